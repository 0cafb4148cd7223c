/* SPDX-License-Identifier: MIT
 * Rounds of looking for places where all features hold; see settle.h.
 */
#include "mesh/features/settle.h"

#include "mesh/features/demote.h"
#include "mesh/features/join.h"
#include "mesh/features/move.h"
#include "mesh/features/shift.h"

static bool is_corner(const csg_feature *f)
{
    return f->sheet_count > 2;
}

/* Gives up one of two that cannot be joined (or both), g NULL: the one that has none beyond. */
static void give_up(csg_feature_store *store, const csg_cell_tables *tables, csg_feature *f,
                    csg_feature *g)
{
    bool both = !g || is_corner(f) == is_corner(g);
    if (g && (both || is_corner(f)))
        csg_feature_demote(store, tables, g);
    if (both || !is_corner(f))
        csg_feature_demote(store, tables, f);
}

/* An apex that was not found yet, from its neighbours; those in its way are looked after first. */
static bool solve_late(csg_feature_store *store, const csg_cell_tables *tables, uint32_t index,
                       csg_feature_probe *probe)
{
    csg_feature *f = &store->features[index];
    bool is_in_vain;
    if (csg_feature_replace(store, tables, index, probe, &is_in_vain))
        return true;
    for (int s = 0; s < f->side_count; s++) {
        csg_feature *g = f->flipped >> s & 1 ? &store->features[f->side[s].beyond] : NULL;
        if (g && g->state != CSG_FEATURE_UNSOLVED && !csg_feature_holds(store, tables, g) &&
            csg_feature_shift(store, tables, f->side[s].beyond, CSG_FEATURE_NONE, probe))
            is_in_vain = false;
    }
    if (is_in_vain)
        return false;
    f->tries = 0;
    return csg_feature_replace(store, tables, index, probe, NULL);
}

size_t csg_feature_settle(csg_feature_store *store, const csg_cell_tables *tables,
                          csg_feature_probe *probe)
{
    size_t changed = 0;
    for (uint32_t i = 0; i < store->count; i++) {
        csg_feature *f = &store->features[i];
        if (f->creased && f->state == CSG_FEATURE_UNSOLVED && !solve_late(store, tables, i, probe))
            csg_feature_demote(store, tables, f);
    }
    for (uint32_t i = 0; i < store->count; i++) {
        csg_feature *f = &store->features[i];
        if (f->creased && !csg_feature_unfolds(store, tables, f)) {
            if (!csg_feature_replace(store, tables, i, probe, NULL) &&
                !csg_feature_shift(store, tables, i, CSG_FEATURE_NONE, probe))
                csg_feature_demote(store, tables, f);
            changed++;
        }
        for (int s = 0; s < f->side_count; s++) {
            if (!(f->creased >> s & 1) || csg_feature_side_holds(store, tables, f, s))
                continue;
            uint32_t other = f->flipped >> s & 1 ? f->side[s].beyond : CSG_FEATURE_NONE;
            changed++;
            if (!csg_feature_replace(store, tables, i, probe, NULL) &&
                (other == CSG_FEATURE_NONE ||
                 !csg_feature_replace(store, tables, other, probe, NULL)) &&
                !csg_feature_shift(store, tables, i, other, probe))
                give_up(store, tables, f,
                        other == CSG_FEATURE_NONE ? NULL : &store->features[other]);
        }
    }
    return changed;
}
