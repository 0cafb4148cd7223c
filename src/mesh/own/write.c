/* SPDX-License-Identifier: MIT
 * See write.h.
 */
#include "mesh/own/write.h"

#include <math.h>
#include <string.h>

#include "base/elementary.h"
#include "base/geometry.h"

typedef struct writer {
    const csgm_mesh *from;
    const csg_corners *corners;
    bool split;
    const uint32_t *looks; /* per triangle, or NULL */
    csg_own_normal_of *normal_of;
    void *user;
    csgm_mesh *mesh;
    uint32_t *number; /* per corner: its vertex in the new mesh */
    uint32_t count;   /* of new vertices */
} writer;

static csg_vec3 place_of(const writer *w, uint32_t c)
{
    return csg_vec3_from_floats(w->from->positions + 3 * (size_t)w->corners->vertex[c]);
}

/* Of a corner's triangle. */
static csg_vec3 normal_of(const writer *w, uint32_t c)
{
    csg_vec3 a = place_of(w, c);
    return csg_vec3_normalize(csg_vec3_cross(csg_vec3_sub(place_of(w, csg_corner_next(c)), a),
                                             csg_vec3_sub(place_of(w, csg_corner_previous(c)), a)));
}

/* Whether the edge between this corner's triangle and the one before it around the vertex is a
 * crease, or a border of looks. */
static bool begins_sheet(const writer *w, uint32_t c)
{
    uint32_t before = w->corners->across[csg_corner_previous(c)];
    return w->split && ((w->looks && w->looks[c / 3] != w->looks[before / 3]) ||
                        csg_vec3_dot(normal_of(w, c), normal_of(w, before)) < CSG_CREASE_COS);
}

/* A corner to start the walk around a vertex at: the first of a sheet, where there are several. */
static uint32_t first_of_sheet(const writer *w, uint32_t vertex)
{
    uint32_t first = w->corners->corner[vertex], c = first;
    do {
        if (begins_sheet(w, c))
            return c;
        c = csg_corner_swing(w->corners, c);
    } while (c != first);
    return first;
}

/* Numbers for the corners at a vertex, one per sheet. */
static void number_vertex(writer *w, uint32_t vertex)
{
    uint32_t first = first_of_sheet(w, vertex), c = first;
    do {
        if (c != first && begins_sheet(w, c))
            w->count++;
        w->number[c] = w->count;
        c = csg_corner_swing(w->corners, c);
    } while (c != first);
    w->count++;
}

static double angle_at(const writer *w, uint32_t c)
{
    csg_vec3 at = place_of(w, c);
    csg_vec3 a = csg_vec3_sub(place_of(w, csg_corner_next(c)), at);
    csg_vec3 b = csg_vec3_sub(place_of(w, csg_corner_previous(c)), at);
    return csg_atan2(csg_vec3_norm(csg_vec3_cross(a, b)), csg_vec3_dot(a, b));
}

static void store(float out[3], csg_vec3 normal)
{
    csg_vec3 n = csg_vec3_normalize(normal);
    if (!(csg_vec3_dot(n, n) > 0.5))
        n = csg_vec3_make(0, 0, 1);
    csg_vec3_to_floats(out, n);
    for (int k = 0; k < 3; k++)
        out[k] += 0.0f;
}

/* From a corner towards the middle of the side across. */
static csg_vec3 into_triangle(const writer *w, uint32_t c)
{
    csg_vec3 middle = csg_vec3_scale(
        csg_vec3_add(place_of(w, csg_corner_next(c)), place_of(w, csg_corner_previous(c))), 0.5);
    return csg_vec3_sub(middle, place_of(w, c));
}

/* Asked a little beside the vertex, into the sheet: at the vertex there may be several. */
static void write_normal(const writer *w, uint32_t c, csg_vec3 mean, csg_vec3 into)
{
    static const double BESIDE = 1.0 / 64;
    csg_vec3 place = csg_vec3_add(place_of(w, c), csg_vec3_scale(into, BESIDE));
    csg_vec3 normal;
    bool found = w->normal_of && w->normal_of(w->user, place, csg_vec3_normalize(mean), &normal);
    store(w->mesh->normals + 3 * (size_t)w->number[c], found ? normal : mean);
}

/* The normals of the new vertices at one old vertex. */
static void write_normals(const writer *w, uint32_t vertex)
{
    const csg_corners *m = w->corners;
    uint32_t first = first_of_sheet(w, vertex), c = first, count = 0;
    csg_vec3 sum = {0, 0, 0}, into = {0, 0, 0};
    do {
        uint32_t next = csg_corner_swing(m, c);
        sum = csg_vec3_add(sum, csg_vec3_scale(normal_of(w, c), angle_at(w, c)));
        into = csg_vec3_add(into, into_triangle(w, c));
        count++;
        if (next == first || w->number[next] != w->number[c]) {
            write_normal(w, c, sum, csg_vec3_scale(into, 1.0 / count));
            sum = into = csg_vec3_make(0, 0, 0);
            count = 0;
        }
        c = next;
    } while (c != first);
}

static void fill(const writer *w)
{
    const csg_corners *m = w->corners;
    for (uint32_t c = 0; c < 3 * m->triangle_count; c++) {
        memcpy(w->mesh->positions + 3 * (size_t)w->number[c],
               w->from->positions + 3 * (size_t)m->vertex[c], 3 * sizeof(float));
        w->mesh->indices[c] = w->number[c];
    }
    for (uint32_t v = 0; v < m->vertex_count; v++)
        write_normals(w, v);
}

static csgm_status create(writer *w, csgm_context *context)
{
    csgm_status status = csg_mesh_create(context, w->count, w->from->triangle_count, true,
                                         w->from->colors != NULL, &w->mesh);
    if (status == CSGM_OK && w->from->materials) {
        status = csg_mesh_add_materials(w->mesh);
        if (status != CSGM_OK)
            csg_mesh_destroy(w->mesh);
    }
    if (status == CSGM_OK) {
        w->mesh->origin = w->from->origin;
        w->mesh->split = w->split;
    }
    return status;
}

csgm_status csg_own_write_normals(csgm_context *context, const csgm_mesh *mesh,
                                  const csg_corners *corners, bool split, const uint32_t *looks,
                                  csg_own_normal_of *normal_of_place, void *user, csgm_mesh **out)
{
    writer w = {.from = mesh,
                .corners = corners,
                .split = split,
                .looks = looks,
                .normal_of = normal_of_place,
                .user = user};
    size_t bytes = 3 * (size_t)corners->triangle_count * sizeof *w.number;
    w.number = csg_memory_alloc(&context->memory, bytes);
    if (!w.number)
        return csg_context_no_memory(context);
    for (uint32_t v = 0; v < corners->vertex_count; v++)
        number_vertex(&w, v);
    csgm_status status = create(&w, context);
    if (status == CSGM_OK) {
        fill(&w);
        *out = w.mesh;
    }
    csg_memory_release(&context->memory, w.number, bytes);
    return status;
}
