//! Sharing work between threads.
//!
//! A system can refuse to start a thread, for example in a container that limits processes. The calling
//! thread then does the work: only time is lost.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::{Builder, scope};

/// Calls a function that takes work from a queue until the queue is empty, on at most `count` threads
/// including the calling one, and returns the results.
pub fn share<R: Send>(count: usize, work: impl Fn() -> R + Sync) -> Vec<R> {
    share_with(count, &Builder::new, work)
}

/// Returns the results of a function on each item, in the order of the items, computed on at most `count`
/// threads.
pub fn each<T: Sync, R: Send>(count: usize, items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let some = || {
        let taken = std::iter::from_fn(|| {
            let index = next.fetch_add(1, Ordering::Relaxed);
            Some((index, items.get(index)?))
        });
        taken
            .map(|(index, item)| (index, work(item)))
            .collect::<Vec<_>>()
    };
    let mut done: Vec<_> = share(count.min(items.len()), some)
        .into_iter()
        .flatten()
        .collect();
    done.sort_unstable_by_key(|(index, _)| *index);
    done.into_iter().map(|(_, result)| result).collect()
}

/// Returns the results of two functions. The first one runs on another thread if the system grants one.
pub fn join<A: Send, B>(aside: impl Fn() -> A + Sync, here: impl FnOnce() -> B) -> (A, B) {
    scope(|scope| {
        let started = Builder::new().spawn_scoped(scope, &aside);
        let here = here();
        let aside = match started {
            Ok(thread) => thread.join().unwrap_or_else(|panic| resume_unwind(panic)),
            Err(_) => aside(),
        };
        (aside, here)
    })
}

fn share_with<R: Send>(
    count: usize,
    builder: &dyn Fn() -> Builder,
    work: impl Fn() -> R + Sync,
) -> Vec<R> {
    scope(|scope| {
        let others: Vec<_> = (1..count)
            .map_while(|_| builder().spawn_scoped(scope, &work).ok())
            .collect();
        let mut done = vec![work()];
        for other in others {
            done.push(other.join().unwrap_or_else(|panic| resume_unwind(panic)));
        }
        done
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_keep_the_order_of_their_items() {
        for n in [0, 1, 2, 1000] {
            let numbers: Vec<usize> = (0..n).collect();
            let double: Vec<usize> = numbers.iter().map(|i| 2 * i).collect();
            assert_eq!(each(4, &numbers, |i| 2 * i), double);
        }
        assert_eq!(join(|| 1, || 2), (1, 2));
    }

    #[test]
    #[should_panic(expected = "the last one")]
    fn a_panic_is_passed_on() {
        let numbers: Vec<usize> = (0..100).collect();
        each(4, &numbers, |i| assert!(*i < 99, "the last one"));
    }

    #[test]
    fn the_calling_thread_does_all_work_if_there_are_no_others() {
        // No system can provide a stack of this size.
        let refused = || Builder::new().stack_size(usize::MAX / 4);
        assert!(refused().spawn(|| ()).is_err());
        let left = AtomicUsize::new(100);
        let work = || {
            let mut taken = 0;
            while left
                .fetch_update(Ordering::Relaxed, Ordering::Relaxed, |n| n.checked_sub(1))
                .is_ok()
            {
                taken += 1;
            }
            taken
        };
        assert_eq!(share_with(8, &refused, work), [100]);
    }
}
