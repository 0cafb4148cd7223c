/* SPDX-License-Identifier: MIT
 * What rounding does to a mesh on its way into a file. Formats of floats, and Draco's grid, may put
 * two vertices at one place or three on a line, although they lay apart: read back, the triangles
 * there would have collapsed. Such vertices move to the nearest place of the file where nothing
 * collapses, so that the file has the mesh's triangles, all of them, as a manifold; where there is
 * no such place the mesh is refused.
 */
#ifndef CSG_IO_ROUNDING_H
#define CSG_IO_ROUNDING_H

#include "base/context.h"

typedef enum csg_rounding_kind {
    CSG_ROUND_FLOAT,  /* origin and position added and rounded to floats */
    CSG_ROUND_DOUBLE, /* the same in doubles: it is looked at, and nothing can move */
    CSG_ROUND_GRID    /* Draco's quantisation of the positions, which have no origin */
} csg_rounding_kind;

typedef struct csg_rounding {
    csg_rounding_kind kind;
    float low[3], range; /* of the grid: its corner and its longest side */
    uint32_t most;       /* the grid's largest number on an axis */
    bool is_told; /* the encoder is told this grid, otherwise it takes that of the vertices */
} csg_rounding;

/* The grid that Draco lays over all vertices. is_told: for one that the encoder gets by its
 * options, which hold six decimals. */
csg_rounding csg_rounding_of_draco(const csgm_mesh_view *mesh, uint32_t bits, bool is_told);

/* The number of the grid that a value on an axis gets, as Draco computes it, in floats: whoever
 * writes the grid asks here, as halves go another way in doubles, and what was kept apart meets. */
uint32_t csg_rounding_number(const csg_rounding *grid, int axis, float value);

typedef struct csg_rounded {
    csgm_mesh_view mesh; /* with positions as the file has them, and for floats without an origin */
    float *positions;    /* owned; NULL = the mesh's own */
} csg_rounded;

/* file and format are for the message. CSGM_ERR_UNSUPPORTED (reported): something would collapse.
 * Release `out` when CSGM_OK. */
csgm_status csg_round_mesh(csgm_context *context, const csgm_mesh_view *mesh,
                           const csg_rounding *rounding, const char *file, const char *format,
                           csg_rounded *out);
void csg_rounded_release(csgm_context *context, csg_rounded *rounded);

#endif
