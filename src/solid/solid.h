/* SPDX-License-Identifier: MIT
 * One piece of work of this layer: what it may use, what went wrong on the way, and the nodes that
 * everything here is made of.
 *
 * Failing: what cannot go on (memory, a limit) sets `stop`; everything then returns at once. What
 * these solids do not allow becomes a reason, the empty solid takes the place of what could not be
 * made, and the work goes on. Nothing is reported here: the caller knows the place in its text and
 * the words for it.
 */
#ifndef CSG_SOLID_SOLID_H
#define CSG_SOLID_SOLID_H

#include "scene/tree/build.h"
#include "shape/plane/outline.h"
#include "shape/polyhedra/polyhedron.h"
#include "shape/polyhedra/triangles.h"

typedef enum csg_solid_fault {
    CSG_SOLID_FAILED,       /* cannot `what`: status */
    CSG_SOLID_UNBOUNDED,    /* the solid has no finite box */
    CSG_SOLID_NO_SURFACE,   /* the solid has no surface */
    CSG_SOLID_NO_AREA,      /* an outline encloses nothing */
    CSG_SOLID_NO_TRIANGLES, /* there are none */
    CSG_SOLID_NO_VOLUME,    /* triangles enclose nothing */
    CSG_SOLID_NO_SUM,       /* the sum of `what` cannot be computed */
    CSG_SOLID_CROSSES_AXIS, /* a figure to revolve reaches from x = range[0] to range[1] */
    CSG_SOLID_BAD_NODE,     /* the builder refused a node, as `problem` says */
    CSG_SOLID_FAULT_COUNT
} csg_solid_fault;

typedef struct csg_solid_reason {
    csg_solid_fault fault;
    csgm_status status;
    const char *what, *hint; /* static storage; hint may be NULL */
    double range[2];
    char problem[160];
} csg_solid_reason;

/* Triangles on the scene's surface, `cells` along the longest side of its bounds; none where it has
 * no surface. Reports nothing. What makes meshes stands below this layer, so the caller hands it
 * in (docs/decisions/0005-tessellation.md). */
typedef csgm_status csg_tessellate(csgm_context *context, const csgm_scene *scene, uint32_t cells,
                                   csg_triangles *out);

typedef struct csg_solid_job {
    csg_scene_builder *builder; /* of the nodes that come in and go out */
    csg_memory *memory;         /* for what is forgotten before the end */
    csg_span where;             /* of the nodes */
    csg_tessellate *tessellate; /* NULL: there is none, and what needs one fails */
    bool sketches;              /* nobody will look at what is made: a hull, a sum or a shadow of
                                   solids may be its box */
    uint64_t most_steps;        /* steps this may take */
    double deadline_s;          /* by csg_clock_now_s; 0: none */

    uint64_t steps; /* taken so far */
    bool stop;
    csgm_status status; /* why stopped: MEMORY or LIMIT (of steps, of time, or the builder's) */
    bool failed;        /* the solids that came in cannot be used */
    csg_solid_reason reasons[CSG_SOLID_FAULT_COUNT]; /* the first of each fault, in order */
    uint32_t reason_count;
    uint64_t clock_steps; /* when the clock was last looked at */
} csg_solid_job;

/* ---- going on or not ------------------------------------------------------------------------- */

void csg_solid_no_memory(csg_solid_job *job);
/* Counts steps of work; false: the job stops. */
bool csg_solid_charge(csg_solid_job *job, uint64_t steps);
/* Before and after what may take long in one step. False: the time is up, the job stops. */
bool csg_solid_check_time(csg_solid_job *job);
/* Notes a reason, unless there is one of its fault. */
void csg_solid_note(csg_solid_job *job, const csg_solid_reason *reason);

/* ---- nodes ----------------------------------------------------------------------------------- */

bool csg_solid_is_empty(const csg_solid_job *job, csg_node_id node);
bool csg_solid_is_flat(const csg_solid_job *job, csg_node_id node); /* false for the empty solid */
/* After every csg_build_*: a node that was refused becomes a reason, and EMPTY. */
csg_node_id csg_solid_done(csg_solid_job *job, csg_node_id node);
csg_node_id csg_solid_empty(csg_solid_job *job);
csg_node_id csg_solid_moved(csg_solid_job *job, csg_node_id node, const csg_affine *by);
/* The child grown by r; as it is where it is empty or r is 0. */
csg_node_id csg_solid_grown(csg_solid_job *job, csg_node_id node, double r);
/* A sharp union. */
csg_node_id csg_solid_union(csg_solid_job *job, const csg_node_id *nodes, size_t count);
/* The region of a clean outline, which is released. */
csg_node_id csg_solid_region(csg_solid_job *job, csg_outline *clean);
/* The area of any outline (released) by the even-odd or the winding rule. */
csg_node_id csg_solid_area(csg_solid_job *job, csg_outline *outline, bool even_odd);
/* The solid of the triangles, which are released. What was mended, unless NULL. */
csg_node_id csg_solid_of_triangles(csg_solid_job *job, csg_triangles *triangles,
                                   csg_repairs *repairs);
/* A failure of csg_polygons_*, csg_hull and the like. `what` completes "cannot ..."; static
 * storage. The empty solid. */
csg_node_id csg_solid_failed(csg_solid_job *job, csgm_status status, const char *what);

#endif
