/* SPDX-License-Identifier: MIT
 * Triply periodic surfaces by their nodal approximations: gyroid, schwarz_p, diamond. With
 * X = 360 x / cell, ...
 *   gyroid     sin X cos Y + sin Y cos Z + sin Z cos X
 *   schwarz_p  cos X + cos Y + cos Z
 *   diamond    cos X cos Y cos Z - sin X sin Y sin Z
 * F is scaled by its mean slope on the surface, so that a wall is about as thick as it says. Its
 * largest slope, by which the Lipschitz constant is stated, is sqrt(3) for the first two and
 * sqrt(3/2) for the third, in units of 2 pi / cell.
 */
#include <math.h>

#include "base/elementary.h"
#include "scene/formula/formula.h"
#include "solid/operations.h"

typedef struct writer { /* of a formula */
    csg_formula_builder builder;
    csg_formula_id sines[3], cosines[3];
} writer;

static csg_formula_id apply(writer *w, csg_formula_op op, csg_formula_id a, csg_formula_id b)
{
    return a == CSG_FORMULA_NONE || b == CSG_FORMULA_NONE
               ? CSG_FORMULA_NONE
               : csg_formula_apply(&w->builder, op, a, b);
}

static void write_waves(writer *w, double cell)
{
    csg_formula_id turn = csg_formula_constant(&w->builder, 360 / cell);
    for (uint32_t axis = 0; axis < 3; axis++) {
        csg_formula_id at = csg_formula_apply(&w->builder, CSG_FORMULA_X + axis, 0, 0);
        at = apply(w, CSG_FORMULA_MUL, at, turn);
        w->sines[axis] = apply(w, CSG_FORMULA_SIN, at, 0);
        w->cosines[axis] = apply(w, CSG_FORMULA_COS, at, 0);
    }
}

static csg_formula_id gyroid(writer *w)
{
    csg_formula_id sum = csg_formula_constant(&w->builder, 0);
    for (int axis = 0; axis < 3; axis++)
        sum = apply(w, CSG_FORMULA_ADD, sum,
                    apply(w, CSG_FORMULA_MUL, w->sines[axis], w->cosines[(axis + 1) % 3]));
    return sum;
}

static csg_formula_id schwarz_p(writer *w)
{
    csg_formula_id sum = apply(w, CSG_FORMULA_ADD, w->cosines[0], w->cosines[1]);
    return apply(w, CSG_FORMULA_ADD, sum, w->cosines[2]);
}

static csg_formula_id diamond(writer *w)
{
    csg_formula_id c = apply(w, CSG_FORMULA_MUL, w->cosines[0], w->cosines[1]);
    csg_formula_id s = apply(w, CSG_FORMULA_MUL, w->sines[0], w->sines[1]);
    return apply(w, CSG_FORMULA_SUB, apply(w, CSG_FORMULA_MUL, c, w->cosines[2]),
                 apply(w, CSG_FORMULA_MUL, s, w->sines[2]));
}

/* thickness / 2 - |F| / slope, or F / slope on one side of the surface. */
static csg_formula_id solid(writer *w, csg_formula_id f, double slope, double thickness)
{
    csg_formula_id scaled =
        apply(w, CSG_FORMULA_MUL, f, csg_formula_constant(&w->builder, 1 / slope));
    if (thickness == 0)
        return scaled;
    return apply(w, CSG_FORMULA_SUB, csg_formula_constant(&w->builder, thickness / 2),
                 apply(w, CSG_FORMULA_ABS, scaled, 0));
}

static csg_node_id build_field(csg_solid_job *job, writer *w, csg_formula_id f, double lipschitz)
{
    size_t bytes = w->builder.count * sizeof(csg_formula_step);
    csg_formula_step *steps = f == CSG_FORMULA_NONE ? NULL : csg_memory_alloc(job->memory, bytes);
    uint32_t count = steps ? csg_formula_collect(&w->builder, f, steps) : 0;
    csg_node_id node = CSG_NODE_NONE;
    const csg_field_domain everywhere = {csg_box_all(), false, lipschitz, true};
    if (count)
        node = csg_solid_done(job,
                              csg_build_field(job->builder, steps, count, &everywhere, job->where));
    else
        csg_solid_no_memory(job);
    csg_memory_release(job->memory, steps, bytes);
    return node;
}

csg_node_id csg_solid_periodic(csg_solid_job *job, csg_periodic_kind kind, double cell,
                               double thickness)
{
    /* mean and largest slope of F along one radian; the means by sampling the surfaces */
    double mean = kind == CSG_PERIODIC_GYROID      ? 1.533
                  : kind == CSG_PERIODIC_SCHWARZ_P ? 1.341
                                                   : 1.059;
    double most = sqrt(kind == CSG_PERIODIC_DIAMOND ? 1.5 : 3), wave = 2 * csg_acos(-1) / cell;
    writer w;
    csg_formula_begin(&w.builder, job->memory);
    write_waves(&w, cell);
    csg_formula_id f = kind == CSG_PERIODIC_GYROID      ? gyroid(&w)
                       : kind == CSG_PERIODIC_SCHWARZ_P ? schwarz_p(&w)
                                                        : diamond(&w);
    f = f == CSG_FORMULA_NONE ? f : solid(&w, f, mean * wave, thickness);
    csg_node_id node = build_field(job, &w, f, most / mean);
    csg_formula_end(&w.builder);
    return node;
}
