/* SPDX-License-Identifier: MIT
 * The triangles nearest to many points. Those that lie together go down the tree together
 * (tree_lanes.c).
 */
#ifndef CSG_SHAPE_PACKET_H
#define CSG_SHAPE_PACKET_H

#include "shape/shape_kernel.h"

/* Points of a packet at most. */
enum { CSG_PACKET_MOST = 256 };

/* out[i] is what csg_tree_nearest_of finds for at[i] in these parts of the tree. Points within 2^60
 * of the frame. kernel: NULL for one by one. */
void csg_packet_search(const csg_tree *tree, const csg_shape_kernel *kernel,
                       const csg_tree_parts *parts, const csg_vec3 *at, size_t count,
                       csg_triangle_hit *out);

#endif
