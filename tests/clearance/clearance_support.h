/* SPDX-License-Identifier: MIT
 * Scenes of two parts and what csgm_clearances says of them.
 */
#ifndef TEST_CLEARANCE_SUPPORT_H
#define TEST_CLEARANCE_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka wants the four above first */
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "csgmesh/clearance.h"

static inline csgm_status clear_add(csgm_context *context, csgm_clearances *clearances,
                                    const char *text)
{
    csgm_scene *scene = NULL;
    csgm_status status = csgm_scene_parse(context, text, strlen(text), "test", NULL, &scene);
    if (status == CSGM_OK)
        status = csgm_clearances_add(clearances, scene);
    csgm_scene_destroy(scene);
    return status;
}

/* The first pair of a scene at one pose. */
static inline csgm_clear_pair clear_pair(const csgm_clear_options *options, const char *text)
{
    csgm_context *context = NULL;
    csgm_clearances *clearances = NULL;
    csgm_context_options of_context = csgm_context_options_default();
    of_context.threads = 2;
    assert_int_equal(csgm_context_create(&of_context, &context), CSGM_OK);
    assert_int_equal(csgm_clearances_create(context, options, &clearances), CSGM_OK);
    csgm_status status = clear_add(context, clearances, text);
    if (status != CSGM_OK)
        fail_msg("status %d of %s", status, text);
    const csgm_clear_pair *pair = csgm_clearances_get(clearances, 0);
    assert_non_null(pair);
    csgm_clear_pair out = *pair;
    out.names[0] = out.names[1] = NULL; /* these go with the clearances */
    csgm_clearances_destroy(clearances);
    csgm_context_destroy(context);
    return out;
}

#endif
