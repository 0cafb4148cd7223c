/* SPDX-License-Identifier: MIT
 * Values at any points; see probe.h.
 */
#include "mesh/remesh/probe.h"

#include <math.h>
#include <string.h>

#include "field/field.h"
#include "field/kernels/dispatch.h"
#include "mesh/mesh.h"

enum { NO_POINT = UINT16_MAX };

typedef struct csg_probe_room {
    float x[CSG_PROBE_MOST], y[CSG_PROBE_MOST], z[CSG_PROBE_MOST];
    float channels[4][CSG_PROBE_MOST];
    uint32_t which[CSG_PROBE_MOST]; /* points of the tape at hand */
    const csg_tape_node *nodes[CSG_PROBE_MOST];
    uint32_t node_count[CSG_PROBE_MOST];
    uint16_t next[CSG_PROBE_MOST]; /* point of the same tape; NO_POINT ends them */
    uint16_t first[CSG_PROBE_MOST], last_of[CSG_PROBE_MOST]; /* of each tape */
    uint16_t slots[2 * CSG_PROBE_MOST];                      /* tapes by the hash of their place */
    uint32_t last[3]; /* the block looked up last, and what was found: neighbours follow */
    const csg_block *found;
    bool has_last;
    uint32_t leaf; /* the same of bricks; NONE: there is none */
} csg_probe_room;

bool csg_probe_make(csg_probe *probe, const csg_marching *marching, csg_memory *memory)
{
    const csgm_field *field = marching->field;
    *probe = (csg_probe){.marching = marching,
                         .memory = memory,
                         .noise = marching->noise,
                         .scratch_floats = csg_kernel_scratch_floats(field->depth)};
    /* a little less than the octree's, for rounding */
    probe->tau = (float)(0.99 * (double)field->tape.lipschitz * marching->lattice->cell_size);
    probe->room = csg_memory_alloc(probe->memory, sizeof *probe->room);
    probe->scratch = csg_memory_alloc(probe->memory, probe->scratch_floats * sizeof(float));
    if (probe->room) {
        probe->room->has_last = false;
        probe->room->leaf = CSG_BRICK_NONE;
    }
    if (probe->room && probe->scratch)
        return true;
    csg_probe_release(probe);
    return false;
}

void csg_probe_release(csg_probe *probe)
{
    if (!probe->memory)
        return;
    csg_memory_release(probe->memory, probe->room, sizeof *probe->room);
    csg_memory_release(probe->memory, probe->scratch, probe->scratch_floats * sizeof(float));
    *probe = (csg_probe){0};
}

/* ---- which tape -------------------------------------------------------------------------------
 */

/* Whether a leaf of the brick holds a cell of the finest lattice. */
static bool is_in_leaf(const csg_bricks *b, uint32_t number, const uint32_t cell[3])
{
    const csg_brick *brick = &b->items[number];
    uint32_t own[3];
    for (int axis = 0; axis < 3; axis++) {
        own[axis] = cell[axis] >> (b->finest - brick->level);
        if (own[axis] / CSG_BRICK_EDGE != brick->at[axis])
            return false;
    }
    return !(brick->divided >> csg_brick_octant(own) & 1);
}

/* The brick whose leaf is at a place: that of the place before, as a rule. */
static uint32_t leaf_at(csg_probe_room *room, const csg_bricks *b, const float at[3])
{
    uint32_t cell[3];
    if (room->leaf == CSG_BRICK_NONE || !csg_lattice_cell_of(b->lattice, at, cell) ||
        !is_in_leaf(b, room->leaf, cell))
        room->leaf = csg_bricks_leaf_at(b, at);
    return room->leaf;
}

static void choose_tape(const csg_probe *probe, const float at[3], size_t i)
{
    const csg_marching *m = probe->marching;
    csg_probe_room *room = probe->room;
    uint32_t cell[3];
    room->nodes[i] = m->field->tape.nodes;
    room->node_count[i] = m->field->tape.count;
    if (m->bricks) {
        uint32_t found = leaf_at(room, m->bricks, at);
        if (found != CSG_BRICK_NONE) {
            csg_tape tape = csg_bricks_tape(m->bricks, &m->bricks->items[found]);
            room->nodes[i] = tape.nodes;
            room->node_count[i] = tape.count;
        }
        return;
    }
    if (!csg_lattice_cell_of(m->lattice, at, cell))
        return;
    const uint32_t place[3] = {cell[0] / CSG_BLOCK_EDGE, cell[1] / CSG_BLOCK_EDGE,
                               cell[2] / CSG_BLOCK_EDGE};
    if (!room->has_last || memcmp(room->last, place, sizeof place) != 0) {
        memcpy(room->last, place, sizeof place);
        room->found = csg_block_index_find(m->index, m->blocks, place);
        room->has_last = true;
    }
    const csg_block *block = room->found;
    if (!block)
        return;
    room->nodes[i] = block->nodes;
    room->node_count[i] = block->node_count;
    if (!block->parts)
        return;
    unsigned octant = 0;
    for (unsigned axis = 0; axis < 3; axis++)
        octant |= (cell[axis] % CSG_BLOCK_EDGE >= CSG_PART_EDGE ? 1u : 0u) << axis;
    if (block->parts[octant].state == CSG_CELL_SURFACE) {
        room->nodes[i] = block->parts[octant].nodes;
        room->node_count[i] = block->parts[octant].node_count;
    }
}

/* Links the points of each tape, in their order. How many tapes there are: their first points are
 * in the order of these. */
static size_t link_points(csg_probe_room *room, size_t count)
{
    _Static_assert((CSG_PROBE_MOST & (CSG_PROBE_MOST - 1)) == 0, "a size below is within slots");
    size_t size = 2, tapes = 0;
    while (size < 2 * count)
        size *= 2;
    memset(room->slots, 0xFF, size * sizeof *room->slots);
    for (size_t i = 0; i < count; i++) {
        uint64_t hash = (uint64_t)(uintptr_t)room->nodes[i] * UINT64_C(0x9E3779B97F4A7C15);
        size_t slot = (size_t)(hash >> 32) & (size - 1);
        while (room->slots[slot] != NO_POINT &&
               room->nodes[room->first[room->slots[slot]]] != room->nodes[i])
            slot = (slot + 1) & (size - 1);
        room->next[i] = NO_POINT;
        if (room->slots[slot] == NO_POINT) {
            room->slots[slot] = (uint16_t)tapes;
            room->first[tapes] = room->last_of[tapes] = (uint16_t)i;
            tapes++;
            continue;
        }
        uint16_t *last = &room->last_of[room->slots[slot]];
        room->next[*last] = (uint16_t)i;
        *last = (uint16_t)i;
    }
    return tapes;
}

/* Gathers the points that are linked from this one on. */
static size_t gather(csg_probe_room *room, const float (*at)[3], uint16_t first)
{
    size_t n = 0;
    for (uint16_t i = first; i != NO_POINT; i = room->next[i]) {
        room->x[n] = at[i][0];
        room->y[n] = at[i][1];
        room->z[n] = at[i][2];
        room->which[n++] = i;
    }
    size_t padded = (n + CSG_LANES - 1) / CSG_LANES * CSG_LANES;
    for (size_t i = n; i < padded; i++) {
        room->x[i] = room->x[0];
        room->y[i] = room->y[0];
        room->z[i] = room->z[0];
    }
    return n;
}

/* Calls visit once for each tape, with its points gathered. */
typedef void visit_tape(csg_probe *probe, const csg_tape *tape, size_t count, void *out);

static void each_tape(csg_probe *probe, const float (*at)[3], size_t count, visit_tape *visit,
                      void *out)
{
    csg_probe_room *room = probe->room;
    csg_tape tape = probe->marching->field->tape;
    for (size_t i = 0; i < count; i++)
        choose_tape(probe, at[i], i);
    size_t tapes = link_points(room, count);
    for (size_t k = 0; k < tapes; k++) {
        uint16_t first = room->first[k];
        tape.nodes = room->nodes[first];
        tape.count = room->node_count[first];
        visit(probe, &tape, gather(room, at, first), out);
    }
    probe->evaluations += count;
}

/* ---- what is asked ----------------------------------------------------------------------------
 */

static void visit_values(csg_probe *probe, const csg_tape *tape, size_t count, void *out)
{
    csg_probe_room *room = probe->room;
    float *f = out;
    probe->marching->kernel->values(tape, room->x, room->y, room->z, count, room->channels[0],
                                    probe->scratch, probe->scratch_floats);
    for (size_t i = 0; i < count; i++)
        f[room->which[i]] = room->channels[0][i];
}

void csg_probe_values(csg_probe *probe, const float (*at)[3], size_t count, float *out)
{
    each_tape(probe, at, count, visit_values, out);
}

typedef struct values_and_gradients {
    float *f; /* NULL: not wanted */
    float (*g)[3];
} values_and_gradients;

static void visit_gradients(csg_probe *probe, const csg_tape *tape, size_t count, void *out)
{
    csg_probe_room *room = probe->room;
    const values_and_gradients *to = out;
    float *c[3] = {room->channels[0], room->channels[1], room->channels[2]};
    probe->marching->kernel->values_and_gradients(tape, room->x, room->y, room->z, count,
                                                  room->channels[3], c[0], c[1], c[2],
                                                  probe->scratch, probe->scratch_floats);
    for (size_t i = 0; i < count; i++) {
        if (to->f)
            to->f[room->which[i]] = room->channels[3][i];
        for (int k = 0; k < 3; k++)
            to->g[room->which[i]][k] = c[k][i];
    }
}

void csg_probe_gradients(csg_probe *probe, const float (*at)[3], size_t count, float (*out)[3])
{
    csg_probe_values_and_gradients(probe, at, count, NULL, out);
}

void csg_probe_values_and_gradients(csg_probe *probe, const float (*at)[3], size_t count, float *f,
                                    float (*g)[3])
{
    values_and_gradients out = {f, g};
    each_tape(probe, at, count, visit_gradients, &out);
}

static void visit_true_gradients(csg_probe *probe, const csg_tape *tape, size_t count, void *out)
{
    csg_probe_room *room = probe->room;
    float(*g)[3] = out;
    float *const c[3] = {room->channels[0], room->channels[1], room->channels[2]};
    csg_marching_gradients(probe->marching, tape, room->x, room->y, room->z, count, c,
                           probe->scratch, probe->scratch_floats);
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            g[room->which[i]][k] = c[k][i];
}

void csg_probe_true_gradients(csg_probe *probe, const float (*at)[3], size_t count, float (*out)[3])
{
    each_tape(probe, at, count, visit_true_gradients, out);
}

/* ---- colours and materials --------------------------------------------------------------------
 */

static void visit_colors(csg_probe *probe, const csg_tape *tape, size_t count, void *out)
{
    csg_probe_room *room = probe->room;
    uint8_t(*rgba)[4] = out;
    float *channels[4] = {room->channels[0], room->channels[1], room->channels[2],
                          room->channels[3]};
    probe->marching->kernel->colors(tape, room->x, room->y, room->z, count, channels,
                                    probe->scratch, probe->scratch_floats);
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 4; c++)
            rgba[room->which[i]][c] = csg_mesh_color_byte(channels[c][i]);
}

static void visit_materials(csg_probe *probe, const csg_tape *tape, size_t count, void *out)
{
    csg_probe_room *room = probe->room;
    uint16_t(*pair)[2] = out;
    float *channels[4] = {room->channels[0], room->channels[1], room->channels[2],
                          room->channels[3]};
    csg_tape shaded = *tape;
    shaded.colors = probe->marching->field->materials;
    if (shaded.colors)
        probe->marching->kernel->colors(&shaded, room->x, room->y, room->z, count, channels,
                                        probe->scratch, probe->scratch_floats);
    for (size_t i = 0; i < count; i++) {
        float m = shaded.colors ? channels[0][i] : csg_default_material.r;
        float r = shaded.colors ? channels[1][i] : csg_default_material.g;
        pair[room->which[i]][0] = csg_mesh_material_share(m);
        pair[room->which[i]][1] = csg_mesh_material_share(r);
    }
}

void csg_probe_looks(csg_probe *probe, const float (*at)[3], size_t count, uint8_t (*colors)[4],
                     uint16_t (*materials)[2])
{
    if (colors)
        each_tape(probe, at, count, visit_colors, colors);
    if (materials)
        each_tape(probe, at, count, visit_materials, materials);
}
