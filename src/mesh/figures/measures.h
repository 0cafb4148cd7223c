/* SPDX-License-Identifier: MIT
 * Area, volume and shapes of triangles that come in any order, on any thread: each term is rounded
 * to a multiple of one small step, and multiples are added exactly, so the sums have the same
 * digits in whatever order and groups triangles come.
 *
 * A term of at most 2^b is cut into a multiple of 2^(b - 40) and a rest, which is rounded to a
 * multiple of 2^(b - 80): sums of 256 of either are exact in double, and those of all triangles
 * in integers of 128 bits. With 2^31 triangles the area is wrong by less than 2^-49 of the square
 * of the box's diagonal (and by the rounding of each term), the volume of its cube.
 */
#ifndef CSG_MESH_FIGURES_MEASURES_H
#define CSG_MESH_FIGURES_MEASURES_H

#include "base/geometry.h"
#include "base/int128.h"

enum { CSG_MEASURES_BATCH = 256 };

/* A sum of terms of at most 2^b, in steps of 2^(b - 80). */
typedef struct csg_exact_sum {
    double coarse, fine; /* steps: 2^(b - 40), 2^(b - 80) */
    csg_int128 steps;
} csg_exact_sum;

typedef struct csg_mesh_measures {
    csg_vec3 apex; /* of the tetrahedra whose volumes are summed: small terms, small errors */
    csg_exact_sum area, volume; /* twice, and six times */
    double cotangent, aspect;   /* the largest of all; of the smallest angle */
    uint64_t triangles, flat;   /* flat: without area */
    bool is_broken;             /* a corner is not finite */
    size_t waiting;             /* triangles that are not measured yet: */
    float corner[9][CSG_MEASURES_BATCH];
} csg_mesh_measures;

/* box: around all vertices that triangles use. */
csg_mesh_measures csg_mesh_measures_begin(csg_box box);
void csg_mesh_measures_flush(csg_mesh_measures *measures);
/* What another has measured, too; both began with one box. */
void csg_mesh_measures_add(csg_mesh_measures *measures, csg_mesh_measures *other);
/* area ... max_aspect, zero_area_triangles and bounds, which are those of box moved by origin. */
void csg_mesh_measures_end(csg_mesh_measures *measures, csg_box box, csgm_vec3 origin,
                           csgm_mesh_check *check);

/* One triangle, by its corners' coordinates. */
static inline void csg_mesh_measures_put(csg_mesh_measures *m, const float a[3], const float b[3],
                                         const float c[3])
{
    for (int axis = 0; axis < 3; axis++) {
        m->corner[axis][m->waiting] = a[axis];
        m->corner[3 + axis][m->waiting] = b[axis];
        m->corner[6 + axis][m->waiting] = c[axis];
    }
    if (++m->waiting == CSG_MEASURES_BATCH)
        csg_mesh_measures_flush(m);
}

#endif
