/* SPDX-License-Identifier: MIT
 * See stats.h.
 */
#include "mesh/pipeline/stats.h"

#include <math.h>
#include <string.h>

#include "base/elementary.h"
#include "mesh/pipeline/certify.h"

/* By the size of their cells; a small part begins with smaller ones. */
static void add_blocks(csgm_mesh_stats *sum, const csgm_mesh_stats *part)
{
    const csgm_mesh_stats *both[] = {sum, part};
    double coarsest = fmax(sum->cell_coarsest, part->cell_coarsest);
    uint64_t blocks[CSGM_LEVELS_MOST] = {0};
    for (int k = 0; k < 2; k++) {
        double own = both[k]->cell_coarsest;
        int down = own > 0 ? (int)lround(csg_log2(coarsest / own)) : CSGM_LEVELS_MOST;
        for (int i = 0; i + down < CSGM_LEVELS_MOST; i++)
            blocks[i + down] += both[k]->blocks[i];
    }
    sum->cell_coarsest = coarsest;
    memcpy(sum->blocks, blocks, sizeof blocks);
}

/* A part that keeps its own triangles is where it should be. */
static void add_distances(csgm_mesh_stats *sum, const csgm_mesh_stats *part)
{
    sum->reshape_s += part->reshape_s;
    sum->triangles_before += part->triangles_before;
    if (!part->is_measured)
        return;
    sum->is_measured = true;
    sum->distance_allowed = fmax(sum->distance_allowed, part->distance_allowed);
    sum->max_distance_bound = fmax(sum->max_distance_bound, part->max_distance_bound);
    sum->max_distance_measured = fmax(sum->max_distance_measured, part->max_distance_measured);
    sum->open_places += part->open_places;
}

void csg_mesh_add_stats(csgm_mesh_stats *sum, const csgm_mesh_stats *part)
{
    double nodes = sum->mean_tape_length * (double)sum->leaf_blocks +
                   part->mean_tape_length * (double)part->leaf_blocks;
    sum->octree_s += part->octree_s;
    sum->mesh_s += part->mesh_s;
    sum->own_triangles += part->own_triangles;
    sum->own_triangles_before += part->own_triangles_before;
    if (part->cell_size > 0) {
        sum->cell_size = part->cell_size;
        sum->tolerance = part->tolerance;
        add_blocks(sum, part);
        memcpy(sum->cells, part->cells, sizeof sum->cells);
    }
    sum->cells_visited += part->cells_visited;
    sum->pruned_outside += part->pruned_outside;
    sum->pruned_inside += part->pruned_inside;
    sum->leaf_blocks += part->leaf_blocks;
    sum->point_evaluations += part->point_evaluations;
    sum->gradient_evaluations += part->gradient_evaluations;
    sum->interval_evaluations += part->interval_evaluations;
    sum->primitive_evaluations += part->primitive_evaluations;
    add_distances(sum, part);
    sum->memory_peak_bytes = part->memory_peak_bytes;
    sum->unresolved_cells += part->unresolved_cells;
    csg_mesh_add_certify(&sum->certify, &part->certify);
    sum->feature_vertices += part->feature_vertices;
    sum->smooth_features += part->smooth_features;
    sum->fading_features += part->fading_features;
    if (sum->leaf_blocks)
        sum->mean_tape_length = nodes / (double)sum->leaf_blocks;
}
