/* SPDX-License-Identifier: MIT
 * Area by cubes; see area.h.
 *
 * Let s be a unit vector, the same all over a cube. By the divergence theorem what of s flows out
 * of the solid through the cube's faces flows into it through its surface in the cube, and there
 * s . n is the cosine between s and the surface's inward normal n: so the surface's area is at
 * least that flow, and at most one over the least cosine times it, which is 1 + O(h^2). The flow
 * is made of how much of each face is in the solid, each known between bounds.
 *
 * Two cubes share a face, and what is not known of it takes part with the difference of their s
 * alone, which is O(h), too. So cubes tell their parent how much of their faces is in the solid,
 * and what the area is beside the flow of a vector that is theirs; the parent has a vector of its
 * own and adds the flow of the differences. In the root that is the whole.
 *
 * Where surfaces meet, s is 0, and each group of pieces (section.h) is seen along its own normal.
 */
#include "measure/area.h"

#include <math.h>
#include <string.h>

#include "base/pool.h"
#include "measure/section.h"
#include "measure/share.h"

enum {
    ASK_EVERY = 256, /* cubes, whether to stop */
    FACES = 6,
    UNBOUNDED_DEEPEST = 12 /* levels, where nothing bounds the area: that may be so at any size */
};

/* A cube: its surface's area is within [low, high] + the flow of s out of the solid in it. */
typedef struct account {
    csg_section faces[FACES]; /* in the solid; 2 * axis + (1: the side of larger coordinates) */
    double s[3], low, high;
    bool is_unbounded; /* somewhere in it nothing bounds the area, and nothing is in `high` */
} account;

/* Of one cube of the frontier. */
typedef struct tally {
    account account;
    double size;            /* of all that was added up: what its rounding is counted from */
    double worst;           /* the most that one cube leaves open */
    uint64_t cubes, looked; /* in the latest round; in all */
    bool is_full;           /* it had its share of cubes: it stays as it is */
} tally;

typedef struct rounds {
    csg_measure_walk *walk;
    const csg_area_selection *selection;
    tally *tallies; /* one a cube of the frontier */
    double share;
    uint64_t most_of_one;
    atomic_bool out_of_memory;
} rounds;

static double face_of(double half)
{
    return 4 * half * half;
}

static account plain(double half, csg_cell_state state)
{
    account a = {.low = 0};
    double area = state == CSG_CELL_INSIDE ? face_of(half) : 0;
    for (int i = 0; i < FACES; i++)
        a.faces[i] = (csg_section){area, area};
    return a;
}

/* Nothing is known. */
static account unknown(double half)
{
    account a = {.is_unbounded = true};
    for (int i = 0; i < FACES; i++)
        a.faces[i] = (csg_section){0, face_of(half)};
    return a;
}

/* Of a vector, out of the solid through the cube's faces: at least and at most. */
static csg_section flow_of(const account *a, const double v[3])
{
    csg_section flow = {0, 0};
    for (int i = 0; i < FACES; i++) {
        double through = i & 1 ? v[i / 2] : -v[i / 2];
        flow.least += through * (through > 0 ? a->faces[i].least : a->faces[i].most);
        flow.most += through * (through > 0 ? a->faces[i].most : a->faces[i].least);
    }
    return flow;
}

/* A vector for the parent, in the middle of the children's, and the flow of what they differ by. */
static account combine(const account children[CSG_OCTANTS], double *size)
{
    account a = {.low = 0};
    int count = 0;
    for (int o = 0; o < CSG_OCTANTS; o++) {
        const double *s = children[o].s;
        count += s[0] != 0 || s[1] != 0 || s[2] != 0;
        for (int k = 0; k < 3; k++) {
            a.s[k] += s[k];
            int face = 2 * k + (o >> k & 1);
            a.faces[face].least += children[o].faces[face].least;
            a.faces[face].most += children[o].faces[face].most;
        }
    }
    for (int k = 0; k < 3; k++)
        a.s[k] /= count ? count : 1;
    for (int o = 0; o < CSG_OCTANTS; o++) {
        const account *child = &children[o];
        const double change[3] = {child->s[0] - a.s[0], child->s[1] - a.s[1], child->s[2] - a.s[2]};
        csg_section flow = flow_of(child, change);
        a.low += child->low + flow.least;
        a.high += child->high + flow.most;
        a.is_unbounded |= child->is_unbounded;
        for (int i = 0; i < FACES; i++)
            *size += fabs(change[i / 2]) * child->faces[i].most;
    }
    return a;
}

/* What is known of it in any case: a convex solid's surface in a cube is no larger than the
 * cube's. */
static double most_of(const csg_section_group *g, double half)
{
    return g->is_convex ? FACES * face_of(half) * g->count : INFINITY;
}

static void add_up_to(account *a, double most)
{
    a->is_unbounded |= !isfinite(most);
    a->high += isfinite(most) ? most : 0;
}

/* A component that is `at`, of a unit vector that turns by an angle of that cosine at most. */
static csg_truth turned_within(double at, double cosine, double least, double most)
{
    static const double ROUNDING = 1e-7;
    double sine = sqrt(fmax(1 - cosine * cosine, 0)), rest = sqrt(fmax(1 - at * at, 0));
    double low = at <= -cosine ? -1 : at * cosine - rest * sine - ROUNDING;
    double high = at >= cosine ? 1 : at * cosine + rest * sine + ROUNDING;
    if (high < least || low > most)
        return CSG_TRUTH_NO;
    return low >= fmax(least, -1) && high <= fmin(most, 1) ? CSG_TRUTH_YES : CSG_TRUTH_OPEN;
}

/* Heights that the group's pieces have in the cube, along the selection's direction. */
static csg_truth is_low(const csg_area_selection *by, const csg_measure_cube *q,
                        const csg_halves *halves, const csg_section_group *g)
{
    const csg_enclosure *e = &halves->planes[g->first];
    double along = 0, rest = 0, height = 0, length = 0;
    for (int k = 0; k < 3; k++) {
        along += by->direction[k] * g->direction[k];
        height += by->direction[k] * q->c[k];
        length += e->slope[k] * g->direction[k];
    }
    for (int k = 0; k < 3; k++) {
        double across = by->direction[k] - along * g->direction[k];
        rest += across * across;
    }
    height -= along * e->value / length;
    double room =
        (fabs(along) * g->width + sqrt(rest) * csg_enclosure_radius(q->half)) * (1 + 1e-9);
    return height + room <= by->level_low   ? CSG_TRUTH_YES
           : height - room > by->level_high ? CSG_TRUTH_NO
                                            : CSG_TRUTH_OPEN;
}

static csg_truth is_selected(const rounds *r, const csg_measure_cube *q, const csg_halves *halves,
                             const csg_section_group *g)
{
    const csg_area_selection *by = r->selection;
    double at = 0;
    if (!by)
        return CSG_TRUTH_YES;
    for (int k = 0; k < 3; k++)
        at -= by->direction[k] * g->direction[k];
    csg_truth turned =
        g->cosine > 0 ? turned_within(at, g->cosine, by->least, by->most) : CSG_TRUTH_OPEN;
    csg_truth low = by->level_low < INFINITY ? is_low(by, q, halves, g) : CSG_TRUTH_YES;
    if (turned == CSG_TRUTH_NO || low == CSG_TRUTH_NO)
        return CSG_TRUTH_NO;
    return turned == CSG_TRUTH_YES && low == CSG_TRUTH_YES ? CSG_TRUTH_YES : CSG_TRUTH_OPEN;
}

/* One group alone can be the surface: it is a graph. */
static void take_graph(const csg_section_group *g, double half, csg_truth selected, account *a)
{
    double most = most_of(g, half), flow = fmax(flow_of(a, g->direction).most, 0);
    double more = g->cosine > 0 ? (1 / g->cosine - 1) * flow : INFINITY;
    if (selected == CSG_TRUTH_NO)
        return;
    if (selected == CSG_TRUTH_YES && flow + more <= most) {
        memcpy(a->s, g->direction, sizeof a->s);
        add_up_to(a, more);
    } else {
        add_up_to(a, fmin(flow + more, most));
    }
}

/* Several may meet. */
static void take_group(const csg_halves *halves, double half, const csg_section_group *g,
                       csg_truth selected, account *a)
{
    if (selected == CSG_TRUTH_NO)
        return;
    csg_section seen = csg_section_of_group(halves, half, g);
    a->low += selected == CSG_TRUTH_YES ? seen.least : 0;
    add_up_to(a, fmin(most_of(g, half), seen.most > 0 ? seen.most / g->cosine : 0));
}

/* turn: how far neighbours' s may be from this one's. */
static account find_account(const rounds *r, const csg_measure_cube *q, const csg_halves *halves,
                            double *turn)
{
    csg_section_group groups[CSG_HALVES_MOST];
    double half = q->half;
    int count = csg_section_find_groups(halves, half, groups);
    account a = {.low = 0};
    *turn = 1;
    for (int i = 0; i < FACES; i++)
        a.faces[i] = csg_section_of_face(halves, half, i / 2, i & 1 ? 1 : -1);
    if (count != 1) {
        for (int i = 0; i < count; i++)
            take_group(halves, half, &groups[i], is_selected(r, q, halves, &groups[i]), &a);
        return a;
    }
    double cosine = groups[0].cosine;
    csg_truth selected = is_selected(r, q, halves, &groups[0]);
    if (selected == CSG_TRUTH_NO)
        *turn = 0;
    else if (selected == CSG_TRUTH_YES)
        *turn = fmin(1, 2 * sqrt(fmax(1 - cosine * cosine, 0)));
    take_graph(&groups[0], half, selected, &a);
    return a;
}

/* What the cube leaves open of the area, about. */
static double open_of(const account *a, double turn)
{
    double strips = 0;
    for (int i = 0; i < FACES; i++)
        strips += a->faces[i].most - a->faces[i].least;
    return a->high - a->low + strips * turn;
}

/* The cube's account if what it leaves open is no more than the share, or is_last. */
static bool settle(const rounds *r, csg_measure_worker *worker, tally *t, csg_measure_cube *q,
                   bool is_last, account *out)
{
    csg_halves halves;
    double turn = 1;
    t->cubes++;
    if (!csg_measure_enclose_with_strays(r->walk, worker, q, &halves))
        *out = unknown(q->half);
    else if (q->state != CSG_CELL_SURFACE)
        *out = plain(q->half, q->state);
    else
        *out = find_account(r, q, &halves, &turn);
    double open = open_of(out, turn);
    bool is_small = open <= r->share && (!out->is_unbounded || q->level >= UNBOUNDED_DEEPEST);
    if (!is_small && !is_last)
        return false;
    t->worst = fmax(t->worst, open);
    return true;
}

/* False: out of memory, or it is time to stop. */
static bool visit(rounds *r, csg_measure_worker *worker, tally *t, const csg_measure_cube *parent,
                  account *out)
{
    csg_measure_cube children[CSG_OCTANTS];
    account accounts[CSG_OCTANTS];
    csg_arena_mark mark = csg_arena_get_mark(&worker->arena);
    bool done = csg_measure_divide(r->walk, worker, parent, &worker->arena, children);
    if (!done)
        atomic_store(&r->out_of_memory, true);
    for (int o = 0; o < CSG_OCTANTS && done; o++) {
        csg_measure_cube *q = &children[o];
        t->is_full |= t->cubes >= r->most_of_one;
        bool is_last = t->is_full || q->level >= CSG_MEASURE_DEEPEST;
        if (q->state != CSG_CELL_SURFACE)
            accounts[o] = plain(q->half, q->state);
        else if (!settle(r, worker, t, q, is_last, &accounts[o]))
            done = visit(r, worker, t, q, &accounts[o]);
        if (t->cubes % ASK_EVERY == 0 && csg_mesh_should_stop(r->walk->watch))
            done = false;
    }
    csg_arena_release_to(&worker->arena, mark);
    if (done)
        *out = combine(accounts, &t->size);
    return done;
}

static bool look_at(void *user, uint32_t worker_index, size_t index)
{
    rounds *r = user;
    const csg_measure_cube *q = &r->walk->cubes[index];
    tally now = {.cubes = 0};
    if (r->tallies[index].worst <= r->share || r->tallies[index].is_full)
        return true;
    if (csg_mesh_should_stop(r->walk->watch) ||
        !visit(r, &r->walk->workers[worker_index], &now, q, &now.account))
        return false;
    now.looked = r->tallies[index].looked + now.cubes;
    r->tallies[index] = now;
    return true;
}

static void report(void *user, size_t done, size_t count)
{
    const rounds *r = user;
    csg_mesh_report_progress(r->walk->watch, (double)done / (double)count);
}

static void begin_tallies(rounds *r)
{
    for (size_t i = 0; i < r->walk->count; i++) {
        const csg_measure_cube *q = &r->walk->cubes[i];
        bool is_surface = q->state == CSG_CELL_SURFACE;
        r->tallies[i] = (tally){.worst = is_surface ? INFINITY : 0};
        r->tallies[i].account = is_surface ? unknown(q->half) : plain(q->half, q->state);
    }
}

/* ---- from the frontier up to the root ----------------------------------------------------------
 */

static int octant_of(const double c[3], const csg_measure_cube *q)
{
    return (q->c[0] > c[0] ? 1 : 0) | (q->c[1] > c[1] ? 2 : 0) | (q->c[2] > c[2] ? 4 : 0);
}

/* The account of the cube that has these of the frontier in it; order: room for as many. */
static account gather(const rounds *r, const double c[3], double half, const uint32_t *cubes,
                      size_t count, uint32_t *order, double *size)
{
    account children[CSG_OCTANTS];
    size_t counts[CSG_OCTANTS + 1] = {0};
    if (!count)
        return plain(half, CSG_CELL_OUTSIDE);
    if (count == 1 && r->walk->cubes[cubes[0]].half >= half)
        return r->tallies[cubes[0]].account;
    for (size_t i = 0; i < count; i++)
        counts[octant_of(c, &r->walk->cubes[cubes[i]]) + 1]++;
    for (int o = 0; o < CSG_OCTANTS; o++)
        counts[o + 1] += counts[o];
    size_t next[CSG_OCTANTS];
    memcpy(next, counts, sizeof next);
    for (size_t i = 0; i < count; i++)
        order[next[octant_of(c, &r->walk->cubes[cubes[i]])]++] = cubes[i];
    for (int o = 0; o < CSG_OCTANTS; o++) {
        const double middle[3] = {c[0] + (o & 1 ? half : -half) / 2,
                                  c[1] + (o & 2 ? half : -half) / 2,
                                  c[2] + (o & 4 ? half : -half) / 2};
        children[o] = gather(r, middle, half / 2, order + counts[o], counts[o + 1] - counts[o],
                             order + r->walk->count, size);
    }
    return combine(children, size);
}

/* With room for all rounding: a sum of n terms is off by at most n units in the last place of the
 * sum of their sizes (Higham 2002, 4.2), and a term has a few of its own. Returns what is open but
 * for what nothing bounds. */
static double conclude(const rounds *r, uint32_t *order, csg_area_bounds *out)
{
    static const double MIDDLE[3] = {0};
    double size = 0;
    uint64_t longest = 0;
    size_t count = r->walk->count;
    for (size_t i = 0; i < count; i++) {
        order[i] = (uint32_t)i;
        size += r->tallies[i].size;
        longest = r->tallies[i].cubes > longest ? r->tallies[i].cubes : longest;
    }
    account root = gather(r, MIDDLE, r->walk->half, order, count, order + count, &size);
    csg_section flow = flow_of(&root, root.s);
    double low = root.low + flow.least, high = root.high + flow.most;
    double terms = 64 * ((double)longest + (double)count + 16);
    double slack = terms * 0x1p-52 * (size + fabs(low) + fabs(high));
    out->low = fmax(low - slack, out->low);
    out->high = fmin(root.is_unbounded ? INFINITY : high + slack, out->high);
    out->is_proven = true;
    return high + 2 * slack - low;
}

static void count_cubes(const rounds *r, uint64_t *latest, uint64_t *looked)
{
    *latest = r->walk->count;
    *looked = 0;
    for (size_t i = 0; i < r->walk->count; i++) {
        *latest += r->tallies[i].cubes;
        *looked += r->tallies[i].looked;
    }
}

static csgm_status go_on(rounds *r, double tolerance, double of, uint64_t most_cubes,
                         uint32_t *order, csg_area_bounds *out)
{
    static const double NO_LESS = 0.95; /* of what was open before: rounding is what is left */
    csgm_status status = CSGM_OK;
    double before = INFINITY;
    for (bool more = true; more && status == CSGM_OK;) {
        uint64_t latest, looked = out->cubes;
        r->most_of_one = 64 + (most_cubes - out->cubes) / 16;
        csg_mesh_take(r->walk->watch, CSGM_STAGE_MEASURE, 0.3);
        if (!csg_pool_run(r->walk->context->pool, r->walk->count, look_at, report, r))
            status = atomic_load(&r->out_of_memory) ? csg_context_no_memory(r->walk->context)
                                                    : csg_mesh_why_stopped(r->walk->watch);
        double open = conclude(r, order, out), wanted;
        wanted = tolerance * (of > 0 ? of : out->low + open);
        count_cubes(r, &latest, &out->cubes);
        bool was_in_vain = out->cubes > looked && !(open < NO_LESS * before);
        more = open > wanted && !was_in_vain && out->cubes < most_cubes &&
               csg_measure_next_share(&r->share, wanted / open, (double)latest,
                                      most_cubes - out->cubes);
        before = open;
    }
    return status;
}

csgm_status csg_measure_area(csg_measure_walk *walk, const csg_area_selection *selection,
                             double tolerance, double of, uint64_t most_cubes, csg_area_bounds *out)
{
    enum { LEVELS = 8 /* from the root to the frontier, and one */ };
    csg_memory *memory = &walk->context->memory;
    size_t bytes = (walk->count + 1) * sizeof(tally);
    size_t order_bytes = LEVELS * (walk->count + 1) * sizeof(uint32_t);
    rounds r = {
        .walk = walk, .selection = selection, .share = FACES * face_of(walk->half) * 0x1p-12};
    csgm_status status;
    *out = (csg_area_bounds){.high = INFINITY};
    r.tallies = csg_memory_alloc(memory, bytes);
    uint32_t *order = csg_memory_alloc(memory, order_bytes);
    if (r.tallies && order) {
        begin_tallies(&r);
        status = go_on(&r, tolerance, of, most_cubes, order, out);
    } else {
        status = csg_context_no_memory(walk->context);
    }
    csg_memory_release(memory, order, order_bytes);
    csg_memory_release(memory, r.tallies, bytes);
    return status;
}
