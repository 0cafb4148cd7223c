/* SPDX-License-Identifier: MIT
 * Sampling a block; see block.h.
 */
#include "grid/octree/block.h"

#include <math.h>
#include <string.h>

enum { N = CSG_BLOCK_SAMPLES };

/* count copies of the first `period` floats, in place. */
static void repeat(float *array, size_t period, size_t count)
{
    for (size_t i = 1; i < count; i++)
        memcpy(array + i * period, array, period * sizeof(float));
}

/* Coordinates of the n^3 points from lattice point `first` on, padded to whole lanes. */
static void fill_coordinates(csg_block_samples *samples, const csg_lattice *lattice,
                             const uint32_t first[3], size_t n)
{
    float line[3][N];
    for (int axis = 0; axis < 3; axis++)
        for (uint32_t i = 0; i < n; i++)
            line[axis][i] = csg_lattice_coordinate(lattice, axis, first[axis] + i);
    memcpy(samples->x, line[0], n * sizeof(float));
    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < n; i++)
            samples->y[j * n + i] = line[1][j];
    repeat(samples->x, n, n * n);
    repeat(samples->y, n * n, n);
    for (size_t k = 0; k < n; k++)
        for (size_t i = 0; i < n * n; i++)
            samples->z[k * n * n + i] = line[2][k];
    for (size_t i = n * n * n; i % CSG_LANES; i++) {
        samples->x[i] = samples->x[0];
        samples->y[i] = samples->y[0];
        samples->z[i] = samples->z[0];
    }
}

static void sample_points(csg_block_samples *samples, const csg_kernel *kernel,
                          const csg_tape *tape, const csg_lattice *lattice, const uint32_t first[3],
                          size_t n, float *scratch, size_t scratch_floats)
{
    fill_coordinates(samples, lattice, first, n);
    kernel->values(tape, samples->x, samples->y, samples->z, n * n * n, samples->f, scratch,
                   scratch_floats);
    if (samples->scan)
        csg_scan_values(samples->scan, samples->f, n, first);
}

/* The whole block with one tape. */
static void sample_whole(csg_block *block, csg_block_samples *samples, const csg_kernel *kernel,
                         const csg_tape *tape, const csg_lattice *lattice, float *scratch,
                         size_t scratch_floats)
{
    uint32_t first[3];
    for (int axis = 0; axis < 3; axis++)
        first[axis] = block->at[axis] * CSG_BLOCK_EDGE;
    sample_points(samples, kernel, tape, lattice, first, N, scratch, scratch_floats);
    for (int i = 0; i < CSG_BLOCK_POINTS; i++)
        samples->inside[i] = samples->f[i] >= 0;
    if (csg_block_keeps_ends(tape))
        memcpy(samples->values, samples->f, sizeof samples->values);
}

/* What is known of a part, in the whole block; its values, if they are kept. */
static void take_part(csg_block_samples *samples, size_t begin, csg_cell_state state, bool keeps)
{
    enum { P = CSG_PART_EDGE + 1 };
    const float *f = samples->f;
    for (size_t k = 0; k < P; k++)
        for (size_t j = 0; j < P; j++, f += P) {
            size_t at = begin + (k * N + j) * N;
            uint8_t *row = samples->inside + at;
            for (size_t i = 0; i < P; i++)
                row[i] = state != CSG_CELL_SURFACE ? state == CSG_CELL_INSIDE : f[i] >= 0;
            if (keeps && state == CSG_CELL_SURFACE)
                memcpy(samples->values + at, f, P * sizeof *f);
        }
}

/* Part by part. Points on the planes between parts are in several: they agree in sign. */
static void sample_parts(csg_block *block, csg_block_samples *samples, const csg_kernel *kernel,
                         const csg_tape *tape, const csg_lattice *lattice, float *scratch,
                         size_t scratch_floats)
{
    enum { P = CSG_PART_EDGE + 1 };
    bool keeps = csg_block_keeps_ends(tape);
    for (int i = 0; keeps && i < CSG_BLOCK_POINTS; i++)
        samples->values[i] = NAN;
    for (unsigned octant = 0; octant < CSG_OCTANTS; octant++) {
        const csg_block_part *part = &block->parts[octant];
        uint32_t first[3];
        size_t begin = 0;
        const size_t step[3] = {1, N, N * N};
        for (int axis = 0; axis < 3; axis++) {
            uint32_t shift = (octant >> axis & 1) * CSG_PART_EDGE;
            first[axis] = block->at[axis] * CSG_BLOCK_EDGE + shift;
            begin += shift * step[axis];
        }
        csg_tape short_tape = *tape;
        short_tape.nodes = part->nodes;
        short_tape.count = part->node_count;
        if (part->state == CSG_CELL_SURFACE)
            sample_points(samples, kernel, &short_tape, lattice, first, P, scratch, scratch_floats);
        take_part(samples, begin, part->state, keeps);
    }
}

/* Bits of the points 0..8 of this block along an axis that lie strictly inside the lattice. */
static uint16_t inner_points(const csg_lattice *lattice, int axis, uint32_t at)
{
    uint16_t bits = 0;
    for (uint32_t i = 0; i < N; i++) {
        uint32_t index = at * CSG_BLOCK_EDGE + i;
        bits |= (uint16_t)((index > 0 && index < lattice->cells[axis]) << i);
    }
    return bits;
}

/* Rows of signs, f = 0 inside; what is on the lattice's border or beyond is outside. */
static void collect_signs(csg_block *block, const csg_lattice *lattice, const uint8_t *s)
{
    uint16_t inner[3];
    for (int axis = 0; axis < 3; axis++)
        inner[axis] = inner_points(lattice, axis, block->at[axis]);
    for (int k = 0; k < N; k++)
        for (int j = 0; j < N; j++, s += N) {
            uint64_t eight;
            memcpy(&eight, s, sizeof eight);
            /* gathers the lowest bits of eight bytes (little endian) into the top byte */
            uint16_t row = (uint16_t)((eight * 0x0102040810204080u) >> 56 | (uint64_t)s[8] << 8);
            int on = inner[1] >> j & inner[2] >> k & 1;
            block->inside[k][j] = on ? row & inner[0] : 0;
        }
}

/* Points of a row all of whose neighbours within the block have the other sign. */
static unsigned alone_in_row(uint16_t (*rows)[N], int j, int k)
{
    enum { ALL = (1 << N) - 1 };
    unsigned r = rows[k][j], any = 0, all = ALL; /* of the rows around */
    const int at[4][2] = {{j - 1, k}, {j + 1, k}, {j, k - 1}, {j, k + 1}};
    for (int i = 0; i < 4; i++) {
        if (at[i][0] < 0 || at[i][0] >= N || at[i][1] < 0 || at[i][1] >= N)
            continue;
        any |= rows[at[i][1]][at[i][0]];
        all &= rows[at[i][1]][at[i][0]];
    }
    unsigned inside = r & ~(r << 1) & ~(r >> 1) & ~any;
    unsigned outside = ~r & (r << 1 | 1) & (r >> 1 | 1 << (N - 1)) & all;
    return (inside | outside) & ALL;
}

static void drop_beads(csg_block *block, csg_beads *beads)
{
    uint16_t before[N][N];
    memcpy(before, block->inside, sizeof before);
    for (int k = 0; k < N; k++)
        for (int j = 0; j < N; j++)
            for (unsigned rest = alone_in_row(before, j, k); rest; rest &= rest - 1) {
                int i = __builtin_ctz(rest);
                const uint32_t at[3] = {block->at[0] * CSG_BLOCK_EDGE + (uint32_t)i,
                                        block->at[1] * CSG_BLOCK_EDGE + (uint32_t)j,
                                        block->at[2] * CSG_BLOCK_EDGE + (uint32_t)k};
                if (csg_bead_is(beads, at))
                    block->inside[k][j] ^= (uint16_t)(1 << i);
            }
}

static void collect_crossings(csg_block *block)
{
    uint32_t count = 0;
    for (int axis = 0; axis < 3; axis++)
        for (int k = 0; k < CSG_BLOCK_EDGE; k++) {
            uint64_t word = 0;
            for (int j = 0; j < CSG_BLOCK_EDGE; j++) {
                uint16_t row = block->inside[k][j];
                uint16_t other = axis == 0   ? (uint16_t)(row >> 1)
                                 : axis == 1 ? block->inside[k][j + 1]
                                             : block->inside[k + 1][j];
                word |= (uint64_t)((row ^ other) & 0xFF) << (8 * j);
            }
            block->crossed[axis][k] = word;
            block->rank[axis][k] = (uint16_t)count;
            count += (uint32_t)__builtin_popcountll(word);
        }
    block->vertex_count = count;
}

/* Whether all points agree: most sampled blocks without a surface leave here. */
static bool is_uniform(const csg_block *block)
{
    uint16_t any = 0, all = 0x1FF;
    for (int k = 0; k < N; k++)
        for (int j = 0; j < N; j++) {
            any |= block->inside[k][j];
            all &= block->inside[k][j];
        }
    return any == 0 || all == 0x1FF;
}

bool csg_block_sample(csg_block *block, const csg_kernel *kernel, const csg_tape *tape,
                      const csg_lattice *lattice, const uint32_t at[3], csg_beads *beads,
                      csg_block_samples *samples, float *scratch, size_t scratch_floats)
{
    memcpy(block->at, at, sizeof block->at);
    block->nodes = tape->nodes;
    block->node_count = tape->count;
    block->along = block->slopes = block->ends = NULL;
    (block->parts ? sample_parts : sample_whole)(block, samples, kernel, tape, lattice, scratch,
                                                 scratch_floats);
    collect_signs(block, lattice, samples->inside);
    if (beads && !is_uniform(block))
        drop_beads(block, beads);
    if (is_uniform(block))
        return false;
    collect_crossings(block);
    /* A block may touch the surface with its shared upper faces only: its cells still need
     * triangles, so it stays even without an edge of its own. */
    return true;
}

/* ---- ends of crossed edges --------------------------------------------------------------------
 */

/* Points that are such ends, in rows as block->inside; returns how many. */
static uint32_t find_ends(const csg_block *block, uint16_t rows[N][N])
{
    uint32_t count = 0;
    memset(rows, 0, N * sizeof *rows);
    for (int k = 0; k < N; k++)
        for (int j = 0; j < N; j++) {
            uint16_t row = block->inside[k][j];
            unsigned x = (row ^ row >> 1) & ((1u << (N - 1)) - 1);
            uint16_t y = j + 1 < N ? row ^ block->inside[k][j + 1] : 0;
            uint16_t z = k + 1 < N ? row ^ block->inside[k + 1][j] : 0;
            rows[k][j] |= (uint16_t)(x | x << 1 | y | z);
            if (y)
                rows[k][j + 1] |= y;
            if (z)
                rows[k + 1][j] |= z;
            count += (uint32_t)__builtin_popcount(rows[k][j]); /* nothing is added to it later */
        }
    return count;
}

/* False: some are not known, or signs have been changed since. An edge between values of both signs
 * is within the band, where they are what everybody finds. */
static bool pack_ends(const csg_block *block, uint16_t rows[N][N], const float *values, float *ends)
{
    for (int k = 0; k < N; k++)
        for (int j = 0; j < N; j++, values += N)
            for (unsigned rest = rows[k][j]; rest; rest &= rest - 1) {
                int i = __builtin_ctz(rest);
                bool inside = block->inside[k][j] >> i & 1;
                if (isnan(values[i]) || (values[i] >= 0) != inside)
                    return false;
                *ends++ = values[i];
            }
    return true;
}

bool csg_block_keep_ends(csg_block *block, const csg_block_samples *samples, csg_arena *arena)
{
    uint16_t rows[N][N];
    csg_arena_mark mark = csg_arena_get_mark(arena);
    float *ends = csg_arena_alloc(arena, find_ends(block, rows) * sizeof *ends);
    if (ends && pack_ends(block, rows, samples->values, ends))
        block->ends = ends;
    else
        csg_arena_release_to(arena, mark);
    return ends;
}

void csg_block_unpack_ends(const csg_block *block, float values[CSG_BLOCK_POINTS])
{
    uint16_t rows[N][N];
    const float *ends = block->ends;
    find_ends(block, rows);
    for (int k = 0; k < N; k++)
        for (int j = 0; j < N; j++, values += N)
            for (unsigned rest = rows[k][j]; rest; rest &= rest - 1)
                values[__builtin_ctz(rest)] = *ends++;
}
