//! Several cases at a time, each on threads of its own.

use rayon::ThreadPoolBuilder;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Tries all cases, `jobs` at a time, sharing `threads` threads out among them; results in the
/// order of the cases, whatever these numbers are.
pub fn try_each<C: Sync, R: Send>(
    cases: &[C],
    [jobs, threads]: [usize; 2],
    try_one: &(dyn Fn(&C) -> R + Sync),
) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let found: Mutex<Vec<(usize, R)>> = Mutex::new(Vec::new());
    let each = (threads / jobs.max(1)).max(1);
    std::thread::scope(|scope| {
        for _ in 0..jobs.max(1) {
            scope.spawn(|| {
                // A pool of its own: diagnoses that share one steal each other's work, and their
                // times mean nothing.
                let pool = ThreadPoolBuilder::new().num_threads(each).build().ok();
                loop {
                    let index = next.fetch_add(1, Ordering::SeqCst);
                    let Some(case) = cases.get(index) else {
                        break;
                    };
                    let result = match &pool {
                        Some(pool) => pool.install(|| try_one(case)),
                        None => try_one(case),
                    };
                    if let Ok(mut found) = found.lock() {
                        found.push((index, result));
                    }
                }
            });
        }
    });
    let mut found = found
        .into_inner()
        .unwrap_or_else(|broken| broken.into_inner());
    found.sort_by_key(|(index, _)| *index);
    found.into_iter().map(|(_, result)| result).collect()
}
