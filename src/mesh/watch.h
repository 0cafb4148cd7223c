/* SPDX-License-Identifier: MIT
 * Progress of a mesh build, and what ends it early: the caller's wish, the time limit, no memory,
 * a receiver that takes no more. Every stage gets it, and nothing else of the build with it.
 */
#ifndef CSG_MESH_WATCH_H
#define CSG_MESH_WATCH_H

#include <stdatomic.h>

#include "base/context.h"

typedef struct csg_mesh_watch {
    csgm_context *context;
    const csgm_monitor *monitor;
    double started_s;
    double deadline_s; /* 0: there is none */
    csgm_stage stage;
    double stage_share, stage_done;  /* of the stage: the slab at hand, and those behind it */
    double taken[CSGM_STAGE_COUNT];  /* of each stage: csg_mesh_take */
    bool is_part;                    /* of a mesh with several parts */
    double part_before, part_amount; /* then: fractions of the whole work */
    double told_of_part;             /* the largest fraction */
    double last_report_s;
    double told[CSGM_STAGE_COUNT]; /* the largest fraction of each stage: what is done anew is
                                      not told again */
    atomic_bool timed_out, out_of_memory, refused;
} csg_mesh_watch;

/* The time limit of the context counts from limit_from_s. */
void csg_mesh_watch_begin(csg_mesh_watch *watch, csgm_context *context, const csgm_monitor *monitor,
                          double limit_from_s);

/* What follows is one of several steps of the stage, nobody knows of how many: it is `part` of what
 * is left of it. */
void csg_mesh_take(csg_mesh_watch *watch, csgm_stage stage, double part);

/* These two are callbacks as csg_octree_options has them: user is the watch. The first is for the
 * calling thread, the second for any worker. */
void csg_mesh_report_progress(void *user, double fraction); /* of the slab or step at hand */
bool csg_mesh_should_stop(void *user);

/* Any worker: memory was not to be had. Returns false, for the worker to return. */
bool csg_mesh_stop_without_memory(csg_mesh_watch *watch);
/* What a stage that was stopped ends with; reported where need be. */
csgm_status csg_mesh_why_stopped(csg_mesh_watch *watch);
/* The same of other work than meshing, named as a message begins with it. */
csgm_status csg_mesh_why_work_stopped(csg_mesh_watch *watch, const char *work, const char *hint);
/* Says that what was made is not closed, which is a bug. CSGM_ERR_INTERNAL. */
csgm_status csg_mesh_report_open(csg_mesh_watch *watch);

#endif
