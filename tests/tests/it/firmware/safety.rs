//! Torque goes off: at the start, and when the link falls silent.

use handstand_measure::bench::*;
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;

pub fn lets_down(bench: &mut impl SimulatedCm5, times: usize) {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let mut worst = Worst::default();
    (0..times).for_each(|_| worst.add(link_loss(bench, &mut rng)));
    assert_eq!(worst.failed, 0);
    assert!(worst.soft_ms <= 100.0 && worst.off_ms <= 300.0, "{worst:?}");
}

#[test]
fn a_silent_link_lets_the_robot_down() {
    lets_down(&mut VirtualCm5::new(), 20);
}

#[test]
fn the_first_thing_on_the_bus_is_torque_off() {
    let mut rig = VirtualCm5::new();
    assert!(
        rig.board.bus.torque_offs[0] < 200_000,
        "{:?} ns",
        rig.board.bus.torque_offs
    );
    rig.run_ms(100.0);
    assert!(!rig.bus().any_torque());
}
