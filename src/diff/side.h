/* SPDX-License-Identifier: MIT
 * The two meshes of a comparison, made comparable: corners at one place are one point, of both
 * meshes in one numbering and one frame (shape/polyhedra/frame.h); each mesh has its tree of boxes,
 * its figures, and bounds of what rounding does to distances.
 */
#ifndef CSG_DIFF_SIDE_H
#define CSG_DIFF_SIDE_H

#include <stdatomic.h>

#include "base/clock.h"
#include "base/context.h"
#include "shape/polyhedra/cover.h"

/* A mesh may be looked at with another axis up. */
typedef enum csg_diff_turn {
    CSG_DIFF_AS_IT_IS,
    CSG_DIFF_Y_UP_TO_Z_UP, /* (x, y, z) -> (x, -z, y) */
    CSG_DIFF_Z_UP_TO_Y_UP  /* (x, y, z) -> (x, z, -y) */
} csg_diff_turn;

typedef struct csg_diff_side {
    const csgm_mesh_view *view;
    csg_diff_turn turn;
    csg_arena arena;
    uint32_t *point_of;  /* per vertex of the view */
    csg_triangles chain; /* frame units; its points are those of both sides. Same order of triangles
                            as in the view; empty: no tree */
    uint32_t *points;    /* the ones that this side's triangles use, in order of first use */
    size_t point_count;
    csg_tree tree;
    csg_across *across; /* per triangle of the tree, by csg_diff_pair_link */
    double slack;       /* frame units: distances to this mesh are computed so exactly */
    csgm_mesh_check check;
    bool is_closed;
    /* By csg_diff_measure_points: of each of `points` to the other mesh, indexed by point. */
    double *distance;
    uint32_t *nearest; /* place in the other's tree */
} csg_diff_side;

/* Of the comparison as a whole: steps of which nobody knows how many come. */
typedef struct csg_diff_progress {
    double before, share; /* the steps behind, and the one at hand */
    double last_report_s;
    double told; /* what was last reported: it never falls */
} csg_diff_progress;

typedef struct csg_diff_pair {
    csgm_context *context;
    csg_diff_side sides[2]; /* A, B */
    csg_arena arena;        /* of what both share */
    csg_vec3 *points;       /* scene units until the frame is known, then frame units */
    size_t point_count;
    csg_triangle_frame frame;
    csg_box box;      /* of both, scene units */
    double precision; /* frame units: csgm_diff_report.precision */
    const csgm_monitor *monitor;
    csg_diff_progress progress;
    double deadline_s; /* 0: there is none */
    atomic_bool *timed_out;
} csg_diff_pair;

/* may_turn_b: B is turned as csg_diff_find_turn says. Sides are released by csg_diff_pair_release
 * whatever the status. */
csgm_status csg_diff_pair_make(csg_diff_pair *pair, csgm_context *context, const csgm_mesh_view *a,
                               const csgm_mesh_view *b, bool may_turn_b);
/* Trees and figures; only the figures when `with_trees` is false. */
csgm_status csg_diff_pair_prepare(csg_diff_pair *pair, bool with_trees);
/* Who is across each edge, of both sides, which have trees; once. False: out of memory. */
bool csg_diff_pair_link(csg_diff_pair *pair);
void csg_diff_pair_release(csg_diff_pair *pair);

csg_vec3 csg_diff_turned(csg_diff_turn turn, csg_vec3 p);
/* A vertex of the view in scene units, turned. */
csg_vec3 csg_diff_vertex(const csg_diff_side *side, uint64_t vertex);
/* The turn of B in which its bounds and the spread of its area are most like A's; sound views. */
csg_diff_turn csg_diff_find_turn(const csgm_mesh_view *a, const csgm_mesh_view *b);

/* The next step is `part` of what is left of the comparison. */
void csg_diff_take(csg_diff_pair *pair, double part);
/* Of the step at hand, on the calling thread. */
void csg_diff_tell(csg_diff_pair *pair, size_t done, size_t count);

static inline bool csg_diff_is_cancelled(const csg_diff_pair *pair)
{
    if (pair->deadline_s > 0 && csg_clock_now_s() > pair->deadline_s) {
        atomic_store(pair->timed_out, true);
        return true;
    }
    return csg_context_is_cancelled(pair->context) ||
           (pair->monitor->cancelled && pair->monitor->cancelled(pair->monitor->user));
}

/* A triangle's corner in frame units. */
static inline csg_vec3 csg_diff_corner(const csg_diff_side *side, size_t triangle, int corner)
{
    return side->chain.points[side->chain.corners[triangle][corner]];
}

/* 1 inside the mesh, 0 outside; the mesh is closed. */
bool csg_diff_is_inside(const csg_diff_side *side, csg_vec3 p);

#endif
