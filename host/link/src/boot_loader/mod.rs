//! The CM-5's boot loader (V1.31), which takes a program over the PC line.
//!
//! `#` during reset until the banner, `\r`, prompt `- `; `load 0` -> `Ready..` -> the raw bytes and
//! their sum modulo 256; 150 ms of silence end them -> `Success` or `Error`, `Size:`,
//! `Checksum:XX-YY`; then `verify`, `app` (start the application at power-on), `go`. `sys` undoes
//! `app`: sent before an image, it keeps half of one from being started. 57600 8N1. It lies at
//! 0x1E000, so an image has at most 122,880 bytes.

mod error;
mod image;

pub use error::{BootLoaderError, ImageError};
pub use image::{Image, LARGEST};

use super::port::SerialLink;
use std::time::Duration;

type Result<T> = std::result::Result<T, BootLoaderError>;

/// Speed of the boot loader, baud.
pub const BAUD: u32 = 57_600;

const BANNER: &str = "SYSTEM O.K.";
const PROMPT: &str = "- ";
const ANSWER: Duration = Duration::from_secs(2);
/// Writing flash: 4.5 ms per page of 256 bytes, and as much again for a slow clock.
const PAGE: Duration = Duration::from_millis(9);

/// A boot loader that waits for commands.
pub struct BootLoader<L> {
    link: L,
    /// Pause after every byte of an image.
    pace: Duration,
}

impl<L: SerialLink> BootLoader<L> {
    /// Knocks until the boot loader answers, at most for `patience`; `keep_on` is asked meanwhile.
    ///
    /// # Errors
    /// [`BootLoaderError::NotEntered`] if it does not.
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
        Err(BootLoaderError::NotEntered {
            port: loader.link.name().into(),
        })
    }

    /// Sends the image; `sent` is told how many bytes are on their way.
    ///
    /// # Errors
    /// [`BootLoaderError`]: no answer, or size or checksum differ from ours.
    pub fn load(&mut self, image: &Image, mut sent: impl FnMut(usize)) -> Result<()> {
        self.link.clear()?;
        self.link.send(b"load 0\r")?;
        let ready = self.wait(&["Ready"], ANSWER)?;
        ready.ok_or_else(|| self.no_answer("`load 0`"))?;
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
            .ok_or_else(|| self.no_answer("the image"))?;
        judge(&answer, image)
    }

    /// Lets it compare flash with what it received; its answer.
    ///
    /// How it words the answer is not known to us. Only one that speaks of an error or a failure
    /// counts as bad: size and checksum of what it received were compared before.
    ///
    /// # Errors
    /// [`BootLoaderError`] if it says nothing, or says so.
    pub fn verify(&mut self) -> Result<String> {
        let answer = self.command("verify", Duration::from_secs(20))?;
        let lower = answer.to_lowercase();
        // What was sent may come back as an echo, and the prompt ends it.
        let said = answer.trim_end_matches(PROMPT).trim();
        let said = said.strip_prefix("verify").unwrap_or(said).trim();
        if lower.contains("error") || lower.contains("fail") {
            Err(BootLoaderError::Verify { reply: said.into() })
        } else {
            Ok(said.to_string())
        }
    }

    /// From now on the boot loader waits at power-on, and no application starts: what is in flash
    /// may be half of one.
    ///
    /// # Errors
    /// [`BootLoaderError`] if it does not answer.
    pub fn stay_at_power_on(&mut self) -> Result<()> {
        self.command("sys", ANSWER).map(|_| ())
    }

    /// From now on the application starts at power-on.
    ///
    /// # Errors
    /// [`BootLoaderError`] if it does not answer.
    pub fn start_at_power_on(&mut self) -> Result<()> {
        self.command("app", ANSWER).map(|_| ())
    }

    /// Start the application now; there is no answer.
    ///
    /// # Errors
    /// The port failed.
    pub fn go(&mut self) -> Result<()> {
        Ok(self.link.send(b"go\r")?)
    }

    fn command(&mut self, words: &str, patience: Duration) -> Result<String> {
        self.link.clear()?;
        self.link.send(format!("{words}\r").as_bytes())?;
        self.wait(&[PROMPT], patience)?
            .ok_or_else(|| self.no_answer(format!("`{words}`")))
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

    fn no_answer(&self, request: impl Into<String>) -> BootLoaderError {
        BootLoaderError::NoAnswer {
            port: self.link.name().into(),
            request: request.into(),
        }
    }
}

/// Judges what the boot loader says of an image; its word alone is not enough.
fn judge(answer: &str, image: &Image) -> Result<()> {
    let after = |key: &str| answer.split_once(key).map(|(_, rest)| rest.trim_start());
    let digits = |text: &str| -> String {
        text.trim_start_matches("0x")
            .chars()
            .take_while(char::is_ascii_hexdigit)
            .collect()
    };
    let (length, sum) = (image.bytes().len(), image.checksum());
    let size = after("Size:").map(digits).unwrap_or_default();
    let same_size = size.parse() == Ok(length) || usize::from_str_radix(&size, 16) == Ok(length);
    if !size.is_empty() && !same_size {
        return Err(BootLoaderError::Size {
            sent: length,
            received: size,
        });
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
        return Err(BootLoaderError::Checksum {
            ours: sum,
            theirs: sums,
        });
    }
    if answer.contains("Success") && !size.is_empty() {
        Ok(())
    } else {
        Err(BootLoaderError::Failed {
            reply: answer.trim().into(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::image::program;
    use super::*;

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
            assert_eq!(crate::error::Error::from(error).exit_code(), 4);
        }
    }
}
