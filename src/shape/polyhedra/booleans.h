/* SPDX-License-Identifier: MIT
 * Sharp unions, intersections and differences of polyhedra, triangle by triangle, by the Manifold
 * library (manifold.cc): what lies on the boundary of the result is cut out of the operands'
 * triangles, and triangles in one plane are those of one face again.
 */
#ifndef CSG_SHAPE_BOOLEANS_H
#define CSG_SHAPE_BOOLEANS_H

#include "base/geometry.h"
#include "shape/polyhedra/manifold.h"
#include "shape/polyhedra/triangles.h"

/* A leaf, or an operator on results of earlier steps. */
typedef struct csg_boolean_step {
    csg_boolean_kind kind;
    const csg_triangles *triangles; /* of a leaf: closed and outward, before it is placed */
    csg_affine place;               /* of a leaf */
    uint32_t mark;                  /* of a leaf, below 2^31: its triangles keep it */
    const uint32_t *operands;       /* of an operator: `count` numbers of earlier steps */
    uint32_t count;
} csg_boolean_step;

/* Who waits for the result; asked from another thread until it is there. */
typedef struct csg_boolean_watch {
    bool (*should_stop)(void *user);
    void *user;
} csg_boolean_watch;

/* Triangles, and the mark of each. */
typedef struct csg_marked_triangles {
    csg_triangles triangles;
    uint32_t *marks;
    size_t mark_room;
} csg_marked_triangles;

void csg_marked_triangles_release(csg_marked_triangles *marked);

/* The last step's result, which may have no triangles; places within `tolerance` of each other may
 * become one, and triangles of one plane and mark. *out is initialised in any case, and to be
 * released. CSGM_ERR_SCENE: a leaf is not a closed manifold.
 * CSGM_ERR_MEMORY, not reported; CSGM_CANCELLED: watch said so. CSGM_ERR_UNSUPPORTED: built
 * without the library. The result does not depend on chance. */
csgm_status csg_booleans(csg_memory *memory, const csg_boolean_step *steps, size_t count,
                         double tolerance, const csg_boolean_watch *watch,
                         csg_marked_triangles *out);
/* Was the program built with the library? */
bool csg_booleans_are_available(void);

#endif
