/* SPDX-License-Identifier: MIT
 * Parts over poses; see clearance.h. At each pose the parts' boxes come first: pairs that they show
 * to be no worse than what is known go no further, and only parts of the others are compiled, where
 * they are not what they were.
 */
#include "clearance/clearance.h"

#include <math.h>
#include <string.h>

#include "base/mesh_codes.h"
#include "base/pool.h"
#include "base/trace.h"
#include "clearance/search.h"
#include "scene/tree/placement.h"

/* Of a name over all poses. */
typedef struct part {
    char *name;              /* NULL: none */
    csg_clear_part at;       /* where it was last needed */
    uint64_t version;        /* grows when that changes */
    csg_box box;             /* at this pose */
    size_t index;            /* among the pose's parts */
    bool is_there, is_fresh; /* at this pose; .at is of this pose */
    csg_placement placed[2]; /* at this pose: that of its parity; and at the pose before */
    csg_affine back, forth;  /* from this pose to the one before, and to it; where has_motion */
    double reach;            /* of both placements and the box */
    bool was_there, has_motion, is_still;
} part;

typedef enum outcome { CLEAR, BAD, OPEN } outcome;

/* The step from the pose before to this one. ASKED: a search is to tell. */
typedef enum step { STEP_NONE, STEP_OPEN, STEP_ASKED, STEP_COVERED } step;

typedef struct pair {
    csgm_clear_pair told;
    uint32_t a, b;
    uint64_t versions[2]; /* of the last search; 0: none yet */
    outcome last;         /* of it */
    double last_apart;    /* then they were so far apart; 0: that was not proven */
    step step;
    double between; /* the least of what is proven of steps */
    size_t poses;   /* at which something is known */
    bool is_known;  /* told is of some pose */
} pair;

/* A search of this pose. */
typedef struct inquiry {
    uint32_t pair;
    bool moves_first;  /* the motion is the first part's; else the second one's */
    csg_motion motion; /* where the step is asked for */
    double apart;      /* > 0: known to be so far apart at this pose, and only the step is asked */
    csgm_clear_pair found;
    bool out_of_memory;
} inquiry;

struct csgm_clearances {
    csgm_context *context;
    csgm_clear_options options;
    char **wanted; /* options.part_count names */
    part *parts;
    pair *pairs;
    size_t part_count, part_room, pair_count, pair_room, poses;
    inquiry *search; /* what boxes do not tell of this pose */
    size_t search_count, search_room;
    double tolerance;
    csg_mesh_watch watch;
    bool has_begun;
};

/* ---- beginning and end -------------------------------------------------------------------------
 */

static char *copy_text(csg_memory *memory, const char *text)
{
    size_t bytes = strlen(text) + 1;
    char *copy = csg_memory_alloc(memory, bytes);
    if (copy)
        memcpy(copy, text, bytes);
    return copy;
}

static void release_text(csg_memory *memory, char *text)
{
    if (text)
        csg_memory_release(memory, text, strlen(text) + 1);
}

csgm_clearances *csg_clearances_create(csgm_context *context, const csgm_clear_options *options)
{
    csg_memory *memory = &context->memory;
    csgm_clearances *c = csg_memory_alloc(memory, sizeof *c);
    bool done = c != NULL;
    if (done) {
        *c = (csgm_clearances){.context = context, .options = *options};
        size_t bytes = options->part_count * sizeof *c->wanted;
        c->wanted = bytes ? csg_memory_alloc(memory, bytes) : NULL;
        done = c->wanted || !bytes;
        if (c->wanted)
            memset(c->wanted, 0, bytes);
        for (size_t i = 0; done && i < options->part_count; i++) {
            c->wanted[i] = copy_text(memory, options->parts[i]);
            done = c->wanted[i] != NULL;
        }
    }
    if (done)
        return c;
    csg_clearances_destroy(c);
    csg_context_no_memory(context);
    return NULL;
}

void csg_clearances_destroy(csgm_clearances *c)
{
    if (!c)
        return;
    csg_memory *memory = &c->context->memory;
    for (size_t i = 0; i < c->part_count; i++) {
        csg_clear_part_release(&c->parts[i].at);
        for (int k = 0; k < 2; k++)
            csg_placement_release(&c->parts[i].placed[k]);
        release_text(memory, c->parts[i].name);
    }
    for (size_t i = 0; c->wanted && i < c->options.part_count; i++)
        release_text(memory, c->wanted[i]);
    csg_memory_release(memory, c->wanted, c->options.part_count * sizeof *c->wanted);
    csg_memory_release(memory, c->parts, c->part_room * sizeof *c->parts);
    csg_memory_release(memory, c->pairs, c->pair_room * sizeof *c->pairs);
    csg_memory_release(memory, c->search, c->search_room * sizeof *c->search);
    csg_memory_release(memory, c, sizeof *c);
}

/* ---- parts of a pose ---------------------------------------------------------------------------
 */

static bool is_same_name(const char *a, const char *b)
{
    return a && b ? strcmp(a, b) == 0 : a == b;
}

static bool is_wanted(const csgm_clearances *c, const char *name)
{
    for (size_t i = 0; i < c->options.part_count; i++)
        if (is_same_name(c->wanted[i], name))
            return true;
    return false;
}

static bool is_pair_wanted(const csgm_clearances *c, const char *a, const char *b)
{
    if (c->options.part_count == 0)
        return true;
    bool has_a = is_wanted(c, a), has_b = is_wanted(c, b);
    return c->options.part_count == 1 ? has_a || has_b : has_a && has_b;
}

/* A new part, and its pairs with those before. False: out of memory. */
static bool add_part(csgm_clearances *c, const char *name)
{
    csg_memory *memory = &c->context->memory;
    uint32_t index = (uint32_t)c->part_count;
    part fresh = {.name = name ? copy_text(memory, name) : NULL};
    bool done = csg_memory_reserve(memory, (void **)&c->parts, &c->part_room, c->part_count + 1,
                                   sizeof fresh) &&
                (fresh.name || !name);
    if (!done) {
        release_text(memory, fresh.name);
        return false;
    }
    c->parts[c->part_count++] = fresh;
    for (uint32_t i = 0; i < index; i++) {
        if (!is_pair_wanted(c, c->parts[i].name, name))
            continue;
        if (!csg_memory_reserve(memory, (void **)&c->pairs, &c->pair_room, c->pair_count + 1,
                                sizeof *c->pairs))
            return false;
        c->pairs[c->pair_count++] = (pair){.a = i,
                                           .b = index,
                                           .between = INFINITY,
                                           .told = {.names = {c->parts[i].name, fresh.name},
                                                    .state = CSGM_CLEAR_UNDECIDED,
                                                    .gap = {INFINITY, INFINITY}}};
    }
    return true;
}

/* Parts come in the same order as a rule, so the search begins behind the last one found. */
static bool find_part(csgm_clearances *c, const char *name, size_t *at)
{
    for (size_t n = 0; n < c->part_count; n++) {
        size_t i = (*at + n) % c->part_count;
        if (is_same_name(c->parts[i].name, name)) {
            *at = i;
            return true;
        }
    }
    *at = c->part_count;
    return add_part(c, name);
}

/* From the origin. */
static double farthest_of(csg_box box)
{
    csg_vec3 a = box.min, b = box.max;
    if (csg_box_is_empty(box))
        return 0;
    return csg_vec3_norm(csg_vec3_make(fmax(fabs(a.x), fabs(b.x)), fmax(fabs(a.y), fabs(b.y)),
                                       fmax(fabs(a.z), fabs(b.z))));
}

/* Where it is, and how it came there. False: out of memory. */
static bool place_part(const csgm_clearances *c, part *p, const csg_parts *parts)
{
    const csg_placement *before = &p->placed[(c->poses + 1) % 2];
    csg_placement *now = &p->placed[c->poses % 2];
    if (csg_placement_take(now, parts, p->index) != CSGM_OK)
        return false;
    p->has_motion = p->was_there && csg_placement_motion(now, before, &p->back) &&
                    csg_affine_invert(p->back, &p->forth);
    p->is_still = p->has_motion && csg_placement_is_same(now, before);
    if (p->is_still)
        p->back = p->forth = csg_affine_identity();
    p->reach = csg_placement_reach(now) + 4 * farthest_of(p->box); /* cubes reach beyond the box */
    if (p->was_there)
        p->reach += csg_placement_reach(before);
    return true;
}

static bool take_parts(csgm_clearances *c, const csg_parts *parts)
{
    size_t at = 0;
    for (size_t i = 0; i < c->part_count; i++) {
        c->parts[i].was_there = c->parts[i].is_there;
        c->parts[i].is_there = c->parts[i].is_fresh = false;
    }
    for (size_t i = 0; i < parts->count; i++, at++) {
        if (!find_part(c, csg_parts_name(parts, i), &at))
            return false;
        part *p = &c->parts[at];
        p->is_there = true;
        p->index = i;
        p->box = csg_parts_box(parts, i);
        if (!place_part(c, p, parts))
            return false;
    }
    return true;
}

static bool has_wanted(const csgm_clearances *c)
{
    for (size_t i = 0; i < c->options.part_count; i++) {
        bool found = false;
        for (size_t k = 0; k < c->part_count && !found; k++)
            found = is_same_name(c->wanted[i], c->parts[k].name);
        if (!found)
            return false;
    }
    return true;
}

static csgm_status refuse_few(csgm_context *context)
{
    csg_diag_plain(&context->diags, CSG_DIAG_NOTHING_TO_CLEAR, NULL,
                   "part(\"lid\") in the scene makes what follows a part of its own",
                   "the scene has fewer than two parts: there is nothing to be clear of");
    return CSGM_ERR_SCENE;
}

static double side_of(csg_box box)
{
    return csg_box_is_finite(box) ? csg_box_longest_side(box) : 0;
}

static csgm_status begin(csgm_clearances *c)
{
    static const double SHARE = 1e-4;
    double longest = 0; /* of one part: how far away others are says nothing of how fine it is */
    for (size_t i = 0; i < c->part_count; i++)
        longest = fmax(longest, side_of(c->parts[i].box));
    c->tolerance = c->options.tolerance > 0 ? c->options.tolerance : SHARE * longest;
    if (!(c->tolerance > 0))
        c->tolerance = SHARE;
    csg_mesh_watch_begin(&c->watch, c->context, &c->options.monitor, 0);
    csg_mesh_take(&c->watch, CSGM_STAGE_MEASURE, 1);
    c->has_begun = true;
    return has_wanted(c) ? CSGM_OK : CSGM_ERR_ARGUMENT;
}

/* ---- what boxes tell ---------------------------------------------------------------------------
 */

/* No more than the distance of what is in them. */
static double box_distance(csg_box a, csg_box b)
{
    static const double ROUNDING = 1e-12;
    if (csg_box_is_empty(a) || csg_box_is_empty(b))
        return INFINITY;
    const double low[2][3] = {{a.min.x, a.min.y, a.min.z}, {b.min.x, b.min.y, b.min.z}};
    const double high[2][3] = {{a.max.x, a.max.y, a.max.z}, {b.max.x, b.max.y, b.max.z}};
    double square = 0, size = 0;
    for (int k = 0; k < 3; k++) {
        double gap = fmax(0, fmax(low[1][k] - high[0][k], low[0][k] - high[1][k]));
        square += gap * gap;
        size = fmax(size, fmax(fmax(fabs(low[0][k]), fabs(high[0][k])),
                               fmax(fabs(low[1][k]), fabs(high[1][k]))));
    }
    return isfinite(size) ? fmax(0, sqrt(square) * (1 - ROUNDING) - ROUNDING * size) : 0;
}

static int rank_of(csgm_clear_state state)
{
    return state == CSGM_CLEAR_INTERFERING ? 2 : state == CSGM_CLEAR_UNDECIDED ? 1 : 0;
}

/* Of a gap, where no tolerance was asked for. */
static double share_of(const csgm_clearances *c)
{
    static const double SHARE = 1.0 / 64;
    return c->options.tolerance > 0 ? 0 : SHARE;
}

/* A gap that is as large makes a pose neither worse than the worst, within the tolerance, nor bad.
 */
static double enough_of(const csgm_clearances *c, const pair *p)
{
    const csgm_clear_pair *told = &p->told;
    double worst = INFINITY;
    if (p->is_known && rank_of(told->state))
        worst = 0;
    else if (p->is_known && !told->by_boxes)
        worst = told->gap.high - fmax(c->tolerance, share_of(c) * told->gap.high);
    return fmax(fmax(worst, 0), c->options.min_gap);
}

/* Far: farther apart than half of what one of them is long, and never nearer so far. Where pairs
 * were named, these are wanted. */
static bool is_far(const csgm_clearances *c, const pair *p, double apart)
{
    double a = side_of(c->parts[p->a].box), b = side_of(c->parts[p->b].box);
    return apart >= INFINITY || (c->options.part_count == 0 && (!p->is_known || p->told.by_boxes) &&
                                 apart > 0.5 * fmin(a, b) && apart >= c->options.min_gap);
}

/* False: they have to be searched. */
static bool ask_boxes(csgm_clearances *c, pair *p)
{
    double apart = box_distance(c->parts[p->a].box, c->parts[p->b].box);
    bool is_clear = apart > 0 && apart >= enough_of(c, p);
    if (!is_clear && !is_far(c, p, apart))
        return false;
    if (!p->is_known || (p->told.by_boxes && apart < p->told.gap.low)) {
        p->told.state = CSGM_CLEAR_APART;
        p->told.by_boxes = p->is_known = true;
        p->told.pose = c->poses;
    }
    p->told.gap.low = fmin(p->told.gap.low, apart);
    p->poses++;
    return true;
}

/* ---- steps -------------------------------------------------------------------------------------
 */

/* The ball around the part's box. */
static double most_of(const csg_motion *motion, const part *p)
{
    double radius = 0.5 * csg_vec3_norm(csg_box_size(p->box));
    return csg_motion_most(motion, csg_box_center(p->box), radius);
}

/* The box that the part is in all the way: that of both ends, and of what bends. */
static csg_box box_of_way(const csg_motion *motion, const part *p)
{
    csg_box both = csg_box_hull(p->box, csg_affine_box(&motion->back, p->box));
    return csg_box_grow(both, motion->bend * most_of(motion, p) + motion->slack);
}

static void cover(pair *p, double apart)
{
    p->step = STEP_COVERED;
    p->between = fmin(p->between, apart);
}

/* What is known of the step by motions and boxes. Of two motions, that of the one part seen from
 * the other and the other way round, the smaller one is taken: they are the same way. */
static void begin_step(const csgm_clearances *c, pair *p, inquiry *out)
{
    const part *a = &c->parts[p->a], *b = &c->parts[p->b];
    if (p->step == STEP_NONE || !a->has_motion || !b->has_motion)
        return;
    if (a->is_still && b->is_still) {
        cover(p, INFINITY);
        return;
    }
    double apart = box_distance(a->box, b->box), reach = a->reach + b->reach;
    if (apart >= INFINITY)
        cover(p, INFINITY);
    if (apart >= INFINITY || !isfinite(reach))
        return;
    csg_motion of_b = csg_motion_between(&b->back, &a->forth, reach);
    double most_b = most_of(&of_b, b), least = c->options.min_gap;
    double left = fmax(apart - most_b, box_distance(a->box, box_of_way(&of_b, b)));
    if (most_b <= 2 * of_b.slack) {
        cover(p, INFINITY);
        return;
    }
    if (left > 0 && left >= least) {
        cover(p, left);
        return;
    }
    csg_motion of_a = csg_motion_between(&a->back, &b->forth, reach);
    double most_a = most_of(&of_a, a);
    left = fmax(apart - most_a, box_distance(box_of_way(&of_a, a), b->box));
    out->moves_first = most_a < most_b;
    out->motion = out->moves_first ? of_a : of_b;
    p->step = STEP_ASKED;
    if (left > 0 && left >= least)
        cover(p, left);
}

/* ---- what searches tell ------------------------------------------------------------------------
 */

static bool is_worse(const csgm_clear_pair *told, const csgm_clear_pair *found)
{
    int before = rank_of(told->state), now = rank_of(found->state);
    if (told->by_boxes)
        return true;
    if (before != now)
        return now > before;
    return found->state == CSGM_CLEAR_INTERFERING ? found->volume.low > told->volume.low
                                                  : found->gap.high < told->gap.high;
}

static outcome outcome_of(const csgm_clearances *c, const csgm_clear_pair *found)
{
    double least = c->options.min_gap;
    if (found->state == CSGM_CLEAR_INTERFERING || found->gap.high < least)
        return BAD;
    return found->state == CSGM_CLEAR_UNDECIDED || found->gap.low < least ? OPEN : CLEAR;
}

static void count_pose(pair *p, outcome which)
{
    p->poses++;
    p->told.poses_bad += which == BAD;
    p->told.poses_open += which == OPEN;
}

static void take_found(csgm_clearances *c, pair *p, const csgm_clear_pair *found)
{
    csgm_clear_pair *told = &p->told;
    double low = fmin(told->gap.low, found->gap.low);
    told->pairs += found->pairs;
    if (!p->is_known || is_worse(told, found)) {
        csgm_clear_pair before = *told;
        *told = *found;
        told->pose = c->poses;
        memcpy(told->names, before.names, sizeof told->names);
        told->poses = before.poses;
        told->poses_bad = before.poses_bad;
        told->poses_open = before.poses_open;
        told->pairs = before.pairs;
        told->steps = before.steps;
        told->steps_open = before.steps_open;
        told->first_open = before.first_open;
        p->is_known = true;
    }
    told->gap.low = low;
    p->last = outcome_of(c, found);
    p->last_apart = found->state == CSGM_CLEAR_APART ? found->gap.low : 0;
    p->versions[0] = c->parts[p->a].version;
    p->versions[1] = c->parts[p->b].version;
    count_pose(p, p->last);
}

static bool search_one(void *user, uint32_t worker, size_t index)
{
    csgm_clearances *c = user;
    inquiry *q = &c->search[index];
    const pair *p = &c->pairs[q->pair];
    bool asks = p->step == STEP_ASKED, turned = asks && q->moves_first;
    csg_clear_task task = {.a = &c->parts[turned ? p->b : p->a].at,
                           .b = &c->parts[turned ? p->a : p->b].at,
                           .tolerance = c->tolerance,
                           .share = share_of(c),
                           .enough = enough_of(c, p),
                           .min_gap = c->options.min_gap,
                           .enough_volume = p->told.volume.low,
                           .most_pairs = c->options.most_pairs,
                           .motion = asks ? &q->motion : NULL,
                           .apart = q->apart,
                           .worker = worker,
                           .watch = &c->watch};
    bool done = csg_clear_search(&task, &q->found, &q->out_of_memory);
    if (turned) {
        csgm_vec3 first = q->found.nearest[0];
        q->found.nearest[0] = q->found.nearest[1];
        q->found.nearest[1] = first;
    }
    return done;
}

static csgm_status refresh(csgm_clearances *c, const csg_parts *parts, uint32_t index)
{
    part *p = &c->parts[index];
    bool changed = false;
    if (p->is_fresh)
        return CSGM_OK;
    csgm_status status =
        csg_clear_part_take(&p->at, c->context, parts, p->index, &c->watch, &changed);
    p->version += changed;
    p->is_fresh = true;
    return status;
}

static bool is_there(const csgm_clearances *c, const pair *p)
{
    return c->parts[p->a].is_there && c->parts[p->b].is_there;
}

static void begin_pose(const csgm_clearances *c, pair *p)
{
    bool is_now = is_there(c, p);
    bool is_step = is_now && c->parts[p->a].was_there && c->parts[p->b].was_there;
    p->told.poses += is_now;
    p->step = is_step ? STEP_OPEN : STEP_NONE;
}

static void end_step(const csgm_clearances *c, pair *p)
{
    csgm_clear_pair *told = &p->told;
    bool is_open = p->step == STEP_OPEN || p->step == STEP_ASKED;
    told->steps += p->step != STEP_NONE;
    told->steps_open += is_open;
    if (is_open && !told->first_open)
        told->first_open = c->poses;
    p->step = STEP_NONE;
}

/* A pose that was begun and not ended: pairs that were not looked at do not have it. Where it was
 * their first, nothing is known of them. */
static void end_pose(const csgm_clearances *c, pair *p)
{
    if (p->poses == p->told.poses)
        return;
    if (p->poses) {
        p->told.poses = p->poses;
        return;
    }
    count_pose(p, OPEN);
    p->told.gap.low = 0;
    p->told.pose = c->poses;
    p->is_known = true;
}

/* Pairs that have to be searched, their parts compiled. */
static csgm_status plan(csgm_clearances *c, const csg_parts *parts)
{
    csg_memory *memory = &c->context->memory;
    csgm_status status = CSGM_OK;
    c->search_count = 0;
    for (uint32_t i = 0; i < c->pair_count && status == CSGM_OK; i++) {
        pair *p = &c->pairs[i];
        if (i % 64 == 0 && csg_mesh_should_stop(&c->watch))
            return csg_mesh_why_stopped(&c->watch);
        inquiry asked = {.pair = i, .found = {.state = CSGM_CLEAR_UNDECIDED, .gap = {0, INFINITY}}};
        if (!is_there(c, p))
            continue;
        begin_step(c, p, &asked);
        bool is_told = ask_boxes(c, p);
        if (is_told && p->step != STEP_ASKED)
            continue;
        status = refresh(c, parts, p->a);
        if (status == CSGM_OK)
            status = refresh(c, parts, p->b);
        bool is_old =
            p->versions[0] == c->parts[p->a].version && p->versions[1] == c->parts[p->b].version;
        if (is_told)
            asked.apart = box_distance(c->parts[p->a].box, c->parts[p->b].box);
        if (status == CSGM_OK && is_old && !is_told) {
            count_pose(p, p->last);
            asked.apart = p->last_apart;
            if (p->step != STEP_ASKED || !(asked.apart > 0))
                continue;
        }
        if (status == CSGM_OK && !csg_memory_reserve(memory, (void **)&c->search, &c->search_room,
                                                     c->search_count + 1, sizeof *c->search))
            status = csg_context_no_memory(c->context);
        if (status == CSGM_OK)
            c->search[c->search_count++] = asked;
    }
    return status;
}

static csgm_status search_all(csgm_clearances *c)
{
    bool out_of_memory = false;
    bool done = csg_pool_run(c->context->pool, c->search_count, search_one, NULL, c);
    for (size_t i = 0; i < c->search_count; i++) {
        const inquiry *q = &c->search[i];
        pair *p = &c->pairs[q->pair];
        if (p->step == STEP_ASKED && q->found.gap_between > 0 &&
            q->found.gap_between >= c->options.min_gap)
            cover(p, q->found.gap_between);
        if (q->apart > 0)
            p->told.pairs += q->found.pairs;
        else if (done || !p->poses || outcome_of(c, &q->found) != OPEN)
            take_found(c, p, &q->found);
        out_of_memory |= q->out_of_memory;
    }
    if (done)
        return CSGM_OK;
    return out_of_memory ? csg_context_no_memory(c->context) : csg_mesh_why_stopped(&c->watch);
}

csgm_status csg_clearances_add(csgm_clearances *c, const csgm_scene *scene)
{
    CSG_ZONE(c->context, "clear");
    csg_parts parts;
    csgm_status status = csg_parts_find(&parts, scene);
    if (status == CSGM_OK && !take_parts(c, &parts))
        status = CSGM_ERR_MEMORY;
    if (status == CSGM_ERR_MEMORY)
        csg_context_no_memory(c->context);
    if (status == CSGM_OK && !c->has_begun)
        status = begin(c);
    if (status == CSGM_OK && parts.count < 2)
        status = refuse_few(c->context);
    for (size_t i = 0; i < c->pair_count && status == CSGM_OK; i++)
        begin_pose(c, &c->pairs[i]);
    if (status == CSGM_OK)
        status = plan(c, &parts);
    if (status == CSGM_OK)
        status = search_all(c);
    csg_zone_count(c->context, "pairs", c->search_count);
    csg_parts_reset(&parts);
    for (size_t i = 0; i < c->pair_count; i++) {
        pair *p = &c->pairs[i];
        end_step(c, p);
        end_pose(c, p);
        p->told.gap_between = fmin(p->told.gap.low, p->between);
    }
    c->poses++;
    return status;
}

/* ---- results -----------------------------------------------------------------------------------
 */

const csgm_clear_pair *csg_clearances_get(const csgm_clearances *c, size_t index)
{
    return index < c->pair_count ? &c->pairs[index].told : NULL;
}

bool csg_clearances_part(const csgm_clearances *c, size_t index, const char **name)
{
    if (index >= c->part_count)
        return false;
    *name = c->parts[index].name;
    return true;
}

csgm_context *csg_clearances_context(const csgm_clearances *c)
{
    return c->context;
}

double csg_clearances_tolerance(const csgm_clearances *c)
{
    return c->tolerance;
}
