//! Compiled pipelines are kept from one run to the next, and a damaged cache does no harm.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common;
use crate::common::folder::Folder;
use rara::gpu::Bindings;
use rara::scene::{Kind, generate};
use rara::{Clip, Headless, HeadlessDesc, Picture, PipelineCache, Settings};

/// A picture drawn with a pipeline cache, and the bytes of compiled pipelines that were in it.
fn run(pipeline_cache: PipelineCache) -> (Picture, u64) {
    let scene = generate(Kind::General, 500, 1);
    let camera = common::views(&scene, 1, (64, 48))[0];
    let desc = HeadlessDesc::default()
        .device(std::env::var("RARA_TEST_DEVICE").ok())
        .validation(true)
        .bindings(Some(Bindings::Address))
        .pipeline_cache(pipeline_cache);
    let mut headless = Headless::new(&desc).expect("a Vulkan device");
    headless.load(&scene).expect("uploads");
    headless
        .render(&camera, &Clip::default(), &Settings::default())
        .expect("renders");
    let picture = headless.picture().expect("reads back");
    (picture, headless.kept_pipeline_bytes())
}

/// The one file of compiled pipelines in a folder.
fn only_file(folder: &Path) -> PathBuf {
    let files = fs::read_dir(folder).expect("the folder was made");
    let files = files.map(|file| file.expect("listed").path());
    let files: Vec<_> = files
        .filter(|path| path.extension() != Some("compiled".as_ref()))
        .collect();
    assert_eq!(files.len(), 1, "{files:?}");
    files[0].clone()
}

#[test]
fn pipelines_that_lavapipe_compiles_at_their_first_use_are_compiled_ahead_once() {
    let place = Folder::new("pipelines-ahead");
    let folder = place.join("cache");
    let (first, _) = run(PipelineCache::Folder(folder.clone()));
    let list = only_file(&folder).with_extension("compiled");
    let is_lavapipe = common::headless_unchecked(Bindings::Address)
        .device_name()
        .contains("llvmpipe");
    if !is_lavapipe || std::thread::available_parallelism().map_or(1, usize::from) < 2 {
        assert!(!list.exists(), "nothing is compiled ahead here");
        return;
    }
    let noted = fs::read_to_string(&list).expect("the list was written");
    assert!(noted.lines().count() > 5, "{noted}");
    let (second, _) = run(PipelineCache::Folder(folder.clone()));
    assert_eq!(fs::read_to_string(&list).expect("is there"), noted);
    // A list that is damaged is as good as one that lacks what cannot be read.
    let damaged = noted.replacen('\n', "no hash\n", 1);
    fs::write(&list, damaged).expect("the file is ours");
    let (third, _) = run(PipelineCache::Folder(folder));
    assert!(first == second && first == third);
}

#[test]
fn what_was_compiled_is_there_in_the_next_run() {
    let place = Folder::new("pipelines-kept");
    let folder = place.join("made by the first run");
    let (first, before) = run(PipelineCache::Folder(folder.clone()));
    assert_eq!(before, 0);
    let written = only_file(&folder);
    let (second, kept) = run(PipelineCache::Folder(folder.clone()));
    assert!(kept >= 32, "{kept} bytes are no cache");
    assert!(first == second, "what was kept draws another picture");
    assert_eq!(only_file(&folder), written);
    let (third, none) = run(PipelineCache::Off);
    assert_eq!(none, 0);
    assert!(first == third);
}

#[test]
fn a_damaged_cache_is_ignored_and_replaced() {
    let place = Folder::new("pipelines-damaged");
    let folder = place.join("cache");
    let (whole, _) = run(PipelineCache::Folder(folder.clone()));
    let file = only_file(&folder);
    let good = fs::read(&file).expect("was written");
    let flipped = |at: usize| {
        let mut bytes = good.clone();
        bytes[at] ^= 1;
        bytes
    };
    for bad in [
        Vec::new(),
        b"nonsense".to_vec(),
        good[..good.len() - 1].to_vec(),
        flipped(0),
        flipped(20),
        flipped(good.len() - 1),
    ] {
        fs::write(&file, &bad).expect("the file is ours");
        let (picture, used) = run(PipelineCache::Folder(folder.clone()));
        assert_eq!(used, 0, "{} bad bytes were used", bad.len());
        assert!(picture == whole);
        let (_, used) = run(PipelineCache::Folder(folder.clone()));
        assert!(used > 0, "the bad file was not replaced");
    }
}

#[test]
fn where_nothing_can_be_kept_the_picture_is_the_same() {
    let place = Folder::new("pipelines-refused");
    let folder = place.join("cache");
    fs::write(&folder, "a file where a folder should be").expect("writes");
    let (picture, used) = run(PipelineCache::Folder(folder));
    assert_eq!(used, 0);
    assert!(picture == run(PipelineCache::Off).0);
}
