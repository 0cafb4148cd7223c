/* SPDX-License-Identifier: MIT
 * The shortest segment between two places of a surface that face each other across it: branch and
 * bound over pairs of pieces of the surface, wherever they come from.
 */
#ifndef CSG_WALLS_SEARCH_H
#define CSG_WALLS_SEARCH_H

#include <math.h>

#include "mesh/watch.h"
#include "walls/normals.h"

/* Two points that are shown to face each other so far apart. */
typedef struct csg_wall_shown {
    csg_vec3 at[2];
    double apart; /* INFINITY: none yet */
} csg_wall_shown;

/* A tree of pieces of a surface, known by numbers; 0 is the root. Any of these may find memory
 * short, and says so in *out_of_memory of the task. */
typedef struct csg_wall_source {
    void *user;
    /* No two points of a and b that face each other are nearer; INFINITY: none do. More than
     * `enough` need not be known exactly. line: a direction that may tell; zero: none. */
    double (*bound)(void *user, uint32_t a, uint32_t b, csg_vec3 line, double enough);
    /* False: every segment from a to b leaves what it should run in. */
    bool (*may_see)(void *user, uint32_t a, uint32_t b);
    /* Which of them is divided next: 0, 1, or -1: neither can be. */
    int (*choose)(void *user, uint32_t a, uint32_t b);
    /* Its children are numbered from *first on. */
    bool (*divide)(void *user, uint32_t node, uint32_t *first, uint32_t *count);
    /* Looks for points near a and b that are nearer than the best ones. */
    void (*show)(void *user, uint32_t a, uint32_t b, csg_wall_shown *best);
} csg_wall_source;

typedef struct csg_wall_task {
    csg_wall_source source;
    double tolerance, share; /* it is to be known to the larger of a length and a share of it */
    uint64_t most_pairs;
    csg_memory *memory;
    csg_mesh_watch *watch;
    bool *out_of_memory;
} csg_wall_task;

typedef struct csg_wall_found {
    double low; /* nothing is nearer; INFINITY: nothing faces anything */
    csg_wall_shown best;
    uint64_t pairs;
} csg_wall_found;

/* False: stopped, or out of memory; *out is what is proven by then in any case. */
bool csg_wall_search(const csg_wall_task *task, csg_wall_found *out);

#endif
