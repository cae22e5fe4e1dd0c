//! Logs as different programs write them.

use super::*;

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
