/* SPDX-License-Identifier: MIT
 * The mesh that comes out; see output.h. Vertices that nobody moved have the floats that they had.
 * Normals are means of the triangles around a vertex, weighted by their angles there, as far as no
 * crease lies between.
 */
#include "mesh/foreign/output.h"

#include <string.h>

#include "base/elementary.h"
#include "base/sets.h"

static const double CREASE_COSINE = 0.766; /* 40 degrees */

void csg_foreign_output_init(csg_foreign_output *output, csgm_context *context,
                             const csgm_mesh_view *source)
{
    *output = (csg_foreign_output){.context = context, .source = *source};
}

void csg_foreign_output_release(csg_foreign_output *output)
{
    csg_memory *memory = &output->context->memory;
    csg_memory_release(memory, output->positions, output->vertex_room * 3 * sizeof(float));
    csg_memory_release(memory, output->normals, output->normal_room * 3 * sizeof(float));
    csg_memory_release(memory, output->looks, output->look_room * sizeof *output->looks);
    csg_memory_release(memory, output->indices, output->index_room * 3 * sizeof(uint32_t));
}

static bool grow(csg_foreign_output *output, void *array, size_t *room, size_t needed, size_t bytes)
{
    void *data;
    memcpy(&data, array, sizeof data);
    if (!csg_memory_reserve(&output->context->memory, &data, room, needed, bytes))
        return false;
    memcpy(array, &data, sizeof data);
    return true;
}

static bool has_looks(const csg_foreign_output *output)
{
    return output->source.colors || output->source.materials;
}

/* normal and look may be NULL where the mesh has none. */
static bool add_vertex(csg_foreign_output *output, const float position[3], const float *normal,
                       const csg_corner_look *look)
{
    size_t next = output->vertex_count + 1;
    if (next > UINT32_MAX ||
        !grow(output, &output->positions, &output->vertex_room, next, 3 * sizeof(float)))
        return false;
    memcpy(output->positions + 3 * (next - 1), position, 3 * sizeof(float));
    if (normal) {
        if (!grow(output, &output->normals, &output->normal_room, next, 3 * sizeof(float)))
            return false;
        memcpy(output->normals + 3 * (next - 1), normal, 3 * sizeof(float));
    }
    if (look) {
        if (!grow(output, &output->looks, &output->look_room, next, sizeof *output->looks))
            return false;
        output->looks[next - 1] = *look;
    }
    output->vertex_count = next;
    return true;
}

static bool add_triangle(csg_foreign_output *output, const uint32_t corners[3])
{
    if (!grow(output, &output->indices, &output->index_room, output->triangle_count + 1,
              3 * sizeof(uint32_t)))
        return false;
    memcpy(output->indices + 3 * output->triangle_count++, corners, 3 * sizeof(uint32_t));
    return true;
}

/* ---- normals ----------------------------------------------------------------------------------- */

typedef struct shading {
    csg_vec3 *faces;   /* unit normals */
    uint32_t *cluster; /* of each corner: one of those that have its normal */
    csg_vec3 *sums;    /* of each corner that is such a one */
} shading;

static csg_vec3 at(const csg_halfedge_mesh *mesh, uint32_t vertex)
{
    const double *p = mesh->points[vertex];
    return csg_vec3_make(p[0], p[1], p[2]);
}

static csg_vec3 unit(csg_vec3 v)
{
    double length = csg_vec3_norm(v);
    return length > 0 ? csg_vec3_scale(v, 1 / length) : csg_vec3_make(0, 0, 1);
}

static double angle_between(csg_vec3 a, csg_vec3 b)
{
    return csg_atan2(csg_vec3_norm(csg_vec3_cross(a, b)), csg_vec3_dot(a, b));
}

/* By angles, so that it does not matter how a face is cut into triangles, times areas: where a
 * large plane face ends in a rounding, viewers would bend all of it otherwise. */
static void sum_normals(const csg_halfedge_mesh *mesh, shading *s)
{
    for (uint32_t half = 0; half < 3 * mesh->triangle_count; half++) {
        const uint32_t *c = mesh->corners[half / 3];
        csg_vec3 p = at(mesh, c[half % 3]), a = csg_vec3_sub(at(mesh, c[(half + 1) % 3]), p),
                 b = csg_vec3_sub(at(mesh, c[(half + 2) % 3]), p);
        double weight = angle_between(a, b) * csg_vec3_norm(csg_vec3_cross(a, b));
        csg_vec3 *sum = &s->sums[csg_set_root(s->cluster, half)];
        *sum = csg_vec3_add(*sum, csg_vec3_scale(s->faces[half / 3], weight));
    }
}

static bool shade(csg_arena *arena, const csg_halfedge_mesh *mesh, shading *s)
{
    uint32_t halves = (uint32_t)(3 * mesh->triangle_count);
    csg_triangle_edges edges;
    csg_triangles triangles = {
        .corners = mesh->corners, .point_count = mesh->vertex_count, .count = mesh->triangle_count};
    s->faces = csg_arena_alloc(arena, mesh->triangle_count * sizeof *s->faces);
    s->cluster = csg_arena_alloc(arena, halves * sizeof *s->cluster);
    s->sums = csg_arena_calloc(arena, halves, sizeof *s->sums);
    if (!s->faces || !s->cluster || !s->sums || !csg_edges_make(arena, &triangles, &edges))
        return false;
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        csg_vec3 a = at(mesh, mesh->corners[t][0]);
        s->faces[t] = unit(csg_vec3_cross(csg_vec3_sub(at(mesh, mesh->corners[t][1]), a),
                                          csg_vec3_sub(at(mesh, mesh->corners[t][2]), a)));
    }
    csg_sets_init(s->cluster, halves);
    for (size_t i = 0; i < edges.count; i++) {
        const uint32_t *pair = edges.halves + edges.edges[i].first;
        if (edges.edges[i].count != 2 ||
            csg_vec3_dot(s->faces[pair[0] / 3], s->faces[pair[1] / 3]) < CREASE_COSINE)
            continue;
        csg_sets_join(s->cluster, pair[0], csg_corner_next(pair[1]));
        csg_sets_join(s->cluster, csg_corner_next(pair[0]), pair[1]);
    }
    sum_normals(mesh, s);
    return true;
}

/* ---- vertices ---------------------------------------------------------------------------------- */

/* The source's floats where the vertex has not moved. */
static void place(const csg_foreign_piece *piece, uint32_t vertex, float out[3])
{
    uint32_t from = piece->mesh.vertex_from[vertex];
    if (memcmp(piece->mesh.points[vertex], piece->points[from], sizeof *piece->points) == 0) {
        memcpy(out, piece->source.positions + 3 * (size_t)piece->source_vertex[from],
               3 * sizeof *out);
        return;
    }
    csg_vec3 p = csg_triangle_frame_leave(&piece->frame, at(&piece->mesh, vertex));
    out[0] = (float)p.x, out[1] = (float)p.y, out[2] = (float)p.z;
}

/* What tells the vertices of one place apart. */
typedef struct kind {
    csg_corner_look look;
    uint32_t cluster;
} kind;

static kind kind_of(const csg_foreign_output *output, const csg_foreign_piece *piece, shading *s,
                    uint32_t corner)
{
    kind out = {{{0}, {0}}, 0};
    if (has_looks(output))
        out.look = csg_foreign_look(piece, corner / 3, (int)(corner % 3));
    if (output->source.normals)
        out.cluster = csg_set_root(s->cluster, corner);
    return out;
}

/* The vertices of one place, one after the other; number: of each corner. */
static bool add_place(csg_foreign_output *output, const csg_foreign_piece *piece, shading *s,
                      uint32_t vertex, const csg_vertex_corners *corners, kind *kinds,
                      uint32_t *number)
{
    const uint32_t *first = corners->first, *next = corners->next;
    float position[3];
    place(piece, vertex, position);
    for (uint32_t c = first[vertex]; c != UINT32_MAX; c = next[c]) {
        uint32_t other = first[vertex];
        kinds[c] = kind_of(output, piece, s, c);
        while (other != c && memcmp(&kinds[other], &kinds[c], sizeof *kinds) != 0)
            other = next[other];
        if (other != c) {
            number[c] = number[other];
            continue;
        }
        number[c] = (uint32_t)output->vertex_count;
        if (c != first[vertex]) {
            output->split |= kinds[c].cluster != kinds[first[vertex]].cluster;
            output->jumps |=
                memcmp(&kinds[c].look, &kinds[first[vertex]].look, sizeof kinds->look) != 0;
        }
        csg_vec3 n =
            output->source.normals ? unit(s->sums[kinds[c].cluster]) : csg_vec3_make(0, 0, 0);
        const float normal[3] = {(float)n.x, (float)n.y, (float)n.z};
        if (!add_vertex(output, position, output->source.normals ? normal : NULL,
                        has_looks(output) ? &kinds[c].look : NULL))
            return false;
    }
    return true;
}

bool csg_foreign_output_add(csg_foreign_output *output, const csg_foreign_piece *piece)
{
    const csg_halfedge_mesh *mesh = &piece->mesh;
    csg_arena *arena = piece->arena;
    shading s = {NULL};
    csg_vertex_corners corners;
    uint32_t *number = csg_arena_alloc(arena, 3 * mesh->triangle_count * sizeof *number);
    kind *kinds = csg_arena_alloc(arena, 3 * mesh->triangle_count * sizeof *kinds);
    if (!number || !kinds || !csg_list_corners(arena, mesh, &corners) ||
        (output->source.normals && !shade(arena, mesh, &s)))
        return false;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        if (!add_place(output, piece, &s, v, &corners, kinds, number))
            return false;
    for (size_t t = 0; t < mesh->triangle_count; t++)
        if (!add_triangle(output, number + 3 * t))
            return false;
    return true;
}

bool csg_foreign_output_copy(csg_foreign_output *output, csg_arena *scratch,
                             uint64_t first_triangle, uint64_t triangle_count)
{
    const csgm_mesh_view *source = &output->source;
    uint32_t *number = csg_arena_alloc(scratch, source->vertex_count * sizeof *number);
    if (!number)
        return false;
    memset(number, 0xff, source->vertex_count * sizeof *number);
    for (uint64_t t = first_triangle; t < first_triangle + triangle_count; t++) {
        uint32_t corners[3];
        for (size_t k = 0; k < 3; k++) {
            uint32_t v = source->indices[3 * t + k];
            csg_corner_look look = csg_vertex_look(source, v);
            if (number[v] == UINT32_MAX) {
                number[v] = (uint32_t)output->vertex_count;
                if (!add_vertex(output, source->positions + 3 * (size_t)v,
                                source->normals ? source->normals + 3 * (size_t)v : NULL,
                                has_looks(output) ? &look : NULL))
                    return false;
            }
            corners[k] = number[v];
        }
        if (!add_triangle(output, corners))
            return false;
    }
    return true;
}

csgm_status csg_foreign_output_finish(csg_foreign_output *output, csgm_mesh **out)
{
    csgm_mesh *mesh;
    csgm_status status =
        csg_mesh_create(output->context, output->vertex_count, output->triangle_count,
                        output->source.normals != NULL, output->source.colors != NULL, &mesh);
    if (status == CSGM_OK && output->source.materials)
        status = csg_mesh_add_materials(mesh);
    if (status != CSGM_OK)
        return status;
    mesh->origin = output->source.origin;
    mesh->split = output->split && !output->jumps;
    if (output->vertex_count)
        memcpy(mesh->positions, output->positions, output->vertex_count * 3 * sizeof(float));
    if (output->vertex_count && mesh->normals)
        memcpy(mesh->normals, output->normals, output->vertex_count * 3 * sizeof(float));
    if (output->triangle_count)
        memcpy(mesh->indices, output->indices, output->triangle_count * 3 * sizeof(uint32_t));
    for (size_t i = 0; i < output->vertex_count; i++) {
        if (mesh->colors)
            memcpy(mesh->colors + 4 * i, output->looks[i].color, 4);
        if (mesh->materials)
            memcpy(mesh->materials + 2 * i, output->looks[i].material, 2 * sizeof(uint16_t));
    }
    *out = mesh;
    return CSGM_OK;
}
