/* SPDX-License-Identifier: MIT
 * Sides of polygons lie in faces of their cells: what they are called on the other side.
 */
#ifndef CSG_MESH_FEATURES_FACE_H
#define CSG_MESH_FEATURES_FACE_H

#include "mesh/marching/tables.h"

/* The one face of the cell that both edges lie in, or -1: a diagonal through the cell. */
static inline int csg_face_between(const csg_cell_tables *tables, uint8_t a, uint8_t b)
{
    unsigned common = tables->faces[a] & tables->faces[b];
    return common ? __builtin_ctz(common) : -1;
}

/* The same lattice edge as the cell beyond a face names it. */
static inline uint8_t csg_edge_beyond(const csg_cell_tables *tables, uint8_t edge, int axis)
{
    const uint8_t *o = tables->offset[edge];
    unsigned at[3] = {o[0], o[1], o[2]};
    at[axis] ^= 1;
    unsigned along = edge / 4, first = along == 0 ? 1 : 0, second = along == 2 ? 1 : 2;
    return (uint8_t)(4 * along + at[first] + 2 * at[second]);
}

#endif
