/* SPDX-License-Identifier: MIT
 * Vertices and triangles of blocks; see marching.h.
 */
#include "mesh/marching/marching.h"

#include <math.h>
#include <string.h>

#include "field/field.h"
#include "mesh/mesh.h"

enum { N = CSG_BLOCK_SAMPLES, E = CSG_BLOCK_EDGE };

/* ---- finding blocks ---------------------------------------------------------------------------
 */

bool csg_block_index_make(csg_table *index, csg_memory *memory, csg_block *const *blocks,
                          size_t count)
{
    csg_table_init(index, memory);
    if (!csg_table_reserve(index, count + 1, NULL, NULL))
        return false;
    for (size_t i = 0; i < count; i++)
        csg_table_add(index, csg_lattice_hash(blocks[i]->at), (uint32_t)i);
    return true;
}

const csg_block *csg_block_index_find(const csg_table *index, csg_block *const *blocks,
                                      const uint32_t at[3])
{
    size_t slot;
    uint32_t found = csg_table_first(index, csg_lattice_hash(at), &slot);
    while (found != CSG_TABLE_NONE && memcmp(blocks[found]->at, at, sizeof blocks[found]->at) != 0)
        found = csg_table_next(index, &slot);
    return found != CSG_TABLE_NONE ? blocks[found] : NULL;
}

/* ---- cells ----------------------------------------------------------------------------------- */

uint32_t csg_marching_count(const csg_block *block, const csg_cell_tables *tables)
{
    uint32_t count = 0;
    for (int k = 0; k < E; k++)
        for (int j = 0; j < E; j++) {
            csg_cell_rows s = csg_cell_rows_of(block, j, k);
            for (unsigned rest = s.mixed; rest; rest &= rest - 1)
                count += tables->count[csg_cell_pattern(&s, __builtin_ctz(rest))];
        }
    return count;
}

/* ---- vertices
 * ------------------------------------------------------------------------------------ */

/* Crossed edges of a word before a bit. */
static uint32_t rank_in_word(uint64_t word, int bit)
{
    return (uint32_t)__builtin_popcountll(word & (((uint64_t)1 << bit) - 1));
}

/* Coordinates of the block's lattice points and lengths of the edges between them. */
typedef struct block_lines {
    float point[3][N], step[3][E];
} block_lines;

static block_lines lines_of(const csg_lattice *lattice, const csg_block *block)
{
    block_lines lines;
    for (int axis = 0; axis < 3; axis++) {
        for (uint32_t i = 0; i < N; i++)
            lines.point[axis][i] = csg_lattice_coordinate(lattice, axis, block->at[axis] * E + i);
        for (int i = 0; i < E; i++)
            lines.step[axis][i] = lines.point[axis][i + 1] - lines.point[axis][i];
    }
    return lines;
}

/* Fills in what the field is at both ends of edges, given by their slots, where the block has kept
 * it for the very places that roots would ask for: lower ends and what lies a step farther. */
static void take_ends(const csg_block *block, const block_lines *lines, const uint16_t *slots,
                      csg_edges *e)
{
    static const int STEP[3] = {1, N, N * N};
    float values[CSG_BLOCK_POINTS];
    e->has_ends = false;
    if (!block->ends)
        return;
    bool are_same = true;
    for (int axis = 0; axis < 3; axis++)
        for (int i = 0; i < E; i++)
            are_same = are_same &&
                       lines->point[axis][i] + lines->step[axis][i] == lines->point[axis][i + 1];
    e->has_ends = are_same;
    if (!are_same)
        return;
    csg_block_unpack_ends(block, values);
    for (uint32_t i = 0; i < e->count; i++) {
        int point = slots[i] % CSG_BLOCK_POINTS;
        e->fa[i] = values[point];
        e->fb[i] = values[point + STEP[slots[i] / CSG_BLOCK_POINTS]];
    }
}

/* Where a part of a block lies: masks of the words' bits and a range of layers. */
typedef struct part_range {
    uint64_t bits;
    int first_layer, end_layer;
} part_range;

static part_range range_of_part(unsigned octant)
{
    enum { P = CSG_PART_EDGE };
    uint64_t columns = (octant & 1) ? 0xF0F0F0F0F0F0F0F0u : 0x0F0F0F0F0F0F0F0Fu;
    uint64_t lines = (octant >> 1 & 1) ? 0xFFFFFFFF00000000u : 0x00000000FFFFFFFFu;
    int layer = (octant >> 2 & 1) ? P : 0;
    return (part_range){columns & lines, layer, layer + P};
}

/* Lists crossed edges within a range, in the order of their ranks, and their slots. */
static void collect_edges(const csg_block *block, const block_lines *lines, part_range range,
                          csg_edges *e, uint16_t *slots)
{
    uint32_t n = 0;
    for (int axis = 0; axis < 3; axis++)
        for (int k = range.first_layer; k < range.end_layer; k++) {
            uint64_t word = block->crossed[axis][k];
            for (uint64_t rest = word & range.bits; rest; rest &= rest - 1, n++) {
                int bit = __builtin_ctzll(rest), i = bit & 7, j = bit >> 3;
                e->ax[n] = lines->point[0][i];
                e->ay[n] = lines->point[1][j];
                e->az[n] = lines->point[2][k];
                e->dx[n] = axis == 0 ? lines->step[0][i] : 0;
                e->dy[n] = axis == 1 ? lines->step[1][j] : 0;
                e->dz[n] = axis == 2 ? lines->step[2][k] : 0;
                e->a_inside[n] = block->inside[k][j] >> i & 1;
                e->rank[n] = (uint16_t)(block->rank[axis][k] + rank_in_word(word, bit));
                slots[n] = (uint16_t)(axis * CSG_BLOCK_POINTS + (k * N + j) * N + i);
            }
        }
    e->count = n;
    take_ends(block, lines, slots, e);
}

static void write_positions(const csg_marching *m, const csg_edges *e, float *out)
{
    for (uint32_t i = 0; i < e->count; i++) {
        const float at[3] = {e->x[i], e->y[i], e->z[i]};
        csg_marching_shift(m, at, out + 3 * e->rank[i]);
    }
}

/* Outward: against the gradient. At a critical point, along the edge from inside to outside.
 * Adding 0 makes every zero positive: a sum with an operand that pruning drops loses the sign. */
static void write_normals(const csg_edges *e, float *const g[3], float *out)
{
    for (uint32_t i = 0; i < e->count; i++) {
        float *n = out + 3 * e->rank[i];
        float x = 0.0f - g[0][i], y = 0.0f - g[1][i], z = 0.0f - g[2][i];
        float square = x * x + y * y + z * z;
        if (!(square > 1e-12f)) {
            float turn = e->a_inside[i] ? 1.0f : -1.0f;
            x = turn * e->dx[i], y = turn * e->dy[i], z = turn * e->dz[i];
            square = x * x + y * y + z * z;
        }
        float k = 1.0f / sqrtf(square);
        n[0] = x * k + 0.0f;
        n[1] = y * k + 0.0f;
        n[2] = z * k + 0.0f;
    }
}

static void write_colors(const csg_edges *e, float *const rgba[4], uint8_t *out)
{
    for (uint32_t i = 0; i < e->count; i++)
        for (int c = 0; c < 4; c++)
            out[4 * e->rank[i] + c] = csg_mesh_color_byte(rgba[c][i]);
}

static void write_materials(const csg_edges *e, float *const pair[2], uint16_t *out)
{
    for (uint32_t i = 0; i < e->count; i++)
        for (int c = 0; c < 2; c++)
            out[2 * e->rank[i] + c] = csg_mesh_material_share(pair[c][i]);
}

void csg_marching_colors(const csg_marching *m, const csg_tape *tape, const csg_edges *e,
                         float *const channels[4], uint8_t *out, float *scratch,
                         size_t scratch_floats)
{
    m->kernel->colors(tape, e->x, e->y, e->z, e->count, channels, scratch, scratch_floats);
    write_colors(e, channels, out);
}

/* Metallic and roughness are mixed as colours are: as two channels of a tape's other paint box. A
 * field without any, beside others in one mesh, has the default. */
void csg_marching_materials(const csg_marching *m, const csg_tape *tape, const csg_edges *e,
                            float *const channels[4], uint16_t *out, float *scratch,
                            size_t scratch_floats)
{
    csg_tape shaded = *tape;
    shaded.colors = m->field->materials;
    if (shaded.colors) {
        m->kernel->colors(&shaded, e->x, e->y, e->z, e->count, channels, scratch, scratch_floats);
    } else {
        for (uint32_t i = 0; i < e->count; i++) {
            channels[0][i] = csg_default_material.r;
            channels[1][i] = csg_default_material.g;
        }
    }
    write_materials(e, channels, out);
}

void csg_marching_gradients(const csg_marching *m, const csg_tape *tape, const float *x,
                            const float *y, const float *z, size_t count, float *const out[3],
                            float *scratch, size_t scratch_floats)
{
    enum { MOST_NODES = 256 }; /* of a whole tape, which each point is asked of seven times */
    const csg_tape *whole = &m->field->tape;
    if (whole->turns && whole->count <= MOST_NODES)
        m->kernel->true_gradients(whole, x, y, z, count, out[0], out[1], out[2], scratch,
                                  scratch_floats);
    else
        m->kernel->gradients(tape, x, y, z, count, out[0], out[1], out[2], scratch, scratch_floats);
}

/* The places of the collected edges' vertices, which are known. */
static void take_places(csg_marching_room *room)
{
    csg_edges *e = &room->edges;
    for (uint32_t i = 0; i < e->count; i++) {
        const float *at = room->slots.at[room->slots.slot[i]];
        e->x[i] = at[0], e->y[i] = at[1], e->z[i] = at[2];
    }
}

/* The same of their gradients. */
static void take_slopes(const csg_marching_room *room, float *const out[3])
{
    for (uint32_t i = 0; i < room->edges.count; i++)
        for (int axis = 0; axis < 3; axis++)
            out[axis][i] = room->slopes[room->slots.slot[i]][axis];
}

/* Roots (unless room->slots has them), normals, colours and materials of the collected edges. */
static uint64_t make_vertices(const csg_marching *m, const csg_tape *tape, const csg_block *block,
                              csg_marching_room *room, const csg_marching_output *out,
                              float *scratch, size_t scratch_floats)
{
    csg_edges *e = &room->edges;
    float *channels[4] = {room->channels[0], room->channels[1], room->channels[2],
                          room->channels[3]};
    if (!e->count)
        return 0;
    e->end_distance = m->end_distance;
    uint64_t evaluations = 0;
    if (block->along)
        take_places(room);
    else
        evaluations = m->kernel->roots(tape, e, m->noise, scratch, scratch_floats);
    write_positions(m, e, out->positions);
    if (out->normals) {
        if (block->slopes)
            take_slopes(room, channels);
        else
            csg_marching_gradients(m, tape, e->x, e->y, e->z, e->count, channels, scratch,
                                   scratch_floats);
        write_normals(e, channels, out->normals);
    }
    if (out->colors)
        csg_marching_colors(m, tape, e, channels, out->colors, scratch, scratch_floats);
    if (out->materials)
        csg_marching_materials(m, tape, e, channels, out->materials, scratch, scratch_floats);
    return evaluations;
}

uint64_t csg_marching_vertices(const csg_marching *m, const csg_block *block,
                               csg_marching_room *room, const csg_marching_output *out,
                               float *scratch, size_t scratch_floats)
{
    csg_tape tape = m->field->tape;
    block_lines lines = lines_of(m->lattice, block);
    uint16_t *slots = room->slots.slot;
    if (block->along)
        csg_marching_roots(m, block, &room->edges, &room->slots, scratch, scratch_floats);
    for (uint32_t i = 0; block->slopes && i < room->slots.count; i++)
        memcpy(room->slopes[slots[i]], block->slopes + (size_t)3 * i, sizeof room->slopes[0]);
    if (!block->parts) {
        tape.nodes = block->nodes;
        tape.count = block->node_count;
        collect_edges(block, &lines, (part_range){~(uint64_t)0, 0, E}, &room->edges, slots);
        return make_vertices(m, &tape, block, room, out, scratch, scratch_floats);
    }
    uint64_t evaluations = 0;
    for (unsigned octant = 0; octant < CSG_OCTANTS; octant++) {
        const csg_block_part *part = &block->parts[octant];
        if (part->state != CSG_CELL_SURFACE)
            continue;
        tape.nodes = part->nodes;
        tape.count = part->node_count;
        collect_edges(block, &lines, range_of_part(octant), &room->edges, slots);
        evaluations += make_vertices(m, &tape, block, room, out, scratch, scratch_floats);
    }
    return evaluations;
}

/* ---- triangles
 * ----------------------------------------------------------------------------------- */

/* The block's own edges are numbered in the order of their ranks. */
static void number_own_edges(const csg_block *block, uint32_t vertex[3][CSG_BLOCK_POINTS])
{
    uint32_t next = block->first_vertex;
    for (int axis = 0; axis < 3; axis++)
        for (int k = 0; k < E; k++)
            for (uint64_t rest = block->crossed[axis][k]; rest; rest &= rest - 1) {
                int bit = __builtin_ctzll(rest);
                vertex[axis][(k * N + (bit >> 3)) * N + (bit & 7)] = next++;
            }
}

/* Vertex numbers of an upper neighbour's edges that this block's cells use. shift: 8 on the axes
 * where it lies above; there only its first layer touches this block. */
static void number_edges(const csg_block *from, const int shift[3],
                         uint32_t vertex[3][CSG_BLOCK_POINTS])
{
    /* bits of the first column and row where the neighbour lies above in x and y */
    uint64_t used = ~(uint64_t)0;
    if (shift[0])
        used &= 0x0101010101010101u;
    if (shift[1])
        used &= 0xFF;
    int layers = shift[2] ? 1 : E;
    for (int axis = 0; axis < 3; axis++)
        for (int k = 0; k < layers; k++) {
            uint64_t word = from->crossed[axis][k];
            for (uint64_t rest = word & used; rest; rest &= rest - 1) {
                int bit = __builtin_ctzll(rest);
                int i = (bit & 7) + shift[0], j = (bit >> 3) + shift[1];
                vertex[axis][((k + shift[2]) * N + j) * N + i] =
                    from->first_vertex + from->rank[axis][k] + rank_in_word(word, bit);
            }
        }
}

/* Bit o set: the surface crosses an edge of this block that the upper neighbour o owns (octant
 * bits: the axes on which it lies above). Those edges lie in the upper faces (one axis) and on the
 * lines where two of these meet; the neighbour above on all three axes owns none. */
static unsigned needed_neighbours(const csg_block *block)
{
    unsigned any = 0, all = ~0u, any_y = 0, all_y = ~0u, any_z = 0, all_z = ~0u;
    for (int k = 0; k < N; k++)
        for (int j = 0; j < N; j++) {
            any |= block->inside[k][j];
            all &= block->inside[k][j];
        }
    for (int i = 0; i < N; i++) {
        any_y |= block->inside[i][E];
        all_y &= block->inside[i][E];
        any_z |= block->inside[E][i];
        all_z &= block->inside[E][i];
    }
    const unsigned row = block->inside[E][E], rim = 1u << E, whole = (1u << N) - 1;
    bool crossed[8] = {
        [1] = any & ~all & rim,     [2] = any_y != 0 && (all_y & whole) != whole,
        [3] = any_y & ~all_y & rim, [4] = any_z != 0 && (all_z & whole) != whole,
        [5] = any_z & ~all_z & rim, [6] = row != 0 && row != whole,
    };
    unsigned needed = 0;
    for (unsigned octant = 0; octant < 8; octant++)
        needed |= (unsigned)crossed[octant] << octant;
    return needed;
}

void csg_marching_number(const csg_marching *m, const csg_block *block, csg_marching_room *room)
{
    uint32_t(*vertex)[CSG_BLOCK_POINTS] = room->vertex;
    number_own_edges(block, vertex);
    unsigned needed = needed_neighbours(block);
    for (unsigned octant = 1; octant < 8; octant++) {
        if (!(needed >> octant & 1))
            continue;
        uint32_t at[3];
        int shift[3];
        for (int axis = 0; axis < 3; axis++) {
            at[axis] = block->at[axis] + (octant >> axis & 1);
            shift[axis] = (octant >> axis & 1) ? E : 0;
        }
        const csg_block *from = csg_block_index_find(m->index, m->blocks, at);
        if (from)
            number_edges(from, shift, vertex);
    }
}

void csg_marching_places_make(csg_marching_places *places, const csg_cell_tables *tables)
{
    for (int pattern = 0; pattern < 256; pattern++)
        for (int c = 0; c < CSG_CELL_MOST_INDICES; c++) {
            int edge = tables->edge[pattern][c];
            const uint8_t *o = tables->offset[edge];
            places->place[pattern][c] =
                (uint16_t)(edge / 4 * CSG_BLOCK_POINTS + (o[2] * N + o[1]) * N + o[0]);
        }
}

/* Two triangles, the most frequent number, are copied without asking; a third and more where there
 * are. Unused places of a pattern name some vertex of the table. */
static uint32_t *put_cell(uint32_t *out, const uint32_t *vertex, const uint16_t *place, int count)
{
    enum { USUAL = 6 };
    for (int c = 0; c < USUAL; c++)
        out[c] = vertex[place[c]];
    for (int c = USUAL; c < count; c++)
        out[c] = vertex[place[c]];
    return out + count;
}

void csg_marching_triangles(const csg_marching *m, const csg_block *block, csg_marching_room *room,
                            const csg_marching_output *out)
{
    const uint32_t *vertex = room->vertex[0];
    uint32_t *end = room->indices;
    csg_marching_number(m, block, room);
    for (int k = 0; k < E; k++)
        for (int j = 0; j < E; j++) {
            csg_cell_rows s = csg_cell_rows_of(block, j, k);
            for (unsigned rest = s.mixed; rest; rest &= rest - 1) {
                int i = __builtin_ctz(rest);
                unsigned pattern = csg_cell_pattern(&s, i);
                end = put_cell(end, vertex + (k * N + j) * N + i, m->places->place[pattern],
                               3 * m->tables->count[pattern]);
            }
        }
    memcpy(out->indices, room->indices, (size_t)(end - room->indices) * sizeof *end);
}

/* ---- loose triangles
 * ----------------------------------------------------------------------------- */

/* Of a row of points, those whose edge along an axis ends inside the block and is crossed. */
static unsigned crossed_in_row(const csg_block *block, int axis, int j, int k)
{
    unsigned row = block->inside[k][j];
    if (axis == 0)
        return (row ^ row >> 1) & ((1u << E) - 1);
    if ((axis == 1 ? j : k) == E)
        return 0;
    return (row ^ (axis == 1 ? block->inside[k][j + 1] : block->inside[k + 1][j])) &
           ((1u << N) - 1);
}

/* Points of a block along each axis, from the first up to before the end. */
typedef struct point_range {
    int first[3], end[3];
} point_range;

/* Those of a part of the block; points of the upper rim belong to the last ones. */
static point_range points_of_part(unsigned octant)
{
    point_range r;
    for (int axis = 0; axis < 3; axis++) {
        bool upper = octant >> axis & 1;
        r.first[axis] = upper ? CSG_PART_EDGE : 0;
        r.end[axis] = upper ? N : CSG_PART_EDGE;
    }
    return r;
}

/* Lists crossed edges, the rim's too, of the points in a range. */
static void collect_all_edges(const csg_block *block, const block_lines *lines, point_range r,
                              csg_edges *e)
{
    uint32_t n = 0;
    unsigned columns = (1u << r.end[0]) - (1u << r.first[0]);
    for (int axis = 0; axis < 3; axis++)
        for (int k = r.first[2]; k < r.end[2]; k++)
            for (int j = r.first[1]; j < r.end[1]; j++)
                for (unsigned rest = crossed_in_row(block, axis, j, k) & columns; rest;
                     rest &= rest - 1) {
                    int i = __builtin_ctz(rest);
                    e->ax[n] = lines->point[0][i];
                    e->ay[n] = lines->point[1][j];
                    e->az[n] = lines->point[2][k];
                    e->dx[n] = axis == 0 ? lines->step[0][i] : 0;
                    e->dy[n] = axis == 1 ? lines->step[1][j] : 0;
                    e->dz[n] = axis == 2 ? lines->step[2][k] : 0;
                    e->rank[n++] = (uint16_t)(axis * CSG_BLOCK_POINTS + (k * N + j) * N + i);
                }
    e->count = n;
    take_ends(block, lines, e->rank, e);
}

static int axis_of(uint16_t slot)
{
    return slot / CSG_BLOCK_POINTS;
}

bool csg_marching_keeps_roots(const csg_marching *m)
{
    return m->field->tape.shapes != NULL;
}

void csg_marching_keep_roots(const csg_slots *slots, float *along)
{
    for (uint32_t i = 0; i < slots->count; i++)
        along[i] = slots->at[slots->slot[i]][axis_of(slots->slot[i])];
}

bool csg_marching_keeps_slopes(const csg_marching *m)
{
    return csg_marching_keeps_roots(m) && !m->field->tape.turns;
}

void csg_marching_keep_slopes(const csg_slots *slots, float (*by_slot)[3], float *slopes)
{
    for (uint32_t i = 0; i < slots->count; i++)
        memcpy(slopes + (size_t)3 * i, by_slot[slots->slot[i]], sizeof *by_slot);
}

/* As the edges' roots: from a zero with a sign both make one without. */
static void place_kept(csg_edges *e, const float *along)
{
    for (uint32_t i = 0; i < e->count; i++) {
        int axis = axis_of(e->rank[i]);
        e->x[i] = axis == 0 ? along[i] : e->ax[i] + 0.0f;
        e->y[i] = axis == 1 ? along[i] : e->ay[i] + 0.0f;
        e->z[i] = axis == 2 ? along[i] : e->az[i] + 0.0f;
    }
}

uint64_t csg_marching_roots(const csg_marching *m, const csg_block *block, csg_edges *edges,
                            csg_slots *slots, float *scratch, size_t scratch_floats)
{
    csg_tape tape = m->field->tape;
    block_lines lines = lines_of(m->lattice, block);
    uint64_t evaluations = 0;
    slots->count = 0;
    for (unsigned octant = 0; octant < (block->parts ? CSG_OCTANTS : 1u); octant++) {
        const csg_block_part *part = block->parts ? &block->parts[octant] : NULL;
        if (part && part->state != CSG_CELL_SURFACE)
            continue;
        tape.nodes = part ? part->nodes : block->nodes;
        tape.count = part ? part->node_count : block->node_count;
        point_range range = part ? points_of_part(octant) : (point_range){{0, 0, 0}, {N, N, N}};
        collect_all_edges(block, &lines, range, edges);
        edges->end_distance = m->end_distance;
        if (block->along)
            place_kept(edges, block->along + slots->count);
        else if (edges->count)
            evaluations += m->kernel->roots(&tape, edges, m->noise, scratch, scratch_floats);
        for (uint32_t i = 0; i < edges->count; i++) {
            float *p = slots->at[edges->rank[i]];
            p[0] = edges->x[i], p[1] = edges->y[i], p[2] = edges->z[i];
            slots->slot[slots->count++] = edges->rank[i];
        }
    }
    return evaluations;
}

uint64_t csg_marching_shifted_roots(const csg_marching *m, const csg_block *block,
                                    csg_marching_room *room, float *scratch, size_t scratch_floats)
{
    csg_slots *slots = &room->slots;
    uint64_t evaluations =
        csg_marching_roots(m, block, &room->edges, slots, scratch, scratch_floats);
    for (uint32_t i = 0; i < slots->count; i++)
        csg_marching_shift(m, slots->at[slots->slot[i]], slots->at[slots->slot[i]]);
    return evaluations;
}

uint64_t csg_marching_corners(const csg_marching *m, const csg_block *block,
                              csg_marching_room *room, float *corners, float *scratch,
                              size_t scratch_floats)
{
    uint64_t evaluations = csg_marching_shifted_roots(m, block, room, scratch, scratch_floats);
    for (int k = 0; k < E; k++)
        for (int j = 0; j < E; j++) {
            csg_cell_rows s = csg_cell_rows_of(block, j, k);
            for (unsigned rest = s.mixed; rest; rest &= rest - 1) {
                int i = __builtin_ctz(rest), cell = (k * N + j) * N + i;
                unsigned pattern = csg_cell_pattern(&s, i);
                for (int c = 0; c < 3 * m->tables->count[pattern]; c++, corners += 3)
                    memcpy(corners, room->slots.at[cell + m->places->place[pattern][c]],
                           3 * sizeof(float));
            }
        }
    return evaluations;
}
