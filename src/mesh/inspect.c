/* SPDX-License-Identifier: MIT
 * Counts edges, fans, components and measures of an indexed triangle mesh; see inspect.h.
 *
 * A half-edge is named by the corner it starts at: 3 * triangle + k. Half-edges are sorted by their
 * smaller vertex with one counting sort, and inside such a bucket by the larger vertex, so that the
 * uses of one undirected edge stand together. Corners at the same vertex that are joined by an edge
 * are united (union-find): the sets left at a vertex are its fans. Uniting the three corners of
 * each triangle after that leaves one set a component.
 */
#include "mesh/inspect.h"

#include <stdlib.h>
#include <string.h>

#include "base/geometry.h"
#include "base/mesh_codes.h"
#include "base/sets.h"
#include "mesh/figures/measures.h"
#include "mesh/watch.h"
#include "mesh/weld.h"

enum {
    INSERTION_SORT_MOST = 24,
    STEPS = 1 << 14 /* triangles, corners or vertices between two looks at the clock */
};

typedef struct inspection {
    csg_mesh_watch *watch;
    const csgm_mesh_view *mesh;
    csgm_mesh_check *check;
    uint64_t corner_count;  /* 3 * triangle_count, < 2^32 */
    uint64_t sound_count;   /* triangles that take part */
    uint64_t edge_count;    /* undirected */
    uint32_t *bucket_begin; /* vertex_count + 1: half-edges by smaller vertex */
    uint64_t *half_edges;   /* larger vertex << 32 | starting corner */
    uint32_t *parent;       /* sets of corners (base/sets.h) */
    uint8_t *fans;          /* per vertex: 0, 1 or 2 = several */
} inspection;

/* Of a loop over i: the clock is looked at in its first step, then now and then. */
static bool may_go_on(const inspection *in, uint64_t i)
{
    return i % STEPS != 0 || !csg_mesh_should_stop(in->watch);
}

static const uint32_t *triangle_at(const inspection *in, uint64_t triangle)
{
    return in->mesh->indices + 3 * triangle;
}

static bool is_in_range(const inspection *in, const uint32_t *v)
{
    uint64_t count = in->mesh->vertex_count;
    return v[0] < count && v[1] < count && v[2] < count;
}

static bool is_sound(const inspection *in, const uint32_t *v)
{
    return is_in_range(in, v) && v[0] != v[1] && v[1] != v[2] && v[2] != v[0];
}

/* Vertices of the half-edge that starts at this corner. */
static void half_edge_ends(const inspection *in, uint32_t corner, uint32_t *from, uint32_t *to)
{
    const uint32_t *v = triangle_at(in, corner / 3);
    *from = v[corner % 3];
    *to = v[corner % 3 == 2 ? 0 : corner % 3 + 1];
}

/* ---- edges --------------------------------------------------------------------------- */

/* Counting sort, first half: bucket sizes, the count of what is broken. */
static void count_half_edges(inspection *in)
{
    memset(in->bucket_begin, 0, (in->mesh->vertex_count + 1) * sizeof *in->bucket_begin);
    for (uint64_t t = 0; t < in->mesh->triangle_count && may_go_on(in, t); t++) {
        const uint32_t *v = triangle_at(in, t);
        for (int k = 0; k < 3; k++)
            in->check->index_out_of_range += v[k] >= in->mesh->vertex_count;
        if (!is_in_range(in, v))
            continue;
        if (!is_sound(in, v)) {
            in->check->degenerate_triangles++;
            continue;
        }
        in->sound_count++;
        for (int k = 0; k < 3; k++) {
            uint32_t a = v[k], b = v[(k + 1) % 3];
            in->bucket_begin[a < b ? a : b]++;
        }
    }
}

/* Second half: after it bucket_begin[v] is where bucket v begins. */
static void place_half_edges(inspection *in)
{
    uint32_t end = 0;
    for (uint64_t v = 0; v <= in->mesh->vertex_count; v++) {
        end += in->bucket_begin[v];
        in->bucket_begin[v] = end;
    }
    for (uint64_t t = in->mesh->triangle_count; t-- > 0 && may_go_on(in, t);) {
        const uint32_t *v = triangle_at(in, t);
        if (!is_sound(in, v))
            continue;
        for (uint32_t k = 3; k-- > 0;) {
            uint32_t a = v[k], b = v[(k + 1) % 3];
            uint64_t larger = a < b ? b : a;
            in->half_edges[--in->bucket_begin[a < b ? a : b]] = larger << 32 | (3 * t + k);
        }
    }
}

static int compare_half_edges(const void *a, const void *b)
{
    uint64_t left, right;
    memcpy(&left, a, sizeof left);
    memcpy(&right, b, sizeof right);
    return (left > right) - (left < right);
}

static void sort_bucket(uint64_t *keys, size_t count)
{
    if (count > INSERTION_SORT_MOST) {
        qsort(keys, count, sizeof *keys, compare_half_edges);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        uint64_t key = keys[i];
        size_t j = i;
        for (; j > 0 && keys[j - 1] > key; j--)
            keys[j] = keys[j - 1];
        keys[j] = key;
    }
}

/* The corner at vertex `at` of the triangle to which the half-edge belongs. */
static uint32_t corner_at(const inspection *in, uint32_t half_edge, uint32_t at)
{
    uint32_t from, to;
    half_edge_ends(in, half_edge, &from, &to);
    if (from == at)
        return half_edge;
    return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1;
}

/* All uses of the edge between `smaller` and the vertex in the keys. */
static void close_edge(inspection *in, uint32_t smaller, const uint64_t *keys, size_t uses)
{
    uint32_t larger = (uint32_t)(keys[0] >> 32), first = (uint32_t)keys[0];
    size_t forward = 0;
    for (size_t i = 0; i < uses; i++) {
        uint32_t half_edge = (uint32_t)keys[i];
        forward += corner_at(in, half_edge, smaller) == half_edge;
        csg_sets_join(in->parent, corner_at(in, first, smaller), corner_at(in, half_edge, smaller));
        csg_sets_join(in->parent, corner_at(in, first, larger), corner_at(in, half_edge, larger));
    }
    in->edge_count++;
    in->check->boundary_edges += uses == 1;
    in->check->nonmanifold_edges += uses > 2;
    in->check->misoriented_edges += uses == 2 && forward != 1;
}

static void walk_edges(inspection *in)
{
    csg_sets_init(in->parent, in->corner_count);
    for (uint32_t v = 0; v < in->mesh->vertex_count && may_go_on(in, v); v++) {
        uint64_t *keys = in->half_edges + in->bucket_begin[v];
        size_t count = in->bucket_begin[v + 1] - in->bucket_begin[v];
        sort_bucket(keys, count);
        for (size_t begin = 0, end; begin < count; begin = end) {
            for (end = begin + 1; end < count && keys[end] >> 32 == keys[begin] >> 32;)
                end++;
            close_edge(in, v, keys + begin, end - begin);
        }
    }
}

/* ---- fans and components ------------------------------------------------------------- */

static void count_fans(inspection *in)
{
    uint64_t used = 0;
    if (in->mesh->vertex_count)
        memset(in->fans, 0, in->mesh->vertex_count);
    for (uint64_t c = 0; c < in->corner_count && may_go_on(in, c); c++) {
        const uint32_t *v = triangle_at(in, c / 3);
        if (in->parent[c] != c || !is_sound(in, v))
            continue;
        uint8_t *fans = &in->fans[v[c % 3]];
        used += *fans == 0;
        in->check->nonmanifold_vertices += *fans == 1;
        if (*fans < 2)
            ++*fans;
    }
    in->check->unused_vertices = in->mesh->vertex_count - used;
    in->check->euler = (int64_t)used - (int64_t)in->edge_count + (int64_t)in->sound_count;
}

static void count_components(inspection *in)
{
    for (uint64_t t = 0; t < in->mesh->triangle_count && may_go_on(in, t); t++) {
        uint32_t corner = (uint32_t)(3 * t);
        csg_sets_join(in->parent, corner, corner + 1);
        csg_sets_join(in->parent, corner, corner + 2);
    }
    for (uint64_t c = 0; c < in->corner_count; c += 3)
        in->check->components += in->parent[c] == c && is_sound(in, triangle_at(in, c / 3));
    in->check->genus = (int64_t)in->check->components - in->check->euler / 2;
}

/* ---- measures ------------------------------------------------------------------------ */

static const float *position(const inspection *in, uint32_t vertex)
{
    return in->mesh->positions + 3 * (size_t)vertex;
}

static csg_box used_box(const inspection *in)
{
    csg_box box = csg_box_empty();
    for (uint64_t v = 0; v < in->mesh->vertex_count; v++) {
        if (!in->fans[v])
            continue;
        csg_vec3 p = csg_vec3_from_floats(position(in, (uint32_t)v));
        box = csg_box_hull(box, (csg_box){p, p});
    }
    return box;
}

static void measure(inspection *in)
{
    csg_box box = used_box(in);
    csg_mesh_measures measures = csg_mesh_measures_begin(box);
    for (uint64_t t = 0; t < in->mesh->triangle_count && may_go_on(in, t); t++) {
        const uint32_t *v = triangle_at(in, t);
        if (is_sound(in, v))
            csg_mesh_measures_put(&measures, position(in, v[0]), position(in, v[1]),
                                  position(in, v[2]));
    }
    csg_mesh_measures_end(&measures, box, in->mesh->origin, in->check);
}

/* ---- memory -------------------------------------------------------------------------- */

static bool take(csg_memory *memory, void *slot, uint64_t count, size_t element_bytes)
{
    void **array = slot;
    *array = count ? csg_memory_alloc(memory, (size_t)count * element_bytes) : NULL;
    return *array || !count;
}

static bool take_arrays(csg_memory *memory, inspection *in)
{
    return take(memory, &in->bucket_begin, in->mesh->vertex_count + 1, sizeof *in->bucket_begin) &&
           take(memory, &in->half_edges, in->corner_count, sizeof *in->half_edges) &&
           take(memory, &in->parent, in->corner_count, sizeof *in->parent) &&
           take(memory, &in->fans, in->mesh->vertex_count, sizeof *in->fans);
}

static void release_arrays(csg_memory *memory, inspection *in)
{
    csg_memory_release(memory, in->bucket_begin,
                       (in->mesh->vertex_count + 1) * sizeof *in->bucket_begin);
    csg_memory_release(memory, in->half_edges, in->corner_count * sizeof *in->half_edges);
    csg_memory_release(memory, in->parent, in->corner_count * sizeof *in->parent);
    csg_memory_release(memory, in->fans, in->mesh->vertex_count * sizeof *in->fans);
}

csgm_status csg_mesh_too_large(csgm_context *context, uint64_t triangle_count)
{
    csg_diag_plain(&context->diags, CSG_DIAG_MESH_TOO_LARGE, NULL, NULL,
                   "a mesh of %llu triangles is too large to be inspected",
                   (unsigned long long)triangle_count);
    return CSGM_ERR_LIMIT;
}

static csgm_status inspect_indexed(csg_mesh_watch *watch, const csgm_mesh_view *mesh,
                                   csgm_mesh_check *out)
{
    csgm_context *context = watch->context;
    if (mesh->triangle_count > UINT32_MAX / 3)
        return csg_mesh_too_large(context, mesh->triangle_count);
    csgm_mesh_check check = {0};
    inspection in = {
        .watch = watch, .mesh = mesh, .check = &check, .corner_count = 3 * mesh->triangle_count};
    if (!take_arrays(&context->memory, &in)) {
        release_arrays(&context->memory, &in);
        return csg_context_no_memory(context);
    }
    /* a pass that was stopped leaves arrays behind that the next one must not read */
    void (*const passes[])(inspection *) = {count_half_edges, place_half_edges, walk_edges,
                                            count_fans,       count_components, measure};
    bool is_stopped = false;
    for (size_t i = 0; i < sizeof passes / sizeof *passes && !is_stopped; i++) {
        passes[i](&in);
        is_stopped = csg_mesh_should_stop(watch);
    }
    release_arrays(&context->memory, &in);
    if (is_stopped)
        return csg_mesh_why_work_stopped(watch, "looking at the mesh", "raise --timeout");
    *out = check;
    return CSGM_OK;
}

/* The same triangles with the first vertex of each place. */
static csgm_status inspect_welded(csg_mesh_watch *watch, const csgm_mesh_view *mesh, csg_weld how,
                                  csgm_mesh_check *out)
{
    csg_memory *memory = &watch->context->memory;
    uint32_t *to = NULL, *indices = NULL;
    bool failed = true;
    if (take(memory, &to, mesh->vertex_count, sizeof *to) &&
        take(memory, &indices, 3 * mesh->triangle_count, sizeof *indices))
        csg_weld_map(memory, mesh, how, to, &failed);
    csgm_status status = failed ? csg_context_no_memory(watch->context) : CSGM_OK;
    if (status == CSGM_OK) {
        csgm_mesh_view welded = *mesh;
        for (uint64_t i = 0; i < 3 * mesh->triangle_count; i++)
            indices[i] =
                mesh->indices[i] < mesh->vertex_count ? to[mesh->indices[i]] : mesh->indices[i];
        welded.indices = indices;
        status = inspect_indexed(watch, &welded, out);
    }
    csg_memory_release(memory, to, (size_t)mesh->vertex_count * sizeof *to);
    csg_memory_release(memory, indices, 3 * (size_t)mesh->triangle_count * sizeof *indices);
    return status;
}

/* Files with a vertex for each normal are open along every crease until they are welded: each part
 * for itself, as parts that touch are solids of their own; all of them, where parts are open still,
 * as those of a solid that is cut by its materials. */
csgm_status csg_mesh_inspect(csgm_context *context, const csgm_mesh_view *mesh, double limit_from_s,
                             csgm_mesh_check *out)
{
    const csgm_monitor nobody = {0};
    csg_mesh_watch watch = {0};
    csgm_mesh_check check, welded;
    csg_mesh_watch_begin(&watch, context, &nobody, limit_from_s);
    csg_weld how = mesh->split            ? CSG_WELD_RUNS
                   : mesh->part_count > 1 ? CSG_WELD_PARTS
                                          : CSG_WELD_ALL;
    csgm_status status = inspect_indexed(&watch, mesh, &check);
    for (bool is_done = false; status == CSGM_OK && check.boundary_edges && !is_done;) {
        status = inspect_welded(&watch, mesh, how, &welded);
        if (status == CSGM_OK && welded.boundary_edges < check.boundary_edges) {
            welded.unused_vertices = check.unused_vertices;
            check = welded;
        }
        is_done = how != CSG_WELD_PARTS;
        how = CSG_WELD_ALL;
    }
    if (status == CSGM_OK)
        *out = check;
    return status;
}
