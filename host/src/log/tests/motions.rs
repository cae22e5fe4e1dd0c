//! Constants from comments; how a log is cut into motions.

use super::*;

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
