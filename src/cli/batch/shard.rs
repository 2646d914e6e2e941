//! The share of one of several workers: by `--shard`, or as an array job of a scheduler says.

use super::super::failure::Failure;
use super::super::pictures::RunShare;

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
const COUNT: &str = "RARA_SHARDS";

/// The share of this process, if it is a task of an array.
pub(super) fn of_scheduler(
    variable: impl Fn(&str) -> Option<String>,
) -> Result<Option<RunShare>, Failure> {
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
                "{index} is {at}, of indices that do not follow each other in equal steps: say which share this is by --shard K/N"
            )));
        }
        return part((at - first) / step + 1, all).map(Some);
    }
    for (index, first) in INDICES {
        let Some(at) = number(index) else {
            continue;
        };
        let Some(count) = number(COUNT) else {
            return Err(Failure::Usage(format!(
                "{index} is {at}, and nothing says of how many: set {COUNT} to the number of workers, or give --shard K/N"
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

fn part(number: u32, of: u32) -> Result<RunShare, Failure> {
    format!("{number}/{of}").parse().map_err(Failure::Usage)
}

/// Says which of the pictures are a part's, by the number of the scene and the work of each. Parts follow each other, so that few
/// workers load a scene. Within a scene, neighbours are spread over its parts, since they take about equally long, and more or
/// less than others of the same estimate.
pub(super) fn share(part: RunShare, pictures: &[(usize, f64)]) -> Vec<bool> {
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
mod tests {
    use super::*;

    fn parse(set: &[(&str, &str)]) -> Result<Option<String>, String> {
        let variable = |name: &str| {
            let found = set.iter().find(|(of, _)| *of == name);
            found.map(|(_, value)| (*value).to_owned())
        };
        let part = of_scheduler(variable).map_err(|failure| failure.to_string())?;
        Ok(part.map(|part| part.to_string()))
    }

    #[test]
    fn array_jobs_of_each_scheduler_are_shares() {
        let slurm = |id, min, max, count| {
            let [a, b, c, d, ..] = [
                "SLURM_ARRAY_TASK_ID",
                "SLURM_ARRAY_TASK_MIN",
                "SLURM_ARRAY_TASK_MAX",
                "SLURM_ARRAY_TASK_COUNT",
            ];
            parse(&[(a, id), (b, min), (c, max), (d, count)])
        };
        assert_eq!(slurm("0", "0", "3", "4"), Ok(Some("1/4".into())));
        assert_eq!(slurm("40", "1", "40", "40"), Ok(Some("40/40".into())));
        assert!(slurm("9", "1", "9", "3").is_err(), "1,5,9");
        let sge = |id| {
            parse(&[
                ("SGE_TASK_ID", id),
                ("SGE_TASK_FIRST", "2"),
                ("SGE_TASK_LAST", "10"),
                ("SGE_TASK_STEPSIZE", "2"),
            ])
        };
        assert_eq!(sge("6"), Ok(Some("3/5".into())));
        assert_eq!(sge("undefined"), Ok(None));
        let pod = [("JOB_COMPLETION_INDEX", "7"), ("RARA_SHARDS", "8")];
        assert_eq!(parse(&pod), Ok(Some("8/8".into())));
        assert!(
            parse(&pod[..1])
                .expect_err("of how many")
                .contains("RARA_SHARDS")
        );
        assert!(parse(&[("JOB_COMPLETION_INDEX", "8"), ("RARA_SHARDS", "8")]).is_err());
        let pbs = |index| parse(&[("PBS_ARRAY_INDEX", index), ("RARA_SHARDS", "3")]);
        assert_eq!(pbs("3"), Ok(Some("3/3".into())));
        assert!(pbs("0").expect_err("from 1").contains("from 1"));
        assert_eq!(parse(&[]), Ok(None));
    }

    #[test]
    fn each_picture_is_in_one_share_and_shares_are_balanced() {
        let work: Vec<(usize, f64)> = (0..100)
            .map(|n| (n / 40, (1 + n * 7 % 13) as f64))
            .collect();
        let all: f64 = work.iter().map(|(_, work)| work).sum();
        for of in [1, 3, 8, 100, 250] {
            let mut taken = vec![0; work.len()];
            for number in 1..=of {
                let wanted = share(part(number, of).expect("a part"), &work);
                let sum: f64 = (wanted.iter().zip(&work))
                    .filter_map(|(wanted, (_, work))| wanted.then_some(work))
                    .sum();
                assert!(sum <= all / f64::from(of) + 13.0, "{number}/{of}: {sum}");
                (taken.iter_mut().zip(&wanted))
                    .for_each(|(taken, wanted)| *taken += i32::from(*wanted));
            }
            assert!(taken.iter().all(|taken| *taken == 1), "{of}");
        }
        assert_eq!(share(part(1, 2).expect("a part"), &[(0, 0.0)]), [true]);
        assert_eq!(share(part(2, 2).expect("a part"), &[(0, 0.0)]), [false]);
    }

    #[test]
    fn pictures_of_one_scene_that_take_longer_and_longer_are_spread() {
        let pictures = [(0, 1.0); 300];
        let seconds = |number: usize| 1.0 + number as f64 / 100.0;
        let all: f64 = (0..300).map(seconds).sum();
        for number in 1..=10 {
            let ours = share(part(number, 10).expect("a part"), &pictures);
            let ours = (0..300).filter(|&index| ours[index]).map(seconds);
            let share = 10.0 * ours.sum::<f64>() / all;
            // Neighbours in one share would be 36 % off.
            assert!((share - 1.0).abs() < 0.03, "{number}: {share}");
        }
    }
}
