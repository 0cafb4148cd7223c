/* SPDX-License-Identifier: MIT
 * Affine functions below the field, over a triangle: where one is positive at the three corners the
 * triangle is inside, whatever its size. The same of the field turned around: it is outside.
 *
 * Linear bounds go through the operators as those of neural networks do through their layers (Zhang
 * et al., Efficient neural network robustness certification with general activation functions,
 * 2018): all that blend values alone grow with their operands, so what is below these may stand for
 * them. An intersection is concave in its operands' values: what it makes of them at the corners is
 * below it in between. A union is convex: its tangent planes are below it, which are mixtures of
 * operands; of a sharp one any mixture is. A convex primitive's field is concave too. One that is
 * turned around is convex, and nowhere farther below its corners' plane than three times as far as
 * it is at the triangle's middle, which is a mean, with a weight of a third or more, of any other
 * place and corners. Outlines are beside their segments (shape.h), and what is neither strays from
 * its corners' plane by what its gradients do.
 *
 * Turned around a union is an intersection, so one side is told as the other is.
 */
#ifndef CSG_MESH_DISTANCE_MINORANT_H
#define CSG_MESH_DISTANCE_MINORANT_H

#include "base/geometry.h"
#include "mesh/distance/touching.h"

/* A triangle of which the sign is to be known. */
typedef struct csg_sided_triangle {
    csg_vec3 at[3];
    double turn; /* 1: is it inside? -1: outside? */
} csg_sided_triangle;

/* A lower bound of turn times the field over each of up to CSG_OCTANTS triangles in which the
 * tape holds, but for rounding of places; -INFINITY: not known. */
void csg_minorants_find(const csg_kernel *kernel, const csg_touching *field,
                        const csg_sided_triangle *triangles, size_t count, double *least);

#endif
