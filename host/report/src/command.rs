//! Command lines within sentences, set as code that a button copies.

use maud::{Markup, html};

/// What every command line begins with.
const PROGRAM: &str = "handstand ";

/// A sentence with its command line, which follows a colon and ends it, and with what stands in
/// backquotes, as code.
pub(super) fn with_commands(sentence: &str) -> Markup {
    let start = sentence
        .match_indices(PROGRAM)
        .find(|(at, _)| sentence[..*at].ends_with(": "));
    match start {
        Some((at, _)) => html! {
            (quoted(sentence[..at].trim_end()))
            span.commanded { code.command { (sentence[at..].trim_end()) } }
        },
        None => quoted(sentence),
    }
}

/// A text whose parts in backquotes are code.
pub(super) fn quoted(text: &str) -> Markup {
    let parts: Vec<&str> = text.split('`').collect();
    // An odd quote quotes nothing.
    if parts.len().is_multiple_of(2) {
        return html! { (text) };
    }
    html! {
        @for (index, part) in parts.iter().enumerate() {
            @if index % 2 == 0 { (part) } @else { code { (part) } }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_line_is_code_to_the_end_and_prose_is_not() {
        let set = |text: &str| with_commands(text).into_string();
        assert_eq!(
            set("Add it: handstand add 'my model.toml' viscous@1 -o b.toml"),
            "Add it:<span class=\"commanded\"><code class=\"command\">handstand add 'my \
             model.toml' viscous@1 -o b.toml</code></span>"
        );
        assert_eq!(
            set("`add` writes it; see handstand compare."),
            "<code>add</code> writes it; see handstand compare."
        );
        assert_eq!(set("a ` alone <b>"), "a ` alone &lt;b&gt;");
    }
}
