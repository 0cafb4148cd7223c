/* SPDX-License-Identifier: MIT
 * The table of primitives, put together from primitives.def and their files: a function that a
 * primitive lacks is an error here that names it.
 */
#include "scene/primitives/primitive.h"

#include <assert.h>

#include "scene/formula/formulate.h"
#include "scene/primitives/every_primitive.h"
#include "scene/primitives/kinds.h"

/* What every primitive has; the line of a tube ends here. */
#define COMMON(name, count, traits, call, otherwise, usual)                                        \
#name, count, traits, call, otherwise, usual, csg_##name##_check, csg_##name##_distance,       \
        csg_##name##_support, csg_##name##_has_face, csg_##name##_term, csg_##name##_depth,        \
        csg_##name##_balls, csg_##name##_example

static const csg_primitive rows[] = {
#define CSG_PRIMITIVE(NAME, name, count, traits, call, otherwise, usual, doc)                      \
    [CSG_NODE_##NAME -                                                                             \
        CSG_NODE_FIRST_PRIMITIVE] = {COMMON(name, count, traits, call, otherwise, usual),          \
                                     csg_##name##_pack,                                            \
                                     CSG_##NAME##_OWN,                                             \
                                     csg_##name##_gradients,                                       \
                                     csg_##name##_smooth,                                          \
                                     csg_##name##_may_crease,                                      \
                                     csg_##name##_mirrors},
#define CSG_CURVE_PRIMITIVE(NAME, name, count, traits, call, otherwise, usual, doc)                \
    [CSG_NODE_##NAME -                                                                             \
        CSG_NODE_FIRST_PRIMITIVE] = {COMMON(name, count, traits, call, otherwise, usual),          \
                                     NULL,                                                         \
                                     0,                                                            \
                                     NULL,                                                         \
                                     NULL,                                                         \
                                     csg_##name##_may_crease,                                      \
                                     NULL},
#include "scene/primitives/primitives.def"
};

/* Room for them all; {f >= -level} is known in one way; a trait that tubes have and no other.
 * A condition that fails says which primitive and what it lacks. */
#define CSG_PRIMITIVE(NAME, name, count, traits, ...)                                              \
    _Static_assert((int)CSG_##NAME##_OWN <= (int)CSG_LEAF_MOST_OWN,                                \
                   #name ": CSG_LEAF_MOST_OWN floats at most (leaf.h)");                           \
    _Static_assert((count) <= CSG_PRIMITIVE_MOST_PARAMETERS, #name ": too many parameters");       \
    _Static_assert(!((traits)&CSG_TRAIT_OUTSIDE) == !!((traits)&CSG_TRAIT_GAUGE),                  \
                   #name ": either OUTSIDE or GAUGE must hold (primitive.h)");                     \
    _Static_assert(!((traits)&CSG_TRAIT_CURVE), #name ": CURVE is of tubes");
#define CSG_CURVE_PRIMITIVE(NAME, name, count, traits, ...)                                        \
    _Static_assert((count) <= CSG_PRIMITIVE_MOST_PARAMETERS, #name ": too many parameters");       \
    _Static_assert((traits)&CSG_TRAIT_CURVE, #name ": a tube has CURVE");
#include "scene/primitives/primitives.def"

const csg_primitive *csg_primitive_of(csg_primitive_kind kind)
{
    assert(csg_node_is_named_primitive(kind));
    return &rows[kind - CSG_NODE_FIRST_PRIMITIVE];
}

csg_sample csg_reference_primitive(csg_primitive_kind kind, const double *parameters, csg_vec3 p)
{
    if (kind == CSG_NODE_EMPTY)
        return (csg_sample){-INFINITY, csg_vec3_make(0, 0, 0)};
    return csg_primitive_of(kind)->distance(parameters, p);
}

csg_term csg_formulate_primitive(csg_terms *t, csg_primitive_kind kind, const double *v,
                                 const csg_term p[3])
{
    if (kind == CSG_NODE_EMPTY)
        return csg_term_number(t, -CSG_FORMULA_FAR);
    return csg_primitive_of(kind)->term(t, v, p);
}

/* ---- what boxes and rectangles share -------------------------------------------------------- */

bool csg_cone_add_box(csg_cone_leaf *l, int axes)
{
    double over[3] = {0, 0, 0}, a[3], most = -INFINITY;
    for (int k = 0; k < axes; k++) {
        a[k] = fabs(l->q[k]) - (double)l->own[k];
        most = fmax(most, a[k]);
        over[k] = copysign(fmax(a[k], 0), l->q[k]);
    }
    for (int k = 0; k < axes; k++) { /* all over the ball one face is the nearest place */
        bool alone = a[k] > l->rho;
        for (int j = 0; j < axes; j++)
            alone = alone && (j == k || a[j] < -l->rho);
        if (!alone)
            continue;
        l->bend = 0;
        return csg_cone_add(l, k == 0 ? copysign(1, -l->q[0]) : 0,
                            k == 1 ? copysign(1, -l->q[1]) : 0, k == 2 ? copysign(1, -l->q[2]) : 0,
                            0);
    }
    if (sqrt(over[0] * over[0] + over[1] * over[1] + over[2] * over[2]) > 1.2 * l->rho)
        return csg_cone_add_away(l, over[0], over[1], over[2]);
    uint32_t faces = 0;
    l->sharp_from = (double)l->own[axes];
    for (int k = 0; k < axes; k++) {
        if (a[k] + l->rho < fmin(0, most - l->rho))
            continue;
        for (int side = -1; side <= 1; side += 2) {
            double g[3] = {0, 0, 0};
            g[k] = -side;
            if (side * l->q[k] < -l->rho)
                continue; /* the other side is the nearer one all over the ball */
            faces++;
            if (!csg_cone_add_face(l, g[0], g[1], g[2],
                                   (double)l->own[axes] + (double)l->own[k] - side * l->q[k]))
                return false;
        }
    }
    l->balls->has_edges |= faces > 1 && l->own[axes] == 0;
    return true;
}

float csg_box_edge_distance(const float *own, const float q[3], int axes)
{
    float d[3] = {0, 0, 0}, best = INFINITY;
    for (int i = 0; i < axes; i++)
        d[i] = fabsf(fabsf(q[i]) - own[i]);
    for (int i = 0; i < axes; i++)
        for (int j = i + 1; j < axes; j++)
            best = fminf(best, sqrtf(d[i] * d[i] + d[j] * d[j]));
    return best;
}
