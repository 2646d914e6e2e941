//! Handles: numbers that C sees as pointers, and that are never followed. None is given out twice, so that one that was
//! destroyed is known by its number, as is one of another kind, and one that another thread changes at the same time.

use std::any::{Any, TypeId, type_name};
use std::collections::HashMap;
use std::ops::{Deref, DerefMut};
use std::ptr::without_provenance_mut;
use std::sync::{Arc, LazyLock, Mutex, MutexGuard, PoisonError};

use rara::{Error, Result};

use crate::boundary::{RaraResult, exclusive, guard, invalid};

/// What a handle stands for.
type Object = Arc<dyn Any + Send + Sync>;

/// The objects that are alive.
#[derive(Default)]
struct Handles {
    /// The number that was given out last.
    last: usize,
    /// The objects by their numbers, with their kind; `None` while a thread has the object to itself.
    objects: HashMap<usize, (TypeId, Option<Object>)>,
}

/// Numbers are as far apart as what memory is allocated in, as C expects of pointers.
const STEP: usize = 16;

fn handles() -> MutexGuard<'static, Handles> {
    static HANDLES: LazyLock<Mutex<Handles>> = LazyLock::new(Mutex::default);
    HANDLES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Runs the body of a function that makes a handle: `*out` is null if `make` fails.
pub(crate) unsafe fn create<T: Send + Sync + 'static>(
    out: *mut *mut T,
    name: &str,
    make: impl FnOnce() -> Result<T>,
) -> RaraResult {
    guard(|| {
        let out = exclusive(out, name)?;
        *out = std::ptr::null_mut();
        *out = add(make()?)?;
        Ok(())
    })
}

/// Gives an object a handle.
pub(crate) fn add<T: Send + Sync + 'static>(object: T) -> Result<*mut T> {
    let mut handles = handles();
    let Some(number) = handles.last.checked_add(STEP) else {
        return Err(Error::Memory(
            "this process has made as many handles as there are numbers: start it again".into(),
        ));
    };
    handles.last = number;
    let kind = TypeId::of::<T>();
    handles
        .objects
        .insert(number, (kind, Some(Arc::new(object))));
    Ok(without_provenance_mut(number))
}

/// Ends a handle; null is ignored, and so is what is no handle that is alive, but for the message. The object goes when
/// nothing uses it any more.
pub(crate) fn destroy<T: Send + Sync + 'static>(handle: *mut T) -> RaraResult {
    guard(|| {
        if handle.is_null() {
            return Ok(());
        }
        let mut handles = handles();
        if let Some((kind, _)) = handles.objects.get(&handle.addr()) {
            check_kind::<T>(*kind, "the handle")?;
        }
        let Some(ended) = handles.objects.remove(&handle.addr()) else {
            return not_alive::<T, _>("the handle");
        };
        // What ends with it may call the host, which may come back here.
        drop(handles);
        drop(ended);
        Ok(())
    })
}

/// What a handle stands for, to be used beside others that use it.
pub(crate) fn alive<T: Send + Sync + 'static>(handle: *const T, name: &str) -> Result<Arc<T>> {
    find(handle, name, &mut handles())
        .cloned()?
        .downcast()
        .or_else(|_| not_alive::<T, _>(name))
}

/// What a handle stands for, to be changed by one thread that has it to itself meanwhile.
pub(crate) fn alone<T: Send + Sync + 'static>(
    handle: *mut T,
    name: &str,
) -> Result<ExclusiveHandle<T>> {
    let mut handles = handles();
    find(handle, name, &mut handles)?;
    let place = handles.objects.get_mut(&handle.addr());
    let object = place.and_then(|(_, object)| object.take());
    let object = object.expect("it was found").downcast::<T>();
    let mut object = object.unwrap_or_else(|_| unreachable!("its kind was checked"));
    if Arc::get_mut(&mut object).is_some() {
        let number = handle.addr();
        return Ok(ExclusiveHandle {
            object: Some(object),
            number,
        });
    }
    let kind = TypeId::of::<T>();
    handles.objects.insert(handle.addr(), (kind, Some(object)));
    used_elsewhere(name)
}

/// A number of what a handle stands for; 0 where it is null or not alive.
pub(crate) fn number<T: Send + Sync + 'static, N: Default>(
    handle: *const T,
    name: &str,
    number: impl FnOnce(&T) -> N,
) -> N {
    let mut found = N::default();
    guard(|| {
        found = number(&*alive(handle, name)?);
        Ok(())
    });
    found
}

/// An object that one thread has to itself, until this is dropped.
pub(crate) struct ExclusiveHandle<T: Send + Sync + 'static> {
    /// `None` only while being dropped.
    object: Option<Arc<T>>,
    number: usize,
}

impl<T: Send + Sync> Deref for ExclusiveHandle<T> {
    type Target = T;

    fn deref(&self) -> &T {
        self.object.as_ref().expect("taken only by drop")
    }
}

impl<T: Send + Sync> DerefMut for ExclusiveHandle<T> {
    fn deref_mut(&mut self) -> &mut T {
        let object = self.object.as_mut().expect("taken only by drop");
        Arc::get_mut(object).expect("nobody finds it meanwhile")
    }
}

impl<T: Send + Sync> Drop for ExclusiveHandle<T> {
    fn drop(&mut self) {
        let object = self.object.take().map(|object| object as Object);
        // Its handle may have been destroyed meanwhile: then it goes now, when the lock is free again.
        let ended = match handles().objects.get_mut(&self.number) {
            Some((_, place)) => std::mem::replace(place, object),
            None => object,
        };
        drop(ended);
    }
}

/// The object of a handle, if it is alive, of this kind, and nobody has it to itself.
fn find<'a, T: 'static>(
    handle: *const T,
    name: &str,
    handles: &'a mut Handles,
) -> Result<&'a Object> {
    if handle.is_null() {
        return invalid(format!("{name} is null"));
    }
    match handles.objects.get(&handle.addr()) {
        None => not_alive::<T, _>(name),
        Some((kind, object)) => {
            check_kind::<T>(*kind, name)?;
            match object {
                Some(object) => Ok(object),
                None => used_elsewhere(name),
            }
        }
    }
}

fn check_kind<T: 'static>(kind: TypeId, name: &str) -> Result<()> {
    if kind == TypeId::of::<T>() {
        return Ok(());
    }
    not_alive::<T, _>(name)
}

fn not_alive<T, R>(name: &str) -> Result<R> {
    let kind = type_name::<T>().rsplit("::").next().unwrap_or_default();
    invalid(format!(
        "{name} is no {kind} that is alive: it was destroyed, or no function of rara's has made it"
    ))
}

fn used_elsewhere<R>(name: &str) -> Result<R> {
    invalid(format!(
        "{name} is used by another call, which this one would disturb: let one thread at a time use it"
    ))
}

#[cfg(test)]
mod tests;
