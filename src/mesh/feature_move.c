/* SPDX-License-Identifier: MIT
 * Apexes along a crease stand in its order: see feature_move.h.
 */
#include "mesh/feature_move.h"

#include "mesh/feature_apex.h"

static csg_vec3 point(const float at[3])
{
    return csg_vec3_make((double)at[0], (double)at[1], (double)at[2]);
}

/* The features before and after one on a crease; false for others. */
static bool neighbours_of(const csg_feature_store *store, const csg_feature *f,
                          const csg_feature *beside[2])
{
    int count = 0;
    for (int s = 0; s < f->side_count; s++)
        if (f->creased >> s & 1) {
            if (f->beyond[s] == CSG_FEATURE_NONE || count == 2)
                return false;
            beside[count++] = &store->features[f->beyond[s]];
        }
    return count == 2 && f->sheet_count == 2;
}

static void restore(const csg_feature *f, csg_feature_polygon *p, csg_apex *a)
{
    *p = (csg_feature_polygon){
        .sides = f->side_count, .sheets = f->sheet_count, .creased = f->creased};
    for (int s = 0; s < p->sides; s++) {
        p->edge[s] = f->edge[s];
        p->sheet[s] = f->sheet[s];
        p->corner[s] = point(f->corner[s]);
    }
    csg_feature_find_middles(p);
    for (int k = 0; k < p->sheets; k++)
        a->planes[k] = csg_plane_at(f->at[0], f->at[1], f->at[2], 0, -f->normal[k][0],
                                    -f->normal[k][1], -f->normal[k][2]);
}

bool csg_feature_move(const csg_feature_store *store, uint32_t index, csg_feature_probe *probe,
                      csg_feature *out)
{
    const csg_feature *f = &store->features[index], *beside[2];
    if (!neighbours_of(store, f, beside))
        return false;
    csg_vec3 low = point(beside[0]->at), high = point(beside[1]->at), at = point(f->at);
    if (csg_vec3_dot(csg_vec3_sub(at, low), csg_vec3_sub(high, at)) > 0)
        return false;
    double cell = probe->marching->lattice->cell_size;
    csg_feature_polygon p;
    csg_apex a = {.at = csg_vec3_scale(csg_vec3_add(low, high), 0.5)};
    restore(f, &p, &a);
    p.start_count = 1;
    csg_apex_meet(&p, &a, cell);
    csg_apexes_improve(&p, &a, cell, probe);
    *out = *f;
    out->flipped = 0; /* the fan itself must look out */
    bool found = csg_apexes_choose(&p, &a, probe, out) != NULL;
    out->flipped = f->flipped;
    return found;
}
