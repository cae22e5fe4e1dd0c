use super::*;
use handstand_shared::control_table::*;
use handstand_shared::dynamixel::timing::BYTE_NS;
use handstand_shared::dynamixel::{BROADCAST, Request};
use handstand_shared::raw::Position;

fn send(bus: &mut Bus, now_ns: u64, bytes: &[u8]) -> Vec<(u64, u8)> {
    bytes.iter().for_each(|byte| bus.receive(now_ns, *byte));
    std::iter::from_fn(|| bus.take(u64::MAX)).collect()
}

#[test]
fn a_ping_is_answered_literally_and_in_time() {
    let mut bus = Bus::new([1]);
    let answer = send(&mut bus, 1_000_000, &[0xff, 0xff, 1, 2, 1, 0xfb]);
    let bytes: Vec<u8> = answer.iter().map(|(_, byte)| *byte).collect();
    assert_eq!(bytes, [0xff, 0xff, 1, 2, 0, 0xfc]);
    let first_us = (answer[0].0 - 1_000_000) / 1000;
    // 18 us to begin and a byte of 10 us, or later by the motor's interrupt.
    assert!((28..=28 + 130).contains(&first_us), "{first_us} us");
    assert!(
        answer
            .windows(2)
            .all(|pair| pair[1].0 - pair[0].0 >= BYTE_NS)
    );
}

#[test]
fn an_eeprom_write_silences_a_servo_and_a_ram_write_does_not() {
    let mut bus = Bus::new([1]);
    let write = |register: Register, data: &'static [u8]| Request::Write {
        address: register.address,
        data,
    };
    bus.transact(1, write(LED, &[1]));
    assert_eq!(
        bus.transact(
            1,
            Request::Read {
                address: 25,
                count: 1
            }
        ),
        [1]
    );
    bus.transact(1, write(MAX_TEMPERATURE, &[80]));
    assert_eq!(
        bus.transact(
            1,
            Request::Read {
                address: 11,
                count: 1
            }
        ),
        [0u8; 0]
    );
    bus.advance(7_000_000);
    assert_eq!(
        bus.transact(
            1,
            Request::Read {
                address: 11,
                count: 1
            }
        ),
        [80]
    );
}

#[test]
fn a_value_out_of_range_changes_nothing() {
    let mut bus = Bus::new([1]);
    bus.transact(
        1,
        Request::Write {
            address: TORQUE_ENABLE.address,
            data: &[2],
        },
    );
    assert!(!bus.any_torque());
    bus.transact(
        1,
        Request::Write {
            address: PRESENT_POSITION.address,
            data: &[0, 0],
        },
    );
    bus.advance(1_000_000);
    assert_eq!(bus.servos[0].get(PRESENT_POSITION), 512);
}

#[test]
fn a_goal_moves_the_shaft_near_it_and_torque_off_stops_it() {
    let mut bus = Bus::new([1, 2]);
    let goal = 700u16.to_le_bytes();
    bus.transact(
        1,
        Request::Write {
            address: GOAL_POSITION.address,
            data: &goal,
        },
    );
    assert!(bus.any_torque());
    bus.advance(2_000_000_000);
    let error = bus.servos[0].get(PRESENT_POSITION).abs_diff(700);
    assert!(
        (1..=4).contains(&error),
        "the dead zone leaves a few codes, not {error}"
    );
    bus.transact(
        BROADCAST,
        Request::Write {
            address: 24,
            data: &[0],
        },
    );
    assert!(!bus.any_torque() && bus.torque_offs.len() == 1);
    bus.servos[0].set(GOAL_POSITION, 300);
    bus.advance(3_000_000_000);
    assert!(bus.servos[0].get(PRESENT_POSITION).abs_diff(700) < 6);
}

#[test]
fn wheel_mode_turns_by_its_command() {
    let mut bus = Bus::new([1]);
    bus.servos[0].set(CCW_LIMIT, 0);
    bus.servos[0].set(TORQUE_ENABLE, 1);
    bus.servos[0].set(MOVING_SPEED, 1024 + 512);
    assert!((bus.servos[0].regulator().duty(0.0) + 0.5).abs() < 1e-3);
    bus.advance(200_000_000);
    assert!(bus.servos[0].shaft.angle_rad < -0.2);
    assert!(Position(bus.servos[0].get(PRESENT_POSITION)) < Position::CENTRE);
}

#[test]
fn faults_do_what_their_names_say() {
    let ping = [0xff, 0xff, 1, 2, 1, 0xfb];
    let answers = |set: fn(&mut Faults)| {
        let mut bus = Bus::new([1]);
        set(&mut bus.servos[0].faults);
        let answer = send(&mut bus, 0, &ping);
        answer.into_iter().map(|(_, byte)| byte).collect::<Vec<_>>()
    };
    assert_eq!(answers(|f| f.dead = true), [0u8; 0]);
    assert_eq!(answers(|f| f.drop = 1.0), [0u8; 0]);
    assert_eq!(answers(|f| f.wrong_id = 1.0), [0xff, 0xff, 2, 2, 0, 0xfb]);
    let flipped = answers(|f| f.flip = 1.0);
    let wrong: u32 = (flipped.iter().zip([0xff, 0xff, 1, 2, 0, 0xfc]))
        .map(|(a, b)| (a ^ b).count_ones())
        .sum();
    assert_eq!(wrong, 1);
    assert_eq!(answers(|f| f.echo = true)[..6], ping);
    let corrupted = answers(|f| f.corrupt_request = 1.0);
    assert_eq!(corrupted, [0xff, 0xff, 1, 2, 16, 0xec]);
}

#[test]
fn a_wrong_checksum_is_reported_and_not_executed() {
    let mut bus = Bus::new([1, 2]);
    // WRITE torque enable 1 to servo 1, its sum one too large.
    let answer = send(&mut bus, 0, &[0xff, 0xff, 1, 4, 3, 24, 1, 0xdf]);
    let bytes: Vec<u8> = answer.into_iter().map(|(_, byte)| byte).collect();
    assert_eq!(bytes, [0xff, 0xff, 1, 2, 16, 0xec]);
    assert!(!bus.any_torque());
    assert_eq!(send(&mut bus, 0, &[0xff, 0xff, 254, 4, 3, 24, 1, 0]), []);
    assert_eq!(send(&mut bus, 0, &[0xff, 0xff, 1, 2, 1, 0xfb]).len(), 6);
}

#[test]
fn two_servos_of_one_id_garble_each_other() {
    let mut bus = Bus::new([1, 2, 2]);
    let sound = |bytes: Vec<(u64, u8)>| {
        let bytes: Vec<u8> = bytes.into_iter().map(|(_, byte)| byte).collect();
        handstand_shared::dynamixel::Packet::new(&bytes).is_ok()
    };
    for round in 0..20 {
        let now_ns = round * 3_141_592;
        assert!(sound(send(&mut bus, now_ns, &[0xff, 0xff, 1, 2, 1, 0xfb])));
        let both = send(&mut bus, now_ns + 1_000_000, &[0xff, 0xff, 2, 2, 1, 0xfa]);
        assert!(!both.is_empty() && !sound(both), "round {round}");
    }
}

/// A blocked shaft: the torque limit falls to 0 and stays there until it is written.
#[test]
fn an_overloaded_servo_lets_go_until_its_torque_limit_is_written() {
    let mut bus = Bus::new([1]);
    let goal = 900u16.to_le_bytes();
    let write = |register: Register, data: &'static [u8]| Request::Write {
        address: register.address,
        data,
    };
    bus.servos[0].jammed = true;
    bus.transact(
        1,
        Request::Write {
            address: GOAL_POSITION.address,
            data: &goal,
        },
    );
    bus.advance(900_000_000);
    assert!(bus.any_torque() && bus.servos[0].get(TORQUE_LIMIT) == 1023);
    bus.advance(1_100_000_000);
    assert!(!bus.any_torque() && bus.servos[0].get(TORQUE_LIMIT) == 0);
    assert_eq!(bus.servos[0].regulator().duty(0.0), 0.0);
    let ping = |bus: &mut Bus| send(bus, 1_200_000_000, &[0xff, 0xff, 1, 2, 1, 0xfb])[4].1;
    assert_eq!(ping(&mut bus), 32);
    bus.transact(1, write(TORQUE_ENABLE, &[1]));
    assert_eq!(
        bus.servos[0].regulator().duty(0.0),
        0.0,
        "that alone is not enough"
    );
    bus.servos[0].jammed = false;
    bus.transact(1, write(TORQUE_LIMIT, &[0xff, 3]));
    assert_eq!(ping(&mut bus), 0);
    bus.advance(2_000_000_000);
    assert!(bus.servos[0].get(PRESENT_POSITION) > 850);
}

#[test]
fn only_the_servo_addressed_replies_and_none_to_a_broadcast() {
    let mut bus = Bus::new([1, 2, 3]);
    assert_eq!(
        bus.transact(
            2,
            Request::Read {
                address: ID.address,
                count: 1
            }
        ),
        [2]
    );
    assert_eq!(bus.transact(BROADCAST, Request::Ping), [0u8; 0]);
    assert_eq!(bus.transact(9, Request::Ping), [0u8; 0]);
    assert_eq!(bus.next_ns(), None);
}
