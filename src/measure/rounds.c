/* SPDX-License-Identifier: MIT
 * Rounds; see rounds.h.
 */
#include "measure/rounds.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/elementary.h"
#include "base/pool.h"
#include "measure/ledger.h"

enum {
    ASK_EVERY = 256,    /* cubes, whether to stop */
    SIZES = 96,         /* of what cubes leave open, each a root of two below the one before */
    LEVELS = 8,         /* from the root to the frontier, and one */
    LEDGERS_MOST = 128, /* MB of ledgers between two rounds */
    LEDGERS_SHARE = 8   /* and what part of all memory, where that has a limit */
};

/* Of one cube of the frontier. */
typedef struct tally {
    double worst;            /* the most that one cube leaves open */
    uint64_t cubes;          /* in it */
    uint64_t latest, looked; /* at how many of them the latest round has looked; all rounds */
    bool is_full;            /* it had its share of cubes: it stays as it is */
    uint32_t images;         /* cubes that are like it, itself included */
    double opens[SIZES];     /* what cubes of each size leave open, that of the first share first */
} tally;

/* A cube of the frontier is that of another one. */
typedef struct image {
    uint32_t index, of;
    const csg_symmetry *by;
} image;

typedef struct rounds {
    const csg_rounds_job *job;
    csg_measure_walk *walk;
    tally *tallies; /* one a cube of the frontier, as the accounts */
    char *accounts;
    csg_ledger *ledgers; /* one a cube of the frontier, then one a worker, for what it walks */
    uint32_t *order;     /* of the frontier's cubes, octant by octant, level by level */
    image *images;
    size_t image_count;
    double share;
    uint64_t most_of_one;
    atomic_bool out_of_memory;
} rounds;

static char *account_of(const rounds *r, char *accounts, size_t i)
{
    return accounts + i * r->job->account_bytes;
}

/* A walk of one cube of the frontier. */
typedef struct stroll {
    rounds *r;
    csg_measure_worker *worker;
    tally *t;
    csg_ledger *ledger; /* of this round */
} stroll;

/* At most the first share times the root of two to the power of -size. */
static int size_of(const rounds *r, double open)
{
    static const double ROOT = 0.70710678118654752;
    int exponent;
    double part = frexp(open / r->job->share, &exponent);
    int size = (part < ROOT ? 1 : 0) - 2 * exponent;
    return !(open > 0) || size >= SIZES ? SIZES - 1 : size < 0 ? 0 : size;
}

/* Of one that stays as it is. */
static void count_open(const rounds *r, tally *t, double open)
{
    t->worst = fmax(t->worst, open);
    if (isfinite(open))
        t->opens[size_of(r, open)] += open;
}

/* What a cube comes to that the round before has left as it is. True: it is enough. */
static bool take_known(stroll *s, const csg_measure_cube *q, double open, const void *known,
                       void *account)
{
    const rounds *r = s->r;
    if (open > r->share && !s->t->is_full && q->level < CSG_MEASURE_DEEPEST)
        return false;
    count_open(r, s->t, open);
    memcpy(account, known, r->job->account_bytes);
    csg_ledger_add_leaf(s->ledger, &r->walk->context->memory, open, known, r->job->account_bytes);
    return true;
}

/* What it comes to. True: it is enough. */
static bool settle(stroll *s, csg_measure_cube *q, void *account)
{
    rounds *r = s->r;
    tally *t = s->t;
    t->is_full |= t->latest >= r->most_of_one;
    t->latest++;
    bool is_last = t->is_full || q->level >= CSG_MEASURE_DEEPEST;
    s->worker->enough = is_last ? 0 : r->share;
    double open = r->job->settle(r->job->user, r->walk, s->worker, q, account);
    if (open > r->share && !is_last)
        return false;
    count_open(r, t, open);
    csg_ledger_add_leaf(s->ledger, &r->walk->context->memory, open, account, r->job->account_bytes);
    return true;
}

/* known: what the round before has found in the parent. False: out of memory, or it is time to
 * stop. */
static bool visit(stroll *s, const csg_measure_cube *parent, csg_ledger_reader *known, void *out)
{
    rounds *r = s->r;
    const csg_rounds_job *job = r->job;
    csg_arena *arena = &s->worker->arena;
    csg_measure_cube children[CSG_OCTANTS];
    csg_arena_mark mark = csg_arena_get_mark(arena);
    char *octants = csg_arena_alloc(arena, CSG_OCTANTS * job->account_bytes);
    bool done = octants && csg_measure_divide(r->walk, s->worker, parent, arena, children);
    if (!done)
        atomic_store(&r->out_of_memory, true);
    for (int o = 0; o < CSG_OCTANTS && done; o++) {
        csg_ledger_reader nothing = {.of = NULL}, *of_child = &nothing;
        csg_measure_cube *q = &children[o];
        const void *before = NULL;
        char *account = account_of(r, octants, (size_t)o);
        bool is_enough = true;
        if (q->state != CSG_CELL_SURFACE) {
            job->settle_plain(job->user, q, account);
            continue;
        }
        if (++s->t->cubes % ASK_EVERY == 0 && csg_mesh_should_stop(r->walk->watch))
            done = false;
        double open = known->of ? csg_ledger_read(known, job->account_bytes, &before) : -1;
        if (before)
            is_enough = take_known(s, q, open, before, account);
        else if (!known->of)
            is_enough = settle(s, q, account);
        else
            is_enough = false;
        if (is_enough)
            continue;
        if (known->of && !before)
            of_child = known;
        csg_ledger_add_divided(s->ledger, &r->walk->context->memory);
        done = done && visit(s, q, of_child, account);
    }
    if (done)
        job->combine(job->user, octants, out);
    csg_arena_release_to(arena, mark);
    return done;
}

static bool look_at(void *user, uint32_t worker_index, size_t index)
{
    rounds *r = user;
    csg_measure_worker *worker = &r->walk->workers[worker_index];
    csg_memory *memory = &r->walk->context->memory;
    tally *kept = &r->tallies[index], now = {.worst = 0};
    if (kept->worst <= r->share || kept->is_full)
        return true;
    csg_ledger *ledger = &r->ledgers[index], *next = &r->ledgers[r->walk->count + worker_index];
    stroll s = {.r = r, .worker = worker, .t = &now, .ledger = next};
    csg_ledger_reader known = {.of = ledger->is_lost ? NULL : ledger};
    csg_arena_mark mark = csg_arena_get_mark(&worker->arena);
    csg_ledger_begin(next);
    void *account = csg_arena_alloc(&worker->arena, r->job->account_bytes);
    bool done = account && !csg_mesh_should_stop(r->walk->watch) &&
                visit(&s, &r->walk->cubes[index], &known, account);
    if (!account)
        atomic_store(&r->out_of_memory, true);
    if (done) {
        now.looked = kept->looked + now.latest;
        now.images = kept->images;
        *kept = now;
        memcpy(account_of(r, r->accounts, index), account, r->job->account_bytes);
        csg_ledger_release(ledger, memory, r->job->account_bytes);
        *ledger = csg_ledger_copy(next, memory, r->job->account_bytes);
    }
    csg_arena_release_to(&worker->arena, mark);
    return done;
}

/* Those of the last cubes of the frontier go if all are too large. */
static void bound_ledgers(rounds *r)
{
    const csg_memory *memory = &r->walk->context->memory;
    uint64_t most = (uint64_t)LEDGERS_MOST << 20, bytes = 0;
    if (memory->limit_bytes && memory->limit_bytes / LEDGERS_SHARE < most)
        most = memory->limit_bytes / LEDGERS_SHARE;
    for (size_t i = 0; i < r->walk->count; i++) {
        bytes += csg_ledger_bytes(&r->ledgers[i], r->job->account_bytes);
        if (bytes > most)
            csg_ledger_release(&r->ledgers[i], &r->walk->context->memory, r->job->account_bytes);
    }
}

static void report(void *user, size_t done, size_t count)
{
    const rounds *r = user;
    csg_mesh_report_progress(r->walk->watch, (double)done / (double)count);
}

static void begin_tallies(rounds *r)
{
    const csg_rounds_job *job = r->job;
    for (size_t i = 0; i < r->walk->count + r->walk->worker_count; i++)
        r->ledgers[i] = (csg_ledger){.is_lost = true};
    for (size_t i = 0; i < r->walk->count; i++) {
        const csg_measure_cube *q = &r->walk->cubes[i];
        bool is_surface = q->state == CSG_CELL_SURFACE;
        r->tallies[i] = (tally){.worst = is_surface ? INFINITY : 0, .images = 1};
        (is_surface ? job->leave_open : job->settle_plain)(job->user, q,
                                                           account_of(r, r->accounts, i));
    }
}

/* ---- cubes that are like each other ------------------------------------------------------------
 */

static int compare_places(const void *a, const void *b)
{
    const csg_measure_cube *p = *(const csg_measure_cube *const *)a,
                           *q = *(const csg_measure_cube *const *)b;
    for (int k = 0; k < 3; k++)
        if (p->c[k] != q->c[k])
            return p->c[k] < q->c[k] ? -1 : 1;
    return 0;
}

/* The frontier's cube at this place; NULL: there is none with a surface that is as large. */
static const csg_measure_cube *find_at(const rounds *r, const csg_measure_cube *const *sorted,
                                       const csg_measure_cube *at)
{
    const csg_measure_cube *const *found =
        bsearch(&at, sorted, r->walk->count, sizeof *sorted, compare_places);
    return found && (*found)->half == at->half && (*found)->state == CSG_CELL_SURFACE ? *found
                                                                                      : NULL;
}

/* Of each cube that is not one itself, in their order. is_image: all false before. */
static void find_images_of(rounds *r, const csg_measure_cube *const *sorted, size_t of,
                           bool *is_image)
{
    const csg_symmetries *all = &r->walk->symmetries;
    csg_measure_cube at = r->walk->cubes[of];
    for (int n = 0; n < all->count && !is_image[of] && at.state == CSG_CELL_SURFACE; n++) {
        const csg_symmetry *by = &all->of[n];
        if (r->job->is_kept && !r->job->is_kept(r->job->user, by))
            continue;
        csg_symmetry_map(by, r->walk->cubes[of].c, at.c);
        const csg_measure_cube *found = find_at(r, sorted, &at);
        size_t index = found ? (size_t)(found - r->walk->cubes) : 0;
        if (index <= of || is_image[index])
            continue;
        is_image[index] = true;
        r->images[r->image_count++] = (image){(uint32_t)index, (uint32_t)of, by};
        r->tallies[index].worst = 0;
        r->tallies[of].images++;
    }
}

/* False: out of memory. */
static bool find_images(rounds *r)
{
    size_t count = r->walk->count;
    csg_arena *arena = &r->walk->workers[0].arena;
    if (!count || !r->walk->symmetries.count)
        return true;
    csg_arena_mark mark = csg_arena_get_mark(arena);
    const csg_measure_cube **sorted = csg_arena_alloc(arena, count * sizeof *sorted);
    bool *is_image = csg_arena_calloc(arena, count, sizeof *is_image);
    for (size_t i = 0; sorted && is_image && i < count; i++)
        sorted[i] = &r->walk->cubes[i];
    if (sorted && is_image)
        qsort(sorted, count, sizeof *sorted, compare_places);
    for (size_t i = 0; sorted && is_image && i < count; i++)
        find_images_of(r, sorted, i, is_image);
    csg_arena_release_to(arena, mark);
    return sorted && is_image;
}

static void turn_images(rounds *r)
{
    for (size_t i = 0; i < r->image_count; i++)
        r->job->turn(r->images[i].by, account_of(r, r->accounts, r->images[i].of),
                     account_of(r, r->accounts, r->images[i].index));
}

/* ---- from the frontier up to the root ----------------------------------------------------------
 */

static int octant_of(const double c[3], const csg_measure_cube *q)
{
    return (q->c[0] > c[0] ? 1 : 0) | (q->c[1] > c[1] ? 2 : 0) | (q->c[2] > c[2] ? 4 : 0);
}

/* The account of the cube that has these of the frontier in it; order: room for as many on each
 * level. False: out of memory. */
static bool gather(rounds *r, const csg_measure_cube *cube, const uint32_t *cubes, size_t count,
                   uint32_t *order, void *out)
{
    csg_arena *arena = &r->walk->workers[0].arena;
    size_t counts[CSG_OCTANTS + 1] = {0}, next[CSG_OCTANTS];
    if (!count) {
        r->job->settle_plain(r->job->user, cube, out);
        return true;
    }
    if (count == 1 && r->walk->cubes[cubes[0]].half >= cube->half) {
        memcpy(out, account_of(r, r->accounts, cubes[0]), r->job->account_bytes);
        return true;
    }
    for (size_t i = 0; i < count; i++)
        counts[octant_of(cube->c, &r->walk->cubes[cubes[i]]) + 1]++;
    for (int o = 0; o < CSG_OCTANTS; o++)
        counts[o + 1] += counts[o];
    memcpy(next, counts, sizeof next);
    for (size_t i = 0; i < count; i++)
        order[next[octant_of(cube->c, &r->walk->cubes[cubes[i]])]++] = cubes[i];
    csg_arena_mark mark = csg_arena_get_mark(arena);
    char *octants = csg_arena_alloc(arena, CSG_OCTANTS * r->job->account_bytes);
    bool done = octants != NULL;
    for (int o = 0; o < CSG_OCTANTS && done; o++) {
        csg_measure_cube child = {.half = cube->half / 2, .state = CSG_CELL_OUTSIDE};
        for (int k = 0; k < 3; k++)
            child.c[k] = cube->c[k] + (o >> k & 1 ? child.half : -child.half);
        done = gather(r, &child, order + counts[o], counts[o + 1] - counts[o],
                      order + r->walk->count, account_of(r, octants, (size_t)o));
    }
    if (done)
        r->job->combine(r->job->user, octants, out);
    csg_arena_release_to(arena, mark);
    return done;
}

static csg_rounds_counts count_cubes(const rounds *r, uint64_t *latest)
{
    csg_rounds_counts counts = {0};
    *latest = r->walk->count;
    for (size_t i = 0; i < r->walk->count; i++) {
        const tally *t = &r->tallies[i];
        *latest += t->cubes;
        counts.cubes += t->looked;
        counts.longest = t->cubes > counts.longest ? t->cubes : counts.longest;
    }
    counts.longest += r->walk->count;
    return counts;
}

/* The ratio of what is wanted to what is open. Less than 0: out of memory. */
static double conclude(rounds *r, const csg_rounds_counts *counts)
{
    csg_measure_cube root = csg_measure_root(r->walk);
    csg_arena *arena = &r->walk->workers[0].arena;
    csg_arena_mark mark = csg_arena_get_mark(arena);
    void *account = csg_arena_alloc(arena, r->job->account_bytes);
    double ratio = -1;
    for (size_t i = 0; i < r->walk->count; i++)
        r->order[i] = (uint32_t)i;
    root.state = CSG_CELL_OUTSIDE; /* if there is no frontier */
    turn_images(r);
    if (account && gather(r, &root, r->order, r->walk->count, r->order + r->walk->count, account))
        ratio = r->job->conclude(r->job->user, account, counts);
    csg_arena_release_to(arena, mark);
    return ratio;
}

/* ---- how they go on ----------------------------------------------------------------------------
 */

/* What the latest rounds have shown: what is left open falls with the share's power `falls`,
 * between that of planes where the surface is smooth, 1/2, and that of better models, 3/5, or
 * slower where less is known of it; at first it is taken for the least of these that is usual. */
typedef struct course {
    double share, open, falls; /* of the round before; open: 0, there is none */
    /* What of the cubes that are divided is left, and by which share of all that was open this
     * round was to have no more than that of it; 0: it was not chosen so. */
    double left, divided;
} course;

static void take_course(course *c, double share, double open)
{
    static const double LEAST = 0.4, MOST = 0.75, LEAST_LEFT = 0.02, MOST_LEFT = 0.75;
    if (c->open > 0 && share < c->share && open < c->open)
        c->falls = fmin(fmax(csg_log(open / c->open) / csg_log(share / c->share), LEAST), MOST);
    if (c->divided > 0)
        c->left = fmin(fmax(1 - (1 - open / c->open) / c->divided, LEAST_LEFT), MOST_LEFT);
    c->share = share;
    c->open = open;
    c->divided = 0;
}

/* Where a little less is wanted, no more cubes need to be divided than those that leave most open:
 * the largest share by which as much as is too much goes. 0: it is far less than this one. */
static double find_share(const rounds *r, course *c, double wanted)
{
    static const double FAR = 0x1p-3, ROOT = 0.70710678118654752;
    double opens[SIZES] = {0}, all = 0, divided = 0, share = r->job->share;
    for (size_t i = 0; i < r->walk->count; i++)
        for (int n = 0; n < SIZES; n++)
            opens[n] += r->tallies[i].images * r->tallies[i].opens[n];
    for (int n = 0; n < SIZES; n++)
        all += opens[n];
    for (int n = 0; n < SIZES && share > FAR * r->share; n++, share *= ROOT) {
        if (share < r->share && (1 - c->left) * divided >= (1 - wanted) * all) {
            c->divided = divided / all;
            return share;
        }
        divided += opens[n];
    }
    return 0;
}

/* The next share. Cubes become more by its power of 2/3 at most, and those that there are already
 * are known. False: so many are not to be had. */
static bool choose_share(rounds *r, course *c, double ratio, uint64_t latest, uint64_t left)
{
    static const double LEAST_STEP = 0.5, LARGEST_STEP = 0x1p-6, MARGIN = 1.4, CLOSE = 0.95;
    double step = fmax(fmin(csg_pow(MARGIN * ratio, 1 / c->falls), LEAST_STEP), LARGEST_STEP);
    double more = 1 + (double)left / (double)latest, affordable = more * sqrt(more);
    if (!(affordable > 1 / LEAST_STEP))
        return false;
    double share = find_share(r, c, CLOSE * ratio);
    r->share = fmax(share > 0 ? share : step * r->share, r->share / affordable);
    return true;
}

static csgm_status go_on(rounds *r, uint64_t most_cubes)
{
    static const double BETTER = 1.05; /* than the best round so far */
    enum {
        VAIN = 2, /* rounds that are not: rounding is what is left */
        IDLE = 32 /* rounds that look at no cube, as all are full or as small as can be */
    };
    csgm_status status = CSGM_OK;
    csg_rounds_counts counts = {0};
    course so_far = {.falls = 0.5, .left = 0.05};
    double best = 0;
    int vain = 0, idle = 0;
    for (bool more = true; more && status == CSGM_OK;) {
        uint64_t latest, looked = counts.cubes;
        r->most_of_one = 64 + (most_cubes - counts.cubes) / 16;
        csg_mesh_take(r->walk->watch, CSGM_STAGE_MEASURE, 0.3);
        bool done = csg_pool_run(r->walk->context->pool, r->walk->count, look_at, report, r);
        counts = count_cubes(r, &latest);
        bound_ledgers(r);
        double ratio = conclude(r, &counts);
        if (atomic_load(&r->out_of_memory) || ratio < 0)
            status = csg_context_no_memory(r->walk->context);
        else if (!done)
            status = csg_mesh_why_stopped(r->walk->watch);
        idle = counts.cubes > looked ? 0 : idle + 1;
        if (ratio > BETTER * best) {
            best = ratio;
            vain = 0;
        } else if (counts.cubes > looked) {
            vain++;
        }
        take_course(&so_far, r->share, 1 / ratio);
        more = ratio < 1 && vain < VAIN && idle < IDLE && counts.cubes < most_cubes &&
               choose_share(r, &so_far, ratio, latest, most_cubes - counts.cubes);
    }
    return status;
}

csgm_status csg_measure_rounds(csg_measure_walk *walk, const csg_rounds_job *job,
                               uint64_t most_cubes)
{
    csg_memory *memory = &walk->context->memory;
    size_t count = walk->count + 1, bytes = count * sizeof(tally),
           account_bytes = count * job->account_bytes,
           order_bytes = LEVELS * count * sizeof(uint32_t),
           ledger_count = walk->count + walk->worker_count,
           ledger_bytes = ledger_count * sizeof(csg_ledger), image_bytes = count * sizeof(image);
    rounds r = {.job = job, .walk = walk, .share = job->share};
    if (walk->symmetries.count) /* images are alike by what floats tell, and leave room for */
        walk->exact.parameters = NULL;
    csgm_status status;
    r.tallies = csg_memory_alloc(memory, bytes);
    r.accounts = csg_memory_alloc(memory, account_bytes);
    r.order = csg_memory_alloc(memory, order_bytes);
    r.ledgers = csg_memory_alloc(memory, ledger_bytes);
    r.images = csg_memory_alloc(memory, image_bytes);
    if (r.tallies && r.accounts && r.order && r.ledgers && r.images) {
        begin_tallies(&r);
        status = find_images(&r) ? go_on(&r, most_cubes) : csg_context_no_memory(walk->context);
        for (size_t i = 0; i < ledger_count; i++)
            csg_ledger_release(&r.ledgers[i], memory, job->account_bytes);
    } else {
        status = csg_context_no_memory(walk->context);
    }
    csg_memory_release(memory, r.images, image_bytes);
    csg_memory_release(memory, r.ledgers, ledger_bytes);
    csg_memory_release(memory, r.order, order_bytes);
    csg_memory_release(memory, r.accounts, account_bytes);
    csg_memory_release(memory, r.tallies, bytes);
    return status;
}
