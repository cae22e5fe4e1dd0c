//! A program as the boot loader takes it.

use super::ImageError;
use crate::error::{Error, Place, Result};
use handstand_shared::image::{self, ImageFault};
use std::path::Path;

/// Where the boot loader begins: the largest image, bytes.
pub const LARGEST: usize = 122_880;
/// A program as the boot loader takes it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image(Vec<u8>);

impl Image {
    /// Reads a raw binary.
    ///
    /// # Errors
    /// A file that cannot be read; Intel HEX or ELF, which the boot loader would write into flash
    /// as they are; too large; not Handstand's firmware, or not all of it.
    pub fn load(path: &Path) -> Result<Image> {
        Image::read(path, Image::check)
    }

    /// Reads a raw binary that may be any program for the AVR.
    ///
    /// # Errors
    /// As [`Image::load`], without the last one.
    pub fn load_any(path: &Path) -> Result<Image> {
        Image::read(path, Image::check_any)
    }

    fn read(
        path: &Path,
        check: impl Fn(Vec<u8>) -> std::result::Result<Image, ImageError>,
    ) -> Result<Image> {
        let bytes = std::fs::read(path).map_err(|error| Error::file(path, "read", error))?;
        check(bytes)
            .map_err(|error| Error::data(Place::file(path), error.to_string(), error.remedy()))
    }

    /// Handstand's firmware from its bytes, its mark ([`handstand_shared::image`]) included.
    ///
    /// # Errors
    /// Bytes that are no raw program, too many, without a mark, or damaged.
    pub fn check(bytes: Vec<u8>) -> std::result::Result<Image, ImageError> {
        let image = Image::check_any(bytes)?;
        match image::program(&image.0) {
            Ok(_) => Ok(image),
            Err(ImageFault::NoMark) => Err(ImageError::NoMark),
            Err(ImageFault::Length { .. } | ImageFault::Check) => Err(ImageError::Damaged),
        }
    }

    /// Any program from its bytes.
    ///
    /// # Errors
    /// Bytes that are no raw program, or too many.
    pub fn check_any(bytes: Vec<u8>) -> std::result::Result<Image, ImageError> {
        let is_hex = bytes.first() == Some(&b':')
            && bytes
                .iter()
                .take(80)
                .all(|b| b.is_ascii_hexdigit() || b":\r\n".contains(b));
        // The first word of an AVR program is a jump: `jmp` or `rjmp`.
        let is_jump = matches!(bytes[..], [0x0c, 0x94, _, _, ..] | [_, 0xc0..=0xcf, ..]);
        match bytes.len() {
            0 => Err(ImageError::Empty),
            _ if bytes.starts_with(b"\x7fELF") => Err(ImageError::Elf),
            _ if is_hex => Err(ImageError::IntelHex),
            length if length > LARGEST => Err(ImageError::TooLong(length)),
            _ if !is_jump => Err(ImageError::NoJump),
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

/// A program of this many bytes, which begins with a jump and ends with its mark.
#[cfg(test)]
pub(super) fn program(length: usize) -> Vec<u8> {
    let mut bytes = vec![0x0c, 0x94, 0x46, 0x00];
    bytes.resize(length - image::MARK, 0x5a);
    bytes.extend(image::mark(&bytes));
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_program_is_taken_where_it_is_wanted() {
        let unmarked = program(500)[..400].to_vec();
        assert!(Image::check_any(unmarked).is_ok());
        assert_eq!(Image::check_any(vec![0; 100]), Err(ImageError::NoJump));
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
            (program(500)[..499].to_vec(), "no mark"),
            ([program(500), vec![0xff]].concat(), "no mark"),
            (
                [&program(500)[..100], &program(500)[101..]].concat(),
                "damaged",
            ),
            (
                [&program(500)[..100], &[1], &program(500)[101..]].concat(),
                "damaged",
            ),
        ] {
            let what = Image::check(bytes).unwrap_err().to_string();
            assert!(what.contains(said), "{what}");
        }
    }
}
