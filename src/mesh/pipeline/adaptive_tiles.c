/* SPDX-License-Identifier: MIT
 * Tile after tile, each on all threads; see adaptive_tiles.h.
 */
#include "mesh/pipeline/adaptive_tiles.h"

#include "base/trace.h"
#include "mesh/adaptive/extract.h"
#include "mesh/adaptive/tiles.h"
#include "mesh/adaptive/unsure.h"
#include "mesh/pipeline/paint.h"

/* What a brick's triangles take while they are made and thinned out, at most: eleven of them in the
 * lattice with most, at 36 bytes and 350 more for each vertex, and what finds vertices by place. */
enum { BYTES_PER_BRICK = 4096, LEAST_BRICKS = 256 };
/* Of the limit: what all of it may take, and what a tile may. */
enum { WHOLE_SHARE = 2, TILE_SHARE = 16 };

/* What a vertex that is left takes when all tiles are there, with its two triangles, at least, and
 * more than before: places, neighbours and quadrics. */
enum { LEAST_BYTES_PER_VERTEX = 128 };

size_t csg_mesh_tile_bricks(const csg_bricks *b, const csg_mesh_goal *goal, uint64_t limit_bytes)
{
    uint64_t leaves = 0;
    for (size_t i = 0; i < b->count; i++)
        leaves += csg_brick_has_leaves(&b->items[i]);
    if (!limit_bytes || csg_mesh_goal_has_count(goal) || !(goal->error > 0) ||
        leaves * BYTES_PER_BRICK <= limit_bytes / WHOLE_SHARE)
        return 0;
    uint64_t most = limit_bytes / TILE_SHARE / BYTES_PER_BRICK;
    return most > LEAST_BRICKS ? (size_t)most : LEAST_BRICKS;
}

/* Whether places near which the judge was not sure of the surface are near all tiles together. */
static csgm_status look_for_unsure(csg_extraction *x, const csg_tiles *tiles, bool *any)
{
    CSG_ZONE(x->context, "unsure places");
    csg_unsure unsure;
    csgm_status status = csg_unsure_begin(x, &unsure);
    *any = false;
    if (status != CSGM_OK)
        return status;
    for (size_t i = 0; i < tiles->count && unsure.count && status == CSGM_OK; i++) {
        const csg_tile *tile = &tiles->items[i];
        csg_extracted_part part;
        status = csg_extract_part(x, tiles->leaves + tile->first, tile->count, &part);
        if (status == CSGM_OK)
            csg_unsure_look(x, &unsure, part.mesh);
        csg_extracted_part_release(&part);
    }
    x->smooth = 0; /* it is counted when they are made */
    *any = csg_unsure_end(x, &unsure);
    return status;
}

static csgm_status add_tile(const csg_mesh_input *input, const csg_marching *marching,
                            const csg_mesh_goal *goal, csg_extraction *x, const csg_tiles *tiles,
                            const csg_tile *tile)
{
    csg_extracted_part part;
    x->watch->stage = CSGM_STAGE_MESH;
    csgm_status status = csg_extract_part(x, tiles->leaves + tile->first, tile->count, &part);
    if (status != CSGM_OK)
        return status;
    part.mesh->origin = csg_mesh_origin_of(input);
    status = csg_mesh_paint(input, marching, x->watch, part.mesh);
    const csg_tile_mesh mesh = {.mesh = part.mesh,
                                .places = part.places,
                                .creases = part.creases,
                                .seen = goal->seen,
                                .low = tile->box.min,
                                .high = tile->box.max,
                                .error = csg_mesh_goal_error(goal),
                                .farthest = csg_mesh_goal_farthest(goal),
                                .share = 0.5 / (double)tiles->count};
    if (status == CSGM_OK)
        status = csg_joined_add(goal->joined, &mesh, marching, x->watch);
    csg_extracted_part_release(&part);
    return status;
}

/* Cells of some of the leaves that the surface crosses. */
static uint64_t crossed_cells(const csg_bricks *b, const uint32_t *leaves, size_t count)
{
    uint64_t cells = 0;
    for (size_t i = 0; i < count; i++) {
        const csg_brick *brick = &b->items[leaves[i]];
        cells += (uint64_t)__builtin_popcount((unsigned)(brick->crossed & ~brick->divided));
    }
    return cells;
}

/* Compares what is certain to be needed with the limit, before each tile: the work on those before
 * would be for nothing. cells: of tiles to come. They have a sample for each vertex; a bead has six
 * in eight cells, and nothing has fewer. */
static csgm_status check_room(const csg_extraction *x, const csg_joined *joined, uint64_t cells)
{
    const csg_memory *memory = &x->context->memory;
    const csg_begun_samples *s = &joined->samples;
    uint64_t spare = s->vertex_capacity - s->vertex_count + s->block_count * CSG_SAMPLES_OF_BLOCK -
                     s->other_count;
    uint64_t needed = atomic_load(&memory->used_bytes) - spare * sizeof(csg_surface_sample) +
                      cells / 8 * 6 * sizeof(csg_surface_sample);
    uint64_t found = csg_arena_bytes(&x->judge->kept); /* is forgotten before what is left begins */
    uint64_t left = (uint64_t)joined->vertex_count * LEAST_BYTES_PER_VERTEX;
    needed += left > found ? left - found : 0;
    return needed <= memory->limit_bytes ? CSGM_OK : csg_context_needs_memory(x->context, needed);
}

static csgm_status join_tiles(const csg_mesh_input *input, const csg_marching *marching,
                              const csg_mesh_goal *goal, csg_extraction *x, const csg_tiles *tiles)
{
    CSG_ZONE(x->context, "tiles");
    uint64_t cells = crossed_cells(x->bricks, tiles->leaves, tiles->leaf_count);
    csgm_status status = check_room(x, goal->joined, cells);
    for (size_t i = 0; i < tiles->count && status == CSGM_OK; i++) {
        const csg_tile *tile = &tiles->items[i];
        status = add_tile(input, marching, goal, x, tiles, tile);
        cells -= crossed_cells(x->bricks, tiles->leaves + tile->first, tile->count);
        if (status == CSGM_OK)
            status = check_room(x, goal->joined, cells);
    }
    return status;
}

csgm_status csg_mesh_make_tiles(const csg_mesh_input *input, const csg_marching *marching,
                                const csg_mesh_goal *goal, csg_extraction *x, size_t most_bricks,
                                bool *any)
{
    csg_tiles tiles;
    *any = false;
    csgm_status status = csg_tiles_make(x->bricks, most_bricks, &tiles)
                             ? CSGM_OK
                             : csg_context_no_memory(x->context);
    if (status == CSGM_OK)
        status = look_for_unsure(x, &tiles, any);
    if (status == CSGM_OK && !*any)
        status = join_tiles(input, marching, goal, x, &tiles);
    csg_tiles_release(&tiles);
    return status;
}
