/* SPDX-License-Identifier: MIT
 * See field_support.h.
 */
#include "field/field_support.h"

#include <stdlib.h>
#include <string.h>

void test_subject_begin(test_subject *subject)
{
    memset(subject, 0, sizeof *subject);
    test_context_init(&subject->context);
    assert_int_equal(csg_build_begin(&subject->builder, &subject->context), CSGM_OK);
}

void test_subject_compile(test_subject *subject, csg_node_id root)
{
    subject->scene = test_seal(&subject->builder, root);
    assert_int_equal(csg_field_compile(&subject->context, subject->scene, &subject->field),
                     CSGM_OK);
}

void test_subject_end(test_subject *subject)
{
    csg_field_destroy(subject->field);
    csg_scene_destroy(subject->scene);
    test_context_end(&subject->context);
}

void test_points_clear(test_points *points)
{
    memset(points, 0, sizeof *points);
}

bool test_points_add(test_points *points, csg_vec3 at)
{
    if (points->count == TEST_MOST_POINTS)
        return false;
    points->x[points->count] = (float)at.x;
    points->y[points->count] = (float)at.y;
    points->z[points->count] = (float)at.z;
    points->count++;
    return true;
}

csg_vec3 test_points_in_scene(const test_points *points, size_t i, const csgm_field *field)
{
    csg_vec3 at = {(double)points->x[i], (double)points->y[i], (double)points->z[i]};
    return csg_vec3_add(at, field->center);
}

static void same_bits(const float *a, const float *b, size_t count, bool zeros_too,
                      const char *array, const char *what)
{
    for (size_t i = 0; i < count; i++) {
        bool both_zero = a[i] == 0 && b[i] == 0 && !zeros_too;
        if (memcmp(&a[i], &b[i], sizeof *a) && !both_zero)
            fail_msg("%s: %s differs at point %zu: %.9g (%a) and %.9g (%a)", what, array, i,
                     (double)a[i], (double)a[i], (double)b[i], (double)b[i]);
    }
}

/* Both by one walk are what they are by two. */
static void evaluate_together(const csg_kernel *kernel, const csg_tape *tape,
                              const test_points *points, const test_results *alone, float *scratch,
                              size_t floats)
{
    test_results both;
    kernel->values_and_gradients(tape, points->x, points->y, points->z, points->count, both.value,
                                 both.gradient[0], both.gradient[1], both.gradient[2], scratch,
                                 floats);
    same_bits(both.value, alone->value, points->count, true, "value", "both at once");
    for (int c = 0; c < 3; c++)
        same_bits(both.gradient[c], alone->gradient[c], points->count, true, "gradient",
                  "both at once");
}

void test_evaluate(const csg_kernel *kernel, const csg_tape *tape, const test_points *points,
                   test_results *out)
{
    size_t floats = csg_kernel_scratch_floats(csg_tape_depth(tape));
    float *scratch = malloc(floats * sizeof *scratch);
    assert_non_null(scratch);
    memset(out, 0, sizeof *out);
    float *const rgba[4] = {out->color[0], out->color[1], out->color[2], out->color[3]};
    kernel->values(tape, points->x, points->y, points->z, points->count, out->value, scratch,
                   floats);
    kernel->gradients(tape, points->x, points->y, points->z, points->count, out->gradient[0],
                      out->gradient[1], out->gradient[2], scratch, floats);
    kernel->colors(tape, points->x, points->y, points->z, points->count, rgba, scratch, floats);
    evaluate_together(kernel, tape, points, out, scratch, floats);
    free(scratch);
}

size_t test_kernels(const csg_kernel *kernels[8])
{
    size_t count = 0;
    for (csgm_isa isa = CSGM_ISA_SCALAR; isa <= CSGM_ISA_SIMD128; isa++)
        if (csg_cpu_best_isa(isa) == isa)
            kernels[count++] = csg_kernel_for(isa);
    assert_true(count > 0);
    return count;
}

void test_same_bits(const test_results *a, const test_results *b, size_t count, bool zeros_too,
                    const char *what)
{
    same_bits(a->value, b->value, count, zeros_too, "value", what);
    for (int c = 0; c < 3; c++)
        same_bits(a->gradient[c], b->gradient[c], count, zeros_too, "gradient", what);
    for (int c = 0; c < 4; c++)
        same_bits(a->color[c], b->color[c], count, zeros_too, "colour", what);
}

bool test_is_smooth(const csgm_scene *scene, csg_vec3 p, double reach)
{
    csg_vec3 here = test_sample(scene, p).gradient;
    for (int corner = 0; corner < 27; corner++) {
        csg_vec3 step = {corner % 3 - 1, corner / 3 % 3 - 1, corner / 9 - 1};
        csg_vec3 there = test_sample(scene, csg_vec3_add(p, csg_vec3_scale(step, reach))).gradient;
        if (csg_vec3_norm(csg_vec3_sub(there, here)) > 5e-4)
            return false;
    }
    return true;
}
