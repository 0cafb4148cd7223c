/* SPDX-License-Identifier: MIT
 * Maps of the cube onto itself (axes that change places, coordinates whose signs are turned) under
 * which a solid is what it was: what is known of one of its cubes is known of the cube's images.
 * They are read off the tape: each leaf becomes another one, or itself, and what joins them
 * remains.
 */
#ifndef CSG_MEASURE_SYMMETRY_H
#define CSG_MEASURE_SYMMETRY_H

#include "field/tape.h"

enum { CSG_SYMMETRIES_MOST = 47 /* all maps of a cube onto itself but the identity */ };

/* Takes x to y, y_i = sign[i] x_axes[i]. */
typedef struct csg_symmetry {
    int axes[3];
    double sign[3];
} csg_symmetry;

typedef struct csg_symmetries {
    csg_symmetry of[CSG_SYMMETRIES_MOST];
    int count;
} csg_symmetries;

/* Those of a tape's solid. *tape: of the same field with the parameters in the arena where there
 * are any, with as much more room (tape.h, off and turned) as its leaves differ from each other's
 * images, so that whatever is proven with it holds of the images of what is meant as well. False:
 * out of memory. */
bool csg_symmetries_find(csg_tape *tape, size_t parameter_count, csg_arena *arena,
                         csg_symmetries *out);

void csg_symmetry_map(const csg_symmetry *s, const double from[3], double to[3]);

/* A direction that is the same after it. */
bool csg_symmetry_keeps(const csg_symmetry *s, const double direction[3]);

#endif
