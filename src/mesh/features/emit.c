/* SPDX-License-Identifier: MIT
 * Blocks with features; see emit.h.
 */
#include "mesh/features/emit.h"

#include <math.h>
#include <string.h>

#include "field/field.h"

enum { N = CSG_BLOCK_SAMPLES, E = CSG_BLOCK_EDGE };

/* ---- vertices -------------------------------------------------------------------------------- */

static uint32_t copies_of(const csg_feature *f, bool split)
{
    return split ? f->sheet_count : 1;
}

/* The mean of the sheets' normals. */
static void mean_normal(const csg_feature *f, float out[3])
{
    float n[3] = {0, 0, 0}, square = 0;
    for (int k = 0; k < f->sheet_count; k++)
        for (int i = 0; i < 3; i++)
            n[i] += f->normal[k][i];
    for (int i = 0; i < 3; i++)
        square += n[i] * n[i];
    if (!(square > 1e-12f)) {
        memcpy(out, f->normal[0], 3 * sizeof(float));
        return;
    }
    for (int i = 0; i < 3; i++)
        out[i] = n[i] / sqrtf(square) + 0.0f;
}

/* The corner of a sheet that is nearest to the apex: a vertex of the mesh, whose colour is known
 * to be the sheet's. */
static const float *nearest_corner(const csg_feature *f, int sheet)
{
    const float *nearest = f->side[0].corner;
    float least = INFINITY;
    for (int s = 0; s < f->side_count; s++) {
        const float *c = f->side[s].corner;
        float x = c[0] - f->at[0], y = c[1] - f->at[1], z = c[2] - f->at[2];
        float square = x * x + y * y + z * z;
        if (f->side[s].sheet == sheet && square < least) {
            least = square;
            nearest = c;
        }
    }
    return nearest;
}

/* That which holds in the feature's cell. */
static csg_tape tape_of_cell(const csg_marching *m, const csg_block *block, const csg_feature *f)
{
    csg_tape tape = m->field->tape;
    const int cell[3] = {f->cell & 7, f->cell >> 3 & 7, f->cell >> 6};
    csg_block_choose_tape(block, cell, &tape);
    return tape;
}

/* Colours and materials of an apex: of each sheet, or their mean. */
static void paint(const csg_marching *m, const csg_block *block, const csg_feature *f, bool split,
                  uint32_t vertex, csg_marching_room *room, const csg_marching_output *out,
                  float *scratch, size_t scratch_floats)
{
    float *channels[4] = {room->channels[0], room->channels[1], room->channels[2],
                          room->channels[3]};
    csg_tape tape = tape_of_cell(m, block, f);
    csg_edges *e = &room->edges;
    uint8_t color[4 * CSG_FEATURE_MOST_SHEETS] = {0};
    uint16_t material[2 * CSG_FEATURE_MOST_SHEETS] = {0};
    e->count = f->sheet_count;
    for (uint32_t k = 0; k < e->count; k++) {
        const float *at = nearest_corner(f, (int)k);
        e->x[k] = at[0], e->y[k] = at[1], e->z[k] = at[2];
        e->rank[k] = (uint16_t)k;
    }
    if (out->colors)
        csg_marching_colors(m, &tape, e, channels, color, scratch, scratch_floats);
    if (out->materials)
        csg_marching_materials(m, &tape, e, channels, material, scratch, scratch_floats);
    uint32_t sums[6] = {0}; /* over the sheets, then their means */
    for (uint32_t k = 0; k < e->count; k++) {
        for (uint32_t c = 0; c < 6; c++)
            sums[c] += c < 4 ? color[4 * k + c] : material[2 * k + c - 4];
        if (split && out->colors)
            memcpy(out->colors + 4 * (vertex + k), color + 4 * k, 4);
        if (split && out->materials)
            memcpy(out->materials + 2 * (vertex + k), material + 2 * k, 2 * sizeof *material);
    }
    for (int c = 0; c < 6; c++)
        sums[c] = (sums[c] + e->count / 2) / e->count;
    for (uint32_t c = 0; c < 4 && !split && out->colors; c++)
        out->colors[4 * vertex + c] = (uint8_t)sums[c];
    for (uint32_t c = 0; c < 2 && !split && out->materials; c++)
        out->materials[2 * vertex + c] = (uint16_t)sums[4 + c];
}

void csg_feature_vertices(const csg_marching *m, const csg_block *block,
                          const csg_feature_store *store, const csg_feature_block *features,
                          bool split, csg_marching_room *room, const csg_marching_output *out,
                          float *scratch, size_t scratch_floats)
{
    uint32_t v = block->vertex_count - features->vertices;
    for (uint32_t i = features->first; i < features->first + features->count; i++) {
        const csg_feature *f = &store->features[i];
        if (f->state == CSG_FEATURE_BARE)
            continue;
        if (out->colors || out->materials)
            paint(m, block, f, split, v, room, out, scratch, scratch_floats);
        for (uint32_t k = 0; k < copies_of(f, split); k++, v++) {
            csg_marching_shift(m, f->at, out->positions + 3 * v);
            if (out->normals && split)
                memcpy(out->normals + 3 * v, f->normal[k], 3 * sizeof(float));
            else if (out->normals)
                mean_normal(f, out->normals + 3 * v);
        }
    }
}

/* ---- triangles ------------------------------------------------------------------------------- */

/* Calls put() for the corners of each triangle of the block, in the order of its cells. */
typedef struct emitter {
    const csg_marching *m;
    const csg_block *block;
    const csg_feature_store *store;
    const csg_feature_block *features;
    void (*put)(struct emitter *emitter, const csg_fan_corner *corner);
    const csg_marching_room *room;
    bool split;
    int cell;          /* slot of its lowest point */
    uint32_t *indices; /* where the next goes */
    float *corners;
} emitter;

static int slot_of(const emitter *e, uint8_t edge)
{
    const uint8_t *o = e->m->tables->offset[edge];
    return e->cell + edge / 4 * CSG_BLOCK_POINTS + (o[2] * N + o[1]) * N + o[0];
}

static void put_index(emitter *e, const csg_fan_corner *corner)
{
    const uint32_t *vertex = e->room->vertex[0];
    *e->indices++ = corner->apex ? corner->apex->vertex + (e->split ? corner->sheet : 0)
                                 : vertex[slot_of(e, corner->edge)];
}

static void put_position(emitter *e, const csg_fan_corner *corner)
{
    if (corner->apex || corner->at)
        csg_marching_shift(e->m, corner->apex ? corner->apex->at : corner->at, e->corners);
    else
        memcpy(e->corners, e->room->slots.at[slot_of(e, corner->edge)], 3 * sizeof(float));
    e->corners += 3;
}

static void emit_fan(emitter *e, const csg_feature *f)
{
    csg_fan_corner corners[3];
    for (int s = 0; s < csg_feature_triangle_count(f); s++) {
        csg_feature_triangle(e->store, f, s, corners);
        for (int c = 0; c < 3; c++)
            e->put(e, &corners[c]);
    }
}

/* Feature i on are those of this cell and the ones after it. Returns the first of a later cell. */
static uint32_t emit_cell(emitter *e, unsigned pattern, int cell, uint32_t i)
{
    const csg_cell_tables *tables = e->m->tables;
    const uint8_t *edge = tables->edge[pattern];
    uint32_t end = e->features->first + e->features->count;
    if (i < end && e->store->features[i].cell == cell && e->store->features[i].joined) {
        for (; i < end && e->store->features[i].cell == cell; i++) /* all of its loops */
            emit_fan(e, &e->store->features[i]);
        return i;
    }
    for (int loop = 0; loop < tables->loop_count[pattern]; loop++) {
        int count = 3 * (tables->loop_sides[pattern][loop] - 2);
        bool fanned = false;
        for (; i < end && e->store->features[i].cell == cell && e->store->features[i].loop == loop;
             i++, fanned = true)
            emit_fan(e, &e->store->features[i]);
        for (int c = 0; c < count && !fanned; c++)
            e->put(e, &(csg_fan_corner){.edge = edge[c]});
        edge += count;
    }
    return i;
}

static void emit_block(emitter *e)
{
    uint32_t next = e->features->first;
    for (int k = 0; k < E; k++)
        for (int j = 0; j < E; j++) {
            csg_cell_rows rows = csg_cell_rows_of(e->block, j, k);
            for (unsigned rest = rows.mixed; rest; rest &= rest - 1) {
                int i = __builtin_ctz(rest);
                e->cell = (k * N + j) * N + i;
                next = emit_cell(e, csg_cell_pattern(&rows, i), (k * E + j) * E + i, next);
            }
        }
}

/* Puts vertices of the block that have moved to their places. A mesh has a handful of them. */
static void place_moved(const csg_marching *m, const csg_block *block,
                        const csg_feature_store *store, const csg_feature_block *features,
                        const csg_marching_room *room, const csg_marching_output *out)
{
    for (size_t i = 0; i < store->move_count; i++) {
        const csg_feature_moved *move = &store->moves[i];
        for (int k = 0; k < 4 && !move->back; k++) {
            if (move->feature[k] < features->first ||
                move->feature[k] >= features->first + features->count)
                continue;
            const csg_feature *f = &store->features[move->feature[k]];
            const uint8_t edge = f->side[move->corner[k]].edge, *o = m->tables->offset[edge];
            const int at[3] = {(f->cell & 7) + o[0], (f->cell >> 3 & 7) + o[1],
                               (f->cell >> 6) + o[2]};
            if (at[0] == E || at[1] == E || at[2] == E) /* the block's above */
                continue;
            uint32_t v = room->vertex[edge / 4][(at[2] * N + at[1]) * N + at[0]];
            v -= block->first_vertex;
            csg_marching_shift(m, f->side[move->corner[k]].corner, out->positions + 3 * v);
            if (out->normals)
                memcpy(out->normals + 3 * v, move->normal, sizeof move->normal);
        }
    }
}

void csg_feature_triangles(const csg_marching *m, const csg_block *block,
                           const csg_feature_store *store, const csg_feature_block *features,
                           bool split, csg_marching_room *room, const csg_marching_output *out)
{
    csg_marching_number(m, block, room);
    if (out->positions)
        place_moved(m, block, store, features, room, out);
    emitter e = {.m = m,
                 .block = block,
                 .store = store,
                 .features = features,
                 .put = put_index,
                 .room = room,
                 .split = split,
                 .indices = out->indices};
    emit_block(&e);
}

uint64_t csg_feature_corners(const csg_marching *m, const csg_block *block,
                             const csg_feature_store *store, const csg_feature_block *features,
                             csg_marching_room *room, float *corners, float *scratch,
                             size_t scratch_floats)
{
    uint64_t evaluations = csg_marching_shifted_roots(m, block, room, scratch, scratch_floats);
    emitter e = {.m = m,
                 .block = block,
                 .store = store,
                 .features = features,
                 .put = put_position,
                 .room = room,
                 .corners = corners};
    emit_block(&e);
    return evaluations;
}
