/* SPDX-License-Identifier: MIT
 * Edges that a wedge pokes through: the surface crosses them twice, so neither end shows it. Where
 * the ends are no further from the surface than the edge is long, the field climbs from both (or
 * falls, in a groove) and the tangents there belong to two sheets, the tangents meet between them;
 * on plane faces just where the crease passes by. If the field has the other sign there, the edge
 * gets a point in that place, and a root on either side of it.
 *
 * This depends on values and gradients at both ends alone, so all bricks of one level around an
 * edge agree; where their levels differ the coarser one is divided.
 */
#ifndef CSG_MESH_ADAPTIVE_PIERCE_H
#define CSG_MESH_ADAPTIVE_PIERCE_H

#include "grid/adaptive/bricks.h"
#include "mesh/adaptive/sheets.h"

enum { CSG_BRICK_EDGES = 3 * CSG_BRICK_EDGE * CSG_BRICK_SAMPLES * CSG_BRICK_SAMPLES };

/* Which edges of a brick are pierced, as csg_brick_edge numbers them, and where: a coordinate along
 * the edge's axis. */
typedef struct csg_pierced {
    uint64_t edges;
    float at[CSG_BRICK_EDGES];
} csg_pierced;

/* Of an edge: the length of the shorter span on either side of the point, at least. */
#define CSG_LEAST_SPAN 0x1p-4f

/* f: values at the brick's points. Leaves of the finest level have none. */
void csg_pierce(csg_sheet_probe *probe, const csg_bricks *bricks, const csg_brick *brick,
                const float *f, csg_pierced *out);

#endif
