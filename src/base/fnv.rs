//! Fowler, Noll and Vo's hash FNV-1a of 64 bits: it tells versions apart, and is no protection. The build script has it too.

/// The hash of nothing.
pub const NOTHING: u64 = 0xcbf2_9ce4_8422_2325;

/// The hash of what another one is of, and of these bytes or words behind it.
pub fn with<T: Into<u64>>(hash: u64, behind: impl IntoIterator<Item = T>) -> u64 {
    behind.into_iter().fold(hash, |hash, one| {
        (hash ^ one.into()).wrapping_mul(0x0100_0000_01b3)
    })
}
