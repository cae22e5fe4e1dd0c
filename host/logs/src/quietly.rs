//! Panics of a library that reads what others wrote: the file is broken, and no more is printed.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

thread_local! {
    static IS_QUIET: Cell<bool> = const { Cell::new(false) };
}

/// What `read` gives, none where it panics; the panic is not printed. All others go to the hook
/// that was there at the first call.
pub(super) fn quietly_caught<T>(read: impl FnOnce() -> T) -> Option<T> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let others = take_hook();
        set_hook(Box::new(move |info| {
            if !IS_QUIET.get() {
                others(info)
            }
        }));
    });
    let before = IS_QUIET.replace(true);
    let read = catch_unwind(AssertUnwindSafe(read));
    IS_QUIET.set(before);
    read.ok()
}

#[cfg(test)]
mod tests {
    use super::quietly_caught;
    use std::process::Command;

    const CHILD: &str = "HANDSTAND_TEST_QUIETLY";

    /// In a process of its own: the hook is one for all tests.
    #[test]
    fn a_panic_that_is_caught_is_not_printed_and_others_are() {
        if std::env::var_os(CHILD).is_some() {
            assert_eq!(quietly_caught(|| 3), Some(3));
            assert_eq!(
                quietly_caught(|| -> i32 { panic!("within the reader") }),
                None
            );
            let other = std::thread::spawn(|| panic!("anywhere else"));
            assert!(other.join().is_err());
            return;
        }
        let tests = std::env::current_exe().unwrap();
        let name = "quietly::tests::a_panic_that_is_caught_is_not_printed_and_others_are";
        let ran = Command::new(tests)
            .args([name, "--exact", "--nocapture"])
            .env(CHILD, "1")
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&ran.stderr);
        assert!(ran.status.success(), "{said}");
        assert!(!said.contains("within the reader"), "{said}");
        assert!(said.contains("anywhere else"), "{said}");
    }
}
