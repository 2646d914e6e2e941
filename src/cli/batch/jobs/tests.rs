use super::*;
use serde_json::json;

fn lines(value: Value) -> Result<Vec<String>, String> {
    let mut jobs = Vec::new();
    let done = collect(value, &Map::new(), Path::new("f"), &mut jobs);
    done.map_err(|failure| failure.to_string())?;
    let line = |job: &Job| {
        let words = job
            .words
            .iter()
            .skip(1)
            .map(|word| word.to_str().expect("text"));
        words.collect::<Vec<_>>().join(" ")
    };
    Ok(jobs.iter().map(line).collect())
}

#[test]
fn flags_have_the_names_that_they_have_on_the_command_line() {
    let job = json!({"scene": ["a.ply", "-b.ply"], "output": "o.png", "clip_op": "or", "clip": ["x", "y"],
                     "trace-all": true, "validation": false, "sigma": 3});
    let line = "render --clip=x --clip=y --clip-op=or --output=o.png --sigma=3 --trace-all -- a.ply -b.ply";
    assert_eq!(lines(job).as_deref(), Ok(&[line.to_owned()][..]));
}

#[test]
fn ranges_and_templates_make_many_of_one() {
    let job = json!({"size": "8x8", "jobs": [
        {"scene": "${s}.ply", "output": "${s}_${n:03}.png", "clip": "plane:z=${z}%", "size": "4x4",
         "for": {"n": "9..10", "s": ["a", "b"], "z": "0..50:2"}},
        {"command": "sweep", "scene": "c", "output": "c"}]});
    let made = lines(job).expect("jobs");
    assert_eq!(made.len(), 9);
    let third = "render --clip=plane:z=0.0% --output=b_009.png --size=4x4 -- b.ply";
    assert_eq!(made[2], third);
    assert_eq!(made[8], "sweep --output=c --size=8x8 -- c");
    let job = json!({"scene": "${s}", "output": "${s}_${v}", "clip": "plane:z=${z}%",
        "for": {"s": ["a", "b"]}, "zip": {"v": "0..2", "z": ["10", "20", "40"]}});
    let line = |(s, v, z)| format!("render --clip=plane:z={z}% --output={s}_{v} -- {s}");
    let made = ["a", "b"].map(|s| [(s, 0, 10), (s, 1, 20), (s, 2, 40)].map(line));
    assert_eq!(lines(job), Ok(made.concat()));
    let numbers = |range: &str| series(&range.into()).expect("a range");
    assert_eq!(numbers("3..1"), [3, 2, 1].map(Value::from));
    assert_eq!(numbers("0..1:11")[3], json!(0.3));
    assert_eq!(numbers("2..5:1"), [json!(2.0)]);
}

#[test]
fn what_is_no_job_is_refused_by_its_number_with_the_remedy() {
    let scene = json!({"scene": "a", "output": "b"});
    let with = |key: &str, value: Value| {
        let mut job = scene.clone();
        job[key] = value;
        json!([scene, job])
    };
    for (value, parts) in [
        (json!([scene, 7]), ["job 2", "is not a job"]),
        (json!([{"output": "b"}]), ["job 1", "\"scene\" is missing"]),
        (with("command", "bake".into()), ["job 2", "neither"]),
        (
            with("json", true.into()),
            ["job 2", "rara batch has its own"],
        ),
        (with("size", json!({})), ["job 2", "\"size\""]),
        (
            with("for", "0..9".into()),
            ["job 2", "\"for\" is an object"],
        ),
        (with("for", json!({"z": "0.."})), ["z", "not a range"]),
        (with("for", json!({"z": "0..9999999"})), ["z", "more than"]),
        (
            with("for", json!({"z": "0..1:9999999"})),
            ["z", "more than"],
        ),
        (
            with("for", json!({"a": "1..9999", "b": "1..9999"})),
            ["job 2", "more than"],
        ),
        (
            with("zip", json!({"a": "1..3", "b": [1, 2]})),
            ["a has 3 values", "as many"],
        ),
        (
            json!([{"scene": "a", "output": "b", "for": {"z": "1..2"}, "zip": {"z": "1..2"}}]),
            ["z is a name", "\"zip\""],
        ),
        (
            json!([{"scene": "a", "output": "${no}", "for": {"z": "1..2"}}]),
            ["'no'", "have z"],
        ),
        (
            json!([{"scene": "a", "output": "${z", "for": {"z": "1..2"}}]),
            ["job 1", "no }"],
        ),
    ] {
        let said = lines(value.clone()).expect_err("refused");
        assert!(
            parts.iter().all(|part| said.contains(part)),
            "{value}: {said}"
        );
    }
}
