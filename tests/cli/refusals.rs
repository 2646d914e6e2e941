//! Help texts, wrong command lines, and files and places that will not do.

use std::fs;

use super::{done, folder, line, rara, refused, stderr, stdout};

#[test]
fn every_command_has_help_with_an_example() {
    let commands = [
        "render", "sweep", "demo", "compare", "convert", "generate", "bake", "info", "devices",
    ];
    let overview = stdout(&done(rara(["--help"])));
    for command in commands {
        assert!(overview.contains(&format!("\n  {command} ")), "{command}");
        let help = stdout(&done(rara([command, "--help"])));
        assert!(
            help.contains("Usage: rara") && help.contains("Example"),
            "{command}"
        );
        assert!(help.contains(&format!("  rara {command}")), "{command}");
    }
    assert_eq!(
        stdout(&done(rara(["--version"]))),
        concat!("rara ", env!("CARGO_PKG_VERSION"), "\n")
    );
}

#[test]
fn render_takes_the_flags_that_scripts_rely_on() {
    let help = stdout(&done(rara(["render", "--help"])));
    for flag in [
        "--output",
        "--eye",
        "--target",
        "--up",
        "--fov-y",
        "--ortho",
        "--section",
        "--section-thickness",
        "--section-scale",
        "--cameras",
        "--view",
        "--camera",
        "--size",
        "--clip",
        "--clip-expr",
        "--clip-file",
        "--save-clip",
        "--layer-clip",
        "--hide",
        "--clip-op",
        "--mode",
        "--decay",
        "--sigma",
        "--miss",
        "--trace-all",
        "--background",
        "--sh-degree",
        "--raster",
        "--device",
        "--validation",
        "--repeat",
        "--json",
    ] {
        assert!(
            help.contains(&format!("{flag} ")) || help.contains(&format!("{flag}\n")),
            "{flag}"
        );
    }
}

#[test]
fn typing_nothing_shows_the_help_and_is_an_error() {
    let output = rara([] as [&str; 0]);
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty() && stderr(&output).contains("Usage: rara"));
}

#[test]
fn a_wrong_command_line_is_status_2_and_one_line() {
    let here = folder("usage");
    for (words, what) in [
        ("frobnicate", "frobnicate"),
        ("render", "SCENE"),
        ("render x.ply", "--output"),
        ("render x.ply -o a.png --frob", "--frob"),
        ("render x.ply -o a.jpg", ".png"),
        (
            "render x.ply -o a.png --mode soft",
            "none, hard, rara, exact",
        ),
        ("render x.ply -o a.png --decay square", "linear, depth"),
        ("render x.ply -o a.png --miss maybe", "keep, drop, peak"),
        ("render x.ply -o a.png --sigma -1", "above zero"),
        ("render x.ply -o a.png --sigma nan", "above zero"),
        (
            "render x.ply -o a.png --target 1,2,3 --camera c.json",
            "--camera",
        ),
        (
            "render x.ply -o a.png --eye 1,2 --target 0,0,0",
            "3 numbers",
        ),
        (
            "render x.ply -o a.png --eye 1,2,x --target 0,0,0",
            "'x' is not a finite number",
        ),
        (
            "render x.ply -o a.png --eye 1,2,3 --target 1,2,3",
            "same point",
        ),
        (
            "render x.ply -o a.png --eye 0,0,1 --target 0,0,0 --fov-y 180",
            "180",
        ),
        (
            "render x.ply -o a.png --eye 0,0,1 --target 0,0,0 --camera c.json",
            "--camera",
        ),
        (
            "render x.ply -o a.png --cameras c.json --camera c.json",
            "--camera",
        ),
        ("render x.ply -o a.png --ortho -1", "above zero"),
        ("render x.ply -o a.png --ortho wide", "`fit`"),
        ("render x.ply -o a.png --ortho fit --fov-y 40", "--fov-y"),
        (
            "render x.ply -o a.png --ortho 1 --camera c.json",
            "--camera",
        ),
        (
            "render x.ply -o a.png --ortho fit --eye 1,2,3 --target 0,0,0",
            "give a height",
        ),
        (
            "render x.ply -o a.png --ortho fit --eye 1,2,3",
            "give a height",
        ),
        ("render x.ply -o a.png --section axial", "axial=50%"),
        ("render x.ply -o a.png --section w=0.5", "sagittal"),
        ("render x.ply -o a.png --section z=1.5", "from 0 to 1"),
        (
            "render x.ply -o a.png --section z=0.1..0.9",
            "FROM..TO:COUNT",
        ),
        (
            "render x.ply -o a.png --section z=0..1:0",
            "number of sections",
        ),
        ("render x.ply -o a.png --section z=0..1:3", "put {}"),
        ("render x.ply -o a.png --section skin", "no --clip-file"),
        (
            "render x.ply -o a.png --section z=0.5 --section-thickness 0",
            "above zero",
        ),
        (
            "render x.ply -o a.png --section z=0.5 --section-scale nan",
            "above zero",
        ),
        ("render x.ply -o a.png --section-thickness 1", "--section"),
        (
            "render x.ply -o a.png --section z=0.5 --eye 1,2,3 --target 0,0,0",
            "places the camera itself",
        ),
        (
            "render x.ply -o a.png --section z=0.5 --ortho 3",
            "places the camera itself",
        ),
        (
            "render x.ply -o a.png --section z=0.5 --clip-op or",
            "leave out --clip-op or",
        ),
        ("render x.ply -o a.png --size 100", "1024x768"),
        (
            "render x.ply -o a.png --near-cut -1",
            "give a depth above 0",
        ),
        (
            "generate general -n 1.5 -o a.ply",
            "expected a whole number",
        ),
        ("render x.ply -o a.png --size 0x100", "0x100"),
        ("render x.ply -o a.png --size 100000x1", "100000x1"),
        (
            "render x.ply -o a.png --clip plane:0,0,0,1",
            "non-zero normal",
        ),
        ("render x.ply -o a.png --clip plane:inf,0,0,1", "finite"),
        ("render x.ply -o a.png --clip plane:1,0,0", "4 numbers"),
        (
            "render x.ply -o a.png --clip ball:1,0,0",
            "'ball' is not a shape; use plane, slab, box",
        ),
        ("render x.ply -o a.png --clip ball:1,0,0", "cone, polygon"),
        ("render x.ply -o a.png --clip sphere:0,0,0,0", "above zero"),
        (
            "render x.ply -o a.png --clip !cylinder:0,0,0,1,0,0",
            "7 numbers",
        ),
        (
            "render x.ply -o a.png --clip-expr all(sphere:0,0,0,1",
            "the ) of all(",
        ),
        (
            "render x.ply -o a.png --save-clip a.json",
            "no clip to save",
        ),
        ("generate general -o a_{}.ply", "leave them out"),
        ("compare a.png b.png --map {}.png", "leave them out"),
        (
            "render x.ply -o a.png --save-camera {:03}.json",
            "leave them out",
        ),
        (
            "render x.ply -o a.png --clip plane:1,0,0,0 --save-clip {name}.json",
            "leave them out",
        ),
        (
            "render x.ply -o a.png --clip box:0,0,0,1,1,-1",
            "above zero",
        ),
        ("render x.ply -o a.png --clip-op xor", "and, or"),
        (
            "render x.ply -o a.png --raster triangles",
            "mesh, quad, tiles",
        ),
        (
            "render x.ply -o a.png --background 1,2,3",
            "between 0 and 1",
        ),
        ("render x.ply -o a.png --sh-degree 4", "4"),
        ("render x.ply -o a.png --repeat 0", "0"),
        ("sweep x.ply", "--clip-normal"),
        ("sweep x.ply", "--from and --to"),
        ("sweep x.ply --clip-normal 0,0,0", "zero"),
        ("sweep x.ply --clip-normal 1,0,0 --frames 0", "0"),
        (
            "sweep x.ply --from sphere:0,0,0,1 --to box:0,0,0,1,1,1 --frames 2",
            "the same kinds of shapes",
        ),
        (
            "sweep x.ply --from sphere:0,0,0,1 --to !sphere:0,0,0,1 --frames 2",
            "the same kinds of shapes",
        ),
        ("generate blob -o a.ply", "general, strands, layers"),
        ("generate general -o a.txt", ".ply"),
        ("compare a.png", "B"),
        (
            "bench x.ply",
            "no command bench here; rara-lab has the commands that measure",
        ),
        ("help bench", "rara-lab has the commands that measure"),
        (
            "render a.ply --width=640",
            "tip: use --size <WxH> (Picture size",
        ),
        ("render a.ply --near 1", " or --near-cut <DEPTH> (Leave out"),
        ("render a.ply -o a.png --show count", ".exr"),
        ("sweep a.ply --clip-normal x -o frames --show count", ".exr"),
    ] {
        refused(&line(&here, words), 2, what);
    }
    assert_eq!(
        fs::read_dir(&*here).unwrap().count(),
        0,
        "nothing was written"
    );
}

#[test]
fn negative_numbers_are_values() {
    // The scene is missing, which the command finds out only once it has understood the command line.
    let output = rara([
        "render",
        "none.ply",
        "--json",
        "--eye",
        "-1,2,-3",
        "--target",
        "-1,-1,-1",
        "--up",
        "-1,-1,0",
        "--clip",
        "plane:-1,-2,-3,-4",
    ]);
    refused(&output, 1, "none.ply");
    refused(
        &rara(["sweep", "none.ply", "--clip-normal", "-1,0,0", "--json"]),
        1,
        "none.ply",
    );
}

#[test]
fn places_that_cannot_be_written_are_found_before_the_work() {
    let here = folder("places");
    fs::write(here.join("file"), "").unwrap();
    fs::create_dir(here.join("folder.png")).unwrap();
    // None of the scenes exists either; a message about the place shows that it was checked first.
    for (words, what) in [
        ("render none.ply -o @/file/new/a.png", "not a folder"),
        ("render none.ply -o @/file/a.png", "not a folder"),
        ("render none.ply -o @/folder.png", "this is a folder"),
        (
            "sweep none.ply --clip-normal 1,0,0 -o @/file",
            "not a folder",
        ),
        ("demo none.ply -o @/file/such", "not a folder"),
        ("generate general -o @/file/such/a.ply", "not a folder"),
    ] {
        refused(&line(&here, words), 1, what);
    }
}

#[test]
fn files_that_cannot_be_read_are_status_1_and_named() {
    let here = folder("unreadable");
    fs::write(
        here.join("bad.ply"),
        "ply\nformat binary_little_endian 1.0\nelement vertex 5\n",
    )
    .unwrap();
    fs::write(here.join("bad.json"), "{").unwrap();
    fs::write(here.join("bad.png"), "no picture").unwrap();
    for (words, what) in [
        ("info @/none.ply", "none.ply"),
        ("info @/bad.ply", "bad.ply"),
        ("render @/bad.ply --json", "bad.ply"),
        ("render @/none.ply --json --view 1", "none.ply"),
        ("render @/bad.ply --json --camera @/none.json", "none.json"),
        ("render @/bad.ply --json --cameras @/bad.json", "bad.json"),
        ("compare @/none.png @/none.png", "none.png"),
        ("compare @/bad.png @/bad.png", "bad.png"),
    ] {
        refused(&line(&here, words), 1, what);
    }
}
