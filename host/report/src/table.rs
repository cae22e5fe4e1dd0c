//! Tables of results: a column is written once, and a terminal, a page and a CSV file show it.

use crate::output::table::{plain_table, unbroken};
use comfy_table::{CellAlignment, Table};
use maud::{Markup, html};
use std::borrow::Cow;

/// Class of numbers.
const NUMBER: &str = "number";

/// What a row has under a column, as text.
type TextCell<'a, T> = Box<dyn Fn(&T) -> String + 'a>;
/// Whether it is good news.
type Judge<'a, T> = Box<dyn Fn(&T) -> bool + 'a>;
/// The same as a page draws it.
type PageCell<'a, T> = Box<dyn Fn(&T) -> Markup + 'a>;

/// The columns of a table whose rows are `T`, written one after the other.
#[must_use]
pub struct Columns<'a, T>(Vec<TableColumn<'a, T>>);

/// A column: its heading, and what a row has under it.
struct TableColumn<'a, T> {
    heading: Cow<'a, str>,
    page_heading: Option<&'a str>,
    /// Absent of what only a page can show.
    text: Option<TextCell<'a, T>>,
    /// Absent where a page shows the text.
    page: Option<PageCell<'a, T>>,
    /// Whether what stands there is good news.
    is_good: Option<Judge<'a, T>>,
    class: Option<&'static str>,
}

/// The columns of a table whose rows are `T`: none yet.
pub fn columns_of<'a, T>() -> Columns<'a, T> {
    Columns(Vec::new())
}

impl<'a, T> Columns<'a, T> {
    /// And a column of words.
    pub fn text(self, heading: impl Into<Cow<'a, str>>, text: impl Fn(&T) -> String + 'a) -> Self {
        self.with(heading.into(), Some(Box::new(text)), None)
    }

    /// And a column of numbers, which stand under each other.
    pub fn number(
        self,
        heading: impl Into<Cow<'a, str>>,
        text: impl Fn(&T) -> String + 'a,
    ) -> Self {
        self.text(heading, text).class(NUMBER)
    }

    /// And a column that pages alone have: a picture, a field to fill in.
    pub fn drawn(self, heading: impl Into<Cow<'a, str>>, page: impl Fn(&T) -> Markup + 'a) -> Self {
        self.with(heading.into(), None, Some(Box::new(page)))
    }

    fn with(
        mut self,
        heading: Cow<'a, str>,
        text: Option<TextCell<'a, T>>,
        page: Option<PageCell<'a, T>>,
    ) -> Self {
        self.0.push(TableColumn {
            heading,
            page_heading: None,
            text,
            page,
            is_good: None,
            class: None,
        });
        self
    }

    /// On pages the last column is drawn so: as code, as a link, with a picture beside it.
    pub fn drawn_as(self, page: impl Fn(&T) -> Markup + 'a) -> Self {
        self.with_last(|last| last.page = Some(Box::new(page)))
    }

    /// On pages the last column has the colour of good or of bad news.
    pub fn judged(self, is_good: impl Fn(&T) -> bool + 'a) -> Self {
        self.with_last(|last| last.is_good = Some(Box::new(is_good)))
    }

    /// On pages the last column is called so.
    pub fn called(self, page_heading: &'a str) -> Self {
        self.with_last(|last| last.page_heading = Some(page_heading))
    }

    /// On pages the last column is of this class.
    pub fn class(self, class: &'static str) -> Self {
        self.with_last(|last| last.class = Some(class))
    }

    fn with_last(mut self, change: impl FnOnce(&mut TableColumn<'a, T>)) -> Self {
        self.0.last_mut().map(change);
        self
    }

    /// Those that are text.
    fn texts<'c>(&'c self) -> impl Iterator<Item = (&'c TableColumn<'a, T>, &'c TextCell<'a, T>)> {
        let columns = self.0.iter();
        columns.filter_map(|column| Some((column, column.text.as_ref()?)))
    }
}

impl<T> TableColumn<'_, T> {
    fn markup(&self, row: &T) -> Markup {
        let cell = match (&self.page, &self.text) {
            (Some(page), _) => page(row),
            (None, Some(text)) => in_lines(&text(row)),
            (None, None) => html! {},
        };
        match &self.is_good {
            Some(is_good) => {
                let class = if is_good(row) { "good" } else { "bad" };
                html! { span class=(class) { (cell) } }
            }
            None => cell,
        }
    }
}

/// Lines below each other.
fn in_lines(text: &str) -> Markup {
    html! { @for (index, line) in text.lines().enumerate() { @if index > 0 { br; } (line) } }
}

/// A plain table for a terminal, a line for each of `rows`.
pub fn table_of<'r, T: 'r>(rows: impl IntoIterator<Item = &'r T>, columns: &Columns<T>) -> Table {
    let mut table = plain_table(columns.texts().map(|(column, _)| &*column.heading));
    for row in rows {
        table.add_row(columns.texts().map(|(_, text)| text(row)));
    }
    table
}

/// The lines of such a table, `width` characters long, numbers under each other; nothing without
/// rows.
pub(crate) fn table_lines<'r, T: 'r>(
    rows: impl IntoIterator<Item = &'r T>,
    columns: &Columns<T>,
    width: u16,
) -> Option<String> {
    let mut table = table_of(rows, columns);
    table.set_width(width);
    table = unbroken(table);
    for (own, (column, _)) in table.column_iter_mut().zip(columns.texts()) {
        if column.class == Some(NUMBER) {
            own.set_cell_alignment(CellAlignment::Right);
        }
    }
    let lines = table.lines().map(|line| line.trim_end().to_string());
    let lines: Vec<String> = lines.collect();
    (!table.is_empty()).then(|| lines.join("\n"))
}

/// CSV: the headings, then a line for each of `rows`. No cell holds a comma.
pub fn csv_of<'r, T: 'r>(rows: impl IntoIterator<Item = &'r T>, columns: &Columns<T>) -> String {
    let headings: Vec<&str> = columns
        .texts()
        .map(|(column, _)| &*column.heading)
        .collect();
    let mut csv = headings.join(",") + "\n";
    for row in rows {
        let cells: Vec<String> = columns.texts().map(|(_, text)| text(row)).collect();
        csv += &(cells.join(",") + "\n");
    }
    csv
}

/// A page's table, a line for each of `rows`.
pub fn page_table<'r, T: 'r>(
    rows: impl IntoIterator<Item = &'r T>,
    columns: &Columns<T>,
) -> Markup {
    page_table_with(rows, columns, |_| None)
}

/// The same with a class for some rows.
pub fn page_table_with<'r, T: 'r>(
    rows: impl IntoIterator<Item = &'r T>,
    columns: &Columns<T>,
    class: impl Fn(&T) -> Option<&'static str>,
) -> Markup {
    let headings = html! {
        @for own in &columns.0 {
            (heading(own.page_heading.unwrap_or(&own.heading), own.class))
        }
    };
    let rows = html! {
        @for row in rows {
            tr class=[class(row)] {
                @for own in &columns.0 { td class=[own.class] { (own.markup(row)) } }
            }
        }
    };
    scrolling(None, &headings, &rows)
}

/// A page's table of rows whose first has the columns' headings, and whose first cells are those of
/// the rows; the others are numbers.
pub fn page_matrix(rows: &[impl AsRef<[String]>]) -> Markup {
    let mut rows = rows.iter().map(|row| row.as_ref().iter().enumerate());
    let headings = html! {
        @for (index, name) in rows.next().into_iter().flatten() {
            (heading(name, (index > 0).then_some(NUMBER)))
        }
    };
    let rows = html! {
        @for row in rows {
            tr { @for (index, cell) in row {
                @if index == 0 { th scope="row" { (cell) } } @else { td.number { (cell) } }
            } }
        }
    };
    scrolling(Some("matrix"), &headings, &rows)
}

/// A column's heading; one without words is no heading to a screen reader.
fn heading(words: &str, class: Option<&str>) -> Markup {
    html! {
        @if words.is_empty() { td {} } @else { th scope="col" class=[class] { (words) } }
    }
}

/// A table that scrolls sideways where it is too wide.
fn scrolling(class: Option<&str>, headings: &Markup, rows: &Markup) -> Markup {
    html! {
        div.scroll tabindex="0" {
            table class=[class] { thead { tr { (headings) } } tbody { (rows) } }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_is_the_same_on_a_terminal_a_page_and_in_a_file() {
        let columns = columns_of::<(&str, f64)>()
            .text("Name", |(name, _)| name.to_string())
            .drawn("Link", |(name, _)| html! { a href=(name) { "<" } })
            .number("Size, m", |(_, size_m)| size_m.to_string())
            .judged(|(_, size_m)| *size_m < 1.0)
            .text("", |_| "a\nb".to_string())
            .called("Note");
        let rows = [("short", 0.5), ("long", 20.5)];
        let csv = csv_of(&rows, &columns);
        assert!(csv.starts_with("Name,Size, m,\nshort,0.5,a\nb\n"), "{csv}");
        let text = table_lines(&rows, &columns, 60).unwrap();
        assert!(
            text.contains(" short       0.5") && !text.contains('<'),
            "{text}"
        );
        assert_eq!(table_lines(&rows[..0], &columns, 60), None);
        let page = page_table_with(&rows, &columns, |row| (row.1 > 1.0).then_some("best"));
        let page = page.into_string();
        for part in [
            "<th scope=\"col\">Note</th>",
            "<td class=\"number\"><span class=\"bad\">20.5</span></td>",
            "<a href=\"long\">&lt;</a>",
            "<tr class=\"best\">",
            "<td>a<br>b</td>",
        ] {
            assert!(page.contains(part), "{part}: {page}");
        }
    }
}
