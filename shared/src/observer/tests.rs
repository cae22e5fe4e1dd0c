extern crate std;
use super::*;
use std::vec::Vec;

/// Readings are predicted as estimated, but for the rate; the estimate stays but for 256 times
/// the innovation and the first applied input; inputs are minus the driven joints' angles and
/// inputs two samples old.
fn observer() -> Observer {
    let mut observer = Observer::ZERO;
    for (i, row) in observer.predict.rows.iter_mut().enumerate() {
        (row.shift, row.low, row.high) = (8, i16::MIN, i16::MAX);
        if i < JOINTS {
            row.k[i] = -256;
        }
    }
    for (i, row) in observer.update.rows.iter_mut().enumerate() {
        (row.shift, row.low, row.high) = (8, i16::MIN, i16::MAX);
        if i < JOINTS {
            row.k[i] = -256;
            row.k[STATE + i] = -128;
            row.k[SEEN] = -3 * 256;
        }
    }
    for (i, row) in observer.feedback.rows.iter_mut().enumerate() {
        (row.shift, row.low, row.high) = (8, -100, 100);
        row.k[i + 1] = 256;
        row.k[ESTIMATED + INPUTS + i] = 256;
    }
    observer.reading_places = [1, 1, 1, 0];
    observer.balance_places = [0, 2, 3];
    observer
}

#[test]
fn it_starts_at_the_readings_and_remembers_what_was_given() {
    let observer = observer();
    let mut memory = Memory::ZERO;
    observer.start(&mut memory, &[10, 20, 30, 40], [1, 2, 3]);
    assert_eq!(
        memory.all()[..ESTIMATED],
        [20, 40, 60, 0, 0, 0, 1, 8, 24, 0, 0]
    );
    assert_eq!(
        observer.raw_command(&mut memory, &[10, 20, 30, 40]),
        [-40, -60]
    );
    assert_eq!(memory.all()[STATE..SEEN], [0, 0, 0, 40]);
    observer.update(&mut memory, [7, 9]);
    assert_eq!(memory.all()[..JOINTS], [41, 61, 81]);
    assert_eq!(memory.all()[ESTIMATED..STATE], [7, 9, 0, 0, 0, 0]);
    observer.raw_command(&mut memory, &[20, 31, 40, 0]);
    assert_eq!(memory.all()[STATE..SEEN], [-1, 1, -1, 0]);
    observer.update(&mut memory, [1, 2]);
    // Halves of the innovation are rounded down, for there is no bias.
    assert_eq!(memory.all()[..JOINTS], [43, 64, 83]);
    assert_eq!(memory.all()[ESTIMATED..STATE], [1, 2, 7, 9, 0, 0]);
    // The innovation and what was applied stay as they were.
    assert_eq!(memory.all()[STATE..], [-1, 1, -1, 0, 1, 2]);
    assert_eq!(observer.raw_command(&mut memory, &[0; 4]), [-71, -92]);
    memory.all[1] = 1000;
    memory.step = PREDICT;
    assert_eq!(observer.raw_command(&mut memory, &[0; 4]), [-100, -92]);
    // A reading that is missing is the one predicted.
    let heard = [true, false, true, false];
    observer.raw_command_of(&mut memory, &[30, 99, 50, 77], heard);
    let all = observer.raw_command(&mut memory, &[30, 99, 50, 77]);
    let [first, _, third, _] = *memory.all()[STATE..SEEN].first_chunk::<4>().unwrap();
    let some = observer.raw_command_of(&mut memory, &[30, 99, 50, 77], heard);
    assert_eq!(memory.all()[STATE..SEEN], [first, 0, third, 0]);
    assert_eq!(all, some);
    // Innovations saturate.
    observer.raw_command(&mut memory, &[i16::MIN, i16::MAX, 0, 0]);
    assert_eq!(memory.all()[STATE..STATE + 2], [i16::MIN, i16::MAX - 1000]);
}

#[test]
fn the_next_estimate_counts_from_the_last_step_on() {
    let observer = observer();
    let mut memory = Memory::ZERO;
    let steps = |memory: &mut Memory| {
        let mut steps = 0;
        while observer.step_update(memory) {
            steps += 1;
        }
        steps
    };
    observer.start(&mut memory, &[10, 20, 30, 40], [1, 2, 3]);
    // Prediction: departures and a row per reading.
    assert_eq!(steps(&mut memory), 1 + READINGS);
    observer.raw_command(&mut memory, &[11, 22, 33, 44]);
    assert_eq!(steps(&mut memory), 0);
    let (mut whole, mut left_to_next) = (memory, memory);
    observer.update(&mut whole, [7, 9]);
    observer.begin_update(&mut memory, [7, 9]);
    let before = memory;
    for _ in 0..ESTIMATED {
        assert!(observer.step_update(&mut memory));
        assert_eq!(memory.all(), before.all());
    }
    assert!(observer.step_update(&mut memory));
    assert_ne!(memory.all(), before.all());
    assert_eq!(steps(&mut memory), 1 + READINGS);
    assert_eq!(memory, whole);
    // What was not done meanwhile is done before the next raw command.
    observer.begin_update(&mut left_to_next, [7, 9]);
    let next = [12, 23, 34, 45];
    assert_eq!(
        observer.raw_command(&mut left_to_next, &next),
        observer.raw_command(&mut whole, &next)
    );
    assert_eq!(left_to_next, whole);
    // A new start forgets an update.
    observer.begin_update(&mut memory, [7, 9]);
    observer.start(&mut memory, &[10, 20, 30, 40], [1, 2, 3]);
    assert_eq!(steps(&mut memory), 1 + READINGS);
}

#[test]
fn it_survives_its_bytes() {
    let mut bytes = Vec::new();
    observer().bytes(|byte| bytes.push(byte));
    assert_eq!(bytes.len(), Observer::LENGTH);
    let mut back = Observer::ZERO;
    assert_eq!(back.fill(&mut bytes.iter().copied()), Some(()));
    assert_eq!(back, observer());
    assert!(back.is_safe());
    for length in 0..bytes.len() {
        let mut short = bytes[..length].iter().copied();
        assert_eq!(back.fill(&mut short), None);
    }
}

#[test]
fn it_is_safe_if_all_its_tables_are() {
    assert!(observer().is_safe());
    let spoilt: [fn(&mut Observer); 3] = [
        |observer| observer.predict.rows[3].shift = 31,
        |observer| observer.feedback.rows[1].shift = 31,
        |observer| observer.update.rows[10].shift = 31,
    ];
    for spoil in spoilt {
        let mut observer = observer();
        spoil(&mut observer);
        assert!(!observer.is_safe());
    }
}

#[test]
fn inputs_are_kept_for_three_samples() {
    let observer = observer();
    let mut memory = Memory::ZERO;
    for applied in [[1, 2], [3, 4], [5, 6], [7, 8]] {
        observer.update(&mut memory, applied);
    }
    assert_eq!(memory.all()[ESTIMATED..STATE], [7, 8, 5, 6, 3, 4]);
}
