/* SPDX-License-Identifier: MIT
 * A closed surface that bends outwards at every edge and covers nothing twice is convex (Tietze and
 * Nakajima 1928), so one look at each edge decides.
 */
#include "shape/polyhedra/convex.h"

/* How far the third corner of `other` lies outside of the plane of `half`'s triangle. */
static double height_over(const csg_triangles *chain, uint32_t half, uint32_t other)
{
    const uint32_t *corners = chain->corners[half / 3];
    csg_vec3 a = chain->points[corners[0]];
    csg_vec3 normal = csg_vec3_cross(csg_vec3_sub(chain->points[corners[1]], a),
                                     csg_vec3_sub(chain->points[corners[2]], a));
    csg_vec3 tip = chain->points[chain->corners[other / 3][(other % 3 + 2) % 3]];
    return csg_vec3_dot(csg_vec3_normalize(normal), csg_vec3_sub(tip, a));
}

bool csg_chain_is_convex(const csg_triangles *chain, const csg_triangle_edges *edges)
{
    for (size_t i = 0; i < edges->count; i++) {
        const uint32_t *halves = edges->halves + edges->edges[i].first;
        if (edges->edges[i].count != 2 || height_over(chain, halves[0], halves[1]) > 0x1p-30 ||
            height_over(chain, halves[1], halves[0]) > 0x1p-30)
            return false;
    }
    return true;
}
