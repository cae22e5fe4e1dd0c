#[cfg(simavr)]
#[test]
fn smoke() {
    use handstand_shared::message::*;
    let elf = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../target/avr/avr-none/avr/handstand-firmware.elf");
    let mut rig = handstand_simavr::Rig::new(&elf).unwrap();
    rig.run_ms(5.0);
    println!(
        "torque offs {:?} cycles {}",
        rig.bus.torque_offs,
        rig.core.byte_cycles(1)
    );
    rig.say(&Command::Hello { version: VERSION });
    rig.run_ms(20.0);
    println!("{:?}", rig.seen.reports);
    rig.say(&Command::Mode(Mode::Stream));
    let t0 = std::time::Instant::now();
    for _ in 0..50 {
        rig.say(&Command::KeepAlive);
        rig.run_ms(10.0);
    }
    println!("wall {:?}", t0.elapsed());
    rig.say(&Command::Ask(Subject::Telemetry));
    rig.run_ms(50.0);
    rig.say(&Command::Ask(Subject::Statistics));
    rig.run_ms(50.0);
    println!("{:#?}", &rig.seen.reports[2..4]);
    println!(
        "n {} bad {} dir {} wait {}",
        rig.seen.reports.len(),
        rig.seen.bad_frames,
        rig.seen.direction_faults,
        rig.seen.most_waiting
    );
    for (_, r) in &rig.seen.reports {
        if !matches!(r, Report::Stream(_)) {
            println!("{r:?}");
        }
    }
}
