use super::*;
use crate::clip::Expression;
use glam::DVec3;

#[test]
fn the_list_means_the_region_and_its_stack_stays_low() {
    // A chain of alternating operations, and a wide tree.
    let mut chain = "sphere:0,0,0,1".to_string();
    for number in 0..40 {
        let (name, at) = (["all", "any"][number % 2], number as f64 / 20.0 - 1.0);
        chain = format!("{name}({chain}, plane:1,{at},0,{at})");
    }
    let wide: Vec<String> = (0..64)
        .map(|n| format!("all(sphere:{n},0,0,.6, plane:0,1,0,.{n})"))
        .collect();
    for (text, most) in [(chain, 2), (format!("any({})", wide.join(",")), 3)] {
        let clip = text.parse::<Expression>().unwrap().clip();
        let steps = postfix(&clip);
        assert!(branch(&clip).depth <= most);
        for number in 0..500 {
            let turn = |by: f64| (f64::from(number) * by).sin();
            let point = DVec3::new(3.0 * turn(0.7), turn(1.3), turn(2.1));
            let answers = steps.iter().map(|step| {
                (
                    step.surface.distance(point) >= 0.0,
                    step.operators.iter().copied(),
                )
            });
            let kept = answer(answers, true, |op, a, b| match op {
                ClipOp::And => a && b,
                ClipOp::Or => a || b,
            });
            assert_eq!(kept, clip.keeps(point), "{point}");
        }
    }
}
