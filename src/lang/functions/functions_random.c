/* SPDX-License-Identifier: MIT
 * rands(): for a seed the numbers that OpenSCAD gives, so that a scene that depends on them is the
 * same solid. The generator is MT19937 (Matsumoto and Nishimura 1998); two of its words make a
 * number in [0, 1). Without a seed it is one sequence for all of an evaluation, begun with seed 0.
 */
#include <float.h>
#include <math.h>

#include "lang/functions/functions.h"

enum { WORDS = CSG_TWISTER_WORDS, MIDDLE = 397 };

static void seed_twister(csg_twister *twister, uint32_t seed)
{
    twister->words[0] = seed;
    for (uint32_t i = 1; i < WORDS; i++) {
        uint32_t before = twister->words[i - 1];
        twister->words[i] = 1812433253u * (before ^ before >> 30) + i;
    }
    twister->next = WORDS;
}

static void twist(csg_twister *twister)
{
    uint32_t *words = twister->words;
    for (uint32_t i = 0; i < WORDS; i++) {
        uint32_t joined = (words[i] & 0x80000000u) | (words[(i + 1) % WORDS] & 0x7FFFFFFFu);
        words[i] = words[(i + MIDDLE) % WORDS] ^ joined >> 1 ^ (joined & 1 ? 0x9908B0DFu : 0);
    }
    twister->next = 0;
}

static uint32_t next_word(csg_twister *twister)
{
    if (twister->next == WORDS)
        twist(twister);
    uint32_t y = twister->words[twister->next++];
    y ^= y >> 11;
    y ^= y << 7 & 0x9D2C5680u;
    y ^= y << 15 & 0xEFC60000u;
    return y ^ y >> 18;
}

/* In [low, high): the second word is the upper half. */
static double next_number(csg_twister *twister, double low, double high)
{
    double lower = next_word(twister);
    double unit = (lower + next_word(twister) * 0x1p32) * 0x1p-64;
    return (unit < 1 ? unit : 1 - 0x1p-53) * (high - low) + low;
}

/* A whole number from 0 to 2^31 - 2 is its own seed; any other number is taken modulo the prime
 * 2^31 - 1, where a power of two is a rotation of 31 bits (as Python hashes numbers). */
static uint32_t seed_of(double number)
{
    const uint64_t prime = 0x7FFFFFFF;
    int exponent;
    if (isnan(number))
        return 0;
    if (isinf(number))
        return number > 0 ? 314159u : 0u - 314159u;
    uint64_t seed = (uint64_t)ldexp(frexp(fabs(number), &exponent), 53) % prime;
    int rotation = ((exponent - 53) % 31 + 31) % 31;
    seed = (seed << rotation) % prime;
    return number < 0 ? 0u - (uint32_t)seed : (uint32_t)seed;
}

static csg_twister *twister_of(const csg_function_call *call)
{
    csg_eval *e = call->e;
    bool fresh = !e->twister;
    if (fresh)
        e->twister = csg_arena_alloc(&e->program->arena, 2 * sizeof *e->twister);
    if (!e->twister) {
        csg_eval_no_memory(e);
        return NULL;
    }
    if (fresh)
        seed_twister(&e->twister[0], 0);
    if (call->count <= 3)
        return &e->twister[0];
    seed_twister(&e->twister[1], seed_of(call->arguments[3].as.number));
    return &e->twister[1];
}

csg_value csg_function_rands(const csg_function_call *call)
{
    double values[4] = {0};
    for (uint32_t i = 0; i < call->count; i++) {
        if (call->arguments[i].kind != CSG_VALUE_NUMBER)
            return csg_bad_argument(call, i, "numbers");
        values[i] = call->arguments[i].as.number;
    }
    if (!isfinite(values[2]))
        return csg_bad_argument(call, 2, "a finite count");
    double low = isfinite(values[0]) ? values[0] : -DBL_MAX / 2;
    double high = isfinite(values[1]) ? values[1] : DBL_MAX / 2;
    double count = trunc(fabs(values[2]));
    csg_twister *twister = twister_of(call);
    csg_list list = {0};
    csg_list_reserve(call->e, &list, count, call->where);
    for (double i = 0; i < count && twister && csg_eval_charge(call->e, 1, call->where); i++) {
        double number = low == high ? low : next_number(twister, fmin(low, high), fmax(low, high));
        csg_list_push(call->e, &list, csg_value_number(number), call->where);
    }
    return csg_list_finish(call->e, &list);
}
