/* SPDX-License-Identifier: MIT
 * Reaches of pieces; see support.h. For a piece {v_i + s_i . y >= 0} of the cube and weights w_i >=
 * 0, d . y <= sum w_i v_i + (d + sum w_i s_i) . y, which is at most sum w_i v_i + half |d + sum w_i
 * s_i|_1: a convex function of the weights. Where d is a sum of outward normals, as at the nearest
 * point of an edge or corner, the second term vanishes.
 */
#include "clearance/support.h"

#include <math.h>
#include <string.h>

enum { SWEEPS = 2 };

/* ---- pieces ------------------------------------------------------------------------------------
 * A formula of unions and intersections as a union of intersections, while these are few.
 */

typedef struct operand {
    uint8_t masks[CSG_PIECES_MOST];
    uint8_t count;
} operand;

static operand everything(void)
{
    return (operand){.count = 1};
}

static operand join_operands(const operand *a, const operand *b)
{
    operand out = *a;
    if (a->count + b->count > CSG_PIECES_MOST)
        return everything();
    memcpy(out.masks + out.count, b->masks, b->count);
    out.count = (uint8_t)(a->count + b->count);
    return out;
}

/* Too many: what one of them contains, contains the intersection. */
static operand meet_operands(const operand *a, const operand *b)
{
    operand out = {.count = 0};
    if (a->count * b->count > CSG_PIECES_MOST)
        return a->count > b->count ? *b : *a;
    for (int i = 0; i < a->count; i++)
        for (int k = 0; k < b->count; k++)
            out.masks[out.count++] = a->masks[i] | b->masks[k];
    return out;
}

/* A plane that cuts nothing off is left out; one that leaves nothing has no piece. */
static operand of_plane(const csg_enclosure *e, double half, int index, csg_clear_plane *out)
{
    static const double ROUNDING = 1e-12; /* of the planes' own arithmetic */
    double length =
        sqrt(e->slope[0] * e->slope[0] + e->slope[1] * e->slope[1] + e->slope[2] * e->slope[2]);
    double value = e->value + e->above;
    value += ROUNDING * (fabs(e->value) + e->above + half * length);
    if (!(length > 0))
        return value >= 0 ? everything() : (operand){.count = 0};
    *out = (csg_clear_plane){value / length,
                             {e->slope[0] / length, e->slope[1] / length, e->slope[2] / length}};
    double reach = half * (fabs(out->slope[0]) + fabs(out->slope[1]) + fabs(out->slope[2]));
    if (out->value < -reach)
        return (operand){.count = 0};
    return out->value >= reach ? everything()
                               : (operand){.masks = {(uint8_t)(1u << index)}, .count = 1};
}

void csg_clear_pieces_find(const csg_halves *h, double half, csg_clear_pieces *out)
{
    operand stack[CSG_HALVES_CODE];
    int top = 0;
    memset(out, 0, sizeof *out);
    out->plane_count = (uint8_t)h->plane_count;
    for (int i = 0; i < h->length; i++) {
        int code = h->code[i];
        if (code >= 0) {
            stack[top++] = of_plane(&h->planes[code], half, code, &out->planes[code]);
            continue;
        }
        operand *a = &stack[top - 2], *b = &stack[top - 1];
        operand both = code == CSG_HALVES_UNION ? join_operands(a, b) : meet_operands(a, b);
        stack[--top - 1] = both;
    }
    memcpy(out->masks, stack[0].masks, sizeof out->masks);
    out->count = stack[0].count;
}

/* ---- reaches -----------------------------------------------------------------------------------
 */

typedef struct dual {
    const csg_clear_plane *planes[CSG_HALVES_MOST];
    double weights[CSG_HALVES_MOST], rest[3]; /* rest: d + sum w_i s_i */
    double half;
    int count;
} dual;

static double value_of(const dual *d)
{
    double sum = d->half * (fabs(d->rest[0]) + fabs(d->rest[1]) + fabs(d->rest[2]));
    for (int i = 0; i < d->count; i++)
        sum += d->weights[i] * d->planes[i]->value;
    return sum;
}

/* The best weight of one plane, those of the others as they are: at 0, or where a coordinate of the
 * rest vanishes. */
static void improve(dual *d, int index)
{
    const csg_clear_plane *p = d->planes[index];
    double base[3], best_weight = 0, best = INFINITY;
    for (int k = 0; k < 3; k++)
        base[k] = d->rest[k] - d->weights[index] * p->slope[k];
    for (int at = -1; at < 3; at++) {
        double weight = at < 0 ? 0 : -base[at] / p->slope[at], value;
        if (at >= 0 && !(weight > 0 && weight < 1e6))
            continue;
        value = weight * p->value;
        for (int k = 0; k < 3; k++)
            value += d->half * fabs(base[k] + weight * p->slope[k]);
        if (value < best) {
            best = value;
            best_weight = weight;
        }
    }
    d->weights[index] = best_weight;
    for (int k = 0; k < 3; k++)
        d->rest[k] = base[k] + best_weight * p->slope[k];
}

/* Weights that make -direction of two or three normals, as nearly as they can. False: not all are
 * positive. */
static bool compose(dual *d, const double direction[3])
{
    const double *s[3], *w = direction;
    for (int i = 0; i < d->count; i++)
        s[i] = d->planes[i]->slope;
    if (d->count == 2) {
        double g = csg_dot3(s[0], s[1]), a = -csg_dot3(s[0], w), b = -csg_dot3(s[1], w),
               det = 1 - g * g;
        d->weights[0] = (a - g * b) / det;
        d->weights[1] = (b - g * a) / det;
    } else {
        double cross[3][3], det;
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                cross[i][k] = s[(i + 1) % 3][(k + 1) % 3] * s[(i + 2) % 3][(k + 2) % 3] -
                              s[(i + 1) % 3][(k + 2) % 3] * s[(i + 2) % 3][(k + 1) % 3];
        det = csg_dot3(s[0], cross[0]);
        for (int i = 0; i < 3; i++)
            d->weights[i] = -csg_dot3(w, cross[i]) / det;
    }
    for (int i = 0; i < d->count; i++)
        if (!(d->weights[i] >= 0 && d->weights[i] < 1e6))
            return false;
    for (int k = 0; k < 3; k++) {
        d->rest[k] = direction[k];
        for (int i = 0; i < d->count; i++)
            d->rest[k] += d->weights[i] * s[i][k];
    }
    return true;
}

static double reach_of_piece(const csg_clear_pieces *pieces, uint8_t mask, double half,
                             const double direction[3])
{
    dual d = {.half = half, .rest = {direction[0], direction[1], direction[2]}};
    for (int i = 0; i < pieces->plane_count; i++)
        if (mask >> i & 1)
            d.planes[d.count++] = &pieces->planes[i];
    double best = value_of(&d);
    for (int sweep = 0; sweep < (d.count > 1 ? SWEEPS : 1); sweep++)
        for (int i = 0; i < d.count; i++)
            improve(&d, i);
    best = fmin(best, value_of(&d));
    if ((d.count == 2 || d.count == 3) && compose(&d, direction))
        best = fmin(best, value_of(&d));
    return best;
}

double csg_clear_reach(const csg_clear_pieces *pieces, double half, const double direction[3])
{
    double most = -INFINITY;
    if (!pieces)
        return half * (fabs(direction[0]) + fabs(direction[1]) + fabs(direction[2]));
    for (int i = 0; i < pieces->count; i++)
        most = fmax(most, reach_of_piece(pieces, pieces->masks[i], half, direction));
    return most;
}
