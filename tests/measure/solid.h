/* SPDX-License-Identifier: MIT
 * A scene's text by the C interface, for tests of what is measured of it.
 */
#ifndef TEST_MEASURE_SOLID_H
#define TEST_MEASURE_SOLID_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka wants the four above first */
#include <cmocka.h>

#include <string.h>

#include "csgmesh/csgmesh.h"
#include "failing.h"

typedef struct solid {
    csgm_context *context;
    csgm_scene *scene;
    csgm_field *field;
} solid;

static inline csgm_status open_solid(solid *s, csgm_context_options options, const char *text)
{
    *s = (solid){.context = NULL};
    options.threads = 1;
    csgm_status status = csgm_context_create(&options, &s->context);
    if (status == CSGM_OK)
        status = csgm_scene_parse(s->context, text, strlen(text), "test", NULL, &s->scene);
    if (status == CSGM_OK)
        status = csgm_field_compile(s->context, s->scene, &s->field);
    return status;
}

static inline void close_solid(solid *s)
{
    csgm_field_destroy(s->field);
    csgm_scene_destroy(s->scene);
    csgm_context_destroy(s->context);
}

/* Measures a text's solid, once for each allocation that it takes, which is refused, and then
 * without; `check` has what came of each. How many were refused. */
static inline int measure_with_refusals(const char *text, csgm_measure_options how,
                                        void (*check)(const csgm_measures *m, bool done))
{
    bool done = false;
    int refused = 0;
    for (long n = 0; !done; n++) {
        failing f = {.left = n};
        solid s;
        csgm_context_options options = csgm_context_options_default();
        options.allocator = (csgm_allocator){failing_alloc, failing_release, &f};
        if (open_solid(&s, options, text) == CSGM_OK) {
            csgm_measures m = csgm_measures_default();
            csgm_status status = csgm_measure_field(s.context, s.field, &how, &m);
            done = status == CSGM_OK;
            refused += !done;
            assert_true(done || status == CSGM_ERR_MEMORY);
            check(&m, done);
        }
        close_solid(&s);
        assert_int_equal(f.live, 0);
    }
    return refused;
}

static inline void assert_holds(csgm_interval interval, double value)
{
    assert_true(interval.low <= value);
    assert_true(interval.high >= value);
}

#endif
