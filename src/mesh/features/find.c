/* SPDX-License-Identifier: MIT
 * Where the gradient of the field jumps along the polygons of a block's cells: creases. Blocks
 * without anything that could make one are passed over, the rest is asked in batches: gradients at
 * the vertices, then at the middles of those segments whose ends differ, again and again: the half
 * that keeps the difference is the one with the jump.
 */
#include <math.h>
#include <string.h>

#include "mesh/features/apex.h"
#include "mesh/features/facets.h"
#include "mesh/features/help.h"
#include "mesh/features/pair.h"
#include "mesh/features/possible.h"
#include "mesh/features/solve.h"

enum { N = CSG_BLOCK_SAMPLES, E = CSG_BLOCK_EDGE, HALVINGS = 10, BRACKETS = 1 << HALVINGS };

/* 1 - cos of 0.6 degrees, below which ends of a segment count as equal. */
static const float LEAST_DIFFERENCE = 5.5e-5f;
/* On a smooth surface both halves of a short segment turn alike and not by much: 1 - cos within
 * 10 % and below that of 12 degrees. */
static const float ALIKE = 1.1f, LITTLE = 0.02f;
/* 1 - cos of what floats make of one plane's gradient. */
static const float SAME = 1e-6f;
/* 1 - cos of 30 degrees. */
static const float DETOUR = 0.134f;
/* Corners of a polygon around a tip look apart by 25 degrees and more. */
static const float WIDE = 0.9f;

/* ---- vertices -------------------------------------------------------------------------------- */

/* Rows of lattice edges along each axis, a bit each: of a layer and a line, as slots count them. */
typedef struct edge_rows {
    uint16_t bits[3][N][N];
} edge_rows;

/* Those of cells that may crease: nobody asks what the gradient is at others. */
static void mark_edges(const csg_feature_room *room, edge_rows *rows)
{
    memset(rows, 0, sizeof *rows);
    for (int k = 0; k < E; k++)
        for (int j = 0; j < E; j++) {
            unsigned cells = room->possible.any[k * E + j], ends = cells | cells << 1;
            for (int side = 0; side < 2; side++) {
                rows->bits[0][k][j + side] |= (uint16_t)cells;
                rows->bits[0][k + 1][j + side] |= (uint16_t)cells;
                rows->bits[1][k + side][j] |= (uint16_t)ends;
                rows->bits[2][k][j + side] |= (uint16_t)ends;
            }
        }
}

static bool is_marked(const edge_rows *rows, unsigned slot)
{
    unsigned axis = slot / CSG_BLOCK_POINTS, point = slot % CSG_BLOCK_POINTS;
    return rows->bits[axis][point / (N * N)][point / N % N] >> point % N & 1;
}

/* Values and gradients at the vertices, by slot: at all of them, or on the edges of cells that may
 * crease. Whether these are all. */
static bool take_gradients(csg_feature_room *room, csg_feature_probe *probe, bool at_all)
{
    const csg_slots *slots = &room->slots;
    edge_rows rows;
    uint32_t count = 0;
    mark_edges(room, &rows);
    for (uint32_t i = 0; i < slots->count; i++) {
        const float *p = slots->at[slots->slot[i]];
        if (!at_all && !is_marked(&rows, slots->slot[i]))
            continue;
        room->x[count] = p[0], room->y[count] = p[1], room->z[count] = p[2];
        room->which[count++] = slots->slot[i];
    }
    float *const g[3] = {room->g[0], room->g[1], room->g[2]};
    csg_feature_probe_points(probe, room->x, room->y, room->z, count, room->f, g);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t slot = room->which[i];
        room->value[slot] = room->f[i];
        for (int axis = 0; axis < 3; axis++)
            room->gradient[slot][axis] = room->g[axis][i];
    }
    return count == slots->count;
}

/* ---- segments -------------------------------------------------------------------------------- */

static bool add_segment(csg_feature_room *room, const csg_found_loop *loop, int side)
{
    uint16_t from = loop->slot[side], to = loop->slot[(side + 1) % loop->side_count];
    float difference = 1.0f - csg_feature_cosine(room->gradient[from], room->gradient[to]);
    if (!(difference > LEAST_DIFFERENCE) || room->segment_count == CSG_FEATURE_SEGMENTS)
        return false;
    csg_segment *s = &room->segments[room->segment_count++];
    *s = (csg_segment){.from = from,
                       .to = to,
                       .loop = (uint16_t)room->loop_count,
                       .side = (uint8_t)side,
                       .active = 1,
                       .high = 1,
                       .jump = difference};
    memcpy(s->low_gradient, room->gradient[from], sizeof s->low_gradient);
    memcpy(s->high_gradient, room->gradient[to], sizeof s->high_gradient);
    return true;
}

/* The smallest cosine between normals of its corners. */
static float widest_of(const csg_feature_room *room, const csg_found_loop *loop)
{
    float widest = 1;
    for (int a = 0; a < loop->side_count; a++)
        for (int b = a + 1; b < loop->side_count; b++)
            widest = fminf(widest, csg_feature_cosine(room->gradient[loop->slot[a]],
                                                      room->gradient[loop->slot[b]]));
    return widest;
}

/* False: no two of its corners are as far apart, told without a root. */
static bool may_be_wide(const csg_feature_room *room, const csg_found_loop *loop)
{
    static const float LEAST = WIDE * WIDE + 1e-4f; /* of the square of the cosine */
    for (int a = 0; a < loop->side_count; a++)
        for (int b = a + 1; b < loop->side_count; b++) {
            const float *g = room->gradient[loop->slot[a]], *h = room->gradient[loop->slot[b]];
            float gh = g[0] * h[0] + g[1] * h[1] + g[2] * h[2];
            float gg = g[0] * g[0] + g[1] * g[1] + g[2] * g[2];
            float hh = h[0] * h[0] + h[1] * h[1] + h[2] * h[2];
            if (!(gh > 0 && gh * gh > LEAST * gg * hh))
                return true;
        }
    return false;
}

/* Loops with a segment to look at, or around what may be a tip. */
static void add_loop(const csg_marching *m, csg_feature_room *room, int cell, unsigned pattern,
                     const csg_cell_loops *loops, int index)
{
    const csg_cell_tables *tables = m->tables;
    if (room->loop_count == CSG_FEATURE_SEGMENTS / 4)
        return;
    csg_found_loop *loop = &room->loops[room->loop_count];
    *loop = (csg_found_loop){.cell = (uint16_t)cell,
                             .pattern = (uint8_t)pattern,
                             .loop = (uint8_t)index,
                             .joined = room->any_joined ? room->joined[cell] : 0,
                             .side_count = loops->sides[index]};
    int i = cell & 7, j = cell >> 3 & 7, k = cell >> 6;
    for (int s = 0; s < loop->side_count; s++) {
        uint8_t edge = loops->edge[index][s];
        const uint8_t *o = tables->offset[edge];
        loop->edge[s] = edge;
        loop->slot[s] =
            (uint16_t)(edge / 4 * CSG_BLOCK_POINTS + ((k + o[2]) * N + j + o[1]) * N + i + o[0]);
        loop->crease[s] = -1;
    }
    bool may_jump = !(room->possible.tips[cell / E] >> cell % E & 1);
    if (!may_jump && !loop->joined && !may_be_wide(room, loop))
        return;
    float widest = widest_of(room, loop);
    if (1.0f - widest <= LEAST_DIFFERENCE && !loop->joined)
        return;
    bool any = loop->wide = widest < WIDE;
    any |= loop->joined != 0;
    for (int s = 0; s < loop->side_count && may_jump; s++)
        any |= add_segment(room, loop, s);
    room->loop_count += any;
}

/* All loops of a cell with a joined face are features. */
static bool may_crease(const csg_feature_room *room, int cell)
{
    return room->possible.any[cell / E] >> cell % E & 1 || (room->any_joined && room->joined[cell]);
}

static void collect_loops(const csg_marching *m, const csg_block *block, csg_feature_room *room)
{
    room->segment_count = room->loop_count = 0;
    for (int k = 0; k < E; k++)
        for (int j = 0; j < E; j++) {
            csg_cell_rows rows = csg_cell_rows_of(block, j, k);
            for (unsigned rest = rows.mixed; rest; rest &= rest - 1) {
                int i = __builtin_ctz(rest);
                unsigned pattern = csg_cell_pattern(&rows, i);
                int cell = (k * E + j) * E + i;
                if (!may_crease(room, cell))
                    continue;
                csg_cell_loops loops = csg_feature_loops(room, m->tables, (unsigned)cell, pattern);
                for (int l = 0; l < loops.count; l++)
                    add_loop(m, room, cell, pattern, &loops, l);
            }
        }
}

static void point_along(const csg_feature_room *room, const csg_segment *s, float t, float p[3])
{
    const float *a = room->slots.at[s->from], *b = room->slots.at[s->to];
    for (int axis = 0; axis < 3; axis++)
        p[axis] = a[axis] + t * (b[axis] - a[axis]);
}

/* One halving of all active segments. */
static void halve(csg_feature_room *room, csg_feature_probe *probe)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < room->segment_count; i++) {
        csg_segment *s = &room->segments[i];
        if (!s->active || s->found)
            continue;
        float p[3];
        point_along(room, s, 0.5f * (s->low + s->high), p);
        room->x[count] = p[0], room->y[count] = p[1], room->z[count] = p[2];
        room->which[count++] = i;
    }
    float *const g[3] = {room->g[0], room->g[1], room->g[2]};
    csg_feature_probe_points(probe, room->x, room->y, room->z, count, room->f, g);
    for (uint32_t i = 0; i < count; i++) {
        csg_segment *s = &room->segments[room->which[i]];
        const float middle[3] = {g[0][i], g[1][i], g[2][i]};
        float low = 1.0f - csg_feature_cosine(s->low_gradient, middle);
        float high = 1.0f - csg_feature_cosine(middle, s->high_gradient);
        float t = 0.5f * (s->low + s->high), kept = fmaxf(low, high);
        s->active =
            (kept > ALIKE * fminf(low, high) || kept > LITTLE) && kept > CSG_FEATURE_LEAST_JUMP;
        s->jump = kept;
        s->plane = fminf(low, high) <= SAME;
        memcpy(low >= high ? s->high_gradient : s->low_gradient, middle, sizeof middle);
        *(low >= high ? &s->high : &s->low) = t;
        *(low >= high ? &s->high_value : &s->low_value) = room->f[i];
    }
}

/* Where sheets are plane a segment's jump is known beforehand: where the tangent planes at both
 * vertices are as high as each other. Vertices are roots to 2^-14 of their edge, which is several
 * brackets where a crease is blunt: so f counts. Returns the bracket, of 2^HALVINGS, in which that
 * is; -1: at an end, or nowhere. */
static int expected_bracket(const csg_feature_room *room, const csg_segment *s)
{
    const float *a = room->slots.at[s->from], *b = room->slots.at[s->to];
    const float *from = room->gradient[s->from], *to = room->gradient[s->to];
    float rise = 0, fall = 0;
    for (int axis = 0; axis < 3; axis++) {
        rise += from[axis] * (b[axis] - a[axis]);
        fall -= to[axis] * (b[axis] - a[axis]);
    }
    float step = room->value[s->to] - room->value[s->from];
    float t = (step + fall) / (rise + fall) * BRACKETS;
    return t >= 1 && t < BRACKETS - 1 ? (int)t : -1;
}

/* Asks both ends of the brackets where jumps are expected. Where each has its vertex's own gradient
 * the bracket is the one that halving would come to. */
static void expect_jumps(csg_feature_room *room, csg_feature_probe *probe)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < room->segment_count && count + 2 <= CSG_FEATURE_SEGMENTS; i++) {
        const csg_segment *s = &room->segments[i];
        int bracket = s->active && s->plane ? expected_bracket(room, s) : -1;
        for (int end = 0; bracket >= 0 && end < 2; end++) {
            float p[3];
            point_along(room, s, (float)(bracket + end) / BRACKETS, p);
            room->x[count] = p[0], room->y[count] = p[1], room->z[count] = p[2];
            room->which[count++] = i;
        }
    }
    float *const g[3] = {room->g[0], room->g[1], room->g[2]};
    csg_feature_probe_points(probe, room->x, room->y, room->z, count, room->f, g);
    for (uint32_t i = 0; i < count; i += 2) {
        csg_segment *s = &room->segments[room->which[i]];
        const float low[3] = {g[0][i], g[1][i], g[2][i]};
        const float high[3] = {g[0][i + 1], g[1][i + 1], g[2][i + 1]};
        float jump = 1.0f - csg_feature_cosine(low, high);
        if (!(1.0f - csg_feature_cosine(s->low_gradient, low) <= SAME) ||
            !(1.0f - csg_feature_cosine(high, s->high_gradient) <= SAME) ||
            !(jump > CSG_FEATURE_LEAST_JUMP))
            continue;
        int bracket = expected_bracket(room, s);
        s->low = (float)bracket / BRACKETS;
        s->high = (float)(bracket + 1) / BRACKETS;
        s->low_value = room->f[i];
        s->high_value = room->f[i + 1];
        s->jump = jump;
        s->found = 1;
        memcpy(s->low_gradient, low, sizeof low);
        memcpy(s->high_gradient, high, sizeof high);
    }
}

/* Where the tangent planes on both sides of the jump meet, near it. */
static void locate_crease(csg_feature_room *room, uint32_t index)
{
    csg_segment *s = &room->segments[index];
    float low[3], high[3];
    const float *g = s->low_gradient, *h = s->high_gradient;
    point_along(room, s, s->low, low);
    point_along(room, s, s->high, high);
    const csg_plane planes[2] = {
        csg_plane_at(low[0], low[1], low[2], s->low_value, g[0], g[1], g[2]),
        csg_plane_at(high[0], high[1], high[2], s->high_value, h[0], h[1], h[2])};
    csg_vec3 at = {(double)low[0], (double)low[1], (double)low[2]};
    s->active = csg_planes_meet(planes, 2, &at);
    s->at[0] = (float)at.x, s->at[1] = (float)at.y, s->at[2] = (float)at.z;
    if (s->active)
        room->loops[s->loop].crease[s->side] = (int16_t)index;
}

/* Fills in what is not known of the ends of the brackets: at vertices, whose values nobody has
 * asked for and whose gradients may have been corrected. */
static void ask_vertices(csg_feature_room *room, csg_feature_probe *probe)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < room->segment_count; i++) {
        const csg_segment *s = &room->segments[i];
        if (!s->active || (s->low > 0 && s->high < 1))
            continue;
        float p[3];
        point_along(room, s, s->low > 0 ? s->high : s->low, p);
        room->x[count] = p[0], room->y[count] = p[1], room->z[count] = p[2];
        room->which[count++] = i;
    }
    float *const g[3] = {room->g[0], room->g[1], room->g[2]};
    csg_feature_probe_points(probe, room->x, room->y, room->z, count, room->f, g);
    for (uint32_t i = 0; i < count; i++) {
        csg_segment *s = &room->segments[room->which[i]];
        const float gradient[3] = {g[0][i], g[1][i], g[2][i]};
        *(s->low > 0 ? &s->high_value : &s->low_value) = room->f[i];
        memcpy(s->low > 0 ? s->high_gradient : s->low_gradient, gradient, sizeof gradient);
    }
}

/* Whether g turns from a towards b, and not past it. */
static bool is_between(const float *g, const float *a, const float *b)
{
    float u[3], v[3];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        u[i] = a[j] * g[k] - a[k] * g[j];
        v[i] = g[j] * b[k] - g[k] * b[j];
    }
    return csg_feature_cosine(u, v) > 0.999f && csg_feature_cosine(a, b) < csg_feature_cosine(a, g);
}

/* Both segments at a vertex jump there: it lies on a crease, and its gradient may be neither
 * sheet's but between them. That of a point a little inside takes its place. */
static bool correct_vertex(csg_feature_room *room, const csg_segment *before,
                           const csg_segment *behind, csg_feature_probe *probe)
{
    static const float LITTLE_INSIDE = 2e-3f; /* cells */
    uint16_t slot = behind->from;
    float *g = room->gradient[slot], inside[3][1];
    const float *at = room->slots.at[slot];
    if (!before->active || !behind->active || before->high < 1 || behind->low > 0 ||
        !is_between(g, before->low_gradient, behind->high_gradient))
        return false;
    float square = g[0] * g[0] + g[1] * g[1] + g[2] * g[2];
    float reach = LITTLE_INSIDE * (float)probe->marching->lattice->cell_size / sqrtf(square);
    float x = at[0] + reach * g[0], y = at[1] + reach * g[1], z = at[2] + reach * g[2];
    csg_feature_probe_points(probe, &x, &y, &z, 1, NULL,
                             (float *const[3]){inside[0], inside[1], inside[2]});
    const float fresh[3] = {inside[0][0], inside[1][0], inside[2][0]};
    if (!(1.0f - csg_feature_cosine(fresh, g) > CSG_FEATURE_LEAST_JUMP))
        return false;
    memcpy(g, fresh, sizeof fresh);
    return true;
}

/* Segments of a loop stand one after another. */
static bool correct_vertices(csg_feature_room *room, csg_feature_probe *probe)
{
    bool any = false;
    for (uint32_t i = 0, first = 0; i < room->segment_count; i++) {
        const csg_segment *s = &room->segments[i];
        first = room->segments[first].loop == s->loop ? first : i;
        const csg_segment *start = &room->segments[first];
        if (i > first && s[-1].side + 1 == s->side)
            any = correct_vertex(room, &s[-1], s, probe) || any;
        if (i > first && start->side == 0 && s->side + 1 == room->loops[s->loop].side_count)
            any = correct_vertex(room, s, start, probe) || any;
    }
    return any;
}

/* Where the surface is curved a segment runs a little inside the solid, and near a crease that it
 * does not cross, past the place where the other sheet becomes the nearer one: the gradient jumps
 * away and back again, by far more than it differs between the ends. */
static void drop_detours(csg_feature_room *room)
{
    for (uint32_t i = 0; i < room->segment_count; i++) {
        csg_segment *s = &room->segments[i];
        float ends = 1.0f - csg_feature_cosine(room->gradient[s->from], room->gradient[s->to]);
        s->active = s->active && !(ends < LITTLE && s->jump > DETOUR);
    }
}

static void find_jumps(const csg_marching *m, const csg_block *block, csg_feature_room *room,
                       csg_feature_probe *probe)
{
    collect_loops(m, block, room);
    halve(room, probe);
    expect_jumps(room, probe);
    for (int step = 1; step < HALVINGS; step++)
        halve(room, probe);
    csg_feature_drop_facets(room, probe);
}

static void find_creases(const csg_marching *m, const csg_block *block, csg_feature_room *room,
                         csg_feature_probe *probe)
{
    find_jumps(m, block, room, probe);
    if (correct_vertices(room, probe))
        find_jumps(m, block, room, probe);
    drop_detours(room);
    ask_vertices(room, probe);
    for (uint32_t i = 0; i < room->segment_count; i++)
        if (room->segments[i].active)
            locate_crease(room, i);
}

/* ---- the whole ------------------------------------------------------------------------------- */

static bool end_block(csg_feature_room *room, csg_memory *memory, const csg_block *block,
                      size_t before)
{
    if (room->count == before)
        return true;
    if (!csg_memory_reserve(memory, (void **)&room->blocks, &room->block_capacity,
                            room->block_count + 1, sizeof(csg_feature_block)))
        return false;
    csg_feature_block *entry = &room->blocks[room->block_count++];
    *entry =
        (csg_feature_block){.first = (uint32_t)before, .count = (uint32_t)(room->count - before)};
    memcpy(entry->at, block->at, sizeof entry->at);
    return true;
}

/* False: out of memory. */
static bool keep_roots(csg_feature_room *room, csg_block *block)
{
    float *along = csg_arena_alloc(&room->along, room->slots.count * sizeof *along);
    if (along)
        csg_marching_keep_roots(&room->slots, along);
    block->along = along;
    return along;
}

/* The same of gradients there. */
static bool keep_slopes(csg_feature_room *room, csg_block *block)
{
    float *slopes = csg_arena_alloc(&room->along, (size_t)3 * room->slots.count * sizeof *slopes);
    if (slopes)
        csg_marching_keep_slopes(&room->slots, room->gradient, slopes);
    block->slopes = slopes;
    return slopes;
}

static bool find_in_block(csg_feature_room *room, csg_block *block, csg_feature_probe *probe,
                          csg_memory *memory)
{
    const csg_marching *m = probe->marching;
    bool possible = csg_feature_find_possible(probe, &room->possible);
    bool has_pairs = csg_feature_has_pairs(block);
    if (!possible && !has_pairs)
        return true;
    probe->evaluations += csg_marching_roots(m, block, &room->edges, &room->slots, probe->scratch,
                                             probe->scratch_floats);
    if (csg_marching_keeps_roots(m) && !keep_roots(room, block))
        return false;
    if (take_gradients(room, probe, has_pairs) && csg_marching_keeps_slopes(m) &&
        !keep_slopes(room, block))
        return false;
    /* before gradients are corrected: that depends on the block, this must not */
    room->any_joined = has_pairs && csg_feature_pair(room, probe);
    if (!possible && !room->any_joined)
        return true;
    find_creases(m, block, room, probe);
    size_t before = room->count;
    return csg_feature_solve(room, probe) && csg_feature_help(room, before, probe) &&
           end_block(room, memory, block, before);
}

bool csg_feature_find(const csg_marching *m, csg_block *block, csg_feature_room *room,
                      csg_memory *memory, float *scratch, size_t scratch_floats)
{
    csg_feature_probe probe =
        csg_feature_probe_of(m, block, &room->around, memory, scratch, scratch_floats);
    room->lists.memory = room->along.memory = memory;
    bool done = find_in_block(room, block, &probe, memory);
    room->evaluations += probe.evaluations;
    return done;
}

/* The large arrays are filled before they are read, but for whole vectors of edges. */
void csg_feature_room_init(csg_feature_room *room)
{
    memset(&room->edges, 0, sizeof room->edges);
    memset(&room->around, 0, sizeof room->around);
    csg_arena_init(&room->lists, NULL);
    csg_arena_init(&room->along, NULL);
    csg_feature_room_empty(room);
}

void csg_feature_room_empty(csg_feature_room *room)
{
    csg_memory *memory = room->lists.memory; /* NULL: it has never had any */
    if (memory) {
        csg_memory_release(memory, room->features, room->capacity * sizeof(csg_feature));
        csg_memory_release(memory, room->blocks, room->block_capacity * sizeof(csg_feature_block));
    }
    csg_arena_reset(&room->lists);
    room->features = NULL;
    room->blocks = NULL;
    room->capacity = room->block_capacity = 0;
    room->count = room->block_count = 0;
    room->smooth = room->fading = room->evaluations = 0;
}

void csg_feature_room_release(csg_feature_room *room)
{
    csg_feature_around_release(&room->around);
    csg_arena_reset(&room->along);
    csg_feature_room_empty(room);
}
