/* SPDX-License-Identifier: MIT
 * What a polyhedron has: for those who answer questions about it, polyhedron.c and faces.c.
 */
#ifndef CSG_SHAPE_SOLID_H
#define CSG_SHAPE_SOLID_H

#include "shape/polyhedra/tree.h"
#include "shape/shape.h"

typedef struct csg_polyhedron {
    csg_shape shape;
    csg_triangle_frame frame;
    csg_triangles mended;
    csg_tree tree;
    uint64_t hash;
    bool is_convex;
    uint32_t (*beside)[3]; /* per triangle in the tree, along each edge: the other triangle there */
    float (
        *turn)[3]; /* along each edge: 1 - cos of the angle between both; 2 where there is none */
    atomic_uchar *plain; /* per triangle in the tree: whether it is (csg_tree_plain_group), once it
                            was asked */
} csg_polyhedron;

enum { CSG_PLAIN_UNKNOWN, CSG_PLAIN_NO, CSG_PLAIN_YES };

/* More than points and their feet are moved by rounding. */
static const double CSG_POLYHEDRON_LEAST = 0x1p-36;

/* Edges that count as convex may bend the other way by 2^-30 (convex.c): farther from the surface
 * than this all triangles of a convex solid but needles are as good as plain. */
static const double CSG_POLYHEDRON_CONVEX_BEYOND = 0x1p-28;

static inline const csg_polyhedron *csg_polyhedron_of(const csg_shape *shape)
{
    return (const csg_polyhedron *)shape;
}

/* So far away that the solid is a point; also whatever is not a number. Frame units. */
static inline bool csg_polyhedron_is_far(csg_vec3 p)
{
    return !(fabs(p.x) < 0x1p60 && fabs(p.y) < 0x1p60 && fabs(p.z) < 0x1p60);
}

/* A triangle's unit normal, into the solid. */
static inline csg_vec3 csg_polyhedron_inward(const csg_tree_triangle *t)
{
    return csg_vec3_normalize(csg_vec3_cross(t->ac, t->ab));
}

/* faces.c. What `turn` is of an edge, once `beside` is known; whether a triangle, by its place in
 * the tree, is plain, found once; and whether it is as good as plain for a point with no triangle
 * within `free`. */
float csg_polyhedron_find_turn(const csg_polyhedron *solid, uint32_t place, int edge);
bool csg_polyhedron_find_plain(const csg_polyhedron *solid, uint32_t place);
static inline bool csg_polyhedron_is_plain(const csg_polyhedron *solid, uint32_t place)
{
    int known = atomic_load_explicit(&solid->plain[place], memory_order_relaxed);
    return known == CSG_PLAIN_UNKNOWN ? csg_polyhedron_find_plain(solid, place)
                                      : known == CSG_PLAIN_YES;
}
static inline bool csg_polyhedron_is_plain_beyond(const csg_polyhedron *solid, uint32_t place,
                                                  double free)
{
    return solid->is_convex && free > CSG_POLYHEDRON_CONVEX_BEYOND
               ? !solid->tree.triangles[place].is_needle
               : csg_polyhedron_is_plain(solid, place);
}

/* Operations of the shape. */
bool csg_polyhedron_normals(const csg_shape *shape, csg_vec3 c, double radius,
                            csg_shape_take_normal *take, void *user);
void csg_polyhedron_creases(const csg_shape *shape, const csg_shape_crease *crease,
                            csg_shape_balls *balls);

#endif
