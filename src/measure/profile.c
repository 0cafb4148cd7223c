/* SPDX-License-Identifier: MIT
 * Profiles; see profile.h. With r the distance from the axis and z along it the volume is 2 pi
 * times the integral of r over the section, and its moments are such integrals, too; the area is 2
 * pi times the integral of r along the section's curve. A square is the middle section of a cube
 * around a place in the half plane, so what is known of cubes tells of it. In any other half plane
 * through the axis the solid's section is between the same bounds (axis.h), so what would be 0 of a
 * perfect one is no more than these are apart.
 */
#include "measure/profile.h"

#include <math.h>
#include <string.h>

#include "measure/carve.h"
#include "measure/cut.h"
#include "measure/graph.h"
#include "measure/graph_field.h"
#include "measure/section.h"

/* Of r^i z^k over the section. */
enum { R, RZ, RR, RRZ, RRR, RZZ, WEIGHTS };

enum {
    SQUARES = 4,
    DEEPEST = 15,          /* levels: more digits no centre has as a float (begin) */
    MOST_SQUARES = 1 << 14 /* in all rounds: what takes more is measured by cubes */
};

/* Than the volume, second moments may be, of their size. */
static const double MOMENTS_WIDER = 4;

static const double PI = 3.14159265358979324;

typedef struct sums {
    double low[WEIGHTS], high[WEIGHTS];
    double arc_low, arc_high; /* of r along the curve; high: INFINITY, nothing bounds it */
    double cut;               /* area of all squares that were cut: their rounding */
} sums;

typedef struct profile {
    csg_measure_walk *walk;
    int radius, along, across; /* axes of the frame */
    double share, arc_share;   /* what a square may leave open */
    double squared[WEIGHTS];   /* of second moments: about as much more of them */
    double reach;              /* no place of the root is as far out */
    uint64_t squares, latest;
    bool out_of_memory;
    sums sum;
} profile;

typedef struct interval {
    double low, high;
} interval;

static interval times(interval a, interval b)
{
    double p[4] = {a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
    return (interval){fmin(fmin(p[0], p[1]), fmin(p[2], p[3])),
                      fmax(fmax(p[0], p[1]), fmax(p[2], p[3]))};
}

static double radius_at(const profile *p, const csg_measure_cube *q)
{
    return q->c[p->radius];
}

/* ---- what is in a square -----------------------------------------------------------------------
 */

/* No more than that area anywhere in the square. */
static void add_open(const profile *p, const csg_measure_cube *q, double area, sums *s)
{
    double r = radius_at(p, q), z = q->c[p->along], h = q->half;
    const interval rs = {fmax(r - h, 0), r + h}, zs = {z - h, z + h};
    interval zz = times(zs, zs), of[WEIGHTS];
    zz.low = fmax(zz.low, 0);
    of[R] = rs;
    of[RZ] = times(rs, zs);
    of[RR] = times(rs, rs);
    of[RRZ] = times(of[RR], zs);
    of[RRR] = times(of[RR], rs);
    of[RZZ] = times(rs, zz);
    for (int n = 0; n < WEIGHTS; n++) {
        s->low[n] += area * fmin(of[n].low, 0);
        s->high[n] += area * fmax(of[n].high, 0);
    }
}

/* No integral of a product of three coordinates is more over a part of a square. */
static double third_of(double half)
{
    return half * half * half * half * half;
}

/* Integrals of 1, u, v, u^2, v^2 and u v around the centre, off by these; no third moment is more
 * than that. */
typedef struct known {
    double one, u, v, uu, vv, uv;
    double error, first, second, third;
} known;

static void add_known(const profile *p, const csg_measure_cube *q, const known *k, sums *s)
{
    double r = radius_at(p, q), z = q->c[p->along], a = fabs(z);
    const double middle[WEIGHTS] = {
        [R] = r * k->one + k->u,
        [RZ] = r * z * k->one + z * k->u + r * k->v + k->uv,
        [RR] = r * r * k->one + 2 * r * k->u + k->uu,
        [RRZ] = z * (r * r * k->one + 2 * r * k->u + k->uu) + r * r * k->v + 2 * r * k->uv,
        [RRR] = r * r * r * k->one + 3 * r * r * k->u + 3 * r * k->uu,
        [RZZ] = r * (z * z * k->one + 2 * z * k->v + k->vv) + z * z * k->u + 2 * z * k->uv,
    };
    const double off[WEIGHTS] = {
        [R] = r * k->error + k->first,
        [RZ] = r * a * k->error + (a + r) * k->first + k->second,
        [RR] = r * r * k->error + 2 * r * k->first + k->second,
        [RRZ] = a * (r * r * k->error + 2 * r * k->first + k->second) + r * r * k->first +
                2 * r * k->second + k->third,
        [RRR] = r * r * r * k->error + 3 * r * r * k->first + 3 * r * k->second + k->third,
        [RZZ] = r * (a * a * k->error + 2 * a * k->first + k->second) + a * a * k->first +
                2 * a * k->second + k->third,
    };
    for (int n = 0; n < WEIGHTS; n++) {
        s->low[n] += middle[n] - off[n];
        s->high[n] += middle[n] + off[n];
    }
}

static void add_full(const profile *p, const csg_measure_cube *q, sums *s)
{
    double h = q->half, area = 4 * h * h;
    const known all = {.one = area, .uu = area * h * h / 3, .vv = area * h * h / 3};
    add_known(p, q, &all, s);
}

/* Of the solid that has the section in all of the cube: its integrals around the cube's centre, and
 * how far they are off. */
static void add_integrals(const profile *p, const csg_measure_cube *q, const double *of,
                          const csg_graph *off, sums *s)
{
    static const int MIXED[3][3] = {{0, CSG_INTEGRAL_XY, CSG_INTEGRAL_XZ},
                                    {CSG_INTEGRAL_XY, 0, CSG_INTEGRAL_YZ},
                                    {CSG_INTEGRAL_XZ, CSG_INTEGRAL_YZ, 0}};
    double h = q->half, deep = 1 / (2 * h);
    const known k = {.one = deep * of[CSG_INTEGRAL_ONE],
                     .u = deep * of[CSG_INTEGRAL_X + p->radius],
                     .v = deep * of[CSG_INTEGRAL_X + p->along],
                     .uu = deep * of[CSG_INTEGRAL_XX + p->radius],
                     .vv = deep * of[CSG_INTEGRAL_XX + p->along],
                     .uv = deep * of[MIXED[p->radius][p->along]],
                     .error = off ? deep * off->error : 0,
                     .first = off ? deep * off->first : 0,
                     .second = off ? deep * off->second : 0,
                     .third = third_of(h)};
    s->cut += 4 * h * h;
    add_known(p, q, &k, s);
}

/* ---- squares -----------------------------------------------------------------------------------
 */

/* The solid in it, by models. False: more is open than the share, or it is not known. */
static bool add_solid(profile *p, const csg_measure_cube *q, const csg_taylor_pieces *section,
                      sums *s)
{
    csg_graph graph;
    double h = q->half, share = p->share / (radius_at(p, q) + h) * 2 * h, reach = p->walk->half;
    if (third_of(h) > p->share * reach * reach || !csg_graph_find(section, h, share, &graph) ||
        !graph.is_close)
        return false;
    add_integrals(p, q, graph.integrals, &graph, s);
    for (int n = RRR; n <= RZZ; n++)
        if (s->high[n] - s->low[n] > MOMENTS_WIDER * p->share * p->squared[n]) {
            *s = (sums){.cut = 0};
            return false;
        }
    return true;
}

/* False: the same of the curve. */
static bool add_curve(profile *p, const csg_measure_cube *q, const csg_taylor_pieces *section,
                      sums *s)
{
    double least, most;
    const csg_graph_turned turned = {
        .across = p->across, .radius = p->radius, .at = radius_at(p, q), .enough = p->arc_share};
    if (!csg_graph_arc(section, q->half, &turned, &least, &most) || most - least > p->arc_share)
        return false;
    s->arc_low += least;
    s->arc_high += most;
    return true;
}

/* Planes that do not depend on the axis across: with the section they go on along it, and what is
 * in the cube is as much more as the cube is deep. */
static void flatten(const profile *p, csg_halves *halves)
{
    for (int i = 0; i < halves->plane_count; i++) {
        csg_enclosure *e = &halves->planes[i];
        if (e->stray > 0)
            e->stray += fabs(e->slope[p->across]);
        e->slope[p->across] = 0;
    }
}

/* The solid by such planes. Returns what is left open. */
static double add_carved(const profile *p, const csg_measure_cube *q, const csg_halves *halves,
                         sums *s)
{
    double h = q->half, deep = 1 / (2 * h), certain[CSG_INTEGRALS] = {0};
    double most = csg_carve(halves, h, CSG_CARVE_MOST, NULL);
    double least = csg_carve(halves, h, CSG_CARVE_LEAST, certain);
    double open = fmin(fmax(most - least, 0) * deep, 4 * h * h);
    add_integrals(p, q, certain, NULL, s);
    add_open(p, q, open, s);
    return open * (radius_at(p, q) + h);
}

/* The curve by such planes. No line along a group's direction
 * meets its surface twice; nor is a convex figure's curve in the square longer than that is around.
 */
static interval arc_by_planes(const profile *p, const csg_measure_cube *q, const csg_halves *halves)
{
    static const double MORE = 1 + 1e-6; /* of what normals lean out of the half plane */
    csg_section_group groups[CSG_HALVES_MOST];
    double h = q->half, r = radius_at(p, q), deep = 1 / (2 * h);
    interval arc = {0, 0};
    int count = csg_section_find_groups(halves, h, groups);
    for (int i = 0; i < count; i++) {
        const csg_section_group *g = &groups[i];
        csg_section seen = csg_section_of_group(halves, h, g);
        double around = g->is_convex ? 8 * h * g->count : INFINITY;
        double most = seen.most > 0 ? deep * seen.most / g->cosine : 0;
        arc.low += deep * seen.least;
        arc.high += fmin(around, most);
    }
    return (interval){arc.low * fmax(r - h, 0), arc.high * (r + h) * MORE};
}

/* By planes, and what any pieces tell. Returns whether that is enough. */
static bool add_planes(profile *p, csg_measure_cube *q, const csg_taylor_pieces *section,
                       bool has_solid, sums *s)
{
    static const double STRAY_MOST = 0.9;
    csg_halves halves;
    double h = q->half, open = 0;
    interval arc = {0, INFINITY};
    const csg_graph_turned turned = {
        .across = p->across, .radius = p->radius, .at = radius_at(p, q)};
    bool has_planes = csg_measure_enclose_with_strays(p->walk, &p->walk->workers[0], q, &halves);
    if (q->state == CSG_CELL_INSIDE)
        add_full(p, q, s);
    if (q->state != CSG_CELL_SURFACE)
        return true;
    if (has_planes) {
        flatten(p, &halves);
        arc = arc_by_planes(p, q, &halves);
    }
    if (section)
        arc.high = fmin(arc.high, csg_graph_arc_most(section, h, &turned, STRAY_MOST));
    bool is_last = q->level >= DEEPEST, is_close = arc.high - arc.low <= p->arc_share;
    double least, most; /* of models, more than the share, but less than planes leave */
    if (is_last && section && csg_graph_arc(section, h, &turned, &least, &most))
        arc = (interval){fmax(arc.low, least), fmin(arc.high, most)};
    is_close = is_close && (has_solid || third_of(h) <= p->share * p->walk->half * p->walk->half);
    if (!is_last && !is_close)
        return false;
    s->arc_low += arc.low;
    s->arc_high += arc.high;
    if (!has_solid && has_planes) {
        open = add_carved(p, q, &halves, s);
    } else if (!has_solid) {
        add_open(p, q, 4 * h * h, s);
        open = INFINITY;
    }
    return is_last || open <= p->share;
}

/* False: it has to be divided. */
static bool settle(profile *p, csg_measure_cube *q)
{
    csg_taylor_pieces f, section; /* not filled: they are large */
    sums solid = {.cut = 0}, curve = {.cut = 0}, rest = {.cut = 0};
    bool has_section = csg_graph_field_pieces(&q->tape, q->c, q->half, &f) &&
                       csg_graph_section(&f, q->half, p->across, 0, &section);
    bool has_solid = has_section && add_solid(p, q, &section, &solid);
    bool has_curve = has_solid && add_curve(p, q, &section, &curve);
    if (!has_curve && !add_planes(p, q, has_section ? &section : NULL, has_solid, &rest))
        return false;
    bool is_plain = q->state != CSG_CELL_SURFACE; /* then planes have told all of it */
    const sums *of[3] = {&rest, &solid, &curve};
    for (int i = 0; i < (is_plain ? 1 : 3); i++) {
        for (int n = 0; n < WEIGHTS; n++) {
            p->sum.low[n] += of[i]->low[n];
            p->sum.high[n] += of[i]->high[n];
        }
        p->sum.arc_low += of[i]->arc_low;
        p->sum.arc_high += of[i]->arc_high;
        p->sum.cut += of[i]->cut;
    }
    return true;
}

/* No place of the bounds is as far from the axis, or along it. */
static bool is_beyond(const profile *p, const csg_measure_cube *q)
{
    static const double CORNER = 1.4143; /* sqrt(2) */
    const csg_box b = p->walk->bounds;
    const double low[3] = {b.min.x, b.min.y, b.min.z}, high[3] = {b.max.x, b.max.y, b.max.z};
    double z = q->c[p->along], h = q->half;
    return radius_at(p, q) - h > CORNER * p->walk->half || z - h > high[p->along] ||
           z + h < low[p->along];
}

/* Quarters of a square; new tapes are in the worker's arena. False: out of memory. */
static bool divide(const profile *p, const csg_measure_cube *parent,
                   csg_measure_cube children[SQUARES])
{
    csg_measure_walk *w = p->walk;
    csg_pruner *pruner = &w->workers[0].pruner;
    float c[3][CSG_OCTANTS];
    double half = parent->half / 2;
    bool is_root = !parent->level; /* its quarters are farther out than values are known for */
    for (int o = 0; o < CSG_OCTANTS; o++) {
        csg_measure_cube *child = &children[o % SQUARES];
        *child = (csg_measure_cube){.half = half,
                                    .level = parent->level + 1,
                                    .state = CSG_CELL_SURFACE,
                                    .tape = parent->tape};
        memcpy(child->c, parent->c, sizeof child->c);
        child->c[p->radius] += o & 1 ? half : -half;
        child->c[p->along] += o & 2 ? half : -half;
        for (int axis = 0; axis < 3; axis++)
            c[axis][o] = (float)child->c[axis];
    }
    if (is_root)
        return true;
    if (!csg_prune_octants(pruner, &parent->tape, c[0], c[1], c[2], csg_measure_radius(half)))
        return false;
    for (int o = 0; o < SQUARES; o++) {
        children[o].state =
            is_beyond(p, &children[o]) ? CSG_CELL_OUTSIDE : csg_prune_state(pruner, o);
        if (children[o].state == CSG_CELL_SURFACE &&
            !csg_prune_shorten(pruner, o, w->tau, &w->workers[0].arena, &children[o].tape))
            return false;
    }
    return true;
}

/* False: it was stopped, or there are too many. */
static bool visit(profile *p, const csg_measure_cube *parent)
{
    csg_measure_cube children[SQUARES];
    csg_arena *arena = &p->walk->workers[0].arena;
    csg_arena_mark mark = csg_arena_get_mark(arena);
    bool done = divide(p, parent, children);
    p->out_of_memory |= !done;
    for (int o = 0; o < SQUARES && done; o++) {
        csg_measure_cube *q = &children[o];
        if (q->state == CSG_CELL_INSIDE)
            add_full(p, q, &p->sum);
        if (q->state != CSG_CELL_SURFACE)
            continue;
        p->latest++;
        done = ++p->squares < MOST_SQUARES && !csg_mesh_should_stop(p->walk->watch) &&
               ((parent->level && settle(p, q)) || visit(p, q));
    }
    csg_arena_release_to(arena, mark);
    return done;
}

/* ---- all of it ---------------------------------------------------------------------------------
 */

/* Around r = 0 to more than any corner of the bounds is from the axis. Faces that lie where squares
 * meet would count for both, so a square's size is a prime number's multiple, which lengths that
 * somebody has written down are not, and the middle is none of its corners. Halves have 8 digits,
 * and the centres at the deepest level 24. */
static csg_measure_cube begin(profile *p)
{
    static const double PRIMES[] = {131, 167, 211, 251}, ABOVE = 341.0 / 4096, LARGER = 1.1;
    csg_measure_walk *w = p->walk;
    csg_measure_cube root = {.state = CSG_CELL_SURFACE, .tape = w->tape};
    int exponent;
    frexp(w->half, &exponent);
    for (int i = 0; !(root.half >= LARGER * w->half); i = (i + 1) % 4, exponent += !i)
        root.half = ldexp(PRIMES[i], exponent - 8);
    p->across = (w->axis + 2) % 3;
    p->radius = (w->axis + 1) % 3;
    p->along = w->axis;
    root.c[p->radius] = root.half;
    root.c[p->along] = ABOVE * root.half;
    p->reach = 2 * root.half;
    return root;
}

/* A sum of n terms is off by at most n units in the last place of the sum of their sizes, and a
 * term has a few of its own; no more than the root's area times the largest of the weights. */
static void take_rounding(profile *p)
{
    static const double TERM = 64;
    double terms = (double)p->latest * 8 + TERM, reach = p->reach, size[WEIGHTS];
    double slack = terms * 0x1p-52 * p->sum.high[R] + CSG_CUT_ROUNDING * p->sum.cut * reach;
    for (int n = 0; n < WEIGHTS; n++)
        size[n] = n == R ? 1 : n == RZ || n == RR ? reach : reach * reach;
    for (int n = 0; n < WEIGHTS; n++) {
        p->sum.low[n] -= 2 * slack * size[n];
        p->sum.high[n] += 2 * slack * size[n];
    }
    p->sum.low[R] = fmax(p->sum.low[R], 0);
    double more = terms * 0x1p-52 * p->sum.arc_high;
    p->sum.arc_low = fmax(p->sum.arc_low - more, 0);
    p->sum.arc_high += more;
}

static interval scaled(const sums *s, int n, double factor)
{
    static const double ROUNDING = 0x1p-50;
    double by = ROUNDING * factor * fmax(fabs(s->low[n]), fabs(s->high[n]));
    return (interval){factor * s->low[n] - by, factor * s->high[n] + by};
}

static void put_integral(csg_integral_bounds *out, int n, interval of)
{
    out->low[n] = of.low;
    out->high[n] = of.high;
}

/* Of a function g of the angle that is between bounds the integral of g cos is no more than 2 times
 * what these are apart, that of g sin cos no more than once that. */
static interval nearly_zero(const sums *s, int n, double factor)
{
    double most = factor * (s->high[n] - s->low[n]) * (1 + 0x1p-50);
    return (interval){-most, most};
}

static void take_integrals(const sums *s, const profile *p, csg_integral_bounds *out)
{
    static const int MIXED[3][3] = {{0, CSG_INTEGRAL_XY, CSG_INTEGRAL_XZ},
                                    {CSG_INTEGRAL_XY, 0, CSG_INTEGRAL_YZ},
                                    {CSG_INTEGRAL_XZ, CSG_INTEGRAL_YZ, 0}};
    int r = p->radius, z = p->along, y = p->across;
    put_integral(out, CSG_INTEGRAL_ONE, scaled(s, R, 2 * PI));
    put_integral(out, CSG_INTEGRAL_X + z, scaled(s, RZ, 2 * PI));
    put_integral(out, CSG_INTEGRAL_X + r, nearly_zero(s, RR, 2));
    put_integral(out, CSG_INTEGRAL_X + y, nearly_zero(s, RR, 2));
    put_integral(out, CSG_INTEGRAL_XX + z, scaled(s, RZZ, 2 * PI));
    put_integral(out, CSG_INTEGRAL_XX + r, scaled(s, RRR, PI));
    put_integral(out, CSG_INTEGRAL_XX + y, scaled(s, RRR, PI));
    put_integral(out, MIXED[r][y], nearly_zero(s, RRR, 1));
    put_integral(out, MIXED[z][r], nearly_zero(s, RRZ, 2));
    put_integral(out, MIXED[z][y], nearly_zero(s, RRZ, 2));
    out->low[0] = fmax(out->low[0], 0);
    out->is_proven = true;
    out->cubes = p->squares;
}

/* What is open falls with the share's power 4/5: a square leaves its fifth power, and there are as
 * many as lengths of it. Of the curve it is a little less. */
static double step_of(double ratio)
{
    static const double LEAST = 0x1p-12, MOST = 0.25;
    return ratio < 1 ? fmin(fmax(0.5 * ratio * sqrt(sqrt(ratio)), LEAST), MOST) : 1;
}

/* Each round is proven by itself. */
static void keep_best(const sums *now, sums *best)
{
    for (int n = 0; n < WEIGHTS; n++) {
        best->low[n] = fmax(best->low[n], now->low[n]);
        best->high[n] = fmin(best->high[n], now->high[n]);
    }
    best->arc_low = fmax(best->arc_low, now->arc_low);
    best->arc_high = fmin(best->arc_high, now->arc_high);
}

static double ratio_of(double tolerance, double low, double high)
{
    return isfinite(high) ? tolerance * high / (high - low) : 0;
}

/* Round by round, until both are as close as asked, or no closer than in the round before. */
static void find_sums(profile *p, const csg_measure_cube *root, csg_profile_measures *out,
                      sums *best)
{
    static const double BETTER = 1.05;
    double before = 0, arc_before = 0;
    for (bool more = true; more;) {
        p->sum = (sums){.cut = 0};
        p->latest = 0;
        if (!visit(p, root))
            return;
        take_rounding(p);
        keep_best(&p->sum, best);
        double ratio = ratio_of(out->tolerance, best->low[R], best->high[R]);
        for (int n = RRR; n <= RZZ; n++) {
            ratio =
                fmin(ratio, ratio_of(MOMENTS_WIDER * out->tolerance, best->low[n], best->high[n]));
            p->squared[n] = fmin(best->high[n] / best->high[R], p->squared[n]);
        }
        double arc_ratio = ratio_of(out->area_tolerance, best->arc_low, best->arc_high);
        out->is_close = ratio >= 1;
        out->is_area_close = arc_ratio >= 1;
        more = (!out->is_close && ratio > BETTER * before) ||
               (!out->is_area_close && arc_ratio > BETTER * arc_before);
        before = ratio;
        arc_before = arc_ratio;
        p->share *= step_of(ratio);
        p->arc_share *= step_of(arc_ratio);
    }
}

csgm_status csg_measure_profile(csg_measure_walk *walk, csg_profile_measures *out)
{
    profile p = {.walk = walk};
    const csg_measure_cube root = begin(&p);
    double h = root.half;
    sums best = {.arc_high = INFINITY};
    for (int n = 0; n < WEIGHTS; n++) {
        best.low[n] = -INFINITY;
        best.high[n] = INFINITY;
    }
    out->is_close = out->is_area_close = false;
    p.squared[RRR] = p.squared[RZZ] = p.reach * p.reach;
    p.share = h * h * h * 0x1p-14;
    p.arc_share = h * h * 0x1p-9;
    find_sums(&p, &root, out, &best);
    out->integrals = (csg_integral_bounds){.cubes = p.squares};
    if (p.out_of_memory)
        return csg_context_no_memory(walk->context);
    if (csg_mesh_should_stop(walk->watch))
        return csg_mesh_why_stopped(walk->watch);
    if (out->is_close)
        take_integrals(&best, &p, &out->integrals);
    if (out->is_area_close)
        out->area = (csgm_interval){2 * PI * best.arc_low * (1 - 0x1p-50),
                                    2 * PI * best.arc_high * (1 + 0x1p-50)};
    return CSGM_OK;
}
