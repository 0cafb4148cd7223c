/* SPDX-License-Identifier: MIT
 * Outlines for tests: random ones, their area, an allocator that fails at its n-th call.
 */
#ifndef CSG_TESTS_OUTLINE_SUPPORT_H
#define CSG_TESTS_OUTLINE_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/random.h"
#include "failing.h"
#include "shape/plane/outline.h"

typedef struct failing_memory {
    csg_memory memory;
    failing allocator;
} failing_memory;

void failing_init(failing_memory *f, long left);

/* A counter-clockwise loop about the centre; radii between inner and outer. */
void add_star(csg_outline *outline, csg_random *random, csg_vec2 center, double inner, double outer,
              int corners, bool clockwise);
void add_rectangle(csg_outline *outline, double x0, double y0, double x1, double y1);
/* Points anywhere in a square: crosses itself. */
void add_scribble(csg_outline *outline, csg_random *random, double size, int corners);

double area_of(const csg_outline *outline);
/* Winding number by angles. */
int winding_of(const csg_outline *outline, csg_vec2 p);
/* Distance to the nearest segment. */
double distance_of(const csg_outline *outline, csg_vec2 p);

/* Triangles as csg_polygons_triangulate promises: counter-clockwise, of the outline's area, each
 * edge of the outline on just one of them and each other edge on two, once in each direction.
 * `slack`: area that rounding may have turned over. */
void check_triangles(const csg_outline *outline, const uint32_t *indices, size_t count,
                     double slack);

#endif
