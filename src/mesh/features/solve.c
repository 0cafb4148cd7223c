/* SPDX-License-Identifier: MIT
 * From a loop of a block with creases to a feature: its sheets, and where to look for its apex.
 */
#include "mesh/features/solve.h"

#include <math.h>
#include <string.h>

#include "mesh/features/apex.h"
#include "mesh/features/help.h"
#include "mesh/features/smooth.h"

enum { MOST_SHEETS = CSG_FEATURE_MOST_SHEETS };

typedef csg_feature_polygon polygon;
typedef csg_apex apex;

/* Sheets are runs of corners between creases; without creases, round a tip, each corner. A single
 * crease is none: a side may pass so near to the axis below the tip of a cone that it looks like
 * one; the polygon may be that round the tip. */
static bool mark_sheets(const csg_feature_room *room, const csg_found_loop *loop, polygon *p)
{
    *p = (polygon){.sides = loop->side_count};
    int creases = 0, first = 0;
    for (int s = 0; s < p->sides; s++)
        if (loop->crease[s] >= 0) {
            p->creased |= (uint16_t)(1u << s);
            first = creases++ ? first : s + 1;
        }
    if (creases == 1) {
        p->creased = 0;
        creases = first = 0;
    }
    int sheet = 0;
    for (int k = 0; k < p->sides; k++) {
        int s = (first + k) % p->sides;
        p->corner[s] = csg_vec3_from_floats(room->slots.at[loop->slot[s]]);
        p->edge[s] = loop->edge[s];
        p->sheet[s] = (uint8_t)sheet;
        sheet += !creases || (p->creased >> s & 1);
    }
    p->sheets = creases ? creases : p->sides;
    return p->sheets <= MOST_SHEETS;
}

/* On a crease: between the places where it passes into the neighbours, or at one of these. */
static void choose_starts(const csg_feature_room *room, const csg_found_loop *loop, polygon *p)
{
    p->start_count = 0;
    if (p->sheets != 2) {
        p->start[p->start_count++] = p->middle;
        return;
    }
    csg_vec3 at[3] = {{0, 0, 0}};
    int n = 1;
    for (int s = 0; s < p->sides; s++)
        if (p->creased >> s & 1) {
            at[n] = csg_vec3_from_floats(room->segments[loop->crease[s]].at);
            at[0] = csg_vec3_add(at[0], csg_vec3_scale(at[n++], 0.5));
        }
    for (int k = 0; k < 3; k++)
        p->start[p->start_count++] = at[k];
    p->start[p->start_count++] = at[0]; /* the first one slides */
}

/* The tangent planes at the corners in the middle of each run, to begin with. */
static void first_planes(const csg_feature_room *room, const csg_found_loop *loop, const polygon *p,
                         apex *a)
{
    int seen[MOST_SHEETS] = {0}, length[MOST_SHEETS] = {0};
    for (int s = 0; s < p->sides; s++)
        length[p->sheet[s]]++;
    for (int s = 0; s < p->sides; s++) {
        int k = p->sheet[s];
        if (seen[k]++ > length[k] / 2)
            continue;
        const float *at = room->slots.at[loop->slot[s]], *g = room->gradient[loop->slot[s]];
        a->planes[k] = csg_plane_at(at[0], at[1], at[2], 0, g[0], g[1], g[2]);
    }
}

/* All but the apex. */
static void record(const csg_feature_room *room, const csg_found_loop *loop, const polygon *p,
                   csg_feature *out)
{
    *out = (csg_feature){.cell = loop->cell,
                         .pattern = loop->pattern,
                         .joined = loop->joined,
                         .loop = loop->loop,
                         .side_count = (uint8_t)p->sides,
                         .sheet_count = (uint8_t)p->sheets,
                         .creased = p->creased};
    for (int s = 0; s < p->sides; s++) {
        memcpy(out->corner[s], room->slots.at[loop->slot[s]], sizeof out->corner[s]);
        out->edge[s] = p->edge[s];
        out->sheet[s] = p->sheet[s];
        out->beyond[s] = CSG_FEATURE_NONE;
    }
}

/* False where the polygon has no apex. */
static bool solve_polygon(const csg_feature_room *room, const csg_found_loop *loop, polygon *p,
                          csg_feature_probe *probe, csg_feature *out)
{
    double cell = probe->marching->lattice->cell_size;
    apex apexes[CSG_FEATURE_MOST_STARTS];
    memset(apexes, 0, sizeof apexes);
    csg_feature_find_middles(p);
    choose_starts(room, loop, p);
    record(room, loop, p, out);
    for (int k = 0; k < p->start_count; k++) {
        apexes[k].at = p->start[k];
        first_planes(room, loop, p, &apexes[k]);
        csg_apex_meet(p, &apexes[k], cell);
    }
    csg_apexes_improve(p, apexes, cell, probe);
    return csg_apexes_choose(p, apexes, probe, out);
}

/* An apex to be found from those of its neighbours. */
static void leave_unsolved(const csg_feature_room *room, const csg_found_loop *loop,
                           const polygon *p, csg_feature *out)
{
    apex a = {.at = p->start[0]};
    first_planes(room, loop, p, &a);
    csg_apex_place(p, &a, out);
    csg_feature_enter(out, CSG_FEATURE_UNSOLVED);
}

/* In a cell with a joined face every loop is a feature: without a crease, with an apex within its
 * sheet, or at least a smooth one. */
static void leave_smooth(const csg_feature_room *room, const csg_found_loop *loop,
                         csg_feature_probe *probe, csg_feature *out)
{
    polygon p = {.sides = loop->side_count, .sheets = 1};
    const float *g = room->gradient[loop->slot[0]];
    memcpy(p.edge, loop->edge, sizeof p.edge);
    record(room, loop, &p, out);
    csg_apex a = {.planes = {csg_plane_at(0, 0, 0, 0, g[0], g[1], g[2])}};
    csg_apex_place(&p, &a, out);
    for (int s = 0; s < p.sides; s++)
        p.corner[s] = csg_vec3_from_floats(out->corner[s]);
    csg_feature_find_middles(&p);
    if (csg_feature_place_within(out, p.middle, probe))
        return;
    csg_feature_enter(out, CSG_FEATURE_GIVEN_UP);
    csg_feature_divide(out, probe->marching->tables, 0);
}

bool csg_feature_solve(csg_feature_room *room, const csg_found_loop *loop, csg_feature_probe *probe,
                       csg_memory *memory)
{
    polygon p;
    if (!csg_memory_reserve(memory, (void **)&room->features, &room->capacity, room->count + 1,
                            sizeof(csg_feature)))
        return false;
    csg_feature *out = &room->features[room->count];
    bool good = mark_sheets(room, loop, &p), crossed = false;
    float sharpest = 0;
    for (int s = 0; s < loop->side_count; s++)
        if (loop->crease[s] >= 0) {
            crossed = true;
            sharpest = fmaxf(sharpest, room->segments[loop->crease[s]].jump);
        }
    if (!crossed && (!good || !loop->wide) && !loop->joined)
        return true;
    bool found = good && (crossed || loop->wide) && solve_polygon(room, loop, &p, probe, out);
    /* nobody beyond could help a tip: it is for the polygon there to reach */
    bool solved = found && (p.creased || out->state == CSG_FEATURE_SOLVED);
    /* where all creases are blunt, one that enters the polygon and is not found where it should
     * leave it fades there: it ends, and smoothly */
    bool fades = sharpest < CSG_FEATURE_FADING;
    bool creased = p.creased && !fades;
    if (good && creased && !solved)
        leave_unsolved(room, loop, &p, out);
    bool is_feature = solved || (good && creased);
    if (!is_feature && loop->joined)
        leave_smooth(room, loop, probe, out);
    if (is_feature || loop->joined)
        room->count++;
    if (!is_feature && crossed && !found)
        *(fades ? &room->fading : &room->smooth) += 1;
    return true;
}
