//! The part of one of several workers: by `--part`, or as an array job of a scheduler says.

use super::super::failure::Failure;
use super::super::pictures::RunPart;

/// A scheduler sets these for a task of an array: its index, the first index, the last one, and the step between two.
const SCHEDULERS: [[&str; 4]; 2] = [
    [
        "SLURM_ARRAY_TASK_ID",
        "SLURM_ARRAY_TASK_MIN",
        "SLURM_ARRAY_TASK_MAX",
        "SLURM_ARRAY_TASK_STEP",
    ],
    [
        "SGE_TASK_ID",
        "SGE_TASK_FIRST",
        "SGE_TASK_LAST",
        "SGE_TASK_STEPSIZE",
    ],
];

/// The variables that set an index and not how many there are, and the first index.
const INDICES: [(&str, u32); 3] = [
    ("JOB_COMPLETION_INDEX", 0), // Kubernetes
    ("PBS_ARRAY_INDEX", 1),
    ("PBS_ARRAYID", 1),
];

/// The number of workers, for schedulers that do not say it.
const COUNT: &str = "RARA_PARTS";
/// The former name of this variable.
const COUNT_BEFORE: &str = "RARA_SHARDS";

/// The part of this process, if it is a task of an array.
pub(super) fn of_scheduler(
    variable: impl Fn(&str) -> Option<String>,
) -> Result<Option<RunPart>, Failure> {
    let number = |name: &str| variable(name).and_then(|text| text.trim().parse::<u32>().ok());
    for [index, first, last, step] in SCHEDULERS {
        // Outside of an array SGE sets "undefined".
        let (Some(at), Some(first), Some(last)) = (number(index), number(first), number(last))
        else {
            continue;
        };
        let count = number("SLURM_ARRAY_TASK_COUNT").filter(|_| index.starts_with("SLURM"));
        let step = number(step).unwrap_or(1).max(1);
        let all = last.saturating_sub(first) / step + 1;
        if count.is_some_and(|count| count != all)
            || at < first
            || !(at - first).is_multiple_of(step)
        {
            return Err(Failure::Usage(format!(
                "{index} is {at}, of indices that do not follow each other in equal steps: say which part this is by --part K/N"
            )));
        }
        return part((at - first) / step + 1, all).map(Some);
    }
    for (index, first) in INDICES {
        let Some(at) = number(index) else {
            continue;
        };
        let Some(count) = number(COUNT).or_else(|| number(COUNT_BEFORE)) else {
            return Err(Failure::Usage(format!(
                "{index} is {at}, and nothing says of how many: set {COUNT} to the number of workers, or give --part K/N"
            )));
        };
        let Some(number) = at.checked_sub(first) else {
            return Err(Failure::Usage(format!(
                "{index} is {at}: number the array from {first} to the number of workers"
            )));
        };
        return part(number + 1, count).map(Some);
    }
    Ok(None)
}

fn part(number: u32, of: u32) -> Result<RunPart, Failure> {
    format!("{number}/{of}").parse().map_err(Failure::Usage)
}

/// Says which of the pictures are a part's, by the number of the scene and the work of each. Parts follow each other, so that few
/// workers load a scene. Within a scene, neighbours are spread over its parts, since they take about equally long, and more or
/// less than others of the same estimate.
pub(super) fn has(part: RunPart, pictures: &[(usize, f64)]) -> Vec<bool> {
    // The fractions of its multiples are spread evenly.
    const GOLDEN_RATIO: f64 = 1.618_033_988_749_895;
    let place = |index: usize| (index as f64 * GOLDEN_RATIO).fract();
    let mut order: Vec<usize> = (0..pictures.len()).collect();
    order.sort_by(|&a, &b| {
        let scenes = pictures[a].0.cmp(&pictures[b].0);
        scenes.then(place(a).total_cmp(&place(b)))
    });
    let all: f64 = pictures.iter().map(|(_, work)| work).sum();
    let mut before = 0.0;
    let mut is_ours = vec![false; pictures.len()];
    for index in order {
        let (_, work) = pictures[index];
        // A picture is in the part in which its middle lies.
        let middle = before + work / 2.0;
        before += work;
        is_ours[index] = part.has(if all > 0.0 { middle / all } else { 0.0 });
    }
    is_ours
}

#[cfg(test)]
mod tests;
