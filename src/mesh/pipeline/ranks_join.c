/* SPDX-License-Identifier: MIT
 * What ranks have made, brought together; see ranks.h.
 */
#include <string.h>

#include "base/ranks.h"
#include "base/trace.h"
#include "mesh/pipeline/ranks.h"

/* Doubts about thin parts, to the first rank, which follows them. */
static csgm_status join_doubts(csgm_context *context, csg_octree *octree, csgm_status own)
{
    size_t count = 0;
    uint64_t edges;
    const csg_scan *doubts = own == CSGM_OK ? csg_octree_doubts(octree, &count, &edges) : NULL;
    if (!doubts && count) {
        own = csg_context_no_memory(context);
        count = 0;
    }
    csg_rank_pieces all;
    csgm_status status = csg_ranks_gather(context, own, 0, doubts, count * sizeof *doubts, &all);
    if (status == CSGM_OK && csg_ranks_is_first(context) &&
        !csg_octree_adopt_doubts(octree, all.bytes, (size_t)(all.total / sizeof *doubts)))
        status = csg_context_no_memory(context);
    csg_rank_pieces_release(&context->memory, &all);
    return csg_ranks_agree(context, status);
}

/* Of the vertices that clipping made, for the first rank's first worker. */
static csgm_status join_bounds(csgm_context *context, csg_mesh_workers *workers, csgm_status own)
{
    csg_box box = csg_box_empty();
    for (uint32_t i = 0; i < workers->count; i++)
        box = csg_box_hull(box, workers->each[i].bounds);
    csg_rank_pieces all;
    csgm_status status = csg_ranks_gather(context, own, 0, &box, sizeof box, &all);
    const csg_box *each = all.bytes;
    for (size_t i = 0; i < all.total / sizeof box; i++)
        workers->each[0].bounds = csg_box_hull(workers->each[0].bounds, each[i]);
    csg_rank_pieces_release(&context->memory, &all);
    return status;
}

/* One array of the mesh, `bytes` an element, from all ranks behind each other. */
static csgm_status join_array(csgm_context *context, csgm_status own, const void *piece,
                              uint64_t count, size_t bytes, void *place)
{
    return csg_ranks_gather_into(context, own, 0, piece, count * bytes, place);
}

/* All ranks have the same arrays, so they meet in the same exchanges; an array without elements may
 * be NULL. */
static csgm_status join_arrays(const csg_mesh_output *o, const csgm_mesh *own, csgm_mesh *whole,
                               csgm_status status)
{
    csgm_context *context = o->watch->context;
    uint64_t v = own->vertex_count;
    bool first = csg_ranks_is_first(context) && status == CSGM_OK;
    status = join_array(context, status, own->positions, v, 3 * sizeof(float),
                        first ? whole->positions : NULL);
    if (status == CSGM_OK && o->counts.normals)
        status = join_array(context, status, own->normals, v, 3 * sizeof(float),
                            first ? whole->normals : NULL);
    if (status == CSGM_OK && o->counts.colors)
        status = join_array(context, status, own->colors, v, 4, first ? whole->colors : NULL);
    if (status == CSGM_OK && csg_mesh_gets_materials(o->input))
        status = join_array(context, status, own->materials, v, 2 * sizeof(uint16_t),
                            first ? whole->materials : NULL);
    if (status == CSGM_OK)
        status = join_array(context, status, own->indices, own->triangle_count,
                            3 * sizeof(uint32_t), first ? whole->indices : NULL);
    return status;
}

/* The first rank's mesh becomes the whole one, the others' an empty one. */
static csgm_status join_mesh(csg_mesh_output *o, csgm_status own)
{
    csgm_context *context = o->watch->context;
    bool first = csg_ranks_is_first(context);
    csgm_mesh *part = o->mesh, *whole = NULL;
    if (own == CSGM_OK)
        own = csg_mesh_create(context, first ? o->counts.vertex_count : 0,
                              first ? o->counts.triangle_count : 0, o->counts.normals,
                              o->counts.colors, &whole);
    if (own == CSGM_OK && csg_mesh_gets_materials(o->input))
        own = csg_mesh_add_materials(whole);
    if (own != CSGM_OK)
        return csg_ranks_agree(context, own);
    whole->origin = part->origin;
    whole->split = part->split;
    csgm_status status = csg_ranks_agree(context, CSGM_OK);
    if (status == CSGM_OK)
        status = join_arrays(o, part, whole, status);
    csg_mesh_destroy(status == CSGM_OK ? part : whole);
    o->mesh = status == CSGM_OK ? whole : part;
    return status;
}

csgm_status csg_mesh_ranks_join(csg_mesh_output *o, csg_mesh_slabs *s, csgm_status own)
{
    csgm_context *context = o->watch->context;
    if (!context->ranks || s->is_whole)
        return own;
    CSG_ZONE(context, "joining ranks");
    csgm_status status = csg_ranks_agree(context, own);
    if (status != CSGM_OK || !s->octree)
        return status;
    status = join_doubts(context, s->octree, status);
    if (status == CSGM_OK)
        status = join_bounds(context, o->workers, status);
    if (status == CSGM_OK && !o->receiver)
        status = join_mesh(o, status);
    return status;
}

/* An empty mesh in place of one that all ranks have, on all but the first. */
static csgm_status leave_to_first(csgm_context *context, csgm_mesh **mesh)
{
    csgm_mesh *whole = *mesh;
    if (csg_ranks_is_first(context) || !whole->triangle_count)
        return CSGM_OK;
    csgm_status status = csg_mesh_create(context, 0, 0, false, false, mesh);
    if (status == CSGM_OK)
        csg_mesh_destroy(whole);
    else
        *mesh = whole;
    return status;
}

csgm_status csg_mesh_ranks_settle(csgm_context *context, csgm_status own, csgm_mesh **mesh)
{
    bool has_mesh = own == CSGM_OK;
    if (has_mesh && context->ranks)
        own = leave_to_first(context, mesh);
    csgm_status status = csg_ranks_agree(context, own);
    if (has_mesh && status != CSGM_OK) {
        csg_mesh_destroy(*mesh);
        *mesh = NULL;
    }
    return status;
}
