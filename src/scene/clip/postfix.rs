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
mod tests;
