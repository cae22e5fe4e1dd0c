//! Buttons.

use super::condition;
use handstand_measure::bench::*;
use handstand_shared::message::*;

#[test]
fn any_button_stops_an_armed_robot() {
    let mut rig = VirtualCm5::new();
    arm(&mut rig);
    rig.board.buttons = handstand_firmware::panel::button::LEFT;
    for _ in 0..5 {
        rig.send(&Command::KeepAlive);
        rig.run_ms(10.0);
    }
    assert!(!rig.bus().any_torque());
}

#[test]
fn start_chooses_balancing_and_moves_nothing() {
    let mut rig = VirtualCm5::new();
    rig.board.buttons = handstand_firmware::panel::button::START;
    rig.run_ms(20.0);
    assert_eq!(rig.app.condition(), Condition::Bridge, "it may be bouncing");
    assert_eq!(condition(&mut rig), Some(Condition::Balance));
    rig.board.buttons = handstand_firmware::panel::button::UP;
    rig.run_ms(50.0);
    assert_eq!(rig.app.condition(), Condition::Balance);
    assert!(!rig.bus().any_torque());
}
