//! BAM's logs.

use super::*;

fn bam(change: &str, to: &str) -> Result<Vec<Motion>, Error> {
    let entries: Vec<String> = (0..12)
        .map(|i| format!(
            r#"{{"timestamp": 0.{i:02}, "position": 0.5, "speed": 1, "input_volts": 12.0, "goal_position": 0.{i}, "torque_enable": true}}"#
        ))
        .collect();
    let text = format!(
        r#"{{"mass": 0.5, "length": 0.1, "kp": 32, "entries": [{}]}}"#,
        entries.join(",")
    );
    let log = file(text.replacen(change, to, 1).as_bytes(), ".json");
    read(&[LogRequest::whole(log.path())], &columns())
}

#[test]
fn reads_bam_logs() {
    let motion = &bam("", "").unwrap()[0];
    assert_eq!(motion.len(), 12);
    assert_eq!(motion.supply_v.as_ref().unwrap()[3], 12.0);
    assert!(motion.torque_on.as_ref().unwrap()[3]);
    assert!(bam("\"speed\": 1,", "").unwrap()[0].velocity_rad_s[0].is_none());
    for (change, to, what) in [
        (
            "\"position\": 0.5",
            "\"position\": \"far\"",
            "entry 0, position: \"far\" is not a number",
        ),
        (
            "\"goal_position\": 0.3,",
            "",
            "entry 3, goal_position: nothing is not a number",
        ),
        (
            "\"timestamp\": 0.05",
            "\"timestamp\": 0.01",
            "entry 5, timestamp: time does not increase",
        ),
        (
            "\"torque_enable\": true",
            "\"torque_enable\": \"on\"",
            "entry 0, torque_enable",
        ),
        ("entries", "samples", "no list 'entries'"),
        ("{\"mass\"", "{mass", "1:2: not JSON"),
    ] {
        let error = bam(change, to).unwrap_err();
        assert!(error.to_string().contains(what), "{what}: {error}");
    }
}

#[test]
fn mass_length_and_gain_are_held_against_the_model() {
    let arm = |mass_kg, com_m| LogColumns {
        arm: Some(ArmFigures { mass_kg, com_m }),
        ..columns()
    };
    let text = |kp: u32| {
        let entry = |i: u32| {
            format!(
                "{{\"timestamp\": {}, \"position\": 0.5, \"goal_position\": 0.5}}",
                f64::from(i)
            )
        };
        let entries: Vec<String> = (0..12).map(entry).collect();
        let entries = entries.join(",");
        format!(
            "{{\"mass\": 0.5, \"length\": 0.1, \"arm_mass\": 0.04, \"kp\": {kp}, \"entries\": [{entries}]}}"
        )
    };
    let log = file(text(32).as_bytes(), ".json");
    let request = LogRequest::whole(log.path());
    let read_as = |columns: &LogColumns| read(std::slice::from_ref(&request), columns);
    assert!(read_as(&arm(0.54, 0.096)).is_ok());
    assert!(read_as(&columns()).is_ok());
    for (wrong, what) in [
        (arm(0.2, 0.1), "mass is 0.5400 kg"),
        (arm(0.54, 0.2), "mass times length"),
    ] {
        let said = read_as(&wrong).unwrap_err().to_string();
        assert!(said.contains(what), "{said}");
    }
    let other = file(text(16).as_bytes(), ".json");
    let both = [request.clone(), LogRequest::whole(other.path())];
    let said = read(&both, &columns()).unwrap_err().to_string();
    assert!(said.contains("kp is 16, and 32 in"), "{said}");
}
