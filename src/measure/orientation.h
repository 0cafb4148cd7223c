/* SPDX-License-Identifier: MIT
 * Three directions at right angles along which a solid is small: the axes of a box around it. All
 * that is asked of the solid is how far it reaches.
 */
#ifndef CSG_MEASURE_ORIENTATION_H
#define CSG_MEASURE_ORIENTATION_H

#include "measure/extent.h"

enum { CSG_BOX_FACES = 6 /* along each axis backwards, then along each forwards */ };

/* How far the solid reaches along unit vectors; each known to the tolerance, a length, where that
 * can be. Not CSGM_OK: stopped, and reported. */
typedef csgm_status csg_reacher(void *user, const csg_vec3 *directions, size_t count,
                                double tolerance, csg_support_point *out);

typedef struct csg_orientation {
    csg_vec3 axes[3]; /* of unit length, at right angles */
    csg_support_point reaches[CSG_BOX_FACES];
} csg_orientation;

/* size: of the solid, a length. *out is filled in any case, as well as could be done. */
csgm_status csg_orientation_find(csg_memory *memory, csg_reacher *reach, void *user, double size,
                                 double tolerance, csg_orientation *out);

#endif
