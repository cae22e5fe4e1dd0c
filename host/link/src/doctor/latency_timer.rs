//! An adapter that holds bytes back: the latency timer of FTDI chips, 16 ms as delivered.

use super::{Cause, cause};
use std::path::Path;
use std::time::Duration;

/// What exchanges take whatever their length, where the timer is at its 16 ms.
const HELD_BACK: std::ops::Range<Duration> = Duration::from_millis(14)..Duration::from_millis(18);

/// The device's own name behind a port, `ttyUSB0`, also where the port is a link to it, as those in
/// `/dev/serial/by-id` and of udev's rules are.
fn device_name(port: &str) -> Option<String> {
    let own = Path::new(port).canonicalize().ok()?;
    Some(own.file_name()?.to_str()?.to_string())
}

/// The timer of the adapter behind this port, ms; none where there is none, or on other systems.
fn timer_ms(port: &str) -> Option<u32> {
    let name = device_name(port)?;
    let file = format!("/sys/class/tty/{name}/device/latency_timer");
    std::fs::read_to_string(file).ok()?.trim().parse().ok()
}

/// The cause, if the adapter on `port` holds bytes back; `pings` are round trips of pings.
pub(super) fn held_back(port: &str, mut pings: Vec<Duration>) -> Option<Cause> {
    pings.sort_unstable();
    let median = pings.get(pings.len() / 2).copied().unwrap_or_default();
    let timer_ms = timer_ms(port);
    if timer_ms.is_none_or(|ms| ms < 2) && !HELD_BACK.contains(&median) {
        return None;
    }
    let seen = match timer_ms {
        Some(ms) => format!("its latency timer is {ms} ms"),
        None => "answers take as long whatever their length".to_string(),
    };
    let name = device_name(port).unwrap_or("ttyUSB0".to_string());
    let median_ms = median.as_secs_f64() * 1e3;
    Some(cause(
        0.3,
        "the adapter holds answers back: about 60 exchanges a second at any speed",
        format!("{seen}; half of the pings took more than {median_ms:.1} ms"),
        format!("echo 1 | sudo tee /sys/bus/usb-serial/devices/{name}/latency_timer"),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn the_command_names_the_device_behind_a_link() {
        let folder = tempfile::tempdir().unwrap();
        let (device, link) = (
            folder.path().join("ttyUSB7"),
            folder.path().join("usb-FTDI-if00"),
        );
        std::fs::write(&device, "").unwrap();
        std::os::unix::fs::symlink(&device, &link).unwrap();
        let pings = vec![Duration::from_millis(16); 5];
        let cause = held_back(link.to_str().unwrap(), pings).unwrap();
        let command = "echo 1 | sudo tee /sys/bus/usb-serial/devices/ttyUSB7/latency_timer";
        assert_eq!(cause.remedy, command);
    }

    #[test]
    fn answers_that_take_16_ms_are_held_back() {
        let pings = |ms| vec![Duration::from_millis(ms); 5];
        assert!(held_back("/dev/none", pings(16)).is_some());
        assert!(held_back("/dev/none", pings(1)).is_none());
        assert!(held_back("/dev/none", pings(30)).is_none());
        assert!(held_back("/dev/none", Vec::new()).is_none());
    }
}
