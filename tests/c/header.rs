//! `rara.h` is what cbindgen makes of `src/c`. `RARA_WRITE_HEADER=1` writes it anew.

use std::path::Path;

#[test]
fn the_header_is_current() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config =
        cbindgen::Config::from_file(folder.join("cbindgen.toml")).expect("a configuration");
    let bindings = cbindgen::Builder::new().with_config(config);
    let files = [
        "boundary", "camera", "clip", "depth", "device", "renderer", "scene", "settings", "stats",
    ];
    let add = |bindings: cbindgen::Builder, file: &&str| {
        bindings.with_src(folder.join(file).with_extension("rs"))
    };
    let bindings = files.iter().fold(bindings, add);
    let mut made = Vec::new();
    bindings.generate().expect("C has it all").write(&mut made);
    let made = String::from_utf8(made).expect("UTF-8");
    let header = folder.join("rara.h");
    if std::env::var_os("RARA_WRITE_HEADER").is_some() {
        std::fs::write(&header, &made).expect("src/c is writable");
    }
    let committed = std::fs::read_to_string(&header).unwrap_or_default();
    assert!(
        made == committed,
        "src/c/rara.h is stale: RARA_WRITE_HEADER=1 cargo test -p rara-c --test c_header"
    );
}
