/* SPDX-License-Identifier: MIT
 * How level the surface is, height by height: the largest |n_z| of its normals n in each of many
 * thin stretches of z, which tells how high a layer may be there (heights.h).
 *
 * An octree is walked down to where all gradients of each smooth piece of the field have much the
 * same |n_z|: what is found is no less than the true one. Where gradients have no bounds in the
 * smallest cubes either, the largest of some samples counts, and the cube is told.
 */
#ifndef CSG_SLICE_PROFILE_H
#define CSG_SLICE_PROFILE_H

#include "measure/walk.h"

typedef struct csg_slice_profile {
    double bottom, step; /* stretch i is [bottom + i step, bottom + (i + 1) step], scene units */
    size_t count;
    atomic_uint *most; /* of each the bits of a float from 0 to 1; 0: there is no surface */
    atomic_uint_fast64_t sampled; /* cubes */
    double edge;                  /* of the smallest cubes */
} csg_slice_profile;

/* Stretches a quarter as high as the lowest layer, whose height is `least`, from the bottom of the
 * solid's bounds to their top. Below `lowest` and above `enough` nobody asks how much |n_z| is. The
 * same for any number of threads. CSGM_OK, or why not (reported); release in any case. */
csgm_status csg_slice_profile_find(csg_slice_profile *profile, csgm_context *context,
                                   const csgm_field *field, csg_mesh_watch *watch, double least,
                                   double lowest, double enough);
void csg_slice_profile_release(csg_slice_profile *profile, csg_memory *memory);

/* Of one stretch. */
double csg_slice_profile_at(const csg_slice_profile *profile, size_t index);

#endif
