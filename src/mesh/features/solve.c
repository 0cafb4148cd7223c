/* SPDX-License-Identifier: MIT
 * From loops of a block with creases to features: their sheets, and where to look for an apex. The
 * first place nearly always holds good, so it is tried alone, but for many polygons at once: the
 * field is asked in batches.
 */
#include "mesh/features/solve.h"

#include <math.h>
#include <string.h>

#include "mesh/features/apex.h"
#include "mesh/features/help.h"
#include "mesh/features/smooth.h"

enum { MOST_SHEETS = CSG_FEATURE_MOST_SHEETS, AT_ONCE = CSG_FEATURE_MOST_WALKS };

typedef csg_feature_polygon polygon;
typedef csg_apex apex;

/* What may become a feature. */
typedef struct candidate {
    const csg_found_loop *loop;
    polygon p;
    apex apexes[CSG_FEATURE_MOST_STARTS]; /* one for each start */
    csg_feature_whole whole;              /* what is known of the feature */
    float sharpest;                       /* of its creases: 1 - cos */
    bool good, crossed, is_looked; /* not too many sheets; it has creases; an apex is looked for */
    bool found;                    /* it has one */
} candidate;

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
                   csg_feature_whole *whole)
{
    csg_feature *out = &whole->feature;
    csg_feature_begin(whole, &(csg_feature){.cell = loop->cell,
                                            .pattern = loop->pattern,
                                            .joined = loop->joined,
                                            .loop = loop->loop,
                                            .side_count = (uint8_t)p->sides,
                                            .sheet_count = (uint8_t)p->sheets,
                                            .creased = p->creased});
    for (int s = 0; s < p->sides; s++) {
        memcpy(out->side[s].corner, room->slots.at[loop->slot[s]], sizeof out->side[s].corner);
        out->side[s].edge = p->edge[s];
        out->side[s].sheet = p->sheet[s];
        out->side[s].beyond = CSG_FEATURE_NONE;
    }
}

/* Its sheets, and its apexes on their way. */
static void begin_candidate(const csg_feature_room *room, const csg_found_loop *loop, double cell,
                            candidate *c)
{
    c->loop = loop;
    c->good = mark_sheets(room, loop, &c->p);
    c->crossed = c->found = false;
    bool is_plane = true;
    c->sharpest = 0;
    for (int s = 0; s < loop->side_count; s++)
        if (loop->crease[s] >= 0) {
            c->crossed = true;
            is_plane = is_plane && room->segments[loop->crease[s]].found;
            c->sharpest = fmaxf(c->sharpest, room->segments[loop->crease[s]].jump);
        }
    c->is_looked = c->good && (c->crossed || loop->wide);
    if (!c->is_looked)
        return;
    csg_feature_find_middles(&c->p);
    choose_starts(room, loop, &c->p);
    record(room, loop, &c->p, &c->whole);
    c->whole.feature.is_plane = is_plane && c->p.creased;
    for (int k = 0; k < c->p.start_count; k++) {
        apex *a = &c->apexes[k];
        memset(a, 0, sizeof *a);
        a->at = c->p.start[k];
        first_planes(room, loop, &c->p, a);
        csg_apex_meet(&c->p, a, cell);
    }
}

/* The first starts of all. */
static void try_first(candidate *candidates, int count, csg_feature_probe *probe)
{
    const csg_marching *m = probe->marching;
    csg_apex_walk walks[AT_ONCE];
    candidate *owner[AT_ONCE];
    float f[AT_ONCE];
    int n = 0;
    for (int i = 0; i < count; i++) {
        candidate *c = &candidates[i];
        if (!c->is_looked)
            continue;
        walks[n] =
            (csg_apex_walk){&c->p, &c->apexes[0], c->p.start_count > 1, c->whole.feature.is_plane};
        owner[n++] = c;
    }
    if (!n)
        return;
    csg_apexes_improve(walks, n, m->lattice->cell_size, probe);
    csg_apexes_ask(walks, n, probe, f);
    for (int i = 0; i < n; i++) {
        candidate *c = owner[i];
        c->found = csg_apexes_choose(&c->p, c->apexes, &f[i], 1, m, &c->whole.feature);
    }
}

/* The other starts of one whose first is not good. */
static void try_others(candidate *c, csg_feature_probe *probe)
{
    const csg_marching *m = probe->marching;
    csg_apex_walk walks[CSG_FEATURE_MOST_STARTS];
    float f[CSG_FEATURE_MOST_STARTS];
    int count = c->p.start_count;
    for (int k = 0; k < count; k++)
        walks[k] = (csg_apex_walk){&c->p, &c->apexes[k], false, c->whole.feature.is_plane};
    csg_apexes_improve(walks + 1, count - 1, m->lattice->cell_size, probe);
    csg_apexes_ask(walks, count, probe, f);
    c->found = csg_apexes_choose(&c->p, c->apexes, f, count, m, &c->whole.feature);
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
                         csg_feature_probe *probe, csg_feature_whole *whole)
{
    csg_feature *out = &whole->feature;
    polygon p = {.sides = loop->side_count, .sheets = 1};
    const float *g = room->gradient[loop->slot[0]];
    memcpy(p.edge, loop->edge, sizeof p.edge);
    record(room, loop, &p, whole);
    csg_apex a = {.planes = {csg_plane_at(0, 0, 0, 0, g[0], g[1], g[2])}};
    csg_apex_place(&p, &a, out);
    for (int s = 0; s < p.sides; s++)
        p.corner[s] = csg_vec3_from_floats(out->side[s].corner);
    csg_feature_find_middles(&p);
    if (csg_feature_place_within(out, p.middle, probe))
        return;
    csg_feature_enter(out, CSG_FEATURE_GIVEN_UP);
    csg_feature_divide(out, probe->marching->tables, 0);
}

static bool end_candidate(csg_feature_room *room, candidate *c, csg_feature_probe *probe)
{
    const csg_found_loop *loop = c->loop;
    csg_feature *out = &c->whole.feature;
    if (!c->crossed && (!c->good || !loop->wide) && !loop->joined)
        return true;
    /* nobody beyond could help a tip: it is for the polygon there to reach */
    bool solved = c->found && (c->p.creased || out->state == CSG_FEATURE_SOLVED);
    /* where all creases are blunt, one that enters the polygon and is not found where it should
     * leave it fades there: it ends, and smoothly */
    bool fades = c->sharpest < CSG_FEATURE_FADING;
    bool creased = c->p.creased && !fades;
    if (c->good && creased && !solved)
        leave_unsolved(room, loop, &c->p, out);
    bool is_feature = solved || (c->good && creased);
    if (!is_feature && loop->joined)
        leave_smooth(room, loop, probe, &c->whole);
    if (!is_feature && c->crossed && !c->found)
        *(fades ? &room->fading : &room->smooth) += 1;
    return !(is_feature || loop->joined) ||
           csg_feature_append(&room->features, &room->count, &room->capacity, &room->lists, out);
}

static bool solve_some(csg_feature_room *room, const csg_found_loop *loops, int count,
                       csg_feature_probe *probe)
{
    candidate candidates[AT_ONCE];
    for (int i = 0; i < count; i++)
        begin_candidate(room, &loops[i], probe->marching->lattice->cell_size, &candidates[i]);
    try_first(candidates, count, probe);
    for (int i = 0; i < count; i++) {
        candidate *c = &candidates[i];
        bool is_settled = c->found && c->whole.feature.state == CSG_FEATURE_SOLVED;
        if (c->is_looked && c->p.start_count > 1 && !is_settled)
            try_others(c, probe);
        if (!end_candidate(room, c, probe))
            return false;
    }
    return true;
}

bool csg_feature_solve(csg_feature_room *room, csg_feature_probe *probe)
{
    for (uint32_t i = 0; i < room->loop_count; i += AT_ONCE) {
        uint32_t left = room->loop_count - i;
        int count = (int)(left < AT_ONCE ? left : AT_ONCE);
        if (!solve_some(room, &room->loops[i], count, probe))
            return false;
    }
    return true;
}
