//! Handles: numbers that C sees as pointers, and that are never followed. None is given out twice, so that one that was
//! destroyed is known by its number, as is one of another kind. Calls that would disturb each other take turns.

use std::any::{Any, TypeId, type_name};
use std::collections::HashMap;
use std::ffi::c_void;
use std::ops::{Deref, DerefMut};
use std::ptr::without_provenance_mut;
use std::sync::{Arc, Condvar, LazyLock, Mutex, MutexGuard, PoisonError};
use std::thread::{self, ThreadId};

use rara::{Error, Result};

use crate::boundary::{RaraResult, exclusive, guard, invalid};

/// What a handle stands for.
pub(crate) type Object = Arc<dyn Any + Send + Sync>;

/// The objects that are alive.
#[derive(Default)]
struct Handles {
    /// The number that was given out last.
    last: usize,
    /// The objects by their numbers.
    objects: HashMap<usize, Place>,
}

/// The place of an object.
struct Place {
    kind: TypeId,
    /// `None` while a thread has the object to itself.
    object: Option<Object>,
    /// The thread that has it to itself.
    taken_by: Option<ThreadId>,
    /// How many calls use the object beside each other.
    users: usize,
}

/// Tells those who wait for an object that a call has ended.
static ENDED: Condvar = Condvar::new();

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
    let place = Place {
        kind: TypeId::of::<T>(),
        object: Some(Arc::new(object)),
        taken_by: None,
        users: 0,
    };
    handles.objects.insert(number, place);
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
        if let Some(place) = handles.objects.get(&handle.addr()) {
            check_kind::<T>(place.kind, "the handle")?;
        }
        let Some(ended) = handles.objects.remove(&handle.addr()) else {
            return not_alive::<T, _>("the handle");
        };
        // What ends with it may call the host, which may come back here.
        drop(handles);
        ENDED.notify_all();
        drop(ended);
        Ok(())
    })
}

/// Finds what a handle stands for, to be used beside others that use it. It waits for a call of another thread that changes it.
pub(crate) fn alive<T: Send + Sync + 'static>(
    handle: *const T,
    name: &str,
) -> Result<SharedHandle<T>> {
    let mut handles = wait_for::<T>(handle.addr(), name, |_| true)?;
    let place = handles.place(handle.addr());
    place.users += 1;
    let object = place.object.clone().expect("nobody has it to himself");
    Ok(SharedHandle {
        object: Some(of_its_kind(object)),
        number: handle.addr(),
    })
}

/// Finds what a handle stands for, to be changed by one thread that has it to itself meanwhile. It waits for the calls of other
/// threads that use it.
pub(crate) fn alone<T: Send + Sync + 'static>(
    handle: *mut T,
    name: &str,
) -> Result<ExclusiveHandle<T>> {
    let mut handles = wait_for::<T>(handle.addr(), name, |place| place.users == 0)?;
    let place = handles.place(handle.addr());
    // Something else may have kept it.
    let is_kept = place.object.as_mut().and_then(Arc::get_mut).is_none();
    if is_kept {
        return used_elsewhere(name);
    }
    place.taken_by = Some(thread::current().id());
    Ok(ExclusiveHandle {
        object: place.object.take().map(of_its_kind),
        number: handle.addr(),
    })
}

/// Ends a handle of any kind but `Other`, when no call uses it any more, and returns what it stood for.
pub(crate) fn end<Other: 'static>(handle: *mut c_void, name: &str) -> Result<Object> {
    let is_other = |place: &Place| place.kind == TypeId::of::<Other>();
    if handles().objects.get(&handle.addr()).is_some_and(is_other) {
        return invalid(format!("{name} is a {}", kind_name::<Other>()));
    }
    let mut handles = wait_for::<dyn Any>(handle.addr(), name, |place| place.users == 0)?;
    let place = handles.objects.remove(&handle.addr());
    drop(handles);
    ENDED.notify_all();
    let object = place.and_then(|place| place.object);
    Ok(object.expect("it was found, and nobody has it to himself"))
}

/// Waits until a handle's object is in its place, and ready.
fn wait_for<T: ?Sized + 'static>(
    number: usize,
    name: &str,
    is_ready: impl Fn(&Place) -> bool,
) -> Result<MutexGuard<'static, Handles>> {
    if number == 0 {
        return invalid(format!("{name} is null"));
    }
    let mut handles = handles();
    loop {
        let Some(place) = handles.objects.get(&number) else {
            return not_alive::<T, _>(name);
        };
        check_kind::<T>(place.kind, name)?;
        if place.object.is_some() && is_ready(place) {
            return Ok(handles);
        }
        if place.taken_by == Some(thread::current().id()) {
            return used_elsewhere(name); // it would wait for itself
        }
        handles = ENDED.wait(handles).unwrap_or_else(PoisonError::into_inner);
    }
}

impl Handles {
    /// The place of a number that was found.
    fn place(&mut self, number: usize) -> &mut Place {
        self.objects.get_mut(&number).expect("it was found")
    }
}

fn of_its_kind<T: Send + Sync + 'static>(object: Object) -> Arc<T> {
    let object = object.downcast::<T>();
    object.unwrap_or_else(|_| unreachable!("its kind was checked"))
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

/// An object that is used beside others that use it, until this is dropped.
#[derive(Debug)]
pub(crate) struct SharedHandle<T: Send + Sync + 'static> {
    /// `None` only while being dropped.
    object: Option<Arc<T>>,
    number: usize,
}

impl<T: Send + Sync> SharedHandle<T> {
    /// The object, for longer than the call.
    pub(crate) fn keep(self) -> Arc<T> {
        self.object.clone().expect("taken only by drop")
    }
}

impl<T: Send + Sync> Deref for SharedHandle<T> {
    type Target = T;

    fn deref(&self) -> &T {
        self.object.as_ref().expect("taken only by drop")
    }
}

impl<T: Send + Sync> Drop for SharedHandle<T> {
    fn drop(&mut self) {
        let mut handles = handles();
        if let Some(place) = handles.objects.get_mut(&self.number) {
            place.users -= 1;
            self.object = None; // the place has it too
        }
        drop(handles);
        ENDED.notify_all();
    }
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
            Some(place) => {
                place.taken_by = None;
                std::mem::replace(&mut place.object, object)
            }
            None => object,
        };
        ENDED.notify_all();
        drop(ended);
    }
}

/// Refuses a handle of another kind than `T`, which may be that of any handle.
fn check_kind<T: ?Sized + 'static>(kind: TypeId, name: &str) -> Result<()> {
    if [kind, TypeId::of::<dyn Any>()].contains(&TypeId::of::<T>()) {
        return Ok(());
    }
    not_alive::<T, _>(name)
}

fn kind_name<T: ?Sized + 'static>() -> &'static str {
    match TypeId::of::<T>() == TypeId::of::<dyn Any>() {
        true => "handle",
        false => type_name::<T>().rsplit("::").next().unwrap_or_default(),
    }
}

fn not_alive<T: ?Sized + 'static, R>(name: &str) -> Result<R> {
    let kind = kind_name::<T>();
    invalid(format!(
        "{name} is no {kind} that is alive: it was destroyed, or no function of rara's has made it"
    ))
}

fn used_elsewhere<R>(name: &str) -> Result<R> {
    invalid(format!(
        "{name} is used by this call already, or is part of something that is alive"
    ))
}

#[cfg(test)]
mod tests;
