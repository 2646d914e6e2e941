//! The buffers that stages hand to each other. Each is declared once, beside the stage that writes it: its name, which is that
//! of the shaders' bindings, and its bytes as they follow from a plan.

use std::sync::atomic::{AtomicUsize, Ordering};

use crate::passes::plan::Plan;
use crate::passes::scene_buffers::SceneBuffers;
use rara_gpu::{Buffer, Location};

/// The declaration of a buffer.
#[derive(Debug)]
pub(crate) struct Storage {
    /// The debug name.
    pub(super) name: &'static str,
    /// Bytes that a frame of a plan needs.
    pub(super) bytes: fn(&Plan) -> u64,
    /// Who reaches it in a frame of a plan.
    pub(super) location: fn(&Plan) -> Location,
    /// The buffer of a scene; `None` of one that is the frame's own.
    pub(super) of_scene: Option<fn(&SceneBuffers) -> &Buffer>,
    /// The place in a frame's memory; none before all declarations are numbered.
    place: AtomicUsize,
}

impl Storage {
    /// A buffer of the frame that only the device sees.
    pub(super) const fn new(name: &'static str, bytes: fn(&Plan) -> u64) -> Self {
        Self {
            name,
            bytes,
            location: |_| Location::GpuOnly,
            of_scene: None,
            place: AtomicUsize::new(usize::MAX),
        }
    }

    /// The same in memory that the host may see too.
    pub(super) const fn located(self, location: fn(&Plan) -> Location) -> Self {
        Self { location, ..self }
    }

    pub(super) const fn of_scene(name: &'static str, buffer: fn(&SceneBuffers) -> &Buffer) -> Self {
        let of_scene = Some(buffer);
        Self {
            of_scene,
            ..Self::new(name, |_| 0)
        }
    }

    pub(super) fn place(&self) -> usize {
        self.place.load(Ordering::Relaxed)
    }

    /// Numbers all declarations by their places.
    pub(super) fn number(all: &[&Self]) {
        for (place, storage) in all.iter().enumerate() {
            storage.place.store(place, Ordering::Relaxed);
        }
    }
}

/// Declares the buffers that the stages of a file write first, `name: bytes of a plan` each: `MEMORY` has them by name, and
/// `STORAGES` is their list.
macro_rules! memory {
    ($($(#[$doc:meta])* $name:ident: $bytes:expr $(, in $location:expr)?;)+) => {
        /// The buffers that this file declares.
        #[derive(Debug)]
        pub(in crate::passes) struct Memory {
            $($(#[$doc])* pub(in crate::passes) $name: $crate::passes::storage::Storage,)+
        }

        /// The buffers that this file declares.
        pub(in crate::passes) static MEMORY: Memory = Memory {
            $($name: $crate::passes::storage::Storage::new(stringify!($name), $bytes)$(.located($location))?,)+
        };

        /// The list of these buffers.
        pub(in crate::passes) static STORAGES: &[&$crate::passes::storage::Storage] = &[$(&MEMORY.$name),+];
    };
}
pub(super) use memory;

/// The buffers of a program: `from => [name]` binds the declaration `name` of `from` to the binding of that name; after a
/// semicolon come those whose binding has another name.
macro_rules! buffers {
    ($program:ident {
        $($from:expr => [$($name:ident),+ $(,)?]),+ $(,)?
        $(; $($other:ident $(: $buffer:expr)?),+ $(,)?)?
    }) => {
        $program::Buffers {
            $($($name: &$from.$name,)+)+
            $($($other $(: $buffer)?,)+)?
        }
    };
}
pub(super) use buffers;
