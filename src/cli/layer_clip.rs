//! `--layer-clip`: the clips of single layers, in place of what their list says.

use rara::Bounds;

use super::failure::Failure;
use super::layer_names::named;
use rara::scene::layers::{LayerClip, Region, SceneLayers};

/// Does what the flags say, in their order.
pub(super) fn apply(texts: &[String], loaded: &mut SceneLayers) -> Result<(), Failure> {
    for text in texts {
        let Some(at) = loaded.end_of_name(text) else {
            return Err(Failure::Usage(format!(
                "--layer-clip {text}: expected NAME=EXPRESSION, as in skin=plane:1,0,0,0"
            )));
        };
        let (name, region) = (&text[..at], &text[at + 1..]);
        let wrong = |error: rara::Error| Failure::Usage(format!("--layer-clip {name}: {error}"));
        let clip = match region.trim() {
            "frame" => None,
            text => {
                let clip = LayerClip::<Region>::parse(text);
                let clip = clip.and_then(|clip| clip.within(|| Bounds::of(loaded.scene())));
                Some(clip.map_err(wrong)?)
            }
        };
        for layer in named(loaded, "--layer-clip", name)? {
            layer.clip = clip.clone();
        }
    }
    Ok(())
}
