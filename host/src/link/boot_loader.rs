//! The CM-5's boot loader (V1.31), which takes a program over the PC line.
//!
//! `#` during reset until the banner, `\r`, prompt `- `; `load 0` -> `Ready..` -> the raw bytes and their sum modulo 256;
//! 150 ms of silence end them -> `Success` or `Error`, `Size:`, `Checksum:XX-YY`; then `verify`, `app` (start the
//! application at power-on), `go`. 57600 8N1. It lies at 0x1E000, so an image has at most 122,880 bytes.

use super::port::Link;
use crate::error::{Error, Place, Result};
use std::path::Path;
use std::time::Duration;

/// Where the boot loader begins: the largest image, bytes.
pub const LARGEST: usize = 122_880;
/// Speed of the boot loader, baud.
pub const BAUD: u32 = 57_600;

const BANNER: &str = "SYSTEM O.K.";
const PROMPT: &str = "- ";
const ANSWER: Duration = Duration::from_secs(2);
/// Writing flash: 4.5 ms per page of 256 bytes, and as much again for a slow clock.
const PAGE: Duration = Duration::from_millis(9);

/// A program as the boot loader takes it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image(Vec<u8>);

impl Image {
    /// Reads a raw binary.
    ///
    /// # Errors
    /// A file that cannot be read; Intel HEX or ELF, which the boot loader would write into flash as they are; too large.
    pub fn load(path: &Path) -> Result<Image> {
        let bytes = std::fs::read(path).map_err(|error| Error::file(path, "read", error))?;
        Image::check(bytes).map_err(|(what, remedy)| Error::data(Place::file(path), what, remedy))
    }

    fn check(bytes: Vec<u8>) -> Result<Image, (String, &'static str)> {
        let bin = "give the raw binary, the `.bin` that `cargo xtask firmware` writes";
        let is_hex = bytes.first() == Some(&b':')
            && bytes
                .iter()
                .take(80)
                .all(|b| b.is_ascii_hexdigit() || b":\r\n".contains(b));
        // The first word of an AVR program is a jump: `jmp` or `rjmp`.
        let is_jump = matches!(bytes[..], [0x0c, 0x94, _, _, ..] | [_, 0xc0..=0xcf, ..]);
        match bytes.len() {
            0 => Err(("the file is empty".to_string(), bin)),
            _ if bytes.starts_with(b"\x7fELF") => {
                Err(("this is an ELF, not a raw binary".to_string(), bin))
            }
            _ if is_hex => Err(("this is Intel HEX, not a raw binary".to_string(), bin)),
            length if length > LARGEST => Err((
                format!("{length} bytes are too many: the boot loader begins at {LARGEST}"),
                "make the program smaller",
            )),
            _ if !is_jump => Err((
                "this is no program for the AVR: it does not begin with a jump".to_string(),
                bin,
            )),
            _ => Ok(Image(bytes)),
        }
    }

    /// Its bytes.
    pub fn bytes(&self) -> &[u8] {
        &self.0
    }

    /// Sum of all bytes modulo 256.
    pub fn checksum(&self) -> u8 {
        self.0
            .iter()
            .fold(0, |sum: u8, byte| sum.wrapping_add(*byte))
    }
}

/// A boot loader that waits for commands.
pub struct BootLoader<L> {
    link: L,
    /// Pause after every byte of an image.
    pace: Duration,
}

impl<L: Link> BootLoader<L> {
    /// Knocks until the boot loader answers, at most for `patience`; `keep_on` is asked meanwhile.
    ///
    /// # Errors
    /// [`Error::Device`] if it does not.
    pub fn enter(
        link: L,
        pace: Duration,
        patience: Duration,
        mut keep_on: impl FnMut() -> bool,
    ) -> Result<Self> {
        let mut loader = BootLoader { link, pace };
        let deadline = loader.link.now() + patience;
        // It may be waiting already.
        loader.link.send(b"\r")?;
        if loader
            .wait(&[PROMPT], Duration::from_millis(300))?
            .is_some()
        {
            return Ok(loader);
        }
        while loader.link.now() < deadline && keep_on() {
            loader.link.send(b"#")?;
            if loader.wait(&[BANNER], Duration::from_millis(20))?.is_some() {
                loader.wait(&["\n"], Duration::from_millis(200))?;
                loader.command("", ANSWER)?;
                return Ok(loader);
            }
        }
        Err(Error::device(
            format!("{}: the boot loader does not answer", loader.link.name()),
            "press the MODE button (reset) while this program knocks; is the cable in the CM-5, the battery on?",
        ))
    }

    /// Sends the image; `sent` is told how many bytes are on their way.
    ///
    /// # Errors
    /// [`Error::Device`]: no answer, or size or checksum differ from ours.
    pub fn load(&mut self, image: &Image, mut sent: impl FnMut(usize)) -> Result<()> {
        self.link.clear()?;
        self.link.send(b"load 0\r")?;
        let ready = self.wait(&["Ready"], ANSWER)?;
        ready.ok_or_else(|| self.silent("`load 0`"))?;
        // The rest of its line, before bytes could be taken for it.
        self.wait(&["\n"], Duration::from_millis(200))?;
        let chunk = if self.pace.is_zero() { 64 } else { 1 };
        for (place, bytes) in image.bytes().chunks(chunk).enumerate() {
            self.link.send(bytes)?;
            // The system's buffers would take all at once, and the bar would lie.
            self.link
                .pause(self.link.line_time(bytes.len()) + self.pace);
            sent((place + 1) * chunk);
        }
        self.link.send(&[image.checksum()])?;
        let writing = PAGE * (image.bytes().len() / 256 + 1) as u32;
        let patience = self.link.line_time(image.bytes().len()) + writing + ANSWER;
        let answer = self
            .wait(&[PROMPT], patience)?
            .ok_or_else(|| self.silent("the image"))?;
        judge(&answer, image)
    }

    /// Lets it compare flash with what it received; its answer.
    ///
    /// How it words the answer is not known to us. Only one that speaks of an error or a failure counts as bad: size and
    /// checksum of what it received were compared before.
    ///
    /// # Errors
    /// [`Error::Device`] if it says nothing, or says so.
    pub fn verify(&mut self) -> Result<String> {
        let answer = self.command("verify", Duration::from_secs(20))?;
        let lower = answer.to_lowercase();
        // What was sent may come back as an echo, and the prompt ends it.
        let said = answer.trim_end_matches(PROMPT).trim();
        let said = said.strip_prefix("verify").unwrap_or(said).trim();
        match lower.contains("error") || lower.contains("fail") {
            true => Err(Error::device(
                format!("verify failed: the boot loader says `{said}`"),
                AGAIN,
            )),
            false => Ok(said.to_string()),
        }
    }

    /// From now on the application starts at power-on.
    ///
    /// # Errors
    /// [`Error::Device`] if it does not answer.
    pub fn start_at_power_on(&mut self) -> Result<()> {
        self.command("app", ANSWER).map(|_| ())
    }

    /// Starts the application now; nobody answers.
    ///
    /// # Errors
    /// The port failed.
    pub fn go(&mut self) -> Result<()> {
        self.link.send(b"go\r")
    }

    fn command(&mut self, words: &str, patience: Duration) -> Result<String> {
        self.link.clear()?;
        self.link.send(format!("{words}\r").as_bytes())?;
        self.wait(&[PROMPT], patience)?
            .ok_or_else(|| self.silent(&format!("`{words}`")))
    }

    /// What came until one of these words did, or nothing if none does.
    fn wait(&mut self, words: &[&str], patience: Duration) -> Result<Option<String>> {
        let deadline = self.link.now() + patience;
        let mut heard = Vec::new();
        let mut byte = [0];
        // Byte by byte: what follows the word belongs to the next answer.
        while self.link.now() < deadline {
            let left = deadline - self.link.now();
            if self.link.receive(&mut byte, left)? == 1 {
                heard.push(byte[0]);
                if words.iter().any(|word| heard.ends_with(word.as_bytes())) {
                    return Ok(Some(String::from_utf8_lossy(&heard).into_owned()));
                }
            }
        }
        Ok(None)
    }

    fn silent(&self, about: &str) -> Error {
        Error::device(
            format!(
                "{}: the boot loader does not answer to {about}",
                self.link.name()
            ),
            "press MODE (reset) and try again; if it stays so, slow down: --pace-us 200",
        )
    }
}

const AGAIN: &str = "the CM-5 holds no whole program, the boot loader is unharmed: try again, slower if it stays so: --pace-us 200";

/// Judges what the boot loader says of an image; its word alone is not enough.
fn judge(answer: &str, image: &Image) -> Result<()> {
    let after = |key: &str| answer.split_once(key).map(|(_, rest)| rest.trim_start());
    let digits = |text: &str| -> String {
        text.trim_start_matches("0x")
            .chars()
            .take_while(char::is_ascii_hexdigit)
            .collect()
    };
    let failed = |what: String| Err(Error::device(what, AGAIN));
    let (length, sum) = (image.bytes().len(), image.checksum());
    let size = after("Size:").map(digits).unwrap_or_default();
    let same_size = size.parse() == Ok(length) || usize::from_str_radix(&size, 16) == Ok(length);
    if !size.is_empty() && !same_size {
        return failed(format!(
            "{length} bytes were sent, the boot loader received {size}"
        ));
    }
    let sums: Vec<u8> = after("Checksum:")
        .map(|text| {
            text.split('-')
                .take(2)
                .filter_map(|word| u8::from_str_radix(&digits(word), 16).ok())
                .collect()
        })
        .unwrap_or_default();
    if sums.len() != 2 || sums.iter().any(|theirs| *theirs != sum) {
        return failed(format!(
            "the checksum is wrong: ours {sum:02X}, the boot loader's {sums:02X?}"
        ));
    }
    match answer.contains("Success") && !size.is_empty() {
        true => Ok(()),
        false => failed(format!("the boot loader says: {}", answer.trim())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn program(length: usize) -> Vec<u8> {
        let mut bytes = vec![0x0c, 0x94, 0x46, 0x00];
        bytes.resize(length, 0x5a);
        bytes
    }

    #[test]
    fn only_raw_programs_that_fit_are_taken() {
        assert!(Image::check(program(1000)).is_ok());
        assert!(Image::check(program(LARGEST)).is_ok());
        for (bytes, said) in [
            (Vec::new(), "empty"),
            (program(LARGEST + 1), "too many"),
            (b"\x7fELF\x01\x01".to_vec(), "ELF"),
            (
                b":100000000C9446000C945E000C945E000C945E00E4\r\n".to_vec(),
                "Intel HEX",
            ),
            (vec![0; 100], "jump"),
        ] {
            let (what, _) = Image::check(bytes).unwrap_err();
            assert!(what.contains(said), "{what}");
        }
    }

    #[test]
    fn its_word_is_taken_only_if_size_and_sum_agree() {
        let image = Image::check(program(1000)).unwrap();
        let sum = image.checksum();
        let good = format!("Success\r\nSize:1000\r\nChecksum:{sum:02X}-{sum:02X}\r\n- ");
        judge(&good, &image).unwrap();
        for (bad, said) in [
            (good.replace("1000", "999"), "received 999"),
            (good.replace(&format!("-{sum:02X}"), "-00"), "checksum"),
            (good.replace("Success", "Error"), "says: Error"),
            ("- ".to_string(), "checksum"),
        ] {
            let error = judge(&bad, &image).unwrap_err();
            assert!(error.to_string().contains(said), "{error}");
            assert_eq!(error.exit_code(), 4);
        }
    }
}
