//! What is refused, and where the complaint points.

use super::*;

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
    type Refusal<'a> = (
        String,
        &'a LogColumns,
        Option<usize>,
        Option<usize>,
        &'a str,
    );
    let cases: &[Refusal] = &[
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
            plain.replace("0.06,0.5", ",0.5"),
            &columns(),
            Some(8),
            Some(1),
            "nothing is not a number",
        ),
        (
            plain.replace("0.06,0.5", "NaN,0.5"),
            &columns(),
            Some(8),
            Some(1),
            "'NaN' is not finite",
        ),
        (
            plain.replace(",0.5,", ",,"),
            &columns(),
            None,
            None,
            "q holds no value",
        ),
        (
            plain.replace(",-1\n", ",nan\n"),
            &columns(),
            None,
            None,
            "u holds no value",
        ),
        (
            plain.replace("0.06,0.5,-1", "0.06,0.5,inf"),
            &columns(),
            Some(8),
            Some(3),
            "'inf' is not finite",
        ),
        (
            plain.replace("0.06,0.5,-1", "0.06,1e200,-1"),
            &columns(),
            Some(8),
            Some(2),
            "q: '1e200' is 1.000e200 rad, beyond the 1000000 rad that a reading may be",
        ),
        (
            plain.replace("0.06,0.5,-1", "0.06,0.5,-2e6"),
            &columns(),
            Some(8),
            Some(3),
            "u: '-2e6' is -2.000e6 rad",
        ),
        (
            plain.replace("0.06", "1e200"),
            &columns(),
            Some(8),
            Some(1),
            "time jumps from 0.05 s to 1e200 s",
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
fn time_that_goes_back_is_refused_with_its_remedy() {
    let late = rows("t_s,q,u", ',').replace("0.06", "0.01");
    let log = file(late.as_bytes(), ".csv");
    let error = read(&[LogRequest::whole(log.path())], &columns()).unwrap_err();
    let said = ":8:1: time does not increase: 0.01 s after 0.05 s";
    assert!(error.to_string().ends_with(said), "{error}");
    assert_eq!(
        error.remedy().unwrap(),
        "cut the log there, mark the recordings in a segment column, or name a range of rows"
    );
}

#[test]
fn a_stamp_among_numbers_names_the_unit_that_it_has() {
    let stamped = rows("t_s,q,u", ',').replace("\n0.", "\n2024-05-01T10:00:00.");
    let log = file(stamped.as_bytes(), ".csv");
    let error = read(&[LogRequest::whole(log.path())], &columns()).unwrap_err();
    let said = ":2:1: t_s: '2024-05-01T10:00:00.00' is a time stamp, not a number";
    assert!(error.to_string().ends_with(said), "{error}");
    assert!(error.remedy().unwrap().contains("unit = \"iso8601\""));
}
