/* SPDX-License-Identifier: MIT
 * Cubes; see walk.h.
 */
#include "measure/walk.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/pool.h"
#include "field/field.h"
#include "field/kernels/dispatch.h"
#include "mesh/distance/slopes.h"

enum { FRONTIER = 512, FRONTIER_LEVELS = 6 };

/* No smaller, with 8 bits. */
static double rounded_up(double half)
{
    int exponent;
    double mantissa = frexp(half, &exponent);
    return ldexp(ceil(mantissa * 256) / 256, exponent);
}

static double largest_coordinate(csg_box box)
{
    return fmax(
        fmax(fmax(fabs(box.min.x), fabs(box.max.x)), fmax(fabs(box.min.y), fabs(box.max.y))),
        fmax(fabs(box.min.z), fabs(box.max.z)));
}

static bool begin_workers(csg_measure_walk *w, float rounding)
{
    csg_memory *memory = &w->context->memory;
    w->worker_count = csg_pool_threads(w->context->pool);
    w->workers = csg_memory_alloc(memory, w->worker_count * sizeof *w->workers);
    if (!w->workers)
        return false;
    bool done = true;
    for (uint32_t i = 0; i < w->worker_count; i++) {
        csg_measure_worker *s = &w->workers[i];
        csg_pruner_init(&s->pruner, memory, w->kernel, rounding);
        csg_arena_init(&s->arena, memory);
        s->scratch = csg_memory_alloc(memory, w->scratch_floats * sizeof *s->scratch);
        done = done && s->scratch;
    }
    return done;
}

static bool is_beyond(csg_box b, const csg_measure_cube *q)
{
    return q->c[0] - q->half > b.max.x || q->c[0] + q->half < b.min.x ||
           q->c[1] - q->half > b.max.y || q->c[1] + q->half < b.min.y ||
           q->c[2] - q->half > b.max.z || q->c[2] + q->half < b.min.z;
}

bool csg_measure_divide(const csg_measure_walk *w, csg_measure_worker *s,
                        const csg_measure_cube *parent, csg_arena *arena,
                        csg_measure_cube children[CSG_OCTANTS])
{
    float c[3][CSG_OCTANTS];
    double half = parent->half / 2;
    for (int o = 0; o < CSG_OCTANTS; o++)
        for (int axis = 0; axis < 3; axis++) {
            children[o].c[axis] = parent->c[axis] + (o >> axis & 1 ? half : -half);
            c[axis][o] = (float)children[o].c[axis];
        }
    if (!csg_prune_octants(&s->pruner, &parent->tape, c[0], c[1], c[2], csg_measure_radius(half)))
        return false;
    for (int o = 0; o < CSG_OCTANTS; o++) {
        csg_measure_cube *child = &children[o];
        child->half = half;
        child->level = parent->level + 1;
        child->state = csg_prune_state(&s->pruner, o);
        if (child->state == CSG_CELL_SURFACE && is_beyond(w->bounds, child))
            child->state = CSG_CELL_OUTSIDE;
        if (child->state == CSG_CELL_SURFACE &&
            !csg_prune_shorten(&s->pruner, o, w->tau, arena, &child->tape))
            return false;
    }
    return true;
}

void csg_measure_take_state(csg_measure_cube *q, const csg_halves *halves)
{
    csg_truth state = csg_halves_state(halves, q->half);
    if (state != CSG_TRUTH_OPEN)
        q->state = state == CSG_TRUTH_YES ? CSG_CELL_INSIDE : CSG_CELL_OUTSIDE;
}

bool csg_measure_enclose(const csg_measure_walk *w, csg_measure_worker *s, csg_measure_cube *q,
                         csg_halves *out)
{
    bool known =
        csg_halves_find(w->kernel, &q->tape, q->c, q->half, s->scratch, w->scratch_floats, out);
    if (known)
        csg_measure_take_state(q, out);
    return known;
}

bool csg_measure_enclose_with_strays(const csg_measure_walk *w, csg_measure_worker *s,
                                     csg_measure_cube *q, csg_halves *out)
{
    bool known = csg_halves_find_with_strays(w->kernel, &q->tape, q->c, q->half, s->scratch,
                                             w->scratch_floats, out);
    if (known)
        csg_measure_take_state(q, out);
    return known;
}

static bool keep(csg_measure_walk *w, const csg_measure_cube *cube)
{
    if (!csg_memory_reserve(&w->context->memory, (void **)&w->cubes, &w->capacity, w->count + 1,
                            sizeof *cube))
        return false;
    w->cubes[w->count++] = *cube;
    return true;
}

/* The octants of one cube of the frontier take its place. */
static bool split(csg_measure_walk *w, const csg_measure_cube *parent)
{
    csg_measure_cube children[CSG_OCTANTS];
    if (!csg_measure_divide(w, &w->workers[0], parent, &w->tapes, children))
        return false;
    for (int o = 0; o < CSG_OCTANTS; o++)
        if (children[o].state != CSG_CELL_OUTSIDE && !keep(w, &children[o]))
            return false;
    return true;
}

csg_measure_cube csg_measure_root(const csg_measure_walk *w)
{
    return (csg_measure_cube){.half = w->half, .state = CSG_CELL_SURFACE, .tape = w->tape};
}

/* Level by level, on one thread: there are few of them. */
static csgm_status find_frontier(csg_measure_walk *w)
{
    size_t first = 0, surfaces = 1;
    csg_measure_cube root = csg_measure_root(w);
    bool done = keep(w, &root);
    for (int level = 0; done && level < FRONTIER_LEVELS && surfaces && surfaces < FRONTIER;
         level++) {
        size_t end = w->count, kept = 0;
        surfaces = 0;
        for (size_t i = first; i < end && done; i++) {
            csg_measure_cube cube = w->cubes[i];
            if (csg_mesh_should_stop(w->watch))
                return csg_mesh_why_stopped(w->watch);
            done = cube.state == CSG_CELL_INSIDE ? keep(w, &cube) : split(w, &cube);
        }
        for (size_t i = end; i < w->count; i++, kept++) {
            w->cubes[kept] = w->cubes[i];
            surfaces += w->cubes[kept].state == CSG_CELL_SURFACE;
        }
        w->count = kept;
    }
    return done ? CSGM_OK : csg_context_no_memory(w->context);
}

bool csg_measure_walk_open(csg_measure_walk *w, csgm_context *context, const csgm_field *field,
                           csg_mesh_watch *watch)
{
    *w = (csg_measure_walk){.context = context,
                            .field = field,
                            .tape = field->tape,
                            .watch = watch,
                            .kernel = csg_kernel_for(context->isa),
                            .axis = CSG_AXIS_NONE,
                            .scratch_floats = csg_kernel_scratch_floats(field->depth)};
    csg_arena_init(&w->tapes, &context->memory);
    w->bounds = (csg_box){csg_vec3_sub(field->bounds.min, field->center),
                          csg_vec3_sub(field->bounds.max, field->center)};
    double extent = largest_coordinate(w->bounds);
    w->bounds = csg_box_grow(w->bounds, 1e-12 * (extent + csg_vec3_norm(field->center)));
    w->half = rounded_up(largest_coordinate(w->bounds));
    double rounding = 32 * (double)FLT_EPSILON * w->half * sqrt(3.0);
    w->tau = (float)(4 * rounding * fmax(1, (double)field->tape.lipschitz));
    return begin_workers(w, (float)rounding);
}

/* Numbers that are no floats are the scene's. */
static bool find_exact(csg_measure_walk *w)
{
    w->tape.exact = &w->exact;
    return csg_field_exact(w->context, w->field, &w->tapes, &w->exact);
}

csgm_status csg_measure_walk_begin(csg_measure_walk *w, csgm_context *context,
                                   const csgm_field *field, csg_mesh_watch *watch)
{
    bool done = csg_measure_walk_open(w, context, field, watch) && find_exact(w) &&
                csg_axis_find(&w->tape, field->parameter_count, &w->exact, &w->tapes, &w->axis) &&
                csg_symmetries_find(&w->tape, field->parameter_count, &w->tapes, &w->symmetries);
    return done ? find_frontier(w) : csg_context_no_memory(context);
}

void csg_measure_walk_release(csg_measure_walk *w)
{
    csg_memory *memory = &w->context->memory;
    for (uint32_t i = 0; w->workers && i < w->worker_count; i++) {
        csg_pruner_release(&w->workers[i].pruner);
        csg_arena_reset(&w->workers[i].arena);
        csg_memory_release(memory, w->workers[i].scratch,
                           w->scratch_floats * sizeof *w->workers[i].scratch);
    }
    csg_memory_release(memory, w->workers, w->worker_count * sizeof *w->workers);
    csg_memory_release(memory, w->cubes, w->capacity * sizeof *w->cubes);
    csg_arena_reset(&w->tapes);
}
