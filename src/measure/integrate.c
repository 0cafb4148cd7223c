/* SPDX-License-Identifier: MIT
 * Volume and moments by cubes; see integrate.h. Every cube contributes what is inside for certain,
 * and what may be.
 */
#include "measure/integrate.h"

#include <math.h>
#include <string.h>

#include "measure/carve.h"
#include "measure/graph.h"
#include "measure/graph_field.h"
#include "measure/rounds.h"

/* Of a cube. */
typedef struct sum {
    double low[CSG_INTEGRALS], high[CSG_INTEGRALS];
    double cut; /* volume of all cubes that were cut: what their rounding is counted from */
} sum;

typedef struct job {
    double reach; /* of the root */
    double tolerance;
    csg_integral_bounds *out;
} job;

static double volume_of(const csg_measure_cube *q)
{
    return 8 * q->half * q->half * q->half;
}

static void product_range(double a, double b, double c, double d, double *low, double *high)
{
    double p[4] = {a * c, a * d, b * c, b * d};
    *low = fmin(fmin(p[0], p[1]), fmin(p[2], p[3]));
    *high = fmax(fmax(p[0], p[1]), fmax(p[2], p[3]));
}

/* Volume within [0, open] anywhere in the cube. */
static void add_open(sum *s, const csg_measure_cube *q, double open)
{
    double low[CSG_INTEGRALS] = {1}, high[CSG_INTEGRALS] = {1};
    for (int k = 0; k < 3; k++) {
        double from = q->c[k] - q->half, to = q->c[k] + q->half;
        low[CSG_INTEGRAL_X + k] = from;
        high[CSG_INTEGRAL_X + k] = to;
        low[CSG_INTEGRAL_XX + k] = from <= 0 && to >= 0 ? 0 : fmin(from * from, to * to);
        high[CSG_INTEGRAL_XX + k] = fmax(from * from, to * to);
    }
    for (int n = 0; n < 3; n++) {
        int i = CSG_INTEGRAL_X + (n == 2), k = CSG_INTEGRAL_X + (n == 0 ? 1 : 2);
        product_range(low[i], high[i], low[k], high[k], &low[CSG_INTEGRAL_XY + n],
                      &high[CSG_INTEGRAL_XY + n]);
    }
    for (int n = 0; n < CSG_INTEGRALS; n++) {
        s->low[n] += open * fmin(low[n], 0);
        s->high[n] += open * fmax(high[n], 0);
    }
}

static void add_known(sum *s, const csg_measure_cube *q, double around_center[CSG_INTEGRALS])
{
    csg_integrals_shift(around_center, q->c);
    for (int n = 0; n < CSG_INTEGRALS; n++) {
        s->low[n] += around_center[n];
        s->high[n] += around_center[n];
    }
}

static void settle_plain(const void *user, const csg_measure_cube *q, void *account)
{
    sum *s = account;
    double whole[CSG_INTEGRALS];
    *s = (sum){.cut = 0};
    if (q->state != CSG_CELL_INSIDE)
        return;
    csg_integrals_of_cube(q->half, whole);
    add_known(s, q, whole);
}

static void leave_open(const void *user, const csg_measure_cube *q, void *account)
{
    sum *s = account;
    *s = (sum){.cut = volume_of(q)};
    add_open(s, q, volume_of(q));
}

/* Of a graph's integrals around the cube's centre. */
static void add_graph(sum *s, const csg_measure_cube *q, csg_graph *g)
{
    static const int FIRST[] = {0, 1, 2, 0, 0, 1}, SECOND[] = {0, 1, 2, 1, 2, 2};
    double off[CSG_INTEGRALS] = {g->error};
    for (int k = 0; k < 3; k++)
        off[CSG_INTEGRAL_X + k] = fabs(q->c[k]) * g->error + g->first;
    for (int n = 0; n < 6; n++) {
        double i = fabs(q->c[FIRST[n]]), k = fabs(q->c[SECOND[n]]);
        off[CSG_INTEGRAL_XX + n] = i * k * g->error + (i + k) * g->first + g->second;
    }
    csg_integrals_shift(g->integrals, q->c);
    for (int n = 0; n < CSG_INTEGRALS; n++) {
        s->low[n] += g->integrals[n] - off[n];
        s->high[n] += g->integrals[n] + off[n];
    }
}

/* Where the field is smooth in the cube. Returns what it leaves open; INFINITY: it is not smooth,
 * or may not be. */
static double settle_smooth(const csg_measure_cube *q, double enough, sum *s)
{
    csg_taylor_pieces f; /* not filled: they are large */
    csg_graph graph;
    if (!csg_graph_field_pieces(&q->tape, q->c, q->half, &f) ||
        !csg_graph_find(&f, q->half, enough, &graph))
        return INFINITY;
    if (!graph.is_close) {
        leave_open(NULL, q, s);
        return volume_of(q);
    }
    *s = (sum){.cut = volume_of(q)};
    add_graph(s, q, &graph);
    s->low[0] = fmax(s->low[0], 0);
    s->high[0] = fmin(s->high[0], volume_of(q));
    return s->high[0] - s->low[0];
}

static double settle(const void *user, const csg_measure_walk *walk, csg_measure_worker *worker,
                     csg_measure_cube *q, void *account)
{
    double known[CSG_INTEGRALS] = {0};
    csg_halves halves;
    sum *s = account;
    double smooth = settle_smooth(q, worker->enough, s);
    if (isfinite(smooth))
        return smooth;
    if (!csg_measure_enclose(walk, worker, q, &halves)) {
        leave_open(user, q, account);
        return volume_of(q);
    }
    if (q->state != CSG_CELL_SURFACE) {
        settle_plain(user, q, account);
        return 0;
    }
    double most = csg_carve(&halves, q->half, CSG_CARVE_MOST, NULL);
    double least = csg_carve(&halves, q->half, CSG_CARVE_LEAST, known);
    double open = fmin(fmax(most - least, 0), volume_of(q));
    *s = (sum){.cut = volume_of(q)};
    add_known(s, q, known);
    add_open(s, q, open);
    return open;
}

static void take_turned(const sum *from, int n, double sign, int k, sum *to)
{
    to->low[k] = sign > 0 ? from->low[n] : -from->high[n];
    to->high[k] = sign > 0 ? from->high[n] : -from->low[n];
}

/* Each coordinate is another one, or less than 0 times that. */
static void turn(const csg_symmetry *by, const void *of, void *account)
{
    static const int AT[3][3] = {{CSG_INTEGRAL_XX, CSG_INTEGRAL_XY, CSG_INTEGRAL_XZ},
                                 {CSG_INTEGRAL_XY, CSG_INTEGRAL_XX + 1, CSG_INTEGRAL_YZ},
                                 {CSG_INTEGRAL_XZ, CSG_INTEGRAL_YZ, CSG_INTEGRAL_XX + 2}};
    const sum *from = of;
    sum *to = account;
    *to = *from;
    for (int i = 0; i < 3; i++) {
        take_turned(from, CSG_INTEGRAL_X + by->axes[i], by->sign[i], CSG_INTEGRAL_X + i, to);
        for (int k = i; k < 3; k++)
            take_turned(from, AT[by->axes[i]][by->axes[k]], by->sign[i] * by->sign[k], AT[i][k],
                        to);
    }
}

static void combine(const void *user, const void *octants, void *account)
{
    const sum *of = octants;
    sum *s = account;
    *s = (sum){.cut = 0};
    for (int o = 0; o < CSG_OCTANTS; o++) {
        for (int n = 0; n < CSG_INTEGRALS; n++) {
            s->low[n] += of[o].low[n];
            s->high[n] += of[o].high[n];
        }
        s->cut += of[o].cut;
    }
}

/* With room for all rounding: a sum of n terms is off by at most n units in the last place of the
 * sum of their sizes (Higham 2002, 4.2), and a term has a few of its own. */
static double conclude(void *user, const void *root, const csg_rounds_counts *counts)
{
    static const double TERM = 16;
    const job *j = user;
    csg_integral_bounds *out = j->out;
    const sum *s = root;
    double terms = 8 * (double)counts->longest + TERM;
    double slack = terms * 0x1p-52 * s->high[0] + CSG_CUT_ROUNDING * s->cut;
    for (int n = 0; n < CSG_INTEGRALS; n++) {
        double size = n == 0 ? 1 : n < CSG_INTEGRAL_XX ? 2 * j->reach : 4 * j->reach * j->reach;
        out->low[n] = s->low[n] - slack * size;
        out->high[n] = s->high[n] + slack * size;
    }
    out->low[0] = fmax(out->low[0], 0);
    out->is_proven = true;
    out->cubes = counts->cubes;
    return j->tolerance * out->high[0] / (out->high[0] - out->low[0]);
}

csgm_status csg_measure_integrate(csg_measure_walk *walk, double tolerance, uint64_t most_cubes,
                                  csg_integral_bounds *out)
{
    job j = {.reach = walk->half, .tolerance = tolerance, .out = out};
    const csg_rounds_job rounds = {.account_bytes = sizeof(sum),
                                   .share = 8 * walk->half * walk->half * walk->half * 0x1p-20,
                                   .user = &j,
                                   .settle_plain = settle_plain,
                                   .leave_open = leave_open,
                                   .settle = settle,
                                   .turn = turn,
                                   .combine = combine,
                                   .conclude = conclude};
    memset(out, 0, sizeof *out);
    return csg_measure_rounds(walk, &rounds, most_cubes);
}
