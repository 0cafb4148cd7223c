/* SPDX-License-Identifier: MIT
 * The fixture of tests that build one scene at a time: a context and a builder, made before each
 * test and checked for leaks after it.
 */
#ifndef TEST_SCENE_FIXTURE_H
#define TEST_SCENE_FIXTURE_H

#include "scene_support.h"

static csgm_context context;
static csg_scene_builder builder;

static int begin(void **state)
{
    test_context_init(&context);
    return csg_build_begin(&builder, &context) != CSGM_OK;
}

static int end(void **state)
{
    csg_build_abandon(&builder);
    test_context_end(&context);
    return 0;
}

#endif
