//! The formats of scene files by their names.

use std::fmt;
use std::path::Path;

/// The format of a scene file, which [`load`](super::load) finds by what is in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// 3DGS `.ply`: a list of properties in full precision.
    Ply,
    /// PlayCanvas' `.compressed.ply`: 16 bytes a Gaussian, quantised within chunks of 256.
    CompressedPly,
    /// antimatter15's `.splat`: 32 bytes a Gaussian, without spherical harmonics.
    Splat,
    /// mkkellogg's `.ksplat`, of compression level 0, 1 or 2.
    Ksplat,
    /// Niantic's `.spz`, versions 1 to 4.
    Spz,
    /// PlayCanvas' SOG: WebP pictures and a `meta.json`, in a `.sog` archive or a folder.
    Sog,
    /// PlayCanvas' streamed SOG: a `lod-meta.json` beside folders of SOG, of which the finest level is read.
    StreamedSog,
    /// glTF 2.0, `.glb` or `.gltf`, with `KHR_gaussian_splatting`.
    Gltf,
}

impl Format {
    /// The formats that are written, with the endings of their files' names.
    #[cfg(feature = "formats")]
    const WRITTEN: [(&str, Self); 5] = [
        (".compressed.ply", Self::CompressedPly),
        (".ply", Self::Ply),
        (".spz", Self::Spz),
        (".sog", Self::Sog),
        (".glb", Self::Gltf),
    ];

    /// The formats that are written, with the endings of their files' names.
    #[cfg(not(feature = "formats"))]
    const WRITTEN: [(&str, Self); 1] = [(".ply", Self::Ply)];

    /// The format that a file of this name is [saved](super::save) in; `None` for a name whose ending says none that is
    /// written.
    pub fn of_name(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_string_lossy().to_ascii_lowercase();
        let mut written = Self::WRITTEN.iter();
        written
            .find(|(ending, _)| name.ends_with(ending))
            .map(|(_, format)| *format)
    }

    /// The endings of the formats that are written, for messages.
    pub(super) fn endings() -> String {
        Self::WRITTEN.map(|(ending, _)| ending).join(", ")
    }
}

impl fmt::Display for Format {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str(match self {
            Self::Ply => "3DGS .ply",
            Self::CompressedPly => "compressed .ply",
            Self::Splat => ".splat",
            Self::Ksplat => ".ksplat",
            Self::Spz => ".spz",
            Self::Sog => "SOG",
            Self::StreamedSog => "streamed SOG",
            Self::Gltf => "glTF",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_say_the_format_that_is_written() {
        let of = |name: &str| Format::of_name(Path::new(name));
        assert_eq!(of("a/b.PLY"), Some(Format::Ply));
        assert_eq!((of("b.splat"), of("ply"), of("")), (None, None, None));
        #[cfg(feature = "formats")]
        assert_eq!(
            [
                of("b.compressed.ply"),
                of("c.glb"),
                of("c.d.spz"),
                of("x.sog")
            ],
            [
                Format::CompressedPly,
                Format::Gltf,
                Format::Spz,
                Format::Sog
            ]
            .map(Some)
        );
    }
}
