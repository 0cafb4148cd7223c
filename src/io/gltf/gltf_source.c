/* SPDX-License-Identifier: MIT
 * Shapes of a mesh; see gltf_source.h. Where vertices are split at creases, a shape says which of
 * them are one, if it is a manifold then: EXT_mesh_manifold lets nobody say so of another.
 */
#include "io/gltf/gltf_source.h"

#include <math.h>

#include "mesh/weld.h"

static void position_range(csg_gltf_shape *shape, const csgm_mesh_view *mesh)
{
    for (int k = 0; k < 3; k++) {
        shape->min[k] = INFINITY;
        shape->max[k] = -INFINITY;
    }
    const float *p = mesh->positions + 3 * shape->first_vertex;
    for (uint64_t i = 0; i < shape->vertex_count; i++, p += 3)
        for (int k = 0; k < 3; k++) {
            shape->min[k] = p[k] < shape->min[k] ? p[k] : shape->min[k];
            shape->max[k] = p[k] > shape->max[k] ? p[k] : shape->max[k];
        }
}

/* ---- is it a manifold? -------------------------------------------------------------------------
 */

/* For each vertex of a shape, the ends of the edges that leave it. */
typedef struct edges {
    uint32_t *first; /* vertex_count + 1 */
    uint32_t *ends;  /* index_count */
} edges;

static uint32_t corner_of(const csg_gltf_source *source, const csg_gltf_shape *shape, uint64_t i)
{
    uint32_t vertex = source->mesh.indices[shape->first_index + i];
    return source->merge_to[vertex] - (uint32_t)shape->first_vertex;
}

static uint64_t next_corner(uint64_t i)
{
    return i % 3 == 2 ? i - 2 : i + 1;
}

static void sort_edges(const csg_gltf_source *source, const csg_gltf_shape *shape, edges *e)
{
    memset(e->first, 0, (size_t)(shape->vertex_count + 1) * sizeof *e->first);
    for (uint64_t i = 0; i < shape->index_count; i++)
        e->first[corner_of(source, shape, i) + 1]++;
    for (uint64_t v = 0; v < shape->vertex_count; v++)
        e->first[v + 1] += e->first[v];
    for (uint64_t i = shape->index_count; i-- > 0;)
        e->ends[--e->first[corner_of(source, shape, i) + 1]] =
            corner_of(source, shape, next_corner(i));
    /* first[v + 1] is now where v begins */
    memmove(e->first, e->first + 1, (size_t)shape->vertex_count * sizeof *e->first);
    e->first[shape->vertex_count] = (uint32_t)shape->index_count;
}

static uint32_t count_edges(const edges *e, uint32_t from, uint32_t to)
{
    uint32_t count = 0;
    for (uint32_t i = e->first[from]; i < e->first[from + 1]; i++)
        count += e->ends[i] == to;
    return count;
}

/* Each edge leaves its vertex once, and comes back once. */
static bool is_matched(const edges *e, uint64_t vertex_count)
{
    for (uint32_t v = 0; v < vertex_count; v++)
        for (uint32_t i = e->first[v]; i < e->first[v + 1]; i++)
            if (e->ends[i] == v || count_edges(e, v, e->ends[i]) != 1 ||
                count_edges(e, e->ends[i], v) != 1)
                return false;
    return true;
}

/* False: out of memory. */
static bool look_for_manifold(csg_memory *memory, const csg_gltf_source *source,
                              csg_gltf_shape *shape)
{
    edges e;
    size_t first_bytes = (size_t)(shape->vertex_count + 1) * sizeof *e.first;
    size_t end_bytes = (size_t)shape->index_count * sizeof *e.ends;
    if (shape->index_count > UINT32_MAX)
        return true;
    e.first = csg_memory_alloc(memory, first_bytes);
    e.ends = csg_memory_alloc(memory, end_bytes);
    bool has_room = e.first && e.ends;
    if (has_room) {
        sort_edges(source, shape, &e);
        bool manifold = is_matched(&e, shape->vertex_count);
        for (uint64_t i = 0; manifold && i < shape->index_count; i++) {
            uint32_t vertex = source->mesh.indices[shape->first_index + i];
            shape->merge_count += source->merge_to[vertex] != vertex;
        }
    }
    csg_memory_release(memory, e.first, first_bytes);
    csg_memory_release(memory, e.ends, end_bytes);
    return has_room;
}

/* A vertex's first copy may belong to the shape before it, if that ends at the same place. */
static bool merges_stay_inside(const csg_gltf_source *source, const csg_gltf_shape *shape)
{
    for (uint64_t i = 0; i < shape->vertex_count; i++)
        if (source->merge_to[shape->first_vertex + i] < shape->first_vertex)
            return false;
    return true;
}

/* The arena holds what is found; scratch memory is given back. */
static bool find_merges(csg_gltf_source *source)
{
    csg_memory *memory = source->arena.memory;
    bool failed = false;
    uint32_t *to = csg_arena_alloc(&source->arena, (source->mesh.vertex_count + 1) * sizeof *to);
    if (!to)
        return false;
    if (source->merge_to) /* vertices that are split otherwise, too */
        memcpy(to, source->merge_to, source->mesh.vertex_count * sizeof *to);
    else
        csg_weld_map(memory, &source->mesh, CSG_WELD_RUNS, to, &failed);
    if (failed)
        return false;
    source->merge_to = to;
    for (size_t i = 0; i < source->shape_count; i++) {
        csg_gltf_shape *shape = &source->shapes[i];
        if (merges_stay_inside(source, shape) && !look_for_manifold(memory, source, shape))
            return false;
    }
    return true;
}

/* ---- all of it -------------------------------------------------------------------- */

csgm_status csg_gltf_source_make(csgm_context *context, const csgm_mesh_view *mesh,
                                 const csgm_write_options *options, csg_gltf_source *out)
{
    *out = (csg_gltf_source){.mesh = *mesh};
    csg_arena_init(&out->arena, &context->memory);
    csgm_status status = csg_gltf_take_levels(context, mesh, options, out);
    if (status)
        return status;
    bool may_repeat = !mesh->equal_cells;
    if ((may_repeat && (!csg_gltf_lay_out_components(out) || !csg_gltf_find_pieces(out))) ||
        (options->uv != CSGM_UV_NONE && !csg_gltf_project(out, options->uv)))
        return csg_context_no_memory(context);
    for (size_t i = 0; i < out->shape_count; i++)
        position_range(&out->shapes[i], &out->mesh);
    if ((mesh->split || out->uv) && !mesh->equal_cells && !find_merges(out))
        return csg_context_no_memory(context);
    return CSGM_OK;
}

void csg_gltf_source_release(csg_gltf_source *source)
{
    if (source->arena.memory)
        csg_arena_reset(&source->arena);
}
