/* SPDX-License-Identifier: MIT
 * One pool of worker threads. Work is claimed item by item in index order; the calling thread
 * takes part as worker 0, and alone runs `poll` between its items.
 */
#ifndef CSG_BASE_POOL_H
#define CSG_BASE_POOL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/memory.h"

typedef struct csg_pool csg_pool;
typedef struct csg_trace_lanes csg_trace_lanes;

/* threads >= 1. NULL on failure. With fewer threads than asked for when the system has no more. */
csg_pool *csg_pool_create(csg_memory *memory, uint32_t threads);
void csg_pool_destroy(csg_pool *pool); /* NULL is a no-op */
uint32_t csg_pool_threads(const csg_pool *pool);
/* Ends the workers; the next run starts them anew, as many as the system has. */
void csg_pool_rest(csg_pool *pool);
/* From now on each worker's part of a loop is a zone (trace.h). */
void csg_pool_set_trace(csg_pool *pool, csg_trace_lanes *lanes);

/* Work on item `index` as worker `worker` (< csg_pool_threads). False = stop everything. */
typedef bool csg_pool_work(void *user, uint32_t worker, size_t index);
/* On the calling thread between items; done counts finished items. */
typedef void csg_pool_poll(void *user, size_t done, size_t count);

/* Runs work for every index in [0, count), any order across workers; returns when all are done.
 * False when some work returned false; items not yet begun are then skipped. poll may be NULL. */
bool csg_pool_run(csg_pool *pool, size_t count, csg_pool_work *work, csg_pool_poll *poll,
                  void *user);

#endif
