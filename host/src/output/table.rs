//! Rows as a table for people, and as CSV.

use comfy_table::{ContentArrangement, Table, TableComponent, presets};

/// A column: its heading, and what a row has under it.
pub type TableColumn<'a, T> = (&'a str, &'a dyn Fn(&T) -> String);

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

/// A plain table, a line for each of `rows`.
pub fn table_of<'r, T: 'r>(
    rows: impl IntoIterator<Item = &'r T>,
    columns: &[TableColumn<T>],
) -> Table {
    let mut table = plain_table(columns.iter().map(|(heading, _)| *heading));
    for row in rows {
        table.add_row(columns.iter().map(|(_, cell)| cell(row)));
    }
    table
}

/// The table as wide as the terminal; where there is none, at most so many characters.
pub fn within_width(mut table: Table, most: u16) -> Table {
    if table.width().is_none() {
        table.set_width(most);
    }
    table
}

/// CSV: the headings, then a line for each of `rows`. No cell holds a comma.
pub fn csv_of<'r, T: 'r>(
    rows: impl IntoIterator<Item = &'r T>,
    columns: &[TableColumn<T>],
) -> String {
    let headings: Vec<&str> = columns.iter().map(|(heading, _)| *heading).collect();
    let mut text = headings.join(",") + "\n";
    for row in rows {
        let cells: Vec<String> = columns.iter().map(|(_, cell)| cell(row)).collect();
        text += &(cells.join(",") + "\n");
    }
    text
}

/// A cell that stays empty without a value.
pub fn or_empty<V: ToString>(value: Option<V>) -> String {
    value.map_or(String::new(), |value| value.to_string())
}
