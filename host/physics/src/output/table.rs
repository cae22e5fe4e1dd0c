//! Tables for people: how wide they are, and where they break.

use comfy_table::{ColumnConstraint, ContentArrangement, Table, TableComponent, Width, presets};

/// Longest word that is never broken.
const MOST_UNBROKEN: usize = 40;
/// Longest number with its interval that is never broken.
const MOST_OF_NUMBER: usize = 28;

/// A table without frame, as wide as its text asks and at most as wide as the terminal.
pub fn plain_table<'a>(header: impl IntoIterator<Item = &'a str>) -> Table {
    let mut table = Table::new();
    table
        .load_preset(presets::UTF8_HORIZONTAL_ONLY)
        .set_content_arrangement(ContentArrangement::Dynamic)
        .set_header(header)
        .remove_style(TableComponent::HorizontalLines)
        .remove_style(TableComponent::MiddleIntersections);
    table
}

/// The table as wide as the terminal; where there is none, at most so many characters.
pub fn within_width(mut table: Table, most: u16) -> Table {
    if table.width().is_none() {
        table.set_width(most);
    }
    unbroken(table)
}

/// The table with columns as wide as their longest word, that no identifier or number is broken;
/// words as long as hashes may be. It is wider than it shall be where words leave no room.
pub fn unbroken(mut table: Table) -> Table {
    let columns = table.column_count();
    let longest = |index: usize| {
        let rows = table.header().into_iter().chain(table.row_iter());
        let cells = rows.filter_map(|row| row.cell_iter().nth(index));
        let words = cells.flat_map(|cell| word_lengths(&cell.content()));
        words.filter(|length| *length <= MOST_UNBROKEN).max()
    };
    let widths: Vec<Option<usize>> = (0..columns).map(longest).collect();
    for (column, longest) in table.column_iter_mut().zip(widths) {
        let width = longest.unwrap_or_default() as u16 + column.padding_width();
        column.set_constraint(ColumnConstraint::LowerBoundary(Width::Fixed(width)));
    }
    table
}

/// How long the parts of a cell are that stay in one line: its words; of a number with what belongs
/// to it, as the ends of its interval, the whole.
fn word_lengths(cell: &str) -> Vec<usize> {
    let length = |text: &str| text.chars().count();
    let number = cell.starts_with(|sign: char| sign.is_ascii_digit() || "-><".contains(sign));
    if number && length(cell) <= MOST_OF_NUMBER {
        vec![length(cell)]
    } else {
        cell.split_whitespace().map(length).collect()
    }
}

/// A cell that stays empty without a value.
pub fn or_empty<V: ToString>(value: Option<V>) -> String {
    value.map_or(String::new(), |value| value.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_narrow_table_breaks_between_words_only() {
        let address = "link1.inertia_kg_m2";
        let why = "the moment of inertia about the centre of mass of the first link";
        let mut table = plain_table(["Parameter", "Value", "Why"]);
        table.add_row([address, "0.0015625", why]);
        table.set_width(48);
        assert!(
            !table.to_string().contains(address),
            "nothing to mend:\n{table}"
        );
        let table = unbroken(table).to_string();
        for word in [address, "0.0015625"].into_iter().chain(why.split(' ')) {
            assert!(table.contains(word), "{word}:\n{table}");
        }
        assert!(table.lines().count() > 5, "{table}");
    }

    #[test]
    fn a_hash_does_not_make_a_table_wide() {
        let mut table = plain_table(["SHA-256", "Why"]);
        table.add_row(["f".repeat(64).as_str(), "a"]);
        table.set_width(40);
        let table = unbroken(table).to_string();
        assert!(
            table.lines().all(|line| line.chars().count() <= 40),
            "{table}"
        );
    }
}
