//! Everything that crosses the boundary: codes and messages, panics, null pointers, structs of other versions.

use std::any::Any;
use std::cell::RefCell;
use std::ffi::{CString, c_char, c_void};
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr::NonNull;

use rara::ash::vk;
use rara::gpu::WriteOnly;
use rara::{Error, Result};

use crate::names::in_c;

/// The result of every function that can fail. After anything but RARA_OK rara_last_error_message says more.
pub type RaraResult = i32;
/// Done.
pub const RARA_OK: RaraResult = 0;
/// An argument is not possible: a null pointer, a plane without a normal, a picture of no size. The message names it.
pub const RARA_ERROR_INVALID: RaraResult = 1;
/// A file could not be opened or read.
pub const RARA_ERROR_IO: RaraResult = 2;
/// A file was read, and what stands in it is not usable.
pub const RARA_ERROR_FORMAT: RaraResult = 3;
/// The device lacks something.
pub const RARA_ERROR_DEVICE: RaraResult = 4;
/// There is not enough memory, on the device, on the host, or in the budget of rara_device_set_memory_budget.
pub const RARA_ERROR_MEMORY: RaraResult = 5;
/// A Vulkan call failed for another reason.
pub const RARA_ERROR_VULKAN: RaraResult = 6;
/// A panic was stopped: rara has a bug, and the message says which. With the handles that the call was given, only the
/// destroy functions are sure to work.
pub const RARA_ERROR_PANIC: RaraResult = 7;
/// VK_ERROR_DEVICE_LOST. Nothing on the device can be used any more: the host destroys what was made from the RaraDevice,
/// then the RaraDevice, then its own device, and goes on with another one.
pub const RARA_ERROR_DEVICE_LOST: RaraResult = 8;

/// The version of this header. It changes when a host must be compiled anew; structs that grow at their end and functions
/// that are added do not change it.
pub const RARA_ABI_VERSION: u32 = 5;

/// The version of the library that is linked: the RARA_ABI_VERSION of its header.
#[unsafe(no_mangle)]
pub extern "C" fn rara_abi_version() -> u32 {
    RARA_ABI_VERSION
}

thread_local! {
    static MESSAGE: RefCell<CString> = RefCell::default();
}

/// The message of this thread's last call that failed: one or two sentences in UTF-8, "" if none has failed. It is valid
/// until this thread's next call that fails.
#[unsafe(no_mangle)]
pub extern "C" fn rara_last_error_message() -> *const c_char {
    let message = MESSAGE.try_with(|message| message.borrow().as_ptr());
    message.unwrap_or(c"".as_ptr()) // the thread is ending
}

/// Runs a function's body: a failure or a panic in it becomes a code and a message.
pub(crate) fn guard(run: impl FnOnce() -> Result<()>) -> RaraResult {
    let run = || {
        #[cfg(test)]
        crate::tests::nulls::panic_if_asked();
        run()
    };
    // Handles are not unwind safe in Rust's sense; the documentation of RARA_ERROR_PANIC says what they are still good
    // for.
    match catch_unwind(AssertUnwindSafe(run)) {
        Ok(Ok(())) => RARA_OK,
        Ok(Err(error)) => fail(code(&error), &error.to_string()),
        Err(payload) => fail(RARA_ERROR_PANIC, &text_of(payload)),
    }
}

fn fail(code: RaraResult, message: &str) -> RaraResult {
    let message = c_string(&in_c(message));
    // This has no effect while the thread is ending.
    let _ = MESSAGE.try_with(|last| last.replace(message));
    code
}

/// A text with a NUL at its end and no other NUL.
pub(crate) fn c_string(text: &str) -> CString {
    CString::new(text.replace('\0', "\u{fffd}")).unwrap_or_default()
}

fn code(error: &Error) -> RaraResult {
    match error {
        Error::Invalid(_) => RARA_ERROR_INVALID,
        Error::Io { .. } => RARA_ERROR_IO,
        Error::Format { .. } => RARA_ERROR_FORMAT,
        Error::Device(_) => RARA_ERROR_DEVICE,
        Error::DeviceLost { .. } => RARA_ERROR_DEVICE_LOST,
        Error::Memory(_) | Error::Budget(_) => RARA_ERROR_MEMORY,
        // The wildcard stands for what a later version may add to these two.
        Error::Vulkan { .. } | Error::Validation(_) | _ => RARA_ERROR_VULKAN,
    }
}

fn text_of(payload: Box<dyn Any + Send>) -> String {
    let text = payload.downcast_ref::<String>().cloned();
    let text = text.or_else(|| Some((*payload.downcast_ref::<&str>()?).to_owned()));
    // Dropping it may panic once more.
    std::mem::forget(payload);
    text.unwrap_or_else(|| "a panic without a message".into())
}

pub(crate) fn invalid<T>(message: impl Into<String>) -> Result<T> {
    Err(Error::Invalid(message.into()))
}

/// The value that an argument points to, to be read.
///
/// # Safety
/// `pointer` is null, or points to a `T` that nobody changes for `'a`.
pub(crate) unsafe fn shared<'a, T>(pointer: *const T, name: &str) -> Result<&'a T> {
    match pointer.as_ref() {
        Some(value) => Ok(value),
        None => invalid(format!("{name} is null")),
    }
}

/// The value that an argument points to, to be changed.
///
/// # Safety
/// `pointer` is null, or points to a `T` that nobody else uses for `'a`.
pub(crate) unsafe fn exclusive<'a, T>(pointer: *mut T, name: &str) -> Result<&'a mut T> {
    match pointer.as_mut() {
        Some(value) => Ok(value),
        None => invalid(format!("{name} is null")),
    }
}

/// Several values one after the other; with a count of 0 the pointer may be null.
///
/// # Safety
/// `first` is null, or points to `count` values that nobody changes for `'a`.
pub(crate) unsafe fn list<'a, T>(first: *const T, count: usize, name: &str) -> Result<&'a [T]> {
    if count == 0 {
        return Ok(&[]);
    }
    check_count::<T>(count, name)?;
    shared(first, name)?;
    Ok(std::slice::from_raw_parts(first, count))
}

/// Writes as many of what was found as there is room for, and none where `first` is null. `*count` is the room on entry, and
/// becomes how many were found.
///
/// # Safety
/// `first` is null, or has room for `*count` values, which nobody else uses; `count` is null, or may be overwritten.
pub(crate) unsafe fn write_list<T, F>(
    first: *mut T,
    count: *mut usize,
    found: &[F],
    make: impl Fn(&F) -> T,
) -> Result<()> {
    let count = exclusive(count, "count")?;
    if !first.is_null() {
        check_count::<T>(*count, "count")?;
        for (place, one) in found.iter().take(*count).enumerate() {
            first.add(place).write(make(one));
        }
    }
    *count = found.len();
    Ok(())
}

/// Memory to be written; with a size of 0 the pointer may be null.
///
/// # Safety
/// `first` is null, or points to `size` bytes that nobody else uses for `'a`.
pub(crate) unsafe fn memory<'a>(
    first: *mut c_void,
    size: usize,
    name: &str,
) -> Result<WriteOnly<'a>> {
    if size == 0 {
        return Ok((&mut [][..]).into());
    }
    check_count::<u8>(size, name)?;
    let first = NonNull::new(first.cast());
    let first = first.ok_or_else(|| Error::Invalid(format!("{name} is null")))?;
    Ok(WriteOnly::new(NonNull::slice_from_raw_parts(first, size)))
}

fn check_count<T>(count: usize, name: &str) -> Result<()> {
    if count > isize::MAX as usize / size_of::<T>().max(1) {
        return invalid(format!(
            "{name}: {count} of them are more than memory holds"
        ));
    }
    Ok(())
}

/// Refuses a command buffer that is null.
pub(crate) fn recording(cmd: vk::CommandBuffer) -> Result<vk::CommandBuffer> {
    if cmd == vk::CommandBuffer::null() {
        return invalid("cmd is null");
    }
    Ok(cmd)
}

/// Structs that may grow at their end. A host says how large its own are, so that each side can be the newer one.
///
/// # Safety
/// The struct is `repr(C)`, begins with its size, may hold any bytes, and only ever grows at its end.
pub(crate) unsafe trait Versioned: Copy {
    /// Its name in C.
    const NAME: &'static str;
    /// Its size, and nothing else: null, false and 0.
    const BLANK: Self;
}

/// Says of a struct that it is [`Versioned`]: it must be `repr(C)`, begin with its size, and hold only numbers, handles and
/// pointers.
macro_rules! versioned {
    ($name:ident) => {
        // SAFETY: it is as the macro asks, which tests/c/layouts.rs holds to what C compilers do.
        unsafe impl $crate::boundary::Versioned for $name {
            const NAME: &'static str = stringify!($name);
            const BLANK: Self = Self {
                struct_size: size_of::<Self>(),
                // SAFETY: zeros are numbers, and null.
                ..unsafe { std::mem::zeroed() }
            };
        }
    };
}
pub(crate) use versioned;

/// True when a struct of some version, older or newer than this one, can have this size: in C the size is a multiple of
/// the alignment, and the struct's first field holds the size.
fn is_a_version<T: Versioned>(size: usize) -> bool {
    size >= size_of::<usize>() && size.is_multiple_of(align_of::<T>())
}

/// Reads a host's struct; fields that its version does not have yet are as in `default`.
///
/// # Safety
/// `pointer` is null, or points to a size and to as many bytes as it says, the size included.
pub(crate) unsafe fn read<T: Versioned>(pointer: *const T, default: T, name: &str) -> Result<T> {
    let size = *shared(pointer.cast::<usize>(), name)?;
    check_size::<T>(size, format_args!("{name}->struct_size"))?;
    Ok(copied(pointer, size, default))
}

/// Reads a host's structs one after the other, all of the size that the first says; fields that their version does not
/// have yet are as in `default`. With a count of 0 the pointer may be null.
///
/// # Safety
/// `first` is null, or points to `count` structs of one size, and each begins with that size.
pub(crate) unsafe fn read_list<T: Versioned>(
    first: *const T,
    count: usize,
    default: T,
    name: &str,
) -> Result<Vec<T>> {
    if count == 0 {
        return Ok(Vec::new());
    }
    check_count::<T>(count, name)?;
    let size = *shared(first.cast::<usize>(), name)?;
    check_size::<T>(size, format_args!("{name}[0].struct_size"))?;
    let read = |index| {
        let pointer = first.byte_add(index * size);
        let own = *pointer.cast::<usize>();
        if own != size {
            return invalid(format!(
                "{name}[{index}].struct_size is {own}, and {name}[0].struct_size is {size}: set all of them to sizeof({})",
                T::NAME
            ));
        }
        Ok(copied(pointer, size, default))
    };
    (0..count).map(read).collect()
}

/// Checks that a host's struct is of this version or an older one; `field` names the field with its size, for the
/// message.
fn check_size<T: Versioned>(size: usize, field: fmt::Arguments<'_>) -> Result<()> {
    if is_a_version::<T>(size) && size <= size_of::<T>() {
        return Ok(());
    }
    invalid(format!(
        "{field} is {size}, and this library's {} has {} bytes: set it to sizeof({}), and link a library that is not older \
         than its header",
        T::NAME,
        size_of::<T>(),
        T::NAME,
    ))
}

/// A struct whose first `size` bytes are a host's; the rest is as in `default`.
///
/// # Safety
/// `pointer` points to `size` bytes, no more than a `T` has.
unsafe fn copied<T: Versioned>(pointer: *const T, size: usize, default: T) -> T {
    let mut value = default;
    std::ptr::copy_nonoverlapping(
        pointer.cast::<u8>(),
        std::ptr::from_mut(&mut value).cast(),
        size,
    );
    value
}

/// Writes as much of a struct as the host's has room for.
///
/// # Safety
/// `pointer` is null, or points to `size` bytes that may be overwritten, aligned as a `T`.
pub(crate) unsafe fn write<T: Versioned>(
    pointer: *mut T,
    size: usize,
    value: &T,
    name: &str,
) -> Result<()> {
    if !is_a_version::<T>(size) {
        return invalid(format!("{name} of {size} bytes: give sizeof({})", T::NAME));
    }
    shared(pointer.cast_const().cast::<u8>(), name)?;
    let size = size.min(size_of::<T>());
    std::ptr::copy_nonoverlapping(std::ptr::from_ref(value).cast(), pointer.cast::<u8>(), size);
    pointer.cast::<usize>().write(size);
    Ok(())
}
