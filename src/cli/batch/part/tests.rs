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
fn array_jobs_of_each_scheduler_are_parts() {
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
            .contains("RARA_PARTS")
    );
    assert!(parse(&[("JOB_COMPLETION_INDEX", "8"), ("RARA_SHARDS", "8")]).is_err());
    let pbs = |index| parse(&[("PBS_ARRAY_INDEX", index), ("RARA_PARTS", "3")]);
    assert_eq!(pbs("3"), Ok(Some("3/3".into())));
    assert!(pbs("0").expect_err("from 1").contains("from 1"));
    assert_eq!(parse(&[]), Ok(None));
}

#[test]
fn each_picture_is_in_one_part_and_parts_are_balanced() {
    let work: Vec<(usize, f64)> = (0..100)
        .map(|n| (n / 40, (1 + n * 7 % 13) as f64))
        .collect();
    let all: f64 = work.iter().map(|(_, work)| work).sum();
    for of in [1, 3, 8, 100, 250] {
        let mut taken = vec![0; work.len()];
        for number in 1..=of {
            let wanted = has(part(number, of).expect("a part"), &work);
            let sum: f64 = (wanted.iter().zip(&work))
                .filter_map(|(wanted, (_, work))| wanted.then_some(work))
                .sum();
            assert!(sum <= all / f64::from(of) + 13.0, "{number}/{of}: {sum}");
            (taken.iter_mut().zip(&wanted))
                .for_each(|(taken, wanted)| *taken += i32::from(*wanted));
        }
        assert!(taken.iter().all(|taken| *taken == 1), "{of}");
    }
    assert_eq!(has(part(1, 2).expect("a part"), &[(0, 0.0)]), [true]);
    assert_eq!(has(part(2, 2).expect("a part"), &[(0, 0.0)]), [false]);
}

#[test]
fn pictures_of_one_scene_that_take_longer_and_longer_are_spread() {
    let pictures = [(0, 1.0); 300];
    let seconds = |number: usize| 1.0 + number as f64 / 100.0;
    let all: f64 = (0..300).map(seconds).sum();
    for number in 1..=10 {
        let ours = has(part(number, 10).expect("a part"), &pictures);
        let ours = (0..300).filter(|&index| ours[index]).map(seconds);
        let share = 10.0 * ours.sum::<f64>() / all;
        // Neighbours in one part would be 36 % off.
        assert!((share - 1.0).abs() < 0.03, "{number}: {share}");
    }
}
