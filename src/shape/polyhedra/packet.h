/* SPDX-License-Identifier: MIT
 * The triangles nearest to many points. Those that lie together are searched together: the leaves
 * near the box around them are listed once, then points go through the list by lanes
 * (tree_lanes.c).
 */
#ifndef CSG_SHAPE_PACKET_H
#define CSG_SHAPE_PACKET_H

#include "shape/shape_kernel.h"

/* out[i] is what csg_tree_nearest_of finds for at[i] in these parts of the tree; items NULL: what
 * csg_tree_nearest finds. Points within 2^60 of the frame. kernel: NULL for one by one. */
void csg_packet_search(const csg_tree *tree, const csg_shape_kernel *kernel, const uint32_t *items,
                       uint32_t item_count, const csg_vec3 *at, size_t count,
                       csg_triangle_hit *out);

#endif
