/* SPDX-License-Identifier: MIT
 * The curve in which a half plane cuts a solid of revolution, as a graph; see graph.h. What of the
 * surface's normals is not in the half plane is in how far their slopes may be off.
 */
#include "measure/graph.h"

#include <math.h>

#include "base/geometry.h"
#include "measure/graph_field.h"

enum { HALVED_MOST = 30 /* times, a patch that the curve leaves the cube over */ };

/* Along one axis of the face: the polynomial z of the patch is value + slope d + ... there. */
typedef struct curve {
    double middle, half; /* of the patch, from the cube's centre */
    double z, slope, bend, third;
} curve;

typedef struct arc {
    const csg_graph_turned *turned;
    double half; /* of the cube */
    double wide; /* of a first patch, half, across */
    double enough, least, most;
} arc;

static curve curve_of(const csg_graph_patch *q, int along)
{
    return (curve){.middle = q->at[along],
                   .half = q->half[along],
                   .z = q->z,
                   .slope = q->g[along],
                   .bend = q->bend[along ? CSG_GRAPH_YY : CSG_GRAPH_XX],
                   .third = q->third[along ? CSG_GRAPH_YYY : CSG_GRAPH_XXX]};
}

static curve half_of(const curve *c, int side)
{
    double d = side * 0.5 * c->half;
    return (curve){.middle = c->middle + d,
                   .half = 0.5 * c->half,
                   .z = c->z + (c->slope + (0.5 * c->bend + c->third / 6 * d) * d) * d,
                   .slope = c->slope + (c->bend + 0.5 * c->third * d) * d,
                   .bend = c->bend + c->third * d,
                   .third = c->third};
}

/* Distances from the axis along the curve: factor z or d, and what is added to it. */
typedef struct distance {
    double at, of_z, of_d;
} distance;

/* With r the distance and A(p) = sqrt(1 + p^2), p the curve's slope: r A(p). */
static double integrand(const curve *c, const distance *r, double d)
{
    double z = c->z + (c->slope + (0.5 * c->bend + c->third / 6 * d) * d) * d;
    double p = c->slope + (c->bend + 0.5 * c->third * d) * d;
    return (r->at + r->of_z * z + r->of_d * (c->middle + d)) * sqrt(1 + p * p);
}

/* At most, over the patch. */
typedef struct bounds {
    double climb, turn, third; /* of p and its derivatives */
    double steep;              /* A(p) */
    double far;                /* r */
    double reach;              /* of z, from its middle */
} bounds;

static bounds bounds_of(const curve *c, const distance *r)
{
    double w = c->half;
    bounds b = {.third = fabs(c->third)};
    b.turn = fabs(c->bend) + b.third * w;
    b.climb = fabs(c->slope) + b.turn * w;
    b.steep = sqrt(1 + b.climb * b.climb);
    b.reach = (fabs(c->slope) + (0.5 * fabs(c->bend) + b.third / 6 * w) * w) * w * (1 + 1e-12);
    b.far = fabs(r->at + r->of_z * c->z + r->of_d * c->middle) + fabs(r->of_z) * b.reach +
            fabs(r->of_d) * w;
    return b;
}

/* By the rule of Gauss with two points, which errs by w^5 / 135 times the fourth derivative. A's
 * first to fourth derivatives are no more than 1, 1, 0.859 and 3. */
static double integral_of(const curve *c, const distance *r, const bounds *b, double *error)
{
    static const double POINT = 0.57735026918962576; /* sqrt(1/3) */
    static const double A_THIRD = 0.859, A_FOURTH = 3, MORE = 1 + 1e-9, ROUNDING = 1e-13;
    double w = c->half, t = b->turn, of_z = fabs(r->of_z);
    double sum = w * (integrand(c, r, -POINT * w) + integrand(c, r, POINT * w));
    double a1 = t, a2 = t * t + b->third, a3 = (A_THIRD * t * t + 3 * b->third) * t;
    double a4 = A_FOURTH * t * t * t * t + 6 * A_THIRD * t * t * b->third + 3 * b->third * b->third;
    double r1 = fabs(r->of_d) + of_z * b->climb, r2 = of_z * t, r3 = of_z * b->third;
    double fourth = b->far * a4 + 4 * r1 * a3 + 6 * r2 * a2 + 4 * r3 * a1;
    *error = w * w * w * w * w / 135 * fourth * MORE + ROUNDING * w * b->far * b->steep;
    return sum;
}

/* share: what the patch's width across is of a first patch's. */
static void add_curve(arc *s, const curve *c, const distance *r, const csg_graph_room *off,
                      double share, int more)
{
    static const double MORE = 1 + 1e-9;
    const bounds b = bounds_of(c, r);
    double h = s->half, reach = b.reach + off->most, error;
    if (c->z - reach >= h || c->z + reach <= -h)
        return;
    bool is_whole = c->z - reach > -h && c->z + reach < h;
    double sum = integral_of(c, r, &b, &error);
    double moved =
        2 * c->half *
        ((b.far + fabs(r->of_z) * off->most) * off->turned + fabs(r->of_z) * off->most * b.steep) *
        MORE;
    bool is_close = is_whole ? error <= fmax(CSG_GRAPH_SHARE * moved, CSG_GRAPH_LEAST * s->enough)
                             : sum + error + moved <= CSG_GRAPH_LEAST * s->enough;
    /* a curve that is as flat as it is known beside the cube's face stays there */
    bool is_worth = is_whole || b.reach > 0.5 * off->most;
    if (more && !is_close && is_worth) {
        for (int side = -1; side <= 1; side += 2) {
            const curve half = half_of(c, side);
            add_curve(s, &half, r, off, share, more - 1);
        }
        return;
    }
    s->least += is_whole ? share * fmax(sum - error - moved, 0) : 0;
    s->most += share * fmax(sum + error + moved, 0);
}

static double cross(void *user, const csg_graph_base *g, const csg_graph_patch *q,
                    const csg_graph_room *off)
{
    arc *s = user;
    int along = g->axes[0] == s->turned->across ? 1 : 0;
    bool is_along_z = g->axes[2] == s->turned->radius;
    const distance r = {
        .at = s->turned->at, .of_z = is_along_z ? g->turn : 0, .of_d = is_along_z ? 0 : 1};
    const curve c = curve_of(q, along);
    add_curve(s, &c, &r, off, q->half[1 - along] / s->wide, HALVED_MOST);
    return 0;
}

bool csg_graph_arc(const csg_taylor_pieces *section, double half, const csg_graph_turned *turned,
                   double *least, double *most)
{
    csg_graph_field g; /* not filled: it is large */
    double piece = half / CSG_GRAPH_SIDE, ignored = 0, farthest = turned->at + half;
    arc s = {.turned = turned, .half = half, .wide = piece, .enough = turned->enough};
    const csg_graph_visitor visitor = {.user = &s,
                                       .enough = INFINITY,
                                       .enough_turned =
                                           CSG_GRAPH_LEAST * turned->enough * 2 * piece / farthest,
                                       .cross = cross};
    csg_graph_field_begin(&g, section, half);
    if (g.bases[0].axes[2] == turned->across)
        return false;
    int along = g.bases[0].axes[0] == turned->across ? 1 : 0;
    for (int i = 0; i < CSG_GRAPH_SIDE; i++) {
        csg_graph_patch q = {.half = {piece, piece}};
        q.at[along] = (2 * i + 1) * piece - half;
        if (!csg_graph_field_visit(&g, &q, &visitor, &ignored))
            return false;
    }
    *least = s.least;
    *most = s.most;
    return isfinite(s.most);
}

double csg_graph_arc_most(const csg_taylor_pieces *section, double half,
                          const csg_graph_turned *turned, double stray_most)
{
    return 2 * half * csg_graph_spread_most(section, half, stray_most) * (turned->at + half) *
           (1 + 1e-6);
}
