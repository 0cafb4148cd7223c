/* SPDX-License-Identifier: MIT
 * Values of whole tapes; see field.h.
 */
#include "field/field.h"

#include <math.h>

#include "field/kernels/dispatch.h"
#include "scene/tree/numbers.h"

static double finite_or_zero(double value)
{
    return isfinite(value) ? value : 0;
}

csg_vec3 csg_field_center(csg_box bounds)
{
    csg_vec3 center = csg_box_is_empty(bounds) ? csg_vec3_make(0, 0, 0) : csg_box_center(bounds);
    return csg_vec3_make(finite_or_zero(center.x), finite_or_zero(center.y),
                         finite_or_zero(center.z));
}

csgm_field *csg_field_create(csgm_context *context)
{
    csgm_field *field = csg_memory_alloc(&context->memory, sizeof *field);
    if (field) {
        *field = (csgm_field){.context = context};
        csg_arena_init(&field->arena, &context->memory);
    }
    return field;
}

void csg_field_destroy(csgm_field *field)
{
    if (!field)
        return;
    csg_memory *memory = &field->context->memory;
    csg_field_release_parts(field);
    csg_arena_reset(&field->arena);
    csg_memory_release(memory, field, sizeof *field);
}

/* Primitives are distances; formulas may be steeper. */
void csg_field_count(const csgm_scene *scene, csgm_field *field)
{
    csg_numbers_count(scene, &field->primitive_count, &field->operator_count);
    field->tape.steepest = 1;
    for (size_t i = 0; i < scene->node_count; i++) {
        const csg_node *node = &scene->nodes[i];
        if (node->kind == CSG_NODE_FIELD)
            field->tape.steepest =
                fmaxf(field->tape.steepest, (float)scene->formulas[node->payload].lipschitz);
    }
}

uint32_t csg_tape_depth(const csg_tape *tape)
{
    uint32_t top = 0, most = 1;
    for (uint32_t i = 0; i < tape->count; i++) {
        const csg_tape_node *node = &tape->nodes[i];
        if (csg_op_is_leaf(node->op))
            top++;
        else if (csg_op_takes_all(node->op))
            top -= node->arity - 1;
        if (top > most)
            most = top;
        if (node->join)
            top--;
    }
    return most;
}

void csg_field_eval(const csgm_field *field, const float *x, const float *y, const float *z,
                    float *out, size_t count)
{
    enum { POINTS = 64 };
    const csg_kernel *kernel = csg_kernel_for(field->context->isa);
    csg_memory *memory = &field->context->memory;
    size_t scratch_floats = csg_kernel_scratch_floats(field->depth);
    float *scratch = csg_memory_alloc(memory, scratch_floats * sizeof(float));
    for (size_t i = 0; i < count; i += POINTS) {
        size_t n = count - i < POINTS ? count - i : POINTS;
        float px[POINTS] = {0}, py[POINTS] = {0}, pz[POINTS] = {0}, f[POINTS];
        for (size_t j = 0; j < n; j++) {
            px[j] = (float)((double)x[i + j] - field->center.x);
            py[j] = (float)((double)y[i + j] - field->center.y);
            pz[j] = (float)((double)z[i + j] - field->center.z);
        }
        if (scratch)
            kernel->values(&field->tape, px, py, pz, n, f, scratch, scratch_floats);
        for (size_t j = 0; j < n; j++)
            out[i + j] = scratch ? f[j] : NAN;
    }
    if (scratch)
        csg_memory_release(memory, scratch, scratch_floats * sizeof(float));
}
