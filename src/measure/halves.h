/* SPDX-License-Identifier: MIT
 * A solid in a cube as a formula of half spaces: each smooth piece of its field lies between two
 * parallel planes (enclosure.h), and where sharp unions and intersections join such pieces, or a
 * primitive's faces meet, the solid is the union or intersection of theirs. So a crease costs no
 * more than a smooth face.
 */
#ifndef CSG_MEASURE_HALVES_H
#define CSG_MEASURE_HALVES_H

#include "measure/enclosure.h"
#include "mesh/distance/slopes.h"

enum {
    CSG_HALVES_MOST = 8, /* planes */
    CSG_HALVES_CODE = 2 * CSG_HALVES_MOST,
    CSG_HALVES_UNION = -1,
    CSG_HALVES_INTERSECTION = -2
};

typedef struct csg_halves {
    csg_enclosure planes[CSG_HALVES_MOST];
    signed char code[CSG_HALVES_CODE]; /* postfix: planes' indices and operators */
    int plane_count, length;
} csg_halves;

/* What is known of a formula, or of a plane, all over a region. */
typedef enum csg_truth { CSG_TRUTH_NO, CSG_TRUTH_YES, CSG_TRUTH_OPEN } csg_truth;

/* For a tape that is valid in the ball around the cube; c has no rounding as floats. False: nothing
 * is known. scratch: as the kernel needs it. */
bool csg_halves_find(const csg_kernel *kernel, const csg_tape *tape, const double c[3], double half,
                     float *scratch, size_t scratch_floats, csg_halves *out);

/* Is the zero set of a node's join that of its operands, or parts of it: is it sharp, or an
 * orthogonal one that no offset rounds? */
bool csg_halves_joins_sharply(const csg_tape *tape, const csg_tape_node *node);

csg_truth csg_halves_evaluate(const csg_halves *halves, const csg_truth planes[CSG_HALVES_MOST]);

/* The same, and how far each piece's gradients stray from its plane's slope, wherever that can be
 * told, which is not for nothing. */
bool csg_halves_find_with_strays(const csg_kernel *kernel, const csg_tape *tape, const double c[3],
                                 double half, float *scratch, size_t scratch_floats,
                                 csg_halves *out);

/* In the cube: YES all of it is on the positive side of the plane, NO none of it is. */
csg_truth csg_halves_state_of_plane(const csg_enclosure *plane, double half);

/* In the cube: YES it is all inside, NO it is all outside. */
csg_truth csg_halves_state(const csg_halves *halves, double half);

#endif
