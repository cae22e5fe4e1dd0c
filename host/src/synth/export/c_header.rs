//! The gains as a C header that compiles by itself.

use super::Provenance;
use super::golden::golden;
use super::values::{head, list};
use crate::synth::{Design, Fixed, rows};
use std::fmt::Write as _;

const LAW: &str = "\
/* The inputs u for the states x, both in steps. */
static inline void gains_control(const int16_t x[GAINS_STATES], int16_t u[GAINS_INPUTS])
{
    for (uint8_t i = 0; i < GAINS_INPUTS; i++) {
        int32_t sum = gains_bias[i];
        for (uint8_t j = 0; j < GAINS_STATES; j++) {
            int32_t off = (int32_t)x[j] - gains_x0[j];
            if (off > INT16_MAX) off = INT16_MAX;
            if (off < INT16_MIN) off = INT16_MIN;
            sum -= (int32_t)gains_k[i][j] * off;
        }
        sum >>= gains_shift[i];
        if (sum < gains_limits[i][0]) sum = gains_limits[i][0];
        if (sum > gains_limits[i][1]) sum = gains_limits[i][1];
        u[i] = (int16_t)sum;
    }
}";

/// `gains.h`: C99; right shifts of negative values must be arithmetic, as they are with gcc and
/// clang.
pub fn c_header(design: &Design, fixed: &Fixed, made: &Provenance) -> String {
    let law = &fixed.law;
    let (m, n) = law.k.shape();
    let mut text = String::from("/*\n");
    for line in head(design, fixed, made) {
        let _ = writeln!(text, " * {}", line.replace("*/", "* /"));
    }
    let row = |values: &mut dyn Iterator<Item = &i64>| format!("{{{}}}", list(values));
    let gains = rows(&law.k);
    let gains = gains.iter().map(|gains| row(&mut gains.iter()));
    let limits = law.limits.iter().map(|limits| row(&mut limits.iter()));
    let vectors = golden(law);
    let of = |values: Vec<String>| values.join(",\n    ");
    let _ = write!(
        text,
        " */
#ifndef HANDSTAND_GAINS_H
#define HANDSTAND_GAINS_H

#include <stdint.h>

#define GAINS_STATES {n}
#define GAINS_INPUTS {m}
/* CRC-32 of the canonical bytes of this table. */
#define GAINS_FINGERPRINT 0x{:08X}UL
#define GAINS_GOLDEN {}

/* Gains, in steps of input step / state step / 2^shift. */
static const int16_t gains_k[GAINS_INPUTS][GAINS_STATES] = {{{}}};
/* Input at the operating point times 2^shift, and the half that rounds. */
static const int32_t gains_bias[GAINS_INPUTS] = {{{}}};
/* Places by which the sum is shifted right. */
static const uint8_t gains_shift[GAINS_INPUTS] = {{{}}};
/* Least and greatest input, in steps. */
static const int16_t gains_limits[GAINS_INPUTS][2] = {{{}}};
/* The operating point, in steps. */
static const int16_t gains_x0[GAINS_STATES] = {{{}}};

{LAW}

/* States, and the inputs that a right law gives for them. */
static const int16_t gains_golden_x[GAINS_GOLDEN][GAINS_STATES] = {{
    {}
}};
static const int16_t gains_golden_u[GAINS_GOLDEN][GAINS_INPUTS] = {{
    {}
}};

#endif
",
        law.fingerprint(),
        vectors.len(),
        list(gains),
        list(&law.bias),
        list(&law.shift),
        list(limits),
        list(&law.x0),
        of(vectors.iter().map(|g| row(&mut g.x.iter())).collect()),
        of(vectors.iter().map(|g| row(&mut g.u.iter())).collect()),
    );
    text
}
