/* SPDX-License-Identifier: MIT
 * What the judge of cells saw, in place of a search; see missed.h.
 */
#include <string.h>

#include "base/pool.h"
#include "mesh/distance/missed.h"

enum { PLACES_PER_ITEM = 256 };

/* The nearest triangle of the surface; NONE: none is within the error. Those that close a part of a
 * mesh hide it seldom, near the part's border. */
static uint32_t nearest_triangle(const csg_remesh *r, csg_vec3 at, double error)
{
    uint32_t nearest = CSG_CORNER_NONE;
    csg_triangle_tree_nearest(&r->tree, at, error, &nearest);
    if (nearest == CSG_CORNER_NONE || nearest >= r->closing)
        return nearest;
    double least = error * error, weights[3];
    nearest = CSG_CORNER_NONE;
    for (uint32_t t = r->closing; t < r->corners.triangle_count; t++) {
        csg_vec3 v[3];
        csg_triangle_tree_corners(&r->tree, t, v);
        double square = csg_triangle_nearest(v, at, weights);
        if (square < least) {
            least = square;
            nearest = t;
        }
    }
    return nearest;
}

typedef struct search {
    const csg_remesh *remesh;
    const csg_seen *seen;
    double error;
    uint32_t *nearest; /* per place */
} search;

static bool find_some(void *user, uint32_t worker, size_t item)
{
    const search *s = user;
    size_t end = (item + 1) * PLACES_PER_ITEM;
    (void)worker;
    for (size_t i = item * PLACES_PER_ITEM; i < end && i < s->seen->count; i++)
        s->nearest[i] = nearest_triangle(s->remesh, csg_vec3_from_floats(s->seen->at[i]), s->error);
    return !csg_mesh_should_stop(s->remesh->watch);
}

/* Those that have one. */
static bool list_points(const search *s, csg_missed *out)
{
    size_t count = 0;
    for (size_t i = 0; i < s->seen->count; i++)
        count += s->nearest[i] != CSG_CORNER_NONE;
    if (count && !csg_memory_reserve(s->remesh->memory, (void **)&out->points, &out->capacity,
                                     count, sizeof *out->points))
        return csg_mesh_stop_without_memory(s->remesh->watch);
    for (size_t i = 0; i < s->seen->count; i++) {
        csg_missed_point *point = &out->points[out->count];
        if (s->nearest[i] == CSG_CORNER_NONE)
            continue;
        memcpy(point->at, s->seen->at[i], sizeof point->at);
        point->triangle = s->nearest[i];
        out->count++;
    }
    return true;
}

csgm_status csg_missed_take_seen(const csg_remesh *r, const csg_seen *seen, double error,
                                 csg_missed *out)
{
    *out = (csg_missed){0};
    if (!seen->count)
        return CSGM_OK;
    search s = {r, seen, error, csg_memory_alloc(r->memory, seen->count * sizeof *s.nearest)};
    size_t items = (seen->count + PLACES_PER_ITEM - 1) / PLACES_PER_ITEM;
    bool done = s.nearest != NULL || csg_mesh_stop_without_memory(r->watch);
    done =
        done && csg_pool_run(r->context->pool, items, find_some, NULL, &s) && list_points(&s, out);
    csg_memory_release(r->memory, s.nearest, seen->count * sizeof *s.nearest);
    return done ? CSGM_OK : csg_mesh_why_stopped(r->watch);
}
