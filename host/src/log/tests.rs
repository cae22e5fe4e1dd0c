//! Dialects, refusals, the round trip, hostile bytes, and the real logs.

use super::fixture::{column, columns, model, motion, position_drive};
use super::*;
use crate::error::Error;
use crate::model::{Column, LogColumns};
use proptest::prelude::*;

fn file(bytes: &[u8], ending: &str) -> tempfile::NamedTempFile {
    let file = tempfile::Builder::new().suffix(ending).tempfile().unwrap();
    std::fs::write(file.path(), bytes).unwrap();
    file
}

fn read_text(text: &str, columns: &LogColumns) -> Result<Vec<Motion>, Error> {
    let file = file(text.as_bytes(), ".csv");
    read(&[LogRequest::whole(file.path())], columns)
}

/// Twelve rows `t,q,u`, below `header`.
fn rows(header: &str, separator: char) -> String {
    let mut text = format!("{header}\n");
    for i in 0..12 {
        text += &format!("0.{i:02}{separator}0.5{separator}-1\n");
    }
    text
}

fn refused(text: &str, columns: &LogColumns) -> (Option<usize>, Option<usize>, String) {
    match read_text(text, columns).unwrap_err() {
        Error::Data {
            place,
            what,
            remedy,
        } => {
            assert!(!remedy.is_empty());
            (place.line, place.column, what)
        }
        other => panic!("{other}"),
    }
}

#[test]
fn reads_every_dialect_alike() {
    let plain = rows("t_s,q,u", ',');
    let crlf = plain.replace('\n', "\r\n");
    let dialects = [
        plain.clone(),
        format!("\u{feff}{plain}"),
        format!("{crlf}\r\n"),
        rows("t_s;q;u", ';').replace('.', ","),
        rows("t_s;q;u", ';'),
        rows("t_s\tq\tu", '\t'),
        format!(
            "# a bench\n\n{}",
            plain.replace("0.05,", "# pause\n\n0.05,")
        ),
        plain
            .replace("t_s,q,u", "\"t_s\", \"q\" ,u")
            .replace(",0.5", ",\"0.5\""),
        plain.replace("t_s,q,u", "# t_s,q,u"),
        plain.replace('\n', ",\n").replace("u,", "u,note"),
        plain.replace("t_s", ",t_s").replace("\n0", "\n7,0"),
    ];
    let expected = read_text(&plain, &columns()).unwrap();
    assert_eq!(expected[0].len(), 12);
    assert_eq!(expected[0].source.lines, (2, 13));
    for text in dialects {
        let motions = read_text(&text, &columns()).unwrap_or_else(|e| panic!("{e}\n{text}"));
        assert_eq!(motions.len(), 1, "{text}");
        assert_eq!(motions[0].time_s, expected[0].time_s, "{text}");
        assert_eq!(motions[0].position_rad, expected[0].position_rad, "{text}");
        assert_eq!(motions[0].input, expected[0].input, "{text}");
    }
}

#[test]
fn lines_count_comments_and_blanks() {
    let text = format!(
        "# rig\r\n\r\n{}",
        rows("t_s,q,u", ',').replace("0.03,0.5", "\n# here\n0.03,x")
    );
    let (line, column, what) = refused(&text, &columns());
    assert_eq!((line, column), (Some(9), Some(2)));
    assert_eq!(what, "q: 'x' is not a number");
}

#[test]
fn each_refusal_names_its_place() {
    let plain = rows("t_s,q,u", ',');
    let mut with_payload = columns();
    with_payload.payload = Some(column("payload_g", "g"));
    with_payload.turned = Some("turned".into());
    let carrying = |change: &str| {
        let text = plain
            .replace("u\n", "u,payload_g,turned\n")
            .replace("-1\n", "-1,50,0\n");
        text.replace("0.06,0.5,-1,50,0", change)
    };
    type Case<'a> = (
        String,
        &'a LogColumns,
        Option<usize>,
        Option<usize>,
        &'a str,
    );
    let cases: &[Case] = &[
        (String::new(), &columns(), None, None, "no header line"),
        (
            "# only\n\n".into(),
            &columns(),
            None,
            None,
            "no header line",
        ),
        ("t_s,q,u\n".into(), &columns(), None, None, "no sample"),
        (
            plain.replace(",u\n", ",U2\n"),
            &columns(),
            Some(1),
            Some(1),
            "no column 'u'",
        ),
        (
            plain.replace("t_s,", "ts,"),
            &columns(),
            Some(1),
            Some(1),
            "did you mean 'ts'?",
        ),
        (
            plain.replace("t_s,q,u", "1,2,3"),
            &columns(),
            Some(1),
            Some(1),
            "numbers where",
        ),
        (
            plain.replace("q,u", "q,q"),
            &columns(),
            Some(1),
            Some(3),
            "twice",
        ),
        (
            plain.replace("0.06,0.5", "0.06,abc"),
            &columns(),
            Some(8),
            Some(2),
            "'abc' is not a number",
        ),
        (
            plain.replace("0.06,0.5", "0.06,"),
            &columns(),
            Some(8),
            Some(2),
            "nothing is not a number",
        ),
        (
            plain.replace("0.06,0.5", "0.06,NaN"),
            &columns(),
            Some(8),
            Some(2),
            "'NaN' is not finite",
        ),
        (
            plain.replace("0.06,0.5,-1", "0.06,0.5,inf"),
            &columns(),
            Some(8),
            Some(3),
            "'inf' is not finite",
        ),
        (
            plain.replace("0.06", "0.05"),
            &columns(),
            Some(8),
            Some(1),
            "0.05 s after 0.05 s",
        ),
        (
            plain.replace("0.06", "0.01"),
            &columns(),
            Some(8),
            Some(1),
            "0.01 s after 0.05 s",
        ),
        (
            plain.replace("0.06,0.5,-1", "0.06,0.5"),
            &columns(),
            Some(8),
            Some(3),
            "2 fields where the header has 3",
        ),
        (
            plain.replace("0.06,0.5,-1", "0.06,0.5,-1,4"),
            &columns(),
            Some(8),
            Some(4),
            "4 fields",
        ),
        (
            plain.replace("0.06,0.5", "0.06,\"0.5"),
            &columns(),
            Some(8),
            Some(3),
            "2 fields",
        ),
        (
            "t_s,q,u\n0,1,2\n1,2,3\n".into(),
            &columns(),
            Some(2),
            None,
            "2 rows; 10 are the least",
        ),
        (
            carrying("0.06,0.5,-1,60,0"),
            &with_payload,
            Some(8),
            Some(4),
            "0.05 kg to 0.06 kg",
        ),
        (
            carrying("0.06,0.5,-1,50,1"),
            &with_payload,
            Some(8),
            Some(5),
            "turned round",
        ),
        (
            carrying("0.06,0.5,-1,50,2"),
            &with_payload,
            Some(8),
            Some(5),
            "'2' is not 0 or 1",
        ),
    ];
    for (text, columns, line, column, what) in cases {
        let found = refused(text, columns);
        assert!(found.2.contains(what), "{what}: {}", found.2);
        assert_eq!((found.0, found.1), (*line, *column), "{what}");
    }
    let bytes = file(b"t_s,q,u\n0,1,2\n1,\xff,3\n", ".csv");
    let error = read(&[LogRequest::whole(bytes.path())], &columns()).unwrap_err();
    assert!(
        error.to_string().ends_with(":3:2: not UTF-8: byte 0xff"),
        "{error}"
    );
    let absent = read(&[LogRequest::whole("no/such.csv")], &columns()).unwrap_err();
    assert_eq!(absent.exit_code(), 3);
}

#[test]
fn comments_give_constants() {
    let mut columns = columns();
    columns.payload = Some(column("payload_kg", "kg"));
    columns.turned = Some("turned".into());
    let text = format!(
        "# payload_kg = 0.05\n# turned: 1\n# note = tall\n{}",
        rows("t_s,q,u", ',')
    );
    let motions = read_text(&text, &columns).unwrap();
    assert_eq!(motions[0].payload_kg, 0.05);
    assert!(motions[0].turned);
}

#[test]
fn segments_gaps_and_ranges_cut_motions() {
    let mut text = String::from("seg,t_s,q,u\n");
    for segment in ["a", "b", "a"] {
        for i in 0..20 {
            text += &format!("{segment},{},0,0\n", 0.01 * f64::from(i));
        }
    }
    let log = file(text.as_bytes(), ".csv");
    let stem = log
        .path()
        .file_name()
        .unwrap()
        .to_str()
        .unwrap()
        .to_string();
    let mut columns = columns();
    columns.segment = Some("seg".into());
    let names = |requests: &[LogRequest], columns: &LogColumns| -> Vec<(String, usize)> {
        let motions = read(requests, columns).unwrap();
        motions
            .into_iter()
            .map(|m| (m.name.replace(&stem, "f"), m.time_s.len()))
            .collect()
    };
    let whole = LogRequest::whole(log.path());
    let expected = [("f#a", 20), ("f#b", 20), ("f#a.2", 20)].map(|(n, c)| (n.to_string(), c));
    assert_eq!(names(std::slice::from_ref(&whole), &columns), expected);
    let part = LogRequest {
        rows: Some((25, 59)),
        ..whole.clone()
    };
    assert_eq!(
        names(&[part], &columns),
        [("f:25-59#b".to_string(), 15), ("f:25-59#a".to_string(), 20)]
    );
    let beyond = LogRequest {
        rows: Some((25, 60)),
        ..whole
    };
    let error = read(&[beyond], &columns).unwrap_err();
    assert!(error.to_string().contains("it has 60 rows"), "{error}");

    columns.segment = None;
    columns.split_at_gap_s = Some(0.5);
    let gapped: String = (0..30)
        .map(|i| {
            format!(
                "{},0,0\n",
                0.01 * f64::from(i) + if i < 15 { 0.0 } else { 2.0 }
            )
        })
        .collect();
    let motions = read_text(&format!("t_s,q,u\n{gapped}"), &columns).unwrap();
    assert_eq!(motions.len(), 2);
    assert!(motions[1].name.ends_with("#1"));
    assert_eq!(motions[1].source.lines, (17, 31));
}

#[test]
fn a_range_leaves_out_broken_rows() {
    let text = rows("t_s,q,u", ',').replace("0.00,0.5", "0.00,broken");
    let log = file(text.as_bytes(), ".csv");
    let part = LogRequest {
        path: log.path().into(),
        rows: Some((1, 11)),
    };
    assert_eq!(read(&[part], &columns()).unwrap()[0].len(), 11);
}

#[test]
fn what_is_written_reads_back() {
    let mut columns = columns();
    columns.payload = Some(column("payload_g", "g"));
    columns.turned = Some("turned".into());
    columns.segment = Some("segment".into());
    columns.torque_on = Some("on".into());
    columns.supply = Some(column("supply", "mV"));
    columns.joints[0].position = Column {
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

/// Reads and judges, whatever comes of it.
fn survive(log: &tempfile::NamedTempFile) {
    let request = [LogRequest::whole(log.path())];
    let _ = read(&request, &columns());
    let _ = check(&request, &model(position_drive(), columns()));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn arbitrary_bytes_are_survived(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        for ending in [".csv", ".json"] {
            let log = file(&bytes, ending);
            survive(&log);
        }
    }

    #[test]
    fn mutated_logs_are_survived(at in 0usize..200, byte in any::<u8>(), cut in 0usize..200, twice in any::<bool>()) {
        let mut bytes = rows("t_s;q;u", ';').into_bytes();
        let length = bytes.len();
        bytes[at % length] = byte;
        if twice {
            let tail = bytes[cut % length..].to_vec();
            bytes.extend(tail);
        } else {
            bytes.truncate(length - cut % length);
        }
        let log = file(&bytes, ".csv");
        survive(&log);
    }
}
