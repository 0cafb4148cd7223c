/* SPDX-License-Identifier: MIT
 * Bounds by the field's value; see field.h. With f = 0 on the surface and the Lipschitz constant
 * lambda, |f(p)| / lambda is at most the distance of p. From p a step is made along the gradient
 * until f changes its sign: the field is continuous, so the surface is not farther than the step. A
 * triangle is nowhere farther than its centre plus its radius; those with the largest bounds are
 * quartered while that helps and the evaluations last.
 */
#include "diff/field.h"

#include <string.h>

#include "base/pool.h"
#include "diff/distances.h"
#include "scene/reference.h"

enum { RUN = 256, STEPS_MOST = 8 };
/* Nodes evaluated in all: some seconds. */
static const uint64_t NODES_MOST = 150000000;

typedef struct patch {
    csg_vec3 corners[3]; /* of the scene */
    double upper;
} patch;

typedef struct probe {
    double value, upper; /* |f|; distance to a change of sign, or infinity */
    uint32_t evaluations;
} probe;

typedef struct field_work {
    csg_diff_pair *pair;
    const csgm_scene *scene;
    csg_diff_turn back; /* from the pair's space to the scene's */
    double lipschitz;
    patch *patches;
    size_t count;
    probe *probes;
    csg_diff_sampler sampler;
    double *values;
    csgm_diff_field *out;
} field_work;

static csg_vec3 to_scene(const field_work *w, csg_vec3 p)
{
    return csg_diff_turned(w->back, csg_triangle_frame_leave(&w->pair->frame, p));
}

static csg_vec3 from_scene(const field_work *w, csg_vec3 p)
{
    csg_diff_turn turn = w->back == CSG_DIFF_Y_UP_TO_Z_UP   ? CSG_DIFF_Z_UP_TO_Y_UP
                         : w->back == CSG_DIFF_Z_UP_TO_Y_UP ? CSG_DIFF_Y_UP_TO_Z_UP
                                                            : CSG_DIFF_AS_IT_IS;
    return csg_diff_turned(turn, p);
}

/* NaN when there is no memory. */
static csg_sample sample_at(const field_work *w, csg_vec3 p)
{
    csgm_status status = CSGM_OK;
    csg_sample s = csg_reference_eval(w->scene, p, &status);
    if (status != CSGM_OK)
        s.value = NAN;
    return s;
}

static probe probe_at(const field_work *w, csg_vec3 p)
{
    csg_sample s = sample_at(w, p);
    double slope = csg_vec3_norm(s.gradient);
    probe found = {fabs(s.value), s.value == 0 ? 0 : INFINITY, 1};
    if (!(slope > 0) || !(found.value > 0))
        return found;
    csg_vec3 along = csg_vec3_scale(s.gradient, (s.value >= 0 ? -1 : 1) / slope);
    double length = found.value / slope * (1 + 1e-9) + 1e-12 * csg_vec3_norm(p);
    for (int step = 0; step < STEPS_MOST; step++, length *= step < 3 ? 1.01 : 2) {
        double value = sample_at(w, csg_vec3_add(p, csg_vec3_scale(along, length))).value;
        found.evaluations++;
        if ((value >= 0) != (s.value >= 0) && !isnan(value)) {
            found.upper = length;
            break;
        }
    }
    return found;
}

/* ---- patches -------------------------------------------------------------------------------- */

static csg_vec3 center_of(const patch *t)
{
    return csg_vec3_scale(csg_vec3_add(t->corners[0], csg_vec3_add(t->corners[1], t->corners[2])),
                          1.0 / 3);
}

static bool probe_run(void *user, uint32_t worker, size_t index)
{
    (void)worker;
    field_work *w = user;
    size_t end = (index + 1) * RUN < w->count ? (index + 1) * RUN : w->count;
    for (size_t i = index * RUN; i < end; i++) {
        patch *t = &w->patches[i];
        csg_vec3 center = center_of(t);
        double radius = 0;
        for (int k = 0; k < 3; k++)
            radius = fmax(radius, csg_vec3_norm(csg_vec3_sub(t->corners[k], center)));
        w->probes[i] = probe_at(w, center);
        t->upper = fmin(t->upper, w->probes[i].upper + radius);
        if (isnan(w->probes[i].value))
            return false;
    }
    return !csg_diff_is_cancelled(w->pair);
}

static void take_value(field_work *w, double value, csg_vec3 at)
{
    if (value <= w->out->max_abs_field)
        return;
    w->out->max_abs_field = value;
    w->out->lower = value / w->lipschitz;
    w->out->at = from_scene(w, at);
}

static void report_probes(void *user, size_t done, size_t count)
{
    csg_diff_tell(((field_work *)user)->pair, done, count);
}

/* Probes all patches and keeps those whose bound is too wide, in their order; the bounds of the
 * others are in out->upper. */
static csgm_status probe_patches(field_work *w)
{
    csg_memory *memory = &w->pair->context->memory;
    size_t size = w->count * sizeof *w->probes, kept = 0;
    w->probes = csg_memory_alloc(memory, size);
    if (!w->probes)
        return csg_context_no_memory(w->pair->context);
    csg_diff_take(w->pair, 0.3);
    if (!csg_pool_run(w->pair->context->pool, (w->count + RUN - 1) / RUN, probe_run, report_probes,
                      w)) {
        csg_memory_release(memory, w->probes, size);
        return csg_diff_is_cancelled(w->pair) ? CSGM_CANCELLED
                                              : csg_context_no_memory(w->pair->context);
    }
    for (size_t i = 0; i < w->count; i++) {
        take_value(w, w->probes[i].value, center_of(&w->patches[i]));
        w->out->evaluations += w->probes[i].evaluations;
    }
    double target = fmax(1.01 * w->out->lower, w->pair->precision * w->pair->frame.unscale);
    for (size_t i = 0; i < w->count; i++) {
        if (w->patches[i].upper > target)
            w->patches[kept++] = w->patches[i];
        else
            w->out->upper = fmax(w->out->upper, w->patches[i].upper);
    }
    w->count = kept;
    csg_memory_release(memory, w->probes, size);
    return CSGM_OK;
}

/* Each into four by the middles of its sides. False: out of memory. */
static bool quarter(field_work *w, patch **next)
{
    *next = csg_memory_alloc(&w->pair->context->memory, 4 * w->count * sizeof **next);
    for (size_t i = 0; i < w->count && *next; i++) {
        const patch *t = &w->patches[i];
        csg_vec3 middle[3];
        for (int k = 0; k < 3; k++)
            middle[k] = csg_vec3_scale(csg_vec3_add(t->corners[k], t->corners[(k + 1) % 3]), 0.5);
        for (int k = 0; k < 3; k++)
            (*next)[4 * i + (size_t)k] =
                (patch){{t->corners[k], middle[k], middle[(k + 2) % 3]}, t->upper};
        (*next)[4 * i + 3] = (patch){{middle[0], middle[1], middle[2]}, t->upper};
    }
    return *next != NULL;
}

static csgm_status refine_patches(field_work *w, uint64_t budget)
{
    csg_memory *memory = &w->pair->context->memory;
    size_t room = w->count;
    csgm_status status = probe_patches(w);
    while (status == CSGM_OK && w->count && w->out->evaluations + 12 * w->count <= budget) {
        patch *next;
        if (!quarter(w, &next)) {
            status = csg_context_no_memory(w->pair->context);
            break;
        }
        csg_memory_release(memory, w->patches, room * sizeof *w->patches);
        w->patches = next;
        room = w->count *= 4;
        status = probe_patches(w);
    }
    for (size_t i = 0; i < w->count; i++)
        w->out->upper = fmax(w->out->upper, w->patches[i].upper);
    csg_memory_release(memory, w->patches, room * sizeof *w->patches);
    return status;
}

static csgm_status bound_triangles(field_work *w, int from, uint64_t budget)
{
    const csg_diff_side *side = &w->pair->sides[from];
    w->count = side->chain.count;
    w->patches = csg_memory_alloc(&w->pair->context->memory, w->count * sizeof *w->patches);
    if (!w->patches)
        return csg_context_no_memory(w->pair->context);
    for (size_t t = 0; t < w->count; t++) {
        w->patches[t].upper = INFINITY;
        for (int k = 0; k < 3; k++)
            w->patches[t].corners[k] = to_scene(w, csg_diff_corner(side, t, k));
    }
    return refine_patches(w, budget);
}

/* ---- samples -------------------------------------------------------------------------------- */

static bool value_run(void *user, uint32_t worker, size_t index)
{
    (void)worker;
    field_work *w = user;
    uint64_t begin = (uint64_t)index * RUN;
    uint64_t end = begin + RUN < w->sampler.count ? begin + RUN : w->sampler.count;
    size_t triangle = csg_diff_sampler_find(&w->sampler, begin);
    for (uint64_t i = begin; i < end; i++) {
        csg_diff_sample s = csg_diff_sampler_get(&w->sampler, i, triangle);
        triangle = s.triangle;
        w->values[i] = fabs(sample_at(w, to_scene(w, s.at)).value);
        if (isnan(w->values[i]))
            return false;
    }
    return !csg_diff_is_cancelled(w->pair);
}

static csgm_status average_samples(field_work *w, int from, uint64_t count)
{
    csg_memory *memory = &w->pair->context->memory;
    csg_diff_side *side = &w->pair->sides[from];
    csg_arena_mark mark = csg_arena_get_mark(&side->arena);
    csgm_status status = CSGM_OK;
    size_t size = (size_t)count * sizeof *w->values;
    w->values = csg_memory_alloc(memory, size);
    if (!w->values || !csg_diff_sampler_make(&w->sampler, side, count))
        status = csg_context_no_memory(w->pair->context);
    if (status == CSGM_OK) {
        csg_diff_take(w->pair, 0.3);
        if (!csg_pool_run(w->pair->context->pool, (size_t)((count + RUN - 1) / RUN), value_run,
                          report_probes, w))
            status = csg_diff_is_cancelled(w->pair) ? CSGM_CANCELLED
                                                    : csg_context_no_memory(w->pair->context);
    }
    double sum = 0;
    for (uint64_t i = 0; i < count && status == CSGM_OK; i++) {
        sum += w->values[i];
        if (w->values[i] > w->out->max_abs_field) {
            size_t hint = csg_diff_sampler_find(&w->sampler, i);
            take_value(w, w->values[i], to_scene(w, csg_diff_sampler_get(&w->sampler, i, hint).at));
        }
    }
    w->out->mean_abs_field = sum / (double)count;
    w->out->evaluations += count;
    csg_memory_release(memory, w->values, size);
    csg_arena_release_to(&side->arena, mark);
    return status;
}

csgm_status csg_diff_measure_field(csg_diff_pair *pair, int from, const csgm_scene *scene,
                                   uint64_t samples, csgm_diff_field *out)
{
    static const csg_diff_turn backwards[3] = {CSG_DIFF_AS_IT_IS, CSG_DIFF_Z_UP_TO_Y_UP,
                                               CSG_DIFF_Y_UP_TO_Z_UP};
    uint64_t budget = NODES_MOST / (scene->node_count + 1) + 4096;
    *out = (csgm_diff_field){.is_measured = true, .lipschitz = csg_scene_lipschitz(scene)};
    field_work w = {.pair = pair,
                    .scene = scene,
                    .back = backwards[pair->sides[1 - from].turn],
                    .lipschitz = out->lipschitz,
                    .out = out};
    uint64_t count = samples < budget / 4 ? samples : budget / 4;
    csgm_status status = average_samples(&w, from, count);
    if (status != CSGM_OK)
        return status;
    if (pair->sides[from].chain.count <= budget / 4)
        return bound_triangles(&w, from, budget);
    out->upper = INFINITY;
    return CSGM_OK;
}
