//! The last resort around a third-party reader: a panic in it becomes an error of the file that caused it.
//!
//! Files are checked first wherever that is possible. What is left (a broken file that a crate answers with a panic)
//! must still end in one line and exit code 2, so the panic is caught and its message kept off stderr. The hook is
//! installed once and silent only on a thread that is inside `guarded`; every other panic is reported as before.

use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe};
use std::path::Path;
use std::sync::Once;

use crate::error::InputError;

thread_local! {
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}

static HOOK: Once = Once::new();

/// Runs a reader; a panic is an error that carries the panic's message.
pub(super) fn guarded<T>(file: &Path, read: impl FnOnce() -> T) -> Result<T, InputError> {
    HOOK.call_once(|| {
        let before = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if !INSIDE.get() {
                before(info);
            }
        }));
    });
    INSIDE.set(true);
    let result = panic::catch_unwind(AssertUnwindSafe(read));
    INSIDE.set(false);
    result.map_err(|payload| {
        let text = payload
            .downcast_ref::<String>()
            .map(String::as_str)
            .or_else(|| payload.downcast_ref::<&str>().copied())
            .unwrap_or("no message");
        InputError::in_file(file, format!("the file is broken in a way that stops its reader: {text}"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_an_error_of_the_file() {
        let e = guarded(Path::new("m.x"), || "x".parse::<u8>().ok().unwrap()).unwrap_err().to_string();
        assert!(e.starts_with("m.x: the file is broken") && e.contains("None"), "{e}");
        assert_eq!(guarded(Path::new("m.x"), || 7), Ok(7));
        assert!(!INSIDE.get());
    }
}
