/* SPDX-License-Identifier: MIT
 * Rounding without a collapse; see rounding.h.
 *
 * All vertices are rounded; those at one place of the mesh count as one, its first. Suspects are
 * vertices that share their new place with others, and corners of triangles that have lost their
 * area. In the order of their numbers, several times over, each suspect with something wrong about
 * it takes, of the places two steps around where it lay, that with the least wrong, if that is less
 * than where it is: so it ends well. Of several such places it is one that turns few triangles
 * over, then the nearest. All is decided on one thread and by the mesh alone, so files do not
 * depend on the number of threads.
 */
#include "io/rounding.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/mesh_codes.h"
#include "base/places.h"
#include "base/trace.h"
#include "io/writers.h"
#include "mesh/weld.h"

enum {
    REACH = 2,
    WAYS = 2 * REACH + 1,
    CANDIDATES = WAYS * WAYS * WAYS,
    ROUNDS = 8,
    LEAST_STEPS = 64, /* of floats along the longest side of a mesh whose places are not floats */
    MANY = 100,       /* one vertex in so many moved is worth a warning */
    MOST_AT_A_PLACE = 64 /* more than find other places around it in practice */
};

typedef struct rounder {
    csgm_context *context;
    const csgm_mesh_view *mesh;
    const csg_rounding *rounding;
    uint32_t *first;    /* per vertex: the first one at its place */
    csg_vec3 *places;   /* per first vertex: where the file has it */
    csg_table table;    /* of places; entries that have moved on are found by nobody */
    size_t table_count; /* numbers in it, with those */
    uint8_t *suspect;   /* per vertex */
    uint64_t *begin;    /* vertex_count + 1: each one's stretch of triangles */
    uint64_t *around;   /* 3 * triangle_count, which may be more than 32 bits can count */
    uint64_t moved;
} rounder;

/* ---- rounding ----------------------------------------------------------------------------- */

static float as_told(float value)
{
    char text[64];
    snprintf(text, sizeof text, "%f", (double)value);
    return strtof(text, NULL);
}

csg_rounding csg_rounding_of_draco(const csgm_mesh_view *mesh, uint32_t bits, bool is_told)
{
    csg_rounding grid = {
        .kind = CSG_ROUND_GRID, .most = (uint32_t)((1u << bits) - 1), .is_told = is_told};
    float high[3] = {0, 0, 0};
    for (uint64_t i = 0; i < 3 * mesh->vertex_count; i++) {
        float value = mesh->positions[i];
        grid.low[i % 3] = i < 3 ? value : fminf(grid.low[i % 3], value);
        high[i % 3] = i < 3 ? value : fmaxf(high[i % 3], value);
    }
    for (int k = 0; k < 3; k++)
        grid.range = fmaxf(grid.range, high[k] - grid.low[k]);
    for (int k = 0; k < 3 && is_told; k++)
        grid.low[k] = as_told(grid.low[k]);
    if (is_told)
        grid.range = as_told(grid.range);
    return grid;
}

static float number_of(const csg_rounding *grid, int axis, float value)
{
    float per_step = (float)grid->most / grid->range;
    return floorf((value - grid->low[axis]) * per_step + 0.5f);
}

uint32_t csg_rounding_number(const csg_rounding *grid, int axis, float value)
{
    return grid->range > 0 ? (uint32_t)number_of(grid, axis, value) : 0;
}

static double on_grid(const csg_rounding *grid, int axis, double value)
{
    float step = grid->range / (float)grid->most;
    return (double)(number_of(grid, axis, (float)value) * step + grid->low[axis]);
}

/* One after the other, each by a call: gcc 12 at -O3 makes vectors of `is ? (double)(float)x : x`
 * for x and y and then forgets to round them. */
__attribute__((noinline)) static double as_float(double value)
{
    return (double)(float)value;
}

static csg_vec3 round_place(const csg_rounding *rounding, csg_vec3 p)
{
    switch (rounding->kind) {
    case CSG_ROUND_FLOAT:
        return csg_vec3_make(as_float(p.x), as_float(p.y), as_float(p.z));
    case CSG_ROUND_GRID:
        return csg_vec3_make(on_grid(rounding, 0, p.x), on_grid(rounding, 1, p.y),
                             on_grid(rounding, 2, p.z));
    default:
        return p;
    }
}

static csg_vec3 exact_place(const rounder *r, uint32_t vertex)
{
    return csg_vec3_add(r->mesh->origin, csg_vec3_from_floats(r->mesh->positions + 3 * vertex));
}

/* ---- what is wrong ------------------------------------------------------------------------ */

/* Twice the area, as a vector. Of floats near each other the differences are exact and so are their
 * products: it is zero for three points on a line, and for no others. */
static csg_vec3 area_of(const csg_vec3 at[3])
{
    return csg_vec3_cross(csg_vec3_sub(at[1], at[0]), csg_vec3_sub(at[2], at[0]));
}

static bool is_zero(csg_vec3 v)
{
    return v.x == 0 && v.y == 0 && v.z == 0;
}

/* The triangle's vertices, those of one place as one; false where two are the same. */
static bool corners_of(const rounder *r, uint64_t triangle, uint32_t v[3])
{
    for (uint64_t k = 0; k < 3; k++)
        v[k] = r->first[r->mesh->indices[3 * triangle + k]];
    return v[0] != v[1] && v[1] != v[2] && v[2] != v[0];
}

/* The triangle around the mesh's own origin: exact, as its floats are. */
static csg_vec3 area_before(const rounder *r, const uint32_t v[3])
{
    csg_vec3 at[3];
    for (int k = 0; k < 3; k++)
        at[k] = csg_vec3_from_floats(r->mesh->positions + 3 * (size_t)v[k]);
    return area_of(at);
}

/* How many other vertices are at this place. */
static uint32_t count_others(const rounder *r, uint32_t vertex, csg_vec3 place)
{
    size_t slot;
    uint32_t count = 0, other = csg_table_first(&r->table, csg_place_hash(place), &slot);
    for (; other != CSG_TABLE_NONE; other = csg_table_next(&r->table, &slot))
        count += other != vertex && csg_place_is_same(r->places[other], place);
    return count;
}

/* What is wrong about a vertex at this place: others there and triangles without area; and, less
 * bad, triangles that look to another side than they did. */
typedef struct faults {
    uint32_t collapsed, turned;
} faults;

static faults faults_of(const rounder *r, uint32_t vertex, csg_vec3 place)
{
    faults found = {.collapsed = count_others(r, vertex, place)};
    for (uint64_t i = r->begin[vertex]; i < r->begin[vertex + 1]; i++) {
        uint32_t v[3];
        if (!corners_of(r, r->around[i], v))
            continue;
        csg_vec3 at[3], before = area_before(r, v);
        for (int k = 0; k < 3; k++)
            at[k] = v[k] == vertex ? place : r->places[v[k]];
        csg_vec3 after = area_of(at);
        found.collapsed += is_zero(after) && !is_zero(before);
        found.turned += csg_vec3_dot(before, after) < 0;
    }
    return found;
}

static bool is_less(faults a, faults b)
{
    return a.collapsed < b.collapsed || (a.collapsed == b.collapsed && a.turned < b.turned);
}

/* ---- other places ------------------------------------------------------------------------- */

typedef struct candidate {
    csg_vec3 place;
    double distance; /* squared, from where the vertex lay */
} candidate;

/* One step on an axis. Where an axis is much finer than the others, its own step would move nothing
 * that can be seen: a quarter of the coarsest is the least. */
static csg_vec3 steps_at(const rounder *r, csg_vec3 place)
{
    if (r->rounding->kind == CSG_ROUND_GRID) {
        double step = (double)(r->rounding->range / (float)r->rounding->most);
        return csg_vec3_make(step, step, step);
    }
    double step[3] = {fabs(place.x), fabs(place.y), fabs(place.z)}, coarsest = 0;
    for (int k = 0; k < 3; k++) {
        float at = (float)step[k];
        step[k] = (double)nextafterf(at, INFINITY) - (double)at;
        coarsest = fmax(coarsest, step[k]);
    }
    for (int k = 0; k < 3; k++)
        step[k] = fmax(step[k], coarsest / 4);
    return csg_vec3_make(step[0], step[1], step[2]);
}

static bool is_in_grid(const csg_rounding *rounding, csg_vec3 p)
{
    double most = (double)rounding->range, at[3] = {p.x, p.y, p.z};
    for (int k = 0; k < 3 && rounding->kind == CSG_ROUND_GRID; k++) {
        double from_low = at[k] - (double)rounding->low[k];
        if (!(from_low >= 0 && from_low <= most))
            return false;
    }
    return true;
}

/* The places around, the nearest first. */
static int list_candidates(const rounder *r, uint32_t vertex, candidate list[CANDIDATES])
{
    csg_vec3 exact = exact_place(r, vertex), middle = round_place(r->rounding, exact);
    csg_vec3 step = steps_at(r, middle);
    int count = 0;
    for (int i = 0; i < CANDIDATES; i++) {
        csg_vec3 by = csg_vec3_make(step.x * (i % WAYS - REACH), step.y * (i / WAYS % WAYS - REACH),
                                    step.z * (i / (WAYS * WAYS) - REACH));
        csg_vec3 place = round_place(r->rounding, csg_vec3_add(middle, by));
        /* what is written is rounded once more and must stay */
        if (!is_in_grid(r->rounding, place) ||
            !csg_place_is_same(place, round_place(r->rounding, place)))
            continue;
        csg_vec3 way = csg_vec3_sub(place, exact);
        candidate new = {place, csg_vec3_dot(way, way)};
        int at = count++;
        for (; at > 0 && list[at - 1].distance > new.distance; at--)
            list[at] = list[at - 1];
        list[at] = new;
    }
    return count;
}

/* The encoder takes its grid from the outermost vertices: these stay. */
static bool is_pinned(const rounder *r, uint32_t vertex)
{
    const csg_rounding *grid = r->rounding;
    if (grid->kind != CSG_ROUND_GRID)
        return grid->kind == CSG_ROUND_DOUBLE;
    const float *p = r->mesh->positions + 3 * (size_t)vertex;
    bool is_outermost = false;
    for (int k = 0; k < 3; k++)
        is_outermost |= p[k] == grid->low[k] || p[k] - grid->low[k] == grid->range;
    return is_outermost && !grid->is_told;
}

/* Moves the vertex to where less is wrong. false: something is left that collapses there. */
static bool settle(rounder *r, uint32_t vertex)
{
    faults least = faults_of(r, vertex, r->places[vertex]), before = least;
    if (!before.collapsed)
        return true;
    candidate list[CANDIDATES];
    int count = is_pinned(r, vertex) ? 0 : list_candidates(r, vertex, list), best = -1;
    for (int i = 0; i < count && (best < 0 || least.collapsed || least.turned); i++) {
        faults there = faults_of(r, vertex, list[i].place);
        if (there.collapsed >= before.collapsed || !is_less(there, least))
            continue;
        least = there;
        best = i;
    }
    if (best < 0)
        return false;
    r->places[vertex] = list[best].place;
    r->moved++;
    csg_table_add(&r->table, csg_place_hash(list[best].place), vertex);
    r->table_count++;
    return !least.collapsed;
}

/* ---- the mesh ----------------------------------------------------------------------------- */

/* Puts a rounded vertex among the others. The number of those that are there already. */
static uint32_t enter_place(rounder *r, uint32_t vertex)
{
    size_t slot;
    uint32_t count = 0;
    uint32_t other = csg_table_first(&r->table, csg_place_hash(r->places[vertex]), &slot);
    for (; other != CSG_TABLE_NONE; other = csg_table_next(&r->table, &slot)) {
        if (!csg_place_is_same(r->places[other], r->places[vertex]))
            continue;
        count++;
        r->suspect[other] = r->suspect[vertex] = 1;
    }
    csg_table_put(&r->table, slot, vertex);
    r->table_count++;
    return count;
}

/* Rounds all, and marks what came to lie together or on a line. The number of faults; *worst: how
 * many vertices are at one place with another, and none is looked at where they are too many. */
static uint64_t mark_suspects(rounder *r, uint32_t *worst)
{
    uint64_t count = 0;
    *worst = 0;
    memset(r->suspect, 0, r->mesh->vertex_count);
    for (uint32_t i = 0; i < r->mesh->vertex_count && *worst < MOST_AT_A_PLACE; i++) {
        r->places[i] = round_place(r->rounding, exact_place(r, i));
        uint32_t others = r->first[i] == i ? enter_place(r, i) : 0;
        count += others > 0;
        *worst = others > *worst ? others : *worst;
    }
    for (uint64_t t = 0; t < r->mesh->triangle_count && *worst < MOST_AT_A_PLACE; t++) {
        uint32_t v[3];
        if (!corners_of(r, t, v))
            continue;
        const csg_vec3 at[3] = {r->places[v[0]], r->places[v[1]], r->places[v[2]]};
        if (!is_zero(area_of(at)) || is_zero(area_before(r, v)))
            continue;
        count++;
        for (int k = 0; k < 3; k++)
            r->suspect[v[k]] = 1;
    }
    return count;
}

/* Each vertex's triangles, by a counting sort. */
static void list_around(rounder *r)
{
    memset(r->begin, 0, (r->mesh->vertex_count + 1) * sizeof *r->begin);
    for (uint64_t i = 0; i < 3 * r->mesh->triangle_count; i++)
        r->begin[r->first[r->mesh->indices[i]]]++;
    uint64_t end = 0;
    for (uint64_t v = 0; v <= r->mesh->vertex_count; v++)
        r->begin[v] = end += r->begin[v];
    for (uint64_t i = 3 * r->mesh->triangle_count; i-- > 0;)
        r->around[--r->begin[r->first[r->mesh->indices[i]]]] = i / 3;
}

/* What the file has there, for messages. */
static const char *const names[] = {"floats", "doubles", "a grid"};

static double coarsest_step(const rounder *r, uint32_t vertex)
{
    csg_vec3 at = exact_place(r, vertex), step = steps_at(r, at);
    double most = fmax(fabs(at.x), fmax(fabs(at.y), fabs(at.z)));
    if (r->rounding->kind == CSG_ROUND_DOUBLE)
        return nextafter(most, INFINITY) - most;
    return fmax(step.x, fmax(step.y, step.z));
}

static csgm_status refuse(const rounder *r, uint32_t vertex, const char *file, const char *format)
{
    static const char *const hints[] = {
        "write PLY, OBJ, 3MF or GLB, which keep them apart, or move the solid towards zero",
        "write GLB, which keeps them apart, or move the solid towards zero",
        "raise --draco-bits, or mesh it coarser"};
    csg_vec3 at = exact_place(r, vertex);
    csg_diag_plain(&r->context->diags, CSG_DIAG_FORMAT_LIMIT, file, hints[r->rounding->kind],
                   "%s has %s in steps of %.3g near (%.6g, %.6g, %.6g), where triangles of the "
                   "mesh would collapse",
                   format, names[r->rounding->kind], coarsest_step(r, vertex), at.x, at.y, at.z);
    return CSGM_ERR_UNSUPPORTED;
}

static double longest(csg_vec3 v)
{
    return fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z)));
}

/* Are floats so coarse there that the mesh would lose its shape? Places that floats have, as those
 * of a cube of whole numbers, stay where they are, however coarse floats are. */
static bool is_shapeless(const rounder *r)
{
    csg_box box = csg_box_empty();
    double moved = 0;
    for (uint32_t i = 0; i < r->mesh->vertex_count; i++) {
        csg_vec3 p = exact_place(r, i);
        box = csg_box_hull(box, (csg_box){p, p});
        moved = fmax(moved, longest(csg_vec3_sub(round_place(r->rounding, p), p)));
    }
    return r->rounding->kind == CSG_ROUND_FLOAT && r->mesh->vertex_count &&
           2 * LEAST_STEPS * moved > longest(csg_box_size(box));
}

/* Moves suspects until none is left. */
static csgm_status settle_all(rounder *r, const char *file, const char *format)
{
    uint64_t left = 1;
    uint32_t last = 0;
    for (int round = 0; round < ROUNDS && left; round++) {
        left = 0;
        for (uint32_t i = 0; i < r->mesh->vertex_count; i++) {
            if (!r->suspect[i])
                continue;
            if (!csg_table_reserve(&r->table, r->table_count + 2, csg_place_hash_of, r->places))
                return csg_context_no_memory(r->context);
            if (settle(r, i))
                continue;
            last = i;
            left++;
        }
    }
    return left ? refuse(r, last, file, format) : CSGM_OK;
}

static bool take(csg_memory *memory, void *slot, uint64_t count, size_t element_bytes)
{
    void **array = slot;
    *array = csg_memory_alloc(memory, (size_t)(count + 1) * element_bytes);
    return *array;
}

static void release(csg_memory *memory, void *array, uint64_t count, size_t element_bytes)
{
    csg_memory_release(memory, array, (size_t)(count + 1) * element_bytes);
}

static csgm_status repair(rounder *r, const char *file, const char *format)
{
    csg_memory *memory = &r->context->memory;
    csgm_status status = CSGM_ERR_MEMORY;
    if (take(memory, &r->begin, r->mesh->vertex_count, sizeof *r->begin) &&
        take(memory, &r->around, 3 * r->mesh->triangle_count, sizeof *r->around)) {
        list_around(r);
        status = settle_all(r, file, format);
    } else {
        csg_context_no_memory(r->context);
    }
    release(memory, r->begin, r->mesh->vertex_count, sizeof *r->begin);
    release(memory, r->around, 3 * r->mesh->triangle_count, sizeof *r->around);
    return status;
}

static bool has_moved(const rounder *r, uint32_t vertex)
{
    csg_vec3 plain = round_place(r->rounding, exact_place(r, vertex));
    return !csg_place_is_same(r->places[r->first[vertex]], plain);
}

static void tell_moved(const rounder *r, const char *file, const char *format)
{
    uint64_t count = 0;
    uint32_t last = 0;
    for (uint32_t i = 0; i < r->mesh->vertex_count && r->moved; i++) {
        bool moved = r->first[i] == i && has_moved(r, i);
        count += moved;
        last = moved ? i : last;
    }
    if (count * MANY > r->mesh->vertex_count)
        csg_diag_plain(
            &r->context->diags, CSG_DIAG_COARSE_FORMAT, file, NULL,
            "%s has %s in steps of %.3g there: %llu vertices are up to two and a half of "
            "them away from where they should be, so that no triangle collapses",
            format, names[r->rounding->kind], coarsest_step(r, last), (unsigned long long)count);
}

/* The grid's encoder rounds for itself: it gets the places of what has moved only. */
static csgm_status deliver(const rounder *r, csg_rounded *out)
{
    out->mesh = *r->mesh;
    bool keeps = r->rounding->kind == CSG_ROUND_GRID;
    if (r->rounding->kind == CSG_ROUND_DOUBLE || (keeps && !r->moved))
        return CSGM_OK;
    size_t bytes = 12 * (size_t)r->mesh->vertex_count;
    out->positions = csg_memory_alloc(&r->context->memory, bytes);
    if (!out->positions)
        return csg_context_no_memory(r->context);
    for (uint64_t i = 0; i < r->mesh->vertex_count; i++) {
        csg_vec3 place = r->places[r->first[i]];
        float *p = out->positions + 3 * i;
        if (keeps && !has_moved(r, (uint32_t)i)) {
            memcpy(p, r->mesh->positions + 3 * i, 12);
        } else {
            p[0] = (float)place.x;
            p[1] = (float)place.y;
            p[2] = (float)place.z;
        }
    }
    out->mesh.positions = out->positions;
    out->mesh.origin = csg_vec3_make(0, 0, 0);
    return CSGM_OK;
}

csgm_status csg_round_mesh(csgm_context *context, const csgm_mesh_view *mesh,
                           const csg_rounding *rounding, const char *file, const char *format,
                           csg_rounded *out)
{
    CSG_ZONE(context, "rounding");
    csg_memory *memory = &context->memory;
    rounder r = {.context = context, .mesh = mesh, .rounding = rounding};
    bool failed = true;
    csg_table_init(&r.table, memory);
    *out = (csg_rounded){.mesh = *mesh};
    if (rounding->kind == CSG_ROUND_GRID && !(rounding->range > 0))
        return CSGM_OK; /* all in one place, or a grid that cannot be told: the encoder has the word
                         */
    if (take(memory, &r.first, mesh->vertex_count, sizeof *r.first) &&
        take(memory, &r.places, mesh->vertex_count, sizeof *r.places) &&
        take(memory, &r.suspect, mesh->vertex_count, sizeof *r.suspect) &&
        csg_table_reserve(&r.table, (size_t)mesh->vertex_count + 2, NULL, NULL))
        csg_weld_map(memory, mesh, CSG_WELD_ALL, r.first, &failed);
    csgm_status status = failed ? csg_context_no_memory(context) : CSGM_OK;
    uint32_t worst = 0;
    uint64_t found = status ? 0 : mark_suspects(&r, &worst);
    if (!status && (worst >= MOST_AT_A_PLACE || is_shapeless(&r)))
        status = refuse(&r, 0, file, format);
    else if (found)
        status = repair(&r, file, format);
    uint32_t errors = context->diags.errors;
    if (!status)
        tell_moved(&r, file, format);
    if (context->diags.errors != errors) /* as warnings are to be */
        status = CSGM_ERR_SCENE;
    if (!status)
        status = deliver(&r, out);
    csg_table_release(&r.table);
    release(memory, r.first, mesh->vertex_count, sizeof *r.first);
    release(memory, r.places, mesh->vertex_count, sizeof *r.places);
    release(memory, r.suspect, mesh->vertex_count, sizeof *r.suspect);
    return status;
}

void csg_rounded_release(csgm_context *context, csg_rounded *rounded)
{
    csg_memory_release(&context->memory, rounded->positions,
                       rounded->positions ? 12 * (size_t)rounded->mesh.vertex_count : 0);
    rounded->positions = NULL;
}
