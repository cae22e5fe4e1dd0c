//! Twenty readings of what differs between any two servos: position, load, temperature. Two of one
//! id that left the factory alike answer a ping with the same bytes, and a reading with others.

use super::super::port::SerialLink;
use super::super::protocol::Protocol;
use super::super::servo_error::ServoError;
use super::super::servos::Servos;
use crate::error::Result;
use handstand_shared::control_table::{Item, PRESENT_POSITION, PRESENT_TEMPERATURE, x};
use serde::Serialize;

/// How often each servo is read.
pub(super) const READINGS: usize = 20;
/// A shaft's angle does not jump by so many codes and back within a few readings.
const APART_CODES: i32 = 40;
/// Nor its temperature by so many degrees.
const APART_CELSIUS: i32 = 3;
/// So many jumps between two values and nothing between are no motion.
const JUMPS: usize = 4;

/// Answers of one servo to twenty readings.
#[derive(Debug, Clone, Default, Serialize)]
pub struct ReadTest {
    /// Sound answers.
    pub answered: usize,
    /// Bytes, but no sound answer.
    pub garbled: usize,
    /// Sound answers with more bytes behind them.
    pub doubled: usize,
    /// What jumped between two values, as it does between two servos.
    pub apart: Option<String>,
}

impl ReadTest {
    /// Whether two servos answer.
    pub fn is_twice(&self) -> bool {
        2 * (self.garbled + self.doubled) > READINGS || self.apart.is_some()
    }

    /// What was seen that says so.
    pub fn evidence(&self) -> String {
        let (garbled, doubled) = (self.garbled, self.doubled);
        let apart = self.apart.as_ref();
        let apart = apart.map_or(String::new(), |apart| format!("; {apart}"));
        format!("of {READINGS} readings {garbled} were garbled, {doubled} came double{apart}")
    }
}

/// Reads servo `id`; nothing of one whose model is not known in Protocol 2.0.
///
/// # Errors
/// The port failed.
pub fn read_test<L: SerialLink>(servos: &mut Servos<L>, id: u8) -> Result<ReadTest> {
    let mut test = ReadTest::default();
    let [position, temperature] = match servos.current() {
        // The same in every model.
        Protocol::One => [PRESENT_POSITION, PRESENT_TEMPERATURE].map(|r| Item::of_register(&r)),
        Protocol::Two => match servos.model(id) {
            Ok(_) => [x::PRESENT_POSITION, x::PRESENT_TEMPERATURE],
            Err(error) => {
                error.port()?;
                return Ok(test);
            }
        },
    };
    let first = position.address;
    let count = temperature.address + 1 - first;
    let (mut positions, mut temperatures) = (Vec::new(), Vec::new());
    let tries = std::mem::replace(&mut servos.tries, 1);
    for _ in 0..READINGS {
        match servos.read(id, first, count) {
            Ok(reading) => {
                test.answered += 1;
                test.doubled += usize::from(servos.surplus() > 0 || servos.stragglers()? > 0);
                let code = |item: &Item| {
                    let from = usize::from(item.address - first);
                    let bytes = reading.data.get(from..from + usize::from(item.size));
                    bytes.and_then(|bytes| item.code(bytes))
                };
                positions.extend(code(&position));
                temperatures.extend(code(&temperature));
            }
            Err(ServoError::Port(error)) => return Err(error),
            Err(ServoError::NoResponse { .. }) => {}
            Err(_) => test.garbled += 1,
        }
    }
    servos.tries = tries;
    let of_position = two_values(&positions, APART_CODES)
        .map(|(a, b)| format!("its position jumps between codes {a} and {b}"));
    let of_temperature = two_values(&temperatures, APART_CELSIUS)
        .map(|(a, b)| format!("its temperature jumps between {a} and {b} C"));
    test.apart = of_position.or(of_temperature);
    Ok(test)
}

/// Two values at least `apart` between which these jump to and fro, with none in the gap.
fn two_values(values: &[i32], apart: i32) -> Option<(i32, i32)> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable();
    let gap = sorted.windows(2).max_by_key(|pair| pair[1] - pair[0])?;
    let (low, high) = (gap[0], gap[1]);
    let jumps = values
        .windows(2)
        .filter(|pair| (pair[0] <= low) != (pair[1] <= low));
    (high - low >= apart && jumps.count() >= JUMPS).then_some((low, high))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jumps_to_and_fro_are_two_servos_and_motions_are_not() {
        let of = |of: &dyn Fn(i32) -> i32| two_values(&(0..20).map(of).collect::<Vec<_>>(), 40);
        assert_eq!(of(&|k| 500 + 200 * (k % 2)), Some((500, 700)));
        assert_eq!(
            of(&|k| if k % 5 == 0 { 300 } else { 500 + k % 3 }),
            Some((300, 500))
        );
        // A steady turn, a single jump, noise, a shaft that is shaken.
        assert_eq!(of(&|k| 100 * k), None);
        assert_eq!(of(&|k| if k < 10 { 100 } else { 900 }), None);
        assert_eq!(of(&|k| 500 + k % 3), None);
        assert_eq!(of(&|k| 500 + 30 * ((k % 8) - 4).abs()), None);
        assert_eq!(two_values(&[], 40), None);
    }
}
