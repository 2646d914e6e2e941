//! Gaussians from files.

use std::ffi::c_char;
use std::io::Cursor;

use rara::Result;
use rara::scene::{Predicate, Property, SceneFile, load_from_with, load_with};

use crate::boundary::{RaraResult, list};
use crate::gaussians::RaraGaussians;
use crate::handles::create;
use crate::selection::parse;
use crate::text::{self, text};

/// Loads a scene: 3DGS .ply (ascii or binary, spherical harmonics of degree 0 to 3), .compressed.ply, .splat, .ksplat, .spz,
/// SOG (an archive, its folder or meta.json) or glTF with KHR_gaussian_splatting. The format is found by what is in the file.
///
/// `path` is UTF-8, or on Unix whatever the file system takes. `predicates`, of which there may be none, are those that
/// rara_gaussians_select will be given: the properties that the file's `vertex` element has beside those of a Gaussian, such as
/// labels, and that any of them compares are kept, 8 bytes a Gaussian each. RARA_ERROR_FORMAT where the file has no such
/// property.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_gaussians_load(
    path: *const c_char,
    predicates: *const *const c_char,
    predicate_count: usize,
    gaussians: *mut *mut RaraGaussians,
) -> RaraResult {
    create(gaussians, "gaussians", || {
        let path = text::path(path, "path")?;
        let predicates = parsed(predicates, predicate_count)?;
        load_with(&path, &compared(&predicates), &mut |_, _| ()).map(made)
    })
}

/// Loads a scene that is in memory, such as an archive's entry, in any format that is one file. `name` stands for it in
/// messages, and `predicates` are as for rara_gaussians_load.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rara_gaussians_load_from(
    data: *const u8,
    size: usize,
    name: *const c_char,
    predicates: *const *const c_char,
    predicate_count: usize,
    gaussians: *mut *mut RaraGaussians,
) -> RaraResult {
    create(gaussians, "gaussians", || {
        let name = text::path(name, "name")?;
        let source = Cursor::new(list(data, size, "data")?);
        let predicates = parsed(predicates, predicate_count)?;
        load_from_with(source, &name, &compared(&predicates), &mut |_, _| ()).map(made)
    })
}

fn made((loaded, properties): (SceneFile, Vec<Property>)) -> RaraGaussians {
    RaraGaussians {
        report: loaded.report,
        properties,
        ..loaded.gaussians.into()
    }
}

unsafe fn parsed(predicates: *const *const c_char, count: usize) -> Result<Vec<Predicate>> {
    let predicates = list(predicates, count, "predicates")?;
    let parsed = predicates.iter().enumerate().map(|(index, &predicate)| {
        let name = format!("predicates[{index}]");
        parse(text(predicate, &name)?, &name)
    });
    parsed.collect()
}

/// The names of the properties that predicates compare, each once.
fn compared(predicates: &[Predicate]) -> Vec<&str> {
    let mut names: Vec<_> = predicates.iter().flat_map(Predicate::properties).collect();
    names.sort_unstable();
    names.dedup();
    names
}
