//! A region as a list: its surfaces in an order in which a stack of answers makes the region's answer.

use std::cmp::Ordering;

use super::{Clip, ClipOp, Surface};

/// A surface of the list. Its answer goes onto the stack; after that each of `operators` replaces the two answers on top by what
/// they make together.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// The surface that is answered.
    pub surface: Surface,
    /// The operations that then join the last two answers, in order.
    pub operators: Vec<ClipOp>,
}

/// The region as steps. There are no repetitions within a list, since cutting twice is cutting once, and the order is the
/// region's own, so that no bit of a picture depends on the order in which its surfaces are given. What needs most of the
/// stack comes first, so that it is never deeper than the logarithm of the number of surfaces.
pub fn postfix(clip: &Clip) -> Vec<Step> {
    branch(clip).steps
}

/// A part of a region as steps, and how much of the stack they need.
struct Branch {
    steps: Vec<Step>,
    depth: usize,
}

fn branch(clip: &Clip) -> Branch {
    let mut surfaces = clip.surfaces.clone();
    surfaces.sort_by(Surface::order);
    surfaces.dedup();
    let mut branches: Vec<Branch> = clip.parts.iter().map(branch).collect();
    branches.retain(|branch| !branch.steps.is_empty());
    branches.sort_by(|a, b| {
        let surfaces = a.steps.iter().zip(&b.steps);
        let mut orders = surfaces.map(|(a, b)| a.surface.order(&b.surface));
        let first = orders.find(|o| o.is_ne()).unwrap_or(Ordering::Equal);
        b.depth.cmp(&a.depth).then(first)
    });
    branches.extend(surfaces.into_iter().map(|surface| Branch {
        steps: vec![Step {
            surface,
            operators: Vec::new(),
        }],
        depth: 1,
    }));
    let mut branches = branches.into_iter();
    let Some(mut joined) = branches.next() else {
        return Branch {
            steps: Vec::new(),
            depth: 0,
        };
    };
    for branch in branches {
        joined.depth = joined.depth.max(branch.depth + 1);
        joined.steps.extend(branch.steps);
        if let Some(last) = joined.steps.last_mut() {
            last.operators.push(clip.op);
        }
    }
    joined
}

/// The answer that a stack makes of its steps' answers; `empty` is that of a region without steps.
pub fn answer<A>(
    steps: impl IntoIterator<Item = (A, impl IntoIterator<Item = ClipOp>)>,
    empty: A,
    join: impl Fn(ClipOp, A, A) -> A,
) -> A {
    let mut stack = Vec::new();
    for (answer, operators) in steps {
        stack.push(answer);
        for op in operators {
            if let (Some(top), Some(below)) = (stack.pop(), stack.pop()) {
                stack.push(join(op, below, top));
            }
        }
    }
    stack.pop().unwrap_or(empty)
}

#[cfg(test)]
mod tests {
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
}
