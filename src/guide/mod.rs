#![doc = include_str!("links.md")]
#![doc = include_str!("index.md")]
// The chapters are text files of their own: they are read in the repository as well as here. A relative link, which a
// repository's page follows, means nothing among generated pages; where a link leads is therefore written as a
// definition at a file's end, and `links.md`, which comes before each chapter here, defines the same names first.
// Pictures are defined so by `build.rs`.

/// Includes a chapter as the documentation of a module of its name.
macro_rules! chapters {
    ($($name:ident $(shows $($picture:literal)+)?),+ $(,)?) => {
        $(
            #[doc = include_str!("links.md")]
            $($(#[cfg_attr(doc, doc = include_str!(concat!(env!("OUT_DIR"), "/", $picture, ".md")))])+)?
            #[doc = include_str!(concat!(stringify!($name), ".md"))]
            pub mod $name {}
        )+

        /// Every chapter's name, for the tests.
        #[cfg(test)]
        const CHAPTERS: &[&str] = &[$(stringify!($name)),+];
    };
}

chapters! {
    accuracy,
    adding,
    batches,
    building,
    c shows "mesh",
    changes,
    command_line shows "section" "sheet",
    embedding shows "linear" "stored",
    formats,
    frame,
    glossary,
    gpu,
    hosts,
    library,
    modes,
    paper shows "report",
    profiling,
    python,
    speed,
    testing,
    wgpu,
}

#[cfg(test)]
mod tests;
