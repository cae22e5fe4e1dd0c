//! Ctrl-C: the first is asked for, not obeyed at once, so that servos can be let go in order. A
//! second one ends the program at once; if servos may hold torque by then, the last thing on the
//! line is that they let go.

use handstand::fitting::StopSwitch;
use handstand::link::record::EmergencyOff;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

/// Whether the user wants to stop.
#[derive(Clone, Default)]
pub struct Interrupt {
    come: Arc<AtomicBool>,
    accepts: StopSwitch,
    emergency_off: Arc<Mutex<Option<EmergencyOff>>>,
}

impl Interrupt {
    /// From now on.
    pub fn listen() -> Self {
        let interrupt = Interrupt::default();
        #[cfg(unix)]
        interrupt.clone().wait();
        interrupt
    }

    /// From now on; the first one accepts what work has found by then.
    pub fn accepting(switch: &StopSwitch) -> Self {
        let interrupt = Interrupt {
            accepts: switch.clone(),
            ..Interrupt::default()
        };
        #[cfg(unix)]
        interrupt.clone().wait();
        interrupt
    }

    /// What a second Ctrl-C does before it ends the program with exit code 5.
    pub fn at_once(&self, emergency_off: Option<EmergencyOff>) {
        if let Ok(mut slot) = self.emergency_off.lock() {
            *slot = emergency_off;
        }
    }

    /// Whether it has come.
    pub fn has_come(&self) -> bool {
        self.come.load(Ordering::Relaxed)
    }

    #[cfg(unix)]
    fn wait(self) {
        use signal_hook::consts::{SIGINT, SIGTERM};
        use signal_hook::iterator::Signals;
        // What cannot be registered leaves the system's own way, which ends the program at once.
        let Ok(mut signals) = Signals::new([SIGINT, SIGTERM]) else {
            return;
        };
        std::thread::spawn(move || {
            for _ in signals.forever() {
                if self.come.swap(true, Ordering::Relaxed) {
                    self.end();
                }
                self.accepts.accept();
            }
        });
    }

    #[cfg(unix)]
    fn end(&self) {
        let emergency_off = self
            .emergency_off
            .lock()
            .ok()
            .and_then(|mut slot| slot.take());
        match emergency_off {
            Some(emergency_off) => {
                emergency_off();
                std::process::exit(i32::from(super::ExitStatus::Stopped.exit_code()));
            }
            // As the shell counts a program that a signal ended.
            None => std::process::exit(130),
        }
    }
}
