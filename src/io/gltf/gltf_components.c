/* SPDX-License-Identifier: MIT
 * Components of shapes (what hangs together) that are the same, moved, are laid out alike, one
 * behind the other, so that gltf_pieces.c finds them. Two are the same if they have the same
 * vertices, to the bit once moved by one vector, and the same triangles; but where all normals of
 * two triangles are one and theirs, too, the surface is flat there, and how it is cut into
 * triangles does not matter: with all other triangles alike the flat places have the same
 * boundaries, and what lies in a plane is known by its boundary. The mesher cuts equal faces in
 * several ways, as its cells lie. What does not repeat keeps its order.
 */
#include <math.h>
#include <stdlib.h>

#include "base/geometry.h"
#include "base/sets.h"
#include "io/gltf/gltf_source.h"

enum {
    MOST = 4096, /* components of a shape */
    TRIES = 64,  /* unlike ones of its size that one is compared with */
    WORTH_IT = 4 /* one triangle in so many is there already */
};

/* A vertex that knows its mesh, for qsort. */
typedef struct corner {
    const csgm_mesh_view *mesh;
    uint32_t vertex;
} corner;

typedef struct component {
    uint32_t first_vertex, vertex_count; /* in finder.vertices and .sorted */
    uint32_t first_triangle, triangle_count;
    uint32_t like; /* the first component that is the same; itself, if it is that */
    bool is_sorted;
} component;

typedef struct finder {
    csg_gltf_source *source;
    const csg_gltf_shape *shape;
    csg_arena scratch;
    component *components;
    uint32_t count;
    uint32_t *of;        /* per vertex of the shape: its component */
    uint32_t *vertices;  /* of the components, one after the other, ascending */
    uint32_t *triangles; /* the same */
    corner *sorted;      /* vertices as compare_corners has them */
    uint32_t *rank;      /* per vertex: where it stands in its component's stretch of sorted */
    uint64_t saved;      /* triangles of components that are like others */
} finder;

/* ---- components ------------------------------------------------------------------- */

static const uint32_t *triangle_at(const finder *f, uint64_t triangle)
{
    return f->source->mesh.indices + f->shape->first_index + 3 * triangle;
}

static uint64_t triangle_count(const finder *f)
{
    return f->shape->index_count / 3;
}

/* Vertices one behind the other at one place are one that is split at a crease. */
static void join_all(const finder *f)
{
    uint64_t first = f->shape->first_vertex;
    const float *p = f->source->mesh.positions + 3 * first;
    csg_sets_init(f->of, f->shape->vertex_count);
    for (uint64_t t = 0; t < triangle_count(f); t++) {
        const uint32_t *v = triangle_at(f, t);
        for (int k = 1; k < 3; k++)
            csg_sets_join(f->of, (uint32_t)(v[0] - first), (uint32_t)(v[k] - first));
    }
    for (uint32_t i = 1; i < f->shape->vertex_count; i++)
        if (memcmp(p + 3 * (size_t)i, p + 3 * (size_t)(i - 1), 3 * sizeof *p) == 0)
            csg_sets_join(f->of, i - 1, i);
}

/* Roots become numbers of components. False: there are too many. */
static bool number_components(finder *f)
{
    for (uint32_t i = 0; i < f->shape->vertex_count; i++) {
        bool is_root = f->of[i] == i;
        if (is_root && f->count == MOST)
            return false;
        /* the root of a set is its smallest number, so it has its number already */
        uint32_t root = is_root ? i : csg_set_root(f->of, i);
        f->rank[i] = is_root ? f->count++ : f->rank[root];
    }
    memcpy(f->of, f->rank, (size_t)f->shape->vertex_count * sizeof *f->of);
    return true;
}

static void list_components(finder *f)
{
    uint32_t first = (uint32_t)f->shape->first_vertex;
    for (uint32_t i = 0; i < f->shape->vertex_count; i++)
        f->components[f->of[i]].vertex_count++;
    for (uint64_t t = 0; t < triangle_count(f); t++)
        f->components[f->of[*triangle_at(f, t) - first]].triangle_count++;
    uint32_t vertices = 0, triangles = 0;
    for (uint32_t c = 0; c < f->count; c++) {
        f->components[c].first_vertex = vertices;
        f->components[c].first_triangle = triangles;
        vertices += f->components[c].vertex_count;
        triangles += f->components[c].triangle_count;
        f->components[c].vertex_count = f->components[c].triangle_count = 0;
    }
    for (uint32_t i = 0; i < f->shape->vertex_count; i++) {
        component *c = &f->components[f->of[i]];
        f->vertices[c->first_vertex + c->vertex_count++] = first + i;
    }
    for (uint64_t t = 0; t < triangle_count(f); t++) {
        component *c = &f->components[f->of[*triangle_at(f, t) - first]];
        f->triangles[c->first_triangle + c->triangle_count++] = (uint32_t)t;
    }
}

/* ---- comparing -------------------------------------------------------------------- */

static int compare_arrays(const void *array, size_t bytes, uint32_t a, uint32_t b)
{
    const uint8_t *all = array;
    return array ? memcmp(all + bytes * a, all + bytes * b, bytes) : 0;
}

static int compare_looks(const csgm_mesh_view *mesh, uint32_t a, uint32_t b)
{
    int order = compare_arrays(mesh->normals, 3 * sizeof(float), a, b);
    order = order ? order : compare_arrays(mesh->colors, 4, a, b);
    return order ? order : compare_arrays(mesh->materials, 2 * sizeof(uint16_t), a, b);
}

/* Moved vertices have the same order. */
static int compare_corners(const void *left, const void *right)
{
    const corner *a = left, *b = right;
    const float *p = a->mesh->positions + 3 * (size_t)a->vertex;
    const float *q = a->mesh->positions + 3 * (size_t)b->vertex;
    for (int k = 0; k < 3; k++)
        if (p[k] != q[k])
            return p[k] < q[k] ? -1 : 1;
    int order = compare_looks(a->mesh, a->vertex, b->vertex);
    return order ? order : (a->vertex > b->vertex) - (a->vertex < b->vertex);
}

static void sort_corners(const finder *f, component *c)
{
    if (c->is_sorted)
        return;
    corner *sorted = f->sorted + c->first_vertex;
    for (uint32_t i = 0; i < c->vertex_count; i++)
        sorted[i] = (corner){&f->source->mesh, f->vertices[c->first_vertex + i]};
    qsort(sorted, c->vertex_count, sizeof *sorted, compare_corners);
    for (uint32_t i = 0; i < c->vertex_count; i++)
        f->rank[sorted[i].vertex - f->shape->first_vertex] = i;
    c->is_sorted = true;
}

static bool same_vertices(const finder *f, const component *a, const component *b)
{
    const csgm_mesh_view *mesh = &f->source->mesh;
    double shift[3];
    for (uint32_t i = 0; i < a->vertex_count; i++) {
        uint32_t from = f->sorted[a->first_vertex + i].vertex;
        uint32_t to = f->sorted[b->first_vertex + i].vertex;
        const float *p = mesh->positions + 3 * (size_t)from;
        const float *q = mesh->positions + 3 * (size_t)to;
        for (int k = 0; k < 3; k++) {
            shift[k] = i ? shift[k] : (double)q[k] - (double)p[k];
            if ((double)p[k] + shift[k] != (double)q[k])
                return false;
        }
        if (compare_looks(mesh, from, to) != 0)
            return false;
    }
    return true;
}

/* A triangle by the ranks of its corners, the smallest first. */
typedef struct ranked {
    uint32_t rank[3];
    uint32_t triangle;
} ranked;

static int compare_ranked(const void *left, const void *right)
{
    const ranked *a = left, *b = right;
    for (int k = 0; k < 3; k++)
        if (a->rank[k] != b->rank[k])
            return a->rank[k] < b->rank[k] ? -1 : 1;
    return 0;
}

static void rank_triangles(const finder *f, const component *c, ranked *out)
{
    for (uint32_t i = 0; i < c->triangle_count; i++) {
        uint32_t rank[3], least = 0;
        out[i].triangle = f->triangles[c->first_triangle + i];
        for (uint32_t k = 0; k < 3; k++) {
            rank[k] = f->rank[triangle_at(f, out[i].triangle)[k] - f->shape->first_vertex];
            least = rank[k] < rank[least] ? k : least;
        }
        for (uint32_t k = 0; k < 3; k++)
            out[i].rank[k] = rank[(least + k) % 3];
    }
    qsort(out, c->triangle_count, sizeof *out, compare_ranked);
}

/* Its corners have one normal, and so has it, as far as floats tell. */
static bool is_flat(const finder *f, uint32_t triangle)
{
    static const double ROUNDING = 1e-6;
    const csgm_mesh_view *mesh = &f->source->mesh;
    const uint32_t *v = triangle_at(f, triangle);
    csg_vec3 at[3];
    if (!mesh->normals || compare_arrays(mesh->normals, 3 * sizeof(float), v[0], v[1]) != 0 ||
        compare_arrays(mesh->normals, 3 * sizeof(float), v[0], v[2]) != 0)
        return false;
    for (int k = 0; k < 3; k++)
        at[k] = csg_vec3_from_floats(mesh->positions + 3 * (size_t)v[k]);
    csg_vec3 normal = csg_vec3_from_floats(mesh->normals + 3 * (size_t)v[0]);
    csg_vec3 area = csg_vec3_cross(csg_vec3_sub(at[1], at[0]), csg_vec3_sub(at[2], at[0]));
    return csg_vec3_dot(area, normal) > 0 &&
           csg_vec3_norm(csg_vec3_cross(area, normal)) <= ROUNDING * csg_vec3_norm(area);
}

/* Of two sorted lists: what only one has is flat. */
static bool differ_where_flat(const finder *f, const ranked *a, const ranked *b, uint32_t count)
{
    uint32_t i = 0, k = 0;
    while (i < count || k < count) {
        int order = i == count ? 1 : k == count ? -1 : compare_ranked(&a[i], &b[k]);
        if (order < 0 && !is_flat(f, a[i].triangle))
            return false;
        if (order > 0 && !is_flat(f, b[k].triangle))
            return false;
        i += order <= 0;
        k += order >= 0;
    }
    return true;
}

/* *failed: out of memory. */
static bool is_like(finder *f, const component *a, const component *b, bool *failed)
{
    if (!same_vertices(f, a, b))
        return false;
    csg_memory *memory = f->scratch.memory;
    size_t bytes = 2 * (size_t)a->triangle_count * sizeof(ranked);
    ranked *both = csg_memory_alloc(memory, bytes);
    *failed |= !both;
    if (!both)
        return false;
    rank_triangles(f, a, both);
    rank_triangles(f, b, both + a->triangle_count);
    bool found = differ_where_flat(f, both, both + a->triangle_count, a->triangle_count);
    csg_memory_release(memory, both, bytes);
    return found;
}

/* False: out of memory. */
static bool match_components(finder *f)
{
    bool failed = false;
    for (uint32_t i = 0; i < f->count; i++) {
        component *c = &f->components[i];
        c->like = i;
        for (uint32_t k = i, tries = 0; k-- > 0 && tries < TRIES && c->like == i && !failed;) {
            component *other = &f->components[k];
            if (other->like != k || other->vertex_count != c->vertex_count ||
                other->triangle_count != c->triangle_count || !c->triangle_count)
                continue;
            tries++;
            sort_corners(f, other);
            sort_corners(f, c);
            if (!is_like(f, other, c, &failed))
                continue;
            c->like = k;
            f->saved += c->triangle_count;
        }
    }
    return !failed;
}

/* ---- laying out ------------------------------------------------------------------- */

typedef struct layout {
    float *positions, *normals;
    uint8_t *colors;
    uint16_t *materials;
    uint32_t *indices;
} layout;

static void *copy(csg_arena *arena, const void *array, uint64_t bytes, bool *failed)
{
    void *out = array ? csg_arena_alloc(arena, (size_t)bytes) : NULL;
    *failed |= array && !out;
    if (out)
        memcpy(out, array, (size_t)bytes);
    return out;
}

static void put_element(void *to, uint64_t i, const void *from, uint64_t k, size_t bytes)
{
    if (to)
        memcpy((uint8_t *)to + i * bytes, (const uint8_t *)from + k * bytes, bytes);
}

/* The vertex of the component that is where the other one's vertex is in that. */
static uint32_t counterpart(const finder *f, const component *c, uint32_t vertex)
{
    return f->sorted[c->first_vertex + f->rank[vertex - f->shape->first_vertex]].vertex;
}

static void put_component(const finder *f, uint32_t number, const layout *out, uint32_t *new_number)
{
    const csgm_mesh_view *mesh = &f->source->mesh;
    const component *c = &f->components[number], *like = &f->components[c->like];
    bool is_own = c->like == number;
    uint32_t first = (uint32_t)f->shape->first_vertex;
    for (uint32_t i = 0; i < c->vertex_count; i++) {
        uint64_t at = (uint64_t)first + c->first_vertex + i;
        uint32_t vertex = f->vertices[like->first_vertex + i];
        uint32_t from = is_own ? vertex : counterpart(f, c, vertex);
        put_element(out->positions, at, mesh->positions, from, 3 * sizeof(float));
        put_element(out->normals, at, mesh->normals, from, 3 * sizeof(float));
        put_element(out->colors, at, mesh->colors, from, 4);
        put_element(out->materials, at, mesh->materials, from, 2 * sizeof(uint16_t));
        new_number[from - first] = (uint32_t)at;
    }
    uint32_t *index = out->indices + f->shape->first_index + 3 * (uint64_t)c->first_triangle;
    for (uint32_t i = 0; i < c->triangle_count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t vertex = triangle_at(f, f->triangles[like->first_triangle + i])[k];
            *index++ = new_number[(is_own ? vertex : counterpart(f, c, vertex)) - first];
        }
}

/* False: out of memory. */
static bool lay_out(finder *f)
{
    csgm_mesh_view *mesh = &f->source->mesh;
    csg_arena *arena = &f->source->arena;
    bool failed = false;
    uint64_t count = mesh->vertex_count;
    uint32_t *new_number = csg_arena_alloc(&f->scratch, f->shape->vertex_count * sizeof(uint32_t));
    const layout out = {
        copy(arena, mesh->positions, count * 3 * sizeof(float), &failed),
        copy(arena, mesh->normals, count * 3 * sizeof(float), &failed),
        copy(arena, mesh->colors, count * 4, &failed),
        copy(arena, mesh->materials, count * 2 * sizeof(uint16_t), &failed),
        copy(arena, mesh->indices, 3 * mesh->triangle_count * sizeof(uint32_t), &failed)};
    if (failed || !new_number)
        return false;
    for (uint32_t i = 0; i < f->count; i++)
        put_component(f, i, &out, new_number);
    mesh->positions = out.positions;
    mesh->normals = out.normals;
    mesh->colors = out.colors;
    mesh->materials = out.materials;
    mesh->indices = out.indices;
    return true;
}

/* For numbers of components. False, as below: out of memory. */
static bool make_room(finder *f)
{
    size_t vertices = (size_t)f->shape->vertex_count;
    f->of = csg_arena_alloc(&f->scratch, vertices * sizeof *f->of);
    f->rank = csg_arena_alloc(&f->scratch, vertices * sizeof *f->rank);
    return f->of && f->rank;
}

/* For what is compared, where there are several. */
static bool make_more_room(finder *f)
{
    size_t vertices = (size_t)f->shape->vertex_count;
    f->components = csg_arena_alloc(&f->scratch, f->count * sizeof *f->components);
    f->vertices = csg_arena_alloc(&f->scratch, vertices * sizeof *f->vertices);
    f->triangles = csg_arena_alloc(&f->scratch, (size_t)triangle_count(f) * sizeof *f->triangles);
    f->sorted = csg_arena_alloc(&f->scratch, vertices * sizeof *f->sorted);
    if (!f->components || !f->vertices || !f->triangles || !f->sorted)
        return false;
    memset(f->components, 0, f->count * sizeof *f->components);
    return true;
}

static bool look_at_shape(finder *f)
{
    if (!make_room(f))
        return false;
    join_all(f);
    if (!number_components(f) || f->count < 2)
        return true;
    if (!make_more_room(f))
        return false;
    list_components(f);
    if (!match_components(f))
        return false;
    return f->saved < triangle_count(f) / WORTH_IT || !f->saved || lay_out(f);
}

/* Parts of foreign meshes may: then vertices of one cannot be moved about under the others.
 * Stretches that do not ascend are taken for such. */
static bool may_share_vertices(const csg_gltf_source *source)
{
    uint64_t end = 0;
    for (size_t i = 0; i < source->shape_count; i++) {
        if (source->shapes[i].first_vertex < end)
            return true;
        end = source->shapes[i].first_vertex + source->shapes[i].vertex_count;
    }
    return false;
}

bool csg_gltf_lay_out_components(csg_gltf_source *source)
{
    bool good = true;
    if (may_share_vertices(source))
        return true;
    for (size_t i = 0; i < source->shape_count && good; i++) {
        finder f = {.source = source, .shape = &source->shapes[i]};
        if (f.shape->vertex_count < 2 || triangle_count(&f) > UINT32_MAX)
            continue;
        csg_arena_init(&f.scratch, source->arena.memory);
        good = look_at_shape(&f);
        csg_arena_reset(&f.scratch);
    }
    return good;
}
