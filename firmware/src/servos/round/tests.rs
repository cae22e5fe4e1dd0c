use super::super::tests::list;
use super::*;
use crate::test_board::TestBoard;

/// One a tick, whoever does not answer; none whose mode is known.
#[test]
fn modes_are_asked_for_in_turn() {
    let mut servos = Servos::new(&list(&[1, 2, 3, 4]));
    servos
        .all_mut()
        .iter_mut()
        .for_each(|servo| servo.hear(true));
    servos.all_mut()[1].mode = ServoMode::Joint;
    let (mut board, mut statistics) = (TestBoard::default(), Statistics::default());
    for _ in 0..6 {
        servos.ask_mode(&mut board, &mut statistics);
    }
    let asked = board.sent.iter().map(|(packet, _)| packet[2]);
    assert_eq!(asked.collect::<std::vec::Vec<_>>(), [3, 4, 1, 3, 4, 1]);
}

/// The first behind the turn of those that must be read, or else the first before it, beside
/// the one whose turn it is.
#[test]
fn of_those_to_be_read_the_next_is() {
    let chosen = |from: u8, unread: &[u8]| {
        let mut servos = Servos::new(&list(&[1, 2, 3, 4, 5]));
        for (place, servo) in (0..).zip(servos.all_mut()) {
            servo.hear(true);
            servo.armed = true;
            if !unread.contains(&place) {
                servo.registers = Registers::AsWritten;
            }
        }
        servos.housekeeping_from = from;
        servos.choose_whole();
        (servos.whole_in_turn, servos.whole_unread)
    };
    assert_eq!(chosen(1, &[]), (None, None));
    assert_eq!(chosen(1, &[1]), (Some(1), None));
    assert_eq!(chosen(1, &[1, 3, 4]), (Some(1), Some(3)));
    assert_eq!(chosen(3, &[0, 1]), (Some(3), Some(0)));
    assert_eq!(chosen(3, &[0, 4]), (Some(3), Some(4)));
}

/// Under torque other registers are a restart, which is looked into elsewhere.
#[test]
fn registers_differ_only_of_what_is_commanded_before_torque_is_on() {
    for (armed, has_torque, found) in [
        (true, false, Registers::Differ),
        (true, true, Registers::Unread),
        (false, false, Registers::Unread),
    ] {
        let mut servo = Servo::unknown(1);
        servo.armed = armed;
        assert!(!servo.compare(&[0; bus::MOST_READ], ArmLimits::FULL, has_torque));
        assert_eq!(servo.registers, found);
    }
}
