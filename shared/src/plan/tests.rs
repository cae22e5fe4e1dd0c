extern crate std;
use super::*;
use crate::raw::{Position, Signed};
use proptest::prelude::*;
use std::vec::Vec;

const JOINT: Joint = Joint {
    id: 1,
    mirror: 2,
    reversed: false,
    centre: 512,
    dead: 80,
    gain: 1 << 15,
    least: 0,
    most: 1840,
    slew: 1840,
    lowest: -200,
    highest: 220,
    fastest: 10,
};

fn plan(law: Law) -> Plan {
    Plan {
        law,
        joints: [
            JOINT,
            Joint {
                id: 11,
                mirror: 255,
                reversed: true,
                ..JOINT
            },
        ],
        gyro: Gyro {
            from_host: true,
            zero: 512,
            scale: -77,
        },
        moments: [
            Moment {
                along: 1000,
                aside: -3,
            },
            Moment::ZERO,
            Moment {
                along: 500,
                aside: 7,
            },
        ],
        range: 5000,
    }
}

fn laws() -> [Law; 2] {
    let table = GainTable::new(
        [[1, -2, 3, -4, 5, -6]; 2],
        [7; 2],
        [16; 2],
        [[-9, 9]; 2],
        [0; 6],
    );
    let velocity = Velocity {
        fraction: 4,
        share: 128,
    };
    let mut observer = Observer::ZERO;
    observer.update.rows[3].k[20] = 77;
    observer.reading_places = [1, 2, 3, 4];
    observer.balance_places = [5, 6, 7];
    [Law::State { table, velocity }, Law::Observer(observer)]
}

fn bytes_of(plan: &Plan) -> Vec<u8> {
    let mut bytes = Vec::new();
    plan.bytes(|byte| bytes.push(byte));
    bytes
}

#[test]
fn a_plan_survives_its_bytes_and_others_are_refused() {
    for plan in laws().map(plan) {
        let mut bytes = bytes_of(&plan);
        assert!(bytes.len() <= Plan::MOST);
        assert_eq!(Plan::from_bytes(&bytes), Some(plan));
        assert_eq!(plan.fingerprint(), crate::crc::crc32(&bytes));
        for length in 0..bytes.len() {
            assert_eq!(Plan::from_bytes(&bytes[..length]), None);
        }
        bytes.push(0);
        assert_eq!(Plan::from_bytes(&bytes), None);
        let mut unsound = plan;
        unsound.joints[0].dead = 1024;
        assert_eq!(Plan::from_bytes(&bytes_of(&unsound)), None);
        unsound = plan;
        (unsound.joints[1].least, unsound.joints[1].slew) = (20, 19);
        assert_eq!(Plan::from_bytes(&bytes_of(&unsound)), None);
        for (lowest, highest, fastest) in [
            (1, 220, 10),
            (-200, -1, 10),
            (-512, 220, 10),
            (-200, 512, 10),
            (i16::MIN, i16::MAX, 10),
            (-200, 220, 0),
            (-200, 220, 1024),
        ] {
            for place in 0..2 {
                unsound = plan;
                let joint = &mut unsound.joints[place];
                (joint.lowest, joint.highest, joint.fastest) = (lowest, highest, fastest);
                let bytes = bytes_of(&unsound);
                assert_eq!(
                    Plan::from_bytes(&bytes),
                    None,
                    "{lowest} {highest} {fastest}"
                );
            }
        }
    }
    type Spoil = fn(&mut Plan);
    let spoilt: [(&str, Spoil); 9] = [
        ("own mirror", |plan| {
            plan.joints[0].mirror = plan.joints[0].id
        }),
        ("one servo of both", |plan| {
            plan.joints[1].id = plan.joints[0].id
        }),
        ("one mirror of both", |plan| {
            plan.joints[1].mirror = plan.joints[0].mirror
        }),
        ("mirror of the other", |plan| {
            plan.joints[1].id = plan.joints[0].mirror
        }),
        ("driven and mirror", |plan| {
            plan.joints[1].mirror = plan.joints[0].id
        }),
        ("a dead zone of half", |plan| plan.joints[1].dead = 512),
        ("a zero beyond the ADC", |plan| plan.gyro.zero = 1024),
        ("a gyro of no scale", |plan| {
            (plan.gyro.from_host, plan.gyro.scale) = (false, 0)
        }),
        ("a range of more than a right angle", |plan| {
            plan.range = 15_709
        }),
    ];
    for (what, spoil) in spoilt {
        let mut unsound = plan(laws()[0]);
        unsound.joints[0].mirror = 2;
        (unsound.joints[1].id, unsound.joints[1].mirror) = (11, 12);
        assert!(Plan::from_bytes(&bytes_of(&unsound)).is_some());
        spoil(&mut unsound);
        assert_eq!(Plan::from_bytes(&bytes_of(&unsound)), None, "{what}");
    }
    // Without mirrors there is none to share.
    let mut alone = plan(laws()[0]);
    (
        alone.joints[0].mirror,
        alone.joints[1].mirror,
        alone.joints[1].id,
    ) = (255, 255, 11);
    assert!(Plan::from_bytes(&bytes_of(&alone)).is_some());
    assert_eq!(bytes_of(&plan(laws()[1])).len(), Plan::MOST);
    assert_eq!(Plan::from_bytes(&bytes_of(&Plan::ZERO)), None);
}

/// A plan takes the place of any other, whichever law that has.
#[test]
fn a_plan_takes_the_place_of_any_other() {
    for before in laws() {
        for after in laws() {
            let (mut plan, wanted) = (plan(before), plan(after));
            assert!(plan.fill(&mut bytes_of(&wanted).into_iter()));
            assert_eq!(plan, wanted);
        }
    }
}

#[test]
fn a_law_that_is_not_safe_is_refused() {
    let [Law::State { table, velocity }, Law::Observer(observer)] = laws() else {
        panic!("one of each");
    };
    let state = |spoil: fn(&mut GainTable<2, 6>, &mut Velocity)| {
        let (mut table, mut velocity) = (table, velocity);
        spoil(&mut table, &mut velocity);
        Law::State { table, velocity }
    };
    let mut unsafe_observer = observer;
    unsafe_observer.update.rows[3].shift = 31;
    for (law, is_sound) in [
        (state(|_, velocity| velocity.fraction = 7), true),
        (state(|_, velocity| velocity.fraction = 8), false),
        (state(|_, velocity| velocity.share = 1), true),
        (state(|_, velocity| velocity.share = 0), false),
        (state(|_, velocity| velocity.share = 256), true),
        (state(|_, velocity| velocity.share = 257), false),
        (state(|table, _| table.rows[1].shift = 31), false),
        (Law::Observer(unsafe_observer), false),
    ] {
        let plan = plan(law);
        let read = Plan::from_bytes(&bytes_of(&plan));
        assert_eq!(read, is_sound.then_some(plan));
    }
}

#[test]
fn commands_jump_over_the_dead_zone_and_stop_at_the_last_code() {
    assert_eq!(
        [0, 1, 2, 200, -200, 30_000].map(|u| JOINT.command(u)),
        [0, 81, 81, 180, -180, 1023]
    );
    let reversed = plan(laws()[0]).joints[1];
    assert_eq!(
        (reversed.command(200), reversed.angle(Position(500))),
        (-180, 12)
    );
    let both: Vec<_> = JOINT.commands(-180).into_iter().flatten().collect();
    assert_eq!(both, [(1, Signed::new(-180)), (2, Signed::new(180))]);
    assert_eq!(reversed.commands(5).iter().flatten().count(), 1);
    // 254 and 255 are no servos.
    for (mirror, count) in [(253, 2), (254, 1), (255, 1)] {
        assert_eq!(
            Joint { mirror, ..JOINT }.servos().iter().flatten().count(),
            count
        );
    }
}

/// Half of the least input is enough for all of it, a step less is owed.
#[test]
fn what_is_less_than_half_of_the_least_waits() {
    let joint = Joint {
        least: 250,
        ..JOINT
    };
    for (raw_command, input) in [(124, 0), (-124, 0), (125, 250), (-125, -250), (251, 251)] {
        let mut applied = AppliedInput::NOTHING;
        assert_eq!(joint.apply(&mut applied, raw_command), input);
    }
}

/// A servo says its last codes, or any, beyond its range: limits are within it, on either side.
#[test]
fn the_range_of_a_joint_is_one_that_its_servo_measures() {
    for (reversed, centre, lowest, highest, is_sound) in [
        (false, 300, -299, 722, true),
        (false, 300, -300, 722, false),
        (false, 300, -299, 723, false),
        (true, 300, -722, 299, true),
        (true, 300, -723, 299, false),
        (true, 300, -722, 300, false),
    ] {
        let joint = Joint {
            reversed,
            centre,
            lowest,
            highest,
            ..JOINT
        };
        assert_eq!(joint.is_sound(), is_sound, "{joint:?}");
    }
    for (id, is_sound) in [(253, true), (254, false)] {
        assert_eq!(Joint { id, ..JOINT }.is_sound(), is_sound);
    }
}

#[test]
fn range_and_speed_are_told_at_their_edges() {
    let angles = [-201, -200, 0, 220, 221];
    assert_eq!(
        angles.map(|angle| JOINT.is_in_range(angle)),
        [false, true, true, true, false]
    );
    for (change, ticks, is_slow) in [
        (10, 1, true),
        (-10, 1, true),
        (11, 1, false),
        (-11, 1, false),
        (20, 2, true),
        (21, 2, false),
        (i16::MIN, 255, false),
    ] {
        assert_eq!(JOINT.is_slow(change, ticks), is_slow, "{change} in {ticks}");
    }
}

#[test]
fn the_mean_of_what_is_given_is_what_was_wished_for() {
    let joint = Joint {
        least: 250,
        ..JOINT
    };
    for raw_command in [-200, -30, 10, 100, 124, 200, 700] {
        let mut applied = AppliedInput::NOTHING;
        let sum: i32 = (0..1000)
            .map(|_| i32::from(joint.apply(&mut applied, raw_command)))
            .sum();
        assert!(
            (sum - 1000 * i32::from(raw_command)).abs() <= 250,
            "{raw_command}: {sum}"
        );
    }
}

proptest! {
    /// Whatever is commanded: within the limits, never a change beyond the slew, never lost in the
    /// dead zone.
    #[test]
    fn limits_hold(
        least in 0i16..300,
        more in 0i16..2000,
        slew in 0i16..2000,
        raw_commands in prop::collection::vec(any::<i16>(), 1..60),
        small in prop::collection::vec(-400i16..400, 1..60),
    ) {
        let joint = Joint { least, most: least.saturating_add(more), slew: least.max(1).saturating_add(slew), ..JOINT };
        let mut applied = AppliedInput::NOTHING;
        let mut last = 0;
        for raw_command in raw_commands.into_iter().chain(small) {
            let input = joint.apply(&mut applied, raw_command);
            prop_assert!(input.abs() <= joint.most);
            prop_assert!((i32::from(input) - i32::from(last)).abs() <= i32::from(joint.slew));
            prop_assert!(input == 0 || input.abs() >= joint.least, "{input}");
            last = input;
        }
    }
}
