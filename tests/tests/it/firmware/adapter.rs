//! The plain adapter.

use handstand_cm5_sim::{STARTED_MS, XServo};
use handstand_measure::bench::*;
use handstand_shared::control_table::models::ServoModel;
use handstand_shared::control_table::x::GOAL_POSITION;
use handstand_shared::dynamixel::{ErrorBits, Packet};
use handstand_shared::dynamixel2 as two;

/// Existing tools see a plain adapter: their packets go through, and so do the answers.
pub fn is_a_plain_adapter(bench: &mut impl SimulatedCm5) {
    // Before, nothing passes: torque is still being switched off.
    bench.run_ms(STARTED_MS);
    bench.clear();
    bench.send_bytes(&[0xff, 0xff, 3, 2, 1, 0xf9]);
    bench.run_ms(10.0);
    assert_eq!(bench.raw(), [0xff, 0xff, 3, 2, 0, 0xfa]);
    bench.clear();
    bench.send_bytes(&[0xff, 0xff, 1, 4, 2, 36, 8, 0xff - 51]);
    bench.run_ms(10.0);
    let packet = Packet::new(bench.raw()).expect("a sound answer");
    assert_eq!((packet.id(), ErrorBits(packet.code())), (1, ErrorBits(0)));
    assert_eq!(packet.parameters().len(), 8);
    // Ids and registers of zero go to the servos too.
    bench.clear();
    bench.send_bytes(&[0xff, 0xff, 1, 4, 2, 0, 2, 0xff - 9]);
    bench.run_ms(10.0);
    assert_eq!(
        Packet::new(bench.raw()).map(|p| p.parameters().to_vec()),
        Ok(vec![12, 0])
    );
    passes_protocol_2(bench);
}

/// Packets of Protocol 2.0 pass whole, whatever zeros they hold, and so do frames behind them.
fn passes_protocol_2(bench: &mut impl SimulatedCm5) {
    let model = ServoModel::named("xl430").expect("a known model");
    bench.bus().x.servos.push(XServo::new(model, 40, 45));
    let goal = two::Request::Write {
        address: GOAL_POSITION.address,
        data: &[0, 2, 0, 0],
    };
    for (request, length) in [
        (two::Request::Ping, 14),
        (goal, 11),
        (two::Request::Ping, 14),
    ] {
        let mut out = [0; 32];
        let sent = request.emit(40, &mut out).expect("it fits");
        bench.clear();
        bench.send_bytes(&out[..sent]);
        bench.run_ms(15.0);
        let packet = two::Packet::new(bench.raw()).expect("a whole status packet");
        assert_eq!((packet.id(), packet.bytes().len()), (40, length));
    }
    assert_eq!(bench.bus().x.servos[0].get(GOAL_POSITION), 512);
}

#[test]
fn the_adapter_is_transparent() {
    is_a_plain_adapter(&mut VirtualCm5::new());
}
