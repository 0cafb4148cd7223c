/* SPDX-License-Identifier: MIT
 * Dividing, sampling and balancing; see bricks.h. Every round divides a set of bricks in parallel;
 * their children are joined in the order of their parents.
 */
#include "grid/adaptive/bricks.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/trace.h"
#include "field/kernels/dispatch.h"
#include "grid/octree/octree.h"

enum { N = CSG_BRICK_SAMPLES, E = CSG_BRICK_EDGE, BRICKS_PER_ITEM = 8 };

/* Values at a brick's points, x fastest. */
typedef struct brick_samples {
    float x[CSG_BRICK_POINTS_PADDED], y[CSG_BRICK_POINTS_PADDED], z[CSG_BRICK_POINTS_PADDED];
    float f[CSG_BRICK_POINTS_PADDED];
} brick_samples;

/* One thread's part of a round. */
typedef struct csg_bricks_worker {
    csg_pruner pruner;
    csg_arena tapes;
    csg_brick *made;
    size_t count, capacity;
    brick_samples *samples;
    float *scratch;
    csg_bricks_stats stats;
    bool judges; /* the item at hand, which is not another rank's */
} worker;

typedef struct segment {
    uint32_t worker;
    size_t first, count;
} segment;

typedef struct round {
    csg_bricks *bricks;
    const uint32_t *queue;
    size_t queue_count;
    segment *segments; /* one per item */
    size_t done_before;
    bool shares; /* other ranks judge, too */
    atomic_bool out_of_memory;
} round_of_division;

/* ---- places ------------------------------------------------------------------------------------
 */

static uint64_t hash_of_place(uint32_t level, const uint32_t at[3])
{
    return csg_hash_word(level, csg_lattice_hash(at));
}

static uint64_t hash_of_brick(const void *entries, uint32_t number)
{
    const csg_brick *brick = (const csg_brick *)entries + number;
    return hash_of_place(brick->level, brick->at);
}

uint32_t csg_bricks_find(const csg_bricks *b, uint32_t level, const uint32_t at[3])
{
    size_t slot;
    uint32_t found = csg_table_first(&b->index, hash_of_place(level, at), &slot);
    while (found != CSG_TABLE_NONE &&
           (b->items[found].level != level ||
            memcmp(b->items[found].at, at, sizeof b->items[found].at) != 0))
        found = csg_table_next(&b->index, &slot);
    return found;
}

void csg_bricks_around(const csg_bricks *b, uint32_t number, uint32_t around[CSG_BRICKS_AROUND])
{
    const csg_brick *brick = &b->items[number];
    for (uint32_t d = 0; d < CSG_BRICKS_AROUND; d++) {
        const uint32_t at[3] = {brick->at[0] + d % 3 - 1, brick->at[1] + d / 3 % 3 - 1,
                                brick->at[2] + d / 9 - 1};
        around[d] = d == CSG_BRICKS_AROUND / 2 ? number : csg_bricks_find(b, brick->level, at);
    }
}

uint32_t csg_bricks_leaf_at(const csg_bricks *b, const float at[3])
{
    uint32_t cell[3];
    if (!csg_lattice_cell_of(b->lattice, at, cell))
        return CSG_BRICK_NONE;
    for (uint32_t level = b->options.coarse; level <= b->finest; level++) {
        uint32_t place[3], own[3];
        for (int axis = 0; axis < 3; axis++) {
            own[axis] = cell[axis] >> (b->finest - level);
            place[axis] = own[axis] / E;
        }
        uint32_t found = csg_bricks_find(b, level, place);
        if (found == CSG_BRICK_NONE || !(b->items[found].divided >> csg_brick_octant(own) & 1))
            return found;
    }
    return CSG_BRICK_NONE;
}

bool csg_bricks_have(const csg_bricks *b, const float at[3], bool inside)
{
    uint32_t cell[3], number = csg_bricks_leaf_at(b, at);
    if (number == CSG_BRICK_NONE || !csg_lattice_cell_of(b->lattice, at, cell))
        return true;
    const csg_brick *brick = &b->items[number];
    for (int axis = 0; axis < 3; axis++)
        cell[axis] >>= b->finest - brick->level;
    bool corner = brick->inside[cell[2] & 1][cell[1] & 1] >> (cell[0] & 1) & 1;
    return brick->crossed >> csg_brick_octant(cell) & 1 || corner == inside;
}

csg_tape csg_bricks_short_tape(const csg_bricks *b, const csg_brick *brick)
{
    csg_tape tape = b->field->tape;
    tape.nodes = brick->nodes;
    tape.count = brick->node_count;
    return tape;
}

csg_tape csg_bricks_tape(const csg_bricks *b, const csg_brick *brick)
{
    return b->options.prune ? csg_bricks_short_tape(b, brick) : b->field->tape;
}

float csg_bricks_band(const csg_bricks *b, uint32_t level)
{
    double edge = csg_bricks_cell(b, level) * b->lattice->cell_size;
    return (float)(2 * (double)b->field->tape.lipschitz *
                   (edge * (1 + 0x1p-10) + (double)csg_octree_rounding(b->lattice)));
}

uint8_t csg_brick_cells_at(const int from[3], const int to[3])
{
    unsigned cells = 0;
    for (unsigned cell = 0; cell < CSG_OCTANTS; cell++) {
        bool holds = true;
        for (int axis = 0; axis < 3; axis++) {
            int low = 2 * (int)(cell >> axis & 1);
            holds = holds && from[axis] >= low && to[axis] <= low + 2;
        }
        cells |= (unsigned)holds << cell;
    }
    return (uint8_t)cells;
}

void csg_brick_beside(const csg_brick *brick, unsigned part, uint32_t at[3])
{
    for (int axis = 0; axis < 3; axis++) {
        uint32_t step = brick->at[axis] & 1 ? 1u : UINT32_MAX;
        at[axis] = brick->at[axis] / 2 + (part >> axis & 1 ? step : 0);
    }
}

bool csg_brick_is_pierced(const csg_brick *brick, const unsigned from[3], const unsigned to[3])
{
    for (int axis = 0; axis < 3 && brick->pierced; axis++) {
        unsigned p[3], end[3] = {to[0] + 1, to[1] + 1, to[2] + 1};
        end[axis]--;
        for (p[2] = from[2]; p[2] < end[2]; p[2]++)
            for (p[1] = from[1]; p[1] < end[1]; p[1]++)
                for (p[0] = from[0]; p[0] < end[0]; p[0]++)
                    if (brick->pierced >> csg_brick_edge(axis, p) & 1)
                        return true;
    }
    return false;
}

/* ---- one brick ---------------------------------------------------------------------------------
 */

/* All of its points; those on the border of the lattice are outside by decree. */
static void sample(csg_bricks *b, worker *self, csg_brick *brick)
{
    brick_samples *s = self->samples;
    float line[3][N];
    bool border[3][N];
    for (int axis = 0; axis < 3; axis++)
        for (uint32_t i = 0; i < N; i++) {
            uint32_t index = csg_brick_point(b, brick, axis, i);
            line[axis][i] = csg_lattice_coordinate(b->lattice, axis, index);
            border[axis][i] = index == 0 || index >= b->lattice->cells[axis];
        }
    for (int i = 0; i < CSG_BRICK_POINTS_PADDED; i++) {
        int p = i < CSG_BRICK_POINTS ? i : 0;
        s->x[i] = line[0][p % N], s->y[i] = line[1][p / N % N], s->z[i] = line[2][p / (N * N)];
    }
    csg_tape tape = csg_bricks_tape(b, brick);
    b->kernel->values(&tape, s->x, s->y, s->z, CSG_BRICK_POINTS, s->f, self->scratch,
                      csg_kernel_scratch_floats(b->field->depth));
    memset(brick->inside, 0, sizeof brick->inside);
    for (int k = 0; k < N; k++)
        for (int j = 0; j < N; j++)
            for (int i = 0; i < N; i++) {
                bool outer = border[0][i] || border[1][j] || border[2][k];
                bool inside = s->f[(k * N + j) * N + i] >= 0 && !outer;
                brick->inside[k][j] |= (uint8_t)((unsigned)inside << i);
            }
    brick->crossed = 0;
    for (unsigned k = 0; k < E; k++)
        for (unsigned j = 0; j < E; j++)
            for (unsigned i = 0; i < E; i++) {
                unsigned pattern = csg_brick_pattern(brick, i, j, k);
                if (pattern != 0 && pattern != 0xFF)
                    brick->crossed |= (uint8_t)(1u << csg_brick_cell(i, j, k));
            }
    self->stats.sampled++;
    self->stats.point_evaluations += CSG_BRICK_POINTS;
    self->stats.primitive_evaluations += (uint64_t)CSG_BRICK_POINTS * csg_tape_leaf_count(&tape);
}

static bool is_in_lattice(const csg_bricks *b, uint32_t level, const uint32_t at[3])
{
    for (int axis = 0; axis < 3; axis++)
        if ((uint64_t)at[axis] * E << (b->finest - level) >= b->lattice->cells[axis])
            return false;
    return true;
}

static bool make_child(csg_bricks *b, uint32_t worker_index, const csg_brick *parent, int octant)
{
    worker *self = &b->workers[worker_index];
    csg_brick child = {.level = (uint8_t)(parent->level + 1),
                       .wanted = CSG_BRICK_ALL_CELLS,
                       .searched = parent->searched >> octant & 1 ? CSG_BRICK_ALL_CELLS : 0};
    for (int axis = 0; axis < 3; axis++)
        child.at[axis] = 2 * parent->at[axis] + (uint32_t)(octant >> axis & 1);
    if (!is_in_lattice(b, child.level, child.at))
        return true;
    self->stats.visited++;
    csg_cell_state state = csg_prune_state(&self->pruner, octant);
    self->stats.pruned_outside += state == CSG_CELL_OUTSIDE;
    self->stats.pruned_inside += state == CSG_CELL_INSIDE;
    if (state != CSG_CELL_SURFACE)
        return true;
    csg_tape tape = csg_bricks_short_tape(b, parent);
    uint32_t level = child.level > b->options.coarse ? child.level : b->options.coarse;
    if (!csg_prune_shorten(&self->pruner, octant, csg_bricks_band(b, level), &self->tapes, &tape) ||
        !csg_memory_reserve(&b->context->memory, (void **)&self->made, &self->capacity,
                            self->count + 1, sizeof child))
        return false;
    child.nodes = tape.nodes;
    child.node_count = tape.count;
    if (child.level >= b->options.coarse && self->judges) {
        sample(b, self, &child);
        if (!b->options.judge(b->options.judge_user, worker_index, b, &child, self->samples->f))
            return false;
    }
    self->made[self->count++] = child;
    return true;
}

/* Cells that are to be divided and are not. */
static uint8_t new_cells(const csg_brick *brick)
{
    return (uint8_t)(brick->wanted & ~brick->divided);
}

static bool divide(csg_bricks *b, uint32_t worker_index, const csg_brick *parent)
{
    worker *self = &b->workers[worker_index];
    csg_tape tape = csg_bricks_short_tape(b, parent);
    float c[3][CSG_OCTANTS];
    uint32_t half = (uint32_t)(E / 2) * csg_bricks_cell(b, parent->level); /* of the parent */
    for (int octant = 0; octant < CSG_OCTANTS; octant++)
        for (int axis = 0; axis < 3; axis++) {
            uint32_t first = csg_brick_point(b, parent, axis, 0);
            uint32_t at = first + (octant >> axis & 1 ? half : 0);
            c[axis][octant] = csg_lattice_coordinate(b->lattice, axis, at) +
                              (float)(0.5 * half * b->lattice->cell_size);
        }
    double reach = 0.5 * half * b->lattice->cell_size + (double)csg_octree_rounding(b->lattice);
    float radius = (float)(reach * (sqrt(3.0) * (1 + 8 * (double)FLT_EPSILON)));
    if (!csg_prune_octants(&self->pruner, &tape, c[0], c[1], c[2], radius))
        return false;
    self->stats.interval_evaluations += CSG_OCTANTS;
    self->stats.primitive_evaluations += (uint64_t)CSG_OCTANTS * csg_tape_leaf_count(&tape);
    for (int octant = 0; octant < CSG_OCTANTS; octant++)
        if (new_cells(parent) >> octant & 1 && !make_child(b, worker_index, parent, octant))
            return false;
    return true;
}

/* ---- one round ---------------------------------------------------------------------------------
 */

static bool divide_item(void *user, uint32_t worker_index, size_t item)
{
    round_of_division *r = user;
    csg_bricks *b = r->bricks;
    worker *self = &b->workers[worker_index];
    if (b->options.cancelled && b->options.cancelled(b->options.user))
        return false;
    segment *s = &r->segments[item];
    *s = (segment){worker_index, self->count, 0};
    self->judges = !r->shares || csg_ranks_have(b->context, item);
    size_t end = (item + 1) * BRICKS_PER_ITEM;
    for (size_t i = item * BRICKS_PER_ITEM; i < end && i < r->queue_count; i++)
        if (!divide(b, worker_index, &b->items[r->queue[i]])) {
            atomic_store(&r->out_of_memory, true);
            return false;
        }
    s->count = self->count - s->first;
    return true;
}

static void report(void *user, size_t done, size_t count)
{
    round_of_division *r = user;
    csg_bricks *b = r->bricks;
    /* how many rounds there will be nobody knows: the share of what is known by now */
    double all = (double)(r->done_before + count);
    double fraction = 0.9 * ((double)(r->done_before + done) / all);
    if (b->options.progress && fraction > b->reported) {
        b->reported = fraction;
        b->options.progress(b->options.user, fraction);
    }
}

/* What ranks tell each other of a brick that is judged; tapes each has shortened for itself, since
 * they may hold on to shapes. */
typedef struct brick_record {
    uint64_t pierced;
    uint8_t wanted, searched, crossed, flat, several;
    uint8_t inside[N][N];
} brick_record;

static bool tell(const csg_bricks *b, const csg_brick *brick, csg_records *records)
{
    brick_record own = {.pierced = brick->pierced,
                        .wanted = brick->wanted,
                        .searched = brick->searched,
                        .crossed = brick->crossed,
                        .flat = brick->flat,
                        .several = brick->several};
    memcpy(own.inside, brick->inside, sizeof own.inside);
    return csg_records_add(&b->context->memory, records, &own, sizeof own) &&
           (!b->options.tell || b->options.tell(b->options.judge_user, brick, records));
}

static bool hear(const csg_bricks *b, csg_brick *brick, csg_record_reader *reader, size_t item)
{
    brick_record own;
    csg_record_read(reader, item, &own, sizeof own);
    brick->pierced = own.pierced;
    brick->wanted = own.wanted;
    brick->searched = own.searched;
    brick->crossed = own.crossed;
    brick->flat = own.flat;
    brick->several = own.several;
    memcpy(brick->inside, own.inside, sizeof own.inside);
    return !b->options.hear || b->options.hear(b->options.judge_user, brick, reader, item);
}

/* Tells of the bricks of an item, or hears. False: out of memory. */
static bool pass_on(const round_of_division *r, size_t item, csg_records *told,
                    csg_record_reader *heard)
{
    const csg_bricks *b = r->bricks;
    const segment *s = &r->segments[item];
    bool done = true;
    for (size_t i = s->first; i < s->first + s->count && done; i++) {
        csg_brick *brick = &b->workers[s->worker].made[i];
        if (brick->level >= b->options.coarse)
            done = told ? tell(b, brick, told) : hear(b, brick, heard, item);
    }
    return done;
}

/* What each rank has judged, to all. */
static csgm_status exchange_bricks(const round_of_division *r, size_t items, csgm_status own)
{
    csgm_context *context = r->bricks->context;
    csg_records records = {0};
    csg_record_reader reader;
    for (size_t i = 0; i < items && own == CSGM_OK; i++)
        if (csg_ranks_have(context, i) && !pass_on(r, i, &records, NULL))
            own = csg_context_no_memory(context);
    csgm_status status = csg_ranks_exchange(context, own, items, &records, &reader);
    for (size_t i = 0; i < items && status == CSGM_OK; i++)
        if (!csg_ranks_have(context, i) && !pass_on(r, i, NULL, &reader))
            status = csg_context_no_memory(context);
    csg_record_reader_end(&context->memory, &reader);
    return status;
}

/* The children into the array and the index, in the order of the queue. */
static bool join_children(round_of_division *r, size_t items)
{
    csg_bricks *b = r->bricks;
    size_t total = 0, first = b->count;
    for (size_t i = 0; i < items; i++)
        total += r->segments[i].count;
    if (!csg_memory_reserve(&b->context->memory, (void **)&b->items, &b->capacity,
                            b->count + total + 1, sizeof *b->items) ||
        !csg_table_reserve(&b->index, b->count + total + 1, hash_of_brick, b->items))
        return false;
    for (size_t i = 0; i < items; i++) {
        const segment *s = &r->segments[i];
        for (size_t k = 0; k < s->count; k++) {
            b->items[b->count] = b->workers[s->worker].made[s->first + k];
            csg_table_add(&b->index, hash_of_brick(b->items, (uint32_t)b->count),
                          (uint32_t)b->count);
            b->count++;
        }
    }
    for (size_t i = 0; i < r->queue_count; i++) {
        b->items[r->queue[i]].divided |= b->items[r->queue[i]].wanted;
        b->items[r->queue[i]].wanted = 0;
    }
    for (uint32_t i = 0; i < b->worker_count; i++)
        b->workers[i].count = 0;
    return !b->options.joined || b->options.joined(b->options.judge_user, b, first);
}

static csgm_status divide_all(csg_bricks *b, const uint32_t *queue, size_t count)
{
    size_t items = (count + BRICKS_PER_ITEM - 1) / BRICKS_PER_ITEM;
    round_of_division r = {
        .bricks = b, .queue = queue, .queue_count = count, .done_before = b->count / 8};
    r.segments = csg_memory_alloc(&b->context->memory, (items + 1) * sizeof(segment));
    if (!r.segments)
        return csg_context_no_memory(b->context);
    r.shares = csg_ranks_share(b->context, items, CSG_ITEMS_SMALL);
    csgm_status status = CSGM_OK;
    if (!csg_pool_run(b->context->pool, items, divide_item, report, &r))
        status = atomic_load(&r.out_of_memory) ? csg_context_no_memory(b->context)
                 : b->options.why              ? b->options.why(b->options.user)
                                               : CSGM_CANCELLED;
    if (r.shares)
        status = exchange_bricks(&r, items, status);
    if (status == CSGM_OK && !join_children(&r, items))
        status = csg_context_no_memory(b->context);
    csg_memory_release(&b->context->memory, r.segments, (items + 1) * sizeof(segment));
    return status;
}

/* ---- balance -----------------------------------------------------------------------------------
 */

/* Whether the surface crosses what a brick shares with the bricks of csg_brick_beside: a side, an
 * edge or a corner of it. */
static bool is_crossed_beside(const csg_brick *brick, unsigned part)
{
    unsigned low[3], high[3];
    bool any_inside = false, any_outside = false;
    for (int axis = 0; axis < 3; axis++) {
        bool beyond = part >> axis & 1;
        low[axis] = beyond ? E * (brick->at[axis] & 1) : 0;
        high[axis] = beyond ? low[axis] : E;
    }
    for (unsigned k = low[2]; k <= high[2]; k++)
        for (unsigned j = low[1]; j <= high[1]; j++)
            for (unsigned i = low[0]; i <= high[0]; i++) {
                bool inside = brick->inside[k][j] >> i & 1;
                any_inside = any_inside || inside;
                any_outside = any_outside || !inside;
            }
    return (any_inside && any_outside) || csg_brick_is_pierced(brick, low, high);
}

/* Wants every leaf divided that the surface reaches from this brick and that is larger than its
 * cells by more than one level: around the cube that it is an octant of, on its own sides, there
 * must be bricks of that level, or no surface. Where none crosses what both share, neither has a
 * vertex there, and the sizes do not matter. True: there was one, whose children may still be too
 * large. */
static bool want_balance(csg_bricks *b, const csg_brick *brick)
{
    bool any = false;
    if (brick->level < b->options.coarse + 2)
        return false;
    for (unsigned part = 1; part < CSG_OCTANTS; part++) {
        uint32_t at[3], level = brick->level - 1u, found;
        if (!is_crossed_beside(brick, part))
            continue;
        unsigned octant = 0; /* of the brick at hand, the way was down */
        csg_brick_beside(brick, part, at);
        while ((found = csg_bricks_find(b, level, at)) == CSG_BRICK_NONE &&
               level > b->options.coarse) {
            octant = csg_brick_octant(at);
            level--;
            for (int axis = 0; axis < 3; axis++)
                at[axis] /= 2;
        }
        if (found != CSG_BRICK_NONE && level + 1 < brick->level &&
            !(b->items[found].divided >> octant & 1)) {
            b->items[found].wanted |= (uint8_t)(1u << octant);
            any = true;
        }
    }
    return any;
}

/* The numbers of bricks for which something is to be done. */
typedef struct list {
    uint32_t *number;
    size_t count, capacity;
} list;

static bool append(csg_bricks *b, list *l, size_t number)
{
    if (!csg_memory_reserve(&b->context->memory, (void **)&l->number, &l->capacity, l->count + 1,
                            sizeof *l->number))
        return false;
    l->number[l->count++] = (uint32_t)number;
    return true;
}

/* Takes the bricks from `first` on that have cells to be divided. */
static bool collect(csg_bricks *b, list *wanted, size_t first)
{
    for (size_t i = first; i < b->count; i++)
        if (new_cells(&b->items[i]) && !append(b, wanted, i))
            return false;
    return true;
}

/* Wants what the bricks listed and those from *seen on ask for; those that asked stay listed. */
static bool balance(csg_bricks *b, list *unbalanced, size_t *seen)
{
    size_t kept = 0;
    for (; *seen < b->count; ++*seen)
        if (!append(b, unbalanced, *seen))
            return false;
    for (size_t i = 0; i < unbalanced->count; i++) {
        uint32_t number = unbalanced->number[i];
        if (csg_brick_has_leaves(&b->items[number]) && want_balance(b, &b->items[number]))
            unbalanced->number[kept++] = number;
    }
    unbalanced->count = kept;
    return true;
}

/* The last round's are the most, and as much as all bricks take: whoever goes on has use for it. */
static void forget_made(worker *w, csg_memory *memory)
{
    csg_memory_release(memory, w->made, w->capacity * sizeof *w->made);
    w->made = NULL;
    w->capacity = 0;
}

csgm_status csg_bricks_refine(csg_bricks *b)
{
    CSG_ZONE(b->context, "refinement");
    list wanted = {0}, unbalanced = {0};
    csgm_status status = CSGM_OK;
    size_t fresh = 0; /* the first brick that was not asked what it wants */
    for (bool any = true; any && status == CSGM_OK;) {
        wanted.count = 0;
        bool done = collect(b, &wanted, fresh);
        fresh = b->count;
        if (done && !wanted.count) {
            done = balance(b, &unbalanced, &b->balanced);
            done = done && (!unbalanced.count || collect(b, &wanted, 0));
        }
        any = wanted.count > 0;
        status = !done ? csg_context_no_memory(b->context)
                 : any ? divide_all(b, wanted.number, wanted.count)
                       : CSGM_OK;
        if (status == CSGM_OK && b->count > b->options.most)
            status = CSGM_ERR_LIMIT;
    }
    csg_memory_release(&b->context->memory, wanted.number, wanted.capacity * sizeof *wanted.number);
    csg_memory_release(&b->context->memory, unbalanced.number,
                       unbalanced.capacity * sizeof *unbalanced.number);
    for (uint32_t i = 0; i < b->worker_count; i++) {
        const csg_bricks_stats *part = &b->workers[i].stats;
        b->stats.visited += part->visited;
        b->stats.pruned_outside += part->pruned_outside;
        b->stats.pruned_inside += part->pruned_inside;
        b->stats.sampled += part->sampled;
        b->stats.interval_evaluations += part->interval_evaluations;
        b->stats.point_evaluations += part->point_evaluations;
        b->stats.primitive_evaluations += part->primitive_evaluations;
        b->workers[i].stats = (csg_bricks_stats){0};
        forget_made(&b->workers[i], &b->context->memory);
    }
    return status;
}

/* ---- beginning and end -------------------------------------------------------------------------
 */

csgm_status csg_bricks_create(csgm_context *context, const csgm_field *field,
                              const csg_lattice *lattice, const csg_bricks_options *options,
                              csg_bricks *out)
{
    csg_memory *memory = &context->memory;
    uint32_t most = 1;
    for (int axis = 0; axis < 3; axis++)
        most = lattice->cells[axis] > most ? lattice->cells[axis] : most;
    *out = (csg_bricks){.context = context,
                        .field = field,
                        .kernel = csg_kernel_for(context->isa),
                        .lattice = lattice,
                        .options = *options,
                        .worker_count = csg_pool_threads(context->pool)};
    while ((uint32_t)E << out->finest < most)
        out->finest++;
    csg_table_init(&out->index, memory);
    out->workers = csg_memory_alloc(memory, out->worker_count * sizeof(worker));
    bool done = out->workers != NULL;
    if (done)
        memset(out->workers, 0, out->worker_count * sizeof(worker));
    for (uint32_t i = 0; i < out->worker_count && done; i++) {
        worker *w = &out->workers[i];
        csg_pruner_init(&w->pruner, memory, out->kernel, csg_octree_rounding(lattice));
        csg_arena_init(&w->tapes, memory);
        w->samples = csg_memory_alloc(memory, sizeof *w->samples);
        w->scratch =
            csg_memory_alloc(memory, csg_kernel_scratch_floats(field->depth) * sizeof(float));
        done = w->samples && w->scratch;
    }
    done = done &&
           csg_memory_reserve(memory, (void **)&out->items, &out->capacity, 1, sizeof(csg_brick)) &&
           csg_table_reserve(&out->index, 1, NULL, NULL);
    if (!done) {
        csg_bricks_destroy(out);
        return csg_context_no_memory(context);
    }
    out->items[out->count++] = (csg_brick){
        .nodes = field->tape.nodes, .node_count = field->tape.count, .wanted = CSG_BRICK_ALL_CELLS};
    csg_table_add(&out->index, hash_of_brick(out->items, 0), 0);
    return CSGM_OK;
}

void csg_bricks_destroy(csg_bricks *b)
{
    if (!b->context)
        return;
    csg_memory *memory = &b->context->memory;
    for (uint32_t i = 0; b->workers && i < b->worker_count; i++) {
        worker *w = &b->workers[i];
        if (!w->pruner.memory) /* creation ended before */
            continue;
        csg_pruner_release(&w->pruner);
        csg_arena_reset(&w->tapes);
        forget_made(w, memory);
        csg_memory_release(memory, w->samples, sizeof *w->samples);
        csg_memory_release(memory, w->scratch,
                           csg_kernel_scratch_floats(b->field->depth) * sizeof(float));
    }
    csg_memory_release(memory, b->workers, b->worker_count * sizeof(worker));
    csg_memory_release(memory, b->items, b->capacity * sizeof *b->items);
    csg_table_release(&b->index);
    *b = (csg_bricks){0};
}

typedef struct placed {
    uint32_t brick, point[3];
} placed;

static int compare_placed(const void *a, const void *b)
{
    const placed *p = a, *q = b;
    int order = csg_lattice_compare_morton(p->point, q->point);
    /* a brick, and one in the place of its first cell */
    return order ? order : (p->brick > q->brick) - (p->brick < q->brick);
}

bool csg_bricks_leaves(const csg_bricks *b, uint32_t **out, size_t *count)
{
    csg_memory *memory = &b->context->memory;
    size_t n = 0, capacity = b->count;
    placed *leaves = csg_memory_alloc(memory, capacity * sizeof *leaves);
    *out = NULL;
    *count = 0;
    if (!leaves)
        return false;
    for (size_t i = 0; i < b->count; i++)
        if (csg_brick_has_leaves(&b->items[i])) {
            leaves[n].brick = (uint32_t)i;
            for (int axis = 0; axis < 3; axis++)
                leaves[n].point[axis] = csg_brick_point(b, &b->items[i], axis, 0);
            n++;
        }
    qsort(leaves, n, sizeof *leaves, compare_placed);
    *out = n ? csg_memory_alloc(memory, n * sizeof **out) : NULL;
    for (size_t i = 0; *out && i < n; i++)
        (*out)[i] = leaves[i].brick;
    *count = *out ? n : 0;
    csg_memory_release(memory, leaves, capacity * sizeof *leaves);
    return n == *count;
}
