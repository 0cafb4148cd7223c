/* SPDX-License-Identifier: MIT
 * A mesh towards a goal: it is thinned out as far as the error allows (decimate.h), improved where
 * that is asked for (improve.h), and then held against the field (distance/check.h) and mended
 * where that fails (refine.h). What is still open asks for another try of equal cells
 * (pipeline/tries.h), more carefully and, if the resolution is free, more finely.
 */
#ifndef CSG_MESH_RESHAPE_TOLERANCE_H
#define CSG_MESH_RESHAPE_TOLERANCE_H

#include "mesh/distance/missed.h"
#include "mesh/reshape/far.h"
#include "mesh/reshape/joined.h"

/* What is wanted of one field's mesh, and what came of it. */
typedef struct csg_mesh_goal {
    double error;       /* 0: as `share` has it, or nothing is taken away */
    double share;       /* of the triangles that may stay; 0: as few as `error` allows */
    uint64_t triangles; /* that may stay, in place of `share`; errors then grow from `error` on */
    bool proves;        /* the error holds everywhere, or it is said where not; else of samples */
    bool improve;
    bool sharp;           /* creases are kept */
    bool chooses;         /* the cell size */
    bool follows;         /* the shape, with its cells */
    bool is_own;          /* it begins with the triangles of polyhedra: it is the surface */
    csgm_mesh *own;       /* these, for the next try, which takes them over; NULL: none */
    const csg_seen *seen; /* what the judge of its cells saw beside their triangles; NULL: nobody
                             was asked */
    csg_joined *joined; /* the mesh was thinned out in tiles: their samples and kinds; else NULL */
    double finer;       /* of the error: what these are made for */
    double asked;       /* the error before it was raised, since it took too many cells */
    csgm_normals normals; /* of the result */
    double care;          /* of the error: what changes may make, so that the proof has room */
    double started_s;     /* for the time limit of all tries */
    uint32_t tries;       /* before this one */
    bool looks_closer;    /* cells can still be divided around single places */
    bool is_last;
    /* results */
    double cell_size;    /* > 0: the mesh is not good enough, try again with these cells */
    csg_far_places away; /* where cells follow the shape: the places that asked for it, this time
                            and before */
    csg_missed_before before; /* then, how they were found. Whoever makes the cells releases both */
    double allowed, measured, bound, reshape_s; /* bound: INFINITY where nothing is proven */
    uint64_t begun, open;
    uint64_t unfinished; /* stretches of the surface that were too intricate to look through */
    csg_vec3 place;      /* of what is open, scene units */
    bool unproven;       /* it would have taken too long: measured only */
    bool tight;          /* `share` was out of reach */
} csg_mesh_goal;

/* Whether a number of triangles is asked for, and not an error alone. */
static inline bool csg_mesh_goal_has_count(const csg_mesh_goal *goal)
{
    return goal->triangles || goal->share > 0;
}
/* What changes may make of the error, and how far a new vertex may be from the surface: csg_remesh
 * and csg_decimation have them. */
double csg_mesh_goal_error(const csg_mesh_goal *goal);
double csg_mesh_goal_farthest(const csg_mesh_goal *goal);

/* Thins out and improves *mesh as the goal says, as marching made it; its blocks are at hand. *mesh
 * is then another one, unless the goal asks for another try. */
csgm_status csg_mesh_reshape(csg_mesh_goal *goal, csgm_mesh **mesh, const csg_marching *marching,
                             csg_mesh_watch *watch);

#endif
