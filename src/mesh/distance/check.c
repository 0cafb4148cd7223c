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
#include "mesh/distance/slopes.h"

enum { PIECES = 1 << 11, GROUPS = PIECES / CSG_OCTANTS, STACK = 64 };

/* Small triangles that a piece is cut into, along a side. */
enum { MOST_CUTS = 12, MOST_PLACES = (MOST_CUTS + 1) * (MOST_CUTS + 2) / 2 + CSG_LANES };

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
    uint64_t pieces, by_cone, effort;
} settler;

/* What eight pieces took, with their parts. */
typedef struct group_work {
    uint64_t pieces, by_cone, effort;
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

/* Places at which values are asked for, all at once. */
typedef struct places {
    float at[3][2 * MOST_PLACES];
    size_t count, outside; /* those from here on are on the outer side */
} places;

/* The corners of cuts^2 small triangles that the piece is cut into, a step away from it. */
static void add_corners(places *to, const csg_vec3 v[3], csg_vec3 step, int cuts)
{
    csg_vec3 first = csg_vec3_add(v[0], step), q;
    for (int i = 0; i <= cuts; i++)
        for (int k = 0; i + k <= cuts; k++) {
            q = csg_vec3_add(csg_vec3_scale(csg_vec3_sub(v[1], v[0]), (double)i / cuts),
                             csg_vec3_scale(csg_vec3_sub(v[2], v[0]), (double)k / cuts));
            q = csg_vec3_add(first, q);
            size_t n = to->count++;
            to->at[0][n] = (float)q.x, to->at[1][n] = (float)q.y, to->at[2][n] = (float)q.z;
        }
}

/* By how much f has the sign that it should have there, at least. */
static double margin_at(const proof *p, settler *s, places *of)
{
    float f[2 * MOST_PLACES];
    double least = INFINITY;
    for (size_t n = of->count; n % CSG_LANES; n++) /* shapes are asked for copies once */
        for (int axis = 0; axis < 3; axis++)
            of->at[axis][n] = of->at[axis][0];
    p->remesh->probe.marching->kernel->values(&s->tape, of->at[0], of->at[1], of->at[2], of->count,
                                              f, s->scratch, p->scratch_floats);
    for (size_t i = 0; i < of->count; i++) {
        double inside = i < of->outside ? (double)f[i] : -(double)f[i];
        if (!(inside == inside))
            return -INFINITY; /* no value, no proof */
        least = inside < least ? inside : least;
    }
    return least;
}

/* The same on both sides of the piece, a step inwards and a step back. Both are asked for at once
 * where they are few, since a walk over the tape costs the same for sixteen places as for six; else
 * the outer side only where the inner one has more than `hopeless`. */
static double margin_of(const proof *p, settler *s, const csg_vec3 v[3], csg_vec3 step, int cuts,
                        double hopeless)
{
    enum { FEW_CUTS = 2 };
    places of = {.count = 0};
    add_corners(&of, v, step, cuts);
    of.outside = of.count;
    csg_vec3 back = csg_vec3_scale(step, -1);
    if (cuts <= FEW_CUTS) {
        add_corners(&of, v, back, cuts);
        return margin_at(p, s, &of);
    }
    double inside = margin_at(p, s, &of);
    if (!(inside > hopeless))
        return inside;
    of.count = of.outside = 0;
    add_corners(&of, v, back, cuts);
    double outside = margin_at(p, s, &of);
    return inside < outside ? inside : outside;
}

/* Whether all of the piece is inside a step along the axis, and outside a step back. Values lie
 * between those at the corners of a small triangle but for what gradients stray by from one vector.
 * As many triangles as it takes: gradients are found once, and values cost little. No gradient is
 * longer than `longest`: no place is farther from zero than that on both sides. *excess, where that
 * fails: by what factor gradients stray too much. */
static bool settles_by_steps(const proof *p, settler *s, disc d, const csg_vec3 v[3], double stray,
                             double longest, csg_vec3 axis, double *excess)
{
    csg_vec3 step = csg_vec3_scale(axis, p->error);
    double slack = slack_of(p);
    stray *= d.radius;
    if (!(stray < MOST_CUTS * longest * p->error))
        return false;
    for (int cuts = 2; cuts <= MOST_CUTS;) {
        double margin = margin_of(p, s, v, step, cuts, stray / MOST_CUTS + slack) - slack;
        if (margin * cuts > stray)
            return true;
        if (!(margin * MOST_CUTS > stray)) {
            *excess = margin > 0 ? stray / (margin * MOST_CUTS) : INFINITY;
            return false;
        }
        int enough = (int)ceil(stray / margin);
        cuts = enough > cuts ? enough : cuts + 1;
    }
    return false;
}

static bool settles_by_cone(const proof *p, settler *s, disc d, const csg_vec3 v[3],
                            const csg_gradients *gradients, double *excess)
{
    csg_cone cone;
    if (!csg_gradients_find_axis(gradients, &cone))
        return false;
    double least = cone.least * p->error - slack_of(p);
    double longest = fmin(gradients->longest, (double)s->tape.lipschitz);
    csg_vec3 axis = {cone.axis[0], cone.axis[1], cone.axis[2]};
    return (gradients->low >= -least && gradients->high <= least) ||
           settles_by_steps(p, s, d, v, gradients->stray, longest, axis, excess);
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

static verdict settle(const proof *p, settler *s, const csg_vec3 v[3], csg_vec3 normal,
                      double *excess)
{
    static const double STEPS_REACH = 6; /* of the error */
    disc d = disc_of(v);
    double steepest = (double)s->tape.lipschitz, value;
    const csg_gradients_region near = {{v[0], v[1], v[2]}, d.center, p->error, 0};
    csg_gradients gradients;
    bool known = csg_gradients_find(p->remesh->probe.marching->kernel, &s->tape, &near, s->scratch,
                                    p->scratch_floats, &gradients);
    double any;
    *excess = INFINITY;
    s->pieces++;
    s->effort += csg_effort_of(&s->tape);
    if (known && settles_by_cone(p, s, d, v, &gradients, excess)) {
        s->by_cone++;
        return SETTLED;
    }
    if (known && gradients.longest < steepest)
        steepest = gradients.longest;
    value = known ? gradients.value : value_at(p, s, d.center);
    if (fabs(value) > p->farthest * steepest * p->error + slack_of(p))
        return FAR;
    if (d.radius > STEPS_REACH * p->error)
        return OPEN;
    /* any gradient is as near to zero as that */
    csg_vec3 inward = csg_vec3_scale(normal, -1);
    if ((!known || gradients.stray > 0.5 * steepest) &&
        settles_by_steps(p, s, d, v, steepest, steepest, inward, &any))
        return SETTLED;
    csg_vec3 side = csg_vec3_normalize(csg_vec3_sub(v[1], v[0]));
    return d.radius <= 0.5 * p->error && settles_nearby(p, s, d, normal, side) ? SETTLED : OPEN;
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

static const double LEAST_SIDE = 0.0625; /* of the error: shorter ones are not cut */

/* Settles the halves of one that stays open as a whole. Depth first: the stack holds one half for
 * each time the piece was cut. */
static bool settle_halves(const proof *p, settler *s, const piece *whole)
{
    csg_vec3 stack[STACK][3];
    size_t top = 2;
    uint64_t most = s->pieces + MOST_OF_ONE - 1; /* the whole was one */
    if (!bisect(whole->at, LEAST_SIDE * p->error, stack))
        return false;
    while (top) {
        csg_vec3 v[3];
        memcpy(v, stack[--top], sizeof v);
        double any;
        verdict what = settle(p, s, v, whole->normal, &any);
        if (what == SETTLED)
            continue;
        if (what == FAR || top + 2 > STACK || s->pieces > most ||
            !bisect(v, LEAST_SIDE * p->error, &stack[top]))
            return false;
        top += 2;
    }
    return true;
}

/* ---- eight at a time ---------------------------------------------------------------------------
 */

/* Pieces begin with sides of so many cells, or errors where cells are small. What has few leaves,
 * whose gradients say by themselves what does not take part, is cut without another tape. */
enum { FIRST_SIDE = 8, FIRST_ERRORS = 64, DEEPEST = 8, FEW_NODES = 6 };

/* Eight parts of a piece, by three bisections, or fewer by fewer. */
static void cut(const piece *whole, piece *parts, int count)
{
    for (int i = 0; i < count; i++)
        parts[i] = *whole;
    for (int half = count / 2; half; half /= 2)
        for (int i = 0; i < count; i += 2 * half) {
            csg_vec3 halves[2][3];
            if (!bisect(parts[i].at, 0, halves))
                continue;
            memcpy(parts[i].at, halves[0], sizeof halves[0]);
            memcpy(parts[i + half].at, halves[1], sizeof halves[1]);
        }
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

/* Settles pieces; what is large and of several leaves is cut in up to eight, whose tapes are
 * shorter. A triangle with an open piece is mended, whatever its others are: all are looked at
 * before any of them is cut, and no more than it takes to find one that stays open. False: out of
 * memory. */
static bool settle_eight(proof *p, settler *s, const csg_tape *from, piece *pieces, size_t count,
                         int depth)
{
    csg_tape tapes[CSG_OCTANTS];
    verdict what[CSG_OCTANTS];
    double excess[CSG_OCTANTS];
    csg_arena_mark mark = csg_arena_get_mark(&s->arena);
    bool done = prune_eight(p, s, from, pieces, count, tapes);
    for (size_t i = 0; done && i < count; i++) {
        s->tape = tapes[i];
        what[i] = tapes[i].count ? settle(p, s, pieces[i].at, pieces[i].normal, &excess[i]) : FAR;
        pieces[i].open = what[i] == FAR;
    }
    for (size_t i = 0; done && i < count; i++) {
        piece parts[CSG_OCTANTS];
        if (what[i] != OPEN || has_open(pieces, count, pieces[i].triangle))
            continue;
        s->tape = tapes[i];
        if (tapes[i].count <= FEW_NODES || depth == DEEPEST ||
            disc_of(pieces[i].at).radius < 2 * p->error) {
            pieces[i].open = !settle_halves(p, s, &pieces[i]);
            continue;
        }
        int part_count = parts_for(excess[i]);
        cut(&pieces[i], parts, part_count);
        done = settle_eight(p, s, &tapes[i], parts, (size_t)part_count, depth + 1);
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
    const group_work before = {s->pieces, s->by_cone, s->effort};
    bool done =
        settle_eight(p, s, whole, p->pieces + first, count < CSG_OCTANTS ? count : CSG_OCTANTS, 0);
    p->groups[group] = (group_work){s->pieces - before.pieces, s->by_cone - before.by_cone,
                                    s->effort - before.effort};
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
        p->looked_at.by_cone += p->groups[i].by_cone;
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
    out->by_cone += p.looked_at.by_cone;
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
