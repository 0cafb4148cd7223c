/* SPDX-License-Identifier: MIT
 * Gradients through operators; see slopes.h. A stack of operands, as the tape's own
 * evaluation has one.
 */
#include "mesh/distance/slopes.h"

#include <math.h>
#include <string.h>

#include "mesh/distance/slopes_private.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/blends.h"

typedef csg_slopes_operand operand;
typedef csg_slopes_walker walker;
typedef csg_slopes_range range;
typedef csg_slopes_which which;

/* ---- differences and shares --------------------------------------------------------------------
 */

/* How much a field can change from c within the region whose gradients are in a ball of vectors. */
static double span_of(const walker *w, const double at[3], double spread)
{
    const csg_gradients_region *r = &w->region;
    double most = 0;
    for (int i = 0; i < 3; i++) {
        csg_vec3 to = csg_vec3_sub(r->triangle[i], r->c);
        double change = fabs(at[0] * to.x + at[1] * to.y + at[2] * to.z);
        most = change > most ? change : most;
    }
    return most + r->around * csg_norm3(at) + r->half * (fabs(at[0]) + fabs(at[1]) + fabs(at[2])) +
           spread * w->radius;
}

/* The same of a + sign b, whose gradients are in the balls' hulls. */
static double span_of_pairs(const walker *w, const operand *a, const operand *b, double sign)
{
    double most = 0;
    for (uint32_t i = 0; i < a->balls.count; i++)
        for (uint32_t k = 0; k < b->balls.count; k++) {
            const csg_cone_ball *p = &a->balls.items[i], *q = &b->balls.items[k];
            const double both[3] = {p->at[0] + sign * q->at[0], p->at[1] + sign * q->at[1],
                                    p->at[2] + sign * q->at[2]};
            most = fmax(most, span_of(w, both, p->spread + q->spread));
        }
    return most;
}

/* How much it can change within the region. */
double csg_slopes_span(const walker *w, const operand *leaf)
{
    double most = 0;
    if (leaf->faces || leaf->stretched || leaf->balls.has_edges)
        return leaf->longest * w->radius;
    for (uint32_t i = 0; i < leaf->balls.count; i++)
        most = fmax(most, span_of(w, leaf->balls.items[i].at, leaf->balls.items[i].spread));
    return most;
}

double csg_slopes_change(const walker *w, const operand *a, const operand *b)
{
    if (a->stretched || b->stretched || a->balls.has_edges || b->balls.has_edges)
        return fmax(2 * fmax((double)w->tape->steepest, (double)w->tape->lipschitz),
                    a->longest + b->longest) *
               w->radius;
    if (a->faces || b->faces)
        return 1.41421357 * (csg_slopes_sets_apart(&a->balls, &b->balls) * w->radius);
    return span_of_pairs(w, a, b, -1);
}

double csg_slopes_change_of_sum(const walker *w, const operand *a, const operand *b)
{
    if (csg_slopes_are_opposite(w, a, b))
        return 0;
    if (csg_slopes_exceed_hull(a) || csg_slopes_exceed_hull(b))
        return (a->longest + b->longest) * w->radius;
    return span_of_pairs(w, a, b, 1);
}

/* By how much it can change from c, within the region. */
double csg_slopes_reach(const walker *w, const operand *a, const operand *b)
{
    return csg_slopes_change(w, a, b) + a->doubt + b->doubt;
}

/* What a blend adds to the larger operand, and its slope, where the operands differ by d. */
static blended blend_at(uint8_t blend, float n, float chi, double d)
{
    float x = (float)fabs(d);
    switch ((csg_blend_kind)blend) {
#define CSG_FOLD(NAME, name, area, raw, support, excess, smooth, convex, doc)                      \
    case CSG_BLEND_##NAME:                                                                         \
        return name##_float(n, chi, x);
#define CSG_BLEND(NAME, name, area, raw, support, excess, smooth, convex, doc)                     \
    case CSG_BLEND_##NAME: /* the larger one */                                                    \
        break;
#define CSG_RULE(NAME, name, space, fold, interval, demand, lipschitz, equal, doc)                 \
    case CSG_BLEND_##NAME: /* no binary blend */                                                   \
        break;
#include "scene/operators/operators.def"
    case CSG_BLEND_ORTHOGONAL:
    case CSG_BLEND_END:
        break; /* the larger one, or nothing that folds */
    }
    return (blended){0, 0};
}

/* The share of operand a where a - b = d, of a union. */
static double share_at(uint8_t blend, float n, float chi, double d)
{
    float slope = blend_at(blend, n, chi, d).slope;
    if (!csg_blend_is_convex(blend)) /* anything, once it begins */
        slope = (float)fabs(d) < chi ? -1.0f : 0;
    return d > 0 ? 1 + (double)slope : -(double)slope;
}

/* It grows with the difference. Where the shape jumps, at 0, both sides are taken. */
static range shares_of(uint8_t blend, float n, float chi, double low, double high)
{
    static const double ROUNDING = 1e-5;
    range r = {share_at(blend, n, chi, low), share_at(blend, n, chi, high)};
    if (!csg_blend_is_convex(blend) && low < (double)chi && high > -(double)chi)
        r = (range){0, 1};
    if (r.low >= 1 || r.high <= 0)
        return r;
    return (range){fmax(0, fmin(r.low, r.high) - ROUNDING),
                   fmin(1, fmax(r.low, r.high) + ROUNDING)};
}

/* ---- mixing ------------------------------------------------------------------------------------
 */

static bool add_mixture(csg_cone_balls *balls, const csg_cone_ball *a, const csg_cone_ball *b,
                        double share)
{
    if (balls->count >= CSG_CONE_MOST)
        return false;
    csg_cone_ball *out = &balls->items[balls->count++];
    for (int k = 0; k < 3; k++)
        out->at[k] = share * a->at[k] + (1 - share) * b->at[k];
    out->spread = share * a->spread + (1 - share) * b->spread;
    return true;
}

/* A pair's mixtures lie between those of the least and of the largest share; where these are near
 * to each other one ball around both will do. Of a mixture in the middle the spread, too, differs
 * from theirs by half of the shares' range at most. */
static bool mix_pair(csg_cone_balls *balls, const csg_cone_ball *a, const csg_cone_ball *b, range r)
{
    static const double NARROW = 0.3;
    if (r.high - r.low > NARROW)
        return add_mixture(balls, a, b, r.low) && add_mixture(balls, a, b, r.high);
    if (!add_mixture(balls, a, b, 0.5 * (r.low + r.high)))
        return false;
    const double d[3] = {a->at[0] - b->at[0], a->at[1] - b->at[1], a->at[2] - b->at[2]};
    balls->items[balls->count - 1].spread +=
        0.5 * (r.high - r.low) * (csg_norm3(d) + fabs(a->spread - b->spread));
    return true;
}

static bool append_balls(csg_cone_balls *to, const csg_cone_balls *from)
{
    if (to->count + from->count > CSG_CONE_MOST)
        return false;
    memcpy(&to->items[to->count], from->items, from->count * sizeof *from->items);
    to->count += from->count;
    return true;
}

/* All pairs. What is longer than the hull of an operand's faces is so along these: they are added
 * as they are. */
static bool mix_pairs(operand *a, const operand *b, range share)
{
    csg_cone_balls from = a->balls;
    a->balls.count = 0;
    for (uint32_t i = 0; i < from.count; i++)
        for (uint32_t k = 0; k < b->balls.count; k++)
            if (!mix_pair(&a->balls, &from.items[i], &b->balls.items[k], share))
                return false;
    return (!a->faces || append_balls(&a->balls, &from)) &&
           (!b->faces || append_balls(&a->balls, &b->balls));
}

/* a becomes the mixture with b; the value is the caller's. */
bool csg_slopes_mix(operand *a, const operand *b, range share, bool is_sharp)
{
    static const double ANY = 0.7; /* shares that are as good as any */
    if (share.low >= 1)
        return true;
    if (share.high <= 0) {
        a->balls = b->balls;
        a->longest = b->longest;
        a->stretched = b->stretched;
        a->faces = b->faces;
        a->kink = b->kink;
        a->sag = b->sag;
        return true;
    }
    operand before = *a;
    bool faces = a->faces || b->faces;
    bool mixed = !is_sharp && (!faces || share.high - share.low <= ANY) && mix_pairs(a, b, share);
    if (!mixed) { /* any share */
        *a = before;
        if ((!is_sharp && !faces) || !append_balls(&a->balls, &b->balls))
            return false;
    }
    a->balls.has_edges |= b->balls.has_edges;
    a->longest = fmax(a->longest, b->longest);
    a->stretched |= b->stretched;
    a->faces |= b->faces;
    a->kink = INFINITY;
    return true;
}

/* ---- operators ---------------------------------------------------------------------------------
 */

static double joined_value(const csg_tape_node *node, float n, float chi, double a, double b)
{
    return fmax(a, b) + (double)blend_at(node->join_blend, n, chi, a - b).value;
}

double csg_slopes_fold(const csg_tape_node *node, float n, float chi, double a, double b,
                       double *share)
{
    *share = share_at(node->join_blend, n, chi, a - b);
    return joined_value(node, n, chi, a, b);
}

static double orthogonal_value(double n, double turn, double a, double b)
{
    double u = turn * (a - n), v = turn * (b - n);
    return u > 0 && v > 0 ? n + turn * sqrt(u * u + v * v) : turn * fmax(turn * a, turn * b);
}

/* What the larger one of two operands is nowhere less than in the region: their mean with some
 * weights, whose gradient is next to nothing where two solids share a face, so that a field of zero
 * is seen to be no surface. turn: of the operands' values. */
static double least_of_larger(const walker *w, const operand *a, const operand *b, double turn)
{
    double along = 0, square = 0, most = 0;
    if (a->stretched || b->stretched || a->faces || b->faces || a->balls.has_edges ||
        b->balls.has_edges)
        return -INFINITY;
    for (int k = 0; k < 3; k++) {
        double difference = b->balls.items[0].at[k] - a->balls.items[0].at[k];
        along += b->balls.items[0].at[k] * difference;
        square += difference * difference;
    }
    double share = square > 0 ? fmax(0, fmin(1, along / square)) : 0.5, other = 1 - share;
    for (uint32_t i = 0; i < a->balls.count; i++)
        for (uint32_t k = 0; k < b->balls.count; k++) {
            const csg_cone_ball *p = &a->balls.items[i], *q = &b->balls.items[k];
            double mean[3];
            for (int axis = 0; axis < 3; axis++)
                mean[axis] = share * p->at[axis] + other * q->at[axis];
            most = fmax(most, span_of(w, mean, share * p->spread + other * q->spread));
        }
    return turn * (share * a->value + other * b->value) - most;
}

/* An intersection is a union of what is turned around: shares are the same, values too but for the
 * sign. */
static bool join_operands(walker *w, const csg_tape_node *node)
{
    if (csg_blend_is_rule(node->join_blend))
        return csg_slopes_join_rule(w, node);
    const float *parameters = w->tape->parameters + node->join_parameters;
    float n = parameters[CSG_OPERATOR_N], chi = parameters[CSG_OPERATOR_SUPPORT];
    operand *a = &w->stack[w->top - 2], *b = &w->stack[w->top - 1];
    double turn = node->join == CSG_JOIN_UNION ? 1 : -1;
    double reach = csg_slopes_reach(w, a, b);
    double d = turn * (a->value - b->value);
    w->top--;
    if (node->join_blend == CSG_BLEND_ORTHOGONAL) {
        /* an edge where both are beyond n; else the larger one */
        double u = turn * (a->value - (double)n), v = turn * (b->value - (double)n);
        bool edge = fmin(u, v) > -2 * w->radius - a->doubt - b->doubt;
        range r = edge ? (range){0, 1} : shares_of(CSG_BLEND_SHARP, n, chi, d - reach, d + reach);
        double value = orthogonal_value((double)n, turn, a->value, b->value);
        bool done = csg_slopes_mix(a, b, r, true);
        a->low = orthogonal_value((double)n, turn, a->low, b->low);
        a->high = orthogonal_value((double)n, turn, a->high, b->high);
        a->least = orthogonal_value((double)n, turn, a->least, b->least);
        a->most = orthogonal_value((double)n, turn, a->most, b->most);
        a->stretched |= edge;
        a->faces |= edge;
        a->longest *= edge ? 1.41421357 : 1;
        a->value = value;
        a->doubt += b->doubt;
        return done;
    }
    range r = shares_of(node->join_blend, n, chi, d - reach, d + reach);
    /* of a sharp one little can be settled by that, and asking costs more */
    bool mixes = r.low < 1 && r.high > 0 && node->join_blend != CSG_BLEND_SHARP;
    double kink = mixes ? fmax(a->kink, b->kink) + 0.25 * csg_slopes_parting(w, a, b) : 0;
    double sag = fmax(a->sag, b->sag);
    double value = turn * joined_value(node, n, chi, turn * a->value, turn * b->value);
    double least = turn * least_of_larger(w, a, b, turn);
    a->least = turn * joined_value(node, n, chi, turn * a->least, turn * b->least);
    a->most = turn * joined_value(node, n, chi, turn * a->most, turn * b->most);
    if (turn > 0)
        a->least = fmax(a->least, least);
    else
        a->most = fmin(a->most, least);
    a->doubt = fmax(a->doubt, b->doubt) + 1e-6 * fabs(a->value - b->value);
    a->value = value;
    a->low = turn * joined_value(node, n, chi, turn * a->low, turn * b->low) - a->doubt;
    a->high = turn * joined_value(node, n, chi, turn * a->high, turn * b->high) + a->doubt;
    bool done = csg_slopes_mix(a, b, r, node->join_blend == CSG_BLEND_SHARP);
    if (mixes) {
        a->kink = kink;
        a->sag = sag;
    }
    return done;
}

double csg_slopes_value(const operand *o, which w)
{
    switch (w) {
    case CSG_SLOPES_MIDDLE:
        return o->value;
    case CSG_SLOPES_LOW:
        return o->low;
    case CSG_SLOPES_HIGH:
        return o->high;
    case CSG_SLOPES_LEAST:
        return o->least;
    case CSG_SLOPES_MOST:
        return o->most;
    }
    return NAN;
}

/* ---- the walk ----------------------------------------------------------------------------------
 */

/* A subtree, or all of the tape. */
static bool walk_nodes(walker *w, uint32_t first, uint32_t count)
{
    for (uint32_t i = first; i < first + count; i++) {
        const csg_tape_node *node = &w->tape->nodes[i];
        bool known = node->op == CSG_OP_UNION || node->op == CSG_OP_INTERSECTION;
        if (csg_op_is_leaf(node->op)) {
            w->nodes[w->top].first = i;
            known = csg_slopes_push_leaf(w, node);
        } else if (csg_op_is_round(node->op)) {
            known = csg_slopes_join_round(w, node);
        } else if (csg_op_is_fillet(node->op)) {
            known = csg_slopes_join_fillet(w, node);
        } else if (node->op == CSG_OP_COMBINE) {
            known = csg_slopes_combine(w, node);
        } else if (csg_op_delivers(node->op)) {
            csg_slopes_deliver(w, node);
            known = true;
        }
        w->nodes[w->top - 1].end = i + 1;
        if (!known || (node->join && !join_operands(w, node)))
            return false;
        w->nodes[w->top - 1].end = i + 1;
    }
    return true;
}

/* Parts that touch: one half where the region does not reach the plane, else any of both. */
static bool join_halves(walker *w, const csg_touching *t)
{
    operand *a = &w->stack[0], *b = &w->stack[1];
    const double slope[3] = {t->slope.x, t->slope.y, t->slope.z};
    double side = csg_touching_side(t, w->region.c), reach = span_of(w, slope, 0) + t->doubt;
    w->top = 1;
    if (side > reach)
        return true;
    if (side < -reach) {
        *a = *b;
        return true;
    }
    a->low = fmin(a->low, b->low) - t->doubt;
    a->high = fmax(a->high, b->high) + t->doubt;
    a->least = fmin(a->least, b->least);
    a->most = fmax(a->most, b->most);
    a->doubt = fmax(a->doubt, b->doubt) + t->doubt;
    a->value = side < 0 ? b->value : a->value;
    return csg_slopes_mix(a, b, (range){0, 1}, true);
}

static bool walk(walker *w, const csg_touching *t)
{
    if (!t->is_there)
        return walk_nodes(w, 0, t->tape->count);
    for (int i = 0; i < 2; i++)
        if (!walk_nodes(w, (uint32_t)(t->halves[i].nodes - t->tape->nodes), t->halves[i].count))
            return false;
    return join_halves(w, t);
}

/* The middle of the balls, whose hull they are in, or where combinations of these may be longer of
 * a ball around those; and how far from it they are at most, along the triangle's plane alone too:
 * of gradients that differ in length, as those of thin walls do, that is much less. */
static void find_stray(const walker *w, const operand *root, csg_gradients *out)
{
    const csg_cone_balls *balls = &root->balls;
    csg_cone_ball middle = {.at = {0, 0, 0}};
    out->stray = out->across = INFINITY;
    if (balls->count && csg_slopes_exceed_hull(root)) {
        out->is_axis_known = true;
        out->has_axis = csg_cone_find_axis(balls, &out->cone);
        if (out->has_axis && csg_slopes_enclose_around(balls, &out->cone, root->longest, &middle))
            out->stray = out->across = middle.spread;
    } else if (balls->count) {
        middle = csg_slopes_ball_around(balls);
        out->stray = middle.spread;
        out->across = 0;
        for (uint32_t i = 0; i < balls->count; i++) {
            const csg_cone_ball *ball = &balls->items[i];
            csg_vec3 off = {ball->at[0] - middle.at[0], ball->at[1] - middle.at[1],
                            ball->at[2] - middle.at[2]};
            double square = csg_vec3_dot(off, off), along = csg_vec3_dot(off, w->normal);
            double across = square > along * along ? sqrt(square - along * along) : 0;
            out->across = fmax(out->across, across + ball->spread);
        }
    }
    memcpy(out->middle, middle.at, sizeof middle.at);
}

/* Of the balls' hull; where faces meet, combinations may be longer. */
static double find_longest(const operand *root)
{
    const csg_cone_balls *balls = &root->balls;
    double most = 0;
    if (csg_slopes_exceed_hull(root))
        return root->longest;
    for (uint32_t i = 0; i < balls->count; i++)
        most = fmax(most, csg_norm3(balls->items[i].at) + balls->items[i].spread);
    return most;
}

/* What the walk has left. False: no bound is known. */
static bool take_result(const walker *w, csg_gradients *out)
{
    const operand *root = &w->stack[0];
    out->balls = root->balls;
    out->value = root->value;
    out->longest = find_longest(root);
    out->exceeds = csg_slopes_exceed_hull(root);
    out->low = root->low;
    out->high = root->high;
    out->least = root->least;
    out->most = root->most;
    out->kink = root->kink;
    out->sag = root->sag;
    out->is_axis_known = false;
    find_stray(w, root, out);
    out->doubt = root->doubt;
    out->has_level = w->has_level;
    if (w->has_level)
        out->level = w->level.balls;
    return out->balls.count > 0;
}

/* 0 where it is none. */
static csg_vec3 normal_of(const csg_vec3 v[3])
{
    csg_vec3 n = csg_vec3_cross(csg_vec3_sub(v[1], v[0]), csg_vec3_sub(v[2], v[0]));
    double length = csg_vec3_norm(n);
    return length > 0 ? csg_vec3_scale(n, 1 / length) : (csg_vec3){0, 0, 0};
}

/* Or are all of them around a place. */
static bool have_triangles(const csg_gradients_region *regions, size_t count)
{
    bool any = false;
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < CSG_SLOPES_CORNERS; k++) {
            csg_vec3 v = regions[i].triangle[k], c = regions[i].c;
            any |= v.x != c.x || v.y != c.y || v.z != c.z;
        }
    return any;
}

void csg_gradients_find_each(const csg_kernel *kernel, const csg_touching *field,
                             const csg_gradients_region *regions, size_t count, float *scratch,
                             size_t scratch_floats, csg_gradients *const *out, bool *is_known)
{
    const csg_tape *tape = field->tape;
    enum { PLACES = CSG_SLOPES_CORNERS + 1 };
    float values[CSG_SLOPES_NODES * PLACES * CSG_OCTANTS];
    float x[PLACES * CSG_OCTANTS], y[PLACES * CSG_OCTANTS], z[PLACES * CSG_OCTANTS];
    walker w; /* not filled: its stack is large */
    for (size_t i = 0; i < count; i++)
        is_known[i] = false;
    if (tape->count > CSG_SLOPES_NODES || !tape->count)
        return;
    w.kernel = kernel;
    w.tape = tape;
    w.scratch = scratch;
    w.scratch_floats = scratch_floats;
    w.places = have_triangles(regions, count) ? PLACES : 1;
    size_t all = count * w.places;
    x[0] = y[0] = z[0] = 0; /* set also where there are no regions */
    w.stride = (all + CSG_OCTANTS - 1) / CSG_OCTANTS * CSG_OCTANTS;
    for (size_t i = 0; i < w.stride; i++) { /* the last one again, where vectors have more room */
        size_t n = i < all ? i : all - 1, k = n % w.places;
        const csg_gradients_region *r = &regions[n / w.places];
        csg_vec3 p = k + 1 < w.places ? r->triangle[k] : r->c;
        x[i] = (float)p.x;
        y[i] = (float)p.y;
        z[i] = (float)p.z;
    }
    kernel->leaves(tape, x, y, z, w.stride, values);
    for (size_t i = 0; i < count; i++) {
        w.values = values + i * w.places;
        w.region = regions[i];
        w.flat = 0;
        w.top = 0;
        w.has_level = false;
        for (int k = 0; k < CSG_SLOPES_CORNERS; k++)
            w.flat = fmax(w.flat, csg_vec3_norm(csg_vec3_sub(w.region.triangle[k], w.region.c)));
        w.normal = normal_of(w.region.triangle);
        w.radius = w.flat + w.region.around + sqrt(3.0) * w.region.half;
        is_known[i] = walk(&w, field) && take_result(&w, out[i]);
    }
}

bool csg_gradients_find(const csg_kernel *kernel, const csg_tape *tape,
                        const csg_gradients_region *region, float *scratch, size_t scratch_floats,
                        csg_gradients *out)
{
    bool is_known;
    const csg_touching field = csg_touching_none(tape);
    csg_gradients_find_each(kernel, &field, region, 1, scratch, scratch_floats, &out, &is_known);
    return is_known;
}

bool csg_gradients_find_axis(const csg_gradients *gradients, csg_cone *out)
{
    if (!gradients->is_axis_known)
        return csg_cone_find_axis(&gradients->balls, out);
    *out = gradients->cone;
    return gradients->has_axis;
}
