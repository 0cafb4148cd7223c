/* SPDX-License-Identifier: MIT
 * Beginning and ending; see remesh.h. Checks against the field are in check.c.
 */
#include "mesh/remesh/remesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/elementary.h"
#include "mesh/remesh/probe_loop.h"

enum { BATCH = CSG_PROBE_MOST };

static const double ON_SURFACE = 0.02;     /* distance of a centroid, in longest sides */
static const double SHARP_TURN_COS = 0.85; /* of a crease at a vertex: a corner beyond it */

/* ---- creases ----------------------------------------------------------------------------------
 */

static csg_vec3 normal_of(const csg_remesh *r, uint32_t triangle)
{
    return csg_vec3_normalize(csg_triangle_cross(csg_remesh_corner(r, 3 * triangle),
                                                 csg_remesh_corner(r, 3 * triangle + 1),
                                                 csg_remesh_corner(r, 3 * triangle + 2)));
}

/* Whether it is on the surface, where the field has this value, and no sliver. */
static bool is_flat(const csg_remesh *r, uint32_t triangle, float value)
{
    const csg_vec3 v[3] = {csg_remesh_corner(r, 3 * triangle),
                           csg_remesh_corner(r, 3 * triangle + 1),
                           csg_remesh_corner(r, 3 * triangle + 2)};
    double longest = csg_triangle_longest_side(v);
    double slope = (double)r->probe.marching->field->tape.lipschitz;
    bool near = fabs((double)value) <= ON_SURFACE * longest * slope + 4 * (double)r->probe.noise;
    return near && csg_triangle_quality(v[0], v[1], v[2]) > 0.05;
}

void csg_remesh_values_at_centroids(csg_remesh *r, const uint8_t *wanted, float *value)
{
    float at[BATCH][3], f[BATCH];
    uint32_t of[BATCH], count = r->corners.triangle_count, n = 0;
    for (uint32_t t = 0; t < count; t++) {
        if (csg_corners_is_live(&r->corners, t) && (!wanted || wanted[t])) {
            csg_vec3_to_floats(at[n], csg_remesh_centroid(r, t));
            of[n++] = t;
        }
        if (n < BATCH && t + 1 < count)
            continue;
        csg_probe_values(&r->probe, (const float(*)[3])at, n, f);
        for (uint32_t i = 0; i < n; i++)
            value[of[i]] = f[i];
        n = 0;
    }
}

static int compare_values(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return x < y ? -1 : x > y;
}

double csg_remesh_common_value(float *values, size_t count)
{
    qsort(values, count, sizeof *values, compare_values);
    return count ? (double)values[count - 1 - count / 50] : 0;
}

/* What the creases at a vertex make it, and how many there are. creased: the edges, by the corners
 * that face them. */
static csg_vertex_kind kind_of(const csg_remesh *r, uint32_t vertex, const uint8_t *creased,
                               uint32_t *count)
{
    uint32_t first = r->corners.corner[vertex], c = first, creases = 0;
    csg_vec3 way[2] = {{0, 0, 0}, {0, 0, 0}};
    do {
        if (creased[csg_corner_previous(c)]) {
            csg_vec3 to = csg_remesh_corner(r, csg_corner_next(c));
            if (creases < 2)
                way[creases] = csg_vec3_normalize(csg_vec3_sub(to, r->at[vertex]));
            creases++;
        }
        c = csg_corner_swing(&r->corners, c);
    } while (c != first);
    *count = creases;
    if (creases == 0)
        return CSG_VERTEX_SMOOTH;
    bool straight = creases == 1 || csg_vec3_dot(way[0], way[1]) < -SHARP_TURN_COS;
    return creases <= 2 && straight ? CSG_VERTEX_CREASE : CSG_VERTEX_CORNER;
}

/* Edges at which normals turn, by the corners that face them; and the triangles at these. */
static void find_turns(const csg_remesh *r, uint8_t *creased, uint8_t *turns)
{
    const csg_corners *m = &r->corners;
    memset(turns, 0, m->triangle_count);
    memset(creased, 0, 3 * (size_t)m->triangle_count);
    for (uint32_t t = r->closing; t < m->triangle_count; t++) {
        if (!csg_corners_is_live(m, t))
            continue;
        csg_vec3 normal = normal_of(r, t);
        for (uint32_t c = 3 * t; c < 3 * t + 3; c++) {
            uint32_t other = m->across[c]; /* each edge once, by its lower corner */
            if (other < c || other / 3 < r->closing ||
                !(csg_vec3_dot(normal, normal_of(r, other / 3)) < CSG_CREASE_COS))
                continue;
            creased[c] = creased[other] = 1;
            turns[t] = turns[other / 3] = 1;
        }
    }
}

/* Takes the edges back at whose triangles `turns` does not say that they turn. */
static void take_back_beside(const csg_remesh *r, uint8_t *creased, const uint8_t *turns)
{
    const csg_corners *m = &r->corners;
    for (uint32_t c = 0; c < 3 * m->triangle_count; c++)
        creased[c] = creased[c] && turns[c / 3] && turns[m->across[c] / 3];
}

/* Takes those edges back at which a triangle is a sliver or, in equal cells, off the surface. */
static void take_back_bent(csg_remesh *r, uint8_t *creased, uint8_t *turns, float *value)
{
    const csg_corners *m = &r->corners;
    bool equal = !r->marching->bricks;
    if (equal)
        csg_remesh_values_at_centroids(r, turns, value);
    for (uint32_t t = 0; t < m->triangle_count; t++)
        turns[t] = turns[t] && is_flat(r, t, equal ? value[t] : 0);
    take_back_beside(r, creased, turns);
}

/* Per triangle, but for `creased`, which is per corner. Normals are not kept: they would take six
 * times as much as all of this. */
typedef struct crease_room {
    float *value; /* NULL: cells are not equal */
    uint8_t *turns, *creased;
} crease_room;

/* Takes those edges back at which a triangle is so low that rounding may have turned it. */
static void take_back_low(const csg_remesh *r, const crease_room *room)
{
    static const double LOWEST = 64; /* of the noise */
    const csg_corners *m = &r->corners;
    for (uint32_t t = 0; t < m->triangle_count; t++) {
        if (!room->turns[t])
            continue;
        const csg_vec3 v[3] = {csg_remesh_corner(r, 3 * t), csg_remesh_corner(r, 3 * t + 1),
                               csg_remesh_corner(r, 3 * t + 2)};
        double height = csg_vec3_norm(csg_triangle_cross(v[0], v[1], v[2]));
        room->turns[t] = height > LOWEST * r->tree.noise * csg_triangle_longest_side(v);
    }
    take_back_beside(r, room->creased, room->turns);
}

/* A place in a triangle, beside the edge that a corner faces. */
static void place_beside(const csg_remesh *r, uint32_t corner, float at[3])
{
    static const double NEAR = 0.15; /* of the way to the corner */
    csg_vec3 middle =
        csg_vec3_scale(csg_vec3_add(csg_remesh_corner(r, csg_corner_next(corner)),
                                    csg_remesh_corner(r, csg_corner_previous(corner))),
                       0.5);
    csg_vec3 way = csg_vec3_sub(csg_remesh_corner(r, corner), middle);
    csg_vec3_to_floats(at, csg_vec3_add(middle, csg_vec3_scale(way, NEAR)));
}

static double angle(csg_vec3 a, csg_vec3 b)
{
    return csg_arc_cosine(csg_vec3_dot(csg_vec3_normalize(a), csg_vec3_normalize(b)));
}

typedef struct turning_edges {
    const csg_remesh *remesh;
    uint8_t *creased;
} turning_edges;

/* Of both corners across an edge the lower one has a say: nobody else looks at either. */
static void look_at_turns(void *user, csg_probe *probe, size_t first, size_t end)
{
    static const double MOST_OF_TURN = 0.6;
    const turning_edges *e = user;
    const csg_corners *m = &e->remesh->corners;
    float at[BATCH][3], g[BATCH][3];
    uint32_t of[BATCH / 2], n = 0;
    for (uint32_t c = (uint32_t)first; c < end; c++)
        if (c < m->across[c] && e->creased[c]) {
            place_beside(e->remesh, c, at[2 * n]);
            place_beside(e->remesh, m->across[c], at[2 * n + 1]);
            of[n++] = c;
        }
    if (!n)
        return;
    csg_probe_gradients(probe, (const float(*)[3])at, 2 * n, g);
    for (uint32_t i = 0; i < n; i++) {
        uint32_t c = of[i], across = m->across[c];
        double turn = angle(normal_of(e->remesh, c / 3), normal_of(e->remesh, across / 3));
        double own = angle(csg_vec3_from_floats(g[2 * i]), csg_vec3_from_floats(g[2 * i + 1]));
        e->creased[c] = e->creased[across] = own >= MOST_OF_TURN * turn;
    }
}

/* Takes those edges back on both sides of which the field's gradients differ by much less than the
 * triangles do: there the surface is curved. False: stopped, or without memory; the watch knows. */
static bool take_back_curved(csg_remesh *r, uint8_t *creased)
{
    turning_edges e = {r, creased};
    size_t corners = 3 * (size_t)r->corners.triangle_count;
    return csg_probe_loop(r->watch, r->marching, corners, BATCH / 2, look_at_turns, &e);
}

static bool find_kinds(csg_remesh *r, const crease_room *room)
{
    uint32_t creases;
    find_turns(r, room->creased, room->turns);
    if (r->is_own)
        take_back_low(r, room);
    else
        take_back_bent(r, room->creased, room->turns, room->value);
    if (r->marching->bricks && !take_back_curved(r, room->creased))
        return false;
    for (uint32_t v = 0; v < r->corners.vertex_count; v++)
        r->kind[v] = r->corners.corner[v] == CSG_CORNER_NONE
                         ? 0
                         : (uint8_t)kind_of(r, v, room->creased, &creases);
    return true;
}

/* Runs `find` with room of its own. False: it did, or there is no memory; the watch knows. */
static bool with_room(csg_remesh *r, bool (*find)(csg_remesh *r, const crease_room *room))
{
    size_t count = r->corners.triangle_count;
    bool equal = !r->marching->bricks;
    crease_room room = {.value =
                            equal ? csg_memory_alloc(r->memory, count * sizeof *room.value) : NULL,
                        .turns = csg_memory_alloc(r->memory, count),
                        .creased = csg_memory_alloc(r->memory, 3 * count)};
    bool done = (room.value || !equal) && room.turns && room.creased;
    if (!done)
        csg_mesh_stop_without_memory(r->watch);
    else
        done = find(r, &room);
    csg_memory_release(r->memory, room.value, count * sizeof *room.value);
    csg_memory_release(r->memory, room.turns, count);
    csg_memory_release(r->memory, room.creased, 3 * count);
    return done;
}

/* ---- a second look -----------------------------------------------------------------------------
 */

/* Whether all triangles at a vertex lie in one plane, to rounding. */
static bool is_plane_around(const csg_remesh *r, uint32_t vertex)
{
    static const double ROUNDING = 4; /* of the noise */
    const csg_corners *m = &r->corners;
    csg_vec3 at = r->at[vertex], normal = {0, 0, 0};
    uint32_t first = m->corner[vertex], c = first;
    do {
        normal = csg_vec3_add(normal, csg_triangle_cross(at, r->at[m->vertex[csg_corner_next(c)]],
                                                         r->at[m->vertex[csg_corner_previous(c)]]));
        c = csg_corner_swing(m, c);
    } while (c != first);
    double most = ROUNDING * r->tree.noise, square = csg_vec3_dot(normal, normal);
    do {
        csg_vec3 off = csg_vec3_sub(r->at[m->vertex[csg_corner_next(c)]], at);
        double height = csg_vec3_dot(normal, off);
        if (!(height * height <= most * most * square))
            return false;
        c = csg_corner_swing(m, c);
    } while (c != first);
    return square > 0;
}

/* A corner on a straight crease is none, and nothing is where all around is plane. */
static bool find_less(csg_remesh *r, const crease_room *room)
{
    find_turns(r, room->creased, room->turns);
    take_back_low(r, room);
    if (r->marching->bricks && !take_back_curved(r, room->creased))
        return false;
    for (uint32_t v = 0; v < r->corners.vertex_count; v++) {
        uint32_t creases;
        if (r->corners.corner[v] == CSG_CORNER_NONE || r->kind[v] == CSG_VERTEX_SMOOTH)
            continue;
        if (is_plane_around(r, v))
            r->kind[v] = CSG_VERTEX_SMOOTH;
        else if (kind_of(r, v, room->creased, &creases) == CSG_VERTEX_CREASE && creases == 2)
            r->kind[v] = CSG_VERTEX_CREASE;
    }
    return true;
}

bool csg_remesh_ease_kinds(csg_remesh *r)
{
    return with_room(r, find_less);
}

bool csg_remesh_is_crease(const csg_remesh *r, uint32_t corner)
{
    uint32_t apex = csg_corner_previous(corner), other = r->corners.across[apex];
    csg_vec3 a = csg_remesh_corner(r, corner), b = csg_remesh_corner(r, csg_corner_next(corner));
    if (r->kind[r->corners.vertex[corner]] == CSG_VERTEX_SMOOTH ||
        r->kind[r->corners.vertex[csg_corner_next(corner)]] == CSG_VERTEX_SMOOTH)
        return false;
    csg_vec3 left = csg_vec3_normalize(csg_triangle_cross(a, b, csg_remesh_corner(r, apex)));
    csg_vec3 right = csg_vec3_normalize(csg_triangle_cross(b, a, csg_remesh_corner(r, other)));
    return csg_vec3_dot(left, right) < CSG_CREASE_COS;
}

/* ---- beginning ---------------------------------------------------------------------------------
 */

/* Nobody asks what the mesh was made of where it did not begin with the triangles of polyhedra:
 * counts and which colours there are stay. */
static void forget_arrays(csg_remesh *r)
{
    csgm_mesh *mesh = r->mesh;
    csg_memory_release(r->memory, mesh->positions, mesh->vertex_count * 3 * sizeof(float));
    csg_memory_release(r->memory, mesh->indices, mesh->triangle_count * 3 * sizeof(uint32_t));
    mesh->positions = NULL;
    mesh->indices = NULL;
}

csg_vec3 csg_remesh_first_place(const csg_remesh *r, uint32_t vertex)
{
    return csg_vec3_sub(csg_vec3_from_floats(r->mesh->positions + 3 * (size_t)vertex),
                        r->marching->shift);
}

bool csg_remesh_is_as_begun(const csg_remesh *r, uint32_t triangle)
{
    if (triangle >= r->mesh->triangle_count)
        return false;
    for (size_t c = 3 * (size_t)triangle; c < 3 * (size_t)triangle + 3; c++) {
        uint32_t v = r->corners.vertex[c];
        if (v != r->mesh->indices[c])
            return false;
        csg_vec3 off = csg_vec3_sub(r->at[v], csg_remesh_first_place(r, v));
        if (csg_vec3_dot(off, off) > 0)
            return false;
    }
    return true;
}

static void copy_vertices(csg_remesh *r)
{
    const csgm_mesh *mesh = r->mesh;
    for (uint32_t v = 0; v < r->corners.vertex_count; v++) {
        r->at[v] = csg_remesh_first_place(r, v);
        if (r->looks && mesh->colors)
            memcpy(r->looks[v].color, mesh->colors + 4 * (size_t)v, 4);
        if (r->looks && mesh->materials)
            memcpy(r->looks[v].material, mesh->materials + 2 * (size_t)v, 2 * sizeof(uint16_t));
    }
}

static bool take_arrays(csg_remesh *r)
{
    const csgm_mesh *mesh = r->mesh;
    size_t count = r->corners.vertex_count;
    bool looks = mesh->colors || mesh->materials;
    r->at = csg_memory_alloc(r->memory, count * sizeof *r->at);
    r->kind = csg_memory_alloc(r->memory, count);
    if (looks && (r->looks = csg_memory_alloc(r->memory, count * sizeof *r->looks)))
        memset(r->looks, 0, count * sizeof *r->looks);
    return r->at && r->kind && (!looks || r->looks);
}

csgm_status csg_remesh_begin(csg_remesh *r, csgm_mesh *mesh, const csg_remesh_origin *origin,
                             const csg_marching *marching, csg_mesh_watch *watch)
{
    csgm_context *context = watch->context;
    *r = (csg_remesh){.context = context,
                      .memory = &context->memory,
                      .watch = watch,
                      .marching = marching,
                      .mesh = mesh,
                      .is_own = origin->is_own,
                      .closing = origin->closing,
                      .cell = marching->lattice->cell_size};
    csg_corners_result result = csg_corners_make(&r->corners, r->memory, mesh->indices,
                                                 mesh->triangle_count, mesh->vertex_count);
    if (result == CSG_CORNERS_NOT_CLOSED)
        return csg_mesh_report_open(watch);
    bool done = (result == CSG_CORNERS_MADE && take_arrays(r) &&
                 csg_probe_make(&r->probe, marching, r->memory)) ||
                csg_mesh_stop_without_memory(watch);
    if (done) {
        copy_vertices(r);
        if (!r->is_own)
            forget_arrays(r);
        if (origin->kinds)
            memcpy(r->kind, origin->kinds, r->corners.vertex_count);
        done = (origin->kinds || with_room(r, find_kinds)) &&
               (csg_triangle_tree_make(&r->tree, &r->corners, r->at) ||
                csg_mesh_stop_without_memory(watch));
    }
    if (done)
        return CSGM_OK;
    csg_remesh_end(r);
    return csg_mesh_why_stopped(watch);
}

void csg_remesh_end(csg_remesh *r)
{
    size_t count = r->corners.vertex_count;
    csg_memory_release(r->memory, r->at, count * sizeof *r->at);
    csg_memory_release(r->memory, r->kind, count);
    csg_memory_release(r->memory, r->looks, count * sizeof *r->looks);
    csg_probe_release(&r->probe);
    csg_triangle_tree_release(&r->tree);
    csg_corners_release(&r->corners);
    *r = (csg_remesh){0};
}
