//! The memory of an owner: the buffers that its stages declare. Each has room for the worst that the scene can need, since
//! no stage reads a count on the CPU, except the tiles' lists, whose worst nobody could afford; drivers back untouched memory
//! lazily.

use crate::passes::owner::Owner;
use crate::passes::sizes::Sizes;
use crate::passes::storage::Storage;
use rara_base::error::Result;
use rara_gpu::{Buffer, BufferDesc, Device};

/// Everything the stages hand to each other.
#[derive(Debug)]
pub(crate) struct Buffers<P: Owner> {
    /// By the places of the declarations; `None` where no frame needs a byte.
    buffers: Vec<Option<Buffer>>,
    sizes: Sizes<P>,
}

/// Buffers of earlier frames that are used again, by the places of their declarations. Those that are not are dropped, and go
/// when the frames that use them are done.
#[derive(Debug, Default)]
pub(crate) struct Spare(Vec<Option<Buffer>>);

impl<P: Owner> Buffers<P> {
    /// Allocates for a plan, in these sizes, what the spare buffers do not have.
    pub(crate) fn new(device: &Device, plan: &P, sizes: Sizes<P>, spare: &Spare) -> Result<Self> {
        let buffer = |((storage, size), spare): ((&Storage<P>, u64), Option<&Buffer>)| match spare {
            _ if size == 0 => Ok(None),
            Some(buffer) => Ok(Some(buffer.clone())),
            None => {
                let made = device.create_buffer(&BufferDesc {
                    name: storage.name,
                    size,
                    location: (storage.location)(plan),
                });
                made.map(Some)
            }
        };
        let buffers = sizes.all().zip(spare.iter()).map(buffer);
        Ok(Self {
            buffers: buffers.collect::<Result<_>>()?,
            sizes,
        })
    }

    pub(crate) fn get(&self, storage: &Storage<P>) -> &Buffer {
        let at = |storage: &Storage<P>| self.buffers[storage.place()].as_ref();
        let buffer = at(storage).or_else(|| at(P::empty()));
        buffer.expect("every owner has its empty buffer")
    }

    /// The buffers that may be used again in these sizes, wherever they are: another plan than the one that they were made for
    /// works with them too, and their contents may be needed. `fits` is given their bytes and those that are needed.
    pub(crate) fn spare(&self, sizes: &Sizes<P>, fits: fn(u64, u64) -> bool) -> Spare {
        let spare = |(buffer, (_, size)): (&Option<Buffer>, (&Storage<P>, u64))| {
            let serves = |buffer: &&Buffer| fits(buffer.size(), rounded(size));
            buffer.as_ref().filter(|_| size > 0).filter(serves).cloned()
        };
        Spare(self.buffers.iter().zip(sizes.all()).map(spare).collect())
    }

    pub(crate) fn outgrown(&self, spare: &Spare) -> u64 {
        let pairs = self.buffers.iter().zip(spare.iter());
        let gone = pairs.filter(|(_, spare)| spare.is_none());
        gone.flat_map(|(buffer, _)| buffer).map(Buffer::size).sum()
    }

    /// True when frames of these sizes fit into what is allocated.
    pub(crate) fn fit(&self, need: &Sizes<P>) -> bool {
        self.sizes.hold(need)
    }

    pub(crate) fn sizes(&self) -> &Sizes<P> {
        &self.sizes
    }

    pub(crate) fn all(&self) -> impl Iterator<Item = &Buffer> {
        self.buffers.iter().flatten()
    }
}

impl Spare {
    fn iter(&self) -> impl Iterator<Item = Option<&Buffer>> {
        let all = self.0.iter().map(Option::as_ref);
        all.chain(std::iter::repeat(None))
    }

    /// The bytes that have to be allocated beside them, without what alignment adds.
    pub(crate) fn missing<P: Owner>(&self, sizes: &Sizes<P>) -> u64 {
        let pairs = self.iter().zip(sizes.all());
        let missing = pairs.filter(|(spare, _)| spare.is_none());
        missing.map(|(_, (_, size))| rounded(size)).sum()
    }
}

/// The bytes of a buffer that is to hold so many.
fn rounded(bytes: u64) -> u64 {
    bytes.next_multiple_of(16)
}
