//! Columns that cannot be read, and single cells.

use super::*;

/// A good log whose field `column` of each row becomes what `change` makes of it.
fn changed(column: usize, change: impl Fn(usize, &str) -> String) -> String {
    let good = text(&good());
    let lines = good.lines().enumerate().map(|(index, line)| {
        let fields = line.split(',').enumerate();
        let fields = fields.map(|(at, field)| {
            if at == column && index > 0 {
                change(index, field)
            } else {
                field.to_string()
            }
        });
        fields.collect::<Vec<_>>().join(",")
    });
    lines.collect::<Vec<_>>().join("\n")
}

fn stamp(index: usize) -> String {
    format!("2024-05-01T10:00:{:05.2}Z", 0.01 * (index - 1) as f64)
}

type Refused = (&'static str, (Option<usize>, Option<usize>), String, String);

fn refused(text: &(impl AsRef<[u8]> + ?Sized), model: &Model) -> Vec<Refused> {
    let all = found(text, model);
    let refused = all.into_iter().filter(|f| f.severity == Severity::Refuse);
    let told = refused.map(|f| {
        let place = f.place.unwrap();
        (f.kind, (place.line, place.column), f.what, f.remedy)
    });
    told.collect()
}

/// The one thing that a log is refused for.
#[track_caller]
fn only(text: &str, model: &Model) -> Refused {
    let mut all = refused(text, model);
    assert_eq!(all.len(), 1, "{all:#?}");
    all.remove(0)
}

#[test]
fn stamps_where_numbers_are_declared_are_one_finding_that_names_the_unit() {
    let stamps = changed(0, |index, _| stamp(index));
    let (kind, place, what, remedy) = only(&stamps, &servo());
    assert_eq!((kind, place), ("column", (Some(2), Some(1))));
    let said = "t_s: '2024-05-01T10:00:00.00Z' is a time stamp, not a number; and 599 more lines \
                like it";
    assert_eq!(what, said);
    assert!(remedy.contains("unit = \"iso8601\""), "{remedy}");
    // With that unit the log is fit for use.
    let mut mended = servo();
    mended.log.time.unit = Unit::named("iso8601", None).unwrap();
    assert_eq!(refused(&stamps, &mended), []);
}

#[test]
fn a_column_that_cannot_be_read_is_one_finding_with_its_remedy() {
    let mut stamped = servo();
    stamped.log.time.unit = Unit::named("iso8601", None).unwrap();
    let mut flagged = servo();
    flagged.log.torque_on = Some("u".into());
    type Cell = fn(usize, &str) -> String;
    let cases: [(usize, Cell, &Model, &str, &str); 6] = [
        (
            0,
            |_, field| field.into(),
            &stamped,
            "not a time stamp",
            "unit = \"s\"",
        ),
        (
            0,
            |_, _| "noon".into(),
            &stamped,
            "'noon' is not a time",
            "save the times",
        ),
        (
            0,
            |_, _| String::new(),
            &servo(),
            "nothing is not a number",
            "name another one",
        ),
        (
            1,
            |_, field| format!("{field}rad"),
            &servo(),
            "'0rad' is not a",
            "decimal point",
        ),
        (
            1,
            |_, _| "2e7".into(),
            &servo(),
            "beyond the 1000000 rad",
            "check the column's unit",
        ),
        (
            2,
            |_, _| "on".into(),
            &flagged,
            "'on' is not 0 or 1",
            "as 0 and 1",
        ),
    ];
    for (column, change, model, said, mended) in cases {
        let (kind, place, what, remedy) = only(&changed(column, change), model);
        assert_eq!(
            (kind, place),
            ("column", (Some(2), Some(column + 1))),
            "{said}"
        );
        assert!(what.contains(said), "{what}");
        assert!(what.ends_with("; and 599 more lines like it"), "{what}");
        assert!(remedy.contains(mended), "{remedy}");
    }
}

#[test]
fn single_cells_keep_their_lines_beside_a_column() {
    let few = changed(1, |index, field| match index {
        3 | 5 => "x".into(),
        _ => field.into(),
    });
    let all = refused(&few, &servo());
    assert_eq!((all.len(), all[0].0, all[0].1.0), (1, "cell", Some(4)));
    let said = "q: 'x' is not a number; and 1 more like it, in line 6";
    assert_eq!(all[0].2, said);
    assert!(all[0].3.contains("delete the line"), "{all:?}");
    // A line of units below the names, stamps below it.
    let units = changed(0, |index, _| match index {
        1 => "[s]".into(),
        _ => stamp(index),
    });
    let all = refused(&units, &servo());
    let kinds: Vec<_> = all
        .iter()
        .map(|(kind, place, ..)| (*kind, place.0))
        .collect();
    assert_eq!(kinds, [("column", Some(3)), ("cell", Some(2))]);
    assert!(all[0].2.ends_with("and 598 more lines like it"), "{all:?}");
}

#[test]
fn a_byte_that_is_no_text_costs_its_row_and_what_lies_behind_is_judged() {
    let broken = changed(1, |index, field| match index {
        4 => "@".into(),
        9 => "x".into(),
        _ => field.into(),
    });
    let bytes: Vec<u8> = broken
        .bytes()
        .map(|b| if b == b'@' { 0xff } else { b })
        .collect();
    let all = refused(&bytes, &servo());
    let told: Vec<_> = all
        .iter()
        .map(|(_, place, what, _)| (*place, what.as_str()))
        .collect();
    let expected = [
        ((Some(5), Some(2)), "not UTF-8: byte 0xff"),
        ((Some(10), Some(2)), "q: 'x' is not a number"),
    ];
    assert_eq!(told, expected);
}
