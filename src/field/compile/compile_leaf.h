/* SPDX-License-Identifier: MIT
 * A primitive on its way into the tape: its place, its sizes, its rounding error.
 *
 * A similarity keeps distances, so its scale goes into the primitive's sizes and only a rotation
 * or an offset stays to be done per point; other maps keep the primitive in its own frame and scale
 * its value by the smallest singular value (scene.h).
 */
#ifndef CSG_FIELD_COMPILE_LEAF_H
#define CSG_FIELD_COMPILE_LEAF_H

#include "field/tape.h"

enum { CSG_LEAF_MOST_PARAMETERS = CSG_LEAF_OWN_AFFINE + CSG_LEAF_MOST_OWN };

/* Frame and offset of a leaf whose own frame lies at `place` (relative to the field's centre). */
void csg_leaf_place(csg_leaf *leaf, const csg_affine *place);
/* A placed primitive; of a curve a gentle piece (compile_curve.h). factor: product of its
 * ancestors' smallest singular values. */
void csg_leaf_primitive(csg_leaf *leaf, const csg_affine *place, double factor, bool negate,
                        csg_primitive_kind kind, const double *parameters);
/* The leaf's parameters as tape.h lays them out; returns how many. */
size_t csg_leaf_pack(const csg_leaf *leaf, uint32_t color, float values[CSG_LEAF_MOST_PARAMETERS]);
/* The same as doubles, as csg_tape_exact has them. */
size_t csg_leaf_numbers(const csg_leaf *leaf, double values[CSG_LEAF_MOST_PARAMETERS]);

#endif
