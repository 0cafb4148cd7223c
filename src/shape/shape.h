/* SPDX-License-Identifier: MIT
 * Explicit geometry as a field: a region of the plane bounded by segments (region.h), or a solid
 * bounded by triangles (polyhedron.h). Both give the exact signed distance, positive inside,
 * Lipschitz constant 1; a region does not depend on z. A shape is immutable once made, shared by
 * counting, and may be read by many threads.
 */
#ifndef CSG_SHAPE_SHAPE_H
#define CSG_SHAPE_SHAPE_H

#include <stdatomic.h>

#include "shape/plane/outline.h"
#include "shape/polyhedra/triangles.h"

typedef enum csg_shape_kind { CSG_SHAPE_REGION, CSG_SHAPE_POLYHEDRON } csg_shape_kind;

typedef struct csg_shape csg_shape;
struct csg_shape_kernel;

/* A box in the shape's own frame, and how far from its surface distances matter there; infinite:
 * all of them. */
typedef struct csg_shape_cell {
    csg_vec3 center, half;
    double reach;
} csg_shape_cell;

enum { CSG_SHAPE_MOST_NEAR = 8, CSG_SHAPE_MOST_BALLS = 64 };

/* What of a shape's geometry can matter in a cell, as numbers of its tree. */
typedef struct csg_shape_near {
    double limit; /* distances up to it are exact, others larger than it; the sign is right */
    uint32_t count;
    uint32_t items[];
} csg_shape_near;

/* Takes a unit vector; false ends what gives it. */
typedef bool csg_shape_take_normal(void *user, csg_vec3 inward);

/* Which edges are creases. Angles as 1 - cos. Left out of those by which the surface turns by more
 * than `least` are blunt ones beside which it goes on turning: by less than `blunt` there, and on
 * both sides again by half as much and more, and by less than `blunt`, nearer than `narrow`.
 * Normals that differ by more than `most_turn` count as a crease, whatever lies between them. */
typedef struct csg_shape_crease {
    double least, blunt, narrow, most_turn;
} csg_shape_crease;

/* Balls that lie together, in the shape's own frame. */
typedef struct csg_shape_balls {
    csg_vec3 center[CSG_SHAPE_MOST_BALLS];
    double radius[CSG_SHAPE_MOST_BALLS];
    bool may_crease[CSG_SHAPE_MOST_BALLS];
    size_t count;
    size_t fewest; /* with fewer facets around all of them none is looked at: all may crease */
} csg_shape_balls;

/* What is known of a triangle beside a surface (csg_shape_beside): nothing, what may be far below
 * where it crosses the surface, or what is near to the truth. */
typedef enum csg_beside { CSG_BESIDE_UNKNOWN, CSG_BESIDE_WEAKLY, CSG_BESIDE_CLOSELY } csg_beside;

/* What each kind brings along. */
typedef struct csg_shape_operations {
    void (*destroy)(csg_shape *shape);
    double (*sample)(const csg_shape *shape, csg_vec3 p, csg_vec3 *gradient);
    void (*values)(const csg_shape *shape, const struct csg_shape_kernel *kernel,
                   const csg_shape_near *near, const float *x, const float *y, const float *z,
                   size_t count, float *out);
    void (*gradients)(const csg_shape *shape, const struct csg_shape_kernel *kernel,
                      const csg_shape_near *near, const float *x, const float *y, const float *z,
                      size_t count, float *out, float *gx, float *gy, float *gz);
    uint32_t (*narrow)(const csg_shape *shape, const csg_shape_near *among,
                       const csg_shape_cell *cell, uint32_t *items);
    uint64_t (*hash)(const csg_shape *shape);
    bool (*normals)(const csg_shape *shape, csg_vec3 c, double radius, csg_shape_take_normal *take,
                    void *user);
    void (*creases)(const csg_shape *shape, const csg_shape_crease *crease,
                    csg_shape_balls *balls); /* NULL: it does not tell */
    csg_beside (*beside)(const csg_shape *shape, const csg_vec3 triangle[3], double turn,
                         double at[3]); /* the same */
} csg_shape_operations;

/* The first member of the struct of each kind. */
struct csg_shape {
    csg_shape_kind kind;
    const csg_shape_operations *operations;
    csg_memory *memory;
    atomic_uint references;
    csg_box box; /* of the solid; a region's is infinite in z */
};

void csg_shape_retain(csg_shape *shape);
void csg_shape_release(csg_shape *shape); /* NULL is a no-op */

/* Signed distance at p and its gradient (unit, out of the surface's nearest point; zero where
 * there are several nearest points is not asked for: any of them will do). */
double csg_shape_sample(const csg_shape *shape, csg_vec3 p, csg_vec3 *gradient);

/* The same for many points, in the shape's own frame. Each result depends on its point alone, not
 * on its neighbours in the batch, and is the same on every machine. near: of a cell that holds the
 * points; up to its limit nothing depends on it, and what is larger than that may depend on how
 * many points are asked for. NULL: the whole shape. kernel (shape_kernel.h):
 * the build for the instruction set in use, on which nothing depends but time; NULL: point by
 * point. */
void csg_shape_values(const csg_shape *shape, const struct csg_shape_kernel *kernel,
                      const csg_shape_near *near, const float *x, const float *y, const float *z,
                      size_t count, float *out);
void csg_shape_gradients(const csg_shape *shape, const struct csg_shape_kernel *kernel,
                         const csg_shape_near *near, const float *x, const float *y, const float *z,
                         size_t count, float *out, float *gx, float *gy, float *gz);

/* What can matter in the cell, of what could in a larger one (NULL: of everything): how many, up to
 * CSG_SHAPE_MOST_NEAR items; 0: not known. `reach` is at least the distance between the surface and
 * some point of the cell, so there always is something. */
uint32_t csg_shape_narrow(const csg_shape *shape, const csg_shape_near *among,
                          const csg_shape_cell *cell, uint32_t *items);

/* Gives the normals, into the solid, of all segments or faces that can be nearest to a point of the
 * ball around c; the same one may come again. At every point of the ball where there is a gradient
 * it is one of them, or a combination w_1 n_1 + w_2 n_2 + ... of unit length with all w >= 0
 * (shape.c). False: `take` said so, or there are too many, or sides are not clear there (triangles
 * that cross others, lie within the solid, or are needles). */
bool csg_shape_normals(const csg_shape *shape, csg_vec3 c, double radius,
                       csg_shape_take_normal *take, void *user);

/* Whether csg_shape_creases may be asked. */
static inline bool csg_shape_tells_creases(const csg_shape *shape)
{
    return shape->operations->creases != NULL;
}

/* For each ball whether the surface has creases there, or may have some. Where it has none, the
 * gradients at points whose nearest places are in the ball differ by no more than `most_turn`, and
 * jump by no more than `least` but at blunt edges that are left out. */
void csg_shape_creases(const csg_shape *shape, const csg_shape_crease *crease,
                       csg_shape_balls *balls);

/* An affine function that over a triangle is nowhere more than turn (1 or -1) times the signed
 * distance: its values at the corners. at: first, turn times the distances there. */
csg_beside csg_shape_beside(const csg_shape *shape, const csg_vec3 triangle[3], double turn,
                            double at[3]);

/* A stable hash of the geometry, for printing and comparing. */
uint64_t csg_shape_hash(const csg_shape *shape);

#endif
