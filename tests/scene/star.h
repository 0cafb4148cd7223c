/* SPDX-License-Identifier: MIT
 * A region for tests: a star with a hole in it.
 */
#ifndef TEST_SCENE_STAR_H
#define TEST_SCENE_STAR_H

#include "scene_support.h"
#include "shape/plane/region.h"

/* A star of `count` corners, whose radii `radius` gives, with a hole of which corners share
 * heights. */
static inline csg_shape *test_star(csg_memory *memory, int count,
                                   double (*radius)(int corner, csg_random *random),
                                   csg_random *random)
{
    static const csg_vec2 hole[4] = {{-0.2, -0.2}, {-0.2, 0.1}, {0.2, 0.1}, {0.2, -0.2}};
    csg_outline star;
    csg_shape *shape = NULL;
    csg_outline_init(&star, memory);
    for (int i = 0; i < count; i++) {
        double r = radius(i, random), angle = i * 6.283185307179586 / count;
        assert_true(csg_outline_add(&star, (csg_vec2){r * cos(angle), r * sin(angle)}));
    }
    assert_true(csg_outline_close(&star));
    for (int i = 0; i < 4; i++)
        assert_true(csg_outline_add(&star, hole[i]));
    assert_true(csg_outline_close(&star));
    assert_int_equal(csg_region_create(memory, &star, &shape), CSGM_OK);
    csg_outline_release(&star);
    return shape;
}

#endif
