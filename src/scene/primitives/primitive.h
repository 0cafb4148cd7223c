/* SPDX-License-Identifier: MIT
 * What is known of each primitive: its row of primitives.def and the functions in its own file
 * (torus.h, ...), as one table. Whoever treats primitives differently asks here; nowhere else are
 * they told apart by their names. The float formula alone is not in it: kernels must be able to
 * make vectors of it (field/kernels/leaf_kernel.c).
 */
#ifndef CSG_SCENE_PRIMITIVE_H
#define CSG_SCENE_PRIMITIVE_H

#include "base/random.h"
#include "scene/formula/step.h"
#include "scene/primitives/cone_ball.h"
#include "scene/primitives/leaf.h"
#include "scene/primitives/sizes.h"
#include "scene/primitives/smooth.h"
#include "scene/reference.h"

enum {
    CSG_TRAIT_FLAT = 1,     /* the field does not depend on z */
    CSG_TRAIT_BOUNDED = 2,  /* the solid is, or the figure of the plane */
    CSG_TRAIT_CONVEX = 4,   /* the solid is, and so the field is concave */
    CSG_TRAIT_INSIDE = 8,   /* the field is the exact distance inside: not where curves bend back */
    CSG_TRAIT_OUTSIDE = 16, /* and outside: {f >= -level} is the solid grown by a ball */
    CSG_TRAIT_EXACT = CSG_TRAIT_INSIDE | CSG_TRAIT_OUTSIDE,
    CSG_TRAIT_BALL = 32,   /* turned about the origin it stays as it is */
    CSG_TRAIT_LINEAR = 64, /* under any affine map it stays one of its kind: packs the whole map */
    CSG_TRAIT_FACES = 128, /* gradients as in cone_ball.h, "faces" */
    CSG_TRAIT_GAUGE =
        256, /* f = depth (1 - d) with d(t p) = t d(p): {f >= -level} is the solid scaled */
    CSG_TRAIT_CURVE = 512,   /* along a Bezier curve: leaves of the tape are pieces of it */
    CSG_TRAIT_TURNED = 2048, /* turned about its z axis it stays as it is, or lies in such a solid
                                that reaches no farther along x */
    CSG_TRAIT_STEADY = 1024  /* where `gradients` adds one ball around the gradient at its centre,
                               they stray from it in proportion to the distance, or less */
};

enum { CSG_PRIMITIVE_MOST_PARAMETERS = 16 };

/* A coordinate's sign is turned, or two coordinates change places; AROUND: all is turned about the
 * z axis, by any angle. */
typedef enum csg_mirror {
    CSG_MIRROR_X = 1,
    CSG_MIRROR_Y = 2,
    CSG_MIRROR_Z = 4,
    CSG_MIRROR_SIGNS = CSG_MIRROR_X | CSG_MIRROR_Y | CSG_MIRROR_Z,
    CSG_MIRROR_XY = 8,
    CSG_MIRROR_YZ = 16,
    CSG_MIRROR_AROUND = 32,
    CSG_MIRROR_TURNED = CSG_MIRROR_X | CSG_MIRROR_Y | CSG_MIRROR_XY | CSG_MIRROR_AROUND,
    CSG_MIRROR_ALL = CSG_MIRROR_SIGNS | CSG_MIRROR_TURNED | CSG_MIRROR_YZ
} csg_mirror;

/* Values of a leaf that matter, from `low` to `high`. */
typedef struct csg_band {
    float low, high;
} csg_band;
static inline bool csg_band_meets(csg_band b, float low, float high)
{
    return b.low <= high && b.high >= low;
}

/* Takes balls whose convex hull is a solid's. */
typedef struct csg_ball_sink {
    void *user;
    void (*ball)(void *user, csg_vec3 at, double radius);
    /* Balls along a circle around the z axis at this height, up to half_deg on both sides of +x. */
    void (*arc)(void *user, double radius, double height, double half_deg, double ball_radius);
    double within; /* how far the hull may be off, for what has no such balls otherwise */
    csg_vec3 axes; /* set to 1, 1, 1: all has to be stretched by these */
} csg_ball_sink;

typedef struct csg_primitive {
    const char *name;
    uint32_t parameter_count;
    unsigned traits;

    /* As the scene language says it: $a to $p are the parameters, $A to $D twice that.
     * call_otherwise: where the last parameter is not `usual`; or NULL. */
    const char *call, *call_otherwise;
    double usual;

    /* Whether these parameters are allowed. May put them in order: a normal of unit length. */
    bool (*check)(csg_refusal *refusal, double *v);
    /* Value and gradient, f > 0 inside: the definition. */
    csg_sample (*distance)(const double *v, csg_vec3 p);
    /* Largest n . p over the solid {f >= 0}; INFINITY where it is unbounded. n need not be unit. */
    double (*support)(const double *v, csg_vec3 n);
    /* Whether the solid touches that plane with a plane face, of the plane with an edge. */
    bool (*has_face)(const double *v, csg_vec3 n);
    /* The field as a formula of the point p. */
    csg_term (*term)(csg_terms *t, const double *v, const csg_term p[3]);
    /* f at the skeleton, where all of it is as deep; else 0. */
    double (*depth)(const double *v);
    /* Balls whose hull is the solid's. False: there are none so simple. */
    bool (*balls)(csg_ball_sink *to, const double *v);
    /* Random parameters for tests, sizes about 0.1 to 0.8. */
    void (*example)(csg_random *random, double *v);

    /* Own parameters and magnitude of the leaf that stands in its place; lengths are k times as
     * long there. NULL for curves (field/compile/compile_curve.h). */
    void (*pack)(csg_leaf *leaf, const double *v, double k);
    int own_count;
    /* Adds the gradients in the ball (cone_ball.h). False: no bound. NULL for curves
     * (field/gradients/cone_curve.h). */
    bool (*gradients)(csg_cone_leaf *leaf);
    /* The field in a ball where one formula of it holds (smooth.h). False: none does all over it,
     * or it has no third derivatives to speak of. NULL for curves. */
    bool (*smooth)(const csg_smooth_leaf *leaf, csg_smooth *out);
    /* Whether a crease of the field may be within `reach` of q where its values are in the band. A
     * centre or an axis counts too. */
    bool (*may_crease)(const float *own, const float q[3], float reach, csg_band b);
    /* Maps of its frame that leave the field as it is: bits of csg_mirror. NULL for curves. */
    unsigned (*mirrors)(const float *own);
} csg_primitive;

/* kind: of a primitive, no field and no shape. */
const csg_primitive *csg_primitive_of(csg_primitive_kind kind);
static inline bool csg_primitive_has(csg_primitive_kind kind, unsigned trait)
{
    return csg_node_is_named_primitive(kind) && csg_primitive_of(kind)->traits & trait;
}

#endif
