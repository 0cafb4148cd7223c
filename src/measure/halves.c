/* SPDX-License-Identifier: MIT
 * Formulas of half spaces from tapes; see halves.h. A stack of operands, as the tape's own
 * evaluation has one; their planes and code stand one after the other in what goes out.
 */
#include "measure/halves.h"

#include <math.h>
#include <string.h>

#include "field/gradients/cone_leaf.h"
#include "field/point.h"
#include "scene/operators/blend.h"
#include "scene/operators/blend_kinds.h"
#include "scene/primitives/kinds.h"

typedef struct operand {
    uint32_t first;  /* node of its subtree */
    int plane, at;   /* where its planes and its code begin */
    bool signs_only; /* the planes tell inside from outside, not the field's value */
} operand;

/* What a blend makes of planes' values, all turned, and the shares of them. */
typedef struct blender {
    const csg_tape_node *node; /* NULL: a round one */
    float n, support;
} blender;

enum { ORIGIN_MOST = 4 };

/* Of a plane: the blend that it encloses, turned, up to these errors. */
typedef struct origin {
    csg_enclosure operands[ORIGIN_MOST];
    uint32_t count; /* 0: it is none, or of more operands */
    blender by;
    double turn, below, above;
} origin;

typedef struct walker {
    const csg_kernel *kernel;
    const csg_tape *tape;
    const double *c;
    double half, radius; /* of the cube; of the ball around it */
    bool with_strays;
    float *scratch;
    size_t scratch_floats;
    float low[CSG_SLOPES_NODES * CSG_OCTANTS], high[CSG_SLOPES_NODES * CSG_OCTANTS]; /* corners */
    float low_at_c[CSG_SLOPES_NODES * CSG_OCTANTS], high_at_c[CSG_SLOPES_NODES * CSG_OCTANTS];
    operand stack[CSG_SLOPES_NODES];
    uint32_t top;
    origin origins[CSG_HALVES_MOST];
    csg_halves *out;
} walker;

static double corner(const walker *w, int o, int axis)
{
    return o >> axis & 1 ? w->half : -w->half;
}

static double plane_at(const csg_enclosure *e, const double at[3])
{
    return e->value + e->slope[0] * at[0] + e->slope[1] * at[1] + e->slope[2] * at[2];
}

static double plane_at_corner(const walker *w, const csg_enclosure *e, int o)
{
    const double at[3] = {corner(w, o, 0), corner(w, o, 1), corner(w, o, 2)};
    return plane_at(e, at);
}

/* ---- the formula -------------------------------------------------------------------------------
 */

static bool put_code(csg_halves *h, int code)
{
    if (h->length >= CSG_HALVES_CODE)
        return false;
    h->code[h->length++] = (signed char)code;
    return true;
}

static bool put_plane(walker *w, const csg_enclosure *e)
{
    csg_halves *h = w->out;
    if (h->plane_count >= CSG_HALVES_MOST || !put_code(h, h->plane_count))
        return false;
    w->origins[h->plane_count].count = 0;
    h->planes[h->plane_count++] = *e;
    return true;
}

static void push_operand(walker *w, uint32_t first)
{
    w->stack[w->top++] =
        (operand){.first = first, .plane = w->out->plane_count, .at = w->out->length};
}

/* What the operand has is taken back. */
static void forget(walker *w, const operand *o)
{
    w->out->plane_count = o->plane;
    w->out->length = o->at;
}

/* The operand's plane, where it is one alone. */
static csg_enclosure *single(const walker *w, const operand *o)
{
    bool is_last = o == &w->stack[w->top - 1];
    int end = is_last ? w->out->length : o[1].at;
    return end - o->at == 1 ? &w->out->planes[o->plane] : NULL;
}

/* The operand's value is known by one plane. */
static bool has_value(const walker *w, const operand *o)
{
    return single(w, o) && !o->signs_only;
}

/* ---- pieces ------------------------------------------------------------------------------------
 */

/* What a rule folds has its value where its operator ends it: it takes the place of that. */
static csg_tape_node end_of(const csg_tape_node *last, uint32_t count)
{
    csg_tape_node end = *last;
    end.op = last->join == CSG_JOIN_UNION ? CSG_OP_UNION : CSG_OP_INTERSECTION;
    end.join = CSG_JOIN_NONE;
    end.blend = last->join_blend;
    end.parameters = last->join_parameters;
    end.size = count;
    end.arity = 2;
    return end;
}

/* The subtree of these nodes becomes one operand, between the planes that its gradients allow. */
static bool take_whole(walker *w, uint32_t first, uint32_t last, bool with_join)
{
    csg_tape_node nodes[CSG_SLOPES_NODES];
    csg_tape tape = *w->tape;
    csg_enclosure e;
    tape.nodes = nodes;
    tape.count = last - first + 1;
    memcpy(nodes, w->tape->nodes + first, tape.count * sizeof *nodes);
    if (!with_join)
        nodes[last - first].join = CSG_JOIN_NONE;
    bool is_rule = with_join && csg_blend_is_rule(nodes[last - first].join_blend);
    if (is_rule && tape.count == CSG_SLOPES_NODES)
        return false;
    if (is_rule) {
        nodes[tape.count] = end_of(&nodes[last - first], tape.count + 1);
        tape.count++;
    }
    if (!csg_enclosure_find(w->kernel, &tape, w->c, w->half, w->scratch, w->scratch_floats, &e))
        return false;
    push_operand(w, first);
    return put_plane(w, &e);
}

/* How far the gradient of a leaf may be from what floats say. A capsule's is the direction from the
 * nearest point of its segment: near that, nothing but rounding. Others' have errors there that
 * keep them among the slopes of planes above the field. */
static bool find_stray(const csg_tape *tape, const csg_tape_node *leaf, const double c[3],
                       double *stray)
{
    const float at[3] = {(float)c[0], (float)c[1], (float)c[2]};
    csg_cone_balls balls = {.count = 0};
    *stray = 0;
    if (leaf->op != CSG_OP_OF(CAPSULE))
        return true;
    double slack = (double)tape->parameters[leaf->parameters + CSG_LEAF_SLACK];
    if (!csg_cone_add_leaf(&balls, tape, leaf, at, slack) || balls.count != 1)
        return false;
    *stray = 2 * balls.items[0].spread;
    return true;
}

/* How far the leaf's gradients in the cube's ball are from this one. 0: it is not known. */
static double stray_of_leaf(const walker *w, const csg_tape_node *leaf, csg_vec3 g)
{
    const float at[3] = {(float)w->c[0], (float)w->c[1], (float)w->c[2]};
    csg_cone_balls balls = {.count = 0};
    if (!w->with_strays || !csg_cone_add_leaf(&balls, w->tape, leaf, at, w->radius) ||
        balls.count != 1)
        return 0;
    const csg_cone_ball *ball = &balls.items[0];
    csg_vec3 d = csg_vec3_sub(csg_vec3_make(ball->at[0], ball->at[1], ball->at[2]), g);
    return ball->spread + csg_vec3_norm(d) + CSG_ENCLOSURE_ROUNDING * fmax(1, csg_vec3_norm(g));
}

/* A concave field is nowhere above its tangent plane, and farthest below it at a corner of the
 * cube. */
static bool find_of_concave(walker *w, uint32_t index, csg_enclosure *e)
{
    csg_tape_node alone = w->tape->nodes[index];
    csg_tape tape = *w->tape;
    const float *low = w->low + (size_t)index * CSG_OCTANTS,
                *high = w->high + (size_t)index * CSG_OCTANTS;
    double at_low = (double)w->low_at_c[(size_t)index * CSG_OCTANTS];
    double at_high = (double)w->high_at_c[(size_t)index * CSG_OCTANTS], most = 0, stray;
    bool is_turned = tape.parameters[alone.parameters + CSG_LEAF_SIGMA] < 0;
    alone.join = CSG_JOIN_NONE;
    tape.nodes = &alone;
    tape.count = 1;
    if (!find_stray(&tape, &alone, w->c, &stray))
        return false;
    csg_vec3 g = csg_tape_gradient_at(w->kernel, &tape, csg_vec3_make(w->c[0], w->c[1], w->c[2]),
                                      w->scratch, w->scratch_floats);
    *e = (csg_enclosure){.value = 0.5 * (at_low + at_high),
                         .slope = {g.x, g.y, g.z},
                         .stray = stray_of_leaf(w, &alone, g),
                         .is_convex = true};
    for (int o = 0; o < CSG_OCTANTS; o++) {
        double plane = plane_at_corner(w, e, o);
        most = fmax(most, is_turned ? (double)high[o] - plane : plane - (double)low[o]);
    }
    /* Of the tangent plane; on the other side the corners' intervals have it all. */
    double rounding =
        (at_high - at_low) + CSG_ENCLOSURE_ROUNDING * fmax(1, csg_vec3_norm(g)) * 2 * w->half;
    rounding += stray * w->radius;
    most += 1e-12 * (fabs(e->value) + w->half);
    e->below = is_turned ? rounding : most;
    e->above = is_turned ? most : rounding;
    return isfinite(e->value + e->below + e->above + csg_vec3_norm(g));
}

/* Where its faces meet, as their intersection. They are found in doubles from the tape's
 * parameters, so that nothing but the rounding of these is in them: of a matrix, an offset and the
 * leaf's own lengths, each half a unit in the last place of a float of what it is multiplied by.
 * That is a sixteenth of the leaf's slack at most, where a value by floats has all of it. */
static bool put_faces(walker *w, uint32_t index)
{
    static const double OF_VALUES = 0.125 /* of the slack */, OF_NORMALS = 1e-6;
    const csg_tape_node *leaf = &w->tape->nodes[index];
    const float *parameters = w->tape->parameters + leaf->parameters;
    const float c[3] = {(float)w->c[0], (float)w->c[1], (float)w->c[2]};
    csg_cone_balls balls = {.count = 0};
    csg_cone_face faces[CSG_CONE_MOST];
    int joined = parameters[CSG_LEAF_SIGMA] < 0 ? CSG_HALVES_UNION : CSG_HALVES_INTERSECTION;
    if (!csg_cone_find_faces(&balls, faces, w->tape, leaf, c, w->radius))
        return false;
    for (uint32_t i = 0; i < balls.count; i++) {
        const double *g = balls.items[i].at;
        double turned = OF_NORMALS * fmax(1, sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]));
        double rounding = OF_VALUES * (double)parameters[CSG_LEAF_SLACK] + turned * w->radius;
        const csg_enclosure e = {.value = faces[i].value,
                                 .slope = {g[0], g[1], g[2]},
                                 .below = faces[i].below + rounding,
                                 .above = faces[i].above + rounding,
                                 .stray = w->with_strays ? balls.items[i].spread + turned : 0,
                                 .is_convex = true};
        if (!isfinite(e.value + e.below + e.above) || !put_plane(w, &e) ||
            (i && !put_code(w->out, joined)))
            return false;
    }
    return true;
}

/* Is it enclosed by its values at the cube's corners? */
static bool asks_corners(const csg_tape_node *leaf)
{
    return !leaf->warp && csg_op_has(leaf->op, CSG_TRAIT_CONVEX);
}

/* It is as flat as floats can tell; its faces may be known better. */
static bool is_all_rounding(const walker *w, const csg_tape_node *leaf, const csg_enclosure *e)
{
    static const double MOST = 4; /* times the slack */
    return csg_op_has(leaf->op, CSG_TRAIT_FACES) &&
           e->below + e->above <=
               MOST * (double)w->tape->parameters[leaf->parameters + CSG_LEAF_SLACK];
}

static bool push_leaf(walker *w, uint32_t index)
{
    static const double BENT = 0.05; /* of the half edge */
    const csg_tape_node *leaf = &w->tape->nodes[index];
    csg_enclosure e;
    if (!asks_corners(leaf))
        return take_whole(w, index, index, false);
    push_operand(w, index);
    if (!find_of_concave(w, index, &e))
        return false;
    bool is_flat = is_all_rounding(w, leaf, &e);
    if (is_flat || e.below + e.above > BENT * w->half || (w->with_strays && !(e.stray > 0))) {
        operand *o = &w->stack[w->top - 1];
        bool has_faces = put_faces(w, index), is_one = w->out->plane_count - o->plane == 1;
        o->signs_only = has_faces && !(is_flat && is_one); /* one flat face is the field itself */
        if (has_faces)
            return true;
        forget(w, o);
    }
    return put_plane(w, &e);
}

/* ---- operators ---------------------------------------------------------------------------------
 */

/* How far the plane reaches from its value at the centre. */
static double reach_of(const double slope[3], double half)
{
    return half * (fabs(slope[0]) + fabs(slope[1]) + fabs(slope[2])) * (1 + 1e-12);
}

/* Whether b is nowhere above a, both turned. */
static bool hides(const walker *w, const csg_enclosure *a, const csg_enclosure *b, double turn)
{
    double d[3];
    for (int k = 0; k < 3; k++)
        d[k] = a->slope[k] - b->slope[k];
    double room = turn > 0 ? a->below + b->above : a->above + b->below;
    return turn * (a->value - b->value) - reach_of(d, w->half) - room >= 0;
}

/* Whether the plane is nowhere above zero, turned: an orthogonal join with it is a sharp one. */
static bool is_negative(const walker *w, const csg_enclosure *e, double turn)
{
    double room = turn > 0 ? e->above : e->below;
    return turn * e->value + reach_of(e->slope, w->half) + room <= 0;
}

/* is_orthogonal: of the same sign only, unless one operand has no say. */
static bool join_sharply(walker *w, const csg_tape_node *node, bool is_orthogonal)
{
    operand *a = &w->stack[w->top - 2], *b = &w->stack[w->top - 1];
    double turn = node->join == CSG_JOIN_UNION ? 1 : -1;
    csg_enclosure *p = single(w, a), *q = single(w, b);
    bool plain = p && q && (is_negative(w, p, turn) || is_negative(w, q, turn));
    w->top--;
    a->signs_only |= b->signs_only || (is_orthogonal && !plain);
    if (p && q && hides(w, p, q, turn)) {
        forget(w, b);
        return true;
    }
    if (p && q && hides(w, q, p, turn)) {
        csg_enclosure kept = *q;
        origin from = w->origins[b->plane];
        forget(w, a);
        bool done = put_plane(w, &kept);
        w->origins[a->plane] = from;
        return done;
    }
    return put_code(w->out, turn > 0 ? CSG_HALVES_UNION : CSG_HALVES_INTERSECTION);
}

static double blend(const blender *b, const double *values, uint32_t count, double *shares)
{
    if (b->node) {
        double value = csg_slopes_fold(b->node, b->n, b->support, values[0], values[1], shares);
        shares[1] = 1 - shares[0];
        return value;
    }
    double value = csg_slopes_round(values, count, (double)b->n), sum = 0;
    for (uint32_t i = 0; i < count; i++)
        sum += shares[i] = fmax(values[i] - value + (double)b->n, 0);
    for (uint32_t i = 0; i < count; i++)
        shares[i] /= sum;
    return value;
}

static double distance_of(const double a[3], const double b[3])
{
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

/* How far two operands' difference in the cube may be from what it is at its centre. */
static double change_of(const walker *w, const csg_enclosure *a, const csg_enclosure *b)
{
    double d[3];
    for (int k = 0; k < 3; k++)
        d[k] = a->slope[k] - b->slope[k];
    return reach_of(d, w->half) + fmax(a->below + b->above, a->above + b->below);
}

/* The largest changes of the shares in the cube: those of a fold depend on the difference alone and
 * grow with it, those of a round blend are in the proportions of (f_i - F + n)_+. */
static void find_changes(const walker *w, const csg_enclosure *planes, uint32_t count,
                         const blender *b, double turn, const double *shares, double *changes)
{
    double low[CSG_SLOPES_NODES], high[CSG_SLOPES_NODES], lows = 0, highs = 0, change = 0;
    if (b->node) {
        double d = turn * (planes[0].value - planes[1].value), from, to;
        change = change_of(w, &planes[0], &planes[1]);
        csg_slopes_fold(b->node, b->n, b->support, d - change, 0, &from);
        csg_slopes_fold(b->node, b->n, b->support, d + change, 0, &to);
        changes[0] = changes[1] = fmax(shares[0] - from, to - shares[0]);
        return;
    }
    double values[CSG_SLOPES_NODES] = {0}, n = (double)b->n;
    for (uint32_t i = 0; i < count; i++) {
        values[i] = turn * planes[i].value;
        for (uint32_t k = 0; k < i; k++)
            change = fmax(change, change_of(w, &planes[i], &planes[k]));
    }
    double value = csg_slopes_round(values, count, n);
    change += 1e-5 * n;
    for (uint32_t i = 0; i < count; i++) {
        lows += low[i] = fmax(values[i] - value + n - change, 0);
        highs += high[i] = fmax(values[i] - value + n + change, 0);
    }
    for (uint32_t i = 0; i < count; i++) {
        double least = low[i] > 0 ? low[i] / (low[i] + highs - high[i]) : 0;
        double most = high[i] > 0 ? high[i] / (high[i] + lows - low[i]) : 0;
        changes[i] = fmax(shares[i] - least, most - shares[i]);
    }
}

/* How far the blend's gradients in the cube are from this one, which has these shares of the
 * planes' slopes. 0: it is not known. */
static double stray_of_blend(const walker *w, const csg_enclosure *planes, uint32_t count,
                             const blender *b, double turn, const double *shares,
                             const double slope[3])
{
    double changes[CSG_SLOPES_NODES], most = 0, sum = CSG_ENCLOSURE_ROUNDING;
    for (uint32_t i = 0; i < count; i++) {
        if (!w->with_strays || !(planes[i].stray > 0))
            return 0;
        most = fmax(most, planes[i].stray);
    }
    find_changes(w, planes, count, b, turn, shares, changes);
    for (uint32_t i = 0; i < count; i++)
        sum += changes[i] * distance_of(planes[i].slope, slope);
    return sum + most;
}

/* A union by a convex blend is a convex function of its operands, so with planes for them it is
 * nowhere below its tangent plane, and farthest above it at a corner of the cube. And it grows with
 * its operands, by no more than the most that one of them does. */
static bool join_smoothly(walker *w, const operand *of, uint32_t count, const blender *b,
                          double turn)
{
    static const double ROUNDING = 2e-6; /* of floats in blends */
    double values[CSG_SLOPES_NODES] = {0}, shares[CSG_SLOPES_NODES], ignored[CSG_SLOPES_NODES];
    const csg_enclosure *planes = &w->out->planes[of->plane];
    csg_enclosure e = {.below = 0};
    double most = 0, widest = 0;
    for (uint32_t i = 0; i < count; i++) {
        values[i] = turn * planes[i].value;
        e.below = fmax(e.below, planes[i].below);
        e.above = fmax(e.above, planes[i].above);
    }
    e.value = turn * blend(b, values, count, shares);
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            e.slope[k] += shares[i] * planes[i].slope[k];
    for (int o = 0; o < CSG_OCTANTS; o++) {
        for (uint32_t i = 0; i < count; i++) {
            values[i] = turn * plane_at_corner(w, &planes[i], o);
            widest = fmax(widest, fabs(values[i] - values[0]));
        }
        most = fmax(most, blend(b, values, count, ignored) - turn * plane_at_corner(w, &e, o));
    }
    double rounding = ROUNDING * (widest + fabs(e.value)) + (b->node ? 0 : 1e-5 * (double)b->n);
    rounding += CSG_ENCLOSURE_ROUNDING * reach_of(e.slope, w->half);
    origin from = {.count = count <= ORIGIN_MOST ? count : 0, .by = *b, .turn = turn};
    e.stray = stray_of_blend(w, planes, count, b, turn, shares, e.slope);
    from.below = rounding + (turn > 0 ? e.below : e.above);
    from.above = rounding + (turn > 0 ? e.above : e.below);
    memcpy(from.operands, planes, from.count * sizeof *planes);
    e.below += rounding + (turn < 0 ? most : 0);
    e.above += rounding + (turn > 0 ? most : 0);
    forget(w, of);
    if (!isfinite(e.value + e.below + e.above) || !put_plane(w, &e))
        return false;
    w->origins[of->plane] = from;
    return true;
}

bool csg_halves_joins_sharply(const csg_tape *tape, const csg_tape_node *node)
{
    float n = tape->parameters[node->join_parameters + CSG_OPERATOR_N];
    return node->join_blend == CSG_BLEND_SHARP ||
           (node->join_blend == CSG_BLEND_ORTHOGONAL && !(n > 0) && !(n < 0));
}

static bool join_siblings(walker *w, uint32_t index)
{
    const csg_tape_node *node = &w->tape->nodes[index];
    const float *parameters = w->tape->parameters + node->join_parameters;
    const blender b = {node, parameters[CSG_OPERATOR_N], parameters[CSG_OPERATOR_SUPPORT]};
    const operand *a = &w->stack[w->top - 2];
    bool is_orthogonal = node->join_blend == CSG_BLEND_ORTHOGONAL;
    double turn = node->join == CSG_JOIN_UNION ? 1 : -1;
    if (csg_halves_joins_sharply(w->tape, node)) {
        if (join_sharply(w, node, is_orthogonal))
            return true;
    } else if (node->join_blend < CSG_BLEND_COUNT && csg_blend_is_convex(node->join_blend) &&
               has_value(w, a) && has_value(w, a + 1)) {
        bool done = join_smoothly(w, a, 2, &b, turn);
        w->top--;
        return done;
    }
    w->top = (uint32_t)(a - w->stack);
    forget(w, a);
    return take_whole(w, a->first, index, true);
}

/* An operator that takes all its operands at once. */
static bool combine(walker *w, uint32_t index)
{
    const csg_tape_node *node = &w->tape->nodes[index];
    operand *of = &w->stack[w->top - node->arity];
    bool is_round = csg_op_is_round(node->op);
    for (uint32_t i = 0; i < node->arity && is_round; i++)
        is_round = has_value(w, &of[i]);
    if (is_round) {
        const blender b = {.n = w->tape->parameters[node->parameters + CSG_OPERATOR_N]};
        bool done = join_smoothly(w, of, node->arity, &b, node->op == CSG_OP_ROUND_UNION ? 1 : -1);
        w->top -= node->arity - 1;
        return done;
    }
    w->top -= node->arity;
    forget(w, of);
    return take_whole(w, of->first, index, false);
}

/* How far the blend is above the plane, both turned. */
static double excess_at(const origin *from, const csg_enclosure *e, const double at[3])
{
    double values[ORIGIN_MOST], ignored[ORIGIN_MOST];
    for (uint32_t i = 0; i < from->count; i++)
        values[i] = from->turn * plane_at(&from->operands[i], at);
    return blend(&from->by, values, from->count, ignored) - from->turn * plane_at(e, at);
}

/* The most that the blend exceeds the plane by where the turned plane is within `room` of zero: at
 * a vertex of that part of the cube, on an edge of it. Corners below that must be outside for
 * certain, and all between them is then. INFINITY: they are not. */
static double excess_near(const walker *w, const origin *from, const csg_enclosure *e, double room)
{
    double most = 0;
    for (int o = 0; o < CSG_OCTANTS; o++) {
        const double a[3] = {corner(w, o, 0), corner(w, o, 1), corner(w, o, 2)};
        double at_a = from->turn * plane_at(e, a), over = excess_at(from, e, a);
        if (at_a < -room && !(at_a + over + from->above < 0))
            return INFINITY;
        if (fabs(at_a) <= room)
            most = fmax(most, over);
        for (int axis = 0; axis < 3; axis++) {
            double step = 2 * w->half * from->turn * e->slope[axis];
            for (int side = -1; side <= 1 && !(o >> axis & 1); side += 2) {
                double share = (side * room - at_a) / step;
                if (!(share > 0 && share < 1))
                    continue;
                double p[3] = {a[0], a[1], a[2]};
                p[axis] += 2 * w->half * share;
                most = fmax(most, excess_at(from, e, p));
            }
        }
    }
    return most;
}

/* Planes need to tell inside from outside alone, so that only what is near the surface counts: deep
 * inside a blend may bend as it likes. */
static void tighten(const walker *w, csg_enclosure *e, const origin *from)
{
    enum { ROUNDS = 3 };
    double *above = from->turn > 0 ? &e->above : &e->below;
    for (int i = 0; i < ROUNDS && from->count; i++) {
        double room = fmax(*above, from->below) * (1 + 1e-9);
        double most = excess_near(w, from, e, room) + from->above;
        if (!(most < *above))
            return;
        *above = most;
    }
}

static bool walk(walker *w)
{
    for (uint32_t i = 0; i < w->tape->count; i++) {
        const csg_tape_node *node = &w->tape->nodes[i];
        bool known = node->op == CSG_OP_UNION || node->op == CSG_OP_INTERSECTION;
        if (csg_op_is_leaf(node->op))
            known = push_leaf(w, i);
        else if (csg_op_takes_all(node->op))
            known = node->arity <= w->top && combine(w, i);
        if (!known || (node->join && !join_siblings(w, i)))
            return false;
    }
    for (int i = 0; i < w->out->plane_count; i++)
        tighten(w, &w->out->planes[i], &w->origins[i]);
    return w->top == 1;
}

static bool find(const csg_kernel *kernel, const csg_tape *tape, const double c[3], double half,
                 bool with_strays, float *scratch, size_t scratch_floats, csg_halves *out)
{
    walker w; /* not filled: it is large */
    float x[3][CSG_OCTANTS], middle[3][CSG_OCTANTS];
    if (tape->count > CSG_SLOPES_NODES || !tape->count)
        return false;
    w.kernel = kernel;
    w.tape = tape;
    w.c = c;
    w.half = half;
    w.radius = csg_enclosure_radius(half);
    w.with_strays = with_strays;
    w.scratch = scratch;
    w.scratch_floats = scratch_floats;
    w.top = 0;
    w.out = out;
    out->plane_count = out->length = 0;
    for (int axis = 0; axis < 3; axis++)
        for (int o = 0; o < CSG_OCTANTS; o++) {
            x[axis][o] = (float)(c[axis] + corner(&w, o, axis));
            middle[axis][o] = (float)c[axis];
        }
    if (tape->count > 1 || asks_corners(tape->nodes)) {
        kernel->intervals(tape, x[0], x[1], x[2], 0, NULL, w.low, w.high, scratch);
        kernel->intervals(tape, middle[0], middle[1], middle[2], 0, NULL, w.low_at_c, w.high_at_c,
                          scratch);
    }
    return walk(&w);
}

bool csg_halves_find(const csg_kernel *kernel, const csg_tape *tape, const double c[3], double half,
                     float *scratch, size_t scratch_floats, csg_halves *out)
{
    return find(kernel, tape, c, half, false, scratch, scratch_floats, out);
}

bool csg_halves_find_with_strays(const csg_kernel *kernel, const csg_tape *tape, const double c[3],
                                 double half, float *scratch, size_t scratch_floats,
                                 csg_halves *out)
{
    return find(kernel, tape, c, half, true, scratch, scratch_floats, out);
}

/* ---- what is known of it -----------------------------------------------------------------------
 */

csg_truth csg_halves_evaluate(const csg_halves *h, const csg_truth planes[CSG_HALVES_MOST])
{
    csg_truth stack[CSG_HALVES_CODE];
    int top = 0;
    for (int i = 0; i < h->length; i++) {
        int code = h->code[i];
        if (code >= 0) {
            stack[top++] = planes[code];
            continue;
        }
        csg_truth a = stack[top - 2], b = stack[top - 1];
        csg_truth wins = code == CSG_HALVES_UNION ? CSG_TRUTH_YES : CSG_TRUTH_NO;
        stack[--top - 1] = a == wins || b == wins                       ? wins
                           : a == CSG_TRUTH_OPEN || b == CSG_TRUTH_OPEN ? CSG_TRUTH_OPEN
                                                                        : a;
    }
    return stack[0];
}

csg_truth csg_halves_state_of_plane(const csg_enclosure *e, double half)
{
    double reach = reach_of(e->slope, half);
    return e->value + e->above < -reach  ? CSG_TRUTH_NO
           : e->value - e->below > reach ? CSG_TRUTH_YES
                                         : CSG_TRUTH_OPEN;
}

csg_truth csg_halves_state(const csg_halves *h, double half)
{
    csg_truth planes[CSG_HALVES_MOST];
    for (int i = 0; i < h->plane_count; i++)
        planes[i] = csg_halves_state_of_plane(&h->planes[i], half);
    return csg_halves_evaluate(h, planes);
}
