//! Ctrl-C.

use std::sync::atomic::{AtomicBool, Ordering};

/// What a shell calls "ended by SIGINT".
pub const EXIT_CODE: u8 = 130;

static GRACEFUL: AtomicBool = AtomicBool::new(false);
static REQUESTED: AtomicBool = AtomicBool::new(false);

/// Takes over SIGINT, SIGTERM and SIGHUP. Outside [`gracefully`], and at the second signal within it, the process ends
/// at once.
pub fn install() {
    // Where no handler can be installed the system's own ends the process, which is what would be done anyway.
    let _ = ctrlc::set_handler(|| {
        if !GRACEFUL.load(Ordering::SeqCst) || REQUESTED.swap(true, Ordering::SeqCst) {
            crate::numeric::file::remove_transient_files();
            eprintln!("interrupted");
            std::process::exit(EXIT_CODE.into());
        }
    });
}

/// Whether an end was asked for.
pub fn requested() -> bool {
    REQUESTED.load(Ordering::SeqCst)
}

/// Runs work that asks [`requested`] itself and ends in good order.
pub fn gracefully<T>(work: impl FnOnce() -> T) -> T {
    GRACEFUL.store(true, Ordering::SeqCst);
    let done = work();
    GRACEFUL.store(false, Ordering::SeqCst);
    done
}
