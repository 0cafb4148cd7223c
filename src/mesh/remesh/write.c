/* SPDX-License-Identifier: MIT
 * The changed mesh back into csgm_mesh arrays: numbers without gaps, normals of the field at the
 * new places, at creases a vertex for each sheet where that is asked for.
 */
#include <math.h>
#include <string.h>

#include "mesh/remesh/remesh.h"

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

static csg_vec3 outward(csg_remesh *r, csg_vec3 at)
{
    const float place[3] = {(float)at.x, (float)at.y, (float)at.z};
    float g[3];
    csg_probe_true_gradient(&r->probe, place, g);
    return csg_vec3_normalize(csg_vec3_make(-(double)g[0], -(double)g[1], -(double)g[2]));
}

/* At a crease the gradient takes one side, or has none: a little within the triangle it is that of
 * the triangle's sheet. */
static csg_vec3 outward_within(csg_remesh *r, uint32_t c, double *angle)
{
    static const double STEP = 0.02; /* of a cell */
    csg_vec3 at = csg_remesh_corner(r, c);
    csg_vec3 a = csg_vec3_sub(csg_remesh_corner(r, csg_corner_next(c)), at);
    csg_vec3 b = csg_vec3_sub(csg_remesh_corner(r, csg_corner_previous(c)), at);
    csg_vec3 face = csg_vec3_normalize(csg_vec3_cross(a, b));
    csg_vec3 way = csg_vec3_add(csg_vec3_normalize(a), csg_vec3_normalize(b));
    double reach = fmin(STEP * r->cell, 0.3 * fmin(csg_vec3_norm(a), csg_vec3_norm(b)));
    way = csg_vec3_scale(csg_vec3_normalize(way), reach);
    csg_vec3 normal = outward(r, csg_vec3_add(at, way));
    double lengths = csg_vec3_norm(a) * csg_vec3_norm(b);
    *angle = lengths > 0 ? csg_vec3_norm(csg_vec3_cross(a, b)) / lengths : 0; /* its sine */
    return csg_vec3_dot(normal, face) > 0.7 ? normal : face;
}

static void store(float out[3], csg_vec3 normal)
{
    csg_vec3 n = csg_vec3_normalize(normal);
    if (!(csg_vec3_dot(n, n) > 0.5))
        n = csg_vec3_make(0, 0, 1);
    out[0] = (float)n.x + 0.0f;
    out[1] = (float)n.y + 0.0f;
    out[2] = (float)n.z + 0.0f;
}

/* The normals of the new vertices at one old vertex. */
static void write_normals(writer *w, uint32_t vertex)
{
    csg_remesh *r = w->remesh;
    uint32_t first = first_of_sheet(r, vertex), c = first;
    csg_vec3 normal = outward(r, r->at[vertex]), sum = {0, 0, 0};
    if (r->kind[vertex] == CSG_VERTEX_SMOOTH && csg_vec3_dot(normal, normal) > 0.5) {
        store(w->mesh->normals + 3 * (size_t)w->number[c], normal);
        return;
    }
    do {
        double angle;
        csg_vec3 own = outward_within(r, c, &angle);
        uint32_t next = csg_corner_swing(&r->corners, c);
        sum = csg_vec3_add(sum, csg_vec3_scale(own, angle));
        if (next == first || w->number[next] != w->number[c]) {
            store(w->mesh->normals + 3 * (size_t)w->number[c], sum);
            sum = csg_vec3_make(0, 0, 0);
        }
        c = next;
    } while (c != first);
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
        if (w->mesh->normals)
            write_normals(w, v);
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
    if (status == CSGM_OK) {
        fill(&w);
        w.mesh->split = split;
        csg_mesh_destroy(r->mesh);
        r->mesh = w.mesh;
    }
    csg_memory_release(r->memory, w.number, bytes);
    return status;
}
