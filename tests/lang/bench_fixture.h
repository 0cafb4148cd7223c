/* SPDX-License-Identifier: MIT
 * The fixture of tests that use one bench: opened before them, all memory back after them.
 */
#ifndef TESTS_LANG_BENCH_FIXTURE_H
#define TESTS_LANG_BENCH_FIXTURE_H

#include "lang/support.h"

static bench b;

static int open_bench(void **state)
{
    (void)state;
    bench_open(&b, NULL);
    return 0;
}

static int close_bench(void **state)
{
    (void)state;
    bench_close(&b);
    return 0;
}

#endif
