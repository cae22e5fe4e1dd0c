//! The start: torque off on the bus, whatever went before.

use super::rig::*;
use handstand_cm5_sim::{Bus, HostBoard, SimulatedCm5, VirtualCm5};
use handstand_shared::control_table::{GOAL_POSITION, TORQUE_ENABLE};
use handstand_shared::dynamixel::{BROADCAST, Request};
use handstand_shared::message::*;

fn torqued() -> Bus {
    let mut bus = Bus::new(1..=18);
    for servo in &mut bus.servos {
        servo.set(TORQUE_ENABLE, 1);
    }
    bus
}

#[test]
fn a_restart_within_any_packet_switches_torque_off() {
    // The longest of ours, and the longest there is.
    let mut packets = Vec::new();
    for count in [18, 80] {
        let blocks: Vec<u8> = (0..count).flat_map(|id| [id % 18 + 1, 0, 2]).collect();
        let request = Request::SyncWrite {
            address: GOAL_POSITION.address,
            width: 2,
            blocks: &blocks,
        };
        let mut out = [0; 300];
        let length = request.emit(BROADCAST, &mut out).unwrap();
        packets.push(out[..length].to_vec());
    }
    for packet in packets {
        for said in 0..packet.len() {
            let mut bus = torqued();
            packet[..said].iter().for_each(|byte| bus.receive(0, *byte));
            let mut board = HostBoard::new(bus);
            board.reset_cause = ResetCause(ResetCause::WATCHDOG);
            let mut cm5 = VirtualCm5::start(board);
            assert!(!cm5.bus().any_torque(), "{said} of {} bytes", packet.len());
            assert!(cm5.now_ms() < 5.0, "{} ms", cm5.now_ms());
        }
    }
}

/// A servo that hears nothing for a while, and what the PC says meanwhile.
fn deaf_for(cm5: &mut VirtualCm5, ms: u32, command: Option<&Command>) -> bool {
    cm5.bus().servo(4).unwrap().faults.dead = true;
    for _ in 0..ms / 10 {
        if let Some(command) = command {
            cm5.send(command);
        }
        cm5.run_ms(10.0);
    }
    cm5.bus().servo(4).unwrap().faults.dead = false;
    cm5.run_ms(30.0);
    cm5.bus().any_torque()
}

#[test]
fn torque_off_is_repeated_after_a_start_in_every_state() {
    for cause in [ResetCause::POWER, ResetCause::WATCHDOG] {
        for mode in [None, Some(Mode::Stream), Some(Mode::Balance)] {
            let mut bus = torqued();
            bus.servo(4).unwrap().faults.dead = true;
            let mut board = HostBoard::new(bus);
            board.reset_cause = ResetCause(cause);
            let mut cm5 = VirtualCm5::start(board);
            assert!(cm5.bus().any_torque());
            if let Some(mode) = mode {
                cm5.send(&Command::Hello { version: VERSION });
                cm5.send(&Command::Mode(mode));
            }
            assert!(!deaf_for(&mut cm5, 150, None), "{cause} {mode:?}");
        }
    }
}

#[test]
fn torque_off_is_repeated_after_every_disarming() {
    for command in [
        Command::Disarm,
        Command::Mode(Mode::Stream),
        Command::Mode(Mode::Balance),
        Command::Mode(Mode::Bridge),
    ] {
        let mut cm5 = VirtualCm5::new();
        arm(&mut cm5);
        cm5.bus().servo(4).unwrap().faults.dead = true;
        assert_eq!(ask(&mut cm5, &command), Some(Ok(())));
        assert!(cm5.bus().any_torque(), "it did not hear");
        assert!(!deaf_for(&mut cm5, 120, None), "{command:?}");
    }
}

/// A fault goes on saying it for ever.
#[test]
fn a_fault_repeats_torque_off_without_end() {
    let mut cm5 = VirtualCm5::new();
    arm(&mut cm5);
    cm5.run_ms(600.0);
    assert_eq!(cm5.app.condition(), Condition::Fault(Cause::LinkLost));
    assert!(!cm5.bus().any_torque());
    for _ in 0..5 {
        cm5.run_ms(1000.0);
        cm5.bus().servo(9).unwrap().set(TORQUE_ENABLE, 1);
        cm5.run_ms(100.0);
        assert!(!cm5.bus().any_torque());
    }
}

#[test]
fn nothing_passes_to_the_servos_before_torque_is_surely_off() {
    let on = [0xff, 0xff, 4, 4, 3, 24, 1, 0xff - 36];
    let mut cm5 = VirtualCm5::new();
    while cm5.now_ms() < 190.0 {
        cm5.send_bytes(&on);
        cm5.run_ms(5.0);
        assert!(!cm5.bus().any_torque(), "{} ms", cm5.now_ms());
    }
    cm5.run_ms(100.0);
    cm5.send_bytes(&on);
    cm5.run_ms(20.0);
    assert!(cm5.bus().any_torque(), "then it is an adapter");
    // Nor does it interfere with what the adapter's user does.
    cm5.run_ms(500.0);
    assert!(cm5.bus().any_torque());
}

/// The user of an adapter that was switched to speaks at once.
#[test]
fn an_adapter_s_user_ends_the_repetitions() {
    let mut cm5 = VirtualCm5::new();
    arm(&mut cm5);
    assert_eq!(ask(&mut cm5, &Command::Mode(Mode::Bridge)), Some(Ok(())));
    cm5.send_bytes(&[0xff, 0xff, 4, 4, 3, 24, 1, 0xff - 36]);
    cm5.run_ms(300.0);
    assert!(cm5.bus().servo(4).unwrap().torque_is_on());
}

#[test]
fn any_button_ends_an_adapter() {
    use handstand_firmware::panel::button;
    let on = [0xff, 0xff, 4, 4, 3, 24, 1, 0xff - 36];
    for (down, after) in [
        (button::START, Condition::Balance),
        (button::UP, Condition::Stream),
        (button::LEFT, Condition::Stream),
    ] {
        let mut cm5 = VirtualCm5::new();
        cm5.run_ms(250.0);
        cm5.send_bytes(&on);
        cm5.run_ms(20.0);
        assert!(cm5.bus().any_torque());
        cm5.board.buttons = down;
        // Its user goes on, and reaches nobody.
        for _ in 0..40 {
            cm5.send_bytes(&on);
            cm5.run_ms(10.0);
        }
        assert!(!cm5.bus().any_torque(), "button {down}");
        assert_eq!(cm5.app.condition(), after);
    }
}

/// In a fault twice in every eighth tick, for a servo may have missed it: more would take the bus.
#[test]
fn a_fault_says_torque_off_in_every_eighth_tick() {
    let mut cm5 = VirtualCm5::new();
    arm(&mut cm5);
    cm5.run_ms(1000.0);
    assert_eq!(cm5.app.condition(), Condition::Fault(Cause::LinkLost));
    let before = cm5.bus().torque_offs.len();
    cm5.run_ms(800.0);
    assert_eq!(cm5.bus().torque_offs.len() - before, 20);
}
