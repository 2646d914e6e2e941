use super::*;
use crate::Random;
use glam::DVec3;

fn random(random: &mut Random, depth: u32) -> Expression {
    let pick = (random.unit() * if depth == 0 { 2.0 } else { 5.0 }) as u32;
    let mut operands = || {
        let count = 1 + (random.unit() * 3.0) as usize;
        (0..count)
            .map(|_| self::random(random, depth - 1))
            .collect()
    };
    match pick {
        2 => Expression::All(operands()),
        3 => Expression::Any(operands()),
        4 => Expression::Not(Box::new(self::random(random, depth - 1))),
        _ => {
            let [x, y, z] = [(); 3].map(|()| 2.0 * random.unit() - 1.0);
            let text = match pick {
                1 if z > 0.0 => {
                    // A dart, which its last corner dents.
                    let corners = format!("{x},{y};{},{y};{},{}", x + 1.0, x + 0.5, y + 1.5);
                    let text = format!("z={}..{z};{corners};{},{}", z - 1.0, x + 0.4, y + 0.4);
                    return Expression::Prism(Prism::read(&text).unwrap());
                }
                0 => format!("sphere:{x},{y},{z},{}", 0.3 + random.unit()),
                _ => format!("!plane:{x},{y},{z},{}", random.unit() - 0.5),
            };
            Expression::Shape(text.parse().unwrap())
        }
    }
}

fn keeps(expression: &Expression, point: DVec3) -> bool {
    match expression {
        Expression::Shape(shape) => shape.clip().keeps(point),
        Expression::Prism(prism) => prism.clip().keeps(point),
        Expression::Mesh(mesh) => mesh.inside().distance(point) >= 0.0,
        Expression::All(all) => all.iter().all(|e| keeps(e, point)),
        Expression::Any(any) => any.iter().any(|e| keeps(e, point)),
        Expression::Not(expression) => !keeps(expression, point),
    }
}

#[test]
fn a_region_keeps_what_its_expression_means_and_text_round_trips() {
    let mut source = Random::new(9);
    for _ in 0..300 {
        let expression = random(&mut source, 4);
        let back: Expression = expression.to_string().parse().unwrap();
        assert_eq!(back, expression);
        let clip = expression.clip();
        for _ in 0..20 {
            let point = DVec3::from_array([(); 3].map(|()| 3.0 * source.unit() - 1.5));
            assert_eq!(clip.keeps(point), keeps(&expression, point), "{expression}");
            assert_eq!(clip.complement().keeps(point), !clip.keeps(point));
        }
    }
}

#[test]
fn nonsense_is_refused_with_its_place() {
    for (text, words) in [
        ("", "column 1"),
        ("all()", "column 5"),
        ("all(plane:1,0,0,0", "the ) of all("),
        ("all(plane:1,0,0,0,sphere:0,0,0)", "column 19"),
        ("not(plane:1,0,0,0, plane:0,1,0,0)", "one operand"),
        ("some(plane:1,0,0,0)", "'some'"),
        ("plane:1,0,0,0 )", "left over"),
        ("all plane:1,0,0,0", "( )"),
    ] {
        let message = text.parse::<Expression>().unwrap_err().to_string();
        assert!(message.contains(words), "{text}: {message}");
    }
    let deep = format!("{}plane:1,0,0,0{}", "not(".repeat(100), ")".repeat(100));
    assert!(
        deep.parse::<Expression>()
            .unwrap_err()
            .to_string()
            .contains("48")
    );
}
