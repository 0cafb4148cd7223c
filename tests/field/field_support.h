/* SPDX-License-Identifier: MIT
 * What the field tests share: compiled scenes, points of a batch in the field's frame, and what a
 * kernel says about them.
 */
#ifndef TEST_FIELD_SUPPORT_H
#define TEST_FIELD_SUPPORT_H

#include "field/field.h"
#include "field/kernels/dispatch.h"
#include "scene/random_scene.h"
#include "scene/scene_support.h"

enum { TEST_MOST_POINTS = 512 };

/* Points in the field's frame. */
typedef struct test_points {
    size_t count;
    float x[TEST_MOST_POINTS], y[TEST_MOST_POINTS], z[TEST_MOST_POINTS];
} test_points;

typedef struct test_results {
    float value[TEST_MOST_POINTS];
    float gradient[3][TEST_MOST_POINTS];
    float color[4][TEST_MOST_POINTS];
} test_results;

/* A scene and its tape, and the context that owns both. */
typedef struct test_subject {
    csgm_context context;
    csg_scene_builder builder;
    csgm_scene *scene;
    csgm_field *field;
} test_subject;

/* Begin, build a root with subject->builder, then compile, then end (which checks for leaks). */
void test_subject_begin(test_subject *subject);
void test_subject_compile(test_subject *subject, csg_node_id root);
void test_subject_end(test_subject *subject);

void test_points_clear(test_points *points);
/* The nearest floats; false when the batch is full. */
bool test_points_add(test_points *points, csg_vec3 at);
/* In the scene's frame. */
csg_vec3 test_points_in_scene(const test_points *points, size_t i, const csgm_field *field);

void test_evaluate(const csg_kernel *kernel, const csg_tape *tape, const test_points *points,
                   test_results *out);

/* The builds of the kernels that this machine runs, scalar first; returns how many. */
size_t test_kernels(const csg_kernel *kernels[8]);

/* Same bits in every array, or the test fails and says where. Zeros may differ in sign unless
 * `zeros_too`. */
void test_same_bits(const test_results *a, const test_results *b, size_t count, bool zeros_too,
                    const char *what);

/* Whether the reference's gradient changes by less than 5e-4 within `reach` of p. */
bool test_is_smooth(const csgm_scene *scene, csg_vec3 p, double reach);

#endif
