/* SPDX-License-Identifier: MIT
 * What walks over tapes share; see taylor_walk.h.
 */
#include "field/taylor/taylor_walk.h"

#include <math.h>

#include "field/taylor/warp_taylor.h"
#include "scene/primitives/curve.h"
#include "scene/primitives/kinds.h"

/* ---- leaves ------------------------------------------------------------------------------------
 */

/* Own coordinates; false: a warp on the way is not smooth in the ball. *off: how far the warps'
 * floats put them from where they are. */
static bool place(const csg_taylor_walk *w, const csg_tape_node *leaf, bool with_slopes,
                  csg_smooth_leaf *l, double *off)
{
    enum { PLACE = 12, SHIFT = 3 };
    bool is_offset = leaf->frame == CSG_FRAME_OFFSET;
    double frame[PLACE];
    for (uint32_t i = 0; i < (is_offset ? SHIFT : PLACE); i++)
        frame[i] = csg_tape_number(w->tape, leaf->parameters + CSG_LEAF_FRAME + i);
    l->radius = w->radius;
    l->with_slopes = with_slopes;
    if (!leaf->warp && !is_offset)
        csg_taylor_place_points(frame, w->c, l);
    else if (!csg_taylor_warped(w->tape, leaf->warp, w->c, l, off))
        return false;
    for (int i = 0; i < 3 && is_offset; i++)
        l->p[i].f.value -= frame[i];
    if (leaf->warp && !is_offset)
        csg_taylor_placed(frame, l);
    const csg_taylor *p[3] = {&l->p[0].f, &l->p[1].f, &l->p[2].f};
    l->reach = csg_taylor_change_of(p, 3, w->radius).most;
    return true;
}

double csg_taylor_walk_rounding(const csg_taylor_walk *w, uint32_t leaf)
{
    static const double OF_DOUBLES = 0x1p-26 /* of the slack */, OF_PLACE = 0x1p-44;
    uint32_t at = w->tape->nodes[leaf].parameters;
    double far = fabs(w->c[0]) + fabs(w->c[1]) + fabs(w->c[2]) + w->radius;
    return csg_tape_number(w->tape, at + CSG_LEAF_OFF) +
           csg_tape_number(w->tape, at + CSG_LEAF_TURNED) * far +
           OF_DOUBLES * (double)w->tape->parameters[at + CSG_LEAF_SLACK] + OF_PLACE * far;
}

bool csg_taylor_walk_leaf(const csg_taylor_walk *w, uint32_t index, bool with_slopes,
                          csg_smooth_choice *choice, csg_smooth *out)
{
    static const double OF_FLOATS = 1e-6, OF_DOUBLES = 1e-12; /* of own directions */
    const csg_tape *tape = w->tape;
    const csg_tape_node *leaf = &tape->nodes[index];
    double raise = csg_tape_number(tape, leaf->parameters + CSG_LEAF_RAISE),
           sigma = csg_tape_number(tape, leaf->parameters + CSG_LEAF_SIGMA);
    double directions = csg_tape_is_exact(w->tape) ? OF_DOUBLES : OF_FLOATS;
    double turned = csg_tape_number(tape, leaf->parameters + CSG_LEAF_TURNED);
    double numbers[CSG_LEAF_MOST_OWN];
    csg_smooth_leaf l;
    csg_smooth own;
    double off = 0;
    if (!csg_op_is_primitive(leaf->op) || csg_node_is_curve(csg_op_node_kind(leaf->op)) ||
        !place(w, leaf, with_slopes, &l, &off))
        return false;
    const csg_primitive *primitive = csg_primitive_of(csg_op_node_kind(leaf->op));
    for (int i = 0; i < primitive->own_count; i++)
        numbers[i] = csg_tape_number(tape, csg_tape_own_at(leaf) + (uint32_t)i);
    l.own = numbers;
    l.choice = choice;
    if (choice) {
        choice->signs = w->signs[index] && raise * sigma >= 0;
        choice->at_zero = w->signs[index] && !(fabs(raise) > 0);
        choice->at_level = w->signs[index];
        choice->level = -raise / sigma;
        choice->stretch = 1;
        choice->ways = 1;
        choice->is_creased = false;
        choice->condition_count = 0;
    }
    if (!primitive->smooth(&l, &own))
        return false;
    *out = csg_smooth_line(&l, raise, sigma, &own);
    double stretch = choice ? choice->stretch : 1;
    double moved = stretch * (csg_taylor_walk_rounding(w, index) + off);
    out->f.error += moved;
    /* gradients, where what is curved is moved by that */
    out->f.turned += stretch * (directions + turned) +
                     2 * moved * csg_taylor_stray(&out->f, w->radius) / w->radius;
    if (leaf->warp) /* as far as what is curved turns by that, twice */
        out->f.turned += stretch * (OF_FLOATS + 2 * off / w->radius);
    return true;
}

/* ---- values and decisions ----------------------------------------------------------------------
 */

double csg_taylor_walk_apart(const csg_taylor_walk *w, const csg_taylor *d)
{
    static const double SAME = 0x1p-16; /* of the radius */
    double most = fabs(d->value) + csg_taylor_reach(d, w->radius);
    return most <= SAME * w->radius ? most : INFINITY;
}

void csg_taylor_walk_add_apart(const csg_taylor_walk *w, csg_taylor *f, double apart)
{
    static const double STEEPEST = 16; /* 9 sqrt(3), of what is of third order in a cube */
    f->error += apart;
    f->turned += STEEPEST * apart / w->radius;
}

double csg_taylor_walk_length_off(const csg_taylor_walk *w, double length)
{
    static const double OF_FLOATS = 0x1p-24, OF_DOUBLES = 0x1p-46;
    return (csg_tape_is_exact(w->tape) ? OF_DOUBLES : OF_FLOATS) * length;
}

void csg_taylor_walk_add_length(const csg_taylor_walk *w, double length, csg_taylor *f)
{
    f->error += csg_taylor_walk_length_off(w, length);
    f->turned += csg_taylor_walk_length_off(w, 4);
}

csg_taylor csg_taylor_walk_mean(const csg_taylor *a, const csg_taylor *b, double factor,
                                const csg_taylor *excess)
{
    csg_taylor sum = csg_taylor_sum(a, 1, b);
    sum = csg_taylor_scaled(&sum, 0.5);
    return csg_taylor_sum(&sum, factor, excess);
}

/* Whatever the slope is, no share's size is less than that by more than 1. */
void csg_taylor_walk_share(const csg_taylor *a, const csg_taylor *b, double slope, csg_taylor *f)
{
    static const double ROUNDING = 1 - 1e-9;
    const csg_taylor *least = slope > 0 ? b : a;
    double less = fmin(2 * fabs(slope), 1) * ROUNDING;
    f->error -= less * least->error;
    f->quartic -= less * least->quartic;
    f->turned -= less * least->turned;
    f->thrice -= less * least->thrice;
}

int csg_taylor_walk_choose(csg_taylor_walk *w, const bool *possible, int count)
{
    int all = 0, nth = 0;
    for (int i = 0; i < count; i++)
        all += possible[i];
    if (!all || (all > 1 && (!w->may_decide || w->decisions == CSG_TAYLOR_DECISIONS)))
        return -1;
    if (all > 1) {
        w->options[w->decisions] = all;
        nth = w->script[w->decisions++];
    }
    for (int i = 0; i < count; i++)
        if (possible[i] && nth-- == 0)
            return i;
    return -1;
}

/* What is not told leaves the piece where it is not the field, too: nothing is wrong then. */
void csg_taylor_walk_require(csg_taylor_walk *w, const csg_taylor *g, double off)
{
    csg_taylor_piece *p = w->piece;
    if (p->condition_count == CSG_TAYLOR_CONDITIONS) {
        p->is_partial = true;
        return;
    }
    p->conditions[p->condition_count] = *g;
    p->conditions[p->condition_count++].error += off;
}
