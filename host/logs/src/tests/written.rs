//! What is written reads back, byte for byte.

use super::*;

#[test]
fn what_is_written_reads_back() {
    let mut columns = columns();
    columns.payload = Some(column("payload_g", "g"));
    columns.turned = Some("turned".into());
    columns.segment = Some("segment".into());
    columns.torque_on = Some("on".into());
    columns.supply = Some(column("supply", "mV"));
    *first(&mut columns.joints[0].position) = Column {
        offset: 0.25,
        reversed: true,
        ..column("q_ticks", "ticks")
    };
    let mut motion = motion("a", 50);
    motion.payload_kg = 0.05;
    motion.turned = true;
    motion.supply_v = Some(vec![11.1; 50]);
    motion.torque_on = Some((0..50).map(|i| i < 30).collect());
    let text = to_csv(&motion, &columns, &["made by hand\ntwice".into()]);
    assert!(
        text.starts_with(
            "# payload_g = 50\n# turned = 1\n# segment = 0\n# made by hand\n# twice\n"
        )
    );
    let read = &read_text(&text, &columns).unwrap()[0];
    let near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-10);
    assert!(near(&read.time_s, &motion.time_s));
    assert!(near(&read.position_rad[0], &motion.position_rad[0]));
    assert!(near(
        read.input[0].as_ref().unwrap(),
        motion.input[0].as_ref().unwrap()
    ));
    assert!(near(
        read.supply_v.as_ref().unwrap(),
        motion.supply_v.as_ref().unwrap()
    ));
    assert_eq!(read.torque_on, motion.torque_on);
    assert_eq!((read.payload_kg, read.turned), (0.05, true));
}

#[test]
fn hashes_the_bytes() {
    let plain = rows("t_s,q,u", ',');
    let motion = &read_text(&plain, &columns()).unwrap()[0];
    use sha2::Digest;
    let expected: String = sha2::Sha256::digest(&plain)
        .iter()
        .map(|b| format!("{b:02x}"))
        .collect();
    assert_eq!(motion.source.sha256, expected);
}
