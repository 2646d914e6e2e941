//! `--layer-clip`: the clips of single layers, in place of what their list says.

use super::failure::Failure;
use super::scene_file::LayerClip;
use super::scenes::Loaded;

/// Does what the flags say, in their order.
pub(super) fn apply(texts: &[String], loaded: &mut Loaded) -> Result<(), Failure> {
    for text in texts {
        let Some(at) = loaded.end_of_name(text) else {
            return Err(Failure::Usage(format!(
                "--layer-clip {text}: expected NAME=EXPRESSION, as in skin=plane:1,0,0,0"
            )));
        };
        let (name, region) = (&text[..at], &text[at + 1..]);
        let clip = match region.trim() {
            "frame" => None,
            region => Some(
                LayerClip::parse(region)
                    .map_err(|error| Failure::Usage(format!("--layer-clip {name}: {error}")))?,
            ),
        };
        for layer in loaded.named("--layer-clip", name)? {
            layer.clip = clip.clone();
        }
    }
    Ok(())
}
