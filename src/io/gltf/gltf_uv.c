/* SPDX-License-Identifier: MIT
 * Texture coordinates by projection: from the side of a box that a triangle faces most, or around
 * the Z axis with caps from above and below. They are in scene units, right way up seen from
 * outside, with v downwards as glTF has it. A vertex whose triangles are projected differently
 * becomes several; which of them are one stays known.
 */
#include <math.h>

#include "base/elementary.h"
#include "io/gltf/gltf_source.h"
#include "mesh/weld.h"

/* Charts of a box are its sides, 2 * axis + (0: the lower one); those of a cylinder: */
enum { ROUND, ROUND_BEYOND, CAP_BELOW, CAP_ABOVE }; /* BEYOND: behind the seam at -180 degrees */

typedef struct copy {
    uint32_t vertex, next; /* of another chart; NONE = the last one */
    int chart;
} copy;

#define NONE UINT32_MAX

typedef struct projector {
    csg_gltf_source *source;
    csgm_uv how;
    uint32_t *first; /* each vertex's first copy */
    copy *copies;
    size_t count, room;
    uint32_t *indices;
    double middle[2]; /* of the cylinder */
    double radius;
} projector;

static void position(const projector *p, uint32_t vertex, double out[3])
{
    for (uint64_t k = 0; k < 3; k++)
        out[k] = (double)p->source->mesh.positions[3 * (uint64_t)vertex + k];
}

/* Twice its area, along its normal. */
static void face(const projector *p, const uint32_t corner[3], double out[3])
{
    double a[3], b[3], c[3];
    position(p, corner[0], a);
    position(p, corner[1], b);
    position(p, corner[2], c);
    for (int k = 0; k < 3; k++) {
        int u = (k + 1) % 3, v = (k + 2) % 3;
        out[k] = (b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]);
    }
}

static double angle_of(const projector *p, uint32_t vertex)
{
    double at[3];
    position(p, vertex, at);
    return csg_atan2(at[1] - p->middle[1], at[0] - p->middle[0]);
}

static int side_of_box(const double n[3])
{
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (fabs(n[k]) > fabs(n[axis]))
            axis = k;
    return 2 * axis + (n[axis] > 0);
}

/* The charts of a triangle's corners. */
static void choose(const projector *p, const uint32_t corner[3], int chart[3])
{
    double n[3], angle[3], most = -INFINITY;
    face(p, corner, n);
    int side = side_of_box(n);
    for (int k = 0; k < 3; k++)
        chart[k] = side;
    if (p->how == CSGM_UV_BOX)
        return;
    for (int k = 0; k < 3; k++) {
        angle[k] = angle_of(p, corner[k]);
        most = fmax(most, angle[k]);
    }
    for (int k = 0; k < 3; k++)
        chart[k] = side == 5   ? CAP_ABOVE
                   : side == 4 ? CAP_BELOW
                               : (most - angle[k] > 3.141592653589793 ? ROUND_BEYOND : ROUND);
}

static void coordinates(const projector *p, const copy *c, float out[2])
{
    /* what runs to the right and upwards, seen from outside; a sign for what is mirrored */
    static const struct {
        int right, up;
        double sign;
    } sides[6] = {{1, 2, -1}, {1, 2, 1}, {0, 2, 1}, {0, 2, -1}, {0, 1, -1}, {0, 1, 1}};
    double at[3];
    position(p, c->vertex, at);
    int side = p->how == CSGM_UV_BOX ? c->chart : c->chart == CAP_BELOW ? 4 : 5;
    double u = sides[side].sign * at[sides[side].right], v = at[sides[side].up];
    if (p->how == CSGM_UV_CYLINDER && c->chart <= ROUND_BEYOND) {
        double turn = c->chart == ROUND_BEYOND ? 6.283185307179586 : 0;
        u = p->radius * (angle_of(p, c->vertex) + turn);
        v = at[2];
    }
    out[0] = (float)u;
    out[1] = (float)(0 - v);
}

/* Its number among the copies; NONE: out of memory. */
static uint32_t copy_of(projector *p, uint32_t vertex, int chart)
{
    uint32_t *link = &p->first[vertex];
    for (; *link != NONE; link = &p->copies[*link].next)
        if (p->copies[*link].chart == chart)
            return *link;
    if (p->count >= UINT32_MAX - 1)
        return NONE;
    size_t at =
        link == &p->first[vertex] ? SIZE_MAX : (size_t)((uint8_t *)link - (uint8_t *)p->copies);
    if (!csg_memory_reserve(p->source->arena.memory, (void **)&p->copies, &p->room, p->count + 1,
                            sizeof *p->copies))
        return NONE;
    if (at != SIZE_MAX) /* the array has moved */
        link = (uint32_t *)(void *)((uint8_t *)p->copies + at);
    p->copies[p->count] = (copy){.vertex = vertex, .next = NONE, .chart = chart};
    *link = (uint32_t)p->count;
    return (uint32_t)p->count++;
}

/* Vertices of one shape stay together. */
static bool split_shapes(projector *p)
{
    const csgm_mesh_view *mesh = &p->source->mesh;
    for (size_t i = 0; i < p->source->shape_count; i++) {
        csg_gltf_shape *shape = &p->source->shapes[i];
        size_t first = p->count;
        for (uint64_t k = 0; k < shape->vertex_count; k++)
            p->first[shape->first_vertex + k] = NONE;
        for (uint64_t k = shape->first_index; k < shape->first_index + shape->index_count; k += 3) {
            int chart[3];
            choose(p, mesh->indices + k, chart);
            for (uint64_t c = 0; c < 3; c++) {
                p->indices[k + c] = copy_of(p, mesh->indices[k + c], chart[c]);
                if (p->indices[k + c] == NONE)
                    return false;
            }
        }
        shape->first_vertex = first;
        shape->vertex_count = p->count - first;
    }
    return true;
}

static void *gathered(const projector *p, const void *array, size_t bytes)
{
    uint8_t *out = csg_arena_alloc(&p->source->arena, p->count * bytes);
    for (size_t i = 0; out && i < p->count; i++)
        memcpy(out + i * bytes, (const uint8_t *)array + p->copies[i].vertex * bytes, bytes);
    return out;
}

/* The copies at a vertex's place, by the first of them that there is. */
static uint32_t *merged(projector *p)
{
    csgm_mesh_view *mesh = &p->source->mesh;
    uint32_t *to = csg_arena_alloc(&p->source->arena, p->count * sizeof *to);
    bool failed = !to;
    if (to && mesh->split)
        csg_weld_map(p->source->arena.memory, mesh, CSG_WELD_RUNS, p->first, &failed);
    if (failed)
        return NULL;
    for (uint64_t i = 0; !mesh->split && i < mesh->vertex_count; i++)
        p->first[i] = (uint32_t)i;
    /* first[v]: the vertex that v is one with; then, in the order of copies, the copy */
    uint32_t *copy_at = csg_arena_alloc(&p->source->arena, mesh->vertex_count * sizeof *copy_at);
    for (uint64_t i = 0; copy_at && i < mesh->vertex_count; i++)
        copy_at[i] = NONE;
    for (size_t s = 0; copy_at && s < p->source->shape_count; s++) {
        const csg_gltf_shape *shape = &p->source->shapes[s];
        for (uint64_t i = shape->first_vertex; i < shape->first_vertex + shape->vertex_count; i++) {
            uint32_t root = p->first[p->copies[i].vertex];
            if (copy_at[root] == NONE || copy_at[root] < shape->first_vertex)
                copy_at[root] = (uint32_t)i;
            to[i] = copy_at[root];
        }
    }
    return copy_at ? to : NULL;
}

static bool take_copies(projector *p)
{
    csg_gltf_source *source = p->source;
    csgm_mesh_view *mesh = &source->mesh;
    float *uv = csg_arena_alloc(&source->arena, p->count * 2 * sizeof *uv);
    uint32_t *to = merged(p);
    if (!uv || !to)
        return false;
    for (size_t i = 0; i < p->count; i++)
        coordinates(p, &p->copies[i], uv + 2 * i);
    csgm_mesh_view out = *mesh;
    out.vertex_count = p->count;
    out.indices = p->indices;
    out.positions = gathered(p, mesh->positions, 3 * sizeof(float));
    bool good = out.positions;
    if (mesh->normals)
        good &= (out.normals = gathered(p, mesh->normals, 3 * sizeof(float))) != NULL;
    if (mesh->colors)
        good &= (out.colors = gathered(p, mesh->colors, 4)) != NULL;
    if (mesh->materials)
        good &= (out.materials = gathered(p, mesh->materials, 2 * sizeof(uint16_t))) != NULL;
    source->mesh = out;
    source->uv = uv;
    source->merge_to = to;
    return good;
}

static void measure(projector *p)
{
    const csgm_mesh_view *mesh = &p->source->mesh;
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (uint64_t i = 0; i < mesh->vertex_count; i++)
        for (uint64_t k = 0; k < 2; k++) {
            low[k] = fmin(low[k], (double)mesh->positions[3 * i + k]);
            high[k] = fmax(high[k], (double)mesh->positions[3 * i + k]);
        }
    for (int k = 0; k < 2; k++)
        p->middle[k] = (low[k] + high[k]) / 2;
    p->radius = fmax(high[0] - low[0], high[1] - low[1]) / 2;
}

bool csg_gltf_project(csg_gltf_source *source, csgm_uv how)
{
    csg_memory *memory = source->arena.memory;
    size_t bytes = (size_t)source->mesh.vertex_count * sizeof(uint32_t);
    projector p = {.source = source, .how = how, .first = csg_memory_alloc(memory, bytes)};
    p.indices = csg_arena_alloc(&source->arena,
                                (size_t)source->mesh.triangle_count * 3 * sizeof *p.indices);
    bool good = p.first && p.indices;
    if (good) {
        measure(&p);
        good = split_shapes(&p) && take_copies(&p);
    }
    csg_memory_release(memory, p.first, bytes);
    csg_memory_release(memory, p.copies, p.room * sizeof *p.copies);
    return good;
}
