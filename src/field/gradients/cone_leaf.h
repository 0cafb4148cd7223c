/* SPDX-License-Identifier: MIT
 * The gradients that a leaf of the tape can have in a ball: each primitive states its own
 * (scene/primitives/cone_ball.h), here they are placed.
 */
#ifndef CSG_FIELD_CONE_LEAF_H
#define CSG_FIELD_CONE_LEAF_H

#include "base/geometry.h"
#include "field/gradients/bend_formula.h"
#include "field/tape.h"
#include "scene/primitives/cone_ball.h"

/* Where gradients are asked for: in a ball, a cube with the same centre, and where the field is
 * near to zero. Formulas heed all three, other leaves the ball. */
typedef struct csg_cone_region {
    float c[3];
    double radius;
    double half; /* of the cube's edge; INFINITY: all of the ball */
    double band; /* |f| of the leaf, at most; INFINITY: all */
} csg_cone_region;

/* As csg_cone_add_leaf, of a part of the ball; nothing where the leaf is nowhere within the band.
 */
bool csg_cone_add_leaf_in(csg_cone_balls *balls, const csg_tape *tape, const csg_tape_node *leaf,
                          const csg_cone_region *region);

/* Adds what holds all gradients of a leaf in the ball: they are in the balls' convex hull, or,
 * where faces meet and balls->corner is not 0, combinations with weights >= 0 whose sum is at least
 * 1. False: no bound, or too many. */
bool csg_cone_add_leaf(csg_cone_balls *balls, const csg_tape *tape, const csg_tape_node *leaf,
                       const float c[3], double radius);

/* How a formula's gradient turns in the ball: at c it is within g->spread of g->at, which is
 * rounding, and of any two points no two gradients differ by more than *bend times the distance
 * between them. In a frame that is an offset, the same holds in the cube around the ball. False: it
 * is no formula, or nothing is known. */
bool csg_cone_find_bend(const csg_tape *tape, const csg_tape_node *leaf, const float c[3],
                        double radius, csg_cone_ball *g, double *bend);

/* The same of the pieces that a formula is made of, between its kinks: where these are is told by
 * csg_kink_values(). */
bool csg_cone_find_pieces(const csg_tape *tape, const csg_tape_node *leaf, const float c[3],
                          double radius, csg_formula_pieces *out);

/* What a warp (0: none) makes of a flat triangle with the middle c, within `radius` of it, is so
 * near to a flat one with the same corners. INFINITY: not known. */
double csg_cone_find_curving(const csg_tape *tape, uint32_t warp, csg_vec3 c, double radius);
/* What the leaf changes by at most over a length below its warp. */
double csg_cone_leaf_norm(const csg_tape *tape, const csg_tape_node *leaf);
/* Corners below a warp. False: one is where it is not regular. */
bool csg_cone_warp_corners(const csg_tape *tape, uint32_t warp, const csg_vec3 triangle[3],
                           csg_vec3 out[3]);
/* As csg_shape_beside, of a leaf and a flat triangle below its warp: `at` is turn (1 or -1) times
 * the leaf's values at the corners, and then what is nowhere more than turn times the leaf. */
csg_beside csg_cone_find_beside(const csg_tape *tape, const csg_tape_node *leaf,
                                const csg_vec3 below[3], double turn, double at[3]);

/* Where faces meet: the leaf's solid in the ball is the intersection of theirs, or of what is
 * turned around the union; one face a ball, with its values in the tape's frame at c. False: it is
 * not so.
 */
bool csg_cone_find_faces(csg_cone_balls *balls, csg_cone_face faces[CSG_CONE_MOST],
                         const csg_tape *tape, const csg_tape_node *leaf, const float c[3],
                         double radius);

#endif
