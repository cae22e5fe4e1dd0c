//! Ctrl-C: asked for, not obeyed at once, so that servos can be let go first. A second one ends the program outright.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether the user wants to stop.
#[derive(Debug, Clone, Default)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// From now on.
    pub fn listen() -> Self {
        let interrupt = Interrupt::default();
        #[cfg(unix)]
        for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
            // The order matters: the first signal finds the flag false, sets it, and only the next one ends the program.
            // What cannot be registered leaves the system's own way, which ends the program at once.
            let _ =
                signal_hook::flag::register_conditional_shutdown(signal, 130, interrupt.0.clone());
            let _ = signal_hook::flag::register(signal, interrupt.0.clone());
        }
        interrupt
    }

    /// Whether it has come.
    pub fn has_come(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
