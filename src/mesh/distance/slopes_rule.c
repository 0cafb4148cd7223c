/* SPDX-License-Identifier: MIT
 * Gradients of EXTERIOR and INTERIOR blends; see slopes.h. Their partial derivatives add up to 1
 * and their sizes to K at most (operators.md 7), so one is between (1 - K) / 2 and (1 + K) / 2.
 * These are no shares: a gradient may lie beyond both operands'. Other rules have no bound here.
 */
#include <math.h>

#include "field/rule_layout.h"
#include "mesh/distance/slopes_private.h"
#include "scene/operators/blend_kinds.h"

enum { FEW_BALLS = 4 /* of an operand; each of a pair makes two with each of the other's */ };

/* An operand's gradients as a few balls whose hull holds them. False: no bound is known. */
static bool make_plain(csg_slopes_operand *o)
{
    bool exceeds = o->stretched || o->faces || o->balls.has_edges;
    if (!exceeds && o->balls.count <= FEW_BALLS)
        return true;
    csg_cone_ball one;
    if (!csg_slopes_enclose(&o->balls, o->longest, &one))
        return false;
    o->balls.items[0] = one;
    o->balls.count = 1;
    o->balls.corner = 0;
    o->balls.has_edges = o->stretched = o->faces = false;
    return true;
}

static void add_combination(csg_cone_balls *to, const csg_cone_ball *a, const csg_cone_ball *b,
                            double share)
{
    csg_cone_ball *out = &to->items[to->count++];
    for (int k = 0; k < 3; k++)
        out->at[k] = share * a->at[k] + (1 - share) * b->at[k];
    out->spread = fabs(share) * a->spread + fabs(1 - share) * b->spread;
}

bool csg_slopes_join_rule(csg_slopes_walker *w, const csg_tape_node *node)
{
    static const double ROUNDING = 1e-5;
    const float *own = w->tape->parameters + node->join_parameters;
    csg_slopes_operand *a = &w->stack[w->top - 2], *b = &w->stack[w->top - 1];
    bool is_known =
        node->join_blend == CSG_BLEND_EXTERIOR || node->join_blend == CSG_BLEND_INTERIOR;
    if (!is_known || !make_plain(a) || !make_plain(b))
        return false;
    double k = (double)own[CSG_SMOOTH_K] + ROUNDING, share = (1 + k) / 2;
    csg_cone_balls from = a->balls;
    a->balls.count = 0;
    for (uint32_t i = 0; i < from.count; i++)
        for (uint32_t j = 0; j < b->balls.count; j++) {
            add_combination(&a->balls, &from.items[i], &b->balls.items[j], share);
            add_combination(&a->balls, &from.items[i], &b->balls.items[j], 1 - share);
        }
    a->kink = INFINITY;
    a->longest = k * fmax(a->longest, b->longest);
    a->doubt = k * fmax(a->doubt, b->doubt) + ROUNDING * (double)own[CSG_SMOOTH_DELTA];
    w->top--;
    return true;
}

void csg_slopes_end_rule(csg_slopes_walker *w, const csg_tape_node *node)
{
    csg_slopes_operand *o = &w->stack[w->top - 1];
    o->value = csg_slopes_value_of_node(w, node);
    o->doubt += 1e-6 * fabs(o->value);
    o->low = o->value - o->longest * w->flat - o->doubt;
    o->high = o->value + o->longest * w->flat + o->doubt;
    double span = csg_slopes_span(w, o);
    o->least = o->value - span;
    o->most = o->value + span;
}
