/* SPDX-License-Identifier: MIT
 * A corner of the solid may lie beyond a side of its polygon whose ends are in one sheet: the
 * polygon next door covers it, and none of its corners shows that. See help.h; what is
 * beyond the block's own cells is not known here, and the corner then stays smooth.
 */
#include "mesh/features/help.h"

#include <math.h>
#include <string.h>

#include "mesh/features/cut.h"
#include "mesh/features/face.h"

enum { N = CSG_BLOCK_SAMPLES, E = CSG_BLOCK_EDGE };

/* Whether the triangle of the apex and a side looks inwards. */
static bool pokes_out(const csg_feature *f, int s)
{
    csg_vec3 at = csg_vec3_from_floats(f->at);
    csg_vec3 u = csg_vec3_sub(csg_vec3_from_floats(f->side[s].corner), at);
    csg_vec3 v = csg_vec3_sub(csg_vec3_from_floats(f->side[(s + 1) % f->side_count].corner), at);
    return !(csg_vec3_dot(csg_vec3_cross(u, v), csg_vec3_from_floats(f->normal[f->side[s].sheet])) >
             0);
}

/* The loop of a cell of the block with a side from one edge to another: all but its apex, and which
 * side. False: there is none. */
static bool find_loop(const csg_feature_room *room, const csg_feature_probe *probe, const int at[3],
                      uint8_t from, uint8_t to, csg_feature_whole *whole, int *side)
{
    const csg_cell_tables *tables = probe->marching->tables;
    csg_cell_rows rows = csg_cell_rows_of(probe->block, at[1], at[2]);
    unsigned pattern = csg_cell_pattern(&rows, at[0]);
    if (room->any_joined && room->joined[(at[2] * E + at[1]) * E + at[0]])
        return false; /* all are features */
    for (int l = 0; l < tables->loop_count[pattern]; l++) {
        const uint8_t *edge = tables->loop_edge[pattern][l];
        int count = tables->loop_sides[pattern][l], s = 0;
        while (s < count && (edge[s] != from || edge[(s + 1) % count] != to))
            s++;
        if (s == count)
            continue;
        *side = s;
        csg_feature_begin(whole, &(csg_feature){.cell = (uint16_t)((at[2] * E + at[1]) * E + at[0]),
                                                .pattern = (uint8_t)pattern,
                                                .loop = (uint8_t)l,
                                                .side_count = (uint8_t)count,
                                                .sheet_count = 1});
        csg_feature *out = &whole->feature;
        for (int i = 0; i < count; i++) {
            const uint8_t *o = tables->offset[edge[i]];
            int slot = edge[i] / 4 * CSG_BLOCK_POINTS + ((at[2] + o[2]) * N + at[1] + o[1]) * N +
                       at[0] + o[0];
            out->side[i].edge = edge[i];
            out->side[i].beyond = CSG_FEATURE_NONE;
            memcpy(out->side[i].corner, room->slots.at[slot], sizeof out->side[i].corner);
        }
        return true;
    }
    return false;
}

bool csg_feature_place_within(csg_feature *h, csg_vec3 at, csg_feature_probe *probe)
{
    enum { STEPS = 4 };
    double cell = probe->marching->lattice->cell_size;
    float f = NAN, g[3][1];
    for (int step = 0; step < STEPS; step++) {
        float x = (float)at.x, y = (float)at.y, z = (float)at.z;
        csg_feature_probe_points(probe, &x, &y, &z, 1, &f, (float *const[3]){g[0], g[1], g[2]});
        csg_vec3 n = {(double)g[0][0], (double)g[1][0], (double)g[2][0]};
        double square = csg_vec3_dot(n, n);
        if (!(square > 1e-6) || !(fabs((double)f) < cell))
            return false;
        h->at[0] = x, h->at[1] = y, h->at[2] = z;
        double length = sqrt(square);
        for (int i = 0; i < 3; i++)
            h->normal[0][i] = (float)(-(double)g[i][0] / length) + 0.0f;
        at = csg_vec3_sub(at, csg_vec3_scale(n, (double)f / square));
    }
    if (!(fabs((double)f) <= 1e-4 * cell + 4 * (double)probe->marching->noise) ||
        !csg_feature_cut(NULL, probe->marching->tables, h, h->triangle))
        return false;
    csg_feature_enter(h, CSG_FEATURE_SOLVED);
    return true;
}

/* Between the apex that pokes in and the corners away from it. */
static bool place_apex(csg_feature *h, int side, csg_vec3 poking, csg_feature_probe *probe)
{
    csg_vec3 far = {0, 0, 0};
    int others = h->side_count - 2;
    for (int i = 0; i < others; i++)
        far =
            csg_vec3_add(far, csg_vec3_from_floats(h->side[(side + 2 + i) % h->side_count].corner));
    csg_vec3 at = csg_vec3_scale(csg_vec3_add(poking, csg_vec3_scale(far, 1.0 / others)), 0.5);
    return csg_feature_place_within(h, at, probe);
}

static bool is_there(const csg_feature_room *room, size_t first, const csg_feature *h)
{
    for (size_t i = first; i < room->count; i++)
        if (room->features[i].cell == h->cell && room->features[i].loop == h->loop)
            return true;
    return false;
}

/* The polygon beyond one side of a feature. */
static bool help_side(csg_feature_room *room, size_t first, const csg_feature *f, int s,
                      csg_feature_probe *probe)
{
    const csg_cell_tables *tables = probe->marching->tables;
    uint8_t from = f->side[s].edge, to = f->side[(s + 1) % f->side_count].edge;
    int face = csg_face_between(tables, from, to), side;
    if (face < 0)
        return true;
    int at[3] = {f->cell & 7, f->cell >> 3 & 7, f->cell >> 6}, axis = face / 2;
    at[axis] += face % 2 ? 1 : -1;
    csg_feature_whole whole;
    csg_feature *h = &whole.feature;
    if (at[axis] < 0 || at[axis] >= E ||
        !find_loop(room, probe, at, csg_edge_beyond(tables, to, axis),
                   csg_edge_beyond(tables, from, axis), &whole, &side) ||
        is_there(room, first, h) || !place_apex(h, side, csg_vec3_from_floats(f->at), probe))
        return true;
    return csg_feature_append(&room->features, &room->count, &room->capacity, &room->lists, h);
}

static unsigned place_of(const csg_feature *f)
{
    return f->cell * (unsigned)CSG_CELL_MOST_LOOPS + f->loop;
}

/* By cells and loops: those from `from` on are new. */
static void sort(csg_feature *features, size_t first, size_t from, size_t end)
{
    for (size_t i = from; i < end; i++) {
        csg_feature f = features[i];
        size_t k = i;
        for (; k > first && place_of(&features[k - 1]) > place_of(&f); k--)
            features[k] = features[k - 1];
        features[k] = f;
    }
}

bool csg_feature_help(csg_feature_room *room, size_t first, csg_feature_probe *probe)
{
    size_t end = room->count;
    for (size_t i = first; i < end; i++) {
        csg_feature f = room->features[i]; /* a copy: the array may move */
        for (int s = 0; f.state == CSG_FEATURE_FOLDED && s < f.side_count; s++)
            if (!(f.creased >> s & 1) && pokes_out(&f, s) && !help_side(room, first, &f, s, probe))
                return false;
    }
    sort(room->features, first, end, room->count);
    return true;
}
