/* SPDX-License-Identifier: MIT
 * Adapter to the Manifold library, for booleans.c. Plain types only, for C and C++; no exception
 * crosses it.
 */
#ifndef CSG_SHAPE_MANIFOLD_H
#define CSG_SHAPE_MANIFOLD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "csgmesh/csgmesh.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum csg_boolean_kind {
    CSG_BOOLEAN_LEAF,
    CSG_BOOLEAN_UNION,
    CSG_BOOLEAN_INTERSECTION,
    CSG_BOOLEAN_DIFFERENCE /* the first operand without the others */
} csg_boolean_kind;

typedef struct csg_manifold_step {
    csg_boolean_kind kind;
    size_t point_count, triangle_count; /* of a leaf */
    uint32_t mark;                      /* of a leaf, below 2^31: its triangles keep it */
    const uint32_t *operands;           /* of an operator: `count` numbers of earlier steps */
    uint32_t count;
} csg_manifold_step;

/* What the caller does. give_*: point and triangle number i of a leaf. should_stop is asked from
 * another thread until the result is there. Where take_* return false there is no memory. */
typedef struct csg_manifold_caller {
    void (*give_point)(void *user, size_t step, size_t i, double at[3]);
    void (*give_triangle)(void *user, size_t step, size_t i, uint32_t corners[3]);
    bool (*should_stop)(void *user);
    bool (*take_point)(void *user, const double at[3]);
    bool (*take_triangle)(void *user, const uint32_t corners[3], uint32_t mark);
    void *user;
} csg_manifold_caller;

bool csg_manifold_is_available(void);
/* As csg_booleans, of which this is the work; no memory is asked for before. */
csgm_status csg_manifold_run(const csg_manifold_step *steps, size_t count, double tolerance,
                             const csg_manifold_caller *caller);

#ifdef __cplusplus
}
#endif

#endif
