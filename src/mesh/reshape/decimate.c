/* SPDX-License-Identifier: MIT
 * The order of collapses in one region; see decimate.h. A queue by cost, then by number, so the
 * result depends on nothing but the mesh; entries whose ends have changed since are dropped when
 * they come up. What was refused is tried again by who comes next to the region, if something near
 * it has changed since: at once, one try in a hundred would succeed.
 */
#include "mesh/reshape/decimate.h"

#include <math.h>
#include <string.h>

#include "mesh/remesh/probe_loop.h"

/* ---- the queue ---------------------------------------------------------------------------------
 */

static bool is_before(const csg_waiting *a, const csg_waiting *b)
{
    if (a->cost != b->cost)
        return a->cost < b->cost;
    return a->from != b->from ? a->from < b->from : a->to < b->to;
}

static bool add_waiting(csg_decimation *d, csg_waiting entry)
{
    csg_collapse_queue *q = d->queue;
    if (!csg_memory_reserve(d->remesh->memory, (void **)&q->heap, &q->capacity, q->count + 1,
                            sizeof entry))
        return false;
    size_t i = q->count++;
    for (; i && is_before(&entry, &q->heap[(i - 1) / 2]); i = (i - 1) / 2)
        q->heap[i] = q->heap[(i - 1) / 2];
    q->heap[i] = entry;
    return true;
}

static csg_waiting take_cheapest(csg_collapse_queue *q)
{
    csg_waiting first = q->heap[0], last = q->heap[--q->count];
    size_t i = 0;
    for (size_t child = 1; child < q->count; child = 2 * i + 1) {
        if (child + 1 < q->count && is_before(&q->heap[child + 1], &q->heap[child]))
            child++;
        if (!is_before(&q->heap[child], &last))
            break;
        q->heap[i] = q->heap[child];
        i = child;
    }
    q->heap[i] = last;
    return first;
}

static bool add_edge(csg_decimation *d, uint32_t a, uint32_t b)
{
    uint32_t from = a < b ? b : a, to = a < b ? a : b;
    double cost = csg_collapse_cost(d, from, to);
    if (cost < 0)
        return true;
    return add_waiting(d, (csg_waiting){(float)cost, from, to, d->version[from] + d->version[to]});
}

/* Edges that are not settled. */
static bool add_all_edges(csg_decimation *d, const uint32_t *items, uint32_t count)
{
    const csg_corners *m = &d->remesh->corners;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t t = items ? items[i] : i;
        for (uint32_t c = 3 * t; c < 3 * t + 3 && csg_corners_is_live(m, t); c++) {
            uint32_t a = m->vertex[c], b = m->vertex[csg_corner_next(c)];
            bool fresh = d->state[a] == CSG_VERTEX_FRESH || d->state[b] == CSG_VERTEX_FRESH;
            if (!csg_decimation_owns(d, a) || !csg_decimation_owns(d, b))
                continue;
            if (a < b && fresh && !add_edge(d, a, b))
                return false;
        }
    }
    return true;
}

/* In the queue, all of their edges. */
static void settle_all(csg_decimation *d, const uint32_t *items, uint32_t count)
{
    const csg_corners *m = &d->remesh->corners;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t t = items ? items[i] : i;
        for (uint32_t c = 3 * t; c < 3 * t + 3 && csg_corners_is_live(m, t); c++) {
            uint32_t v = m->vertex[c];
            if (csg_decimation_owns(d, v) && d->state[v] == CSG_VERTEX_FRESH)
                d->state[v] = CSG_VERTEX_SETTLED;
        }
    }
}

static bool add_edges_around(csg_decimation *d, uint32_t vertex)
{
    const csg_corners *m = &d->remesh->corners;
    uint32_t first = m->corner[vertex], c = first;
    do {
        uint32_t other = m->vertex[csg_corner_next(c)];
        if (!csg_decimation_owns(d, other))
            d->state[vertex] = CSG_VERTEX_HELD_UP;
        else if (!add_edge(d, vertex, other))
            return false;
        else if (d->state[other] != CSG_VERTEX_HELD_UP)
            d->state[other] = CSG_VERTEX_FRESH;
        c = csg_corner_swing(m, c);
    } while (c != first);
    return true;
}

/* ---- quadrics ----------------------------------------------------------------------------------
 */

enum { BATCH = CSG_PROBE_MOST };

static csg_vec3 triangle_normal(const csg_remesh *r, uint32_t triangle)
{
    return csg_triangle_cross(csg_remesh_corner(r, 3 * triangle),
                              csg_remesh_corner(r, 3 * triangle + 1),
                              csg_remesh_corner(r, 3 * triangle + 2));
}

/* The mean normal of the triangles at each vertex, by their areas. */
static void find_normals(const csg_remesh *r, csg_vec3 *out)
{
    const csg_corners *m = &r->corners;
    memset(out, 0, m->vertex_count * sizeof *out);
    for (uint32_t t = r->closing; t < m->triangle_count; t++) {
        if (!csg_corners_is_live(m, t))
            continue;
        csg_vec3 normal = triangle_normal(r, t);
        for (uint32_t k = 0; k < 3; k++)
            out[m->vertex[3 * t + k]] = csg_vec3_add(out[m->vertex[3 * t + k]], normal);
    }
    for (uint32_t v = 0; v < m->vertex_count; v++)
        out[v] = csg_vec3_normalize(out[v]);
}

/* Whether triangles at a smooth vertex face far from their mean: they may cut off a crease or a
 * tight curve. */
static bool is_bent(const csg_remesh *r, uint32_t vertex, csg_vec3 mean)
{
    static const double BENT_COS = 0.998;
    const csg_corners *m = &r->corners;
    uint32_t first = m->corner[vertex], c = first;
    if (first == CSG_CORNER_NONE || r->kind[vertex] != CSG_VERTEX_SMOOTH)
        return false;
    do {
        csg_vec3 normal = triangle_normal(r, c / 3);
        double dot = csg_vec3_dot(normal, mean);
        if (!(dot > 0 && dot * dot > BENT_COS * BENT_COS * csg_vec3_dot(normal, normal)))
            return true;
        c = csg_corner_swing(m, c);
    } while (c != first);
    return false;
}

/* A triangle on the surface is its own plane. One that cuts off a crease or a tight curve is
 * replaced by the tangent planes at its corners: those lead back to the crease. tangents: zero
 * where the triangles' own planes are good enough. */
static void add_triangle(csg_decimation *d, uint32_t triangle, const csg_vec3 *tangents)
{
    csg_remesh *r = d->remesh;
    const uint32_t *ids = r->corners.vertex + 3 * (size_t)triangle;
    csg_vec3 cross = triangle_normal(r, triangle);
    double weight = csg_vec3_norm(cross) / 6;
    csg_vec3 normal = csg_vec3_normalize(cross);
    csg_quadric sum = {0};
    int flat = 0; /* corners at which the plane is the triangle's own */
    for (uint32_t k = 0; k < 3; k++) {
        csg_vec3 plane = tangents[ids[k]];
        if (csg_vec3_dot(plane, plane) > 0.5)
            sum = csg_quadric_add(sum, csg_quadric_of_plane(r->at[ids[k]], plane, weight));
        else
            flat++;
    }
    if (flat)
        sum = csg_quadric_add(sum, csg_quadric_of_plane(r->at[ids[0]], normal, flat * weight));
    for (uint32_t k = 0; k < 3; k++) {
        csg_quadric *q = &d->quadrics[ids[k]];
        *q = csg_quadric_add(*q, sum);
    }
}

typedef struct tangent_search {
    const csg_remesh *remesh;
    csg_vec3 *normals;
} tangent_search;

static void find_some_tangents(void *user, csg_probe *probe, size_t first, size_t end)
{
    const tangent_search *t = user;
    float at[BATCH][3], g[BATCH][3];
    uint32_t of[BATCH], n = 0;
    for (uint32_t v = (uint32_t)first; v < end; v++) {
        if (is_bent(t->remesh, v, t->normals[v])) {
            csg_vec3_to_floats(at[n], t->remesh->at[v]);
            of[n++] = v;
        }
        t->normals[v] = csg_vec3_make(0, 0, 0);
    }
    if (n)
        csg_probe_gradients(probe, (const float(*)[3])at, n, g);
    for (uint32_t i = 0; i < n; i++)
        t->normals[of[i]] = csg_vec3_normalize(csg_vec3_scale(csg_vec3_from_floats(g[i]), -1));
}

/* In place of the normals of vertices whose triangles are bent: the field's, zero at critical
 * points; zero for all others. False: stopped, or without memory; the watch knows. */
static bool find_tangents(csg_remesh *r, csg_vec3 *normals)
{
    tangent_search t = {r, normals};
    return csg_probe_loop(r->watch, r->marching, r->corners.vertex_count, BATCH, find_some_tangents,
                          &t);
}

static void make_quadrics(csg_decimation *d, const csg_vec3 *tangents)
{
    csg_remesh *r = d->remesh;
    memset(d->quadrics, 0, r->corners.vertex_count * sizeof *d->quadrics);
    for (uint32_t t = 0; t < r->corners.triangle_count; t++)
        if (csg_corners_is_live(&r->corners, t))
            add_triangle(d, t, tangents);
}

/* Samples and quadrics. False: stopped, or without memory; the watch knows. */
static bool look_at_mesh(csg_decimation *d)
{
    csg_remesh *r = d->remesh;
    size_t count = r->corners.vertex_count;
    csg_vec3 *normals = csg_memory_alloc(r->memory, count * sizeof *normals);
    if (!normals)
        return csg_mesh_stop_without_memory(r->watch);
    find_normals(r, normals);
    bool done = (d->begun || csg_decimation_make_samples(d, normals)) && find_tangents(r, normals);
    if (done)
        make_quadrics(d, normals);
    csg_memory_release(r->memory, normals, count * sizeof *normals);
    return done &&
           (!d->begun || csg_decimation_take_samples(d) || csg_mesh_stop_without_memory(r->watch));
}

/* ---- beginning and ending ----------------------------------------------------------------------
 */

static bool keep_looks(csg_decimation *d)
{
    const csg_remesh *r = d->remesh;
    size_t bytes = r->corners.vertex_count * sizeof *r->looks;
    if (!r->looks)
        return true;
    if (d->begun) {
        d->originals = d->begun->looks;
        return true;
    }
    csg_look_at_vertex *copy = csg_memory_alloc(r->memory, bytes);
    if (copy)
        memcpy(copy, r->looks, bytes);
    d->originals = copy;
    return copy != NULL;
}

static bool take_arrays(csg_decimation *d)
{
    csg_remesh *r = d->remesh;
    size_t vertices = r->corners.vertex_count, triangles = r->corners.triangle_count;
    csg_memory *memory = r->memory;
    d->quadrics = csg_memory_alloc(memory, vertices * sizeof *d->quadrics);
    d->version = csg_memory_alloc(memory, vertices * sizeof *d->version);
    d->state = csg_memory_alloc(memory, vertices);
    size_t samples = vertices + triangles + (d->missed ? d->missed->count : 0) + 1;
    bool done = csg_decimation_hold_samples(d, d->begun ? d->begun->vertex_count + 1 : samples);
    d->first_sample = csg_memory_alloc(memory, triangles * sizeof *d->first_sample);
    d->queue = csg_memory_alloc(memory, sizeof *d->queue);
    d->room = csg_memory_alloc(memory, sizeof *d->room);
    if (d->queue)
        *d->queue = (csg_collapse_queue){0};
    if (d->room)
        memset(d->room, 0, sizeof *d->room);
    if (d->version)
        memset(d->version, 0, vertices * sizeof *d->version);
    return done && d->quadrics && d->version && d->state && d->first_sample && d->queue &&
           d->room && keep_looks(d);
}

csgm_status csg_decimation_begin(csg_decimation *d, csg_remesh *remesh, const csg_missed *missed,
                                 csg_begun_samples *begun)
{
    *d = (csg_decimation){.remesh = remesh,
                          .missed = missed,
                          .begun = begun,
                          .low = csg_vec3_make(-INFINITY, -INFINITY, -INFINITY),
                          .high = csg_vec3_make(INFINITY, INFINITY, INFINITY)};
    if ((take_arrays(d) || csg_mesh_stop_without_memory(remesh->watch)) && look_at_mesh(d))
        return CSGM_OK;
    csg_decimation_end(d);
    return csg_mesh_why_stopped(remesh->watch);
}

void csg_decimation_end(csg_decimation *d)
{
    if (!d->remesh)
        return;
    csg_memory *memory = d->remesh->memory;
    size_t vertices = d->remesh->corners.vertex_count;
    size_t triangles = d->remesh->corners.triangle_count;
    csg_memory_release(memory, d->quadrics, vertices * sizeof *d->quadrics);
    csg_memory_release(memory, d->version, vertices * sizeof *d->version);
    csg_memory_release(memory, d->state, vertices);
    csg_memory_release(memory, d->samples, d->sample_capacity * sizeof *d->samples);
    csg_memory_release(memory, d->first_sample, triangles * sizeof *d->first_sample);
    if (!d->begun)
        csg_memory_release(memory, (void *)d->originals, vertices * sizeof *d->originals);
    if (d->queue)
        csg_memory_release(memory, d->queue->heap, d->queue->capacity * sizeof *d->queue->heap);
    if (d->room)
        csg_memory_release(memory, d->room->owner, d->room->owner_capacity * sizeof(uint32_t));
    csg_memory_release(memory, d->queue, sizeof *d->queue);
    csg_memory_release(memory, d->room, sizeof *d->room);
    *d = (csg_decimation){0};
}

/* ---- the loop ----------------------------------------------------------------------------------
 */

/* Once through the queue. */
static csgm_status collapse_waiting(csg_decimation *d, uint32_t least)
{
    enum { LOOK_UP_EVERY = 256 };
    csg_remesh *r = d->remesh;
    for (uint64_t i = 0; d->queue->count && r->corners.live > least; i++) {
        csg_waiting entry = take_cheapest(d->queue);
        if (r->corners.corner[entry.from] == CSG_CORNER_NONE ||
            r->corners.corner[entry.to] == CSG_CORNER_NONE ||
            entry.version != d->version[entry.from] + d->version[entry.to])
            continue;
        if (i % LOOK_UP_EVERY == 0 && csg_mesh_should_stop(r->watch))
            return CSGM_CANCELLED;
        d->tried++;
        uint32_t kept = csg_collapse_try(d, entry.from, entry.to);
        if (kept == CSG_CORNER_NONE)
            continue;
        d->made++;
        if (!add_edges_around(d, kept))
            return CSGM_ERR_MEMORY;
    }
    return CSGM_OK;
}

csgm_status csg_decimate_region(csg_decimation *d, const uint32_t *items, uint32_t count,
                                uint32_t least)
{
    d->queue->count = 0;
    if (!add_all_edges(d, items, count))
        return CSGM_ERR_MEMORY;
    settle_all(d, items, count);
    return collapse_waiting(d, least);
}
