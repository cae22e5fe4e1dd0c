//! The gains as a C header that compiles by itself.

use super::Provenance;
use super::c_text::{C_LAW, C_SUMS, C_TABLE, C_TEST};
use super::golden::golden;
use super::values::{head, list};
use crate::synth::{Design, FixedDesign, FixedLaw, Signal, rows};
use std::fmt::{Display, Write as _};

/// The name that macros, tables and functions begin with where no other is given.
pub const C_NAME: &str = "gains";

/// Version of what the header holds and how: raised when a firmware would have to change.
const LAYOUT: u32 = 1;

/// Whether `name` can begin the names of C: a small letter, then small letters, digits and `_`.
pub fn is_c_name(name: &str) -> bool {
    let rest = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    name.starts_with(|c: char| c.is_ascii_lowercase()) && name.chars().all(rest)
}

/// The header: C99 and later, C++11 and later; clean under gcc's and clang's -Wconversion. Every
/// name begins with `name`, so that one file can include several. Right shifts of negative values
/// must be arithmetic, as they are with gcc and clang; the header refuses other compilers.
pub fn c_header(design: &Design, fixed: &FixedDesign, made: &Provenance, name: &str) -> String {
    let law = &fixed.law;
    let mut text = String::from("/*\n");
    for line in head(design, fixed, made) {
        let _ = writeln!(text, " * {}", line.replace("*/", "* /"));
    }
    let body = macros(design, law)
        + &table(law)
        + &asserts(law)
        + C_LAW
        + &sums(fixed)
        + &past(design)
        + &test(law);
    let _ = write!(text, " */\n{}", named(&body, name));
    text
}

/// The text with every `@` and `%` replaced by the name, in large and small letters.
fn named(text: &str, name: &str) -> String {
    text.replace('@', &name.to_uppercase()).replace('%', name)
}

/// A constant of type float that reads back as near to `value` as a float can be.
fn float(value: f64) -> String {
    format!("{value:e}f")
}

fn braced<T: Display>(values: impl IntoIterator<Item = T>) -> String {
    format!("{{{}}}", list(values))
}

/// Sizes, times and steps.
fn macros(design: &Design, law: &FixedLaw) -> String {
    let (inputs, states) = law.k.shape();
    let (ts_s, delay_s, past) = match &design.sampled {
        Some((plant, delay_s)) => (plant.ts_s, *delay_s, plant.delayed_inputs),
        None => (0.0, 0.0, 0),
    };
    let mut text = format!(
        "#ifndef HANDSTAND_@_H
#define HANDSTAND_@_H

#include <stdint.h>

/* Version of this header's layout. */
#define @_LAYOUT {LAYOUT}
/* CRC-32 of the canonical bytes of this table. */
#define @_FINGERPRINT 0x{:08X}UL

#define @_STATES {states}
#define @_INPUTS {inputs}
/* The law runs every so many seconds, or microseconds. */
#define @_PERIOD_S {}
#define @_PERIOD_US {}UL
/* From a sample to its inputs, s, as designed for; so many past inputs end the states. */
#define @_DELAY_S {}
#define @_PAST_INPUTS {past}

/* SI value of one step: of each state and of each input, then of all of them in their order. */
",
        law.fingerprint(),
        float(ts_s),
        (1e6 * ts_s).round(),
        float(delay_s),
    );
    for (signals, steps, what) in [
        (&design.states, &law.state_step, "STATE"),
        (&design.inputs, &law.input_step, "INPUT"),
    ] {
        for (name, step) in macro_names(signals).iter().zip(steps) {
            let _ = writeln!(text, "#define @_{what}_STEP_{name} {}", float(*step));
        }
        let all = braced(steps.iter().map(|step| float(*step)));
        let _ = writeln!(text, "#define @_{what}_STEPS {all}");
    }
    text
}

/// `u2(k-1)` as `U2_K1`, `q_left-arm` as `Q_LEFT_ARM`; where two would be the same, all have their
/// place among the signals behind them.
fn macro_names(signals: &[Signal]) -> Vec<String> {
    let letter = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let plain = |signal: &Signal| {
        let name = signal
            .name
            .to_uppercase()
            .replace("(K-", "_K")
            .replace(')', "");
        name.chars().map(letter).collect::<String>()
    };
    let mut all: Vec<String> = signals.iter().map(plain).collect();
    let first = |(place, name): (usize, &String)| !all[..place].contains(name);
    if !all.iter().enumerate().all(first) {
        for (place, name) in all.iter_mut().enumerate() {
            *name = format!("{name}_{}", place + 1);
        }
    }
    all
}

/// The numbers, where firmware wants them.
fn table(law: &FixedLaw) -> String {
    let gains = rows(&law.k);
    let gains = gains.iter().map(braced);
    C_TABLE
        .replace("<k>", &list(gains))
        .replace("<bias>", &list(&law.bias))
        .replace("<shift>", &list(&law.shift))
        .replace("<limits>", &list(law.limits.iter().map(braced)))
        .replace("<x0>", &list(&law.x0))
}

/// What the law relies on, held against the numbers of the table by the compiler.
fn asserts(law: &FixedLaw) -> String {
    let mut text = String::from(
        "
/* What the law relies on: a compiler for which it does not hold stops here. */
typedef char %_assert_arithmetic_shift[(-1 >> 1) == -1 ? 1 : -1];
typedef char %_assert_int16[(int16_t)INT16_MIN == -32767 - 1 && sizeof(int16_t) == 2 ? 1 : -1];
typedef char %_assert_int32[sizeof(int32_t) == 4 ? 1 : -1];
/* No states whatever overflow the sum of an input. */
",
    );
    for (i, row) in law.k.row_iter().enumerate() {
        let sum: Vec<String> = row.iter().map(|k| format!("{}LL", k.abs())).collect();
        let _ = writeln!(
            text,
            "typedef char %_assert_sum_{i}[({}) * 32768LL + {}LL <= 2147483647LL ? 1 : -1];",
            sum.join(" + "),
            law.bias[i].abs()
        );
    }
    text
}

/// Sums of angles are states that the caller keeps.
fn sums(fixed: &FixedDesign) -> String {
    fixed.sums.as_ref().map_or_else(String::new, |sums| {
        C_SUMS
            .replace("<count>", &sums.joints.len().to_string())
            .replace("<first>", &sums.first.to_string())
            .replace("<joints>", &list(&sums.joints))
            .replace("<shift>", &list(&sums.shift))
    })
}

/// Past inputs are states that the caller keeps.
fn past(design: &Design) -> String {
    let past = design
        .sampled
        .as_ref()
        .map_or(0, |(plant, _)| plant.delayed_inputs);
    if past == 0 {
        return String::new();
    }
    "
/* The states end in past inputs, the latest first, as %_control gave them: in their steps, within
   their limits. Call this with x and u after each %_control, before x is filled for the next
   sample; until the first sample they are the inputs that are held. */
static inline void %_remember(int16_t x[@_STATES], const int16_t u[@_INPUTS])
{
    const uint8_t first = @_STATES - @_INPUTS * @_PAST_INPUTS;
    for (uint8_t j = @_STATES - 1; j >= first + @_INPUTS; j--) x[j] = x[j - @_INPUTS];
    for (uint8_t i = 0; i < @_INPUTS; i++) x[first + i] = u[i];
}
"
    .to_string()
}

/// Golden vectors and the function that runs them.
fn test(law: &FixedLaw) -> String {
    let vectors = golden(law);
    let of = |values: Vec<String>| values.join(",\n    ");
    C_TEST
        .replace("<count>", &vectors.len().to_string())
        .replace("<x>", &of(vectors.iter().map(|g| braced(&g.x)).collect()))
        .replace("<u>", &of(vectors.iter().map(|g| braced(&g.u)).collect()))
}
