//! The law in the AVR's own words.
//!
//! The compiler's product of two 16-bit values takes 110 cycles. Here it takes 31 in a row of any
//! length: four 8-bit products and their sum. A shift by bits is a product with a power of two.
//!
//! Products leave their result in r0 and r1. The compiler wants both as they were: r1 zero, r0
//! whatever it was.
#![allow(unsafe_code)]

use crate::gains::Row;
use core::arch::asm;
use core::mem::{MaybeUninit, offset_of, size_of};

/// The assembler's macro `handstand_mac`: subtracts the product of r20-21 and r22-23 from four
/// registers; r11 is zero, r24 and r25 are spoilt.
macro_rules! mac {
    () => {
        concat!(
            ".macro handstand_mac a0, a1, a2, a3\n",
            "muls r21, r23\n", // high x high
            "movw r24, r0\n",
            "mul r20, r22\n", // low x low
            "sub \\a0, r0\n",
            "sbc \\a1, r1\n",
            "sbc \\a2, r24\n",
            "sbc \\a3, r25\n",
            "mulsu r21, r22\n", // high x low, in the middle; the carry is its sign
            "adc \\a3, r11\n",
            "sub \\a1, r0\n",
            "sbc \\a2, r1\n",
            "sbc \\a3, r11\n",
            "mulsu r23, r20\n", // low x high
            "adc \\a3, r11\n",
            "sub \\a1, r0\n",
            "sbc \\a2, r1\n",
            "sbc \\a3, r11\n",
            ".endm\n",
        )
    };
}

/// The assembler's macro `handstand_finish`: the sum in a0 to a3 shifted and within its limits, in
/// u0 and u1; a2 and a3 are among r16 to r23, shift and limits lie at Z, r11 is zero, r20, r24 and
/// r25 and the sum are spoilt.
///
/// Three bytes times 2^(8 - n), without the lowest byte of the product, are those bytes shifted by
/// n: 2^(7 - (shift - 1) % 8).
macro_rules! finish {
    () => {
        concat!(
            ".macro handstand_power\n", // r20 = 2^(7 - r24 % 8)
            "ldi r20, 1\n",
            "sbrs r24, 1\n",
            "ldi r20, 4\n",
            "sbrs r24, 0\n",
            "lsl r20\n",
            "sbrs r24, 2\n",
            "swap r20\n",
            ".endm\n",
            ".macro handstand_scale u0, u1, b0, b1, b2\n", // r1, u1, u0 = b2, b1, b0 times r20 / 256
            "mul \\b1, r20\n",
            "movw \\u0, r0\n",
            "mul \\b0, r20\n",
            "add \\u0, r1\n",
            "adc \\u1, r11\n",
            "mulsu \\b2, r20\n",
            "add \\u1, r0\n",
            "adc r1, r11\n",
            ".endm\n",
            ".macro handstand_finish a0, a1, a2, a3, u0, u1, shift, low, high\n",
            "ldd r24, Z+\\shift\n",
            "dec r24\n",
            "cpi r24, 7\n",
            "brlo 27f\n",
            "breq 28f\n",
            "cpi r24, 15\n",
            "brsh 36f\n",
            "handstand_power\n", // 9 to 15
            "handstand_scale \\u0, \\u1, \\a1, \\a2, \\a3\n",
            "rjmp 40f\n",
            "36: breq 35f\n",
            "cpi r24, 255\n",
            "breq 20f\n",
            "handstand_power\n",
            "cpi r24, 24\n",
            "brsh 38f\n",
            "mul \\a2, r20\n", // 17 to 24
            "mov \\u0, r1\n",
            "mulsu \\a3, r20\n",
            "add \\u0, r0\n",
            "adc r1, r11\n",
            "mov \\u1, r1\n",
            "rjmp 50f\n",
            "38: mulsu \\a3, r20\n", // from 25 on
            "mov \\u0, r1\n",
            "mov \\u1, r1\n",
            "lsl \\u1\n",
            "sbc \\u1, \\u1\n",
            "rjmp 50f\n",
            "35: movw \\u0, \\a2\n", // 16
            "rjmp 50f\n",
            "28: mov \\u0, \\a1\n", // 8
            "mov \\u1, \\a2\n",
            "mov r1, \\a3\n",
            "rjmp 40f\n",
            "20: movw \\u0, \\a0\n", // 0
            "mov r1, \\a2\n",
            "mov r0, \\a2\n",
            "lsl r0\n",
            "adc \\a3, r11\n",
            "breq 40f\n",
            "60: brlt 61f\n", // Beyond 16 bits: the limit of that side.
            "ldd \\u0, Z+\\high\n",
            "ldd \\u1, Z+\\high+1\n",
            "rjmp 99f\n",
            "61: ldd \\u0, Z+\\low\n",
            "ldd \\u1, Z+\\low+1\n",
            "rjmp 99f\n",
            "27: mov r0, \\a2\n", // 1 to 7: what needs more than 24 bits needs more than 16 when shifted.
            "lsl r0\n",
            "adc \\a3, r11\n",
            "brne 60b\n",
            "handstand_power\n",
            "handstand_scale \\u0, \\u1, \\a0, \\a1, \\a2\n",
            "40: mov r0, \\u1\n", // The third byte is the sign of the second, or all is beyond 16 bits.
            "lsl r0\n",
            "adc r1, r11\n",
            "brne 60b\n",
            "50: ldd r24, Z+\\high\n",
            "ldd r25, Z+\\high+1\n",
            "cp r24, \\u0\n",
            "cpc r25, \\u1\n",
            "brlt 51f\n",
            "ldd r24, Z+\\low\n",
            "ldd r25, Z+\\low+1\n",
            "cp \\u0, r24\n",
            "cpc \\u1, r25\n",
            "brge 99f\n",
            "51: movw \\u0, r24\n",
            "99:\n",
            ".endm\n",
        )
    };
}

/// So that the next block may define them again.
macro_rules! forget {
    ($($name:literal)*) => {
        concat!($(".purgem handstand_", $name, "\n"),*)
    };
}

/// How far the states `x` are from the operating point `x0`, saturating: 19 cycles each, where the
/// compiler takes 45.
#[inline(always)]
pub fn departure<const N: usize>(x0: &[i16; N], x: &[i16; N]) -> [i16; N] {
    const { assert!(N > 0 && N < 256) };
    let mut departure = MaybeUninit::<[i16; N]>::uninit();
    // SAFETY: reads N words from X and from Z and writes N at Y, which have them; Y is the
    // compiler's own, and as it was at the end.
    unsafe {
        asm!(
            "movw r24, r28",
            "movw r28, {to}",
            "2: ld r20, X+",
            "ld r21, X+",
            "ld r22, Z+",
            "ld r23, Z+",
            "sub r20, r22",
            "sbc r21, r23",
            "brvc 3f",
            // Beyond 16 bits: 7fff where the unsigned difference borrowed, else 8000.
            "sbc r20, r20",
            "mov r21, r20",
            "subi r21, 0x80",
            "3: st Y+, r20",
            "st Y+, r21",
            "dec {count}",
            "brne 2b",
            "movw r28, r24",
            to = in(reg_pair) departure.as_mut_ptr(),
            count = inout(reg) N as u8 => _,
            inout("X") x.as_ptr() => _,
            inout("Z") x0.as_ptr() => _,
            out("r20") _,
            out("r21") _,
            out("r22") _,
            out("r23") _,
            out("r24") _,
            out("r25") _,
            options(nostack),
        );
        departure.assume_init()
    }
}

/// The one rounding and the one saturation.
#[inline(never)]
pub fn finish<const N: usize>(sum: i32, row: &Row<N>) -> i16 {
    const { assert!(size_of::<Row<N>>() <= 64) };
    let input: i16;
    // SAFETY: reads within the row from Z; r0 and r1 are again what they were at the end.
    unsafe {
        asm!(
            finish!(),
            "mov {kept}, r0",
            "clr r11",
            "handstand_finish {low:l}, {low:h}, r18, r19, r22, r23, {shift}, {least}, {most}",
            "clr r1",
            "mov r0, {kept}",
            forget!("power" "scale" "finish"),
            kept = out(reg) _,
            shift = const offset_of!(Row<N>, shift),
            least = const offset_of!(Row<N>, low),
            most = const offset_of!(Row<N>, high),
            low = in(reg_pair) sum as u16,
            inout("r19r18") (sum >> 16) as u16 => _,
            in("Z") row,
            out("r23r22") input,
            out("r11") _,
            out("r20") _,
            out("r24") _,
            out("r25") _,
            options(nostack, readonly),
        );
    }
    input
}

/// `bias` - sum of products of `k` and `x`, wrapping; of as many as the shorter has, at most 255.
#[inline(never)]
pub fn one_sum(bias: i32, k: &[i16], x: &[i16]) -> i32 {
    let count = k.len().min(x.len()).min(255) as u8;
    if count == 0 {
        return bias;
    }
    let (mut low, mut high) = (bias as u16, (bias >> 16) as u16);
    // SAFETY: reads `count` words from X and from Z, which both have; r0 and r1 are again what they
    // were at the end.
    unsafe {
        asm!(
            mac!(),
            "mov {kept}, r0",
            "clr r11",
            "2: ld r20, X+",
            "ld r21, X+",
            "ld r22, Z+",
            "ld r23, Z+",
            "handstand_mac {low:l}, {low:h}, {high:l}, {high:h}",
            "dec {count}",
            "brne 2b",
            "clr r1",
            "mov r0, {kept}",
            forget!("mac"),
            kept = out(reg) _,
            low = inout(reg_pair) low,
            high = inout(reg_pair) high,
            count = inout(reg) count => _,
            inout("X") x.as_ptr() => _,
            inout("Z") k.as_ptr() => _,
            out("r11") _,
            out("r20") _,
            out("r21") _,
            out("r22") _,
            out("r23") _,
            out("r24") _,
            out("r25") _,
            options(nostack, readonly),
        );
    }
    (u32::from(high) << 16 | u32::from(low)) as i32
}
