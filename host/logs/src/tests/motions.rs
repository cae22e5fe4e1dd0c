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

/// Segments of so many rows each, with their names; a second lies between them.
fn segments(rows: &[(&str, usize)]) -> String {
    let mut text = String::from("seg,t_s,q,u\n");
    for (index, (segment, rows)) in rows.iter().enumerate() {
        let row = |k| index as f64 + 0.01 * f64::from(k);
        (0..*rows as u32).for_each(|k| text += &format!("{segment},{},0,0\n", row(k)));
    }
    text
}

fn read_told(text: &str, columns: &LogColumns) -> (Vec<usize>, Vec<String>) {
    let log = file(text.as_bytes(), ".csv");
    let requests = [LogRequest::whole(log.path())];
    let (motions, findings) = read_with_findings(&requests, columns).unwrap();
    assert!(findings.iter().all(|f| f.severity == Severity::Warn));
    let path = log.path().display().to_string();
    let said = |finding: &LogFinding| finding.statement().replace(&path, "f");
    (
        motions.iter().map(Motion::len).collect(),
        findings.iter().map(said).collect(),
    )
}

#[test]
fn a_short_motion_costs_itself_and_is_told_once_a_file() {
    let mut by_segment = columns();
    by_segment.segment = Some("seg".into());
    let mut by_gap = columns();
    by_gap.split_at_gap_s = Some(0.5);
    let text = segments(&[("x", 1), ("a", 20), ("y", 3), ("b", 20), ("z", 9)]);
    let said = "f:2: 3 motions of 1 to 9 rows (lines 2, 23-25, 46-54) are left out; 10 rows are \
                the least";
    for columns in [&by_segment, &by_gap] {
        let (rows, findings) = read_told(&text, columns);
        assert_eq!((rows, findings), (vec![20, 20], vec![said.to_string()]));
    }
    let (_, findings) = read_told(&segments(&[("a", 20), ("b", 20)]), &by_segment);
    assert!(findings.is_empty(), "{findings:?}");
    // A stray row need not hold what a motion must.
    let (rows, _) = read_told(&text.replacen("x,0,0,0", "x,0,,0", 1), &by_segment);
    assert_eq!(rows, [20, 20]);
    // What moving a column leaves of 11 rows is too short.
    first(&mut by_segment.joints[0].input).shift_s = 0.025;
    let (rows, findings) = read_told(&segments(&[("a", 11), ("b", 20)]), &by_segment);
    assert_eq!(rows, [17]);
    assert!(
        findings[0].contains("a motion of 8 rows (lines 2-12)"),
        "{findings:?}"
    );
}

#[test]
fn a_log_of_nothing_but_short_motions_is_refused() {
    let mut columns = columns();
    columns.segment = Some("seg".into());
    let text = segments(&[("x", 2), ("y", 9)]);
    let (line, _, what) = refused(&text, &columns);
    assert_eq!(
        (line, &*what),
        (Some(2), "a motion of 2 rows; 10 are the least")
    );
    let log = file(segments(&[("a", 20)]).as_bytes(), ".csv");
    let few = LogRequest {
        rows: Some((4, 6)),
        ..LogRequest::whole(log.path())
    };
    let error = read(&[few], &columns).unwrap_err();
    assert!(
        error
            .to_string()
            .ends_with(":6: a motion of 3 rows; 10 are the least"),
        "{error}"
    );
}
