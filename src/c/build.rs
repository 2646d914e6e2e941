//! Gives the shared library the name by which programs look for it: librara.so and the version of rara.h, which changes when
//! they must be compiled anew.

use std::env;

fn main() {
    let boundary = "boundary.rs";
    println!("cargo:rerun-if-changed={boundary}");
    let text = std::fs::read_to_string(boundary).expect("beside this file");
    let named = text.split("RARA_ABI_VERSION: u32 = ").nth(1);
    let version = named.and_then(|from| from.split(';').next());
    let version = version.expect("boundary.rs says the version of rara.h");
    let system = env::var("CARGO_CFG_TARGET_OS").unwrap_or_default();
    let name = match system.as_str() {
        "linux" | "freebsd" | "netbsd" | "openbsd" | "dragonfly" => {
            format!("-soname,librara.so.{version}")
        }
        "macos" | "ios" => format!("-install_name,@rpath/librara.{version}.dylib"),
        // Libraries are found there by the names of their files.
        _ => return,
    };
    println!("cargo:rustc-cdylib-link-arg=-Wl,{name}");
}
