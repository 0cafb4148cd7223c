/* SPDX-License-Identifier: MIT
 * Short edges: one vertex in place of two, where the triangles around become better. Marching cubes
 * makes them where the surface passes close by a lattice point.
 */
#include <math.h>

#include "mesh/reshape/improver.h"

/* Places for the vertex that stays, the best first. */
typedef struct choices {
    csg_vec3 at[3];
    bool on_surface[3];
    int count;
} choices;

static void choose(choices *c, csg_vec3 at, bool on_surface)
{
    c->at[c->count] = at;
    c->on_surface[c->count++] = on_surface;
}

/* Creases are not left, corners do not move. */
static choices places_of(const csg_remesh *r, uint32_t corner)
{
    uint32_t from = r->corners.vertex[corner], to = r->corners.vertex[csg_corner_next(corner)];
    csg_vec3 a = r->at[from], b = r->at[to];
    uint8_t kind_a = r->kind[from], kind_b = r->kind[to];
    choices c = {.count = 0};
    if (kind_a == CSG_VERTEX_CORNER && kind_b == CSG_VERTEX_CORNER)
        return c;
    if (kind_a != CSG_VERTEX_SMOOTH && kind_b != CSG_VERTEX_SMOOTH &&
        !csg_remesh_is_crease(r, corner))
        return c;
    if (kind_a != kind_b) {
        choose(&c, kind_a > kind_b ? a : b, true);
        return c;
    }
    if (kind_a == CSG_VERTEX_SMOOTH)
        choose(&c, csg_vec3_scale(csg_vec3_add(a, b), 0.5), false);
    choose(&c, a, true);
    choose(&c, b, true);
    return c;
}

/* The triangles of a vertex but for those that hold the other one. */
static bool add_fan(csg_improver *m, uint32_t vertex, uint32_t other, uint32_t kept, bool gone_too)
{
    csg_patch *p = &m->patch;
    const csg_remesh *r = m->remesh;
    const csg_corners *corners = &r->corners;
    uint32_t first = corners->corner[vertex], c = first;
    do {
        uint32_t v = corners->vertex[csg_corner_next(c)];
        uint32_t w = corners->vertex[csg_corner_previous(c)];
        bool goes = v == other || w == other;
        if (p->now_count == CSG_PATCH_MOST)
            return false;
        if (!goes || gone_too) {
            csg_vec3 *now = p->now[p->now_count++];
            now[0] = r->at[vertex];
            now[1] = r->at[v];
            now[2] = r->at[w];
        }
        if (!goes) {
            uint32_t i = p->then_count++;
            p->vertex[i][0] = kept;
            p->vertex[i][1] = v;
            p->vertex[i][2] = w;
            p->then[i][1] = r->at[v];
            p->then[i][2] = r->at[w];
        }
        c = csg_corner_swing(corners, c);
    } while (c != first);
    return true;
}

static bool place_is_good(csg_improver *m, uint32_t from, uint32_t to, csg_vec3 *at,
                          bool on_surface, csg_look_at_vertex *look)
{
    static const double LEAST_GAIN = 1.05, GOOD = 0.36;
    csg_remesh *r = m->remesh;
    csg_patch *p = &m->patch;
    if (!on_surface && !csg_remesh_project(r, at, 0.5 * r->cell))
        return false;
    for (uint32_t i = 0; i < p->then_count; i++)
        p->then[i][0] = *at;
    double before = csg_worst_sine((const csg_vec3(*)[3])p->now, p->now_count);
    double after = csg_worst_sine((const csg_vec3(*)[3])p->then, p->then_count);
    if (after < fmin(LEAST_GAIN * before, GOOD))
        return false;
    csg_look_at_vertex other;
    return csg_improve_looks_alike(m, from, *at, &other) &&
           csg_improve_looks_alike(m, to, *at, look) && csg_patch_is_sound(m);
}

bool csg_improve_collapse(csg_improver *m, uint32_t corner)
{
    csg_remesh *r = m->remesh;
    csg_patch *p = &m->patch;
    uint32_t from = r->corners.vertex[corner], to = r->corners.vertex[csg_corner_next(corner)];
    choices c = places_of(r, corner);
    if (!c.count || !csg_corners_can_collapse(&r->corners, corner))
        return false;
    p->now_count = p->then_count = 0;
    p->vertices[0] = from;
    p->vertices[1] = to;
    p->triangles[0] = p->triangles[1] = CSG_CORNER_NONE;
    if (!add_fan(m, from, to, to, true) || !add_fan(m, to, from, to, false))
        return false;
    for (int i = 0; i < c.count; i++) {
        csg_look_at_vertex look = {{0}, {0}};
        uint32_t gone[2] = {corner / 3, r->corners.across[csg_corner_previous(corner)] / 3};
        if (!place_is_good(m, from, to, &c.at[i], c.on_surface[i], &look))
            continue;
        csg_corners_collapse(&r->corners, corner);
        r->at[to] = c.at[i];
        r->kind[to] = r->kind[from] > r->kind[to] ? r->kind[from] : r->kind[to];
        if (r->looks)
            r->looks[to] = look;
        csg_triangle_tree_update_around(&r->tree, to);
        csg_triangle_tree_update(&r->tree, gone[0]);
        csg_triangle_tree_update(&r->tree, gone[1]);
        return true;
    }
    return false;
}
