/* SPDX-License-Identifier: MIT
 * Which diagonals of faces are joined; see pair.h. Asked are the face alone and the field
 * on it, in an order that does not depend on the cell: so both cells, and both blocks, say the
 * same. A face is joined where the solid is at its middle, and the segments round an inside corner
 * cross a crease: there the surface cannot follow them.
 */
#include "mesh/features/pair.h"

#include <math.h>
#include <string.h>

enum { N = CSG_BLOCK_SAMPLES, E = CSG_BLOCK_EDGE, ROUND = 4 };

/* At a lattice point of the block, across an axis. */
typedef struct face {
    int axis, at[3];
} face;

static unsigned inside_at(const csg_block *block, const int at[3])
{
    return block->inside[at[2]][at[1]] >> at[0] & 1u;
}

/* Corner i of a face, counter-clockwise about its axis; each but the last has the edge to the next.
 */
static void corner_of(const face *f, int i, int at[3])
{
    memcpy(at, f->at, sizeof f->at);
    at[(f->axis + 1) % 3] += i == 1 || i == 2;
    at[(f->axis + 2) % 3] += i >= 2;
}

/* The slot of the edge from corner i to the next. */
static int slot_of(const face *f, int i)
{
    int at[3];
    corner_of(f, i == 2 ? 3 : i == 3 ? 0 : i, at);
    return (f->axis + 1 + i % 2) % 3 * CSG_BLOCK_POINTS + (at[2] * N + at[1]) * N + at[0];
}

/* Those with their lowest corner in a row, bit by bit. */
static unsigned faces_in_row(const csg_block *block, int axis, int j, int k)
{
    int up = axis == 1 || j == E ? j : j + 1, out = axis == 2 || k == E ? k : k + 1;
    unsigned a = block->inside[k][j], b = block->inside[out][up];
    if ((axis != 1 && j == E) || (axis != 2 && k == E))
        return 0;
    if (axis == 0)
        return (a ^ block->inside[k][up]) & (a ^ block->inside[out][j]) & ~(a ^ b);
    return (a ^ b) & (a ^ a >> 1) & (b ^ b >> 1) & ((1u << E) - 1);
}

/* What faces_in_row() finds in any row, in loops that the compiler makes vectors of: every block
 * asks. */
bool csg_feature_has_pairs(const csg_block *block)
{
    const uint16_t(*in)[N] = block->inside;
    uint16_t across_x = 0, others = 0;
    for (int k = 0; k < N; k++)
        for (int j = 0; j < E; j++) {
            uint16_t a = in[k][j], b = in[k][j + 1];
            others |= (uint16_t)((a ^ b) & (a ^ a >> 1) & (b ^ b >> 1));
        }
    for (int k = 0; k < E; k++)
        for (int j = 0; j < N; j++) {
            uint16_t a = in[k][j], b = in[k + 1][j];
            others |= (uint16_t)((a ^ b) & (a ^ a >> 1) & (b ^ b >> 1));
        }
    for (int k = 0; k < E; k++)
        for (int j = 0; j < E; j++) {
            uint16_t a = in[k][j];
            across_x |=
                (uint16_t)((a ^ in[k][j + 1]) & (a ^ in[k + 1][j]) & ~(a ^ in[k + 1][j + 1]));
        }
    return across_x || (others & ((1u << E) - 1));
}

static void ask(csg_feature_probe *probe, const float at[3], float *f, float gradient[3])
{
    csg_feature_probe_points(probe, &at[0], &at[1], &at[2], 1, f,
                             (float *const[3]){&gradient[0], &gradient[1], &gradient[2]});
}

/* Whether the gradient jumps between two vertices, however near to each other. */
static bool jumps(const csg_feature_room *room, int from, int to, csg_feature_probe *probe)
{
    enum { HALVINGS = 10 };
    const float *a = room->slots.at[from], *b = room->slots.at[to];
    float low[3], high[3], middle[3], at[3], left = 0, right = 1;
    memcpy(low, room->gradient[from], sizeof low);
    memcpy(high, room->gradient[to], sizeof high);
    for (int step = 0; step < HALVINGS; step++) {
        float t = 0.5f * (left + right);
        for (int axis = 0; axis < 3; axis++)
            at[axis] = a[axis] + t * (b[axis] - a[axis]);
        ask(probe, at, NULL, middle);
        float before = 1.0f - csg_feature_cosine(low, middle);
        float after = 1.0f - csg_feature_cosine(middle, high);
        if (!(fmaxf(before, after) > CSG_FEATURE_LEAST_JUMP))
            return false;
        bool first = before >= after;
        memcpy(first ? high : low, middle, sizeof middle);
        *(first ? &right : &left) = t;
    }
    return true;
}

/* Whether the corners of one of the cells at the face alternate all: there loops of several joined
 * faces could run through one another. The other block's signs are asked for; where they are not
 * known neither block joins the face. */
static bool alternates(const face *f, int side, csg_feature_probe *probe)
{
    const csg_lattice *lattice = probe->marching->lattice;
    float x[ROUND], y[ROUND], z[ROUND], value[ROUND], g[3][ROUND];
    float *const to[3] = {x, y, z};
    bool border[ROUND] = {false}, differ = true;
    int at[3];
    for (int i = 0; i < ROUND; i++) {
        corner_of(f, i, at);
        at[f->axis] += side ? 1 : -1;
        for (int axis = 0; axis < 3; axis++) {
            uint32_t index = probe->block->at[axis] * E + (uint32_t)at[axis];
            border[i] = border[i] || index == 0 || index >= lattice->cells[axis];
            to[axis][i] = csg_lattice_coordinate(lattice, axis, index);
        }
    }
    csg_feature_probe_points(probe, x, y, z, ROUND, value, (float *const[3]){g[0], g[1], g[2]});
    for (int i = 0; i < ROUND && differ; i++) {
        corner_of(f, i, at);
        bool far = value[i] >= 0 && !border[i];
        differ = value[i] != value[i] || far != inside_at(probe->block, at);
    }
    return differ;
}

static bool is_joined(const csg_feature_room *room, const face *f, csg_feature_probe *probe)
{
    int first[3], last[3];
    float middle[3], value, gradient[3];
    corner_of(f, 0, first);
    corner_of(f, 2, last);
    for (int axis = 0; axis < 3; axis++)
        middle[axis] = 0.5f * (probe->line[axis][first[axis]] + probe->line[axis][last[axis]]);
    ask(probe, middle, &value, gradient);
    if (!(value >= 0))
        return false;
    int inside = inside_at(probe->block, first) ? 0 : 1; /* the first inside corner */
    for (int i = inside; i < ROUND; i += 2)
        if (!jumps(room, slot_of(f, (i + ROUND - 1) % ROUND), slot_of(f, i), probe))
            return false;
    return !alternates(f, 0, probe) && !alternates(f, 1, probe);
}

/* To the cells on both sides, as far as they are the block's. */
static void mark_joined(csg_feature_room *room, const face *f)
{
    for (int side = 0; side < 2; side++) { /* of the cell */
        int at[3] = {f->at[0], f->at[1], f->at[2]};
        at[f->axis] -= side;
        if (at[f->axis] >= 0 && at[f->axis] < E)
            room->joined[(at[2] * E + at[1]) * E + at[0]] |= (uint8_t)(1u << (2 * f->axis + side));
    }
}

bool csg_feature_pair(csg_feature_room *room, csg_feature_probe *probe)
{
    bool any = false;
    memset(room->joined, 0, sizeof room->joined);
    for (int axis = 0; axis < 3; axis++)
        for (int k = 0; k < N; k++)
            for (int j = 0; j < N; j++)
                for (unsigned rest = faces_in_row(probe->block, axis, j, k); rest;
                     rest &= rest - 1) {
                    face f = {axis, {__builtin_ctz(rest), j, k}};
                    if (!is_joined(room, &f, probe))
                        continue;
                    mark_joined(room, &f);
                    any = true;
                }
    return any;
}

csg_cell_loops csg_feature_loops(const csg_feature_room *room, const csg_cell_tables *tables,
                                 unsigned cell, unsigned pattern)
{
    if (room->any_joined && room->joined[cell])
        return csg_cell_loops_of(pattern, room->joined[cell]);
    csg_cell_loops loops = {.count = tables->loop_count[pattern]};
    memcpy(loops.sides, tables->loop_sides[pattern], sizeof loops.sides);
    memcpy(loops.edge, tables->loop_edge[pattern], sizeof loops.edge);
    return loops;
}
