/* SPDX-License-Identifier: MIT
 * A round operator among those of slopes.h: shares are in proportions that operands' values tell.
 */
#include <math.h>

#include "mesh/distance/slopes_private.h"

typedef csg_slopes_operand operand;
typedef csg_slopes_walker walker;
typedef csg_slopes_range range;
typedef csg_slopes_which which;

/* The root F of sum (f_i - F + w)_+^2 = w^2 (operators.md 12): a quadratic one of those operands
 * that are active, which are the largest ones, as many as reach it. */
double csg_slopes_round(const double *values, uint32_t count, double w)
{
    double gaps[CSG_SLOPES_NODES], largest = -INFINITY, excess = 0, sum = 0, squares = 0;
    for (uint32_t i = 0; i < count; i++)
        largest = values[i] > largest ? values[i] : largest;
    for (uint32_t i = 0; i < count; i++) { /* in order: they are few */
        double gap = largest - values[i];
        uint32_t to = i;
        for (; to > 0 && gaps[to - 1] > gap; to--)
            gaps[to] = gaps[to - 1];
        gaps[to] = gap;
    }
    for (uint32_t i = 1; i < count && w - gaps[i] > excess; i++) {
        sum += gaps[i];
        squares += gaps[i] * gaps[i];
        double mean = sum / (i + 1), rest = w * w - (squares - sum * mean);
        excess = w - mean - sqrt((rest > 0 ? rest : 0) / (i + 1));
    }
    return largest + (excess > 0 ? excess : 0);
}

static double round_value(const operand *of, which what, uint32_t count, double turn, double w)
{
    double values[CSG_SLOPES_NODES];
    values[0] = -INFINITY; /* set also where there are none */
    for (uint32_t i = 0; i < count; i++)
        values[i] = turn * csg_slopes_value(&of[i], what);
    return turn * csg_slopes_round(values, count, w);
}

/* Of operands in the proportions of these weights. They are mixed one after the other, each with
 * the mixture of those before it. False: no bound is known. */
static bool mix_round(const operand *of, const range *weights, uint32_t count, operand *sum)
{
    range total = {0, 0}; /* of the weights so far */
    for (uint32_t i = 0; i < count; i++) {
        range weight = weights[i];
        if (weight.high <= 0)
            continue;
        range share = {total.low / (total.low + weight.high),
                       total.high / (total.high + weight.low)};
        if (!(total.high > 0))
            *sum = of[i];
        else if (!csg_slopes_mix(sum, &of[i], share, false))
            return false;
        total = (range){total.low + weight.low, total.high + weight.high};
    }
    return total.high > 0;
}

/* F is convex in its operands. Its second derivative along a change v of theirs is the sum of
 * (v_i - v)^2 / S over those that are active, v being the mean in their shares and S the sum of
 * their weights, which is w at least: no more than the sum of (v_i - v_k)^2 / S over all pairs, and
 * of two w^2 / S^3 times that of one. */
static void find_sag(const walker *w, const operand *of, const range *weights, uint32_t count,
                     double size, operand *sum)
{
    double kink = 0, sag = 0, squares = 0, total = 0;
    uint32_t active = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (weights[i].high <= 0)
            continue;
        active++;
        total += weights[i].low;
        kink = fmax(kink, of[i].kink);
        sag = fmax(sag, of[i].sag);
        for (uint32_t k = 0; k < i; k++) {
            double parting = weights[k].high > 0 ? csg_slopes_parting(w, &of[i], &of[k]) : 0;
            squares += 0.25 * parting * parting;
        }
    }
    total = fmax(total, size);
    double bend = active > 2 ? 1 / total : size * size / (total * total * total);
    sum->kink = kink;
    sum->sag = sag + 0.5 * bend * squares;
}

/* Where two operands face each other, as a wall's sides do, their sum hardly changes, and that of
 * their weights is no more than `sum`. Since the weights' squares add up to w^2, the smaller one is
 * no more than sum / 2 - sqrt(w^2 / 2 - sum^2 / 4), and the larger one no less than what is left.
 */
static void part_two(const walker *w, const operand *of, range weights[2], double turn, double size,
                     double doubt)
{
    double sum = 2 * (size + doubt) + turn * (of[0].value + of[1].value) + of[0].doubt +
                 of[1].doubt + csg_slopes_change_of_sum(w, &of[0], &of[1]);
    double rest = 0.5 * size * size - 0.25 * sum * sum;
    if (!(rest > 0))
        return;
    double smaller = fmax(0, 0.5 * sum - sqrt(rest)) + doubt;
    double larger = sqrt(fmax(0, size * size - smaller * smaller)) - doubt;
    for (int i = 0; i < 2; i++)
        if (weights[i].high < larger || weights[1 - i].low > smaller) {
            weights[i].high = fmin(weights[i].high, smaller);
            weights[i].low = fmin(weights[i].low, weights[i].high);
            weights[1 - i].low = fmax(weights[1 - i].low, larger);
            weights[1 - i].high = fmax(weights[1 - i].high, weights[1 - i].low);
        }
}

/* The same where the whole field is zero: there the weights' squares add up to w^2, and each is
 * what its operand is anyway, which in a thin wall says much more than how far operands part. */
static void find_level(walker *w, const operand *of, const range *weights, uint32_t count,
                       double turn, double size)
{
    range at_zero[CSG_SLOPES_NODES];
    double doubt = 1e-5 * size, least = 0, most = 0;
    for (uint32_t i = 0; i < count; i++) {
        double low = turn * (turn > 0 ? of[i].least : of[i].most) - of[i].doubt - doubt;
        double high = turn * (turn > 0 ? of[i].most : of[i].least) + of[i].doubt + doubt;
        at_zero[i] = (range){fmax(0, low + size), fmax(0, fmin(size + doubt, high + size))};
        least += at_zero[i].low * at_zero[i].low;
        most += at_zero[i].high * at_zero[i].high;
    }
    double square = size * size, slack = 4 * doubt * size;
    for (uint32_t i = 0; i < count; i++) {
        double low = at_zero[i].low, high = at_zero[i].high;
        double above = square - slack - (most - high * high);
        double below = square + slack - (least - low * low);
        at_zero[i].low = fmax(fmax(low, sqrt(fmax(above, 0))), weights[i].low);
        at_zero[i].high = fmin(fmin(high, sqrt(fmax(below, 0))), weights[i].high);
        at_zero[i].high = fmax(at_zero[i].high, at_zero[i].low); /* nothing is zero, but rounding */
    }
    if (count == 2)
        part_two(w, of, at_zero, turn, size, doubt);
    w->has_level = mix_round(of, at_zero, count, &w->level);
}

/* Shares are in the proportions of (f_i - F + w)_+. */
bool csg_slopes_join_round(walker *w, const csg_tape_node *node)
{
    double size = (double)w->tape->parameters[node->parameters + CSG_OPERATOR_N];
    double turn = node->op == CSG_OP_ROUND_UNION ? 1 : -1, doubt = 0, change = 0;
    operand *of = &w->stack[w->top - node->arity];
    double value = round_value(of, CSG_SLOPES_MIDDLE, node->arity, turn, size);
    double low = round_value(of, CSG_SLOPES_LOW, node->arity, turn, size);
    double high = round_value(of, CSG_SLOPES_HIGH, node->arity, turn, size);
    double least = round_value(of, CSG_SLOPES_LEAST, node->arity, turn, size);
    double most = round_value(of, CSG_SLOPES_MOST, node->arity, turn, size);
    for (uint32_t i = 0; i < node->arity; i++) {
        doubt = fmax(doubt, of[i].doubt);
        for (uint32_t k = i + 1; k < node->arity; k++)
            change = fmax(change, csg_slopes_change(w, &of[i], &of[k]));
    }
    double reach = change + 2 * doubt + 1e-5 * size;
    range weights[CSG_SLOPES_NODES];
    weights[0] = (range){0, 0}; /* set also where there are none */
    for (uint32_t i = 0; i < node->arity; i++) {
        double at = turn * (of[i].value - value) + size;
        weights[i] = (range){fmax(0, at - reach), at + reach};
    }
    operand sum;
    bool done = mix_round(of, weights, node->arity, &sum);
    if (node == &w->tape->nodes[w->tape->count - 1])
        find_level(w, of, weights, node->arity, turn, size);
    if (done)
        find_sag(w, of, weights, node->arity, size, &sum);
    w->top -= node->arity - 1;
    if (!done)
        return false;
    of[0] = sum;
    of[0].value = value;
    of[0].doubt = doubt + 1e-5 * size;
    of[0].low = low - of[0].doubt;
    of[0].high = high + of[0].doubt;
    of[0].least = least;
    of[0].most = most;
    return done;
}
