//! What a servo keeps without power, as a file.

use super::port::SerialLink;
use super::servo_error::ServoResult;
use super::servos::Servos;
use crate::error::{Error, Place, Result};
use handstand_shared::control_table::{self as ct, Access, REGISTERS, Register};
use std::fmt::Write as _;
use std::path::Path;
use toml_edit::{Document, Item, TableLike};

/// Settings of one servo.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Settings {
    /// Its id.
    pub id: u8,
    codes: Vec<(Register, u16)>,
}

impl Settings {
    /// Reads all EEPROM registers.
    ///
    /// # Errors
    /// Why there is no good answer.
    pub fn read<L: SerialLink>(servos: &mut Servos<L>, id: u8) -> ServoResult<Settings> {
        let mut codes = Vec::new();
        for register in REGISTERS.iter().filter(|register| register.is_eeprom()) {
            codes.push((*register, servos.get(id, *register)?));
        }
        Ok(Settings { id, codes })
    }

    /// Code of a register.
    pub fn get(&self, register: Register) -> Option<u16> {
        self.codes
            .iter()
            .find(|(own, _)| *own == register)
            .map(|(_, code)| *code)
    }

    /// What can be written back: all but id and baud rate, by which the servo is spoken to.
    pub fn restorable(&self) -> impl Iterator<Item = (Register, u16)> {
        let fixed = |register: &Register| {
            *register == ct::ID || *register == ct::BAUD || register.access == Access::Read
        };
        self.codes
            .iter()
            .copied()
            .filter(move |(register, _)| !fixed(register))
    }

    /// The text of a file that [`Settings::load`] reads.
    pub fn to_toml(servos: &[Settings]) -> String {
        let mut text = String::from(
            "# Settings of servos: codes of the AX-12's control table, EEPROM area.\n",
        );
        for servo in servos {
            text += "\n[[servo]]\n";
            for (register, code) in &servo.codes {
                // Writing to a string does not fail.
                let _ = writeln!(text, "{} = {code}", key(register));
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
        let servos = document.get("servo").and_then(Item::as_array_of_tables);
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

fn key(register: &Register) -> String {
    register.name.replace(' ', "_")
}

struct Text<'a> {
    text: &'a str,
    path: &'a Path,
}

impl Text<'_> {
    fn servo(&self, table: &dyn TableLike, at: usize) -> Result<Settings> {
        let mut codes = Vec::new();
        for (name, item) in table.iter() {
            let at = table
                .key(name)
                .and_then(toml_edit::Key::span)
                .map_or(at, |span| span.start);
            let register = Register::named(name).filter(|register| register.is_eeprom());
            let register = register.ok_or_else(|| {
                self.error(at, format!("`{name}` is no register that a servo keeps"))
            })?;
            let code = item.as_integer().and_then(|code| u16::try_from(code).ok());
            let code = code.filter(|code| (register.min..=register.max).contains(code));
            let code = code.ok_or_else(|| {
                let what = format!(
                    "`{name}` cannot be {}: it goes from {} to {}",
                    item.to_string().trim(),
                    register.min,
                    register.max
                );
                self.error(at, what)
            })?;
            codes.push((*register, code));
        }
        let has = |register: Register| codes.iter().any(|(own, _)| *own == register);
        if let Some(missing) = REGISTERS
            .iter()
            .find(|register| register.is_eeprom() && !has(**register))
        {
            return Err(self.error(at, format!("`{}` is missing", key(missing))));
        }
        let id = codes
            .iter()
            .find(|(register, _)| *register == ct::ID)
            .map_or(0, |(_, code)| *code as u8);
        Ok(Settings { id, codes })
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
    use crate::link::virtual_cm5::SimLink;

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
