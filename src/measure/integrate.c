/* SPDX-License-Identifier: MIT
 * Volume and moments by cubes; see integrate.h.
 *
 * Every cube contributes what is inside for certain, and what may be. A cube is divided while the
 * latter is more than a share that is the same for all of them, which costs the fewest cubes; where
 * the sum is too much still, the share is made smaller and the frontier's cubes are walked again.
 * Each round is proven by itself, and each cube of the frontier keeps its latest.
 */
#include "measure/integrate.h"

#include <math.h>
#include <string.h>

#include "base/pool.h"
#include "measure/carve.h"
#include "measure/share.h"

enum { ASK_EVERY = 256 /* cubes, whether to stop */ };

/* Of one cube of the frontier. */
typedef struct sum {
    double low[CSG_INTEGRALS], high[CSG_INTEGRALS];
    double cut;   /* volume of all cubes that were cut: what their rounding is counted from */
    double worst; /* the most that one cube leaves open */
    uint64_t cubes, looked; /* in the latest round; in all */
    bool is_full;           /* it had its share of cubes: it stays as it is */
} sum;

typedef struct rounds {
    csg_measure_walk *walk;
    sum *sums; /* one a cube of the frontier */
    double share;
    uint64_t most_of_one;
    atomic_bool out_of_memory;
} rounds;

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
    s->worst = fmax(s->worst, open);
}

static void add_known(sum *s, const csg_measure_cube *q, double around_center[CSG_INTEGRALS])
{
    csg_integrals_shift(around_center, q->c);
    for (int n = 0; n < CSG_INTEGRALS; n++) {
        s->low[n] += around_center[n];
        s->high[n] += around_center[n];
    }
}

static void add_inside(sum *s, const csg_measure_cube *q)
{
    double whole[CSG_INTEGRALS];
    csg_integrals_of_cube(q->half, whole);
    add_known(s, q, whole);
}

/* Adds the cube if what it leaves open is no more than the share, or is_last. */
static bool settle(const rounds *r, csg_measure_worker *worker, sum *s, csg_measure_cube *q,
                   bool is_last)
{
    double known[CSG_INTEGRALS] = {0}, open = volume_of(q);
    csg_halves halves;
    s->cubes++;
    if (csg_measure_enclose(r->walk, worker, q, &halves)) {
        if (q->state == CSG_CELL_INSIDE)
            add_inside(s, q);
        if (q->state != CSG_CELL_SURFACE)
            return true;
        double most = csg_carve(&halves, q->half, CSG_CARVE_MOST, NULL);
        double least = csg_carve(&halves, q->half, CSG_CARVE_LEAST, known);
        open = fmin(fmax(most - least, 0), open);
    }
    if (open > r->share && !is_last)
        return false;
    s->cut += volume_of(q);
    add_known(s, q, known);
    add_open(s, q, open);
    return true;
}

/* False: out of memory, or it is time to stop. */
static bool visit(rounds *r, csg_measure_worker *worker, sum *s, const csg_measure_cube *parent)
{
    csg_measure_cube children[CSG_OCTANTS];
    csg_arena_mark mark = csg_arena_get_mark(&worker->arena);
    bool done = csg_measure_divide(r->walk, worker, parent, &worker->arena, children);
    if (!done)
        atomic_store(&r->out_of_memory, true);
    for (int o = 0; o < CSG_OCTANTS && done; o++) {
        csg_measure_cube *q = &children[o];
        s->is_full |= s->cubes >= r->most_of_one;
        if (q->state == CSG_CELL_INSIDE)
            add_inside(s, q);
        else if (q->state == CSG_CELL_SURFACE &&
                 !settle(r, worker, s, q, s->is_full || q->level >= CSG_MEASURE_DEEPEST))
            done = visit(r, worker, s, q);
        if (s->cubes % ASK_EVERY == 0 && csg_mesh_should_stop(r->walk->watch))
            done = false;
    }
    csg_arena_release_to(&worker->arena, mark);
    return done;
}

static bool look_at(void *user, uint32_t worker_index, size_t index)
{
    rounds *r = user;
    const csg_measure_cube *q = &r->walk->cubes[index];
    sum now = {.cubes = 0};
    if (r->sums[index].worst <= r->share || r->sums[index].is_full)
        return true;
    if (csg_mesh_should_stop(r->walk->watch) || !visit(r, &r->walk->workers[worker_index], &now, q))
        return false;
    now.looked = r->sums[index].looked + now.cubes;
    r->sums[index] = now;
    return true;
}

/* In the order of the frontier, with room for all rounding: a sum of n terms is off by at most n
 * units in the last place of the sum of their sizes (Higham 2002, 4.2), and a term has a few of its
 * own. */
static void gather(const rounds *r, csg_integral_bounds *out)
{
    static const double TERM = 16;
    uint64_t longest = 0;
    double cut = 0, reach = r->walk->half;
    memset(out, 0, sizeof *out);
    for (size_t i = 0; i < r->walk->count; i++) {
        const sum *s = &r->sums[i];
        for (int n = 0; n < CSG_INTEGRALS; n++) {
            out->low[n] += s->low[n];
            out->high[n] += s->high[n];
        }
        cut += s->cut;
        out->cubes += s->looked;
        longest = s->cubes > longest ? s->cubes : longest;
    }
    double terms = 8 * (double)longest + (double)r->walk->count + TERM;
    double slack = terms * 0x1p-52 * out->high[0] + CSG_CUT_ROUNDING * cut;
    for (int n = 0; n < CSG_INTEGRALS; n++) {
        double size = n == 0 ? 1 : n < CSG_INTEGRAL_XX ? 2 * reach : 4 * reach * reach;
        out->low[n] -= slack * size;
        out->high[n] += slack * size;
    }
    out->low[0] = fmax(out->low[0], 0);
    out->is_proven = true;
}

static void report(void *user, size_t done, size_t count)
{
    const rounds *r = user;
    csg_mesh_report_progress(r->walk->watch, (double)done / (double)count);
}

static void begin_sums(rounds *r)
{
    for (size_t i = 0; i < r->walk->count; i++) {
        const csg_measure_cube *q = &r->walk->cubes[i];
        r->sums[i] = (sum){.cubes = 0};
        if (q->state == CSG_CELL_INSIDE)
            add_inside(&r->sums[i], q);
        else
            add_open(&r->sums[i], q, volume_of(q));
    }
}

static uint64_t cubes_of(const rounds *r)
{
    uint64_t cubes = 0;
    for (size_t i = 0; i < r->walk->count; i++)
        cubes += r->sums[i].cubes;
    return cubes;
}

csgm_status csg_measure_integrate(csg_measure_walk *walk, double tolerance, uint64_t most_cubes,
                                  csg_integral_bounds *out)
{
    csg_memory *memory = &walk->context->memory;
    size_t bytes = (walk->count + 1) * sizeof(sum);
    rounds r = {.walk = walk, .share = 8 * walk->half * walk->half * walk->half * 0x1p-20};
    csgm_status status = CSGM_OK;
    memset(out, 0, sizeof *out);
    r.sums = csg_memory_alloc(memory, bytes);
    if (!r.sums)
        return csg_context_no_memory(walk->context);
    begin_sums(&r);
    for (bool more = true; more && status == CSGM_OK;) {
        r.most_of_one = 64 + (most_cubes - out->cubes) / 16;
        csg_mesh_take(walk->watch, CSGM_STAGE_MEASURE, 0.3);
        if (!csg_pool_run(walk->context->pool, walk->count, look_at, report, &r))
            status = atomic_load(&r.out_of_memory) ? csg_context_no_memory(walk->context)
                                                   : csg_mesh_why_stopped(walk->watch);
        gather(&r, out);
        double open = out->high[0] - out->low[0], wanted = tolerance * out->high[0];
        more = open > wanted && out->cubes < most_cubes &&
               csg_measure_next_share(&r.share, wanted / open,
                                      (double)cubes_of(&r) + (double)walk->count,
                                      most_cubes - out->cubes);
    }
    csg_memory_release(memory, r.sums, bytes);
    return status;
}
