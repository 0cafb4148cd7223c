/* SPDX-License-Identifier: MIT
 * Distances from one mesh to the other: at its points, and at samples spread evenly over its area
 * for what is an average.
 */
#ifndef CSG_DIFF_DISTANCES_H
#define CSG_DIFF_DISTANCES_H

#include "diff/side.h"

/* Fills distance and nearest of both sides; both have trees. CSGM_ERR_MEMORY is reported. */
csgm_status csg_diff_measure_points(csg_diff_pair *pair);

/* Samples of a side's surface: number i lies where (i + 1/2) / count of the area is passed, at a
 * place in its triangle that a sequence of low discrepancy says (Roberts 2018, R2). */
typedef struct csg_diff_sampler {
    const csg_diff_side *side;
    double *area_before; /* of each triangle, and the whole at the end */
    uint64_t count;
} csg_diff_sampler;

typedef struct csg_diff_sample {
    csg_vec3 at; /* frame units */
    size_t triangle;
    double weights[3]; /* of its corners; their sum is 1 */
} csg_diff_sample;

/* Takes memory from the side's arena. False: out of memory, not reported. */
bool csg_diff_sampler_make(csg_diff_sampler *sampler, csg_diff_side *side, uint64_t count);
/* The triangle of sample `index`; hint: one at or before it. */
size_t csg_diff_sampler_find(const csg_diff_sampler *sampler, uint64_t index);
csg_diff_sample csg_diff_sampler_get(const csg_diff_sampler *sampler, uint64_t index, size_t hint);

/* Samples side `from`; fills the averages of *out. When colours are given (both sides have some and
 * they shall be compared) *colors too. Also the largest sample, as a place in frame units. */
csgm_status csg_diff_measure_samples(csg_diff_pair *pair, int from, uint64_t count,
                                     csgm_diff_distance *out, csgm_diff_attribute *colors,
                                     csgm_diff_place *largest);

/* The places of `out->worst` behind the first: the farthest points apart from each other. */
void csg_diff_find_worst(const csg_diff_pair *pair, int from, csgm_diff_distance *out);

#endif
