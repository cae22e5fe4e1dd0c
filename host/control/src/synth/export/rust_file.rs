//! The gains as a Rust file that compiles by itself, `no_std` included.

use super::Provenance;
use super::golden::golden;
use super::values::{head, list};
use crate::synth::{Design, FixedDesign};
use std::fmt::Write as _;

/// `gains.rs`: table, fingerprint, golden vectors, the law itself, and `check`, which runs the
/// vectors.
pub fn rust_file(design: &Design, fixed: &FixedDesign, made: &Provenance) -> String {
    let law = &fixed.law;
    let (m, n) = law.k.shape();
    let mut text = String::new();
    for line in head(design, fixed, made) {
        let _ = writeln!(text, "// {line}");
    }
    let rows = (0..m).map(|i| format!("[{}]", list(law.k.row(i).iter())));
    let limits = law
        .limits
        .iter()
        .map(|[low, high]| format!("[{low}, {high}]"));
    let vectors = golden(law)
        .into_iter()
        .map(|g| format!("    ([{}], [{}]),\n", list(&g.x), list(&g.u)));
    let vectors: Vec<String> = vectors.collect();
    let _ = write!(
        text,
        "
/// CRC-32 of the canonical bytes of this table.
pub const FINGERPRINT: u32 = 0x{:08X};
/// Gains, in steps of input step / state step / 2^SHIFT.
pub const K: [[i16; {n}]; {m}] = [{}];
/// Input at the operating point times 2^SHIFT, and the half that rounds.
pub const BIAS: [i32; {m}] = [{}];
/// Places by which the sum is shifted right.
pub const SHIFT: [u8; {m}] = [{}];
/// Least and greatest input, in steps.
pub const LIMITS: [[i16; 2]; {m}] = [{}];
/// The operating point, in steps.
pub const X0: [i16; {n}] = [{}];

/// The inputs for the states `x`, both in steps.
pub fn control(x: &[i16; {n}]) -> [i16; {m}] {{
    let mut u = [0; {m}];
    for i in 0..{m} {{
        let mut sum = BIAS[i];
        for j in 0..{n} {{
            let product = i32::from(K[i][j]).wrapping_mul(i32::from(x[j].saturating_sub(X0[j])));
            sum = sum.wrapping_sub(product);
        }}
        u[i] = (sum >> SHIFT[i]).clamp(i32::from(LIMITS[i][0]), i32::from(LIMITS[i][1])) as i16;
    }}
    u
}}

/// Whether `law` gives the right inputs for every golden vector.
pub fn check(law: impl Fn(&[i16; {n}]) -> [i16; {m}]) -> bool {{
    GOLDEN.iter().all(|(x, u)| law(x) == *u)
}}

/// States and the inputs that a right law gives for them.
pub const GOLDEN: [([i16; {n}], [i16; {m}]); {}] = [
{}];
",
        law.fingerprint(),
        list(rows),
        list(&law.bias),
        list(&law.shift),
        list(limits),
        list(&law.x0),
        vectors.len(),
        vectors.concat(),
    );
    if let Some(sums) = &fixed.sums {
        let _ = write!(
            text,
            "
/// Integral action: the joints whose angles are summed; their sums are the states from {first} on.
pub const SUM_OF: [usize; {count}] = [{}];
/// Places by which a sum is shifted right to make its state.
pub const SUM_SHIFT: [u8; {count}] = [{}];

/// After each `control`, before `x` is filled for the next sample: adds the angles of `x` to the
/// sums, which are 0 at the start, unless an input is at its limit, and puts the sums into `x`.
pub fn integrate(sums: &mut [i32; {count}], x: &mut [i16; {n}], u: &[i16; {m}]) {{
    if u.iter().zip(&LIMITS).any(|(u, limits)| limits.contains(u)) {{
        return;
    }}
    for j in 0..{count} {{
        let most = i32::from(i16::MAX) << SUM_SHIFT[j];
        let step = i32::from(x[SUM_OF[j]]) - i32::from(X0[SUM_OF[j]]);
        sums[j] = sums[j].saturating_add(step).clamp(-most, most);
        x[{first} + j] = (sums[j] >> SUM_SHIFT[j]) as i16;
    }}
}}
",
            list(&sums.joints),
            list(&sums.shift),
            first = sums.first,
            count = sums.joints.len(),
        );
    }
    text
}
