#[cfg(simavr)]
#[test]
fn profile() {
    use handstand_shared::message::*;
    let elf = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../target/avr/avr-none/avr/handstand-firmware.elf");
    let mut rig = handstand_simavr::Rig::new(&elf).unwrap();
    rig.run_ms(5.0);
    rig.say(&Command::Hello { version: VERSION });
    rig.run_ms(20.0);
    rig.say(&Command::Mode(Mode::Stream));
    rig.run_ms(300.0);
    let mut out = String::new();
    for _ in 0..20000 {
        let c = rig.core.cycle();
        rig.run_until(c + 173);
        out += &format!("{:#x}\n", rig.core.pc());
    }
    std::fs::write("/tmp/pcs", out).unwrap();
}
