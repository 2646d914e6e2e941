//! Work on all cores.

use std::panic::resume_unwind;
use std::sync::mpsc::{Receiver, TrySendError, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::thread;

/// Threads that work at once.
pub fn threads() -> usize {
    thread::available_parallelism().map_or(1, usize::from)
}

/// Returns the results of `work` in the order of the tasks, whichever thread did which. The calling thread takes one task
/// after the other from `tasks`, which may read them from a file, and works where the others have enough to do; only a
/// few tasks are in memory at a time.
pub fn in_parallel<T: Send, R: Send>(
    tasks: impl IntoIterator<Item = T>,
    work: impl Fn(T) -> R + Sync,
) -> Vec<R> {
    let helpers = threads() - 1;
    let (queue, waiting) = sync_channel(2 * helpers);
    let waiting = Mutex::new(waiting);
    let mut done = Vec::new();
    thread::scope(|scope| {
        let mut workers = Vec::new();
        for task in tasks.into_iter().enumerate() {
            match queue.try_send(task) {
                Ok(()) if workers.len() < helpers => {
                    workers.push(scope.spawn(|| all_waiting(&waiting, &work)));
                }
                Ok(()) => {}
                Err(TrySendError::Full((at, task)) | TrySendError::Disconnected((at, task))) => {
                    done.push((at, work(task)));
                }
            }
        }
        drop(queue);
        done.extend(all_waiting(&waiting, &work));
        for worker in workers {
            done.extend(worker.join().unwrap_or_else(|panic| resume_unwind(panic)));
        }
    });
    done.sort_unstable_by_key(|(at, _)| *at);
    done.into_iter().map(|(_, result)| result).collect()
}

/// Does the tasks of a queue, until there are none and none will come.
fn all_waiting<T, R>(
    waiting: &Mutex<Receiver<(usize, T)>>,
    work: impl Fn(T) -> R,
) -> Vec<(usize, R)> {
    let next = || {
        let waiting = waiting.lock().unwrap_or_else(PoisonError::into_inner);
        waiting.recv().ok()
    };
    std::iter::from_fn(next)
        .map(|(at, task)| (at, work(task)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_in_the_order_of_the_tasks() {
        let squares = in_parallel(0..10_000_u64, |number| number * number);
        assert!(squares.into_iter().eq((0..10_000).map(|n| n * n)));
        assert!(in_parallel(0..0, |number: i32| number).is_empty());
    }

    #[test]
    fn tasks_may_be_places_to_write_to() {
        let mut places = [0; 1000];
        in_parallel(places.chunks_mut(7).enumerate(), |(number, chunk)| {
            chunk.fill(number);
        });
        assert!((0..1000).all(|at| places[at] == at / 7));
    }

    #[test]
    #[should_panic(expected = "the seventh")]
    fn a_panic_of_a_task_is_one_of_the_caller() {
        in_parallel(0..100, |number| assert_ne!(number, 7, "the seventh"));
    }
}
