/* SPDX-License-Identifier: MIT
 * Apexes along a crease stand in its order: see move.h.
 */
#include "mesh/features/move.h"

#include "mesh/features/apex.h"
#include "mesh/features/join.h"

/* The features before and after one on a crease; false for others. */
static bool neighbours_of(const csg_feature_store *store, const csg_feature *f,
                          const csg_feature *beside[2])
{
    int count = 0;
    for (int s = 0; s < f->side_count; s++)
        if (f->creased >> s & 1) {
            if (!(f->flipped >> s & 1) || count == 2)
                return false;
            beside[count++] = &store->features[f->side[s].beyond];
        }
    return count == 2 && f->sheet_count == 2;
}

static void restore(const csg_feature *f, csg_feature_polygon *p, csg_apex *a)
{
    *p = (csg_feature_polygon){
        .sides = f->side_count, .sheets = f->sheet_count, .creased = f->creased};
    for (int s = 0; s < p->sides; s++) {
        p->edge[s] = f->side[s].edge;
        p->sheet[s] = f->side[s].sheet;
        p->corner[s] = csg_vec3_from_floats(f->side[s].corner);
    }
    csg_feature_find_middles(p);
    for (int k = 0; k < p->sheets; k++)
        a->planes[k] = csg_plane_at(f->at[0], f->at[1], f->at[2], 0, -f->normal[k][0],
                                    -f->normal[k][1], -f->normal[k][2]);
}

bool csg_feature_move(const csg_feature_store *store, uint32_t index, csg_feature_probe *probe,
                      csg_feature_whole *out)
{
    const csg_feature *f = &store->features[index], *beside[2];
    if (!neighbours_of(store, f, beside))
        return false;
    csg_vec3 low = csg_vec3_from_floats(beside[0]->at), high = csg_vec3_from_floats(beside[1]->at),
             at = csg_vec3_from_floats(f->at);
    if (csg_vec3_dot(csg_vec3_sub(at, low), csg_vec3_sub(high, at)) > 0)
        return false;
    csg_feature_polygon p;
    csg_apex a = {.at = csg_vec3_scale(csg_vec3_add(low, high), 0.5)};
    restore(f, &p, &a);
    csg_feature_keep(out, f);
    csg_feature *moved = &out->feature;
    moved->flipped = 0; /* the fan itself must look out */
    bool found = csg_apex_find(&p, &a, probe, moved) && moved->state == CSG_FEATURE_SOLVED;
    moved->flipped = f->flipped;
    if (f->state == CSG_FEATURE_UNSOLVED)
        moved->state = f->state; /* it is a likely place, no more */
    return found;
}

/* ---- another place -----------------------------------------------------------------------------
 */

/* What is known around a feature. */
typedef struct surroundings {
    const csg_feature *beside[CSG_FEATURE_MOST_SIDES];
    int side[CSG_FEATURE_MOST_SIDES];
    int count;
} surroundings;

static surroundings look_beside(const csg_feature_store *store, const csg_feature *f)
{
    surroundings q = {.count = 0};
    for (int s = 0; s < f->side_count; s++) {
        if (!(f->flipped & ~f->bent & 1u << s))
            continue;
        const csg_feature *g = &store->features[f->side[s].beyond];
        q.beside[q.count] = g;
        q.side[q.count] = s;
        q.count += g->state != CSG_FEATURE_UNSOLVED;
    }
    return q;
}

/* Takes the planes of both sheets at a creased side from the neighbour beyond. */
static void borrow_planes(const csg_feature *f, const surroundings *q, int k, csg_apex *a)
{
    const csg_feature *g = q->beside[k];
    int s = q->side[k], t = f->side[s].beyond_side, s1 = (s + 1) % f->side_count;
    const float *here = g->normal[g->side[(t + 1) % g->side_count].sheet];
    const float *next = g->normal[g->side[t].sheet];
    a->planes[f->side[s].sheet] =
        csg_plane_at(g->at[0], g->at[1], g->at[2], 0, -here[0], -here[1], -here[2]);
    a->planes[f->side[s1].sheet] =
        csg_plane_at(g->at[0], g->at[1], g->at[2], 0, -next[0], -next[1], -next[2]);
}

/* A start for try number n; false: there are no more. Corners have one, between all neighbours and
 * with their planes; on a crease, places between both, with the planes of either or its own. */
static bool begin_try(const csg_feature *f, const surroundings *q, const csg_feature_polygon *p,
                      int n, csg_apex *a)
{
    enum { PLACES = 3 };
    static const double place[PLACES] = {0.5, 0.2, 0.8};
    if (f->sheet_count > 2) {
        a->at = csg_vec3_make(0, 0, 0);
        for (int k = 0; k < q->count; k++) {
            a->at = csg_vec3_add(
                a->at, csg_vec3_scale(csg_vec3_from_floats(q->beside[k]->at), 1.0 / q->count));
            borrow_planes(f, q, k, a);
        }
        return n == 0 && q->count > 0;
    }
    int source = n / PLACES;
    bool ends = q->count == 1 && source > 1; /* the crease does: back from the apex as it was */
    if (q->count == 0 || source > q->count + ends)
        return false;
    if (source > 0 && !ends)
        borrow_planes(f, q, source - 1, a);
    csg_vec3 low = csg_vec3_from_floats(q->beside[0]->at);
    csg_vec3 high = q->count > 1 ? csg_vec3_from_floats(q->beside[1]->at)
                    : ends       ? csg_vec3_from_floats(f->at)
                                 : p->middle;
    a->at = csg_vec3_add(low, csg_vec3_scale(csg_vec3_sub(high, low), place[n % PLACES]));
    return true;
}

bool csg_feature_replace(csg_feature_store *store, const csg_cell_tables *tables, uint32_t index,
                         csg_feature_probe *probe, bool *is_in_vain)
{
    enum { MOST_TRIES = 1, MOST_NODES = 512 /* the whole tape is asked */ };
    csg_feature *f = &store->features[index];
    csg_feature_whole kept, likely;
    csg_feature *before = &kept.feature, *best = &likely.feature;
    if (is_in_vain)
        *is_in_vain = false;
    if (!f->creased || f->tries == MOST_TRIES || probe->marching->field->tape.count > MOST_NODES)
        return false;
    csg_feature_keep(&kept, f);
    before->tries++;
    csg_feature_keep(&likely, before);
    surroundings q = look_beside(store, f);
    bool any = false;
    for (int n = 0;; n++) {
        csg_feature_polygon p;
        csg_apex a = {.lost = false};
        restore(before, &p, &a);
        if (!begin_try(before, &q, &p, n, &a))
            break;
        csg_feature_copy(f, before);
        f->flipped = 0;
        bool found = csg_apex_find(&p, &a, probe, f);
        any = any || found;
        f->flipped = before->flipped;
        csg_feature_agree(store, f);
        if (found && csg_feature_holds(store, tables, f))
            return true;
        if (found && before->state == CSG_FEATURE_UNSOLVED && n == 0) {
            csg_feature_copy(best, f);
            best->state = before->state;
        }
    }
    csg_feature_copy(f, best);
    csg_feature_agree(store, f);
    if (is_in_vain)
        *is_in_vain = !any;
    return false;
}
