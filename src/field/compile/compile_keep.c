/* SPDX-License-Identifier: MIT
 * What a compiler has written, copied into the field's arena.
 */
#include <string.h>

#include "field/compile/compile_private.h"

static void *keep(csg_arena *arena, const void *data, size_t bytes)
{
    void *copy = csg_arena_alloc(arena, bytes);
    if (copy && bytes)
        memcpy(copy, data, bytes);
    return copy;
}

static bool keep_tape(const csg_compiler *c)
{
    csgm_field *field = c->field;
    field->tape.nodes = keep(&field->arena, c->nodes, c->node_count * sizeof *c->nodes);
    field->tape.parameters =
        keep(&field->arena, c->parameters, c->parameter_count * sizeof *c->parameters);
    field->tape.colors = keep(&field->arena, c->colors, c->color_count * sizeof *c->colors);
    field->tape.count = (uint32_t)c->node_count;
    field->parameter_count = c->parameter_count;
    field->color_count = (uint32_t)c->color_count;
    if (!field->tape.nodes || !field->tape.parameters || !field->tape.colors)
        return false;
    field->depth = csg_tape_depth(&field->tape);
    return true;
}

static bool keep_formulas(const csg_compiler *c)
{
    csgm_field *field = c->field;
    field->tape.steps = keep(&field->arena, c->steps, c->step_count * sizeof *c->steps);
    field->tape.formulas = keep(&field->arena, c->formulas, c->formula_count * sizeof *c->formulas);
    field->tape.warps = keep(&field->arena, c->warps, c->warp_count * sizeof *c->warps);
    field->tape.shapes = c->scene->shape_count ? c->scene->shapes : NULL; /* NULL: none */
    if (field->has_materials) {
        field->materials = keep(&field->arena, c->materials, c->color_count * sizeof *c->materials);
        if (!field->materials)
            return false;
    }
    return field->tape.steps && field->tape.formulas && field->tape.warps;
}

bool csg_compile_keep(const csg_compiler *c)
{
    return keep_formulas(c) && keep_tape(c);
}
