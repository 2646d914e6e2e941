//! Files that are no scenes which are read: what each is, by its first bytes, and what to do about it.

use serde_json::Value;

use super::files::{Archive, own_name};
use super::{Format, bare, list};
use rara_base::counted::counted;
use rara_base::error::shortened;
use rara_base::rows;

/// What to do about files of several kinds.
const EXPORT: &str = "export its Gaussians as .ply from the program that made it";
const POINTS: &str =
    "points and meshes are not Gaussians; train a scene, and give the .ply that training wrote";
const TRAINED: &str = "let the trainer export a .ply, and give that";
const UNPACK: &str = "unpack it, and give the scene that is in it";
const PICTURE: &str = "give a scene's file";
const CAMERAS: &str = "give it by --cameras, or one camera by --camera";

/// The beginnings of files, from so many bytes on, what such a file is, and what to do about it.
const KINDS: &[(usize, &[&[u8]], &str, &str)] = &rows! {
    0, &[b"PXR-", b"#usda"], "a USD scene", EXPORT;
    0, &[b"RAD0"], "a .rad scene of Spark", EXPORT;
    0, &[b"LASF"], "a LAS or LAZ point cloud", POINTS;
    0, &[b"ASTM-E57"], "an E57 point cloud", POINTS;
    0, &[b"# .PCD", b"#.PCD", b"VERSION .7", b"VERSION 0.7"], "a PCD point cloud", POINTS;
    0, &[b"Kaydara FBX", b"; FBX"], "an FBX scene", POINTS;
    0, &[b"BLENDER"], "a file of Blender", EXPORT;
    0, &[b"solid ", b"v ", b"o ", b"mtllib ", b"# Blender", b"OFF\n"], "a mesh", POINTS;
    0, &[b"b3dm", b"i3dm", b"pnts", b"cmpt"], "a tile of 3D Tiles 1.0", "export tiles of glTF with KHR_gaussian_splatting";
    0, &[b"\x89HDF"], "an HDF5 file, perhaps a checkpoint of a trainer", TRAINED;
    0, &[b"\x93NUMPY"], "an array of NumPy", TRAINED;
    0, &[b"\x80\x02", b"\x80\x03", b"\x80\x04", b"\x80\x05"], "a pickle of Python, perhaps a checkpoint of a trainer", TRAINED;
    8, &[b"{\""], "a file of safetensors", TRAINED;
    0, &[b"SQLite format 3"], "a database, perhaps COLMAP's", POINTS;
    0, &[b"version https://git-lfs"], "a pointer of Git LFS in place of the file", "run git lfs pull where it was cloned";
    0, &[b"<!DOCTYPE", b"<!doctype", b"<html", b"<HTML"], "a web page in place of the file", "download it again; its page may want you to sign in";
    0, &[b"<?xml", b"<COLLADA"], "XML", EXPORT;
    0, &[b"%PDF"], "a PDF document", PICTURE;
    8, &[b"WEBP"], "a WebP picture", "give the meta.json or the folder that it belongs to";
    0, &[b"\x89PNG", b"\xff\xd8\xff", b"GIF8", b"II*\0", b"MM\0*", b"\x76\x2f\x31\x01"], "a picture", PICTURE;
    4, &[b"ftyp"], "a film or a picture", PICTURE;
    0, &[b"\x28\xb5\x2f\xfd"], "a file compressed with zstd", UNPACK;
    0, &[b"\xfd7zXZ", b"BZh", b"\x04\x22\x4d\x18"], "a file compressed with xz, bzip2 or lz4", UNPACK;
    0, &[b"7z\xbc\xaf", b"Rar!"], "a 7z or RAR archive", UNPACK;
    257, &[b"ustar"], "a tar archive", UNPACK;
    0, &[b"["], "a JSON list, perhaps of cameras", "give cameras by --cameras, and clips by --clip-file";
};

/// The kinds of zip archives, by the end of the name of a file in them.
const ARCHIVES: &[(&[&str], &str, &str)] = &rows! {
    &[".usda", ".usdc", ".usd"], "a USDZ package", EXPORT;
    &["data.pkl"], "a checkpoint of PyTorch", TRAINED;
    &[".npy"], "a set of NumPy's arrays, perhaps a checkpoint of a trainer", TRAINED;
    &["tileset.json"], "a set of 3D Tiles", "unpack it, and give the .glb files of its finest level";
    &[".kml"], "a KMZ map", POINTS;
    &[".obj", ".stl", ".fbx", ".las", ".laz", ".e57", ".dae"], "an archive of points or meshes", POINTS;
    &[".7z", ".rar", ".tar", ".zip", ".gz"], "an archive of archives", UNPACK;
};

/// The kinds of JSON documents, by a member.
const DOCUMENTS: &[(&str, &str, &str)] = &rows! {
    "layers", "a list of layers", "give it to the program rara by a name that ends in .json";
    "frames", "a file of cameras", CAMERAS;
    "world_to_camera", "a file of cameras", CAMERAS;
    "camera_path", "a file of cameras", CAMERAS;
    "totalSplats", "an LCC scene of XGRIDS", "convert it to .ply, for example with splat-transform";
    "", "a JSON document that is neither the meta.json of a SOG scene (means, scales, quats, sh0) nor glTF", "give the scene's own file";
};

/// The refusal of a file that is of this kind.
fn refusal(what: &str, to_do: &str) -> String {
    format!(
        "this is not a scene in a format that rara reads, but {what}: {to_do} (rara reads {})",
        Format::readable()
    )
}

/// What a file is that begins like this and that none of the formats reads.
pub(super) fn file(start: &[u8], total: u64) -> String {
    let text = bare(start).trim_ascii_start();
    let begins = |at: usize, all: &[&[u8]]| {
        let start = if at == 0 {
            text
        } else {
            start.get(at..).unwrap_or_default()
        };
        all.iter().any(|one| start.starts_with(one))
    };
    let known = KINDS.iter().find(|(at, all, ..)| begins(*at, all));
    if let Some((_, _, what, to_do)) = known {
        return refusal(what, to_do);
    }
    // An OBJ may begin with any comment.
    if text.starts_with(b"#") && text.windows(3).any(|line| line == b"\nv ") {
        return refusal("a mesh", POINTS);
    }
    // A binary STL has a header that says nothing, and a count.
    let triangles = start.get(80..84).and_then(|count| count.try_into().ok());
    let triangles = triangles.map(|count| u64::from(u32::from_le_bytes(count)));
    if triangles.is_some_and(|count| total == 84 + 50 * count) {
        return refusal("a mesh", POINTS);
    }
    let (what, to_do) = match start {
        [] => ("an empty file", "get it again"),
        _ => (
            "a file of an unknown kind",
            "convert it to .ply, for example with splat-transform",
        ),
    };
    refusal(what, to_do)
}

/// What an archive is of whose files none is a scene.
pub(super) fn archive(archive: &Archive<'_>) -> String {
    /// Names in a message, at most.
    const NAMED: usize = 3;
    let has = |ends: &[&str]| {
        let mut names = archive
            .paths()
            .map(|path| own_name(path).to_ascii_lowercase());
        names.any(|name| ends.iter().any(|end| name.ends_with(end)))
    };
    if let Some((_, what, to_do)) = ARCHIVES.iter().find(|(ends, ..)| has(ends)) {
        return refusal(what, to_do);
    }
    let names = archive.paths().take(NAMED);
    let names: Vec<_> = names
        .map(|path| shortened(&path.to_string_lossy()))
        .collect();
    refusal(
        &format!(
            "an archive of {} ({}), of which none is a scene's nor the meta.json of SOG",
            counted(archive.paths().count(), "file"),
            names.join(", ")
        ),
        "get the scene again",
    )
}

/// What a JSON document is that is neither of SOG nor of glTF; none for glTF.
pub(super) fn document(document: &Value) -> Option<String> {
    let has = |key: &str| document.get(key).is_some();
    if has("geometricError") || has("root") && has("asset") {
        let mut uris = Vec::new();
        contents(document.get("root"), &mut uris, 0);
        let named = match uris.first() {
            Some(uri) => format!("give the files that it names, such as {}", shortened(uri)),
            None => "it names no file; export it again".into(),
        };
        let to_do = format!("{named}, if they are glTF with KHR_gaussian_splatting");
        return Some(refusal("a tileset of 3D Tiles", &to_do));
    }
    if has("asset") {
        return None;
    }
    // The last row is that of all others.
    let known = DOCUMENTS
        .iter()
        .find(|(key, ..)| has(key) || key.is_empty());
    known.map(|(_, what, to_do)| refusal(what, to_do))
}

/// The names of the files of a tile and of its children.
fn contents<'a>(tile: Option<&'a Value>, uris: &mut Vec<&'a str>, depth: usize) {
    let Some(tile) = tile.filter(|_| depth < 64) else {
        return;
    };
    let own = tile
        .get("content")
        .into_iter()
        .chain(list(tile, "contents"));
    uris.extend(own.filter_map(|content| content.get("uri")?.as_str()));
    for child in list(tile, "children") {
        contents(Some(child), uris, depth + 1);
    }
}
