/* SPDX-License-Identifier: MIT
 * The octree of a slab; see cubes.h.
 */
#include "slice/cubes.h"

#include <float.h>
#include <math.h>

#include "measure/halves.h"

/* A cube of the lattice: its least corner and edge in steps. */
typedef struct place {
    uint32_t at[3], edge;
    int level;
} place;

bool csg_slice_cubes_init(csg_slice_cubes *c, const csg_slice_plan *plan)
{
    csg_memory *memory = &plan->context->memory;
    *c = (csg_slice_cubes){.plan = plan,
                           .scratch_floats = csg_kernel_scratch_floats(plan->field->depth)};
    csg_pruner_init(&c->pruner, memory, plan->kernel, plan->rounding);
    csg_arena_init(&c->arena, memory);
    c->scratch = csg_memory_alloc(memory, c->scratch_floats * sizeof *c->scratch);
    return c->scratch;
}

void csg_slice_cubes_release(csg_slice_cubes *c)
{
    csg_memory *memory = &c->plan->context->memory;
    csg_pruner_release(&c->pruner);
    csg_arena_reset(&c->arena);
    csg_memory_release(memory, c->tapes, c->tape_capacity * sizeof *c->tapes);
    csg_memory_release(memory, c->cubes, c->capacity * sizeof *c->cubes);
    csg_memory_release(memory, c->scratch, c->scratch_floats * sizeof *c->scratch);
}

/* ---- what is known of a cube -------------------------------------------------------------------
 */

/* How thick the sheet is in which the piece's surface runs. */
static double thickness(const csg_enclosure *e)
{
    double slope =
        sqrt(e->slope[0] * e->slope[0] + e->slope[1] * e->slope[1] + e->slope[2] * e->slope[2]);
    return (e->below + e->above) / slope;
}

/* Two pieces that face each other may be the two sides of something thin. */
static bool face_each_other(const csg_enclosure *a, const csg_enclosure *b)
{
    static const double FACING = -0.9; /* the cosine between their normals */
    double both = 0, aa = 0, bb = 0;
    for (int k = 0; k < 3; k++) {
        both += a->slope[k] * b->slope[k];
        aa += a->slope[k] * a->slope[k];
        bb += b->slope[k] * b->slope[k];
    }
    return !(both > FACING * sqrt(aa * bb));
}

/* SPLIT: it takes smaller cubes to tell. */
static csg_slice_kind look_at(csg_slice_cubes *c, const place *p, const csg_tape *tape)
{
    const csg_slice_plan *plan = c->plan;
    csg_halves halves;
    double middle[3], half = 0.5 * p->edge * plan->step * (1 + 1e-6) + (double)plan->rounding / 16;
    bool is_smallest = p->edge == 1;
    for (int k = 0; k < 3; k++)
        middle[k] = (double)csg_slice_place(plan, k, p->at[k] + 0.5 * p->edge);
    csg_slice_kind open = is_smallest ? CSG_SLICE_UNSETTLED : CSG_SLICE_SPLIT;
    if (!csg_halves_find(plan->kernel, tape, middle, half, c->scratch, c->scratch_floats, &halves))
        return open;
    if (csg_halves_state(&halves, half) != CSG_TRUTH_OPEN)
        return CSG_SLICE_EMPTY;
    for (int i = 0; i < halves.plane_count; i++)
        if (!(thickness(&halves.planes[i]) <= plan->tolerance))
            return open;
    if (halves.plane_count == 1)
        return CSG_SLICE_SMOOTH;
    for (int i = 0; i < halves.plane_count; i++)
        for (int k = 0; k < i; k++)
            if (face_each_other(&halves.planes[i], &halves.planes[k]))
                return open;
    return is_smallest ? CSG_SLICE_SHARP : CSG_SLICE_SPLIT;
}

/* ---- the tree ----------------------------------------------------------------------------------
 */

static bool is_beyond(const csg_slice_plan *plan, const place *p)
{
    const double low[3] = {plan->bounds.min.x, plan->bounds.min.y, plan->bounds.min.z};
    const double high[3] = {plan->bounds.max.x, plan->bounds.max.y, plan->bounds.max.z};
    for (int k = 0; k < 3; k++) {
        double from = plan->corner[k] + p->at[k] * plan->step;
        if (from > high[k] || from + p->edge * plan->step < low[k])
            return true;
    }
    return false;
}

static bool has_layers(const csg_slice_plan *plan, const place *p)
{
    double from = plan->corner[2] + p->at[2] * plan->step;
    double to = plan->corner[2] + (p->at[2] + (double)p->edge) * plan->step;
    return csg_slice_layers_below(plan, from) < csg_slice_layers_below(plan, to);
}

static bool keep_tape(csg_slice_cubes *c, const csg_tape *tape, uint32_t *index)
{
    if (!csg_memory_reserve(&c->plan->context->memory, (void **)&c->tapes, &c->tape_capacity,
                            c->tape_count + 1, sizeof *tape))
        return false;
    *index = (uint32_t)c->tape_count;
    c->tapes[c->tape_count++] = *tape;
    return true;
}

/* The place of a child. */
static place octant_of(const place *p, int o)
{
    uint32_t half = p->edge / 2;
    place child = {.edge = half, .level = p->level + 1};
    for (int k = 0; k < 3; k++)
        child.at[k] = p->at[k] + (o >> k & 1 ? half : 0);
    return child;
}

/* Tapes of the octants that matter: all are found before one is divided, since the pruner knows the
 * last cubes alone. */
static bool find_octants(csg_slice_cubes *c, uint32_t parent, const place *p, const bool skip[8])
{
    const csg_slice_plan *plan = c->plan;
    float at[3][CSG_OCTANTS];
    double edge = 0.5 * p->edge * plan->step;
    csg_tape of = c->tapes[c->cubes[parent].tape];
    for (int o = 0; o < CSG_OCTANTS; o++) {
        place child = octant_of(p, o);
        for (int k = 0; k < 3; k++)
            at[k][o] = csg_slice_place(plan, k, child.at[k] + 0.5 * child.edge);
    }
    float radius = (float)(0.5 * edge * sqrt(3.0) * (1 + 4 * (double)FLT_EPSILON));
    float tau = (float)(edge * fmax(1, (double)plan->field->tape.lipschitz)) + plan->rounding;
    if (!csg_prune_octants(&c->pruner, &of, at[0], at[1], at[2], radius))
        return false;
    for (int o = 0; o < CSG_OCTANTS; o++) {
        csg_slice_cube *cube = &c->cubes[c->cubes[parent].first + (uint32_t)o];
        csg_tape tape;
        *cube = (csg_slice_cube){.kind = CSG_SLICE_EMPTY};
        if (skip[o] || csg_prune_state(&c->pruner, o) != CSG_CELL_SURFACE)
            continue;
        if (!csg_prune_shorten(&c->pruner, o, tau, &c->arena, &tape))
            return false;
        cube->kind = CSG_SLICE_SPLIT;
        cube->tape = c->cubes[parent].tape;
        if (tape.nodes != of.nodes && !keep_tape(c, &tape, &cube->tape))
            return false;
    }
    return true;
}

static bool divide(csg_slice_cubes *c, uint32_t parent, const place *p, uint32_t slab)
{
    const csg_slice_plan *plan = c->plan;
    bool skip[CSG_OCTANTS];
    uint32_t first = (uint32_t)c->count;
    if (csg_mesh_should_stop(plan->watch) || c->count > UINT32_MAX - CSG_OCTANTS)
        return false;
    if (!csg_memory_reserve(&plan->context->memory, (void **)&c->cubes, &c->capacity,
                            c->count + CSG_OCTANTS, sizeof *c->cubes))
        return false;
    c->cubes[parent].first = first;
    c->count += CSG_OCTANTS;
    for (int o = 0; o < CSG_OCTANTS; o++) {
        place child = octant_of(p, o);
        bool is_other = child.level <= plan->slab_level &&
                        child.at[2] / child.edge != slab >> (plan->slab_level - child.level);
        skip[o] = is_other || is_beyond(plan, &child) || !has_layers(plan, &child);
    }
    if (!find_octants(c, parent, p, skip))
        return false;
    for (uint32_t o = 0; o < CSG_OCTANTS; o++) {
        place child = octant_of(p, (int)o);
        csg_slice_cube *cube = &c->cubes[first + o];
        if (cube->kind == CSG_SLICE_EMPTY)
            continue;
        if (child.level >= plan->slab_level)
            cube->kind = (uint8_t)look_at(c, &child, &c->tapes[cube->tape]);
        c->unsettled += cube->kind == CSG_SLICE_UNSETTLED;
        if (cube->kind == CSG_SLICE_SPLIT && !divide(c, first + o, &child, slab))
            return false;
    }
    return true;
}

bool csg_slice_cubes_make(csg_slice_cubes *c, uint32_t slab)
{
    const csg_slice_plan *plan = c->plan;
    const place root = {.edge = 1u << plan->levels};
    csg_arena_reset(&c->arena);
    c->count = c->tape_count = 0;
    c->unsettled = 0;
    if (!csg_memory_reserve(&plan->context->memory, (void **)&c->cubes, &c->capacity, 1,
                            sizeof *c->cubes))
        return false;
    c->cubes[c->count++] = (csg_slice_cube){.kind = CSG_SLICE_SPLIT};
    return keep_tape(c, &plan->field->tape, &c->cubes[0].tape) && divide(c, 0, &root, slab);
}
