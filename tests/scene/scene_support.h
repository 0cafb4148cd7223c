/* SPDX-License-Identifier: MIT
 * What the scene tests share: a context that checks for leaks, sealing a scene, one sample.
 */
#ifndef TEST_SCENE_SUPPORT_H
#define TEST_SCENE_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/random.h"
#include "scene/boxes/bounds.h"
#include "scene/reference.h"
#include "scene/tree/build.h"

#define NOWHERE ((csg_span){.source = UINT32_MAX})

static inline void test_context_init(csgm_context *context)
{
    *context = (csgm_context){0};
    csg_memory_init(&context->memory, NULL, 0);
}

static inline void test_context_end(csgm_context *context)
{
    assert_int_equal(atomic_load(&context->memory.used_bytes), 0);
}

/* The builder must not have failed. */
static inline csgm_scene *test_seal(csg_scene_builder *builder, csg_node_id root)
{
    csgm_scene *scene = NULL;
    assert_string_equal(builder->problem, "");
    assert_int_equal(csg_build_finish(builder, root, NULL, 0, &scene), CSGM_OK);
    assert_non_null(scene);
    csg_build_abandon(builder);
    return scene;
}

static inline csg_sample test_sample(const csgm_scene *scene, csg_vec3 p)
{
    csgm_status status = CSGM_OK;
    csg_sample sample = csg_reference_eval(scene, p, &status);
    assert_int_equal(status, CSGM_OK);
    return sample;
}

/* Steps of Newton along the gradient, towards the surface. */
static inline csg_vec3 test_towards_surface(const csgm_scene *scene, csg_vec3 p, int steps)
{
    for (int i = 0; i < steps; i++) {
        csg_sample s = test_sample(scene, p);
        double square = csg_vec3_dot(s.gradient, s.gradient);
        if (square > 0.01)
            p = csg_vec3_sub(p, csg_vec3_scale(s.gradient, s.value / square));
    }
    return p;
}

static inline csg_vec3 test_point(csg_random *random, double reach)
{
    return csg_vec3_make(csg_random_uniform(random, -reach, reach),
                         csg_random_uniform(random, -reach, reach),
                         csg_random_uniform(random, -reach, reach));
}

static inline csg_vec3 test_direction(csg_random *random)
{
    for (;;) {
        csg_vec3 v = test_point(random, 1);
        double length = csg_vec3_norm(v);
        if (length > 0.1 && length < 1)
            return csg_vec3_normalize(v);
    }
}

static inline void test_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.17g is not within %g of %.17g", value, tolerance, expected);
}

static inline void test_near_vec3(csg_vec3 value, csg_vec3 expected, double tolerance)
{
    test_near(value.x, expected.x, tolerance);
    test_near(value.y, expected.y, tolerance);
    test_near(value.z, expected.z, tolerance);
}

#endif
