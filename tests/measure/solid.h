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

static inline void assert_holds(csgm_interval interval, double value)
{
    assert_true(interval.low <= value);
    assert_true(interval.high >= value);
}

#endif
