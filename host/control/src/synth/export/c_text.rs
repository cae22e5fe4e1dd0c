//! What is the same in every C header, but for the name: `@` in large letters, `%` in small ones.

/// Tables, and where they are kept.
pub(super) const C_TABLE: &str = "
/* Where tables are kept and how they are read, shared by all such headers. On an AVR, `#define
   GAINS_PROGMEM` before the first of them leaves the tables in flash; for other memories define
   GAINS_CONST and GAINS_READ_8, _16, _32 of an address. */
#ifndef GAINS_CONST
#ifdef GAINS_PROGMEM
#include <avr/pgmspace.h>
#define GAINS_CONST const PROGMEM
#define GAINS_READ_8(at) ((uint8_t)pgm_read_byte(at))
#define GAINS_READ_16(at) ((int16_t)pgm_read_word(at))
#define GAINS_READ_32(at) ((int32_t)pgm_read_dword(at))
#else
#define GAINS_CONST const
#endif
#endif
#ifndef GAINS_READ_16
#define GAINS_READ_8(at) (*(at))
#define GAINS_READ_16(at) (*(at))
#define GAINS_READ_32(at) (*(at))
#endif

/* Gains, in steps of input step / state step / 2^shift. */
static GAINS_CONST int16_t %_k[@_INPUTS][@_STATES] = {<k>};
/* Input at the operating point times 2^shift, and the half that rounds. */
static GAINS_CONST int32_t %_bias[@_INPUTS] = {<bias>};
/* Places by which the sum is shifted right. */
static GAINS_CONST uint8_t %_shift[@_INPUTS] = {<shift>};
/* Least and greatest input, in steps. */
static GAINS_CONST int16_t %_limits[@_INPUTS][2] = {<limits>};
/* The operating point, in steps. */
static GAINS_CONST int16_t %_x0[@_STATES] = {<x0>};
";

/// The law, and steps of SI values.
pub(super) const C_LAW: &str = "
/* An SI value in steps of `step`, rounded, held within a word. */
static inline int16_t %_steps(float value, float step)
{
    float steps = value / step;
    if (!(steps > -32768.0f)) return INT16_MIN;
    if (steps >= 32767.0f) return INT16_MAX;
    return (int16_t)(steps < 0.0f ? steps - 0.5f : steps + 0.5f);
}

/* The inputs u for the states x, both in steps. */
static inline void %_control(const int16_t x[@_STATES], int16_t u[@_INPUTS])
{
    for (uint8_t i = 0; i < @_INPUTS; i++) {
        const int16_t low = GAINS_READ_16(&%_limits[i][0]);
        const int16_t high = GAINS_READ_16(&%_limits[i][1]);
        int32_t sum = GAINS_READ_32(&%_bias[i]);
        for (uint8_t j = 0; j < @_STATES; j++) {
            int32_t off = (int32_t)x[j] - GAINS_READ_16(&%_x0[j]);
            if (off > INT16_MAX) off = INT16_MAX;
            if (off < INT16_MIN) off = INT16_MIN;
            sum -= (int32_t)GAINS_READ_16(&%_k[i][j]) * off;
        }
        sum >>= GAINS_READ_8(&%_shift[i]);
        if (sum < low) sum = low;
        if (sum > high) sum = high;
        u[i] = (int16_t)sum;
    }
}
";

/// Integral action.
pub(super) const C_SUMS: &str = "
/* Integral action: of the states, <count> from place <first> on are sums of angles. Keep sums, 0 at
   the start, and call this with x and u after each %_control, before x is filled for the next
   sample: it adds the angles of x to the sums, unless an input is at its limit, and puts the sums
   into x. */
#define @_SUMS <count>
static GAINS_CONST uint8_t %_sum_of[@_SUMS] = {<joints>};
static GAINS_CONST uint8_t %_sum_shift[@_SUMS] = {<shift>};
static inline void %_integrate(int32_t sums[@_SUMS], int16_t x[@_STATES], const int16_t u[@_INPUTS])
{
    for (uint8_t i = 0; i < @_INPUTS; i++) {
        if (u[i] == GAINS_READ_16(&%_limits[i][0])) return;
        if (u[i] == GAINS_READ_16(&%_limits[i][1])) return;
    }
    for (uint8_t j = 0; j < @_SUMS; j++) {
        const uint8_t joint = GAINS_READ_8(&%_sum_of[j]);
        const uint8_t shift = GAINS_READ_8(&%_sum_shift[j]);
        const int32_t most = (int32_t)INT16_MAX << shift;
        int32_t step = (int32_t)x[joint] - GAINS_READ_16(&%_x0[joint]);
        if (sums[j] > most - step && step > 0) step = most - sums[j];
        if (sums[j] < -most - step && step < 0) step = -most - sums[j];
        sums[j] += step;
        x[<first> + j] = (int16_t)(sums[j] >> shift);
    }
}
";

/// Vectors that any implementation can be checked by.
pub(super) const C_TEST: &str = "
/* With `#define GAINS_TEST`: states, the inputs that a right law gives for them, and a check. */
#ifdef GAINS_TEST
#define @_GOLDEN <count>
static GAINS_CONST int16_t %_golden_x[@_GOLDEN][@_STATES] = {
    <x>
};
static GAINS_CONST int16_t %_golden_u[@_GOLDEN][@_INPUTS] = {
    <u>
};

/* 0 if %_control gives the right inputs for every golden vector, else the number of the first one,
   counted from 1, for which it does not. */
static inline int %_check(void)
{
    for (int g = 0; g < @_GOLDEN; g++) {
        int16_t x[@_STATES], u[@_INPUTS];
        for (int j = 0; j < @_STATES; j++) x[j] = GAINS_READ_16(&%_golden_x[g][j]);
        %_control(x, u);
        for (int i = 0; i < @_INPUTS; i++)
            if (u[i] != GAINS_READ_16(&%_golden_u[g][i])) return g + 1;
    }
    return 0;
}
#endif

#endif
";
