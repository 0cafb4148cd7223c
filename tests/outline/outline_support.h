/* SPDX-License-Identifier: MIT
 * For the tests of readers: memory that counts and fails when asked to, areas and boxes.
 */
#ifndef TESTS_OUTLINE_SUPPORT_H
#define TESTS_OUTLINE_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "outline/input.h"
#include "shape/plane/polygons.h"

/* The n-th allocation from now on fails, and all after it; 0 = none. */
void support_fail_at(size_t n);
extern csg_memory memory;
int support_setup(void **state);
/* Fails when memory was not given back. */
int support_teardown(void **state);

/* |a - b| <= tolerance. */
#define support_near(a, b, tolerance) support_near_at((a), (b), (tolerance), __FILE__, __LINE__)
void support_near_at(double a, double b, double tolerance, const char *file, int line);

/* A file beside the tests, whose folder is the program's first argument. */
extern const char *support_folder;
csg_bytes support_file(const char *name);

/* Of clean loops. */
double support_area(const csg_outline *outline);
/* The union of the loops takes their place. */
void support_clean(csg_outline *outline);
/* Box and area (of the union) are these, within `tolerance` (area: times the box's half girth). */
void support_expect(csg_outline *outline, double x0, double y0, double x1, double y1, double area,
                    double tolerance);

/* Damages the text in `rounds` ways that a fixed seed makes - cut off, bytes changed, pieces
 * doubled
 * - and calls `reader` on each. */
void support_damage(const char *text, size_t length, int rounds,
                    void (*reader)(const char *text, size_t length));
/* Calls `reader` with the first, second, ... allocation failing, until it gets through. */
void support_starve(const char *text, size_t length,
                    csgm_status (*reader)(const char *text, size_t length));

#endif
