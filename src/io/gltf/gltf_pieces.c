/* SPDX-License-Identifier: MIT
 * Pieces of shapes that are there several times, moved: one shape, shown at each place. A piece is
 * a stretch of triangles whose vertices are a stretch of their own, as those of polyhedra are that
 * keep their triangles. Two are one if triangles, normals and colours are the same to the bit, and
 * positions are, once moved by one vector and rounded: a reader gets the same coordinates, in the
 * same order.
 */
#include "io/gltf/gltf_source.h"

enum { PIECES_MOST = 4096 }; /* of a shape: each is a node */

typedef struct piece {
    uint64_t first_vertex, vertex_count, first_index, index_count;
    size_t like;     /* the first piece that is the same; itself, if it is that */
    csgm_vec3 shift; /* from there to here */
    bool repeats;    /* others are like it */
} piece;

typedef struct finder {
    csg_gltf_source *source;
    piece *pieces;
    size_t count;
} finder;

/* ---- cutting ----------------------------------------------------------------------------------
 */

/* Where no triangle behind uses a vertex that one before does, or a lower one. False: too many, or
 * one only. */
static bool cut(finder *f, const csg_gltf_shape *shape, const uint32_t *least_behind)
{
    const uint32_t *indices = f->source->mesh.indices + shape->first_index;
    uint64_t triangles = shape->index_count / 3;
    uint32_t most = 0;
    f->count = 0;
    for (uint64_t t = 0, begin = 0; t < triangles; t++) {
        for (int k = 0; k < 3; k++)
            most = indices[3 * t + (uint64_t)k] > most ? indices[3 * t + (uint64_t)k] : most;
        if (t + 1 < triangles && least_behind[t + 1] <= most)
            continue;
        if (f->count == PIECES_MOST)
            return false;
        f->pieces[f->count++] = (piece){.first_vertex = least_behind[begin],
                                        .vertex_count = (uint64_t)most - least_behind[begin] + 1,
                                        .first_index = shape->first_index + 3 * begin,
                                        .index_count = 3 * (t + 1 - begin)};
        begin = t + 1;
    }
    return f->count > 1;
}

/* ---- comparing --------------------------------------------------------------------------------
 */

static bool same_bytes(const void *array, size_t bytes, const piece *a, const piece *b)
{
    const uint8_t *all = array;
    return !array || memcmp(all + a->first_vertex * bytes, all + b->first_vertex * bytes,
                            (size_t)a->vertex_count * bytes) == 0;
}

static bool same_triangles(const csgm_mesh_view *mesh, const piece *a, const piece *b)
{
    for (uint64_t i = 0; i < a->index_count; i++)
        if (mesh->indices[a->first_index + i] - a->first_vertex !=
            mesh->indices[b->first_index + i] - b->first_vertex)
            return false;
    return true;
}

/* Moves a's positions onto b's, as a reader does. */
static bool is_moved(const csgm_mesh_view *mesh, const piece *a, const piece *b, csgm_vec3 *shift)
{
    const float *from = mesh->positions + 3 * a->first_vertex;
    const float *to = mesh->positions + 3 * b->first_vertex;
    double *d = &shift->x;
    const double *origin = &mesh->origin.x;
    for (int k = 0; k < 3; k++)
        d[k] = (double)to[k] - (double)from[k];
    for (uint64_t i = 0; i < 3 * a->vertex_count; i++) {
        double moved = (double)from[i] + (origin[i % 3] + d[i % 3]);
        if (moved != (double)to[i] + origin[i % 3])
            return false;
    }
    return true;
}

static bool is_like(const csgm_mesh_view *mesh, const piece *a, const piece *b, csgm_vec3 *shift)
{
    return a->vertex_count == b->vertex_count && a->index_count == b->index_count &&
           is_moved(mesh, a, b, shift) && same_bytes(mesh->normals, 3 * sizeof(float), a, b) &&
           same_bytes(mesh->colors, 4, a, b) &&
           same_bytes(mesh->materials, 2 * sizeof(uint16_t), a, b) && same_triangles(mesh, a, b);
}

/* The indices that need not be written. A piece is compared with the last few unlike ones of its
 * size. */
static uint64_t match(finder *f)
{
    enum { TRIES = 64 };
    uint64_t saved = 0;
    for (size_t i = 0; i < f->count; i++) {
        piece *p = &f->pieces[i];
        p->like = i;
        for (size_t k = i, tries = 0; k-- > 0 && tries < TRIES && p->like == i;) {
            piece *other = &f->pieces[k];
            if (other->like != k || other->vertex_count != p->vertex_count)
                continue;
            tries++;
            if (!is_like(&f->source->mesh, other, p, &p->shift))
                continue;
            p->like = k;
            p->repeats = other->repeats = true;
            saved += p->index_count;
        }
        if (p->like == i)
            p->shift = (csgm_vec3){0, 0, 0};
    }
    return saved;
}

/* ---- shapes ----------------------------------------------------------------------- */

/* What is written of a source: shapes and shows that replace its own. */
typedef struct fresh {
    csg_gltf_shape *shapes;
    csg_gltf_show *shows;
    size_t shape_count, show_count, room;
} fresh;

static void add_shape(fresh *out, const csg_gltf_shape *whole, const piece *first,
                      const piece *last, const csg_gltf_show *show, bool more)
{
    csg_gltf_shape shape = *whole;
    shape.first_vertex = first->first_vertex;
    shape.vertex_count = last->first_vertex + last->vertex_count - first->first_vertex;
    shape.first_index = first->first_index;
    shape.index_count = last->first_index + last->index_count - first->first_index;
    out->shapes[out->shape_count] = shape;
    out->shows[out->show_count] = *show;
    out->shows[out->show_count].more = more;
    out->shows[out->show_count++].shape = out->shape_count++;
}

/* In the order of the pieces, so that a reader gets the triangles in theirs; those that do not
 * repeat stay together. */
static void add_pieces(fresh *out, const csg_gltf_shape *whole, const csg_gltf_show *show,
                       const finder *f, size_t *shape_of)
{
    bool more = false;
    for (size_t i = 0, end; i < f->count; i = end, more = true) {
        const piece *p = &f->pieces[i];
        for (end = i + 1; end < f->count && !p->repeats && !f->pieces[end].repeats;)
            end++;
        if (p->like == i) {
            shape_of[i] = out->shape_count;
            add_shape(out, whole, p, &f->pieces[end - 1], show, more);
            continue;
        }
        csg_gltf_show moved = *show;
        moved.shape = shape_of[p->like];
        moved.more = more;
        moved.shift.x += p->shift.x;
        moved.shift.y += p->shift.y;
        moved.shift.z += p->shift.z;
        out->shows[out->show_count++] = moved;
    }
}

/* Worth it where a quarter of the triangles and more are there already. */
static bool find(finder *f, const csg_gltf_shape *shape, uint32_t *least)
{
    const uint32_t *indices = f->source->mesh.indices + shape->first_index;
    uint32_t lowest = UINT32_MAX;
    for (uint64_t t = shape->index_count / 3; t-- > 0; least[t] = lowest)
        for (int k = 0; k < 3; k++) {
            uint32_t index = indices[3 * t + (uint64_t)k];
            lowest = index < lowest ? index : lowest;
        }
    return cut(f, shape, least) && match(f) >= shape->index_count / 4;
}

static bool make_room(csg_arena *arena, fresh *out, size_t more)
{
    size_t room = 2 * (out->room + more);
    csg_gltf_shape *shapes = csg_arena_alloc(arena, room * sizeof *shapes);
    csg_gltf_show *shows = csg_arena_alloc(arena, room * sizeof *shows);
    if (!shapes || !shows)
        return false;
    if (out->shape_count)
        memcpy(shapes, out->shapes, out->shape_count * sizeof *shapes);
    if (out->show_count)
        memcpy(shows, out->shows, out->show_count * sizeof *shows);
    *out = (fresh){shapes, shows, out->shape_count, out->show_count, room};
    return true;
}

static bool find_all(finder *f, fresh *out, uint32_t *least, size_t *shape_of)
{
    csg_gltf_source *source = f->source;
    for (size_t i = 0; i < source->show_count; i++) {
        const csg_gltf_show *show = &source->shows[i];
        const csg_gltf_shape *shape = &source->shapes[show->shape];
        bool repeats = find(f, shape, least);
        size_t more = repeats ? f->count : 1;
        if (out->show_count + more > out->room && !make_room(&source->arena, out, more))
            return false;
        if (repeats) {
            add_pieces(out, shape, show, f, shape_of);
            continue;
        }
        out->shapes[out->shape_count] = *shape;
        out->shows[out->show_count] = *show;
        out->shows[out->show_count++].shape = out->shape_count++;
    }
    return true;
}

/* ---- without what is not shown ---------------------------------------------------- */

static void *gathered(csg_gltf_source *source, const void *array, size_t bytes, uint64_t count)
{
    uint8_t *out = array ? csg_arena_alloc(&source->arena, (size_t)count * bytes) : NULL, *at = out;
    for (size_t i = 0; out && i < source->shape_count; i++) {
        const csg_gltf_shape *shape = &source->shapes[i];
        memcpy(at, (const uint8_t *)array + shape->first_vertex * bytes,
               (size_t)shape->vertex_count * bytes);
        at += shape->vertex_count * bytes;
    }
    return out;
}

/* Only the vertices and triangles of shapes, one shape after the other. */
static bool leave_out_the_rest(csg_gltf_source *source)
{
    csgm_mesh_view *mesh = &source->mesh;
    uint64_t vertices = 0, count = 0;
    for (size_t i = 0; i < source->shape_count; i++) {
        vertices += source->shapes[i].vertex_count;
        count += source->shapes[i].index_count;
    }
    csgm_mesh_view out = *mesh;
    out.positions = gathered(source, mesh->positions, 3 * sizeof(float), vertices);
    out.normals = gathered(source, mesh->normals, 3 * sizeof(float), vertices);
    out.colors = gathered(source, mesh->colors, 4, vertices);
    out.materials = gathered(source, mesh->materials, 2 * sizeof(uint16_t), vertices);
    uint32_t *indices = csg_arena_alloc(&source->arena, (size_t)count * sizeof *indices);
    if (!indices || !out.positions || !out.normals != !mesh->normals ||
        !out.colors != !mesh->colors || !out.materials != !mesh->materials)
        return false;
    out.indices = indices;
    out.vertex_count = vertices;
    out.triangle_count = count / 3;
    vertices = count = 0;
    for (size_t i = 0; i < source->shape_count; i++) {
        csg_gltf_shape *shape = &source->shapes[i];
        for (uint64_t k = 0; k < shape->index_count; k++)
            indices[count + k] = mesh->indices[shape->first_index + k] -
                                 (uint32_t)shape->first_vertex + (uint32_t)vertices;
        shape->first_vertex = vertices;
        shape->first_index = count;
        vertices += shape->vertex_count;
        count += shape->index_count;
    }
    *mesh = out;
    return true;
}

bool csg_gltf_find_pieces(csg_gltf_source *source)
{
    csg_memory *memory = source->arena.memory;
    finder f = {.source = source};
    fresh out = {.room = 0};
    uint64_t most = 0;
    for (size_t i = 0; i < source->shape_count; i++)
        most = source->shapes[i].index_count > most ? source->shapes[i].index_count : most;
    size_t least_bytes = (size_t)(most / 3 + 1) * sizeof(uint32_t);
    size_t shape_bytes = PIECES_MOST * sizeof(size_t);
    f.pieces = csg_memory_alloc(memory, PIECES_MOST * sizeof *f.pieces);
    uint32_t *least = csg_memory_alloc(memory, least_bytes);
    size_t *shape_of = csg_memory_alloc(memory, shape_bytes);
    bool good = f.pieces && least && shape_of && find_all(&f, &out, least, shape_of);
    csg_memory_release(memory, f.pieces, PIECES_MOST * sizeof *f.pieces);
    csg_memory_release(memory, least, least_bytes);
    csg_memory_release(memory, shape_of, shape_bytes);
    if (good) {
        source->shapes = out.shapes;
        source->shows = out.shows;
        source->shape_count = out.shape_count;
        source->show_count = out.show_count;
        if (out.show_count > out.shape_count)
            good = leave_out_the_rest(source);
    }
    return good;
}
