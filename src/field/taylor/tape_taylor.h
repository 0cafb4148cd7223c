/* SPDX-License-Identifier: MIT
 * A tape's field in a cube as one Taylor model of third order (base/taylor.h), where the field is
 * smooth there: its leaves by their smooth pieces (scene/primitives/smooth.h), its blends as
 * functions of these. Where it is not, as few models as tell it: one for each of the functions that
 * it is somewhere in the cube. The radius is that of the ball around the cube, whose sides are
 * along the axes of the tape's frame; nothing is told beyond the cube.
 */
#ifndef CSG_FIELD_TAPE_TAYLOR_H
#define CSG_FIELD_TAPE_TAYLOR_H

#include "field/tape.h"
#include "field/taylor/pieces.h"

/* Around c, in the tape's frame, with the rounding of the tape's parameters: what is enclosed is
 * the scene's field, or one that has its sign everywhere in the cube. For a tape that is valid
 * there. False: it is not smooth there, or not known to be. */
bool csg_tape_taylor(const csg_tape *tape, const double c[3], double radius, csg_taylor *out);

/* The same in pieces. The field is continuous over the cube; where only its sign is enclosed, so is
 * where it is 0. False: they are too many, or not known. */
bool csg_tape_taylor_pieces(const csg_tape *tape, const double c[3], double radius,
                            csg_taylor_pieces *out);

#endif
