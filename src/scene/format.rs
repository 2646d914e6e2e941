//! The formats of scene files by their names.

use std::fmt;

/// The format of a scene file, which [`load`](super::load) recognises by the contents of the file.
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
    /// PlayCanvas' streamed SOG: a `lod-meta.json` beside folders of SOG, or a `.ssog` archive of them, of which the finest level is read.
    StreamedSog,
    /// SuperSplat's `.ssproj`: an archive of a document and of PLYs, which it places, colours and hides.
    SuperSplat,
    /// glTF 2.0, `.glb` or `.gltf`, with `KHR_gaussian_splatting`.
    Gltf,
}

/// Makes the code of all formats from a row for each: its name, and in words its files, where no other row has them. A format
/// without a row does not compile.
macro_rules! formats {
    ($($format:ident => $name:literal $(, $files:literal)?;)+) => {
        const FILES: &[&str] = &[$($($files,)?)+];

        fn name(self) -> &'static str {
            match self {
                $(Self::$format => $name,)+
            }
        }
    };
}

impl Format {
    formats! {
        Ply => "3DGS .ply", ".ply";
        CompressedPly => "compressed .ply", ".compressed.ply";
        Splat => ".splat", ".splat";
        Ksplat => ".ksplat", ".ksplat";
        Spz => ".spz", ".spz";
        Sog => "SOG", ".sog";
        StreamedSog => "streamed SOG", ".ssog";
        SuperSplat => "SuperSplat project", ".ssproj";
        Gltf => "glTF", "glTF with KHR_gaussian_splatting";
    }

    /// True where a file's name is that of a scene in one file.
    #[cfg(feature = "formats")]
    pub(super) fn is_name(name: &str) -> bool {
        let name = name.to_ascii_lowercase();
        let mut endings = Self::FILES.iter().chain(&[".glb", ".gltf"]);
        endings.any(|ending| ending.starts_with('.') && name.ends_with(ending))
    }

    /// Returns the names of the formats that can be read, for messages and help.
    pub fn readable() -> String {
        match Self::FILES {
            [files @ .., last] => format!("{} and {last}", files.join(", ")),
            [] => String::new(),
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str(self.name())
    }
}
