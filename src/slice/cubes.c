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
    csg_memory_release(memory, c->planes, c->plane_capacity * sizeof *c->planes);
    csg_memory_release(memory, c->cubes, c->capacity * sizeof *c->cubes);
    csg_memory_release(memory, c->scratch, c->scratch_floats * sizeof *c->scratch);
}

/* ---- what is known of a cube -------------------------------------------------------------------
 */

/* How far chords may be from the piece's surface in a cube of this edge, and how thick what its
 * corners do not show. Both are less than the sheet is thick in which the surface runs. And where
 * all gradients are within s of one, of length g: along a chord, at whose ends the field is 0, it
 * changes at rates that differ by 2 s at most, so that it is s / 2 times the length at most; where
 * it is negative at all corners of a square, it is s / 2 times the edge at most on its sides, and
 * as much more between two of these. Where gradients turn by b per length at most the field leaves
 * a chord of length l by b l^2 / 8, and the sides of a square and a line between two of them by as
 * much of its edge each: a quarter of b times the edge's square. The distance to the surface is
 * that by g - s at most. */
static double strays_by(const csg_enclosure *e, double edge)
{
    double slope =
        sqrt(e->slope[0] * e->slope[0] + e->slope[1] * e->slope[1] + e->slope[2] * e->slope[2]);
    double sheet = (e->below + e->above) / slope;
    if (!(e->stray > 0 && e->stray < slope))
        return sheet;
    double rise = e->bend > 0 ? 0.25 * edge * edge * e->bend : edge * e->stray;
    return fmin(sheet, rise / (slope - e->stray));
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

/* Formulas of half spaces that hold in a cube, around a place in it. */
typedef struct known_planes {
    csg_halves halves;
    double middle[3];
    bool are_good; /* each piece is known to the tolerance, and no two face each other */
} known_planes;

static bool are_good(const csg_halves *h, double edge, double tolerance)
{
    for (int i = 0; i < h->plane_count; i++) {
        if (!(strays_by(&h->planes[i], edge) <= tolerance))
            return false;
        for (int k = 0; k < i; k++)
            if (face_each_other(&h->planes[i], &h->planes[k]))
                return false;
    }
    return true;
}

static void place_of_middle(const csg_slice_plan *plan, const place *p, double middle[3])
{
    for (int k = 0; k < 3; k++)
        middle[k] = (double)csg_slice_place(plan, k, p->at[k] + 0.5 * p->edge);
}

/* With what floats may be off. */
static double half_of(const csg_slice_plan *plan, const place *p)
{
    return 0.5 * p->edge * plan->step * (1 + 1e-6) + (double)plan->rounding / 16;
}

/* The slab's layers from *first to below *end run through the cube. */
static void layers_of(const csg_slice_cubes *c, const place *p, size_t *first, size_t *end)
{
    const csg_slice_plan *plan = c->plan;
    double from = plan->corner[2] + p->at[2] * plan->step;
    double to = plan->corner[2] + (p->at[2] + (double)p->edge) * plan->step;
    size_t low = csg_slice_layers_below(plan, from), high = csg_slice_layers_below(plan, to);
    *first = low > c->first_layer ? low : c->first_layer;
    *end = high < c->end_layer ? high : c->end_layer;
}

static bool has_layers(const csg_slice_cubes *c, const place *p)
{
    size_t first, end;
    layers_of(c, p, &first, &end);
    return first < end;
}

/* What planes say of a box in their cube, given by its middle and half edges; *open: how many of
 * them cut it. */
static csg_truth state_in_box(const known_planes *known, const double middle[3],
                              const double half[3], int *open)
{
    csg_truth planes[CSG_HALVES_MOST];
    *open = 0;
    for (int i = 0; i < known->halves.plane_count; i++) {
        const csg_enclosure *e = &known->halves.planes[i];
        double value = e->value, reach = 1e-12 * fabs(e->value);
        for (int k = 0; k < 3; k++) {
            value += e->slope[k] * (middle[k] - known->middle[k]);
            reach += half[k] * fabs(e->slope[k]);
        }
        planes[i] = value + e->above < -reach  ? CSG_TRUTH_NO
                    : value - e->below > reach ? CSG_TRUTH_YES
                                               : CSG_TRUTH_OPEN;
        *open += planes[i] == CSG_TRUTH_OPEN;
    }
    return csg_halves_evaluate(&known->halves, planes);
}

/* In a cube whose planes are good, or one within it. Only its layers count: a piece that ends
 * between two of them, such as the face of a box on its back, is in none. */
static csg_slice_kind look_by_planes(const csg_slice_cubes *c, const place *p,
                                     const known_planes *known)
{
    const csg_slice_plan *plan = c->plan;
    size_t first, end;
    double middle[3], half[3];
    csg_slice_kind kind = CSG_SLICE_EMPTY;
    place_of_middle(plan, p, middle);
    half[0] = half[1] = half_of(plan, p);
    half[2] = (double)plan->rounding / 16;
    layers_of(c, p, &first, &end);
    for (size_t i = first; i < end; i++) {
        int open;
        middle[2] = plan->z[i];
        if (state_in_box(known, middle, half, &open) != CSG_TRUTH_OPEN)
            continue;
        kind = CSG_SLICE_SMOOTH;
        if (open > 1)
            return p->edge == 1 ? CSG_SLICE_SHARP : CSG_SLICE_SPLIT;
    }
    return kind;
}

/* SPLIT: it takes smaller cubes to tell. */
static csg_slice_kind look_at(csg_slice_cubes *c, const place *p, const csg_tape *tape,
                              known_planes *known)
{
    const csg_slice_plan *plan = c->plan;
    csg_halves *halves = &known->halves;
    double half = half_of(plan, p);
    bool is_smallest = p->edge == 1;
    known->are_good = false;
    place_of_middle(plan, p, known->middle);
    csg_slice_kind open = is_smallest ? CSG_SLICE_UNSETTLED : CSG_SLICE_SPLIT;
    if (!csg_halves_find(plan->kernel, tape, known->middle, half, c->scratch, c->scratch_floats,
                         halves))
        return open;
    if (csg_halves_state(halves, half) != CSG_TRUTH_OPEN)
        return CSG_SLICE_EMPTY;
    known->are_good = are_good(halves, 2 * half, plan->tolerance);
    if (!known->are_good)
        return open;
    return halves->plane_count == 1 ? CSG_SLICE_SMOOTH : look_by_planes(c, p, known);
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

static bool keep_tape(csg_slice_cubes *c, const csg_tape *tape, uint32_t *index)
{
    if (!csg_memory_reserve(&c->plan->context->memory, (void **)&c->tapes, &c->tape_capacity,
                            c->tape_count + 1, sizeof *tape))
        return false;
    *index = (uint32_t)c->tape_count;
    c->tapes[c->tape_count++] = *tape;
    return true;
}

/* The plane of a smooth cube: corners that are far from it need no evaluation. */
static bool keep_plane(csg_slice_cubes *c, const known_planes *known, uint32_t *index)
{
    const csg_enclosure *e = &known->halves.planes[0];
    if (!csg_memory_reserve(&c->plan->context->memory, (void **)&c->planes, &c->plane_capacity,
                            c->plane_count + 1, sizeof *c->planes))
        return false;
    csg_slice_plane *plane = &c->planes[c->plane_count++];
    double longest = 1;
    plane->constant = e->value;
    for (int k = 0; k < 3; k++) {
        plane->constant -= e->slope[k] * known->middle[k];
        plane->slope[k] = (float)e->slope[k];
        longest = fmax(longest, fabs(e->slope[k]));
    }
    /* what floats leave out of slopes is in the rounding of lengths */
    plane->room = (float)((fmax(e->below, e->above) + longest * (double)c->plan->rounding) * 1.001);
    *index = (uint32_t)c->plane_count;
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

/* Eight more cubes, all empty so far. */
static bool add_octants(csg_slice_cubes *c, uint32_t parent)
{
    uint32_t first = (uint32_t)c->count;
    if (csg_mesh_should_stop(c->plan->watch) || c->count > UINT32_MAX - CSG_OCTANTS ||
        !csg_memory_reserve(&c->plan->context->memory, (void **)&c->cubes, &c->capacity,
                            c->count + CSG_OCTANTS, sizeof *c->cubes))
        return false;
    for (uint32_t o = 0; o < CSG_OCTANTS; o++)
        c->cubes[first + o] = (csg_slice_cube){.kind = CSG_SLICE_EMPTY};
    c->cubes[parent].first = first;
    c->count += CSG_OCTANTS;
    return true;
}

/* Where all pieces are known planes tell the rest, and tapes stay as they are. */
static bool divide_by_planes(csg_slice_cubes *c, uint32_t parent, const place *p,
                             const known_planes *known)
{
    if (!add_octants(c, parent))
        return false;
    uint32_t first = c->cubes[parent].first;
    for (uint32_t o = 0; o < CSG_OCTANTS; o++) {
        place child = octant_of(p, (int)o);
        if (is_beyond(c->plan, &child) || !has_layers(c, &child))
            continue;
        csg_slice_kind kind = look_by_planes(c, &child, known);
        c->cubes[first + o].kind = (uint8_t)kind;
        c->cubes[first + o].tape = c->cubes[parent].tape;
        if (kind == CSG_SLICE_SPLIT && !divide_by_planes(c, first + o, &child, known))
            return false;
    }
    return true;
}

static bool divide(csg_slice_cubes *c, uint32_t parent, const place *p)
{
    const csg_slice_plan *plan = c->plan;
    bool skip[CSG_OCTANTS];
    for (int o = 0; o < CSG_OCTANTS; o++) {
        place child = octant_of(p, o);
        skip[o] = is_beyond(plan, &child) || !has_layers(c, &child);
    }
    if (!add_octants(c, parent) || !find_octants(c, parent, p, skip))
        return false;
    uint32_t first = c->cubes[parent].first;
    for (uint32_t o = 0; o < CSG_OCTANTS; o++) {
        known_planes known = {.are_good = false};
        place child = octant_of(p, (int)o);
        csg_slice_cube *cube = &c->cubes[first + o];
        if (cube->kind == CSG_SLICE_EMPTY)
            continue;
        if (child.level + CSG_SLICE_LEVELS_ABOVE >= plan->slab_level)
            cube->kind = (uint8_t)look_at(c, &child, &c->tapes[cube->tape], &known);
        c->unsettled += cube->kind == CSG_SLICE_UNSETTLED;
        if (cube->kind == CSG_SLICE_SMOOTH && known.halves.plane_count == 1 &&
            !keep_plane(c, &known, &cube->first))
            return false;
        if (cube->kind == CSG_SLICE_SPLIT &&
            !(known.are_good ? divide_by_planes(c, first + o, &child, &known)
                             : divide(c, first + o, &child)))
            return false;
    }
    return true;
}

bool csg_slice_cubes_make(csg_slice_cubes *c, size_t first_layer, size_t end_layer)
{
    const csg_slice_plan *plan = c->plan;
    const place root = {.edge = 1u << plan->levels};
    csg_arena_reset(&c->arena);
    c->count = c->tape_count = c->plane_count = 0;
    c->unsettled = 0;
    c->first_layer = first_layer;
    c->end_layer = end_layer;
    if (!csg_memory_reserve(&plan->context->memory, (void **)&c->cubes, &c->capacity, 1,
                            sizeof *c->cubes))
        return false;
    c->cubes[c->count++] = (csg_slice_cube){.kind = CSG_SLICE_SPLIT};
    return keep_tape(c, &plan->field->tape, &c->cubes[0].tape) && divide(c, 0, &root);
}
