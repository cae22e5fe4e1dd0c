//! Tables of an SQLite file, read page by page: as much of the format as rosbag2 needs.
//!
//! <https://www.sqlite.org/fileformat2.html>: a table is a tree of pages whose leaves hold rows; a
//! long row goes on in pages of its own.

/// The first bytes of a file.
const MAGIC: &[u8] = b"SQLite format 3\0";
/// Levels of a tree; 2^31 pages make 20.
const DEEPEST: usize = 64;

/// An SQLite file.
pub(super) struct Sqlite<'a> {
    bytes: &'a [u8],
    page_size: usize,
    /// Bytes of a page that hold content.
    usable: usize,
}

/// A value of a row.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    Null,
    Integer(i64),
    Real(f64),
    /// Text or a blob.
    Bytes(Vec<u8>),
}

impl Value {
    pub fn text(&self) -> Option<&str> {
        match self {
            Value::Bytes(bytes) => std::str::from_utf8(bytes).ok(),
            _ => None,
        }
    }
}

/// A row: its number and its values.
pub(super) type Row = (i64, Vec<Value>);

/// What is wrong with a file.
type Damage = &'static str;

/// What takes the rows of a table, with the names of its columns.
type Visitor<'v> = dyn FnMut(&[String], Row) -> Result<(), Damage> + 'v;

impl<'a> Sqlite<'a> {
    /// # Errors
    /// Bytes that are no such file.
    pub fn open(bytes: &'a [u8]) -> Result<Self, Damage> {
        if !bytes.starts_with(MAGIC) || bytes.len() < 100 {
            return Err("not an SQLite file");
        }
        let page_size = match u16::from_be_bytes([bytes[16], bytes[17]]) {
            1 => 65536,
            size => usize::from(size),
        };
        if !(512..=65536).contains(&page_size) || !page_size.is_power_of_two() {
            return Err("its page size is none");
        }
        let usable = page_size - usize::from(bytes[20]);
        if usable >= 480 {
            Ok(Sqlite {
                bytes,
                page_size,
                usable,
            })
        } else {
            Err("its pages have no room")
        }
    }

    /// Whether writers keep rows in a second file.
    pub fn has_log_of_writes(&self) -> bool {
        self.bytes[18] == 2
    }

    /// Hands every row of a table to `visitor`, and the names of its columns before.
    ///
    /// # Errors
    /// No such table, broken pages, and what the visitor refuses.
    pub fn rows(&self, table: &str, visitor: &mut Visitor<'_>) -> Result<(), Damage> {
        let mut found = None;
        self.walk(1, &mut |(_, values)| {
            if let [kind, name, _, Value::Integer(root), sql, ..] = values.as_slice()
                && kind.text() == Some("table")
                && name.text() == Some(table)
            {
                let root = usize::try_from(*root).map_err(|_| "a table begins on no page")?;
                found = Some((root, columns(sql.text().unwrap_or_default())));
            }
            Ok(())
        })?;
        let (root, columns) = found.ok_or("it lacks a table of rosbag2")?;
        self.walk(root, &mut |row| visitor(&columns, row))
    }

    fn page(&self, number: usize) -> Result<&'a [u8], Damage> {
        let from = number
            .checked_sub(1)
            .and_then(|page| page.checked_mul(self.page_size));
        let from = from.ok_or("a page that is not there")?;
        let page = self.bytes.get(from..from.saturating_add(self.page_size));
        page.ok_or("it ends in the middle of a table")
    }

    fn walk(
        &self,
        root: usize,
        visitor: &mut dyn FnMut(Row) -> Result<(), Damage>,
    ) -> Result<(), Damage> {
        let mut seen = vec![false; self.bytes.len() / self.page_size + 1];
        self.tree(root, 0, &mut seen, visitor)
    }

    fn tree(
        &self,
        number: usize,
        depth: usize,
        seen: &mut [bool],
        visitor: &mut dyn FnMut(Row) -> Result<(), Damage>,
    ) -> Result<(), Damage> {
        let page = self.page(number)?;
        if depth > DEEPEST || std::mem::replace(&mut seen[number - 1], true) {
            return Err("its pages lead in a ring");
        }
        // The file's own header stands on the first page.
        let head = if number == 1 { 100 } else { 0 };
        let kind = page[head];
        let cells = usize::from(u16::from_be_bytes([page[head + 3], page[head + 4]]));
        let pointers = head + if kind == 5 { 12 } else { 8 };
        for cell in 0..cells {
            let at = short(page, pointers + 2 * cell)?;
            match kind {
                5 => self.tree(long(page, at)?, depth + 1, seen, visitor)?,
                13 => visitor(self.row(page, at)?)?,
                _ => return Err("a page of another kind than a table's"),
            }
        }
        match kind {
            5 => self.tree(long(page, head + 8)?, depth + 1, seen, visitor),
            13 => Ok(()),
            _ => Err("a page of another kind than a table's"),
        }
    }

    fn row(&self, page: &'a [u8], at: usize) -> Result<Row, Damage> {
        let mut at = at;
        let length =
            usize::try_from(varint(page, &mut at)?).map_err(|_| "a row of negative length")?;
        let number = varint(page, &mut at)?;
        if length > self.bytes.len() {
            return Err("a row longer than the file");
        }
        let payload = self.payload(page, at, length)?;
        Ok((number, values(&payload)?))
    }

    /// A row's bytes: those on its page, and those it goes on with.
    fn payload(&self, page: &'a [u8], at: usize, length: usize) -> Result<Vec<u8>, Damage> {
        let most = self.usable - 35;
        let here = if length <= most {
            length
        } else {
            let least = (self.usable - 12) * 32 / 255 - 23;
            let fitting = least + (length - least) % (self.usable - 4);
            if fitting <= most { fitting } else { least }
        };
        let mut payload = page
            .get(at..at + here)
            .ok_or("a row ends beyond its page")?
            .to_vec();
        let mut next = if here < length {
            long(page, at + here)?
        } else {
            0
        };
        while payload.len() < length {
            let page = self.page(next)?;
            let more = (length - payload.len()).min(self.usable - 4);
            payload.extend(&page[4..4 + more]);
            next = long(page, 0)?;
        }
        Ok(payload)
    }
}

fn short(bytes: &[u8], at: usize) -> Result<usize, Damage> {
    let two = bytes.get(at..at + 2).ok_or("a number beyond its page")?;
    Ok(usize::from(u16::from_be_bytes([two[0], two[1]])))
}

fn long(bytes: &[u8], at: usize) -> Result<usize, Damage> {
    let four = bytes.get(at..at + 4).ok_or("a number beyond its page")?;
    Ok(u32::from_be_bytes([four[0], four[1], four[2], four[3]]) as usize)
}

/// A number of one to nine bytes, seven bits each, eight of the ninth.
fn varint(bytes: &[u8], at: &mut usize) -> Result<i64, Damage> {
    let mut value: u64 = 0;
    for place in 0..9 {
        let byte = *bytes.get(*at).ok_or("a number beyond its page")?;
        *at += 1;
        if place == 8 {
            return Ok(((value << 8) | u64::from(byte)) as i64);
        }
        value = (value << 7) | u64::from(byte & 0x7f);
        if byte < 0x80 {
            break;
        }
    }
    Ok(value as i64)
}

fn values(payload: &[u8]) -> Result<Vec<Value>, Damage> {
    let mut at = 0;
    let head = usize::try_from(varint(payload, &mut at)?).unwrap_or(usize::MAX);
    if head > payload.len() {
        return Err("a row's head is longer than the row");
    }
    let mut from = head;
    let mut values = Vec::new();
    while at < head {
        let kind = varint(payload, &mut at)?;
        let length = match kind {
            0 | 8 | 9 => 0,
            1..=4 => kind as usize,
            5 => 6,
            6 | 7 => 8,
            12.. => ((kind - 12) / 2) as usize,
            _ => return Err("a value of an unknown kind"),
        };
        let end = from.checked_add(length).ok_or("a value beyond its row")?;
        let bytes = payload.get(from..end).ok_or("a value beyond its row")?;
        from = end;
        let integer = || {
            let sign = bytes.first().map_or(0, |byte| (*byte as i8 >> 7) as i64);
            bytes
                .iter()
                .fold(sign, |value, byte| (value << 8) | i64::from(*byte))
        };
        values.push(match kind {
            0 => Value::Null,
            8 => Value::Integer(0),
            9 => Value::Integer(1),
            1..=6 => Value::Integer(integer()),
            7 => Value::Real(f64::from_bits(integer() as u64)),
            _ => Value::Bytes(bytes.to_vec()),
        });
    }
    Ok(values)
}

/// Names of the columns in `CREATE TABLE t(a INTEGER, b TEXT, ..)`.
fn columns(sql: &str) -> Vec<String> {
    let list = sql.split_once('(').map_or("", |(_, list)| list);
    let name = |part: &str| {
        let word = part.split_whitespace().next().unwrap_or_default();
        word.trim_matches(['"', '`', '[', ']', '\'', ')'])
            .to_lowercase()
    };
    list.split(',').map(name).collect()
}
