//! Structs of other versions, of every kind that goes in: how much of them is filled, and which are refused.

use std::ptr::null;

use rara::ash::vk;

use crate::arrays::*;
use crate::bake::*;
use crate::boundary::*;
use crate::channels::*;
use crate::clip::*;
use crate::depth::*;
use crate::device::*;
use crate::layer::*;
use crate::matrices::*;
use crate::renderer_desc::*;
use crate::reserve::*;
use crate::settings::*;
use crate::staging::*;
use crate::tests::assert_fails;

/// Room for any struct and more.
const ROOM: usize = 64;

/// What fills a struct of so many bytes.
type Fill = fn(*mut u64, usize) -> RaraResult;

/// Each struct that goes in: its name, its size and what fills it.
fn filled() -> Vec<(&'static str, usize, Fill)> {
    macro_rules! filled {
        ($($name:ident: $fill:ident($($argument:expr),*)),* $(,)?) => {
            vec![$((stringify!($name), size_of::<$name>(), |to, size| {
                // SAFETY: there is room for any of these structs.
                unsafe { $fill(to.cast::<$name>(), size $(, $argument)*) }
            })),*]
        };
    }
    let filled: Vec<(&'static str, usize, Fill)> = filled![
        RaraAdoptDesc: rara_adopt_desc_default(),
        RaraBakeSettings: rara_bake_settings_default(),
        RaraChannels: rara_channels_default(RARA_AOV_DEPTH, 1, 1),
        RaraClip: rara_clip_default(),
        RaraDepthDesc: rara_depth_desc_default(vk::Format::D32_SFLOAT, MAP),
        RaraDepthImage: rara_depth_image_default(vk::Image::null(), 1, 1),
        RaraFrameLimits: rara_frame_limits_default(1, 1, 1),
        RaraGaussianArrays: rara_gaussian_arrays_default(),
        RaraLayer: rara_layer_default(null(), null()),
        RaraLayerState: rara_layer_state_default(),
        RaraNdc: rara_ndc_default(),
        RaraRendererDesc: rara_renderer_desc_default(vk::Format::R8G8B8A8_UNORM),
        RaraSettings: rara_settings_default(RARA_PRESET_FAST),
        RaraStaging: rara_staging_default(),
    ];
    filled
}

const MAP: RaraDepthMap = RaraDepthMap {
    z_near: 1.0,
    z_far: 2.0,
    reversed: vk::FALSE,
};

#[test]
fn every_struct_that_goes_in_is_filled_as_far_as_it_is_known() {
    let header = include_str!("rara.h");
    let defaults = header.matches("_default(struct ").count();
    assert_eq!(filled().len(), defaults, "a default is missing above");
    for (name, ours, fill) in filled() {
        assert!(ours + 16 <= 8 * ROOM, "{name}");
        for size in [0, 1, 7, 9, ours - 1, ours + 1] {
            let mut room = [77; ROOM];
            let result = fill(room.as_mut_ptr(), size);
            let says = format!("of {size} bytes: give sizeof({name})");
            assert_fails(result, RARA_ERROR_INVALID, &says);
            assert_eq!(room, [77; ROOM], "{name}: left alone");
        }
        // An older host's, which is all but the first field younger than, and a newer one's.
        for (size, known) in [(8, 8), (ours, ours), (ours + 8, ours)] {
            let mut room = [77; ROOM];
            assert_eq!(fill(room.as_mut_ptr(), size), RARA_OK, "{name}");
            assert_eq!(room[0], known as u64, "{name}");
            let behind = known / 8;
            assert!(room[behind..].iter().all(|word| *word == 77), "{name}");
        }
    }
}

#[test]
fn structs_of_later_versions_are_refused_and_of_earlier_ones_filled_up() {
    type Read = fn(*const u64) -> rara::Result<()>;
    // SAFETY: each is given as many bytes as its size says.
    let read: [(&str, &str, Read); 3] = unsafe {
        [
            ("RaraClip", "clip", |from| {
                crate::clip::clip(from.cast()).map(|_| ())
            }),
            ("RaraDepthImage", "depth", |from| {
                depth_image(from.cast()).map(|_| ())
            }),
            ("RaraStaging", "staging", |from| {
                staging(from.cast()).map(|_| ())
            }),
        ]
    };
    for (name, argument, read) in read {
        let (_, ours, fill) = filled()
            .into_iter()
            .find(|(own, ..)| *own == name)
            .expect("is filled");
        let mut room = [0; ROOM];
        assert_eq!(fill(room.as_mut_ptr(), ours), RARA_OK);
        for size in [0, 7, ours + 8] {
            room[0] = size as u64;
            let error = read(room.as_ptr()).expect_err(name).to_string();
            let says = format!("{argument}->struct_size is {size}, and this library's {name} has");
            assert!(error.starts_with(&says), "{error}");
        }
        // Of the first version is the size alone: all else is as by default, of which only a clip says enough.
        room[0] = 8;
        room[1..].fill(u64::MAX);
        let result = read(room.as_ptr()).map_err(|error| error.to_string());
        match name {
            "RaraDepthImage" => assert_eq!(result, Err("depth->image is null".into())),
            "RaraStaging" => assert_eq!(result, Err("staging->buffer is null".into())),
            _ => assert_eq!(result, Ok(())),
        }
    }
}
