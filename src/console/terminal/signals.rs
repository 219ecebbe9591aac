//! Signals as flags: what the system asks of a process that has the screen.

use signal_hook::consts::{SIGCONT, SIGHUP, SIGTERM, SIGTSTP, SIGUSR1};
use signal_hook::{flag, low_level};
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// The signals that came.
#[derive(Debug)]
pub(super) struct Signals {
    terminate: Arc<AtomicBool>,
    hang_up: Arc<AtomicBool>,
    suspend: Arc<AtomicBool>,
    resumed: Arc<AtomicBool>,
    reload: Arc<AtomicBool>,
    registered: Vec<signal_hook::SigId>,
}

impl Signals {
    /// Catches the signals from now on.
    pub(super) fn register() -> io::Result<Self> {
        let mut registered = Vec::new();
        let mut catch = |signal| -> io::Result<Arc<AtomicBool>> {
            let raised = Arc::new(AtomicBool::new(false));
            registered.push(flag::register(signal, Arc::clone(&raised))?);
            Ok(raised)
        };
        let (terminate, hang_up) = (catch(SIGTERM)?, catch(SIGHUP)?);
        let (suspend, resumed) = (catch(SIGTSTP)?, catch(SIGCONT)?);
        let reload = catch(SIGUSR1)?;
        Ok(Self { terminate, hang_up, suspend, resumed, reload, registered })
    }

    /// True where the process was told to end.
    pub(super) fn terminated(&self) -> bool {
        self.terminate.load(Ordering::Relaxed)
    }

    /// True where the terminal went away.
    pub(super) fn hung_up(&self) -> bool {
        self.hang_up.load(Ordering::Relaxed)
    }

    /// True once for each time that the process was asked to stop for the shell.
    pub(super) fn take_suspend(&self) -> bool {
        self.suspend.swap(false, Ordering::Relaxed)
    }

    /// True once for each time that the process was continued.
    pub(super) fn take_resumed(&self) -> bool {
        self.resumed.swap(false, Ordering::Relaxed)
    }

    /// True once for each time that the configuration is to be read again.
    pub(super) fn take_reload(&self) -> bool {
        self.reload.swap(false, Ordering::Relaxed)
    }

    /// Stops this process until the shell continues it.
    pub(super) fn sleep_for_the_shell() {
        // Where the process cannot be stopped, it simply goes on.
        let _ = low_level::raise(signal_hook::consts::SIGSTOP);
    }
}

impl Drop for Signals {
    fn drop(&mut self) {
        for id in self.registered.drain(..) {
            low_level::unregister(id);
        }
    }
}
