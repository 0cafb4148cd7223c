/* SPDX-License-Identifier: MIT
 * Sorting points by the tape that knows them; see probe.h. Inside the band every tape that
 * covers a point gives the same bits, so neither the block at hand nor pruning changes an answer.
 */
#include "mesh/features/probe.h"

#include <math.h>

enum { WHOLE_BLOCK = CSG_OCTANTS, AROUND, UNKNOWN, DOMAINS };

csg_feature_probe csg_feature_probe_of(const csg_marching *m, const csg_block *block,
                                       csg_feature_around *around, csg_memory *memory,
                                       float *scratch, size_t scratch_floats)
{
    csg_feature_probe probe = {.marching = m,
                               .block = block,
                               .around = around,
                               .memory = memory,
                               .scratch = scratch,
                               .scratch_floats = scratch_floats};
    for (int axis = 0; axis < 3 && block; axis++)
        for (uint32_t i = 0; i < CSG_BLOCK_SAMPLES; i++)
            probe.line[axis][i] =
                csg_lattice_coordinate(m->lattice, axis, block->at[axis] * CSG_BLOCK_EDGE + i);
    return probe;
}

static int domain_of(const csg_feature_probe *p, float x, float y, float z)
{
    const float at[3] = {x, y, z};
    unsigned octant = 0;
    bool inside = p->block != NULL;
    for (int axis = 0; axis < 3 && inside; axis++) {
        const float *line = p->line[axis];
        inside = inside && at[axis] >= line[0] && at[axis] <= line[CSG_BLOCK_EDGE];
        octant |= (unsigned)(at[axis] > line[CSG_PART_EDGE]) << axis;
    }
    int far = p->marching->field->tape.count <= CSG_FEATURE_PROBE_MOST_NODES ? AROUND : UNKNOWN;
    if (!inside)
        return far;
    if (!p->block->parts)
        return WHOLE_BLOCK;
    return p->block->parts[octant].state == CSG_CELL_SURFACE ? (int)octant : far;
}

static csg_tape tape_of(const csg_feature_probe *p, int domain)
{
    csg_tape tape = p->marching->field->tape;
    if (domain == AROUND)
        return p->around->tape;
    if (domain == WHOLE_BLOCK) {
        tape.nodes = p->block->nodes;
        tape.count = p->block->node_count;
    } else {
        tape.nodes = p->block->parts[domain].nodes;
        tape.count = p->block->parts[domain].node_count;
    }
    return tape;
}

typedef struct gathered {
    float x[CSG_BATCH], y[CSG_BATCH], z[CSG_BATCH], f[CSG_BATCH], g[3][CSG_BATCH];
    uint32_t from[CSG_BATCH];
} gathered;

static void ask(csg_feature_probe *p, int domain, gathered *at, size_t count, float *f,
                float *const g[3])
{
    csg_tape tape = tape_of(p, domain);
    const csg_kernel *kernel = p->marching->kernel;
    for (size_t i = count; i % CSG_LANES; i++)
        at->x[i] = at->x[0], at->y[i] = at->y[0], at->z[i] = at->z[0];
    kernel->values_and_gradients(&tape, at->x, at->y, at->z, count, at->f, at->g[0], at->g[1],
                                 at->g[2], p->scratch, p->scratch_floats);
    p->evaluations += count;
    for (size_t i = 0; i < count; i++) {
        uint32_t to = at->from[i];
        if (f)
            f[to] = at->f[i];
        for (int axis = 0; axis < 3; axis++)
            g[axis][to] = at->g[axis][i];
    }
}

static void unknown(const gathered *at, size_t count, float *f, float *const g[3])
{
    for (size_t i = 0; i < count; i++) {
        uint32_t to = at->from[i];
        if (f)
            f[to] = NAN;
        g[0][to] = g[1][to] = g[2][to] = 0;
    }
}

/* Cells beyond a block, or a point, that its cube holds: more than apexes reach. */
enum { BEYOND = 5 };

/* Has the cube hold the point. */
static void move_around(csg_feature_probe *p, float x, float y, float z)
{
    const csg_marching *m = p->marching;
    float center[3] = {x, y, z}, cell = (float)m->lattice->cell_size;
    if (csg_feature_around_holds(p->around, x, y, z))
        return;
    for (int axis = 0; axis < 3 && p->block; axis++)
        center[axis] = p->line[axis][CSG_BLOCK_EDGE / 2];
    float half = (CSG_BLOCK_EDGE / 2 + BEYOND) * cell;
    csg_feature_around_move(p->around, p->memory, m, center, half);
    if (!csg_feature_around_holds(p->around, x, y, z))
        csg_feature_around_move(p->around, p->memory, m, (float[3]){x, y, z}, half);
}

/* Points [first, end), at most a batch, by their domains; DOMAINS is for those that are done. */
static void probe_domain(csg_feature_probe *p, int d, uint8_t *domain, const float *x,
                         const float *y, const float *z, size_t first, size_t end, float *f,
                         float *const g[3])
{
    gathered at;
    size_t count = 0;
    for (size_t i = first; i < end; i++) {
        if (domain[i - first] != d)
            continue;
        if (d == AROUND && !count)
            move_around(p, x[i], y[i], z[i]);
        if (d == AROUND && count && !csg_feature_around_holds(p->around, x[i], y[i], z[i]))
            continue;
        at.x[count] = x[i], at.y[count] = y[i], at.z[count] = z[i];
        at.from[count++] = (uint32_t)i;
        domain[i - first] = DOMAINS;
    }
    if (d == UNKNOWN)
        unknown(&at, count, f, g);
    else
        ask(p, d, &at, count, f, g);
}

static void probe_batch(csg_feature_probe *p, const float *x, const float *y, const float *z,
                        size_t first, size_t end, float *f, float *const g[3])
{
    uint8_t domain[CSG_BATCH];
    for (size_t i = first; i < end; i++)
        domain[i - first] = (uint8_t)domain_of(p, x[i], y[i], z[i]);
    for (size_t i = first; i < end; i++)
        if (domain[i - first] != DOMAINS)
            probe_domain(p, domain[i - first], domain, x, y, z, first, end, f, g);
}

void csg_feature_probe_points(csg_feature_probe *p, const float *x, const float *y, const float *z,
                              size_t count, float *f, float *const g[3])
{
    for (size_t i = 0; i < count; i += CSG_BATCH)
        probe_batch(p, x, y, z, i, i + CSG_BATCH < count ? i + CSG_BATCH : count, f, g);
}
