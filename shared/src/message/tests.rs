extern crate std;
use super::*;
use crate::frame::{Decoder, wire_length};
use crate::packed::{Positions, SERVOS, Speeds};
use crate::raw::{MovingSpeed, TorqueLimit};
use proptest::prelude::*;
use std::vec;
use std::vec::Vec;

fn round_trip<M: Message + PartialEq + core::fmt::Debug>(sequence: u8, message: M) -> usize {
    let mut out = [0; MAX_FRAME];
    let length = encode(sequence, &message, &mut out).expect("it fits");
    let mut decoder = Decoder::default();
    let (last, before) = out[..length].split_last().unwrap();
    assert!(before.iter().all(|byte| decoder.push(*byte).is_none()));
    let body = decoder.push(*last).unwrap().unwrap();
    assert_eq!(decode(body), Ok(Numbered { sequence, message }));
    length
}

fn stream_report() -> StreamReport {
    StreamReport {
        tick: u16::MAX,
        condition: Condition::Fault(Cause::LinkLost),
        obeyed: 255,
        positions: Positions::pack([1023; SERVOS]),
        missing: [0; 3],
        housekeeping_from: 17,
        housekeeping: [Housekeeping::default(); 2],
        gyro: 1023,
    }
}

/// 57600 baud carries 57 bytes per 10 ms each way.
#[test]
fn what_goes_every_tick_fits_the_line() {
    assert_eq!(round_trip(255, Report::Stream(stream_report())), 55);
    assert_eq!(
        round_trip(255, Command::Goals(Positions::pack([1023; SERVOS]))),
        30
    );
    assert_eq!(
        round_trip(255, Command::Speeds(Speeds::pack([2047; SERVOS]))),
        32
    );
}

#[test]
fn the_largest_messages_fit_a_frame() {
    let full = Statistics {
        frames: u16::MAX,
        bad_frames: u16::MAX,
        lost_frames: u16::MAX,
        overruns: u16::MAX,
        answers: u16::MAX,
        timeouts: u16::MAX,
        garbled: u16::MAX,
        strangers: u16::MAX,
        retries: u16::MAX,
        cut: u16::MAX,
        missed: [u8::MAX; SERVOS],
    };
    round_trip(1, Report::Statistics(full));
    let bytes = [0xff; PLAN_CHUNK];
    let (offset, length) = (u16::MAX, u16::MAX);
    round_trip(
        2,
        Report::PlanChunk {
            offset,
            length,
            bytes,
        },
    );
    round_trip(3, Command::PlanChunk { offset, bytes });
}

#[test]
fn a_critical_message_without_its_own_check_is_refused() {
    // Token 0x34, torque limit 1023, speed 100.
    let arm = [9, 10, 0x34, 0xff, 7, 100];
    assert_eq!(decode::<Command>(&arm), Err(MessageError::Check));
    let mut checked = [9, 10, 0x34, 0xff, 7, 100, 0, 0, 0, 0];
    checked[6..].copy_from_slice(&crc32(&arm).to_le_bytes());
    let message = Command::Arm {
        token: 0x34,
        limits: ArmLimits {
            torque: TorqueLimit(1023),
            speed: MovingSpeed(100),
        },
    };
    assert_eq!(
        decode(&checked),
        Ok(Numbered {
            sequence: 9,
            message
        })
    );
    for bit in 0..checked.len() * 8 {
        let mut flipped = checked;
        flipped[bit / 8] ^= 1 << (bit % 8);
        if let Ok(Numbered { message, .. }) = decode::<Command>(&flipped) {
            assert!(!message.is_critical(), "{message:?}");
        }
    }
}

/// A piece of a plan has a CRC-32 of its own, whichever way it goes.
#[test]
fn what_may_not_arrive_wrong_is_critical() {
    let (offset, length, bytes) = (0, 1000, [7; PLAN_CHUNK]);
    let told = Report::PlanChunk {
        offset,
        length,
        bytes,
    };
    assert!(Command::PlanChunk { offset, bytes }.is_critical() && told.is_critical());
    assert!(!Report::Statistics(Statistics::default()).is_critical());
}

#[test]
fn hello_keeps_its_form_for_ever() {
    assert_eq!(
        decode(&[7, 0, 1]),
        Ok(Numbered {
            sequence: 7,
            message: Command::Hello { version: 1 }
        })
    );
}

#[test]
fn a_message_with_something_behind_it_is_refused() {
    assert_eq!(decode::<Command>(&[7, 0, 1, 0]), Err(MessageError::Content));
    assert_eq!(decode::<Command>(&[]), Err(MessageError::Content));
}

#[test]
fn the_slow_channels_go_around() {
    let report = stream_report();
    assert!(report.housekeeping(18).map(|(place, _)| place).eq([17, 0]));
    assert!(report.is_present(17) && !report.is_present(24));
    assert_eq!(report.position(17), Some(1023));
}

/// In a list of any length, around its end.
#[test]
fn housekeeping_is_that_of_two_neighbours() {
    let of = |from, count| {
        let report = StreamReport {
            housekeeping_from: from,
            ..stream_report()
        };
        let places = report.housekeeping(count).map(|(place, _)| place);
        places.collect::<Vec<usize>>()
    };
    assert_eq!((of(0, 18), of(3, 18)), (vec![0, 1], vec![3, 4]));
    assert_eq!((of(1, 4), of(3, 4)), (vec![1, 2], vec![3, 0]));
    assert_eq!((of(0, 1), of(0, 2)), (vec![0], vec![0, 1]));
}

#[test]
fn each_servo_has_a_bit_among_the_missing() {
    for missing in 0..SERVOS {
        let [m0, m1, m2, _] = (1u32 << missing).to_le_bytes();
        let report = StreamReport {
            missing: [m0, m1, m2],
            ..stream_report()
        };
        for place in 0..SERVOS {
            assert_eq!(report.is_present(place), place != missing, "{place}");
            assert_eq!(report.position(place).is_some(), place != missing);
        }
    }
}

#[test]
fn a_roster_with_an_id_twice_is_not_sound() {
    let mut list = ServoList::default();
    assert!(list.is_sound());
    for (id, is_sound) in [(253, true), (254, false), (255, false)] {
        list.ids[17] = id;
        assert_eq!(list.is_sound(), is_sound, "{id}");
    }
    list = ServoList::default();
    list.ids[3] = list.ids[9];
    assert!(!list.is_sound());
    list.count = 5;
    assert!(list.is_sound());
    list.count = 0;
    assert!(!list.is_sound());
}

proptest! {
    #[test]
    fn commands_survive(sequence: u8, codes: [u16; SERVOS], token: u16, length: u16, check: u32, bytes: [u8; PLAN_CHUNK], angle: i16, rate: i16, ids: [u8; SERVOS], count: u8) {
        for command in [
            Command::Goals(Positions::pack(codes)), Command::Speeds(Speeds::pack(codes)), Command::Arm { token, limits: ArmLimits::FULL },
            Command::PlanChunk { offset: length, bytes }, Command::PlanStore { length, check }, Command::Disarm, Command::LetDown,
            Command::KeepAlive,
            Command::Attitude(Attitude { angle, rate }), Command::ServoList(ServoList { count, ids }),
            Command::Mode(Mode::Balance), Command::Ask(Subject::Statistics), Command::PlanRead { offset: length },
        ] {
            let length = round_trip(sequence, command);
            prop_assert!(length <= wire_length(MAX_BODY));
            let mut out = [0; MAX_FRAME];
            let length = encode(sequence, &command, &mut out).unwrap();
            prop_assert!(!out[..length].contains(&b'#'), "{:?}", command);
            // The one length of which a body may have to hold the byte.
            prop_assert_ne!(length, wire_length(34), "{:?}", command);
        }
    }

    #[test]
    fn any_body_is_read_without_a_panic(body in proptest::collection::vec(any::<u8>(), 0..MAX_BODY)) {
        let _ = (decode::<Command>(&body), decode::<Report>(&body));
    }
}

/// Around a report that was lost torque may have come on or gone off, or it cannot.
#[test]
fn torque_is_not_known_where_a_lost_report_would_tell() {
    use Condition::{Balance, BalanceArmed, Soft, Stream, StreamArmed};
    let fallen = Condition::Fault(Cause::Fallen);
    let lost = Condition::Fault(Cause::LinkLost);
    let report = |tick, condition| StreamReport {
        tick,
        condition,
        obeyed: 0,
        positions: Positions::pack([0; SERVOS]),
        missing: [0; 3],
        housekeeping_from: 0,
        housekeeping: [Housekeeping::default(); 2],
        gyro: 0,
    };
    // The condition before, the one now, torque when none was lost between them, and when one was.
    let cases = [
        (Balance, BalanceArmed, Some(false), None),
        (Stream, BalanceArmed, Some(false), None),
        (BalanceArmed, BalanceArmed, Some(true), Some(true)),
        (BalanceArmed, fallen, Some(true), None),
        (Balance, fallen, Some(false), None),
        (fallen, fallen, Some(false), Some(false)),
        (Soft, lost, Some(false), Some(false)),
        (BalanceArmed, Balance, Some(false), Some(false)),
        (BalanceArmed, Soft, Some(true), Some(true)),
        (Stream, StreamArmed, Some(true), Some(true)),
        (StreamArmed, Stream, Some(false), Some(false)),
        (Stream, Condition::Bridge, None, None),
    ];
    for (before, now, next, later) in cases {
        let was_on = |gap: u16| {
            let before = report(u16::MAX, before);
            report(u16::MAX.wrapping_add(gap), now).torque_was_on(Some(&before))
        };
        assert_eq!(was_on(1), next, "{before:?}, {now:?}");
        assert_eq!(was_on(2), later, "{before:?}, a lost one, {now:?}");
    }
    for (first, torque) in [
        (BalanceArmed, None),
        (fallen, None),
        (StreamArmed, Some(true)),
    ] {
        assert_eq!(report(7, first).torque_was_on(None), torque, "{first:?}");
    }
}
