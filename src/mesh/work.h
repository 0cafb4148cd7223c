/* SPDX-License-Identifier: MIT
 * The state of one mesh build, shared by the files of the pipeline: build.c (bounds, lattice, what
 * is said at the end), slabs.c (blocks, counts, numbering), output.c (vertices and triangles to
 * their places), watch.c (progress, cancelling, time limit).
 */
#ifndef CSG_MESH_WORK_H
#define CSG_MESH_WORK_H

#include "mesh/features/features.h"
#include "mesh/pipeline/build.h"

/* A stretch of the octree's frontier, with what comes before it in the numbering. */
typedef struct csg_slab {
    size_t first_cell, end_cell;
    uint64_t vertices, triangles;
} csg_slab;

/* Blocks of slabs already made that slabs still to be made touch from below. */
typedef struct csg_halo {
    csg_arena arena;
    csg_block **blocks;
    size_t count, capacity;
} csg_halo;

/* A run on its way to a receiver. */
typedef struct csg_run_buffer {
    float *positions, *normals;
    uint8_t *colors;
    uint32_t *indices;
    float *corners;
    size_t position_capacity, normal_capacity, color_capacity, index_capacity, corner_capacity;
} csg_run_buffer;

/* One thread's part. */
typedef struct csg_mesh_worker {
    csg_marching_room *room;
    csg_feature_room *features; /* NULL: plain marching cubes */
    float *scratch;
    csg_run_buffer run;
    csg_box bounds; /* of the vertices made, where the solid is clipped */
    uint64_t point_evaluations, gradient_evaluations, primitive_evaluations;
} csg_mesh_worker;

/* What the parts of one mesh have in common, and where in the whole one of them stands. */
typedef struct csg_mesh_share {
    const char *name; /* NULL = the part without a name */
    bool colors, materials;
    csg_vec3 origin;
    double started_s;      /* for the time limit */
    double before, amount; /* of the work: fractions */
} csg_mesh_share;

typedef struct csg_mesh_work {
    csgm_context *context;
    const csg_mesh_share *share; /* NULL = the mesh has one part */
    struct csg_mesh_goal *goal;  /* NULL = the mesh stays as marching cubes make it */
    const csgm_mesh_options *options;
    const csgm_field *field;
    csgm_field *clipped; /* owned, NULL when the bounds cut nothing */
    csg_box bounds;
    csg_lattice lattice;

    csg_octree *octree; /* NULL when there is nothing to mesh */
    csg_slab *slabs;
    size_t slab_count;
    csg_block *const *blocks; /* of the slab at hand */
    size_t block_count;
    csg_halo halo, old_halo;
    csg_block **reachable; /* the slab's blocks and the halo's, where there are several slabs */
    size_t reachable_capacity;
    csg_block_index index;

    csg_feature_store features;
    struct csg_found_item *found; /* of the slab at hand */
    bool split;                   /* a vertex for each sheet at a crease */

    csg_cell_tables tables;
    csg_marching_places places;
    csg_marching marching;
    csg_mesh_counts counts;
    csgm_mesh *mesh; /* NULL when a receiver takes it */
    const csg_mesh_receiver *receiver;
    csg_mesh_worker *workers;
    uint32_t worker_count;
    size_t scratch_floats;

    csgm_certify certify;
    uint64_t unresolved_cells;

    csgm_stage stage;
    double started_s, sampled_s, deadline_s, last_report_s;
    double stage_share, stage_done; /* of the stage: the part at hand, and what is behind */
    atomic_bool timed_out, out_of_memory, refused;
} csg_mesh_work;

enum { CSG_BLOCKS_PER_ITEM = 64 }; /* of parallel loops, and a receiver's run */

static inline size_t csg_mesh_item_count(const csg_mesh_work *work)
{
    return (work->block_count + CSG_BLOCKS_PER_ITEM - 1) / CSG_BLOCKS_PER_ITEM;
}

/* ---- watch.c ----------------------------------------------------------------------------------
 */

bool csg_mesh_should_stop(void *work);                      /* any worker */
void csg_mesh_report_progress(void *work, double fraction); /* of the part at hand */
void csg_mesh_poll(void *work, size_t done, size_t count);  /* a csg_pool_poll */
csgm_status csg_mesh_why_stopped(csg_mesh_work *work);      /* reported where need be */

/* ---- slabs.c ----------------------------------------------------------------------------------
 */

/* Divides the frontier so that a slab's blocks fit into the memory limit, counts every slab and
 * leaves the last one's blocks at hand. */
csgm_status csg_mesh_count_slabs(csg_mesh_work *work);
/* Slabs from the last to the first: a block's upper neighbours come after it in Morton order, so
 * their numbers are known by then. make() finds the slab's blocks at hand. */
csgm_status csg_mesh_each_slab(csg_mesh_work *work, csgm_status (*make)(csg_mesh_work *work));
void csg_mesh_release_slabs(csg_mesh_work *work);

/* ---- creases.c --------------------------------------------------------------------------------
 */

/* Finds the features of the blocks at hand, or, where they are known, looks them up; adds what they
 * are to the blocks' counts. */
csgm_status csg_mesh_find_features(csg_mesh_work *work);
/* After the blocks at hand have their numbers, the first time. */
void csg_mesh_number_features(csg_mesh_work *work);
/* Once all are found. */
csgm_status csg_mesh_link_features(csg_mesh_work *work);

/* ---- parts.c ----------------------------------------------------------------------------------
 */

/* As csg_mesh_build, for one field. */
csgm_status csg_mesh_build_one(csgm_context *context, const csgm_field *field,
                               const csgm_mesh_options *options, const csg_mesh_share *share,
                               csgm_mesh **out, csgm_mesh_stats *stats);
/* The same whatever the options ask of the finished mesh; goal (may be NULL) says it
 * (reshape/tolerance.h). */
csgm_status csg_mesh_build_with(csgm_context *context, const csgm_field *field,
                                const csgm_mesh_options *options, const csg_mesh_share *share,
                                struct csg_mesh_goal *goal, csgm_mesh **out,
                                csgm_mesh_stats *stats);
csgm_status csg_mesh_build_parts(csgm_context *context, const csgm_field *field,
                                 const csgm_mesh_options *options, csgm_mesh **out,
                                 csgm_mesh_stats *stats);
/* Where the floats of a mesh in these bounds have their zero. */
csg_vec3 csg_mesh_origin(csg_vec3 center, csg_box bounds);
static inline csg_vec3 csg_mesh_origin_of(const csg_mesh_work *work)
{
    return work->share ? work->share->origin : csg_mesh_origin(work->field->center, work->bounds);
}
static inline bool csg_mesh_is_colored(const csgm_field *field)
{
    return field->has_colors && field->color_count > 1;
}

/* ---- output.c ---------------------------------------------------------------------------------
 */

/* The workers' room, before anything is counted. */
csgm_status csg_mesh_create_workers(csg_mesh_work *work);
/* Tells the counts to the receiver, or makes the mesh's arrays. */
csgm_status csg_mesh_begin_output(csg_mesh_work *work);
/* Vertices and triangles of the blocks at hand. */
csgm_status csg_mesh_make_blocks(csg_mesh_work *work);
void csg_mesh_release_output(csg_mesh_work *work); /* not the mesh */

#endif
