//! Simulated serial ports as links.

use crate::SerialLink;
use crate::error::Result;
use handstand_cm5_sim::{AdapterPort, SimulatedPort};
use std::time::Duration;

/// A simulated serial port as a link, in simulated time.
#[derive(Debug)]
pub struct SimLink<P>(pub P);

impl SimLink<AdapterPort> {
    /// An adapter on the bus that `spec` describes, such as `ids=1-3,delay=0,dead=2`, without a
    /// robot.
    ///
    /// # Errors
    /// [`crate::error::Error::Usage`] where the text describes no bus.
    pub fn adapter(spec: &str) -> Result<Self> {
        Ok(SimLink(AdapterPort::new(super::spec(spec)?.bus())))
    }
}

impl<P: SimulatedPort> SerialLink for SimLink<P> {
    fn name(&self) -> &str {
        self.0.name()
    }

    fn baud(&self) -> u32 {
        self.0.baud()
    }

    fn set_baud(&mut self, baud: u32) -> Result<()> {
        self.0.set_baud(baud);
        Ok(())
    }

    fn send(&mut self, bytes: &[u8]) -> Result<()> {
        self.0.send(bytes);
        Ok(())
    }

    fn receive(&mut self, bytes: &mut [u8], wait: Duration) -> Result<usize> {
        Ok(self.0.receive(bytes, wait))
    }

    fn clear(&mut self) -> Result<()> {
        self.0.clear();
        Ok(())
    }

    fn now(&self) -> Duration {
        self.0.now()
    }

    fn pause(&mut self, time: Duration) {
        self.0.pause(time);
    }

    fn latency(&self) -> Duration {
        self.0.latency()
    }
}
