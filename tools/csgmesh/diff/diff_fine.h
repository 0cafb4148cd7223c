/* SPDX-License-Identifier: MIT
 * A mesh with the same surface and no long edges, for drawing: distances are known at vertices, and
 * a change in the middle of a large triangle would not be seen.
 */
#ifndef CLI_DIFF_FINE_H
#define CLI_DIFF_FINE_H

#include <stdbool.h>

#include "csgmesh/csgmesh.h"

typedef struct diff_fine {
    csgm_mesh_view view; /* of the arrays below, which are its own */
    float *positions, *normals;
    uint8_t *colors;
    uint16_t *materials;
    uint32_t *indices;
    size_t vertex_room, triangle_room;
} diff_fine;

bool diff_fine_has_longer_edge(const csgm_mesh_view *mesh, double longest);

/* Triangles are halved at their longest edge while that is longer; with the least multiple of it by
 * 1.5 that needs no more than `most` new ones. False: out of memory. Release it either way. */
bool diff_fine_make(const csgm_mesh_view *mesh, double longest, uint64_t most, diff_fine *out);
void diff_fine_release(diff_fine *fine);

#endif
