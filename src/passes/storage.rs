//! The buffers that stages hand to each other. Each is declared once, beside the stage that writes it: its name, which is that
//! of the shaders' bindings, and its bytes as they follow from its owner's plan.

use std::sync::atomic::{AtomicUsize, Ordering};

use rara_gpu::Location;

/// The declaration of a buffer that a plan's owner has.
#[derive(Debug)]
pub(crate) struct Storage<P> {
    /// The debug name.
    pub(super) name: &'static str,
    /// Bytes that a plan needs.
    pub(super) bytes: fn(&P) -> u64,
    /// Who reaches it.
    pub(super) location: fn(&P) -> Location,
    /// The place in the owner's memory; none before all declarations are numbered.
    place: AtomicUsize,
}

impl<P> Storage<P> {
    /// A buffer that only the device sees.
    pub(super) const fn new(name: &'static str, bytes: fn(&P) -> u64) -> Self {
        Self {
            name,
            bytes,
            location: |_| Location::GpuOnly,
            place: AtomicUsize::new(usize::MAX),
        }
    }

    /// The same in memory that the host may see too.
    pub(super) const fn located(self, location: fn(&P) -> Location) -> Self {
        Self { location, ..self }
    }

    pub(super) fn place(&self) -> usize {
        self.place.load(Ordering::Relaxed)
    }

    /// Numbers all declarations of these lists by their places.
    pub(super) fn numbered<'a>(
        lists: impl Iterator<Item = &'a &'static [&'static Self]>,
    ) -> Vec<&'static Self>
    where
        P: 'static,
    {
        let all: Vec<_> = lists.flat_map(|list| list.iter().copied()).collect();
        for (place, storage) in all.iter().enumerate() {
            storage.place.store(place, Ordering::Relaxed);
        }
        all
    }
}

/// The name of a declaration, for those who reach it.
pub(super) fn named<S, N: From<S>>(declaration: S) -> N {
    N::from(declaration)
}

/// Declares the buffers that the stages of a file write first, `name: bytes of a plan` each: `MEMORY` has them by name, and
/// `STORAGES` is their list.
macro_rules! memory {
    ($plan:ty: $($(#[$doc:meta])* $name:ident: $bytes:expr $(, in $location:expr)?;)+) => {
        /// The buffers that this file declares.
        #[derive(Debug)]
        pub(in crate::passes) struct Memory {
            $($(#[$doc])* pub(in crate::passes) $name: $crate::passes::storage::Storage<$plan>,)+
        }

        /// The buffers that this file declares.
        pub(in crate::passes) static MEMORY: Memory = Memory {
            $($name: $crate::passes::storage::Storage::<$plan>::new(stringify!($name), $bytes)$(.located($location))?,)+
        };

        /// The list of these buffers.
        pub(in crate::passes) static STORAGES: &[&$crate::passes::storage::Storage<$plan>] = &[$(&MEMORY.$name),+];
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
            $($($name: $crate::passes::storage::named(&$from.$name),)+)+
            $($($other: $crate::passes::storage::buffers!(@ $other $($buffer)?),)+)?
        }
    };
    (@ $other:ident $buffer:expr) => { $crate::passes::storage::named($buffer) };
    (@ $other:ident) => { $crate::passes::storage::named($other) };
}
pub(super) use buffers;
