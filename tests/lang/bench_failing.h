/* SPDX-License-Identifier: MIT
 * What a bench does when memory runs out: one allocation after the other fails.
 */
#ifndef TESTS_LANG_BENCH_FAILING_H
#define TESTS_LANG_BENCH_FAILING_H

#include "failing.h"
#include "lang/support.h"

/* Compiles or loads what is tried. */
typedef csgm_status bench_attempt(bench *poor);

/* Tries with the first, second, ... allocation failing until it gets through: then without a
 * mistake, before that with CSGM_ERR_MEMORY and all memory given back. Every one of the first
 * `dense`, of later ones one in a `share`th of those before it. Returns how many failed. */
static inline long bench_fail_every(bench_attempt *attempt, long dense, long share)
{
    static bench poor;
    failing f = {0};
    const csgm_allocator allocator = {failing_alloc, failing_release, &f};
    long failures = 0;
    bench_open(&poor, &allocator);
    for (long n = 0;; n += n < dense ? 1 : 1 + n / share) {
        f.left = n;
        csgm_status status = attempt(&poor);
        bool failed = f.left < 0;
        if (status != (failed ? CSGM_ERR_MEMORY : CSGM_OK))
            print_error("allocation %ld: status %d\n%s", n, status, poor.text);
        assert_int_equal(status, failed ? CSGM_ERR_MEMORY : CSGM_OK);
        if (!failed)
            break;
        assert_int_equal(f.live, 0);
        failures++;
    }
    bench_close(&poor);
    return failures;
}

#endif
