//! Structs of other versions, of every kind that goes in: how much of them is filled, and which are refused.

use std::ptr::null;

use rara::ash::vk;

use crate::arrays::*;
use crate::bake::*;
use crate::boundary::*;
use crate::channels::*;
use crate::depth::*;
use crate::device::*;
use crate::editor::*;
use crate::layer::*;
use crate::matrices::*;
use crate::renderer_desc::*;
use crate::reserve::*;
use crate::settings::*;
use crate::staging::*;
use crate::tests::assert_fails;

include!(concat!(env!("OUT_DIR"), "/lists.rs"));

/// Room for any struct and more.
const ROOM: usize = 64;

/// What fills a struct of so many bytes.
type Fill = fn(*mut u64, usize) -> RaraResult;

/// Each struct that goes in: its name, its size and what fills it.
fn filled() -> Vec<(&'static str, usize, Fill)> {
    let mut filled: Vec<(&'static str, usize, Fill)> = Vec::new();
    macro_rules! fill {
        ($($name:ident $fill:ident($($argument:expr),*),)*) => {
            $(filled.push((stringify!($name), size_of::<$name>(), |to, size| {
                // SAFETY: there is room for any of these structs.
                unsafe { $fill(to.cast::<$name>(), size $(, $argument)*) }
            }));)*
        };
    }
    defaults!(fill);
    filled
}

#[test]
fn every_struct_that_goes_in_is_filled_as_far_as_it_is_known() {
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
            ("RaraSettings", "settings", |from| {
                settings(from.cast()).map(|_| ())
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
        // A struct of the first version has only its size: the rest is filled with defaults, which only settings can do with.
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
