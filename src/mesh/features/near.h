/* SPDX-License-Identifier: MIT
 * Which triangles of features reach into which cells, and which of them meet: exactly, in the
 * floats of the mesh. Most triangles stay within their cell, or go to the apex next door through
 * the face between both: they can meet only what is in these cells. The rest is entered into every
 * cell that its box touches, and meets what marching cubes makes there too.
 */
#ifndef CSG_MESH_FEATURES_NEAR_H
#define CSG_MESH_FEATURES_NEAR_H

#include <stdatomic.h>

#include "mesh/features/cell.h"
#include "mesh/features/exact.h"
#include "mesh/features/features.h"

/* In the mesh's frame. */
typedef struct csg_near_box {
    float low[3], high[3];
} csg_near_box;

typedef struct csg_near_triangle {
    csg_exact_triangle shape; /* vertices: numbers of this search */
    csg_near_box box;         /* around it */
    uint32_t owner[2]; /* features; one twice where it is one's alone, NONE: of a smooth polygon */
    uint32_t fan[2]; /* its owners' apexes, where they have a fan in which nothing meets; else 0 */
    bool own;        /* of the block at hand */
    bool far;        /* reaches out of its cell, and not only to the apex next door */
    bool plain; /* no vertex has moved; with the feature's apex, or none; and with one next door
                   only if it has a corner in the face between */
} csg_near_triangle;

enum { CSG_NEAR_VIEW = 64 }; /* cells along each axis that a search sees: eight blocks */

/* A cell of marching cubes that was found: several blocks and rounds ask for it. */
typedef struct csg_near_cell {
    uint32_t at[3];
    uint32_t evaluations; /* that it took; counted whenever it is asked for, whoever has found it */
    csg_feature_cell found;
} csg_near_cell;

/* One thread's room. */
typedef struct csg_near_room {
    csg_edges *edges; /* lent, as is scratch */
    float *scratch;
    size_t scratch_floats;
    csg_near_triangle *triangles; /* at hand */
    uint64_t *places, *sorted;    /* cell and triangle, by cells; room for sorting them */
    size_t count, capacity, place_count, place_capacity, sorted_capacity;
    csg_near_cell *cells; /* one for each place in a cube of cells, the last that was asked for */
    size_t cell_capacity;
    uint64_t own_cells[CSG_NEAR_VIEW * CSG_NEAR_VIEW * CSG_NEAR_VIEW / 64]; /* a bit each: the
                                                                   block has triangles there */
    uint64_t evaluations;
} csg_near_room;

typedef struct csg_near {
    csg_feature_store *store;
    const csg_marching *marching; /* shift is that of the mesh */
    const csg_octree *octree;
    csg_memory *memory;
    csg_near_box *boxes; /* of all triangles of each feature */
    atomic_uchar *fans;  /* of each: whether nothing meets around its apex (fan.h), once asked */
} csg_near;

/* The boxes of a block's features; what is known of their fans is forgotten. */
void csg_near_measure(const csg_near *near, size_t block);
/* Around the features of a block, whose boxes are known. */
csg_near_box csg_near_box_of_block(const csg_near *near, size_t block);
/* Whether triangles of a feature, or of one next to it, come near a box; their boxes are known. */
bool csg_near_reaches(const csg_near *near, uint32_t feature, const csg_near_box *box);
/* All triangles that can meet one of the block's; boxes are known. False: out of memory. */
bool csg_near_collect(const csg_near *near, csg_near_room *room, size_t block);

/* Called for two triangles that meet; false: that is enough. */
typedef bool csg_near_found(void *user, const csg_near_triangle *s, const csg_near_triangle *t);
/* What meets of what was collected, at least one of the block's; pairs with a later block's leave
 * that to the earlier one. False: it was enough. */
bool csg_near_search(const csg_near *near, csg_near_room *room, size_t block, csg_near_found *found,
                     void *user);

enum { CSG_NEAR_BLOCKS = 27 };

/* Block k of those around and the block itself; NULL: none with features. */
const csg_feature_block *csg_near_block(const csg_feature_store *store,
                                        const csg_feature_block *block, int k);
/* How far a feature's apex lies outside its cell: cells. */
double csg_near_excess(const csg_near *near, uint32_t feature);
void csg_near_room_release(csg_near_room *room, csg_memory *memory);

#endif
