/* SPDX-License-Identifier: MIT
 * Triangles with the samples they answer for, then vertices; see region_record.h. Of what is gone,
 * as most of it is, a record says just that.
 */
#include "mesh/reshape/region_record.h"

/* A triangle that is left, and how many samples follow, in the order of its list. */
typedef struct triangle_record {
    uint32_t vertex[3], across[3], samples;
} triangle_record;

/* Of a vertex: whether it is gone, left as it was but for the corner that it is found by, or at the
 * end of a collapse. */
typedef enum vertex_fate { GONE, LEFT, MOVED } vertex_fate;

typedef struct vertex_record {
    csg_vec3 at;
    csg_quadric quadric;
    uint32_t version;
    uint8_t kind;
    csg_look_at_vertex look;
} vertex_record;

/* ---- triangles ---------------------------------------------------------------------------------
 */

static bool pack_samples(const csg_decimation *d, uint32_t triangle, csg_records *to)
{
    bool done = true;
    uint32_t s = d->first_sample[triangle];
    for (; s != CSG_CORNER_NONE && done; s = csg_sample_next(d, s))
        done = csg_records_add(d->remesh->memory, to, &s, sizeof s);
    return done;
}

static bool pack_triangle(const csg_decimation *d, uint32_t triangle, csg_records *to)
{
    csg_memory *memory = d->remesh->memory;
    const csg_corners *m = &d->remesh->corners;
    const uint8_t is_left = csg_corners_is_live(m, triangle);
    if (!csg_records_add(memory, to, &is_left, sizeof is_left))
        return false;
    if (!is_left)
        return true;
    triangle_record own = {.samples = 0};
    for (uint32_t k = 0; k < 3; k++) {
        own.vertex[k] = m->vertex[3 * triangle + k];
        own.across[k] = m->across[3 * triangle + k];
    }
    for (uint32_t s = d->first_sample[triangle]; s != CSG_CORNER_NONE; s = csg_sample_next(d, s))
        own.samples++;
    return csg_records_add(memory, to, &own, sizeof own) && pack_samples(d, triangle, to);
}

static void unpack_triangle(csg_decimation *d, uint32_t triangle, csg_record_reader *from,
                            size_t item)
{
    csg_corners *m = &d->remesh->corners;
    uint8_t is_left;
    csg_record_read(from, item, &is_left, sizeof is_left);
    uint32_t last = CSG_CORNER_NONE;
    d->first_sample[triangle] = CSG_CORNER_NONE;
    if (!is_left) {
        m->vertex[3 * triangle] = CSG_CORNER_NONE;
        return;
    }
    triangle_record own;
    csg_record_read(from, item, &own, sizeof own);
    for (uint32_t k = 0; k < 3; k++) {
        m->vertex[3 * triangle + k] = own.vertex[k];
        m->across[3 * triangle + k] = own.across[k];
    }
    for (uint32_t i = 0; i < own.samples; i++) {
        uint32_t s;
        csg_record_read(from, item, &s, sizeof s);
        csg_surface_sample_set_next(&d->samples[s], CSG_CORNER_NONE);
        if (i == 0)
            d->first_sample[triangle] = s;
        else
            csg_surface_sample_set_next(&d->samples[last], s);
        last = s;
    }
}

/* ---- vertices ----------------------------------------------------------------------------------
 */

static bool pack_vertex(const csg_region_of_mesh *g, uint32_t v, csg_records *to)
{
    const csg_decimation *d = g->decimation;
    const csg_remesh *r = d->remesh;
    const uint8_t fate = r->corners.corner[v] == CSG_CORNER_NONE ? GONE
                         : d->version[v] == g->version[v]        ? LEFT
                                                                 : MOVED;
    if (!csg_records_add(r->memory, to, &fate, sizeof fate) ||
        !csg_records_add(r->memory, to, &d->state[v], sizeof *d->state))
        return false;
    if (fate == GONE)
        return true;
    vertex_record own = {
        .at = r->at[v], .quadric = d->quadrics[v], .version = d->version[v], .kind = r->kind[v]};
    if (r->looks)
        own.look = r->looks[v];
    return csg_records_add(r->memory, to, &r->corners.corner[v], sizeof(uint32_t)) &&
           (fate == LEFT || csg_records_add(r->memory, to, &own, sizeof own));
}

static void unpack_vertex(const csg_region_of_mesh *g, uint32_t v, csg_record_reader *from,
                          size_t item)
{
    csg_decimation *d = g->decimation;
    csg_remesh *r = d->remesh;
    uint8_t fate;
    csg_record_read(from, item, &fate, sizeof fate);
    csg_record_read(from, item, &d->state[v], sizeof *d->state);
    r->corners.corner[v] = CSG_CORNER_NONE;
    if (fate == GONE)
        return;
    csg_record_read(from, item, &r->corners.corner[v], sizeof(uint32_t));
    if (fate == LEFT)
        return;
    vertex_record own;
    csg_record_read(from, item, &own, sizeof own);
    r->at[v] = own.at;
    d->quadrics[v] = own.quadric;
    d->version[v] = own.version;
    r->kind[v] = own.kind;
    if (r->looks)
        r->looks[v] = own.look;
}

/* ---- both --------------------------------------------------------------------------------------
 */

bool csg_region_pack(const csg_region_of_mesh *g, csg_records *records)
{
    bool done = true;
    for (uint32_t i = 0; i < g->triangle_count && done; i++)
        if (g->inside[g->triangles[i]] == g->region)
            done = pack_triangle(g->decimation, g->triangles[i], records);
    for (uint32_t i = 0; i < g->vertex_count && done; i++)
        done = pack_vertex(g, g->vertices[i], records);
    return done;
}

void csg_region_unpack(const csg_region_of_mesh *g, csg_record_reader *reader, size_t item)
{
    for (uint32_t i = 0; i < g->triangle_count; i++)
        if (g->inside[g->triangles[i]] == g->region)
            unpack_triangle(g->decimation, g->triangles[i], reader, item);
    for (uint32_t i = 0; i < g->vertex_count; i++)
        unpack_vertex(g, g->vertices[i], reader, item);
}
