/* SPDX-License-Identifier: MIT
 * The proof; see check.h. Pieces of a few cells' size are made on one thread and settled
 * on all, eight at a time, since tapes are pruned to eight cubes at a time.
 */
#include "mesh/distance/check.h"

#include <math.h>
#include <string.h>

#include "base/rank_loop.h"
#include "field/point.h"
#include "grid/octree/octree.h"
#include "mesh/distance/effort.h"
#include "mesh/distance/minorant.h"
#include "mesh/distance/slopes.h"
#include "mesh/distance/steps.h"

enum { PIECES = 1 << 11, GROUPS = PIECES / CSG_OCTANTS, STACK = 64 };

/* Looked at before the proof is given up: all in all, by their effort, and of one piece that was
 * cut. */
static const uint64_t MOST_EFFORT = 6000000, MOST_OF_ONE = 2000;

typedef struct piece {
    csg_vec3 at[3], normal;
    uint32_t triangle;
    bool open;
} piece;

typedef struct settler {
    csg_pruner pruner;
    csg_arena arena;
    csg_tape tape; /* of the piece at hand */
    float *scratch;
    uint64_t pieces, effort;
    uint64_t most; /* pieces, with those of the one at hand */
} settler;

/* What eight pieces took, with their parts. */
typedef struct group_work {
    uint64_t pieces, effort;
} group_work;

typedef struct proof {
    const csg_remesh *remesh;
    double error;
    double farthest; /* of the error: a piece with a place as far from the surface is given up */
    settler *settlers;
    size_t settler_count;
    size_t scratch_floats;
    piece *pieces;
    size_t count;
    group_work groups[GROUPS]; /* of these pieces */
    group_work looked_at;      /* before these pieces */
    double settled, at;        /* triangles whose pieces are proven, and that of the latest piece */
    atomic_bool out_of_memory;
} proof;

/* ---- one piece --------------------------------------------------------------------------------
 */

typedef struct disc {
    csg_vec3 center;
    double radius;
} disc;

static disc disc_of(const csg_vec3 v[3])
{
    csg_vec3 c = csg_vec3_scale(csg_vec3_add(v[0], csg_vec3_add(v[1], v[2])), 1.0 / 3);
    double r = 0;
    for (int k = 0; k < 3; k++)
        r = fmax(r, csg_vec3_norm(csg_vec3_sub(v[k], c)));
    return (disc){c, r};
}

static double value_at(const proof *p, settler *s, csg_vec3 at)
{
    return csg_tape_value_at(p->remesh->probe.marching->kernel, &s->tape, at, s->scratch,
                             p->scratch_floats);
}

/* Rounding of places and values is kept clear of, twice over. */
static double slack_of(const proof *p)
{
    return 4 * (double)p->remesh->probe.noise;
}

/* Thin walls, sharp tips: a change of sign in any direction will do. */
static bool settles_nearby(const proof *p, settler *s, disc d, csg_vec3 normal, csg_vec3 side)
{
    enum { RINGS = 4, WAYS = 26, ROOM = WAYS + CSG_LANES };
    csg_vec3 other = csg_vec3_cross(normal, side);
    float at[3][ROOM], f[ROOM];
    bool inside = false, outside = false;
    double reach = p->error - d.radius;
    for (int ring = 0; ring < RINGS && !(inside && outside); ring++, reach /= 4) {
        for (int i = 0; i < WAYS; i++) {
            /* around in the plane, and leaning to both sides: the plane may be the surface itself
             */
            static const double around[8][2] = {{0.9, 0},   {0, 0.9},    {-0.9, 0},   {0, -0.9},
                                                {0.6, 0.6}, {-0.6, 0.6}, {0.6, -0.6}, {-0.6, -0.6}};
            double up = i >= 24 ? 49 - 2.0 * i : 0.4 * (i % 3 - 1);
            double x = i >= 24 ? 0 : around[i / 3][0], y = i >= 24 ? 0 : around[i / 3][1];
            csg_vec3 off =
                csg_vec3_add(csg_vec3_scale(normal, up),
                             csg_vec3_add(csg_vec3_scale(side, x), csg_vec3_scale(other, y)));
            csg_vec3 q = csg_vec3_add(d.center, csg_vec3_scale(off, reach));
            at[0][i] = (float)q.x, at[1][i] = (float)q.y, at[2][i] = (float)q.z;
        }
        for (int i = WAYS; i % CSG_LANES; i++)
            for (int axis = 0; axis < 3; axis++)
                at[axis][i] = at[axis][0];
        p->remesh->probe.marching->kernel->values(&s->tape, at[0], at[1], at[2], WAYS, f,
                                                  s->scratch, p->scratch_floats);
        for (int i = 0; i < WAYS; i++) {
            inside |= (double)f[i] > slack_of(p);
            outside |= (double)f[i] < -slack_of(p);
        }
    }
    return inside && outside;
}

/* FAR: no surface is as near as it should be, whatever the piece is cut into. */
typedef enum verdict { OPEN, SETTLED, FAR } verdict;

/* Of a piece. */
typedef struct answer {
    verdict what;
    double excess; /* where it is open: by what factor gradients stray too much, or the square of
                      that by which it is too large */
} answer;

/* What is looked at of it. */
typedef struct look {
    disc d;
    csg_gradients gradients;
    bool is_known; /* they are */
} look;

/* Gradients that stray so much more than a value can be need not be asked about: no gradient is
 * longer than `longest`, and no place farther from zero than that on both sides. */
static bool may_settle_by_steps(const proof *p, const csg_steps *steps, double longest)
{
    return csg_steps_off(steps, CSG_STEPS_MOST_CUTS) < longest * p->error;
}

/* Whether all of it is inside a step along the axis that its gradients have in common, or else
 * along its normal, and outside a step back. *steps, if that is to be asked of values. */
static verdict settle_by_cone(const proof *p, const settler *s, const piece *one, const look *l,
                              csg_steps *steps, bool *asks)
{
    csg_cone cone = {.least = 0};
    const csg_gradients *g = &l->gradients;
    *asks = false;
    if (!l->is_known)
        return OPEN;
    bool has_axis = csg_gradients_find_axis(g, &cone);
    double least = cone.least * p->error - slack_of(p);
    if (has_axis && g->low >= -least && g->high <= least)
        return SETTLED;
    double r = l->d.radius, longest = fmin(g->longest, (double)s->tape.lipschitz);
    csg_vec3 axis = {cone.axis[0], cone.axis[1], cone.axis[2]};
    *steps = (csg_steps){
        .at = {one->at[0], one->at[1], one->at[2]},
        .step = csg_vec3_scale(has_axis ? axis : one->normal, has_axis ? p->error : -p->error),
        .stray = g->across * r,
        .kink = g->kink,
        .sag = g->sag};
    *asks = may_settle_by_steps(p, steps, longest);
    return OPEN;
}

/* Its square is the number of parts that settles_nearby() may tell, whatever the gradients are. */
static double times_too_large(const proof *p, disc d)
{
    static const double SMALL = 0.6; /* of the error */
    return d.radius / (SMALL * p->error);
}

/* Of what its gradients did not settle. */
static verdict settle_otherwise(const proof *p, settler *s, const csg_touching *field,
                                const piece *one, const look *l)
{
    static const double STEPS_REACH = 6; /* of the error */
    static const double NEARBY = 0.8;    /* of what is left beside the piece */
    double steepest = (double)s->tape.lipschitz;
    if (l->is_known && l->gradients.longest < steepest)
        steepest = l->gradients.longest;
    double value = l->is_known ? l->gradients.value : value_at(p, s, l->d.center);
    if (fabs(value) > p->farthest * steepest * p->error + slack_of(p))
        return FAR;
    if (l->d.radius > STEPS_REACH * p->error)
        return OPEN;
    /* any gradient is as near to zero as that */
    csg_steps inward = {.at = {one->at[0], one->at[1], one->at[2]},
                        .step = csg_vec3_scale(one->normal, -p->error),
                        .stray = steepest * l->d.radius,
                        .kink = INFINITY,
                        .fails = true};
    if ((!l->is_known || l->gradients.stray > 0.5 * steepest) &&
        may_settle_by_steps(p, &inward, steepest))
        csg_steps_settle(p->remesh->probe.marching->kernel, field, slack_of(p), s->scratch,
                         p->scratch_floats, &inward, 1);
    if (!inward.fails)
        return SETTLED;
    csg_vec3 side = csg_vec3_normalize(csg_vec3_sub(one->at[1], one->at[0]));
    bool may_be_nearby = fabs(value) < NEARBY * steepest * (p->error - l->d.radius);
    return may_be_nearby && settles_nearby(p, s, l->d, one->normal, side) ? SETTLED : OPEN;
}

/* In a ball that holds all of the regions. */
static csg_touching find_touching(const proof *p, const settler *s,
                                  const csg_gradients_region *near, size_t count)
{
    double radius = 0;
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++) {
            double off = csg_vec3_norm(csg_vec3_sub(near[i].triangle[k], near[0].c));
            radius = fmax(radius, off + near[i].around);
        }
    return csg_touching_find(p->remesh->probe.marching->kernel, &s->tape, near[0].c, radius);
}

/* Leaves without faces turn slowly: what their gradients tell is as much, and costs less. */
static bool has_faces(const csg_tape *tape)
{
    for (uint32_t i = 0; i < tape->count; i++)
        if (csg_op_has_faces(tape->nodes[i].op))
            return true;
    return false;
}

/* Whether all of a piece is inside a step against its normal (turn 1), or outside a step along it
 * (turn -1), of those of which it is asked. */
static void keep_by_minorants(const proof *p, const csg_touching *field, const piece *const *pieces,
                              double turn, bool *is_settled, size_t count)
{
    csg_sided_triangle moved[CSG_OCTANTS] = {0};
    double least[CSG_OCTANTS];
    size_t which[CSG_OCTANTS], asked = 0;
    for (size_t i = 0; i < count; i++) {
        if (!is_settled[i])
            continue;
        csg_vec3 step = csg_vec3_scale(pieces[i]->normal, -turn * p->error);
        for (int k = 0; k < 3; k++)
            moved[asked].at[k] = csg_vec3_add(pieces[i]->at[k], step);
        moved[asked].turn = turn;
        which[asked++] = i;
    }
    csg_minorants_find(p->remesh->probe.marching->kernel, field, moved, asked, least);
    for (size_t i = 0; i < asked; i++)
        is_settled[which[i]] = least[i] > slack_of(p);
}

/* Up to eight pieces for which the settler's tape holds. */
static void settle(const proof *p, settler *s, const piece *const *pieces, answer *const *answers,
                   size_t count)
{
    const csg_kernel *kernel = p->remesh->probe.marching->kernel;
    look looks[CSG_OCTANTS]; /* not filled: gradients are large */
    csg_gradients_region near[CSG_OCTANTS] = {0};
    csg_gradients *found[CSG_OCTANTS] = {NULL};
    bool is_known[CSG_OCTANTS], is_settled[CSG_OCTANTS];
    csg_steps steps[CSG_OCTANTS];
    answer *asking[CSG_OCTANTS];
    size_t asked = 0;
    const bool faces = has_faces(&s->tape);
    for (size_t i = 0; i < count; i++) {
        const csg_vec3 *at = pieces[i]->at;
        looks[i].d = disc_of(at);
        is_settled[i] = faces; /* as far as is known */
        near[i] = (csg_gradients_region){{at[0], at[1], at[2]}, looks[i].d.center, p->error, 0};
    }
    const csg_touching field = find_touching(p, s, near, count);
    keep_by_minorants(p, &field, pieces, 1, is_settled, count);
    keep_by_minorants(p, &field, pieces, -1, is_settled, count);
    s->pieces += count;
    s->effort += count * csg_effort_of(&s->tape);
    size_t left = 0, which[CSG_OCTANTS];
    for (size_t i = 0; i < count; i++) {
        if (is_settled[i]) {
            answers[i]->what = SETTLED;
            continue;
        }
        near[left] = near[i];
        looks[left].d = looks[i].d;
        found[left] = &looks[left].gradients;
        which[left++] = i;
    }
    csg_gradients_find_each(kernel, &field, near, left, s->scratch, p->scratch_floats, found,
                            is_known);
    for (size_t i = 0; i < left; i++) {
        answer *a = answers[which[i]];
        bool asks;
        looks[i].is_known = is_known[i];
        a->excess = INFINITY;
        a->what = settle_by_cone(p, s, pieces[which[i]], &looks[i], &steps[asked], &asks);
        if (asks)
            asking[asked++] = a;
    }
    if (asked)
        csg_steps_settle(kernel, &field, slack_of(p), s->scratch, p->scratch_floats, steps, asked);
    for (size_t i = 0; i < asked; i++) {
        asking[i]->what = steps[i].fails ? OPEN : SETTLED;
        asking[i]->excess = steps[i].excess;
    }
    for (size_t i = 0; i < left; i++) {
        answer *a = answers[which[i]];
        if (a->what == OPEN)
            a->what = settle_otherwise(p, s, &field, pieces[which[i]], &looks[i]);
        double times = times_too_large(p, looks[i].d);
        a->excess = fmin(a->excess, times * times);
    }
}

/* The two halves by the middle of the longest side; false: small enough to give up. */
static bool bisect(const csg_vec3 v[3], double least, csg_vec3 (*halves)[3])
{
    int longest = 0;
    double most = 0;
    for (int k = 0; k < 3; k++) {
        double length = csg_vec3_norm(csg_vec3_sub(v[(k + 1) % 3], v[k]));
        if (length > most) {
            most = length;
            longest = k;
        }
    }
    if (!(most > least))
        return false;
    csg_vec3 a = v[longest], b = v[(longest + 1) % 3], c = v[(longest + 2) % 3];
    csg_vec3 middle = csg_vec3_scale(csg_vec3_add(a, b), 0.5);
    const csg_vec3 first[3] = {a, middle, c}, second[3] = {middle, b, c};
    memcpy(halves[0], first, sizeof first);
    memcpy(halves[1], second, sizeof second);
    return true;
}

/* ---- eight at a time ---------------------------------------------------------------------------
 */

/* Pieces begin with sides of so many cells, or errors where cells are small. What has few leaves,
 * whose gradients say by themselves what does not take part, is cut without another tape. */
enum { FIRST_SIDE = 8, FIRST_ERRORS = 64, DEEPEST = 8, FEW_NODES = 6 };
static const double LEAST_SIDE = 0.0625; /* of the error: shorter ones are not cut */

/* Up to eight parts of a piece, by three bisections, or fewer by fewer. False: it is too small. */
static bool cut(const piece *whole, double least, piece *parts, int count)
{
    for (int i = 0; i < count; i++)
        parts[i] = *whole;
    for (int half = count / 2; half; half /= 2)
        for (int i = 0; i < count; i += 2 * half) {
            csg_vec3 halves[2][3];
            if (!bisect(parts[i].at, i ? 0 : least, halves) && !i)
                return false;
            memcpy(parts[i].at, halves[0], sizeof halves[0]);
            memcpy(parts[i + half].at, halves[1], sizeof halves[1]);
        }
    return true;
}

/* Gradients stray by less in a smaller piece, and values between corners by the square of that:
 * where they stray by little too much, few parts are enough. */
static int parts_for(double excess)
{
    int count = 2;
    while (count < CSG_OCTANTS && excess > count)
        count *= 2;
    return count;
}

/* Tapes for the pieces' neighbourhoods, from one that holds around all of them. A tape without
 * nodes: no surface is there. */
static bool prune_eight(proof *p, settler *s, const csg_tape *from, const piece *pieces,
                        size_t count, csg_tape tapes[CSG_OCTANTS])
{
    float c[3][CSG_OCTANTS], tau = (float)(2.5 * (double)from->lipschitz * p->error);
    double most = 0;
    for (size_t i = 0; i < CSG_OCTANTS; i++) {
        disc d = disc_of(pieces[i < count ? i : count - 1].at);
        c[0][i] = (float)d.center.x;
        c[1][i] = (float)d.center.y;
        c[2][i] = (float)d.center.z;
        most = fmax(most, d.radius);
    }
    /* a cube is told by the ball around it, and holds the ball that is needed */
    float radius = (float)(1.733 * (most + 1.05 * p->error));
    if (!csg_prune_octants(&s->pruner, from, c[0], c[1], c[2], radius))
        return false;
    for (size_t i = 0; i < count; i++) {
        tapes[i] = *from;
        tapes[i].count = 0;
        if (csg_prune_state(&s->pruner, (int)i) == CSG_CELL_SURFACE &&
            !csg_prune_shorten(&s->pruner, (int)i, tau, &s->arena, &tapes[i]))
            return false;
    }
    return true;
}

static bool has_open(const piece *pieces, size_t count, uint32_t triangle)
{
    bool any = false;
    for (size_t i = 0; i < count; i++)
        any |= pieces[i].triangle == triangle && pieces[i].open;
    return any;
}

/* Those of each tape at once: most have the same one. */
static void settle_all(const proof *p, settler *s, const piece *pieces, const csg_tape *tapes,
                       answer *answers, size_t count)
{
    bool is_done[CSG_OCTANTS] = {false};
    for (size_t i = 0; i < count; i++) {
        const piece *alike[CSG_OCTANTS];
        answer *of[CSG_OCTANTS];
        size_t alike_count = 0;
        if (!tapes[i].count)
            answers[i].what = FAR;
        for (size_t k = i; k < count && tapes[i].count && !is_done[i]; k++) {
            if (is_done[k] || !csg_tape_is_same(&tapes[i], &tapes[k]))
                continue;
            alike[alike_count] = &pieces[k];
            of[alike_count++] = &answers[k];
            is_done[k] = k > i;
        }
        s->tape = tapes[i];
        if (alike_count)
            settle(p, s, alike, of, alike_count);
    }
}

/* Settles pieces; what stays open is cut in up to eight, whose tapes are shorter where it is large
 * and of several leaves. A triangle with an open piece is mended, whatever its others are: all are
 * looked at before any of them is cut, and no more than it takes to find one that stays open.
 * `from` is short enough: for all of them. False: out of memory. */
static bool settle_eight(proof *p, settler *s, const csg_tape *from, bool is_short, piece *pieces,
                         size_t count, int depth)
{
    csg_tape tapes[CSG_OCTANTS];
    answer answers[CSG_OCTANTS];
    csg_arena_mark mark = csg_arena_get_mark(&s->arena);
    bool done = true;
    if (is_short)
        for (size_t i = 0; i < count; i++)
            tapes[i] = *from;
    else
        done = prune_eight(p, s, from, pieces, count, tapes);
    if (done)
        settle_all(p, s, pieces, tapes, answers, count);
    for (size_t i = 0; done && i < count; i++)
        pieces[i].open = answers[i].what == FAR;
    for (size_t i = 0; done && i < count; i++) {
        piece parts[CSG_OCTANTS];
        if (answers[i].what != OPEN || has_open(pieces, count, pieces[i].triangle))
            continue;
        bool is_last = tapes[i].count <= FEW_NODES || depth >= DEEPEST ||
                       disc_of(pieces[i].at).radius < 2 * p->error;
        if (is_last && !is_short)
            s->most = s->pieces + MOST_OF_ONE;
        int part_count = parts_for(answers[i].excess);
        pieces[i].open = (is_last && s->pieces > s->most) ||
                         !cut(&pieces[i], LEAST_SIDE * p->error, parts, part_count);
        if (pieces[i].open)
            continue;
        done = settle_eight(p, s, &tapes[i], is_last, parts, (size_t)part_count, depth + 1);
        pieces[i].open = done && has_open(parts, (size_t)part_count, pieces[i].triangle);
    }
    csg_arena_release_to(&s->arena, mark);
    return done;
}

static bool settle_group(void *user, uint32_t worker, size_t group)
{
    proof *p = user;
    size_t first = group * CSG_OCTANTS, count = p->count - first;
    const csg_tape *whole = &p->remesh->probe.marching->field->tape;
    settler *s = &p->settlers[worker];
    const group_work before = {s->pieces, s->effort};
    bool done = settle_eight(p, s, whole, false, p->pieces + first,
                             count < CSG_OCTANTS ? count : CSG_OCTANTS, 0);
    p->groups[group] = (group_work){s->pieces - before.pieces, s->effort - before.effort};
    if (done)
        return !csg_mesh_should_stop(p->remesh->watch);
    atomic_store(&p->out_of_memory, true);
    return false;
}

/* ---- all of them -------------------------------------------------------------------------------
 */

static void report_groups(void *user, size_t done, size_t count)
{
    const proof *p = user;
    double share = (double)done / (double)count;
    csg_mesh_report_progress(p->remesh->watch, (p->settled + share * (p->at - p->settled)) /
                                                   p->remesh->corners.triangle_count);
}

/* What each rank has settled, to all: of a group what it took, then which of its pieces are open.
 */
static csgm_status exchange_groups(proof *p, size_t groups, csgm_status own)
{
    csgm_context *context = p->remesh->context;
    csg_records records = {0};
    csg_record_reader reader;
    bool done = true;
    for (size_t i = 0; i < p->count && done && own == CSGM_OK; i++) {
        size_t group = i / CSG_OCTANTS;
        if (csg_ranks_have(context, group))
            done = (i % CSG_OCTANTS || csg_records_add(&context->memory, &records,
                                                       &p->groups[group], sizeof *p->groups)) &&
                   csg_records_add(&context->memory, &records, &p->pieces[i].open, sizeof(bool));
    }
    csgm_status status = csg_ranks_exchange(context, done ? own : csg_context_no_memory(context),
                                            groups, &records, &reader);
    for (size_t i = 0; i < p->count && status == CSGM_OK; i++) {
        size_t group = i / CSG_OCTANTS;
        if (i % CSG_OCTANTS == 0)
            csg_record_read(&reader, group, &p->groups[group], sizeof *p->groups);
        csg_record_read(&reader, group, &p->pieces[i].open, sizeof(bool));
    }
    csg_record_reader_end(&context->memory, &reader);
    return status;
}

static csgm_status settle_pieces(proof *p, uint8_t *pending, csg_distance_proof *out)
{
    const csg_remesh *r = p->remesh;
    size_t groups = (p->count + CSG_OCTANTS - 1) / CSG_OCTANTS;
    csgm_status status = CSGM_OK;
    if (!csg_ranks_run(r->context, groups, CSG_ITEMS_SMALL, settle_group, report_groups, p))
        status = atomic_load(&p->out_of_memory) ? csg_context_no_memory(r->context)
                                                : csg_mesh_why_stopped(r->watch);
    if (csg_ranks_share(r->context, groups, CSG_ITEMS_SMALL))
        status = exchange_groups(p, groups, status);
    if (status != CSGM_OK)
        return status;
    for (size_t i = 0; i < p->count; i++) {
        if (!p->pieces[i].open)
            continue;
        if (!out->open++)
            out->place = disc_of(p->pieces[i].at).center;
        pending[p->pieces[i].triangle] = 1;
    }
    p->count = 0;
    p->settled = p->at;
    for (size_t i = 0; i < groups; i++) {
        p->looked_at.pieces += p->groups[i].pieces;
        p->looked_at.effort += p->groups[i].effort;
    }
    out->stopped = p->looked_at.effort > MOST_EFFORT;
    return CSGM_OK;
}

/* Cuts a triangle into pieces of a few cells and settles them whenever there are enough. */
static csgm_status prove_triangle(proof *p, uint32_t triangle, uint8_t *pending,
                                  csg_distance_proof *out)
{
    const csg_remesh *r = p->remesh;
    double side = fmax(FIRST_SIDE * r->cell, FIRST_ERRORS * p->error);
    csg_vec3 stack[STACK][3];
    size_t top = 1;
    for (uint32_t k = 0; k < 3; k++)
        stack[0][k] = csg_remesh_corner(r, 3 * triangle + k);
    csg_vec3 normal = csg_vec3_normalize(csg_triangle_cross(stack[0][0], stack[0][1], stack[0][2]));
    while (top && !out->stopped) {
        csg_vec3 v[3];
        memcpy(v, stack[--top], sizeof v);
        if (top + 2 <= STACK && bisect(v, side, &stack[top])) {
            top += 2;
            continue;
        }
        if (p->count == PIECES) {
            csgm_status status = settle_pieces(p, pending, out);
            if (status != CSGM_OK)
                return status;
        }
        piece *one = &p->pieces[p->count++];
        memcpy(one->at, v, sizeof v);
        one->normal = normal;
        one->triangle = triangle;
    }
    return CSGM_OK;
}

static bool begin(proof *p)
{
    const csg_remesh *r = p->remesh;
    csg_memory *memory = p->remesh->memory;
    p->settler_count = csg_pool_threads(r->context->pool);
    p->scratch_floats = csg_kernel_scratch_floats(r->marching->field->depth);
    p->pieces = csg_memory_alloc(memory, PIECES * sizeof *p->pieces);
    p->settlers = csg_memory_alloc(memory, p->settler_count * sizeof *p->settlers);
    if (!p->pieces || !p->settlers)
        return false;
    bool done = true;
    for (size_t i = 0; i < p->settler_count; i++) {
        settler *s = &p->settlers[i];
        *s = (settler){0};
        csg_pruner_init(&s->pruner, memory, r->marching->kernel,
                        csg_octree_rounding(r->marching->lattice));
        csg_arena_init(&s->arena, memory);
        s->scratch = csg_memory_alloc(memory, p->scratch_floats * sizeof(float));
        done = done && s->scratch;
    }
    return done;
}

static void end(proof *p)
{
    csg_memory *memory = p->remesh->memory;
    for (size_t i = 0; p->settlers && i < p->settler_count; i++) {
        csg_pruner_release(&p->settlers[i].pruner);
        csg_arena_reset(&p->settlers[i].arena);
        csg_memory_release(memory, p->settlers[i].scratch, p->scratch_floats * sizeof(float));
    }
    csg_memory_release(memory, p->pieces, PIECES * sizeof *p->pieces);
    csg_memory_release(memory, p->settlers, p->settler_count * sizeof *p->settlers);
}

static csgm_status check_by_field(const csg_remesh *remesh, double error, bool patient,
                                  uint8_t *pending, csg_distance_proof *out)
{
    static const double HOPELESS = 0.95; /* pieces would have to be small, and many */
    proof p = {.remesh = remesh, .error = error, .farthest = patient ? 1 : HOPELESS};
    csgm_status status = begin(&p) ? CSGM_OK : csg_context_no_memory(remesh->context);
    const csg_corners *m = &remesh->corners;
    for (uint32_t t = 0; t < m->triangle_count && status == CSGM_OK && !out->stopped; t++)
        if (csg_corners_is_live(m, t) && pending[t]) {
            pending[t] = 0;
            p.at = t;
            status = prove_triangle(&p, t, pending, out);
        }
    if (status == CSGM_OK && p.count && !out->stopped)
        status = settle_pieces(&p, pending, out);
    out->pieces += p.looked_at.pieces;
    out->effort += p.looked_at.effort;
    end(&p);
    return status;
}

csgm_status csg_check_distance(const csg_remesh *remesh, const csg_begun *begun, double error,
                               bool patient, uint8_t *pending, csg_distance_proof *out)
{
    static const double ROUND_SHARE = 0.2; /* of what is left of the stage, for progress */
    *out = (csg_distance_proof){.effort = out->effort};
    csg_mesh_take(remesh->watch, CSGM_STAGE_RESHAPE, ROUND_SHARE);
    if (begun->tree.count) {
        csg_begun_proof found;
        csgm_status status = csg_begun_check(begun, remesh, error, pending, &found);
        out->pieces = found.pieces;
        if (status != CSGM_OK || !found.open)
            return status;
        if (csg_begun_is_decisive(begun, error)) {
            out->open = found.open;
            out->place = found.place;
            return CSGM_OK;
        }
    }
    return check_by_field(remesh, error, patient, pending, out);
}
