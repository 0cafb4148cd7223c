/* SPDX-License-Identifier: MIT
 * Adapter to the Clipper library: loops of whole numbers in, loops of whole numbers out. Plain
 * types only, for C and C++; no exception crosses it. polygons.c is its only user.
 */
#ifndef CSG_SHAPE_CLIPPER_H
#define CSG_SHAPE_CLIPPER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "csgmesh/csgmesh.h"
#include "shape/plane/polygons_terms.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct csg_clipper_point {
    int64_t x, y; /* quickest below 2^30, wrong above 2^62 */
} csg_clipper_point;

typedef struct csg_clipper_loops {
    const csg_clipper_point *points;
    const uint32_t *ends; /* per loop, into points */
    size_t loop_count;
} csg_clipper_loops;

/* Takes one loop of a result; false: out of memory, and no more come. */
typedef bool csg_clipper_take(void *user, const csg_clipper_point *points, size_t count);

bool csg_clipper_available(void);
/* CSGM_ERR_MEMORY, CSGM_ERR_UNSUPPORTED: built without the library. */
csgm_status csg_clipper_combine(csg_polygons_op op, csg_fill fill, const csg_clipper_loops *a,
                                const csg_clipper_loops *b, csg_clipper_take *take, void *user);
csgm_status csg_clipper_offset(const csg_clipper_loops *in, double by, csg_corner corner,
                               double arc_tolerance, csg_clipper_take *take, void *user);

#ifdef __cplusplus
}
#endif

#endif
