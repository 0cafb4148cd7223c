/* SPDX-License-Identifier: MIT
 * The gradients that a primitive's field can have in a ball of radius rho around q, in its own
 * frame, as a few balls of vectors whose convex hull holds them. (What they are for:
 * field/cones/cone.h.) Two ways to bound them:
 *
 * Turning. Where the field is the distance to a convex core K (a point, an axis, a segment, a box
 * without its rounding), the vector u from the nearest point of K to the point is a 1-Lipschitz
 * function of the point, so within rho its direction turns by an angle of at most asin(rho / |u|).
 * For a torus and a tapered capsule the Hessian's largest eigenvalue is used instead (one over the
 * distance to the skeleton or to the axis), for an ellipsoid its largest curvature e_max / e_min^2,
 * which inside at depth d becomes k / (1 - k d), or that depth is concave.
 *
 * Faces. Where faces meet, every gradient is a face's (minus its outward normal) or, outside,
 * minus a unit vector of the form w_1 n_1 + w_2 n_2 + ... with all w >= 0, whose sum is at least 1
 * since |sum w n| <= sum w. So what climbs with all faces' gradients climbs there too. A face
 * takes part when its plane is near enough to be the nearest one anywhere in the ball and, outside,
 * when the ball may be in front of its plane. Primitives of this kind have the trait FACES.
 *
 * Where all gradients are in one ball of vectors, a primitive also says how fast they turn: by no
 * more than `bend` per length between any two points of the ball. A unit vector away from a convex
 * core turns by 1 / |u|.
 */
#ifndef CSG_SCENE_CONE_BALL_H
#define CSG_SCENE_CONE_BALL_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

enum { CSG_CONE_MOST = 32 };

/* Vectors within `spread` of `at`. */
typedef struct csg_cone_ball {
    double at[3], spread;
} csg_cone_ball;

typedef struct csg_cone_balls {
    csg_cone_ball items[CSG_CONE_MOST];
    uint32_t count;
    bool has_edges; /* of a primitive */
    /* Of the leaf added last: */
    double corner; /* 0, or how long its gradients may be where faces meet */
    double bend;   /* no two gradients differ by more than that times the distance between their
                      points; INFINITY: not known */
} csg_cone_balls;

/* A face as a field of its own: within [value - below, value + above] + (its ball's centre) .
 * (x - q) all over the ball. */
typedef struct csg_cone_face {
    double value, below, above;
} csg_cone_face;

/* A leaf in its own frame. */
typedef struct csg_cone_leaf {
    csg_cone_balls *balls;
    csg_cone_face *faces; /* of each ball where it is a face; NULL: nobody asks */
    uint32_t face_count;
    double sharp_from; /* {f >= level} is the faces' intersection for levels no less than this */
    const float *own;  /* parameters as packed */
    double q[3], rho;
    double half[3];    /* of a box around q outside of which nothing matters, or INFINITY */
    double band;       /* the leaf's values, as far as they matter, or INFINITY */
    double turn[3][3]; /* own gradient -> tape's: sigma times the frame's transpose */
    double norm;       /* of turn, at least */
    double bend;       /* own gradients', per length; INFINITY unless it is said */
} csg_cone_leaf;

/* Own gradients within `spread` of (x, y, z). False: there are too many. */
static inline bool csg_cone_add(csg_cone_leaf *l, double x, double y, double z, double spread)
{
    if (l->balls->count >= CSG_CONE_MOST)
        return false;
    csg_cone_ball *ball = &l->balls->items[l->balls->count++];
    const double g[3] = {x, y, z};
    for (int k = 0; k < 3; k++)
        ball->at[k] = l->turn[k][0] * g[0] + l->turn[k][1] * g[1] + l->turn[k][2] * g[2];
    ball->spread = l->norm * spread;
    return true;
}

/* A flat face with its outward normal turned around, whose field is `value` at q. */
static inline bool csg_cone_add_face(csg_cone_leaf *l, double x, double y, double z, double value)
{
    if (l->faces && l->balls->count < CSG_CONE_MOST)
        l->faces[l->face_count++] = (csg_cone_face){value, 0, 0};
    return csg_cone_add(l, x, y, z, 0);
}

/* One that bends: its field leaves the plane by no more than these. */
static inline bool csg_cone_add_bent_face(csg_cone_leaf *l, double x, double y, double z,
                                          double spread, csg_cone_face face)
{
    if (l->faces && l->balls->count < CSG_CONE_MOST)
        l->faces[l->face_count++] = face;
    return csg_cone_add(l, x, y, z, spread);
}

/* Chord of the largest turn of a vector of length d that moves by rho; 2 = any direction. */
static inline double csg_cone_turn_within(double d, double rho)
{
    double s = d > 0 ? rho / d : 2;
    return s < 1 ? sqrt(2 - 2 * sqrt(1 - s * s)) : 2;
}

/* Gradient away from a convex core: u from the core's nearest point to q. */
static inline bool csg_cone_add_away(csg_cone_leaf *l, double x, double y, double z)
{
    double d = sqrt(x * x + y * y + z * z), spread = csg_cone_turn_within(d, l->rho);
    if (d > l->rho)
        l->bend = 1 / (d - l->rho);
    return spread < 1.4 && csg_cone_add(l, -x / d, -y / d, -z / d, spread);
}

#endif
