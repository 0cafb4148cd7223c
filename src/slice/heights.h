/* SPDX-License-Identifier: MIT
 * Where layers begin and end: all of one height, or each as high as the cusp allows that it leaves
 * (Dolenc and Makela, Slicing procedures for layered manufacturing techniques, Computer-Aided
 * Design 26, 1994): a layer of height h with upright sides stands off a surface of normal n by
 * h |n_z|, or falls short of it by that.
 */
#ifndef CSG_SLICE_HEIGHTS_H
#define CSG_SLICE_HEIGHTS_H

#include "csgmesh/slicing.h"
#include "mesh/watch.h"

typedef struct csg_slice_heights {
    double *ends; /* scene units: layer i is from ends[i] to ends[i + 1] */
    size_t count, capacity;
    double lowest, highest; /* of layers' heights */
    uint64_t sampled;       /* cubes whose |n_z| is sampled, not bounded */
    double edge;            /* of these */
} csg_slice_heights;

/* From the bottom of the field's bounds, which are finite, to their top at least. CSGM_OK, or why
 * not (reported); release in any case. */
csgm_status csg_slice_heights_find(csg_slice_heights *heights, csgm_context *context,
                                   const csgm_field *field, csg_mesh_watch *watch,
                                   const csgm_slice_options *options);
void csg_slice_heights_release(csg_slice_heights *heights, csg_memory *memory);

#endif
