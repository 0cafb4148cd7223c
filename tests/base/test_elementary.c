/* SPDX-License-Identifier: MIT
 * Elementary functions: what is exact comes out so, zeros, infinities and NaN are as the C standard
 * has them, a checksum of many values is the one that every machine has, and, where MPFR is there,
 * each is the true value rounded.
 *
 * Usage: base_test_elementary [COUNT SEED]: random arguments a function for MPFR.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/elementary.h"
#include "base/random.h"

#ifdef CSG_TEST_MPFR
#include <mpfr.h>

#include "base/elementary_tables.h"
#define TRUTH(function) , function
#else
#define TRUTH(function)
#endif

typedef struct one_argument {
    const char *name;
    double (*ours)(double), (*theirs)(double);
#ifdef CSG_TEST_MPFR
    int (*truth)(mpfr_t, mpfr_srcptr, mpfr_rnd_t);
#endif
} one_argument;

typedef struct two_arguments {
    const char *name;
    double (*ours)(double, double), (*theirs)(double, double);
#ifdef CSG_TEST_MPFR
    int (*truth)(mpfr_t, mpfr_srcptr, mpfr_srcptr, mpfr_rnd_t);
#endif
} two_arguments;

static const one_argument ONE[] = {
    {"sin", csg_sin, sin TRUTH(mpfr_sin)},     {"cos", csg_cos, cos TRUTH(mpfr_cos)},
    {"tan", csg_tan, tan TRUTH(mpfr_tan)},     {"asin", csg_asin, asin TRUTH(mpfr_asin)},
    {"acos", csg_acos, acos TRUTH(mpfr_acos)}, {"atan", csg_atan, atan TRUTH(mpfr_atan)},
    {"exp", csg_exp, exp TRUTH(mpfr_exp)},     {"log", csg_log, log TRUTH(mpfr_log)},
    {"log2", csg_log2, log2 TRUTH(mpfr_log2)}, {"log10", csg_log10, log10 TRUTH(mpfr_log10)},
};
static const two_arguments TWO[] = {
    {"atan2", csg_atan2, atan2 TRUTH(mpfr_atan2)},
    {"pow", csg_pow, pow TRUTH(mpfr_pow)},
    {"hypot", csg_hypot, hypot TRUTH(mpfr_hypot)},
};
enum { ONES = sizeof ONE / sizeof *ONE, TWOS = sizeof TWO / sizeof *TWO };

static int count_tried = 20000;
static uint64_t seed = 1;

/* Small and large, near and far, whole and short ones: six kinds. */
static double draw(csg_random *random, int kind)
{
    double sign = csg_random_below(random, 2) ? 1 : -1, part = csg_random_uniform(random, 1, 2);
    switch (kind) {
    case 0:
        return csg_random_uniform(random, -1, 1);
    case 1:
        return csg_random_uniform(random, -10, 10);
    case 2:
        return sign * ldexp(part, (int)csg_random_below(random, 80) - 40);
    case 3:
        return csg_random_uniform(random, 0, 1000);
    case 4:
        return sign * csg_random_below(random, 200) / (1 + csg_random_below(random, 8));
    default:
        return sign * ldexp(part, (int)csg_random_below(random, 2000) - 1000);
    }
}

static uint64_t bits_of(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return isnan(x) ? 0 : bits;
}

/* FNV-1a over the bits of many values. The sum was written down on x86-64 with gcc 12: another
 * compiler, processor or C library that has another one would also have other meshes. */
static void test_checksum(void **state)
{
    uint64_t sum = 0xcbf29ce484222325u;
    csg_random random = {4};
    for (int i = 0; i < 6000; i++) {
        double x = draw(&random, i % 6), y = draw(&random, i / 6 % 6);
        for (int k = 0; k < ONES; k++)
            sum = (sum ^ bits_of(ONE[k].ours(x))) * 0x100000001b3u;
        for (int k = 0; k < TWOS; k++)
            sum = (sum ^ bits_of(TWO[k].ours(x, y))) * 0x100000001b3u;
        sum = (sum ^ bits_of(csg_arc_cosine(x))) * 0x100000001b3u;
    }
    assert_int_equal(sum, 0x55d031c599e728eeu);
}

static bool is_same(double a, double b)
{
    return bits_of(a) == bits_of(b);
}

/* All that C's functions define without rounding, so the C library is asked. */
static void test_special(void **state)
{
    static const double special[] = {0,   -0.0,      1,          -1,       2,
                                     -2,  3,         -3,         INFINITY, -INFINITY,
                                     NAN, 0x1p-1074, -0x1p-1074, 1e300,    -1e300};
    enum { COUNT = sizeof special / sizeof *special };
    for (int i = 0; i < COUNT; i++) {
        double x = special[i];
        bool is_far = isfinite(x) && fabs(x) > 0x1p40; /* an angle that says nothing */
        for (int k = is_far ? 3 : 0; k < ONES; k++)
            if (!is_same(ONE[k].ours(x), ONE[k].theirs(x)))
                fail_msg("%s(%g) = %a, not %a", ONE[k].name, x, ONE[k].ours(x), ONE[k].theirs(x));
        for (int j = 0; j < COUNT; j++)
            for (int k = 0; k < TWOS; k++) {
                double ours = TWO[k].ours(x, special[j]), theirs = TWO[k].theirs(x, special[j]);
                if (!is_same(ours, theirs))
                    fail_msg("%s(%g, %g) = %a, not %a", TWO[k].name, x, special[j], ours, theirs);
            }
        assert_true(!is_far || (fabs(csg_sin(x)) <= 1 && fabs(csg_cos(x)) <= 1));
    }
}

static void test_exact(void **state)
{
    for (int i = -20; i <= 20; i++) {
        assert_true(csg_log2(ldexp(1, i)) == i);
        assert_true(csg_pow(2, i) == ldexp(1, i) &&
                    csg_pow(-2, i) == (i % 2 ? -1 : 1) * ldexp(1, i));
    }
    double power = 1;
    for (int i = 0; i <= 15; i++, power *= 10) {
        assert_true(csg_pow(10, i) == power && csg_log10(power) == i);
        assert_true(csg_hypot(3 * power, 4 * power) == 5 * power);
    }
    assert_true(csg_pow(0x1p26 + 1, 2) == 0x1p52 + 0x1p27 + 1); /* 53 bits */
    assert_true(csg_pow(0x1p27 + 1, 2) == 0x1p54 + 0x1p28);     /* half a unit: to the even one */
    assert_true(csg_pow(27, 1.0 / 3) == 3 && csg_pow(0.25, 0.5) == 0.5);
    assert_true(csg_hypot(3e-320, 4e-320) == 5e-320 && csg_hypot(3e300, 4e300) == 5e300);
    assert_true(csg_acos(-1) == 3.14159265358979323846 && csg_exp(0) == 1);
    assert_true(isinf(csg_exp(709.79)) && csg_exp(-745.2) == 0 && csg_exp(-745.1) == 0x1p-1074);
}

#ifdef CSG_TEST_MPFR
/* high + low are the value to 2^-105 of it. */
static void expect_sum(csg_twofold is, mpfr_t value)
{
    mpfr_t rest;
    mpfr_init2(rest, 200);
    mpfr_sub_d(rest, value, is.high, MPFR_RNDN);
    mpfr_sub_d(rest, rest, is.low, MPFR_RNDN);
    assert_true(fabs(mpfr_get_d(rest, MPFR_RNDN)) <= ldexp(fabs(is.high), -105));
    mpfr_clear(rest);
}

static void test_tables(void **state)
{
    mpfr_t value;
    mpfr_init2(value, 200);
    for (unsigned long i = 0; i < sizeof INVERSE_FACTORIAL / sizeof *INVERSE_FACTORIAL; i++) {
        mpfr_fac_ui(value, i, MPFR_RNDN);
        mpfr_ui_div(value, 1, value, MPFR_RNDN);
        expect_sum(INVERSE_FACTORIAL[i], value);
    }
    for (int i = 0; i < 64; i++) {
        mpfr_set_d(value, i / 64.0, MPFR_RNDN);
        mpfr_exp2(value, value, MPFR_RNDN);
        expect_sum(ROOT_OF_TWO[i], value);
    }
    for (int i = LOG_FIRST; i <= LOG_LAST; i++) {
        mpfr_set_d(value, nearbyint(65536.0 / i) * 0x1p-10, MPFR_RNDN);
        mpfr_log(value, value, MPFR_RNDN);
        mpfr_neg(value, value, MPFR_RNDN);
        expect_sum(LOG_OF_INVERSE[i - LOG_FIRST], value);
    }
    static const struct {
        const csg_twofold *table;
        int count, (*truth)(mpfr_t, mpfr_srcptr, mpfr_rnd_t);
    } of_32nds[] = {{SINE, sizeof SINE / sizeof *SINE, mpfr_sin},
                    {COSINE, sizeof COSINE / sizeof *COSINE, mpfr_cos},
                    {ARC_TANGENT, sizeof ARC_TANGENT / sizeof *ARC_TANGENT, mpfr_atan}};
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < of_32nds[k].count; i++) {
            mpfr_set_d(value, i / 32.0, MPFR_RNDN);
            of_32nds[k].truth(value, value, MPFR_RNDN);
            expect_sum(of_32nds[k].table[i], value);
        }
    mpfr_clear(value);
}

static double rounded(mpfr_t value, int direction)
{
    mpfr_subnormalize(value, direction, MPFR_RNDN);
    return mpfr_get_d(value, MPFR_RNDN);
}

/* The true value, or so small that its last bit is not promised. */
static bool is_true(double is, double want)
{
    return is_same(is, want) || (fabs(want) < 0x1p-1022 && fabs(is - want) <= 0x1p-1074);
}

/* Each of many random values is the true one, rounded. Angles of 2^42 and more are not promised. */
static void test_truth(void **state)
{
    csg_random random = {seed};
    mpfr_t x, y, truth;
    mpfr_inits2(53, x, y, truth, (mpfr_ptr)0);
    mpfr_set_emin(-1073);
    mpfr_set_emax(1024);
    for (int i = 0; i < count_tried; i++) {
        double a = draw(&random, i % 6), b = draw(&random, i / 6 % 6);
        mpfr_set_d(x, a, MPFR_RNDN);
        mpfr_set_d(y, b, MPFR_RNDN);
        for (int k = fabs(a) > 0x1p42 ? 3 : 0; k < ONES; k++) {
            double want = rounded(truth, ONE[k].truth(truth, x, MPFR_RNDN)), is = ONE[k].ours(a);
            if (!is_true(is, want))
                fail_msg("%s(%a) = %a, not %a", ONE[k].name, a, is, want);
        }
        for (int k = 0; k < TWOS; k++) {
            double want = rounded(truth, TWO[k].truth(truth, x, y, MPFR_RNDN));
            if (!is_true(TWO[k].ours(a, b), want))
                fail_msg("%s(%a, %a) = %a, not %a", TWO[k].name, a, b, TWO[k].ours(a, b), want);
        }
    }
    mpfr_clears(x, y, truth, (mpfr_ptr)0);
    mpfr_free_cache();
}
#endif

/* The fast one keeps within what its header says. */
static void test_arc_cosine(void **state)
{
    enum { STEPS = 20000 };
    assert_true(csg_arc_cosine(1) == 0 && csg_arc_cosine(7) == 0);
    assert_true(fabs(csg_arc_cosine(-1) - csg_acos(-1)) < 2e-15);
    assert_true(csg_arc_cosine(-7) == csg_arc_cosine(-1));
    for (int i = 0; i <= STEPS; i++) {
        double cosine = 2.0 * i / STEPS - 1, less = nextafter(1, 0) - 1e-12 * i;
        assert_true(fabs(csg_arc_cosine(cosine) - csg_acos(cosine)) <= 2e-15);
        assert_true(fabs(csg_arc_cosine(less) - csg_acos(less)) <= 2e-15);
    }
}

int main(int argc, char **argv)
{
    if (argc > 2) {
        count_tried = atoi(argv[1]);
        seed = strtoull(argv[2], NULL, 10);
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_checksum), cmocka_unit_test(test_special),
        cmocka_unit_test(test_exact),    cmocka_unit_test(test_arc_cosine),
#ifdef CSG_TEST_MPFR
        cmocka_unit_test(test_tables),   cmocka_unit_test(test_truth),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
