//! Ctrl-C and SIGTERM: what is done is finished and kept, the exit code says which it was. A second one
//! ends the program at once.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag::{register, register_conditional_shutdown, register_usize};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Whether the user or the system wants the program to end.
#[derive(Clone)]
pub struct Stop {
    /// Whether there is nothing to finish yet.
    at_once: Arc<AtomicBool>,
    asked: Arc<AtomicBool>,
    by: Arc<AtomicUsize>,
}

impl Stop {
    /// From here on signals do not end the program at once.
    pub fn listen() -> anyhow::Result<Self> {
        let stop = Self::prepare()?;
        stop.finish_from_here();
        Ok(stop)
    }

    /// Signals end the program at once, by the exit codes that they have later too, until there is something to finish.
    pub fn prepare() -> anyhow::Result<Self> {
        let stop = Self {
            at_once: Arc::new(AtomicBool::new(true)),
            asked: Arc::default(),
            by: Arc::default(),
        };
        for signal in [SIGINT, SIGTERM] {
            register_conditional_shutdown(signal, exit_code(signal), Arc::clone(&stop.at_once))?;
            // In this order: the first one finds the flag not set.
            register_conditional_shutdown(signal, exit_code(signal), Arc::clone(&stop.asked))?;
            register_usize(signal, Arc::clone(&stop.by), signal as usize)?;
            register(signal, Arc::clone(&stop.asked))?;
        }
        Ok(stop)
    }

    /// From here on the first signal only asks.
    pub fn finish_from_here(&self) {
        self.at_once.store(false, Ordering::SeqCst);
    }

    pub fn asked(&self) -> &AtomicBool {
        &self.asked
    }

    /// The exit code, once there was a signal: 128 and its number.
    pub fn code(&self) -> Option<u8> {
        let by = self.by.load(Ordering::Relaxed);
        (by != 0).then(|| exit_code(by as i32) as u8)
    }
}

fn exit_code(signal: i32) -> i32 {
    128 + signal
}
