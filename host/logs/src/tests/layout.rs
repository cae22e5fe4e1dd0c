//! Where the names stand, and whether they fit the rows: the same words from every reader.

use super::*;
use crate::RawLog;

/// What is said of a text by who reads it with a model, and by who reads it without.
#[track_caller]
fn said(text: &str) -> (Option<usize>, String) {
    let log = file(text.as_bytes(), ".csv");
    let request = LogRequest::whole(log.path());
    let errors = [
        read(std::slice::from_ref(&request), &columns()).unwrap_err(),
        RawLog::read_request(&request).unwrap_err(),
    ];
    let told = errors.map(|error| {
        let Error::Data { place, problem } = &error else {
            panic!("{error}");
        };
        (place.line, format!("{problem}: {}", problem.remedy))
    });
    assert_eq!(told[0].0, told[1].0, "{told:?}");
    let ([with, _], [_, without]) = (told.clone(), told);
    assert_eq!(with.1.replace(", and no column 't_s'", ""), without.1);
    without
}

fn lines(row: impl Fn(usize) -> String) -> String {
    (0..20).map(|k| row(k) + "\n").collect()
}

#[test]
fn decimal_commas_between_commas_are_one_error() {
    let comma = |value: f64| format!("{value:.3}").replace('.', ",");
    let (t, q) = (
        |k: usize| 0.01 * k as f64,
        |k: usize| (0.3 * k as f64).sin(),
    );
    let cases = [
        lines(|k| format!("{},{}", comma(t(k)), comma(q(k)))),
        lines(|k| format!("\"{}\",\"{}\"", comma(t(k)), comma(q(k)))),
        // Some numbers are whole.
        lines(|k| format!("{k},\"{}\"", comma(q(k)))),
        lines(|k| format!("{},{}", k, comma(q(k)))),
    ];
    for rows in cases {
        for names in ["t_s,q", "time_s,q_rad"] {
            let (line, said) = said(&format!("{names}\n{rows}"));
            assert_eq!(line, Some(2));
            assert!(said.contains("decimal commas"), "{said}");
            assert!(said.contains("export with ;"), "{said}");
        }
    }
    // Behind lines that do not show it, too.
    let whole: String = (0..100).map(|k| format!("{k},2,3\n")).collect();
    let late = format!("t_s,q,u\n{whole}100,\"0,5\",1\n");
    let remedy = read_text(&late, &columns())
        .unwrap_err()
        .remedy()
        .unwrap()
        .into_owned();
    assert!(remedy.contains("export with ;"), "{remedy}");
}

#[test]
fn names_that_do_not_fit_the_rows_are_one_error() {
    let (line, said) = said(&format!(
        "\"Time\",\"angle\"\n{}",
        lines(|k| format!("{}.5,0.{k},0.0,0.1", k))
    ));
    assert_eq!(line, Some(1));
    assert!(said.contains("has 2, the rows have 4 fields"), "{said}");
    assert!(said.contains("name every column"), "{said}");
}

#[test]
fn a_header_under_a_preamble_is_pointed_at() {
    let rows = lines(|k| format!("{}e-3,0.{k},1.5", k));
    let preambles = [
        // An oscilloscope; a title; key and value.
        ("Model,TDS2024\nFirmware,1.0\n\nTIME,CH1,CH2\n", 4),
        ("Log of the bench\nt,q,u\n", 2),
        ("Source,CH1\nInterval,1e-3\nRecord length,20\nt,q,u\n", 4),
    ];
    for (preamble, names) in preambles {
        let (line, said) = said(&format!("{preamble}{rows}"));
        assert_eq!(line, Some(1), "{said}");
        assert!(said.contains(&format!("line {names} looks like")), "{said}");
    }
    let (line, said) = said(&format!("t,q,u\ns,deg,%\n{rows}"));
    assert_eq!(line, Some(2));
    assert!(said.contains("of units"), "{said}");
}

#[test]
fn a_file_without_names_is_said_to_have_none() {
    let (line, said) = said(&lines(|k| format!("0.{k:02},0.5,1")));
    assert_eq!(line, Some(1));
    assert!(said.contains("numbers where the column names"), "{said}");
}

#[test]
fn names_in_comments_and_blanks_between_fields_are_read() {
    let plain = rows("t_s,q,u", ',');
    let expected = read_text(&plain, &columns()).unwrap();
    let dialects = [
        // MATLAB and rostopic, a comment before, within the rows.
        plain.replace("t_s", "%t_s"),
        format!(
            "% of the bench\n{}",
            plain.replace("0.05,", "% pause\n0.05,")
        ),
        format!("% of the bench\n% {plain}"),
        // Blanks, as gnuplot and Fortran write them.
        plain.replace(',', "  "),
        plain.replace(',', " ").replace("\n0", "\n   0"),
        format!("# {}", plain.replace(',', "\t ")),
        // A separator behind the last field; one decimal comma is fine between others.
        plain.replace('\n', ",\n"),
        plain.replace('\n', ",\n").replacen("u,", "u", 1),
        plain.replace(",0.5,", ",5D-1,"),
        // Bars; blanks between decimal commas; ends of lines as old Macs and some meters write.
        plain.replace(',', "|"),
        plain.replace(',', " | ").replace('.', ","),
        plain.replace(',', " ").replace('.', ","),
        plain.replace('\n', "\r"),
        // Excel says its separator first.
        format!("sep=,\n{plain}"),
        format!("sep=;\r\n{}", plain.replace(',', ";")),
    ];
    for text in dialects {
        let motions = read_text(&text, &columns()).unwrap_or_else(|e| panic!("{e}\n{text}"));
        assert_eq!(motions[0].time_s, expected[0].time_s, "{text}");
        assert_eq!(motions[0].position_rad, expected[0].position_rad, "{text}");
        let raw = RawLog::read(file(text.as_bytes(), ".csv").path()).unwrap();
        assert_eq!(raw.names[..3], ["t_s", "q", "u"], "{text}");
        assert_eq!(raw.columns[0].len(), 12, "{text}");
    }
}

#[test]
fn words_for_nothing_are_gaps() {
    let words = [
        "NA", "NULL", "None", "null", "n/a", "NaN", "<NA>", "-", "--", "1.#QNAN", "-1.#IND",
        "#DIV/0!",
    ];
    for word in words {
        let text = rows("t_s,q,u", ',').replacen("0.06,0.5", &format!("0.06,{word}"), 1);
        let motion = &read_text(&text, &columns()).unwrap()[0];
        assert!(motion.position_rad[0][6].is_nan(), "{word}");
    }
}

#[test]
fn what_errors_repeat_of_a_file_has_a_readable_length() {
    let long = "x".repeat(50_000);
    let many = vec!["y".repeat(2000); 500].join(",");
    for text in [
        long.clone(),
        many,
        format!("{long},q\n1,2\n"),
        format!("t_s,{long}\n1,2\n"),
    ] {
        let log = file(text.as_bytes(), ".csv");
        let request = LogRequest::whole(log.path());
        let mut errors = vec![read(std::slice::from_ref(&request), &columns()).unwrap_err()];
        let raw = RawLog::read(log.path()).unwrap();
        errors.push(crate::init::Draft::of(&raw, "a.csv", None).unwrap_err());
        for error in errors {
            let said = format!("{error}{}", error.remedy().unwrap());
            assert!(said.len() < 4000, "{}", said.len());
        }
    }
}
