//! Motions of too few rows, as the reader takes them.

use super::*;

/// Segments of so many rows each.
fn segments(rows: &[usize]) -> String {
    let whole = text(&motion("whole", rows.iter().sum()));
    let mut lines = whole.lines();
    let mut log = format!("{},seg\n", lines.next().unwrap());
    for (segment, rows) in rows.iter().enumerate() {
        let taken = lines.by_ref().take(*rows);
        taken.for_each(|line| log += &format!("{line},{segment}\n"));
    }
    log
}

fn short(text: &str, model: &Model) -> Vec<(Severity, Option<usize>, String)> {
    let all = found(text, model);
    let wrong = all.into_iter().filter(|f| f.severity != Severity::Note);
    let said = wrong.map(|f| (f.severity, f.place.unwrap().line, f.what));
    said.collect()
}

#[test]
fn a_short_segment_is_warned_of_once_as_the_reader_does() {
    let mut servo = servo();
    servo.log.segment = Some("seg".into());
    let said = "2 motions of 1 to 5 rows (lines 2, 603-607) are left out; 10 rows are the least";
    let stray = segments(&[1, 600, 5, 400]);
    let warned = [(Severity::Warn, Some(2), said.to_string())];
    assert_eq!(short(&stray, &servo), warned);
    let log = tempfile::Builder::new().suffix(".csv").tempfile().unwrap();
    std::fs::write(log.path(), &stray).unwrap();
    let requests = [LogRequest::whole(log.path())];
    let (_, of_reader) = crate::read_with_findings(&requests, &servo.log).unwrap();
    let of_check = check(&requests, &servo).unwrap();
    let warned: Vec<_> = of_check.iter().filter(|f| f.kind == "short").collect();
    assert_eq!(of_reader.iter().collect::<Vec<_>>(), warned);
    // What is left out is not judged either.
    finds(&of_check, Severity::Note, "q in 2 motions");
    let refused = (
        Severity::Refuse,
        Some(2),
        "a motion of 5 rows; 10 are the least",
    );
    let all = short(&segments(&[5, 3]), &servo);
    assert_eq!(all, [(refused.0, refused.1, refused.2.to_string())]);
}

#[test]
fn a_stray_row_that_lacks_a_value_costs_itself() {
    let mut servo = servo();
    servo.log.segment = Some("seg".into());
    let stray = segments(&[600, 1]);
    let line = stray.lines().last().unwrap();
    let empty = format!("{},,0,1", line.split(',').next().unwrap());
    let all = short(&stray.replace(line, &empty), &servo);
    assert_eq!(all.len(), 1, "{all:?}");
    assert_eq!((all[0].0, all[0].1), (Severity::Warn, Some(602)));
}

#[test]
fn rows_that_a_moved_column_lacks_do_not_count() {
    let mut servo = servo();
    servo.log.segment = Some("seg".into());
    first(&mut servo.log.joints[0].input).shift_s = 0.025;
    let all = short(&segments(&[11, 600]), &servo);
    assert!(
        all[0].2.contains("a motion of 8 rows (lines 2-12)"),
        "{all:?}"
    );
}
