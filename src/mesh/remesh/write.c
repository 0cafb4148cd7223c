/* SPDX-License-Identifier: MIT
 * The changed mesh back into csgm_mesh arrays: numbers without gaps, normals, at creases a
 * vertex for each sheet where that is asked for.
 */
#include <string.h>

#include "mesh/remesh/normals.h"

typedef struct writer {
    csg_remesh *remesh;
    csgm_mesh *mesh;
    uint32_t *number; /* per corner: its vertex in the new mesh */
    uint32_t count;   /* of new vertices */
    bool split;
} writer;

/* The edge between this corner's triangle and the one before it around the vertex is a crease. */
static bool begins_sheet(const csg_remesh *r, uint32_t c)
{
    return csg_remesh_is_crease(r, c);
}

/* A corner to start the walk around a vertex at: the first of a sheet, where there are several. */
static uint32_t first_of_sheet(const csg_remesh *r, uint32_t vertex)
{
    uint32_t first = r->corners.corner[vertex], c = first;
    if (r->kind[vertex] == CSG_VERTEX_SMOOTH)
        return first;
    do {
        if (begins_sheet(r, c))
            return c;
        c = csg_corner_swing(&r->corners, c);
    } while (c != first);
    return first;
}

/* Numbers for the corners at a vertex, one per sheet if the mesh is split. */
static void number_vertex(writer *w, uint32_t vertex)
{
    const csg_remesh *r = w->remesh;
    uint32_t first = first_of_sheet(r, vertex), c = first;
    bool creased = w->split && r->kind[vertex] != CSG_VERTEX_SMOOTH;
    do {
        if (creased && c != first && begins_sheet(r, c))
            w->count++;
        w->number[c] = w->count;
        c = csg_corner_swing(&r->corners, c);
    } while (c != first);
    w->count++;
}

/* ---- normals -----------------------------------------------------------------------------------
 */

static void store(float out[3], csg_vec3 normal)
{
    csg_vec3 n = csg_vec3_normalize(normal);
    if (!(csg_vec3_dot(n, n) > 0.5))
        n = csg_vec3_make(0, 0, 1);
    out[0] = (float)n.x + 0.0f;
    out[1] = (float)n.y + 0.0f;
    out[2] = (float)n.z + 0.0f;
}

/* False: stopped, or without memory; the watch knows. */
static bool write_normals(writer *w)
{
    csg_remesh *r = w->remesh;
    csg_vec3 *normals = csg_memory_alloc(r->memory, w->count * sizeof *normals);
    if (!normals)
        return csg_mesh_stop_without_memory(r->watch);
    bool done = csg_remesh_find_normals(r, w->number, w->count, normals);
    for (uint32_t v = 0; v < w->count && done; v++)
        store(w->mesh->normals + 3 * (size_t)v, normals[v]);
    csg_memory_release(r->memory, normals, w->count * sizeof *normals);
    return done;
}

/* ---- vertices and triangles --------------------------------------------------------------------
 */

static void write_vertex(writer *w, uint32_t from, size_t to)
{
    csg_remesh *r = w->remesh;
    csgm_mesh *mesh = w->mesh;
    csg_vec3 at = csg_vec3_add(r->at[from], r->marching->shift);
    mesh->positions[3 * to] = (float)at.x + 0.0f;
    mesh->positions[3 * to + 1] = (float)at.y + 0.0f;
    mesh->positions[3 * to + 2] = (float)at.z + 0.0f;
    if (mesh->colors)
        memcpy(mesh->colors + 4 * to, r->looks[from].color, 4);
    if (mesh->materials)
        memcpy(mesh->materials + 2 * to, r->looks[from].material, 2 * sizeof(uint16_t));
}

static void fill(writer *w)
{
    const csg_remesh *r = w->remesh;
    const csg_corners *m = &r->corners;
    for (uint32_t v = 0; v < m->vertex_count; v++) {
        if (m->corner[v] == CSG_CORNER_NONE)
            continue;
        uint32_t c = m->corner[v];
        do {
            write_vertex(w, v, w->number[c]);
            c = csg_corner_swing(m, c);
        } while (c != m->corner[v]);
    }
    size_t i = 0;
    for (uint32_t t = 0; t < m->triangle_count; t++)
        for (uint32_t k = 0; k < 3 && csg_corners_is_live(m, t); k++)
            w->mesh->indices[i++] = w->number[3 * t + k];
}

static csgm_status create(writer *w, const csgm_mesh *old, bool normals)
{
    csgm_context *context = w->remesh->context;
    csgm_status status = csg_mesh_create(context, w->count, w->remesh->corners.live, normals,
                                         old->colors != NULL, &w->mesh);
    if (status == CSGM_OK && old->materials) {
        status = csg_mesh_add_materials(w->mesh);
        if (status != CSGM_OK)
            csg_mesh_destroy(w->mesh);
    }
    if (status == CSGM_OK)
        w->mesh->origin = old->origin;
    return status;
}

csgm_status csg_remesh_write_back(csg_remesh *r, bool normals, bool split)
{
    const csg_corners *m = &r->corners;
    writer w = {.remesh = r, .split = split};
    size_t bytes = 3 * (size_t)m->triangle_count * sizeof *w.number;
    w.number = csg_memory_alloc(r->memory, bytes);
    if (!w.number)
        return csg_context_no_memory(r->context);
    for (uint32_t v = 0; v < m->vertex_count; v++)
        if (m->corner[v] != CSG_CORNER_NONE)
            number_vertex(&w, v);
    csgm_status status = create(&w, r->mesh, normals);
    if (status == CSGM_OK && normals && !write_normals(&w)) {
        csg_mesh_destroy(w.mesh);
        status = csg_mesh_why_stopped(r->watch);
    }
    if (status == CSGM_OK) {
        fill(&w);
        w.mesh->split = split;
        csg_mesh_destroy(r->mesh);
        r->mesh = w.mesh;
    }
    csg_memory_release(r->memory, w.number, bytes);
    return status;
}
