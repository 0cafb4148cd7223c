/* SPDX-License-Identifier: MIT
 * Triangles by cells; see near.h.
 */
#include "mesh/features/near.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "mesh/features/fan.h"

enum { E = CSG_BLOCK_EDGE };

/* ---- a block and what lies around --------------------------------------------------------------
 */

/* Cells count from `first`, eight blocks wide. */
typedef struct view {
    const csg_near *near;
    csg_near_room *room;
    const csg_feature_block *block;
    int first[3];
} view;

enum { VIEW_CELLS = CSG_NEAR_VIEW, VIEW_BEFORE = 24, ITSELF = 13 };

static view view_of(const csg_near *near, csg_near_room *room, size_t block)
{
    view v = {.near = near, .room = room, .block = &near->store->blocks[block]};
    for (int axis = 0; axis < 3; axis++)
        v.first[axis] = (int)v.block->at[axis] * E - VIEW_BEFORE;
    return v;
}

static void cell_of(const csg_feature_block *block, const csg_feature *f, int out[3])
{
    for (int axis = 0; axis < 3; axis++)
        out[axis] = (int)block->at[axis] * E + (f->cell >> (3 * axis) & 7);
}

/* The block of a feature; `guess` is it most of the time. */
static const csg_feature_block *block_of(const csg_feature_store *store,
                                         const csg_feature_block *guess, uint32_t i)
{
    if (i >= guess->first && i < guess->first + guess->count)
        return guess;
    size_t low = 0, high = store->block_count;
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        if (store->blocks[middle].first <= i)
            low = middle;
        else
            high = middle;
    }
    return &store->blocks[low];
}

const csg_feature_block *csg_near_block(const csg_feature_store *store,
                                        const csg_feature_block *block, int k)
{
    const int step[3] = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
    uint32_t at[3];
    for (int axis = 0; axis < 3; axis++) {
        if (step[axis] < 0 && !block->at[axis])
            return NULL;
        at[axis] = block->at[axis] + (uint32_t)step[axis];
    }
    return csg_feature_store_find(store, at);
}

/* ---- boxes -------------------------------------------------------------------------------------
 */

static const csg_near_box NOWHERE = {{INFINITY, INFINITY, INFINITY},
                                     {-INFINITY, -INFINITY, -INFINITY}};

static void include(csg_near_box *box, const float low[3], const float high[3])
{
    for (int axis = 0; axis < 3; axis++) {
        box->low[axis] = low[axis] < box->low[axis] ? low[axis] : box->low[axis];
        box->high[axis] = high[axis] > box->high[axis] ? high[axis] : box->high[axis];
    }
}

static void set_box(csg_near_triangle *t)
{
    t->box = NOWHERE;
    for (int c = 0; c < 3; c++)
        include(&t->box, t->shape.at[c], t->shape.at[c]);
}

/* Whether two boxes come within `reach` of each other along each axis. */
static bool overlap(const csg_near_box *a, const csg_near_box *b, float reach)
{
    bool apart = false;
    for (int axis = 0; axis < 3; axis++)
        apart =
            apart || a->low[axis] - reach > b->high[axis] || b->low[axis] - reach > a->high[axis];
    return !apart;
}

/* ---- triangles of features ---------------------------------------------------------------------
 */

#define APEX 0x80000000u /* vertex numbers of apexes; others are of lattice edges near a block */

static uint32_t number_of_edge(const view *v, const int cell[3], unsigned edge)
{
    enum { WRAP = 2 * VIEW_CELLS };
    const uint8_t *offset = v->near->marching->tables->offset[edge];
    uint32_t number = edge / 4;
    for (int axis = 0; axis < 3; axis++)
        number = number * WRAP + ((uint32_t)(cell[axis] + offset[axis] - v->first[axis]) % WRAP);
    return number;
}

/* Whether a crossed edge of a cell lies in the face to the cell beside it. */
static bool is_in_face(const csg_cell_tables *tables, uint8_t edge, const int cell[3],
                       const int beside[3])
{
    for (int axis = 0; axis < 3; axis++)
        if (cell[axis] != beside[axis])
            return tables->faces[edge] >> (2 * axis + (beside[axis] > cell[axis])) & 1;
    return false;
}

enum { FAN_UNKNOWN, FAN_NO, FAN_YES };

/* Threads may find it twice; they find the same. */
static bool is_fan(const csg_near *near, uint32_t i)
{
    int known = atomic_load_explicit(&near->fans[i], memory_order_relaxed);
    if (known == FAN_UNKNOWN) {
        known = csg_fan_is_clear(near->store, near->marching, i) ? FAN_YES : FAN_NO;
        atomic_store_explicit(&near->fans[i], (unsigned char)known, memory_order_relaxed);
    }
    return known == FAN_YES;
}

static void triangle_of(const view *v, const csg_feature_block *block, uint32_t i, int index,
                        csg_near_triangle *t)
{
    const csg_feature_store *store = v->near->store;
    const csg_marching *m = v->near->marching;
    const csg_feature *f = &store->features[i];
    csg_fan_corner corners[3];
    int cell[3], beside[3];
    bool with_apex = false, in_face = false, moved = false;
    csg_feature_triangle(store, f, index, corners);
    cell_of(block, f, cell);
    *t = (csg_near_triangle){.owner = {i, i}, .own = block == v->block};
    for (int c = 0; c < 3; c++) {
        const csg_feature *apex = corners[c].apex;
        if (!apex)
            continue;
        uint32_t owner = (uint32_t)(apex - store->features);
        csg_marching_shift(m, apex->at, t->shape.at[c]);
        t->shape.vertex[c] = APEX | owner;
        with_apex = with_apex || apex == f;
        t->owner[1] = apex != f ? owner : t->owner[1];
    }
    cell_of(block_of(store, block, t->owner[1]), &store->features[t->owner[1]], beside);
    for (int c = 0; c < 3; c++) {
        if (corners[c].apex)
            continue;
        int k = 0;
        while (f->side[k].edge != corners[c].edge)
            k++;
        csg_marching_shift(m, f->side[k].corner, t->shape.at[c]);
        t->shape.vertex[c] = number_of_edge(v, cell, corners[c].edge);
        moved = moved || corners[c].at;
        in_face = in_face || is_in_face(m->tables, corners[c].edge, cell, beside);
    }
    t->plain = !moved && (t->owner[1] == i || (with_apex && in_face));
    for (int k = 0; k < 2; k++)
        t->fan[k] = is_fan(v->near, t->owner[k]) ? APEX | t->owner[k] : 0;
    set_box(t);
}

/* ---- where they are ----------------------------------------------------------------------------
 */

/* In cells, from the lattice's lowest point. */
static double place_of(const csg_marching *m, float x, int axis)
{
    const double origin[3] = {m->lattice->origin.x, m->lattice->origin.y, m->lattice->origin.z};
    const double shift[3] = {m->shift.x, m->shift.y, m->shift.z};
    return ((double)x - shift[axis] - origin[axis]) / m->lattice->cell_size;
}

/* Away from the faces of a cell: further than any rounding of floats. */
static const double CLEAR = 1e-4;

static bool is_in_cell(const csg_marching *m, const float *at, const int cell[3])
{
    bool in = true;
    for (int axis = 0; axis < 3; axis++) {
        double x = place_of(m, at[axis], axis) - cell[axis];
        in = in && x > CLEAR && x < 1 - CLEAR;
    }
    return in;
}

/* The segment between two apexes goes through the face between their cells. */
static bool goes_through_face(const csg_marching *m, const float *p, const float *q, const int a[3],
                              const int b[3])
{
    int axis = a[0] != b[0] ? 0 : a[1] != b[1] ? 1 : 2;
    double from = place_of(m, p[axis], axis), to = place_of(m, q[axis], axis);
    double t = ((a[axis] > b[axis] ? a[axis] : b[axis]) - from) / (to - from);
    for (int i = 0; i < 3; i++) {
        double x = place_of(m, p[i], i), y = place_of(m, q[i], i), at = x + t * (y - x) - a[i];
        if (i != axis && !(at > CLEAR && at < 1 - CLEAR))
            return false;
    }
    return true;
}

/* Whether it stays in its cell, or in its and the one next door. */
static bool stays_home(const view *v, const csg_near_triangle *t, const int home[3],
                       const int other[3])
{
    const csg_marching *m = v->near->marching;
    float at[2][3];
    if (!t->plain)
        return false;
    for (int c = 0; c < 3; c++)
        if (t->shape.vertex[c] & APEX &&
            !is_in_cell(m, t->shape.at[c],
                        t->shape.vertex[c] == (APEX | t->owner[0]) ? home : other))
            return false;
    if (t->owner[0] == t->owner[1])
        return true;
    for (int k = 0; k < 2; k++)
        csg_marching_shift(m, v->near->store->features[t->owner[k]].at, at[k]);
    return goes_through_face(m, at[0], at[1], home, other);
}

/* The cells that it can meet anything in, from low to high, both included. False: it stays home. */
static bool cells_of(const view *v, const csg_feature_block *block, const csg_near_triangle *t,
                     int low[3], int high[3])
{
    const csg_feature_store *store = v->near->store;
    int home[3], other[3];
    cell_of(block, &store->features[t->owner[0]], home);
    cell_of(block_of(store, block, t->owner[1]), &store->features[t->owner[1]], other);
    bool stays = stays_home(v, t, home, other);
    for (int axis = 0; axis < 3; axis++) {
        if (stays) {
            low[axis] = home[axis] < other[axis] ? home[axis] : other[axis];
            high[axis] = home[axis] > other[axis] ? home[axis] : other[axis];
            continue;
        }
        double least = INFINITY, most = -INFINITY;
        for (int c = 0; c < 3; c++) {
            double x = place_of(v->near->marching, t->shape.at[c][axis], axis);
            least = fmin(least, x);
            most = fmax(most, x);
        }
        low[axis] = (int)floor(least - 10 * CLEAR);
        high[axis] = (int)floor(most + 10 * CLEAR);
    }
    return !stays;
}

/* Own triangles come first; others are of interest where these are. */
static bool is_of_interest(csg_near_room *room, uint32_t cell, bool own)
{
    uint64_t *word = &room->own_cells[cell / 64], bit = (uint64_t)1 << cell % 64;
    *word |= own ? bit : 0;
    return *word & bit;
}

static bool enter_cells(const view *v, const int low[3], const int high[3], uint32_t triangle)
{
    csg_near_room *room = v->room;
    bool own = room->triangles[triangle].own;
    int from[3], to[3];
    for (int axis = 0; axis < 3; axis++) {
        from[axis] = low[axis] > v->first[axis] ? low[axis] - v->first[axis] : 0;
        to[axis] = high[axis] - v->first[axis];
        to[axis] = to[axis] < VIEW_CELLS ? to[axis] : VIEW_CELLS - 1;
    }
    for (int z = from[2]; z <= to[2]; z++)
        for (int y = from[1]; y <= to[1]; y++)
            for (int x = from[0]; x <= to[0]; x++) {
                uint32_t cell = (uint32_t)((z * VIEW_CELLS + y) * VIEW_CELLS + x);
                if (!is_of_interest(room, cell, own))
                    continue;
                if (!csg_memory_reserve(v->near->memory, (void **)&room->places,
                                        &room->place_capacity, room->place_count + 1,
                                        sizeof *room->places))
                    return false;
                room->places[room->place_count++] = (uint64_t)cell << 32 | triangle;
            }
    return true;
}

/* ---- collecting --------------------------------------------------------------------------------
 */

/* Of all its triangles' corners. */
static csg_near_box box_of(const csg_near *near, const csg_feature *f)
{
    csg_near_box box = NOWHERE;
    uint64_t seen[4] = {0}; /* by what a triangle calls a corner, a bit each */
    for (int k = 0; k < csg_feature_triangle_count(f); k++)
        for (int c = 0; c < 3; c++) {
            uint8_t t = f->triangle[k][c];
            if (seen[t / 64] >> t % 64 & 1)
                continue;
            seen[t / 64] |= (uint64_t)1 << t % 64;
            const csg_feature *apex =
                t == CSG_FEATURE_APEX ? f
                : t >= CSG_FEATURE_BEYOND
                    ? &near->store->features[f->side[t - CSG_FEATURE_BEYOND].beyond]
                    : NULL;
            float at[3];
            csg_marching_shift(near->marching, apex ? apex->at : f->side[t].corner, at);
            include(&box, at, at);
        }
    return box;
}

void csg_near_measure(const csg_near *near, size_t index)
{
    const csg_feature_block *block = &near->store->blocks[index];
    for (uint32_t i = block->first; i < block->first + block->count; i++) {
        near->boxes[i] = box_of(near, &near->store->features[i]);
        atomic_store_explicit(&near->fans[i], FAN_UNKNOWN, memory_order_relaxed);
    }
}

csg_near_box csg_near_box_of_block(const csg_near *near, size_t index)
{
    const csg_feature_block *block = &near->store->blocks[index];
    csg_near_box box = NOWHERE;
    for (uint32_t i = block->first; i < block->first + block->count; i++)
        include(&box, near->boxes[i].low, near->boxes[i].high);
    return box;
}

/* Where triangles that are far from their cells must keep apart. */
static float reach_of(const csg_near *near)
{
    return 2 * near->marching->unit;
}

bool csg_near_reaches(const csg_near *near, uint32_t feature, const csg_near_box *box)
{
    const csg_feature *f = &near->store->features[feature];
    bool reaches = overlap(&near->boxes[feature], box, reach_of(near));
    for (int s = 0; s < f->side_count && !reaches; s++)
        reaches = f->side[s].beyond != CSG_FEATURE_NONE &&
                  overlap(&near->boxes[f->side[s].beyond], box, reach_of(near));
    return reaches;
}

static bool add_triangle(const view *v, const csg_feature_block *block, const csg_near_triangle *t)
{
    csg_near_room *room = v->room;
    int low[3], high[3];
    if (!csg_memory_reserve(v->near->memory, (void **)&room->triangles, &room->capacity,
                            room->count + 1, sizeof *room->triangles))
        return false;
    room->triangles[room->count] = *t;
    room->triangles[room->count].far = cells_of(v, block, t, low, high);
    return enter_cells(v, low, high, (uint32_t)room->count++);
}

/* Of one block those that reach into a box (NULL: all). */
static bool add_block(const view *v, const csg_feature_block *block, const csg_near_box *within)
{
    const csg_near *near = v->near;
    for (uint32_t i = block->first; i < block->first + block->count; i++) {
        if (within && !overlap(within, &near->boxes[i], 0))
            continue;
        for (int index = 0; index < csg_feature_triangle_count(&near->store->features[i]);
             index++) {
            csg_near_triangle t;
            triangle_of(v, block, i, index, &t);
            if ((!within || overlap(within, &t.box, 0)) && !add_triangle(v, block, &t))
                return false;
        }
    }
    return true;
}

/* By cells. Triangles were entered in their order, and stay in it. False: out of memory. */
static bool sort_places(const view *v)
{
    enum { DIGIT_BITS = 9, DIGITS = 1 << DIGIT_BITS, PASSES = 2 /* VIEW_CELLS^3 is 2^18 */ };
    csg_near_room *room = v->room;
    size_t count = room->place_count;
    if (!csg_memory_reserve(v->near->memory, (void **)&room->sorted, &room->sorted_capacity, count,
                            sizeof *room->sorted))
        return false;
    uint64_t *from = room->places, *to = room->sorted;
    for (int pass = 0; pass < PASSES; pass++) {
        size_t starts[DIGITS + 1] = {0};
        int shift = 32 + pass * DIGIT_BITS;
        for (size_t i = 0; i < count; i++)
            starts[(from[i] >> shift) % DIGITS + 1]++;
        for (size_t i = 0; i < DIGITS; i++)
            starts[i + 1] += starts[i];
        for (size_t i = 0; i < count; i++)
            to[starts[(from[i] >> shift) % DIGITS]++] = from[i];
        uint64_t *swapped = from;
        from = to;
        to = swapped;
    }
    return true;
}

/* Two blocks along each axis: as far as most searches of a block and the next one go. */
enum { KEPT_BITS = 4, KEPT = 1 << KEPT_BITS };

static bool reserve_cells(csg_memory *memory, csg_near_room *room)
{
    if (room->cells)
        return true;
    if (!csg_memory_reserve(memory, (void **)&room->cells, &room->cell_capacity, KEPT * KEPT * KEPT,
                            sizeof *room->cells))
        return false;
    memset(room->cells, 0xFF, room->cell_capacity * sizeof *room->cells); /* of no cell */
    return true;
}

bool csg_near_collect(const csg_near *near, csg_near_room *room, size_t index)
{
    view v = view_of(near, room, index);
    if (!reserve_cells(near->memory, room))
        return false;
    room->count = room->place_count = 0;
    memset(room->own_cells, 0, sizeof room->own_cells);
    if (!add_block(&v, v.block, NULL))
        return false;
    const csg_near_box within = csg_near_box_of_block(near, index);
    for (int k = 0; k < CSG_NEAR_BLOCKS; k++) {
        const csg_feature_block *other =
            k == ITSELF ? NULL : csg_near_block(near->store, v.block, k);
        if (other && !add_block(&v, other, &within))
            return false;
    }
    return !room->place_count || sort_places(&v);
}

/* ---- smooth polygons ---------------------------------------------------------------------------
 */

/* The first feature of a block that is in this cell or a later one. */
static uint32_t first_from(const csg_feature_store *store, const csg_feature_block *block,
                           uint32_t cell)
{
    uint32_t low = block->first, high = block->first + block->count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        bool is_before = store->features[middle].cell < cell;
        low = is_before ? middle + 1 : low;
        high = is_before ? high : middle;
    }
    return low;
}

/* The polygons of a cell that are features, a bit each; its pattern, 0 where there is none. */
static unsigned loops_known(const csg_feature_store *store, const csg_cell_tables *tables,
                            const uint32_t cell[3], unsigned *pattern)
{
    unsigned known = 0;
    const uint32_t at[3] = {cell[0] / E, cell[1] / E, cell[2] / E};
    const csg_feature_block *block = csg_feature_store_find(store, at);
    uint32_t here = cell[0] % E + (cell[1] % E + cell[2] % E * E) * E;
    *pattern = 0;
    if (!block)
        return 0;
    uint32_t i = first_from(store, block, here), end = block->first + block->count;
    for (; i < end && store->features[i].cell == here; i++) {
        *pattern = store->features[i].pattern;
        known |= 1u << store->features[i].loop;
        if (store->features[i].joined) /* all of them are */
            known = (1u << tables->loop_count[*pattern]) - 1;
    }
    return known;
}

static const csg_feature_cell *find_cell(const view *v, const uint32_t cell[3])
{
    csg_near_room *room = v->room;
    csg_near_cell *kept = &room->cells[cell[0] % KEPT | (cell[1] % KEPT) << KEPT_BITS |
                                       (cell[2] % KEPT) << 2 * KEPT_BITS];
    if (memcmp(kept->at, cell, sizeof kept->at) != 0) {
        memcpy(kept->at, cell, sizeof kept->at);
        kept->evaluations =
            (uint32_t)csg_feature_cell_find(v->near->marching, v->near->octree, cell, room->edges,
                                            room->scratch, room->scratch_floats, &kept->found);
    }
    room->evaluations += kept->evaluations;
    return &kept->found;
}

/* Triangles of marching cubes in a cell; how many. */
static int smooth_triangles(const view *v, const int at[3],
                            csg_near_triangle out[CSG_CELL_MOST_TRIANGLES])
{
    const csg_marching *m = v->near->marching;
    uint32_t cell[3];
    unsigned pattern;
    for (int axis = 0; axis < 3; axis++) {
        if (at[axis] < 0 || at[axis] >= (int)m->lattice->cells[axis])
            return 0;
        cell[axis] = (uint32_t)at[axis];
    }
    unsigned known = loops_known(v->near->store, m->tables, cell, &pattern);
    if (pattern && known == (1u << m->tables->loop_count[pattern]) - 1)
        return 0;
    const csg_feature_cell *found = find_cell(v, cell);
    const uint8_t *edge = m->tables->edge[found->pattern];
    int count = 0;
    for (int loop = 0; loop < m->tables->loop_count[found->pattern]; loop++)
        for (int t = 0; t < m->tables->loop_sides[found->pattern][loop] - 2; t++, edge += 3) {
            if (known >> loop & 1)
                continue;
            csg_near_triangle *to = &out[count++];
            *to = (csg_near_triangle){.owner = {CSG_FEATURE_NONE, CSG_FEATURE_NONE}};
            for (int c = 0; c < 3; c++) {
                csg_marching_shift(m, found->at[edge[c]], to->shape.at[c]);
                to->shape.vertex[c] = number_of_edge(v, at, edge[c]);
            }
            set_box(to);
        }
    return count;
}

/* ---- what meets --------------------------------------------------------------------------------
 */

static bool has_vertex(const csg_near_triangle *t, uint32_t vertex)
{
    return t->shape.vertex[0] == vertex || t->shape.vertex[1] == vertex ||
           t->shape.vertex[2] == vertex;
}

/* Whether both are of one fan of which it is known that no two meet. */
static bool share_fan(const csg_near_triangle *s, const csg_near_triangle *t)
{
    for (int k = 0; k < 2; k++)
        if (s->fan[k] && has_vertex(s, s->fan[k]) && has_vertex(t, s->fan[k]))
            return true;
    return false;
}

/* Apexes out of order fold creases over to all but one line. There they must keep apart by what
 * decimals are off: half a unit in the last place each coordinate, two points by less than two. */
static bool meet(const view *v, const csg_near_triangle *s, const csg_near_triangle *t)
{
    bool is_far = s->far && t->far;
    float reach = reach_of(v->near);
    if (!overlap(&s->box, &t->box, is_far ? reach : 0))
        return false;
    if (share_fan(s, t)) {
        assert(!csg_exact_meet(&s->shape, &t->shape));
        return false;
    }
    return csg_exact_meet(&s->shape, &t->shape) ||
           (is_far && csg_exact_nearly_meet(&s->shape, &t->shape, (double)reach));
}

/* Whether the plane of a triangle passes a cell: where none does, what marching cubes makes there
 * is of no interest. */
static bool passes(const view *v, const csg_near_triangle *t, const int cell[3])
{
    const csg_marching *m = v->near->marching;
    const double size = m->lattice->cell_size;
    const double half = (0.5 + 10 * CLEAR) * size + 2 * (double)m->unit;
    const double origin[3] = {m->lattice->origin.x, m->lattice->origin.y, m->lattice->origin.z};
    const double shift[3] = {m->shift.x, m->shift.y, m->shift.z};
    double u[3], w[3], away = 0, reach = 0;
    for (int axis = 0; axis < 3; axis++) {
        u[axis] = (double)t->shape.at[1][axis] - (double)t->shape.at[0][axis];
        w[axis] = (double)t->shape.at[2][axis] - (double)t->shape.at[0][axis];
    }
    for (int axis = 0; axis < 3; axis++) {
        int i = (axis + 1) % 3, j = (axis + 2) % 3;
        double n = u[i] * w[j] - u[j] * w[i];
        double middle = origin[axis] + shift[axis] + (cell[axis] + 0.5) * size;
        away += n * (middle - (double)t->shape.at[0][axis]);
        reach += half * fabs(n);
    }
    return fabs(away) <= reach;
}

/* The triangles entered into one cell. */
static bool search_cell(const view *v, const uint64_t *places, size_t count, csg_near_found *found,
                        void *user)
{
    const csg_near_triangle *triangles = v->room->triangles;
    csg_near_triangle smooth[CSG_CELL_MOST_TRIANGLES];
    int smooth_count = -1, cell[3], place = (int)(places[0] >> 32);
    for (int axis = 0; axis < 3; axis++, place /= VIEW_CELLS)
        cell[axis] = place % VIEW_CELLS + v->first[axis];
    for (size_t i = 0; i < count && triangles[(uint32_t)places[i]].own; i++) { /* own ones first */
        const csg_near_triangle *s = &triangles[(uint32_t)places[i]];
        for (size_t k = i + 1; k < count; k++) {
            const csg_near_triangle *t = &triangles[(uint32_t)places[k]];
            if ((t->own || t->owner[0] > s->owner[0]) && meet(v, s, t) && !found(user, s, t))
                return false;
        }
        bool is_alone = s->far && !passes(v, s, cell);
        if (smooth_count < 0 && !is_alone)
            smooth_count = smooth_triangles(v, cell, smooth);
        for (int k = 0; k < smooth_count && !is_alone; k++)
            if (meet(v, s, &smooth[k]) && !found(user, s, &smooth[k]))
                return false;
    }
    return true;
}

bool csg_near_search(const csg_near *near, csg_near_room *room, size_t block, csg_near_found *found,
                     void *user)
{
    view v = view_of(near, room, block);
    const uint64_t *places = room->places;
    for (size_t i = 0, end; i < room->place_count; i = end) {
        for (end = i + 1; end < room->place_count && places[end] >> 32 == places[i] >> 32;)
            end++;
        if (!search_cell(&v, places + i, end - i, found, user))
            return false;
    }
    return true;
}

double csg_near_excess(const csg_near *near, uint32_t i)
{
    const csg_feature_store *store = near->store;
    int cell[3];
    float at[3];
    double excess = 0;
    cell_of(block_of(store, &store->blocks[0], i), &store->features[i], cell);
    csg_marching_shift(near->marching, store->features[i].at, at);
    for (int axis = 0; axis < 3; axis++) {
        double x = place_of(near->marching, at[axis], axis) - cell[axis];
        excess = fmax(excess, fmax(-x, x - 1));
    }
    return excess;
}

void csg_near_room_release(csg_near_room *room, csg_memory *memory)
{
    csg_memory_release(memory, room->triangles, room->capacity * sizeof *room->triangles);
    csg_memory_release(memory, room->places, room->place_capacity * sizeof *room->places);
    csg_memory_release(memory, room->cells, room->cell_capacity * sizeof *room->cells);
    csg_memory_release(memory, room->sorted, room->sorted_capacity * sizeof *room->sorted);
    *room = (csg_near_room){0};
}
