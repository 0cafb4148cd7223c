/* SPDX-License-Identifier: MIT
 * One cell of marching cubes; see cell.h.
 */
#include "mesh/features/cell.h"

#include <string.h>

#include "field/field.h"

enum { E = CSG_BLOCK_EDGE, CUBE = 2 * E /* cells of a frontier cube's edge */ };

/* The tape of the frontier's cube that has a cell. False: the surface is not there. */
static bool tape_of_frontier(const csg_octree *octree, const uint32_t cell[3], csg_tape *tape)
{
    const uint32_t cube[3] = {cell[0] / CUBE, cell[1] / CUBE, cell[2] / CUBE};
    uint32_t at[3];
    size_t found = csg_octree_find(octree, cube);
    if (found == csg_octree_frontier_count(octree))
        return false;
    *tape = csg_octree_frontier_tape(octree, found, at);
    return true;
}

/* Which corners have been given the other sign, as blocks do: those that differ from all three next
 * to them may. */
static unsigned beads_of(csg_beads *beads, const uint32_t cell[3], unsigned pattern)
{
    unsigned found = 0;
    for (unsigned c = 0; c < 8; c++) {
        unsigned own = pattern >> c & 1;
        const uint32_t at[3] = {cell[0] + (c & 1), cell[1] + (c >> 1 & 1), cell[2] + (c >> 2 & 1)};
        if ((pattern >> (c ^ 1) & 1) != own && (pattern >> (c ^ 2) & 1) != own &&
            (pattern >> (c ^ 4) & 1) != own)
            found |= (unsigned)csg_bead_is(beads, at) << c;
    }
    return found;
}

/* The lattice's border is outside by decree. */
static unsigned pattern_of(const csg_marching *m, const csg_tape *tape, const uint32_t cell[3],
                           float *scratch, size_t scratch_floats)
{
    float x[CSG_LANES], y[CSG_LANES], z[CSG_LANES], f[CSG_LANES];
    unsigned pattern = 0, border = 0;
    for (unsigned c = 0; c < CSG_LANES; c++) { /* the lanes behind the corners repeat the first */
        unsigned corner = c < 8 ? c : 0;
        const uint32_t at[3] = {cell[0] + (corner & 1), cell[1] + (corner >> 1 & 1),
                                cell[2] + (corner >> 2 & 1)};
        x[c] = csg_lattice_coordinate(m->lattice, 0, at[0]);
        y[c] = csg_lattice_coordinate(m->lattice, 1, at[1]);
        z[c] = csg_lattice_coordinate(m->lattice, 2, at[2]);
        for (int axis = 0; axis < 3; axis++)
            border |= (unsigned)(at[axis] == 0 || at[axis] >= m->lattice->cells[axis]) << corner;
    }
    m->kernel->values(tape, x, y, z, 8, f, scratch, scratch_floats);
    for (unsigned c = 0; c < 8; c++)
        pattern |= (unsigned)(f[c] >= 0) << c;
    pattern &= ~border;
    csg_beads beads = {.kernel = m->kernel,
                       .tape = &m->field->tape,
                       .lattice = m->lattice,
                       .scratch = scratch,
                       .scratch_floats = scratch_floats};
    return pattern ^ beads_of(&beads, cell, pattern);
}

static void add_edge(const csg_marching *m, const uint32_t cell[3], unsigned edge, csg_edges *e)
{
    const uint8_t *o = m->tables->offset[edge];
    uint32_t n = e->count++;
    float low[3], step[3] = {0, 0, 0};
    for (int axis = 0; axis < 3; axis++)
        low[axis] = csg_lattice_coordinate(m->lattice, axis, cell[axis] + o[axis]);
    int along = (int)edge / 4;
    step[along] = csg_lattice_coordinate(m->lattice, along, cell[along] + 1) - low[along];
    e->ax[n] = low[0], e->ay[n] = low[1], e->az[n] = low[2];
    e->dx[n] = step[0], e->dy[n] = step[1], e->dz[n] = step[2];
    e->rank[n] = (uint16_t)edge;
}

static unsigned crossed_edges(const csg_cell_tables *tables, unsigned pattern)
{
    unsigned crossed = 0;
    for (int i = 0; i < 3 * tables->count[pattern]; i++)
        crossed |= 1u << tables->edge[pattern][i];
    return crossed;
}

/* In memory; NULL: it is not, or the surface does not touch it. */
static const csg_block *block_of(const csg_octree *octree, const uint32_t cell[3])
{
    const uint32_t at[3] = {cell[0] / E, cell[1] / E, cell[2] / E};
    size_t low = 0, high;
    csg_block *const *blocks = csg_octree_blocks(octree, &high);
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        int order = csg_lattice_compare_morton(blocks[middle]->at, at);
        if (!order)
            return blocks[middle];
        low = order < 0 ? middle + 1 : low;
        high = order < 0 ? high : middle;
    }
    return NULL;
}

/* From a block in memory. */
static unsigned pattern_in_block(const csg_block *block, const uint32_t cell[3], csg_tape *tape)
{
    const int own[3] = {(int)(cell[0] % E), (int)(cell[1] % E), (int)(cell[2] % E)};
    csg_cell_rows rows = csg_cell_rows_of(block, own[1], own[2]);
    csg_block_choose_tape(block, own, tape);
    return csg_cell_pattern(&rows, own[0]);
}

uint64_t csg_feature_cell_find(const csg_marching *m, const csg_octree *octree,
                               const uint32_t cell[3], csg_edges *edges, float *scratch,
                               size_t scratch_floats, csg_feature_cell *out)
{
    const csg_block *block = block_of(octree, cell);
    csg_tape tape = m->field->tape;
    uint64_t evaluations = 0;
    out->pattern = 0;
    if (block) {
        out->pattern = pattern_in_block(block, cell, &tape);
    } else if (tape_of_frontier(octree, cell, &tape)) {
        out->pattern = pattern_of(m, &tape, cell, scratch, scratch_floats);
        evaluations = 8;
    }
    if (!m->tables->count[out->pattern])
        return evaluations;
    edges->count = 0;
    edges->has_ends = false;
    edges->end_distance = m->end_distance;
    for (unsigned rest = crossed_edges(m->tables, out->pattern); rest; rest &= rest - 1)
        add_edge(m, cell, (unsigned)__builtin_ctz(rest), edges);
    evaluations += m->kernel->roots(&tape, edges, m->noise, scratch, scratch_floats);
    for (uint32_t i = 0; i < edges->count; i++) {
        float *to = out->at[edges->rank[i]];
        to[0] = edges->x[i], to[1] = edges->y[i], to[2] = edges->z[i];
    }
    return evaluations;
}
