//! What a built image takes, and what must not be in it.

use super::build::Built;
use super::stack;
use super::toolchain::output;
use std::process::Command;

/// The CM-5's boot loader begins here; a larger image would overwrite it.
pub const FLASH_LIMIT: usize = 122_880;
/// RAM of the ATmega128.
pub const RAM_SIZE: usize = 4096;

/// Sizes and symbols of an image.
#[derive(Debug, Clone)]
pub struct Image {
    /// Bytes of flash: code, constants and initial values.
    pub flash: usize,
    /// Bytes of RAM for static data; the rest is stack.
    pub ram: usize,
    /// Bytes of RAM that the stack takes at most, by the code's calls and frames.
    pub stack: usize,
    /// Symbols that must not be there.
    pub forbidden: Vec<String>,
}

impl Image {
    /// Looks at an ELF.
    ///
    /// # Errors
    /// Which tool of `binutils-avr` failed.
    pub fn of(built: &Built) -> Result<Image, String> {
        let sizes = output(Command::new("avr-size").arg("-A").arg(&built.elf));
        let sizes = sizes.ok_or("avr-size (Debian: binutils-avr) failed")?;
        let section = |name: &str| -> usize {
            let words = |line: &str| {
                line.split_whitespace()
                    .map(str::to_string)
                    .collect::<Vec<_>>()
            };
            let lines = sizes
                .lines()
                .map(words)
                .filter(|words| words.len() == 3 && words[0] == name);
            lines
                .filter_map(|words| words[1].parse::<usize>().ok())
                .sum()
        };
        let symbols = output(Command::new("avr-nm").arg(&built.elf));
        let symbols = symbols.ok_or("avr-nm (Debian: binutils-avr) failed")?;
        let names = symbols
            .lines()
            .filter_map(|line| line.split_whitespace().last());
        Ok(Image {
            flash: section(".text") + section(".data") + section(".rodata"),
            ram: section(".data") + section(".bss") + section(".noinit"),
            stack: stack::bound(built)?,
            forbidden: names
                .filter(|name| is_forbidden(name))
                .map(str::to_string)
                .collect(),
        })
    }
}

/// `__mulo[sdt]i4` destroys a register of its caller on the AVR; a panic could only hang the robot.
fn is_forbidden(symbol: &str) -> bool {
    let checked_product = ["__mulosi4", "__mulodi4", "__muloti4"].contains(&symbol);
    checked_product || symbol.contains("core9panicking") || symbol.contains("panic_fmt")
}

#[cfg(test)]
mod tests {
    use super::is_forbidden;

    #[test]
    fn the_miscompiled_products_and_panics_are_forbidden() {
        for symbol in [
            "__mulosi4",
            "__muloti4",
            "_RNvNtCs5_4core9panicking9panic_fmt",
        ] {
            assert!(is_forbidden(symbol), "{symbol}");
        }
        assert!(!is_forbidden("__mulsi3") && !is_forbidden("main"));
    }
}
