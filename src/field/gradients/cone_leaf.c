/* SPDX-License-Identifier: MIT
 * The gradients that a leaf's field can have in a ball around a point of the tape's frame; see
 * cone.h. Primitives give theirs in their own frame (scene/primitives/cone_ball.h); shapes those of
 * the faces that can be nearest, formulas those of their derivatives over a box.
 */
#include <math.h>

#include "field/gradients/cone_curve.h"
#include "field/gradients/cone_formula.h"
#include "field/gradients/cone_leaf.h"
#include "field/gradients/cone_warp.h"
#include "field/gradients/narrow_formula.h"
#include "scene/primitives/curve.h"
#include "shape/polyhedra/polyhedron.h"

/* ---- shapes ----------------------------------------------------------------------------------
 */

enum { SHAPE_MOST = 12 }; /* balls; further normals widen the nearest of them */

typedef struct shape_normals {
    csg_cone_leaf *leaf;
    uint32_t first; /* of the balls */
    csg_vec3 one;
    bool is_set, is_bent;
} shape_normals;

/* 1 degree, as where the mesh looks for creases. */
static const double STRAIGHT = 0.01745;

static double distance_between(const double a[3], const double b[3])
{
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return csg_norm3(d);
}

static bool take_normal(void *user, csg_vec3 n)
{
    shape_normals *s = user;
    csg_cone_balls *balls = s->leaf->balls;
    if (!s->is_set)
        s->one = n;
    s->is_set = true;
    s->is_bent |= csg_vec3_norm(csg_vec3_sub(n, s->one)) > STRAIGHT;
    if (csg_vec3_dot(n, s->one) < -0.999 || !csg_cone_add(s->leaf, n.x, n.y, n.z, 0))
        return false;
    const csg_cone_ball *last = &balls->items[balls->count - 1];
    csg_cone_ball *nearest = NULL;
    double least = INFINITY;
    for (uint32_t i = s->first; i + 1 < balls->count; i++) {
        double d = distance_between(balls->items[i].at, last->at);
        if (d < least) {
            least = d;
            nearest = &balls->items[i];
        }
    }
    bool is_full = balls->count - s->first > SHAPE_MOST || balls->count == CSG_CONE_MOST;
    if (nearest && (least <= nearest->spread + 1e-6 || is_full)) {
        nearest->spread = fmax(nearest->spread, least);
        balls->count--;
    }
    return true;
}

/* Outside of a convex solid the gradient is that of the vector from the nearest point, which moves
 * by no more than the point does: far from an edge, that is less than the faces there turn. Edges
 * count as convex that bend the other way by rounding. False: it is not less, or not known. */
static bool add_away_from(csg_cone_leaf *l, const csg_shape *shape, uint32_t first)
{
    static const double ROUNDING = 1e-3;
    csg_cone_balls *balls = l->balls;
    csg_vec3 g;
    double faces = 0;
    if (shape->kind != CSG_SHAPE_POLYHEDRON || !csg_polyhedron_is_convex(shape))
        return false;
    double away = -csg_shape_sample(shape, csg_vec3_make(l->q[0], l->q[1], l->q[2]), &g);
    double spread = csg_cone_turn_within(away, l->rho) + ROUNDING;
    uint32_t count = balls->count;
    if (!(spread < 1) || !csg_cone_add(l, g.x, g.y, g.z, spread))
        return false;
    csg_cone_ball one = balls->items[count];
    for (uint32_t i = first; i < count; i++)
        faces = fmax(faces, distance_between(balls->items[i].at, one.at));
    balls->count = count;
    if (faces <= one.spread)
        return false;
    balls->items[first] = one;
    balls->count = first + 1;
    return true;
}

/* shape.h: gradients are the normals of what can be nearest, or combinations of them with weights
 * >= 0, whose sum is at least 1 as that of faces. */
static bool add_shape(csg_cone_leaf *l, const csg_tape *tape)
{
    shape_normals s = {.leaf = l, .first = l->balls->count};
    const csg_shape *shape = tape->shapes[(uint32_t)l->own[0]];
    bool done =
        csg_shape_normals(shape, csg_vec3_make(l->q[0], l->q[1], l->q[2]), l->rho, take_normal, &s);
    if (done && s.is_bent && add_away_from(l, shape, s.first))
        return true;
    l->balls->has_edges |= s.is_bent;
    return done && s.is_set;
}

/* ---- formulas --------------------------------------------------------------------------------
 */

/* Where the domain ends a coordinate is held: its derivative is 0, on the way there 0 or 1. */
static void place_box(const csg_cone_leaf *l, const csg_tape_formula *formula, csg_cone_box *at,
                      csg_cone_box seeds[3])
{
    for (int k = 0; k < 3; k++) {
        const float from = formula->low[k], to = formula->high[k];
        double half = fmin(l->rho, l->half[k]) * (1 + 1e-6);
        float low = (float)(l->q[k] - half) - 1e-6f * (float)fabs(l->q[k]);
        float high = (float)(l->q[k] + half) + 1e-6f * (float)fabs(l->q[k]);
        seeds[k] = (csg_cone_box){{0, 0, 0}, {0, 0, 0}};
        seeds[k].low[k] = low > from && high < to ? 1 : 0;
        seeds[k].high[k] = high >= from && low <= to ? 1 : 0;
        at->low[k] = low < from ? from : low > to ? to : low;
        at->high[k] = high < from ? from : high > to ? to : high;
    }
}

static void middle_of_box(const csg_cone_box *box, double middle[3], double half[3])
{
    for (int k = 0; k < 3; k++) {
        middle[k] = ((double)box->high[k] + (double)box->low[k]) / 2;
        half[k] = ((double)box->high[k] - (double)box->low[k]) / 2;
    }
}

/* What the formula's own value is where the leaf's is within the band; half a ulp for each of two
 * roundings, and those of the value itself are the slack. */
static range wanted_of(const csg_tape *tape, const csg_tape_node *leaf, double band)
{
    const float *parameters = tape->parameters + leaf->parameters;
    double sigma = (double)parameters[CSG_LEAF_SIGMA], raise = (double)parameters[CSG_LEAF_RAISE];
    double most = (band + (double)parameters[CSG_LEAF_SLACK]) / fabs(sigma) * (1 + 0x1p-20);
    double room = most + fabs(raise / sigma) * 0x1p-20;
    return (range){(float)(-raise / sigma - room), (float)(-raise / sigma + room)};
}

/* The gradients' box: its corners, or a ball around it. None where the formula is nowhere within
 * the band. */
static bool add_formula(csg_cone_leaf *l, const csg_tape *tape, const csg_tape_node *leaf)
{
    enum { CORNERS = 8 };
    const csg_tape_formula *formula = &tape->formulas[(uint32_t)l->own[0]];
    csg_cone_box at, seeds[3], gradient;
    range values[CSG_NARROW_MOST];
    bool is_narrowed = l->band < INFINITY && formula->count <= CSG_NARROW_MOST;
    place_box(l, formula, &at, seeds);
    if (is_narrowed &&
        !csg_narrow_formula(tape, formula, &at, wanted_of(tape, leaf, l->band), values))
        return true;
    if (!csg_cone_formula(tape, formula, &at, seeds, is_narrowed ? values : NULL, &gradient,
                          &l->balls->has_edges))
        return false;
    double middle[3], half[3];
    middle_of_box(&gradient, middle, half);
    if (l->balls->count + CORNERS > CSG_CONE_MOST)
        return csg_cone_add(l, middle[0], middle[1], middle[2], csg_norm3(half));
    for (int i = 0; i < CORNERS; i++)
        if (!csg_cone_add(l, middle[0] + (i & 1 ? half[0] : -half[0]),
                          middle[1] + (i & 2 ? half[1] : -half[1]),
                          middle[2] + (i & 4 ? half[2] : -half[2]), 1e-6))
            return false;
    return true;
}

static bool add_primitive(csg_cone_leaf *l, csg_primitive_kind kind)
{
    double g[3], spread;
    if (!csg_node_is_curve(kind))
        return csg_primitive_of(kind)->gradients(l);
    return csg_cone_curve(l->own, l->q, l->rho, g, &spread, &l->bend) &&
           csg_cone_add(l, g[0], g[1], g[2], spread);
}

static void place_affine(csg_cone_leaf *l, const float *frame, const double c[3], double sigma)
{
    double norm = csg_cone_norm(frame), own_half[3];
    for (int i = 0; i < 3; i++) {
        l->q[i] = (double)frame[9 + i];
        double half = 0;
        for (int k = 0; k < 3; k++) {
            l->q[i] += (double)frame[3 * i + k] * c[k];
            l->turn[k][i] = sigma * (double)frame[3 * i + k];
            half += fabs((double)frame[3 * i + k]) * l->half[k];
        }
        own_half[i] = half;
    }
    for (int i = 0; i < 3 && l->half[i] < INFINITY; i++)
        l->half[i] = own_half[i];
    l->rho *= norm;
    l->norm = fabs(sigma) * norm;
}

static void place(csg_cone_leaf *l, const csg_tape *tape, const csg_tape_node *leaf,
                  const double c[3])
{
    const float *parameters = tape->parameters + leaf->parameters;
    const float *frame = parameters + CSG_LEAF_FRAME;
    double sigma = (double)parameters[CSG_LEAF_SIGMA];
    if (leaf->frame == CSG_FRAME_OFFSET) {
        l->own = parameters + CSG_LEAF_OWN_OFFSET;
        l->norm = fabs(sigma);
        for (int k = 0; k < 3; k++) {
            l->q[k] = c[k] - (double)frame[k];
            l->turn[k][k] = sigma;
        }
    } else {
        l->own = parameters + CSG_LEAF_OWN_AFFINE;
        place_affine(l, frame, c, sigma);
    }
}

static bool add_placed(csg_cone_leaf *l, const csg_tape *tape, const csg_tape_node *leaf,
                       const double c[3])
{
    place(l, tape, leaf, c);
    if (leaf->op == CSG_OP_SHAPE)
        return add_shape(l, tape);
    if (leaf->op == CSG_OP_FIELD)
        return add_formula(l, tape, leaf);
    return csg_op_is_primitive(leaf->op) && add_primitive(l, csg_op_node_kind(leaf->op));
}

bool csg_cone_add_leaf_in(csg_cone_balls *balls, const csg_tape *tape, const csg_tape_node *leaf,
                          const csg_cone_region *region)
{
    /* the slack: the frame's own rounding */
    const float *c = region->c;
    double at[3] = {(double)c[0], (double)c[1], (double)c[2]};
    double slack = (double)tape->parameters[leaf->parameters + CSG_LEAF_SLACK];
    double half = leaf->warp ? INFINITY : region->half + slack;
    csg_cone_leaf l = {.balls = balls,
                       .rho = region->radius + slack,
                       .half = {half, half, half},
                       .band = region->band,
                       .bend = INFINITY};
    csg_cone_way way;
    uint32_t first = balls->count;
    balls->corner = 0;
    if (leaf->warp && !csg_cone_warp(tape, leaf->warp, at, &l.rho, &way))
        return false;
    double before = l.rho;
    if (!add_placed(&l, tape, leaf, at))
        return false;
    bool is_smooth = balls->count - first == 1 && before > 0 && l.bend < INFINITY;
    balls->bend = is_smooth ? l.norm * (l.rho / before) * l.bend * (1 + 1e-6) : INFINITY;
    if (csg_op_has_faces(leaf->op) && balls->count - first > 1)
        balls->corner = l.norm; /* in its own frame they are unit vectors */
    return !leaf->warp || csg_cone_unwarp(&way, balls, first);
}

bool csg_cone_add_leaf(csg_cone_balls *balls, const csg_tape *tape, const csg_tape_node *leaf,
                       const float c[3], double radius)
{
    const csg_cone_region ball = {{c[0], c[1], c[2]}, radius, INFINITY, INFINITY};
    return csg_cone_add_leaf_in(balls, tape, leaf, &ball);
}

/* Is the formula a function of the coordinates all over, and not of some that are held? */
static bool is_within_domain(const csg_cone_box seeds[3])
{
    return seeds[0].low[0] > 0 && seeds[1].low[1] > 0 && seeds[2].low[2] > 0;
}

/* A formula around a point. */
typedef struct placed_formula {
    csg_cone_leaf leaf;
    const csg_tape_formula *formula;
    csg_cone_box box, seeds[3];
    double norm, slack; /* of the frame, and of places in it */
} placed_formula;

/* False: it is none, or one that somewhere in the ball is no function of the coordinates. */
static bool place_formula(placed_formula *p, const csg_tape *tape, const csg_tape_node *leaf,
                          const float c[3], double radius)
{
    double at[3] = {(double)c[0], (double)c[1], (double)c[2]};
    double slack = (double)tape->parameters[leaf->parameters + CSG_LEAF_SLACK];
    *p = (placed_formula){
        .leaf = {.rho = radius + slack, .half = {INFINITY, INFINITY, INFINITY}, .band = INFINITY}};
    if (leaf->op != CSG_OP_FIELD || leaf->warp)
        return false;
    place(&p->leaf, tape, leaf, at);
    p->formula = &tape->formulas[(uint32_t)p->leaf.own[0]];
    p->norm = p->leaf.rho / (radius + slack);
    p->slack = slack * p->norm;
    place_box(&p->leaf, p->formula, &p->box, p->seeds);
    return is_within_domain(p->seeds);
}

/* By what the formula's own is, in its frame. */
static double bend_in_tape(const placed_formula *p, double own)
{
    return p->leaf.norm * p->norm * own * (1 + 1e-6);
}

bool csg_cone_find_bend(const csg_tape *tape, const csg_tape_node *leaf, const float c[3],
                        double radius, csg_cone_ball *g, double *bend)
{
    csg_cone_balls balls = {.count = 0};
    placed_formula p;
    csg_cone_box gradient;
    double own;
    bool has_edges = false;
    if (!place_formula(&p, tape, leaf, c, radius) ||
        !csg_bend_formula(tape, p.formula, &p.box, &own))
        return false;
    p.leaf.balls = &balls;
    p.leaf.rho = p.slack;
    place_box(&p.leaf, p.formula, &p.box, p.seeds);
    if (!csg_cone_formula(tape, p.formula, &p.box, p.seeds, NULL, &gradient, &has_edges) ||
        has_edges)
        return false;
    double middle[3], half[3];
    middle_of_box(&gradient, middle, half);
    *bend = bend_in_tape(&p, own);
    if (!csg_cone_add(&p.leaf, middle[0], middle[1], middle[2], csg_norm3(half)))
        return false;
    *g = balls.items[0];
    return true;
}

bool csg_cone_find_pieces(const csg_tape *tape, const csg_tape_node *leaf, const float c[3],
                          double radius, csg_formula_pieces *out)
{
    placed_formula p;
    if (!place_formula(&p, tape, leaf, c, radius) || !csg_bend_pieces(tape, p.formula, &p.box, out))
        return false;
    out->bend = bend_in_tape(&p, out->bend);
    for (uint32_t i = 0; i < out->kink_count; i++)
        out->kinks[i].slope *= p.norm;
    return true;
}

double csg_cone_find_curving(const csg_tape *tape, uint32_t warp, csg_vec3 c, double radius)
{
    csg_cone_way way;
    double at[3] = {c.x, c.y, c.z}, rho = radius;
    if (!warp)
        return 0;
    if (!csg_cone_warp(tape, warp, at, &rho, &way) || way.count != 1)
        return INFINITY;
    return 0.5 * csg_norm3(way.turns[0].bend) * radius * radius;
}

double csg_cone_leaf_norm(const csg_tape *tape, const csg_tape_node *leaf)
{
    const float *parameters = tape->parameters + leaf->parameters;
    double sigma = fabs((double)parameters[CSG_LEAF_SIGMA]);
    return leaf->frame == CSG_FRAME_OFFSET ? sigma
                                           : sigma * csg_cone_norm(parameters + CSG_LEAF_FRAME);
}

/* In the shape's own frame distances are what they are in the tape's, over sigma. */
csg_beside csg_cone_find_beside(const csg_tape *tape, const csg_tape_node *leaf,
                                const csg_vec3 below[3], double turn, double at[3])
{
    const float *parameters = tape->parameters + leaf->parameters;
    double sigma = (double)parameters[CSG_LEAF_SIGMA], raise = (double)parameters[CSG_LEAF_RAISE];
    csg_vec3 own[3];
    csg_cone_leaf l = {.rho = 0};
    if (leaf->op != CSG_OP_SHAPE)
        return CSG_BESIDE_UNKNOWN;
    for (int k = 0; k < 3; k++) {
        const double c[3] = {below[k].x, below[k].y, below[k].z};
        place(&l, tape, leaf, c);
        own[k] = csg_vec3_make(l.q[0], l.q[1], l.q[2]);
        at[k] = (at[k] - turn * raise) / fabs(sigma);
    }
    const csg_shape *shape = tape->shapes[(uint32_t)l.own[0]];
    csg_beside known = csg_shape_beside(shape, own, sigma * turn > 0 ? 1 : -1, at);
    for (int k = 0; k < 3; k++)
        at[k] = fabs(sigma) * at[k] + turn * raise;
    return known;
}

bool csg_cone_warp_corners(const csg_tape *tape, uint32_t warp, const csg_vec3 triangle[3],
                           csg_vec3 out[3])
{
    for (int k = 0; k < 3; k++) {
        csg_cone_way way;
        double at[3] = {triangle[k].x, triangle[k].y, triangle[k].z}, rho = 0;
        if (warp && !csg_cone_warp(tape, warp, at, &rho, &way))
            return false;
        out[k] = csg_vec3_make(at[0], at[1], at[2]);
    }
    return true;
}

bool csg_cone_find_faces(csg_cone_balls *balls, csg_cone_face faces[CSG_CONE_MOST],
                         const csg_tape *tape, const csg_tape_node *leaf, const float c[3],
                         double radius)
{
    const float *parameters = tape->parameters + leaf->parameters;
    double sigma = (double)parameters[CSG_LEAF_SIGMA], raise = (double)parameters[CSG_LEAF_RAISE];
    double at[3] = {(double)c[0], (double)c[1], (double)c[2]};
    csg_cone_leaf l = {.balls = balls,
                       .faces = faces,
                       .rho = radius + (double)parameters[CSG_LEAF_SLACK],
                       .half = {INFINITY, INFINITY, INFINITY},
                       .band = INFINITY};
    balls->count = 0;
    if (leaf->warp || !csg_op_has(leaf->op, CSG_TRAIT_FACES) || !add_placed(&l, tape, leaf, at) ||
        l.face_count != balls->count || !(-raise / sigma >= l.sharp_from))
        return false;
    for (uint32_t i = 0; i < l.face_count; i++) {
        csg_cone_face f = faces[i];
        faces[i].value = sigma * f.value + raise;
        faces[i].below = fabs(sigma) * (sigma > 0 ? f.below : f.above);
        faces[i].above = fabs(sigma) * (sigma > 0 ? f.above : f.below);
    }
    return balls->count > 0;
}
