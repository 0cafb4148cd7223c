/* SPDX-License-Identifier: MIT
 * A feature that is given up; see demote.h.
 */
#include "mesh/features/demote.h"

#include "mesh/features/cut.h"
#include "mesh/features/shift.h"
#include "mesh/features/smooth.h"

/* Whether what ends in a polygon is a blunt crease. */
static bool is_fading(const csg_feature *f)
{
    float cosine = 0;
    for (int i = 0; i < 3; i++)
        cosine += f->normal[0][i] * f->normal[1][i];
    return f->ends && f->sheet_count == 2 && 1 - cosine < CSG_FEATURE_FADING;
}

void csg_feature_demote(csg_feature_store *store, const csg_cell_tables *tables, csg_feature *f)
{
    csg_feature_shift_back(store, tables, f);
    for (int s = 0; s < f->side_count; s++) {
        if (f->side[s].beyond == CSG_FEATURE_NONE)
            continue;
        csg_feature *g = &store->features[f->side[s].beyond];
        bool joined = f->flipped >> s & 1;
        g->side[f->side[s].beyond_side].beyond = CSG_FEATURE_NONE;
        g->flipped &= (uint16_t) ~(1u << f->side[s].beyond_side);
        g->takes_next &= g->flipped;
        if (joined)
            csg_feature_cut(store->features, tables, g, g->triangle);
        f->side[s].beyond = CSG_FEATURE_NONE;
    }
    if (f->creased & ~f->bent)
        *(is_fading(f) ? &store->fading : &store->smooth) += 1;
    f->creased = f->flipped = f->takes_next = f->bent = 0;
    csg_feature_enter(f, CSG_FEATURE_GIVEN_UP);
    csg_feature_divide(f, tables, 0);
}
