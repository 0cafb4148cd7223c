/* SPDX-License-Identifier: MIT
 * Walks over a tape with three numbers for each operand; see minorant.h.
 */
#include "mesh/distance/minorant.h"

#include <math.h>
#include <string.h>

#include "field/gradients/cone_leaf.h"
#include "mesh/distance/slopes.h"
#include "mesh/distance/slopes_private.h"
#include "scene/operators/blend_kinds.h"

enum { CORNERS = CSG_SLOPES_CORNERS, PLACES = CORNERS + 1 /* and their middle */ };

/* What is nowhere more than an operand, affine between the corners, where all is turned around if
 * the triangle is to be outside. */
typedef struct minorant {
    double at[CORNERS];
} minorant;

typedef struct walk {
    const csg_kernel *kernel;
    const csg_tape *tape;
    const csg_sided_triangle *triangle;
    csg_vec3 middle;
    double radius;     /* of the ball around it that holds the triangle */
    uint32_t warp;     /* the last one asked about: most leaves have the same */
    csg_vec3 below[3]; /* the corners below it */
    double curving;
    bool is_warped;      /* false, and INFINITY: not known */
    const float *values; /* of node number i from i times the stride on, at the places */
    size_t stride;
    minorant stack[CSG_SLOPES_NODES];
    uint32_t top;
} walk;

static double least_of(const minorant *m)
{
    return fmin(m->at[0], fmin(m->at[1], m->at[2]));
}

static double mean_of(const minorant *m)
{
    return (m->at[0] + m->at[1] + m->at[2]) / 3;
}

static void keep_higher(minorant *best, const minorant *other)
{
    if (least_of(other) > least_of(best))
        *best = *other;
}

/* ---- leaves ------------------------------------------------------------------------------------
 */

/* How far the leaf may be below its corners' plane by what its gradients are. */
static double find_sag(const walk *w, const csg_tape_node *leaf)
{
    csg_cone_balls balls = {.count = 0};
    const float c[3] = {(float)w->middle.x, (float)w->middle.y, (float)w->middle.z};
    double steepest = fmax((double)w->tape->steepest, (double)w->tape->lipschitz);
    double off = steepest;
    if (csg_cone_add_leaf(&balls, w->tape, leaf, c, w->radius) && balls.count == 1 &&
        !balls.has_edges)
        off = fmin(balls.items[0].spread, 0.5 * balls.bend * w->radius);
    return off * w->radius;
}

static minorant lower(const double at[CORNERS], double by)
{
    return (minorant){{at[0] - by, at[1] - by, at[2] - by}};
}

static void find_below(walk *w, uint32_t warp)
{
    if (w->warp == warp)
        return;
    w->warp = warp;
    w->curving = csg_cone_find_curving(w->tape, warp, w->middle, w->radius);
    w->is_warped = csg_cone_warp_corners(w->tape, warp, w->triangle->at, w->below);
}

/* Of the radius: it is no use to know more. */
static const double LITTLE_CURVING = 0.02;

/* Of a convex primitive. Gradients are asked where that may tell more. */
static double off_of_convex(const walk *w, const csg_tape_node *leaf, const double at[PLACES],
                            double doubt, double curving)
{
    static const double LITTLE = 1e-3; /* of the radius */
    double sigma = (double)w->tape->parameters[leaf->parameters + CSG_LEAF_SIGMA];
    if (w->triangle->turn * sigma > 0)
        return curving <= LITTLE_CURVING * w->radius ? curving : fmin(curving, find_sag(w, leaf));
    double below = (at[0] + at[1] + at[2]) / 3 - at[CORNERS] + 2 * doubt + curving;
    double off = curving + 3 * fmax(below, 0);
    return off > LITTLE * w->radius ? fmin(off, find_sag(w, leaf)) : off;
}

/* Of any other. */
static minorant minorant_of_others(walk *w, const csg_tape_node *leaf, double at[CORNERS],
                                   double doubt, double curving)
{
    minorant corners = lower(at, doubt), beside = {{0, 0, 0}};
    csg_beside known = CSG_BESIDE_UNKNOWN;
    if (w->is_warped)
        known = csg_cone_find_beside(w->tape, leaf, w->below, w->triangle->turn, at);
    if (known != CSG_BESIDE_UNKNOWN)
        beside = lower(at, doubt + curving);
    if (known == CSG_BESIDE_CLOSELY && curving <= LITTLE_CURVING * w->radius)
        return beside;
    minorant best = lower(corners.at, find_sag(w, leaf));
    if (known != CSG_BESIDE_UNKNOWN)
        keep_higher(&best, &beside);
    return best;
}

/* False: its values are no numbers. */
static bool find_leaf(walk *w, const csg_tape_node *leaf, minorant *out)
{
    const float *values = w->values + (size_t)(leaf - w->tape->nodes) * w->stride;
    double turn = w->triangle->turn, at[PLACES], most = 0;
    for (uint32_t k = 0; k < PLACES; k++) {
        at[k] = turn * (double)values[k];
        if (!(fabs(at[k]) < INFINITY))
            return false;
        most = fmax(most, fabs(at[k]));
    }
    double slack = (double)w->tape->parameters[leaf->parameters + CSG_LEAF_SLACK];
    double doubt = slack + 1e-6 * most, curving = 0;
    find_below(w, leaf->warp);
    if (leaf->warp)
        curving = csg_cone_leaf_norm(w->tape, leaf) * w->curving;
    if (csg_op_has(leaf->op, CSG_TRAIT_CONVEX)) {
        *out = lower(at, doubt + off_of_convex(w, leaf, at, doubt, curving));
        return true;
    }
    *out = minorant_of_others(w, leaf, at, doubt, curving);
    return true;
}

/* ---- operators ---------------------------------------------------------------------------------
 */

static minorant mixture_of(const minorant *a, const minorant *b, double share)
{
    minorant m;
    for (int k = 0; k < CORNERS; k++)
        m.at[k] = share * a->at[k] + (1 - share) * b->at[k];
    return m;
}

/* The mixture whose least corner is highest: the least of three affine functions of the share is
 * largest at an end, or where two of them are equal. */
static minorant larger_of(const minorant *a, const minorant *b)
{
    minorant best = *a;
    keep_higher(&best, b);
    for (int i = 0; i < CORNERS; i++) {
        int k = (i + 1) % CORNERS;
        double p = a->at[i] - a->at[k], q = b->at[k] - b->at[i];
        double share = q / (p + q);
        if (!(share > 0 && share < 1))
            continue;
        const minorant mixed = mixture_of(a, b, share);
        keep_higher(&best, &mixed);
    }
    return best;
}

static minorant smaller_of(const minorant *a, const minorant *b)
{
    minorant m;
    for (int k = 0; k < CORNERS; k++)
        m.at[k] = fmin(a->at[k], b->at[k]);
    return m;
}

/* Where operands have the values a and b. */
static minorant tangent_of_fold(const walk *w, const csg_tape_node *node, const minorant *m,
                                const minorant *n, double a, double b)
{
    const float *parameters = w->tape->parameters + node->join_parameters;
    double share, value = csg_slopes_fold(node, parameters[CSG_OPERATOR_N],
                                          parameters[CSG_OPERATOR_SUPPORT], a, b, &share);
    minorant tangent = mixture_of(m, n, share);
    double off = value - share * a - (1 - share) * b;
    return lower(tangent.at, -off);
}

static minorant fold_at_corners(const walk *w, const csg_tape_node *node, const minorant *m,
                                const minorant *n)
{
    const float *parameters = w->tape->parameters + node->join_parameters;
    minorant out;
    double share;
    for (int k = 0; k < CORNERS; k++)
        out.at[k] =
            -csg_slopes_fold(node, parameters[CSG_OPERATOR_N], parameters[CSG_OPERATOR_SUPPORT],
                             -m->at[k], -n->at[k], &share);
    return out;
}

static uint32_t lowest_corner(const minorant *m)
{
    uint32_t lowest = 0;
    for (uint32_t k = 1; k < CORNERS; k++)
        lowest = m->at[k] < m->at[lowest] ? k : lowest;
    return lowest;
}

/* Whether a union's values are blended here: it is one, or an intersection turned around. */
static bool is_convex_here(const walk *w, bool is_union)
{
    return is_union == (w->triangle->turn > 0);
}

static double spread_of(const minorant *a, const minorant *b)
{
    double most = 0;
    for (int k = 0; k < CORNERS; k++)
        most = fmax(most, fabs(a->at[k] - b->at[k]));
    return most;
}

/* No blend that folds. */
static bool has_edge(uint8_t blend)
{
    return csg_blend_is_sharp(blend) || csg_blend_is_orthogonal(blend);
}

/* Of a union's values: tangent planes. What is orthogonal is nowhere less than sharp. */
static minorant join_convex(const walk *w, const csg_tape_node *node, const minorant *a,
                            const minorant *b)
{
    if (has_edge(node->join_blend))
        return larger_of(a, b);
    minorant best = tangent_of_fold(w, node, a, b, mean_of(a), mean_of(b));
    uint32_t k = lowest_corner(&best);
    minorant there = tangent_of_fold(w, node, a, b, a->at[k], b->at[k]);
    keep_higher(&best, &there);
    return best;
}

/* An intersection of operands at right angles, behind which what is `beyond` is rounded. */
static minorant orthogonal_at_corners(const minorant *a, const minorant *b, double beyond)
{
    minorant out;
    for (int k = 0; k < CORNERS; k++) {
        double u = -a->at[k] - beyond, v = -b->at[k] - beyond;
        out.at[k] = u > 0 && v > 0 ? -beyond - sqrt(u * u + v * v) : fmin(a->at[k], b->at[k]);
    }
    return out;
}

/* Of an intersection's values: those at the corners. */
static minorant join_concave(const walk *w, const csg_tape_node *node, const minorant *a,
                             const minorant *b)
{
    double n = (double)w->tape->parameters[node->join_parameters + CSG_OPERATOR_N];
    if (csg_blend_is_orthogonal(node->join_blend))
        return orthogonal_at_corners(a, b, -w->triangle->turn * n);
    return has_edge(node->join_blend) ? smaller_of(a, b) : fold_at_corners(w, node, a, b);
}

/* Of the two operands on top. False: nothing is known. */
static bool join_operands(walk *w, const csg_tape_node *node)
{
    static const double ROUNDING = 1e-5;
    uint8_t blend = node->join_blend;
    minorant *a = &w->stack[w->top - 2];
    const minorant b = w->stack[--w->top];
    if (!has_edge(blend) && !(csg_blend_is_fold(blend) && csg_blend_is_convex(blend)))
        return false;
    double doubt = has_edge(blend) ? 0 : ROUNDING * spread_of(a, &b);
    minorant both = is_convex_here(w, node->join == CSG_JOIN_UNION) ? join_convex(w, node, a, &b)
                                                                    : join_concave(w, node, a, &b);
    *a = lower(both.at, doubt);
    return true;
}

/* The tangent plane of a round union at these values: shares are in the proportions of (f_i - F +
 * w)_+. */
static minorant tangent_of_round(const minorant *of, uint32_t count, const double *at, double size)
{
    double value = csg_slopes_round(at, count, size), sum = 0;
    minorant tangent = {{0, 0, 0}};
    for (uint32_t i = 0; i < count; i++) {
        double weight = fmax(at[i] - value + size, 0);
        for (int k = 0; k < CORNERS && weight > 0; k++)
            tangent.at[k] += weight * (of[i].at[k] - at[i]);
        sum += weight;
    }
    for (int k = 0; k < CORNERS; k++)
        tangent.at[k] = value + tangent.at[k] / sum;
    return tangent;
}

static void join_round(walk *w, const csg_tape_node *node)
{
    double size = (double)w->tape->parameters[node->parameters + CSG_OPERATOR_N];
    double values[CSG_SLOPES_NODES], doubt = 1e-5 * size;
    uint32_t count = node->arity;
    minorant *of = &w->stack[w->top - count], best;
    values[0] = -INFINITY; /* set also where there are none */
    if (!is_convex_here(w, csg_op_is_union(node->op))) {
        for (uint32_t k = 0; k < CORNERS; k++) {
            for (uint32_t i = 0; i < count; i++)
                values[i] = -of[i].at[k];
            best.at[k] = -csg_slopes_round(values, count, size);
        }
    } else {
        for (uint32_t i = 0; i < count; i++)
            values[i] = mean_of(&of[i]);
        best = tangent_of_round(of, count, values, size);
        uint32_t k = lowest_corner(&best);
        for (uint32_t i = 0; i < count; i++)
            values[i] = of[i].at[k];
        minorant there = tangent_of_round(of, count, values, size);
        keep_higher(&best, &there);
    }
    of[0] = lower(best.at, doubt);
    w->top -= count - 1;
}

/* ---- the walk ----------------------------------------------------------------------------------
 */

/* A subtree, or all of the tape. */
static bool walk_nodes(walk *w, uint32_t first, uint32_t count)
{
    for (uint32_t i = first; i < first + count; i++) {
        const csg_tape_node *node = &w->tape->nodes[i];
        bool known = node->op == CSG_OP_UNION || node->op == CSG_OP_INTERSECTION;
        if (csg_op_is_leaf(node->op)) {
            known = find_leaf(w, node, &w->stack[w->top++]);
        } else if (csg_op_is_round(node->op)) {
            join_round(w, node);
            known = true;
        }
        if (!known || (node->join && !join_operands(w, node)))
            return false;
    }
    return true;
}

/* Parts that touch: either half may stand for the field, but where the triangle is on one side. */
static double join_halves(const walk *w, const csg_touching *t)
{
    double side = csg_touching_side(t, w->middle);
    double reach = csg_vec3_norm(t->slope) * w->radius + t->doubt;
    double a = least_of(&w->stack[0]), b = least_of(&w->stack[1]);
    return side > reach ? a : side < -reach ? b : fmin(a, b) - t->doubt;
}

static double find_least(walk *w, const csg_touching *t)
{
    double least = -INFINITY;
    w->top = 0;
    if (!t->is_there) {
        if (walk_nodes(w, 0, t->tape->count))
            least = least_of(&w->stack[0]);
    } else if (walk_nodes(w, (uint32_t)(t->halves[0].nodes - t->tape->nodes), t->halves[0].count) &&
               walk_nodes(w, (uint32_t)(t->halves[1].nodes - t->tape->nodes), t->halves[1].count)) {
        least = join_halves(w, t);
    }
    return least == least ? least : -INFINITY;
}

static csg_vec3 middle_of(const csg_vec3 at[3])
{
    return csg_vec3_scale(csg_vec3_add(at[0], csg_vec3_add(at[1], at[2])), 1.0 / 3);
}

void csg_minorants_find(const csg_kernel *kernel, const csg_touching *field,
                        const csg_sided_triangle *triangles, size_t count, double *least)
{
    float values[CSG_SLOPES_NODES * PLACES * CSG_OCTANTS];
    float x[PLACES * CSG_OCTANTS], y[PLACES * CSG_OCTANTS], z[PLACES * CSG_OCTANTS];
    size_t all = count * PLACES;
    walk w; /* not filled: its stack is large */
    for (size_t i = 0; i < count; i++)
        least[i] = -INFINITY;
    if (field->tape->count > CSG_SLOPES_NODES || !field->tape->count || !count)
        return;
    w.kernel = kernel;
    w.tape = field->tape;
    w.stride = (all + CSG_OCTANTS - 1) / CSG_OCTANTS * CSG_OCTANTS;
    for (size_t i = 0; i < w.stride; i++) { /* the last one again, where vectors have more room */
        size_t n = i < all ? i : all - 1, k = n % PLACES;
        const csg_sided_triangle *t = &triangles[n / PLACES];
        csg_vec3 p = k < CORNERS ? t->at[k] : middle_of(t->at);
        x[i] = (float)p.x;
        y[i] = (float)p.y;
        z[i] = (float)p.z;
    }
    kernel->leaves(w.tape, x, y, z, w.stride, values);
    for (size_t i = 0; i < count; i++) {
        w.triangle = &triangles[i];
        w.values = values + i * PLACES;
        w.middle = middle_of(triangles[i].at);
        w.radius = 0;
        w.warp = UINT32_MAX;
        for (int k = 0; k < CORNERS; k++)
            w.radius = fmax(w.radius, csg_vec3_norm(csg_vec3_sub(triangles[i].at[k], w.middle)));
        least[i] = find_least(&w, field);
    }
}
