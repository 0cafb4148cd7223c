/* SPDX-License-Identifier: MIT
 * Curves on their way into the tape: cut into gentle pieces, which are leaves of their own below a
 * sharp union, so that pruning drops those that are far away; and their polynomials packed.
 *
 * Gentle: the control polygon's sides, in four dimensions with the radius, turn little and differ
 * little in length. What the kernels look for in such a piece they find (curve_kernel.c).
 */
#ifndef CSG_FIELD_COMPILE_CURVE_H
#define CSG_FIELD_COMPILE_CURVE_H

#include "field/compile/compile_leaf.h"
#include "scene/primitives/curve.h"

enum { CSG_CURVE_MOST_PIECES = 64 };

/* The gentle pieces, in order; returns how many. */
size_t csg_curve_cut(const csg_curve *curve, csg_curve pieces[CSG_CURVE_MOST_PIECES]);
/* Own parameters, frame and magnitude of a piece of a curve; place and k: as csg_leaf_primitive has
 * them, where lengths of the curve's frame are k times as long in the scene, or 1 = not similar. */
void csg_curve_pack(csg_leaf *leaf, const csg_curve *piece, const csg_affine *place, bool similar,
                    double k);

#endif
