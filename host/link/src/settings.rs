//! What a servo keeps without power, as a file.

use super::port::SerialLink;
use super::protocol::Protocol;
use super::servo_error::ServoResult;
use super::servo_rows::Model;
use super::servos::Servos;
use crate::error::{Error, Place, Result};
use handstand_shared::control_table::{self as ct, Access, Item, Register};
use std::fmt::Write as _;
use std::path::Path;
use toml_edit::{Document, TableLike};

/// Settings of one servo.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Settings {
    /// Its id.
    pub id: u8,
    codes: Vec<(Item, i32)>,
}

impl Settings {
    /// Reads all EEPROM registers.
    ///
    /// # Errors
    /// Why there is no good answer.
    pub fn read<L: SerialLink>(servos: &mut Servos<L>, id: u8) -> ServoResult<Settings> {
        let mut codes = Vec::new();
        for item in servos.items(id)?.iter().filter(|item| item.is_eeprom) {
            codes.push((*item, servos.code(id, item)?));
        }
        Ok(Settings { id, codes })
    }

    /// Code of a register by its name.
    pub fn code(&self, name: &str) -> Option<i32> {
        let mut codes = self.codes.iter();
        codes
            .find(|(item, _)| item.is_named(name))
            .map(|(_, code)| *code)
    }

    /// Code of a register that all servos have.
    pub fn get(&self, register: Register) -> Option<i32> {
        self.code(register.name)
    }

    /// What can be written back: all but id, baud rate and protocol, by which the servo is spoken
    /// to.
    pub fn restorable(&self) -> impl Iterator<Item = (Item, i32)> {
        let fixed = |item: &Item| {
            let named = [ct::ID.name, ct::BAUD.name, ct::x::PROTOCOL.name];
            named.contains(&item.name) || item.access == Access::Read
        };
        self.codes
            .iter()
            .copied()
            .filter(move |(item, _)| !fixed(item))
    }

    /// The text of a file that [`Settings::load`] reads.
    pub fn to_toml(servos: &[Settings]) -> String {
        let mut text = String::from(
            "# Settings of servos: codes of the EEPROM area of their control tables.\n",
        );
        for servo in servos {
            text += "\n[[servo]]\n";
            for (item, code) in &servo.codes {
                // Writing to a string does not fail.
                let _ = writeln!(text, "{} = {code}", key(item.name));
            }
        }
        text
    }

    /// Reads a file.
    ///
    /// # Errors
    /// A file that cannot be read; at its place, a key that is no register, a code out of its
    /// range, a register missing.
    pub fn load(path: &Path) -> Result<Vec<Settings>> {
        let text =
            std::fs::read_to_string(path).map_err(|error| Error::file(path, "read", error))?;
        Settings::parse(&text, path)
    }

    /// As [`Settings::load`], of text; `path` names it in errors.
    ///
    /// # Errors
    /// As [`Settings::load`].
    pub fn parse(text: &str, path: &Path) -> Result<Vec<Settings>> {
        let file = Text { text, path };
        let document = Document::parse(text).map_err(|error| {
            let at = error.span().map_or(0, |span| span.start);
            file.error(at, format!("not TOML: {}", error.message().trim()))
        })?;
        let servos = document
            .get("servo")
            .and_then(toml_edit::Item::as_array_of_tables);
        let servos = servos.ok_or_else(|| file.error(0, "there is no [[servo]]"))?;
        let settings: Vec<Settings> = servos
            .iter()
            .map(|table| file.servo(table, table.span().map_or(0, |s| s.start)))
            .collect::<Result<_>>()?;
        for (place, servo) in settings.iter().enumerate() {
            if settings[..place].iter().any(|other| other.id == servo.id) {
                return Err(file.error(0, format!("servo {} is there twice", servo.id)));
            }
        }
        Ok(settings)
    }
}

fn key(name: &str) -> String {
    name.replace(' ', "_")
}

/// What a servo of this model number keeps without power, by address; none of a number that is not
/// known. Without a number it is the AX-12's, of which the number is missing.
fn kept(model: Option<i64>) -> Option<Vec<Item>> {
    let number = match model {
        Some(number) => u16::try_from(number).ok()?,
        None => ct::MODEL.default,
    };
    let model = Model::of(Protocol::One, number).or_else(|| Model::of(Protocol::Two, number))?;
    let items = model.items().into_iter();
    Some(items.filter(|item| item.is_eeprom).collect())
}

struct Text<'a> {
    text: &'a str,
    path: &'a Path,
}

impl Text<'_> {
    fn servo(&self, table: &dyn TableLike, at: usize) -> Result<Settings> {
        let mut codes: Vec<(Item, i32)> = Vec::new();
        let model = table
            .get(&key(ct::MODEL.name))
            .and_then(toml_edit::Item::as_integer);
        let rows = kept(model).ok_or_else(|| {
            let number = model.unwrap_or_default();
            self.error(
                at,
                format!("`model_number` {number} is no model that is known"),
            )
        })?;
        for (name, item) in table.iter() {
            let at = table
                .key(name)
                .and_then(toml_edit::Key::span)
                .map_or(at, |span| span.start);
            let row = rows.iter().find(|row| row.is_named(name));
            let row = row.ok_or_else(|| {
                self.error(at, format!("`{name}` is no register that a servo keeps"))
            })?;
            let code = item.as_integer().and_then(|code| i32::try_from(code).ok());
            let code = code.filter(|code| (row.min..=row.max).contains(code));
            let code = code.ok_or_else(|| {
                let what = format!(
                    "`{name}` cannot be {}: it goes from {} to {}",
                    item.to_string().trim(),
                    row.min,
                    row.max
                );
                self.error(at, what)
            })?;
            codes.push((*row, code));
        }
        let has = |row: &Item| codes.iter().any(|(own, _)| own == row);
        if let Some(missing) = rows.iter().find(|row| !has(row)) {
            return Err(self.error(at, format!("`{}` is missing", key(missing.name))));
        }
        let mut settings = Settings { id: 0, codes };
        settings.id = settings.get(ct::ID).map_or(0, |code| code as u8);
        Ok(settings)
    }

    fn error(&self, at: usize, what: impl Into<String>) -> Error {
        let before = self.text.get(..at).unwrap_or("");
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
        Error::data(
            Place::at(self.path, line, column),
            what,
            "give a file as `handstand bus backup` writes it",
        )
    }
}

#[cfg(test)]
#[cfg(feature = "virtual-cm5")]
mod tests {
    use super::super::Servos;
    use super::*;
    use crate::virtual_cm5::SimLink;

    fn saved() -> Vec<Settings> {
        let mut servos = Servos::new(SimLink::adapter("ids=1+5").unwrap());
        servos.set(5, ct::CCW_LIMIT, 800).unwrap();
        [1, 5]
            .map(|id| Settings::read(&mut servos, id).unwrap())
            .into()
    }

    #[test]
    fn what_is_written_is_read_back() {
        let text = Settings::to_toml(&saved());
        assert!(text.contains("\nccw_angle_limit = 800\n"), "{text}");
        assert_eq!(
            Settings::parse(&text, Path::new("a.toml")).unwrap(),
            saved()
        );
    }

    #[test]
    fn servos_of_protocol_2_keep_signs_and_their_own_rows() {
        let mut servos = Servos::new(SimLink::adapter("model=XM430-W350,ids=3").unwrap());
        servos.set_code(3, &ct::x::HOMING_OFFSET, -100).unwrap();
        let saved = vec![Settings::read(&mut servos, 3).unwrap()];
        let text = Settings::to_toml(&saved);
        assert!(text.contains("\nhoming_offset = -100\n"), "{text}");
        assert!(text.contains("\ncurrent_limit = 1193\n"), "{text}");
        assert_eq!(Settings::parse(&text, Path::new("a.toml")).unwrap(), saved);
        let fixed = ["id", "baud rate", "protocol type", "model number"];
        let mut restored = saved[0].restorable();
        assert!(restored.all(|(item, _)| !fixed.contains(&item.name)));
    }

    #[test]
    fn bad_files_are_named_by_line_and_column() {
        let good = Settings::to_toml(&saved());
        for (from, to, said) in [
            ("id = 5", "id = 500", "a.toml:22:1: `id` cannot be 500"),
            ("id = 5", "idd = 5", "a.toml:22:1: `idd` is no register"),
            ("id = 5", "id = 1", "servo 1 is there twice"),
            ("alarm_led = 36\n", "", "`alarm_led` is missing"),
            ("id = 5", "id 5", "a.toml:22:4: not TOML"),
            ("[[servo]]", "[[serv]]", "there is no [[servo]]"),
        ] {
            let error = Settings::parse(&good.replace(from, to), Path::new("a.toml")).unwrap_err();
            assert!(error.to_string().contains(said), "{said}: {error}");
        }
    }
}
