//! The last figures of flash and RAM, which a build may not exceed unnoticed.

use super::image::Image;
use crate::root;
use serde_json::{Value, json};
use std::path::PathBuf;

/// Share by which flash may grow: toolchains differ.
const FLASH_SHARE: f64 = 0.02;
/// Bytes by which static RAM may grow.
const RAM_BYTES: usize = 16;

/// Flash and static RAM of the image without a plan, as they were accepted last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Budget {
    flash: usize,
    ram: usize,
}

impl Budget {
    fn file() -> PathBuf {
        root().join("firmware/budget.json")
    }

    /// The figures accepted last.
    ///
    /// # Errors
    /// The file cannot be read or holds none.
    pub fn last() -> Result<Budget, String> {
        let file = Budget::file();
        let name = file.display();
        let text = std::fs::read_to_string(&file).map_err(|error| format!("{name}: {error}"))?;
        let value: Value =
            serde_json::from_str(&text).map_err(|error| format!("{name}: {error}"))?;
        let figure = |key: &str| {
            let found = value[key].as_u64().and_then(|it| usize::try_from(it).ok());
            found.ok_or_else(|| format!("{name}: `{key}` is no number of bytes"))
        };
        Ok(Budget {
            flash: figure("flash_bytes")?,
            ram: figure("ram_bytes")?,
        })
    }

    /// Accepts the figures of this image.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn accept(image: &Image) -> Result<(), String> {
        let value = json!({ "flash_bytes": image.flash, "ram_bytes": image.ram });
        let file = Budget::file();
        let text = format!("{value:#}\n");
        std::fs::write(&file, text).map_err(|error| format!("{}: {error}", file.display()))
    }

    /// What of this image exceeds the figures, in words; empty if it keeps them.
    pub fn exceeded(&self, image: &Image) -> Vec<String> {
        let flash = (self.flash as f64 * (1.0 + FLASH_SHARE)) as usize;
        let ram = self.ram + RAM_BYTES;
        let said = |what: &str, is: usize, was: usize| {
            format!(
                "{what} grew from {was} to {is} bytes: make it smaller, or accept it with \
                 `cargo xtask firmware --accept-size`"
            )
        };
        let grown = [
            (image.flash > flash).then(|| said("Flash", image.flash, self.flash)),
            (image.ram > ram).then(|| said("Static RAM", image.ram, self.ram)),
        ];
        grown.into_iter().flatten().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growth_is_noticed_and_noise_is_not() {
        let last = Budget {
            flash: 40_000,
            ram: 700,
        };
        let image = |flash, ram| Image {
            flash,
            ram,
            stack: 0,
            forbidden: Vec::new(),
        };
        assert!(last.exceeded(&image(40_700, 716)).is_empty());
        assert!(last.exceeded(&image(30_000, 600)).is_empty());
        assert_eq!(last.exceeded(&image(40_900, 700)).len(), 1);
        assert_eq!(last.exceeded(&image(40_000, 717)).len(), 1);
        assert_eq!(last.exceeded(&image(50_000, 900)).len(), 2);
    }

    #[test]
    fn the_repository_has_figures() {
        let last = Budget::last().unwrap();
        assert!(last.flash > 10_000 && last.ram > 100, "{last:?}");
    }
}
