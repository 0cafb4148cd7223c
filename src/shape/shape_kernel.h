/* SPDX-License-Identifier: MIT
 * What of the shapes is built once per instruction set: searches for several points at once. All
 * builds find the same, to the bit.
 */
#ifndef CSG_SHAPE_KERNEL_H
#define CSG_SHAPE_KERNEL_H

#include "shape/plane/region_tree.h"
#include "shape/polyhedra/tree.h"

enum { CSG_SHAPE_LANES = 8 };

/* hits[l] is csg_segment_nearest_of(tree, list, x[l], y[l]) for each of CSG_SHAPE_LANES points. */
typedef void csg_nearest_segments_fn(const csg_segment_tree *tree, csg_segment_list list,
                                     const double *x, const double *y, csg_segment_hit *hits);
/* hits[l] is csg_tree_nearest_of(tree, parts, points[l], hint) for the first `used` of
 * CSG_SHAPE_LANES points at least. */
typedef void csg_nearest_triangles_fn(const csg_tree *tree, const csg_tree_parts *parts,
                                      const csg_vec3 *points, size_t used, uint32_t hint,
                                      csg_triangle_hit *hits);

typedef struct csg_shape_kernel {
    csg_nearest_segments_fn *nearest_segments;
    csg_nearest_triangles_fn *nearest_triangles;
} csg_shape_kernel;

extern const csg_shape_kernel csg_shape_kernel_scalar;

/* Within one of the builds: its functions' names, and how many doubles a register holds. Vectors
 * must not be wider: gcc 12 takes comparisons of such ones apart, lane by lane. */
#ifdef CSG_KERNEL
#if defined(__AVX512F__)
enum { CSG_SHAPE_WIDTH = 8 };
#elif defined(__AVX__)
enum { CSG_SHAPE_WIDTH = 4 };
#else
enum { CSG_SHAPE_WIDTH = 2 };
#endif
#define CSG_SHAPE_BUILD__(name, kernel) name##_##kernel
#define CSG_SHAPE_BUILD_(name, kernel) CSG_SHAPE_BUILD__(name, kernel)
#define CSG_SHAPE_BUILD(name) CSG_SHAPE_BUILD_(name, CSG_KERNEL)
csg_nearest_segments_fn CSG_SHAPE_BUILD(csg_nearest_segments);
csg_nearest_triangles_fn CSG_SHAPE_BUILD(csg_nearest_triangles);
#endif

#endif
