//! The same bytes from every process.

use std::fs;

use super::{done, folder, line, line_with};

#[test]
fn every_run_with_any_number_of_driver_threads_gives_the_same_bytes() {
    let here = folder("determinism");
    done(line(
        &here,
        "generate general -n 20000 --seed 7 -o @/scene.ply",
    ));
    let render = |run: usize, threads: &str| {
        let words = format!(
            "render @/scene.ply -o @/{run}.exr --size 300x220 --clip plane:1,0.2,0.1,0 --validation"
        );
        done(line_with(&here, &words, Some(("LP_NUM_THREADS", threads))));
        fs::read(here.join(format!("{run}.exr"))).expect("the picture was written")
    };
    let first = render(0, "1");
    for (run, threads) in ["1", "2", "3", "8"].iter().enumerate() {
        assert!(
            render(run + 1, threads) == first,
            "{threads} driver threads give other bytes than one"
        );
    }
}
