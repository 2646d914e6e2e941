//! Handles that were destroyed, that are of another kind, and that two threads use.

use std::ptr::null_mut;
use std::sync::atomic::{AtomicU32, Ordering};

use super::*;
use crate::boundary::*;
use crate::tests::assert_fails;

#[derive(Debug, PartialEq)]
struct Ball(u32);
#[derive(Debug)]
struct Cube;

/// The message of what is refused.
fn refused<T>(result: Result<T>, part: &str) {
    let error = result.err().expect("is refused");
    assert!(matches!(error, Error::Invalid(_)));
    assert!(error.to_string().contains(part), "{error}");
}

#[test]
fn what_was_destroyed_is_known_and_never_comes_again() {
    let mut before = Vec::new();
    for number in 0..100 {
        let handle = add(Ball(number)).expect("a number");
        assert!(!before.contains(&handle), "a number that was destroyed");
        assert_eq!(*alive(handle, "ball").expect("is alive"), Ball(number));
        assert_eq!(destroy(handle), RARA_OK);
        refused(
            alive(handle, "ball"),
            "ball is no Ball that is alive: it was destroyed",
        );
        refused(
            alone(handle, "ball"),
            "ball is no Ball that is alive: it was destroyed",
        );
        assert_fails(destroy(handle), RARA_ERROR_INVALID, "no Ball that is alive");
        before.push(handle);
    }
    assert_eq!(destroy(null_mut::<Ball>()), RARA_OK);
    refused(alive(null_mut::<Ball>(), "ball"), "ball is null");
    refused(alone(null_mut::<Ball>(), "ball"), "ball is null");
    let nowhere = without_provenance_mut::<Ball>(12345);
    refused(alive(nowhere, "ball"), "no function of rara's has made it");
}

#[test]
fn another_kind_of_handle_is_refused() {
    let handle = add(Ball(7)).expect("a number");
    let other = handle.cast::<Cube>();
    refused(alive(other, "cube"), "cube is no Cube that is alive");
    refused(alone(other, "cube"), "cube is no Cube that is alive");
    assert_fails(destroy(other), RARA_ERROR_INVALID, "no Cube that is alive");
    assert_eq!(*alive(handle, "ball").expect("is alive"), Ball(7));
    assert_eq!(destroy(handle), RARA_OK);
}

#[test]
fn what_one_call_changes_others_wait_for() {
    let handle = add(Ball(1)).expect("a number");
    let shared = [alive(handle, "ball"), alive(handle, "ball")];
    let number = handle.addr();
    let waits = || {
        std::thread::spawn(move || {
            let handle = without_provenance_mut::<Ball>(number);
            alone(handle, "ball").expect("the others end").0 += 1;
        })
    };
    let threads: Vec<_> = (0..4).map(|_| waits()).collect();
    assert!(
        shared
            .iter()
            .all(|ball| ball.as_ref().is_ok_and(|ball| ball.0 == 1))
    );
    drop(shared);
    for thread in threads {
        thread.join().expect("it was not refused");
    }
    let mut changed = alone(handle, "ball").expect("nobody uses it");
    assert_eq!(*changed, Ball(5));
    changed.0 = 2;
    // The same thread would wait for itself.
    refused(alive(handle, "ball"), "ball is used by this call already");
    refused(alone(handle, "ball"), "ball is used by this call already");
    drop(changed);
    let kept = alive(handle, "ball").expect("is alive").keep();
    refused(alone(handle, "ball"), "part of something that is alive");
    assert_eq!(*kept, Ball(2));
    drop(kept);
    // A panic while it is changed leaves it to others.
    let panicked = std::panic::catch_unwind(|| {
        let mut changed = alone(handle, "ball").expect("nobody uses it");
        changed.0 = 3;
        panic!("injected");
    });
    assert!(panicked.is_err());
    assert_eq!(*alive(handle, "ball").expect("is alive"), Ball(3));
    assert_eq!(destroy(handle), RARA_OK);
}

#[test]
fn an_object_lives_until_its_last_call_ends() {
    static GONE: AtomicU32 = AtomicU32::new(0);
    struct Counted;
    impl Drop for Counted {
        fn drop(&mut self) {
            GONE.fetch_add(1, Ordering::Relaxed);
        }
    }
    for (gone, changes) in [(1, false), (2, true)] {
        let handle = add(Counted).expect("a number");
        let used: (
            Option<SharedHandle<Counted>>,
            Option<ExclusiveHandle<Counted>>,
        ) = match changes {
            true => (None, alone(handle, "counted").ok()),
            false => (alive(handle, "counted").ok(), None),
        };
        assert_eq!(destroy(handle), RARA_OK);
        refused(alive(handle, "counted"), "no Counted that is alive");
        assert_eq!(GONE.load(Ordering::Relaxed), gone - 1, "a call uses it");
        drop(used);
        assert_eq!(GONE.load(Ordering::Relaxed), gone);
    }
}
