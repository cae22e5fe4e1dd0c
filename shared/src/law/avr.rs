//! The law in the AVR's own words: the sums `bias - K (x - x0)`.
//!
//! The compiler's product of two 16-bit values takes 110 cycles. Here it takes 31 in a row of any length, and 25 in the law of two
//! inputs and six states, which is unrolled: four 8-bit products and their sum.
#![allow(unsafe_code)]

use crate::gains::{GainTable, Row};
use core::arch::asm;
use core::mem::{offset_of, size_of};

/// The assembler's macro `handstand_mac`: subtracts the product of r20-21 and r22-23 from four registers; r24 is zero.
macro_rules! mac {
    () => {
        concat!(
            ".macro handstand_mac a0, a1, a2, a3\n",
            "muls r21, r23\n", // high x high
            "movw r18, r0\n",
            "mul r20, r22\n", // low x low
            "sub \\a0, r0\n",
            "sbc \\a1, r1\n",
            "sbc \\a2, r18\n",
            "sbc \\a3, r19\n",
            "mulsu r21, r22\n", // high x low, in the middle; the carry is its sign
            "adc \\a3, r24\n",
            "sub \\a1, r0\n",
            "sbc \\a2, r1\n",
            "sbc \\a3, r24\n",
            "mulsu r23, r20\n", // low x high
            "adc \\a3, r24\n",
            "sub \\a1, r0\n",
            "sbc \\a2, r1\n",
            "sbc \\a3, r24\n",
            ".endm\n",
        )
    };
}

/// The sums, if the table is of two inputs and six states.
#[inline(always)]
pub fn fast<const M: usize, const N: usize>(
    table: &GainTable<M, N>,
    x: &[i16; N],
) -> Option<[i32; M]> {
    if M != 2 || N != 6 {
        return None;
    }
    // SAFETY: with M = 2 and N = 6 these are the same types.
    let (table, x) = unsafe {
        let table = (&raw const *table).cast::<GainTable<2, 6>>();
        (&*table, &*(&raw const *x).cast::<[i16; 6]>())
    };
    let sums = sums(table, x);
    let mut out = [0; M];
    out.iter_mut().zip(sums).for_each(|(out, sum)| *out = sum);
    Some(out)
}

/// Both sums, wrapping, for the states `x`.
#[inline(always)]
fn sums(table: &GainTable<2, 6>, x: &[i16; 6]) -> [i32; 2] {
    const ROWS: usize = offset_of!(GainTable<2, 6>, rows);
    const ROW: usize = size_of::<Row<6>>();
    const K: usize = ROWS + offset_of!(Row<6>, k);
    const X0: usize = offset_of!(GainTable<2, 6>, x0);
    // Every field is reached by a displacement from one pointer, of which the AVR has six bits.
    const { assert!(K + ROW + 12 <= 64 && X0 + 12 <= 64) };
    let [first, second] = &table.rows;
    let (mut low0, mut high0) = (first.bias as u16, (first.bias >> 16) as u16);
    let (mut low1, mut high1) = (second.bias as u16, (second.bias >> 16) as u16);
    // SAFETY: reads 12 bytes from X and within the table from Z; r1 is zero again at the end.
    unsafe {
        asm!(
            mac!(),
            "clr r24",
            ".irp j, 0, 2, 4, 6, 8, 10",
            "ld r20, X+",
            "ld r21, X+",
            "ldd r22, Z+{x0}+\\j",
            "ldd r23, Z+{x0}+\\j+1",
            "sub r20, r22",
            "sbc r21, r23",
            "brvc 2f",
            // Beyond 16 bits: 7fff or 8000, the larger one where the wrapped difference is negative.
            "lsl r21",
            "sbc r20, r20",
            "mov r21, r20",
            "subi r21, 0x80",
            "2: ldd r22, Z+{k}+\\j",
            "ldd r23, Z+{k}+\\j+1",
            "handstand_mac {low0:l}, {low0:h}, {high0:l}, {high0:h}",
            "ldd r22, Z+{k1}+\\j",
            "ldd r23, Z+{k1}+\\j+1",
            "handstand_mac {low1:l}, {low1:h}, {high1:l}, {high1:h}",
            ".endr",
            "clr r1",
            ".purgem handstand_mac",
            x0 = const X0,
            k = const K,
            k1 = const K + ROW,
            low0 = inout(reg_pair) low0,
            high0 = inout(reg_pair) high0,
            low1 = inout(reg_pair) low1,
            high1 = inout(reg_pair) high1,
            inout("X") x.as_ptr() => _,
            in("Z") table,
            out("r18") _,
            out("r19") _,
            out("r20") _,
            out("r21") _,
            out("r22") _,
            out("r23") _,
            out("r24") _,
            options(nostack, readonly),
        );
    }
    let join = |low: u16, high: u16| (u32::from(high) << 16 | u32::from(low)) as i32;
    [join(low0, high0), join(low1, high1)]
}

/// `bias` - sum of products of `k` and `x`, wrapping; of as many as the shorter has, at most 255.
#[inline(never)]
pub fn row(bias: i32, k: &[i16], x: &[i16]) -> i32 {
    let count = k.len().min(x.len()).min(255) as u8;
    if count == 0 {
        return bias;
    }
    let (mut low, mut high) = (bias as u16, (bias >> 16) as u16);
    // SAFETY: reads `count` words from X and from Z, which both have; r1 is zero again at the end.
    unsafe {
        asm!(
            mac!(),
            "clr r24",
            "2: ld r20, X+",
            "ld r21, X+",
            "ld r22, Z+",
            "ld r23, Z+",
            "handstand_mac {low:l}, {low:h}, {high:l}, {high:h}",
            "dec r25",
            "brne 2b",
            "clr r1",
            ".purgem handstand_mac",
            low = inout(reg_pair) low,
            high = inout(reg_pair) high,
            inout("X") x.as_ptr() => _,
            inout("Z") k.as_ptr() => _,
            inout("r25") count => _,
            out("r18") _,
            out("r19") _,
            out("r20") _,
            out("r21") _,
            out("r22") _,
            out("r23") _,
            out("r24") _,
            options(nostack, readonly),
        );
    }
    (u32::from(high) << 16 | u32::from(low)) as i32
}
