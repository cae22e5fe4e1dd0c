//! A pseudo terminal: a serial port that any program can open, with this program behind it.

use crate::error::{Error, Result};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::OFlags;
use rustix::io::Errno;
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};
use std::os::fd::OwnedFd;
use std::time::Duration;

/// The side of a pseudo terminal that plays the device.
#[derive(Debug)]
pub struct Pty {
    master: OwnedFd,
    /// Held open, so that programs may come and go.
    slave: OwnedFd,
    name: String,
}

impl Pty {
    /// A new one.
    ///
    /// # Errors
    /// The system has none left.
    pub fn open() -> Result<Pty> {
        let refused =
            |errno: Errno| Error::file("/dev/ptmx", "open a pseudo terminal at", errno.into());
        let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)
            .map_err(refused)?;
        grantpt(&master)
            .and_then(|()| unlockpt(&master))
            .map_err(refused)?;
        let name = ptsname(&master, Vec::new()).map_err(refused)?;
        let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC;
        let slave = rustix::fs::open(&*name, flags, rustix::fs::Mode::empty()).map_err(refused)?;
        // A terminal would echo and rewrite; a serial line does not.
        let mut settings = tcgetattr(&slave).map_err(refused)?;
        settings.make_raw();
        tcsetattr(&slave, OptionalActions::Now, &settings).map_err(refused)?;
        rustix::io::ioctl_fionbio(&master, true).map_err(refused)?;
        Ok(Pty {
            master,
            slave,
            name: name.to_string_lossy().into_owned(),
        })
    }

    /// What programs open: `/dev/pts/3`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The speed the program at the other end has set, baud.
    pub fn baud(&self) -> u32 {
        tcgetattr(&self.slave).map_or(0, |settings| settings.output_speed())
    }

    /// Waits at most `wait` for bytes; how many came.
    ///
    /// # Errors
    /// The system refuses.
    pub fn receive(&self, bytes: &mut [u8], wait: Duration) -> Result<usize> {
        let wait = Timespec {
            tv_sec: wait.as_secs() as _,
            tv_nsec: wait.subsec_nanos() as _,
        };
        let mut waiting = [PollFd::new(&self.master, PollFlags::IN)];
        match poll(&mut waiting, Some(&wait)) {
            Ok(0) | Err(Errno::INTR) => return Ok(0),
            Ok(_) => {}
            Err(errno) => return Err(self.failed(errno)),
        }
        match rustix::io::read(&self.master, bytes) {
            Ok(count) => Ok(count),
            Err(Errno::AGAIN | Errno::INTR | Errno::IO) => Ok(0),
            Err(errno) => Err(self.failed(errno)),
        }
    }

    /// Sends bytes; what a program does not fetch for too long is lost, as on a line.
    ///
    /// # Errors
    /// The system refuses.
    pub fn send(&self, mut bytes: &[u8]) -> Result<()> {
        while !bytes.is_empty() {
            match rustix::io::write(&self.master, bytes) {
                Ok(count) => bytes = &bytes[count..],
                Err(Errno::INTR) => {}
                Err(Errno::AGAIN | Errno::IO) => return Ok(()),
                Err(errno) => return Err(self.failed(errno)),
            }
        }
        Ok(())
    }

    fn failed(&self, errno: Errno) -> Error {
        Error::device(
            format!("{}: {}", self.name, std::io::Error::from(errno)),
            "start it again",
        )
    }
}
