/* SPDX-License-Identifier: MIT
 * What the collapses in one cube have made of a mesh, as a record for the other ranks that have the
 * same mesh (base/rank_loop.h): they take it over in place of doing the same.
 */
#ifndef CSG_MESH_RESHAPE_REGION_RECORD_H
#define CSG_MESH_RESHAPE_REGION_RECORD_H

#include "base/rank_loop.h"
#include "mesh/reshape/decimation.h"

/* All that may be changed there. */
typedef struct csg_region_of_mesh {
    csg_decimation *decimation;
    const uint32_t *triangles; /* of which those with inside[t] == region are the region's */
    const uint32_t *inside;    /* per triangle of the mesh */
    const uint32_t *vertices;  /* the region's own, of which all triangles are */
    const uint32_t *version;   /* per vertex of the mesh: as it was before the collapses */
    uint32_t region, triangle_count, vertex_count;
} csg_region_of_mesh;

/* False: out of memory. */
bool csg_region_pack(const csg_region_of_mesh *region, csg_records *records);
/* On a rank where nothing is changed there yet. item: that the record is of. */
void csg_region_unpack(const csg_region_of_mesh *region, csg_record_reader *reader, size_t item);

#endif
