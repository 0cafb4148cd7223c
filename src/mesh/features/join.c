/* SPDX-License-Identifier: MIT
 * Which features are joined: whether the segments between them can be flipped, and which of two
 * polygons has which half.
 */
#include "mesh/features/join.h"

#include <math.h>
#include <string.h>

#include "mesh/features/cut.h"

/* Whether triangle (a, b, c) looks out of the sheet with normal n. */
static bool looks_along(const float *a, const float *b, const float *c, const float *n)
{
    double u[3], v[3];
    for (int i = 0; i < 3; i++) {
        u[i] = (double)b[i] - (double)a[i];
        v[i] = (double)c[i] - (double)a[i];
    }
    return (u[1] * v[2] - u[2] * v[1]) * (double)n[0] + (u[2] * v[0] - u[0] * v[2]) * (double)n[1] +
               (u[0] * v[1] - u[1] * v[0]) * (double)n[2] >
           0;
}

/* A triangle across a crease that is not flipped looks out between its two sheets. */
static bool stays_outward(const csg_feature *f, int s)
{
    int s1 = (s + 1) % f->side_count;
    float n[3];
    for (int i = 0; i < 3; i++)
        n[i] = f->normal[f->side[s].sheet][i] + f->normal[f->side[s1].sheet][i];
    return looks_along(f->at, f->side[s].corner, f->side[s1].corner, n);
}

/* Gives the feature's flipped sides the halves that the bits of `mask` say, in order. */
static void share_out(csg_feature_store *store, csg_feature *f, unsigned mask)
{
    for (int s = 0; s < f->side_count; s++) {
        if (!(f->flipped >> s & 1))
            continue;
        csg_feature *g = &store->features[f->side[s].beyond];
        uint16_t own = (uint16_t)(1u << s), others = (uint16_t)(1u << f->side[s].beyond_side);
        f->takes_next = (uint16_t)(mask & 1 ? f->takes_next | own : f->takes_next & ~own);
        g->takes_next = (uint16_t)(mask & 1 ? g->takes_next | others : g->takes_next & ~others);
        mask >>= 1;
    }
}

/* What share_out() would change nothing with. */
static unsigned shares_of(const csg_feature *f)
{
    unsigned mask = 0;
    for (int s = 0, bit = 0; s < f->side_count; s++)
        if (f->flipped >> s & 1)
            mask |= (unsigned)(f->takes_next >> s & 1) << bit++;
    return mask;
}

static bool cuts_at(const csg_feature_store *store, const csg_cell_tables *tables,
                    const csg_feature *f, int side)
{
    return csg_feature_cuts_at(store->features, tables, f, side, f->takes_next);
}

/* Whether the feature and what its neighbours have of the same sheets can be cut. */
static bool is_cut(const csg_feature_store *store, const csg_cell_tables *tables,
                   const csg_feature *f)
{
    bool good = csg_feature_is_cut(store->features, tables, f);
    for (int s = 0; s < f->side_count && good; s++)
        if (f->flipped >> s & 1)
            good =
                cuts_at(store, tables, &store->features[f->side[s].beyond], f->side[s].beyond_side);
    return good;
}

/* ---- sharing out -------------------------------------------------------------------------------
 */

/* What takes_next is once halves are shared out by `mask`. */
static uint16_t takes_of(const csg_feature *f, unsigned mask)
{
    unsigned takes = f->takes_next & ~(unsigned)f->flipped;
    for (int s = 0; s < f->side_count; s++)
        if (f->flipped >> s & 1) {
            takes |= (mask & 1) << s;
            mask >>= 1;
        }
    return (uint16_t)takes;
}

/* The creased side that the piece behind side s ends at. */
static int end_of_piece(const csg_feature *f, int s)
{
    do
        s = (s + 1) % f->side_count;
    while (!(f->creased >> s & 1));
    return s;
}

/* A piece depends on the halves at its two ends alone: which of these let it be cut, a bit each, by
 * what takes_next says of its begin (1) and its end (2). */
static unsigned halves_of(const csg_feature_store *store, const csg_cell_tables *tables,
                          const csg_feature *f, int s)
{
    int end = end_of_piece(f, s);
    unsigned fit = 0, free = (f->flipped >> s & 1u) | (f->flipped >> end & 1u) << 1;
    for (unsigned halves = 0; halves < 4; halves++) {
        if (halves & ~free || (s == end && halves % 3))
            continue;
        unsigned takes = (halves & 1) << s | (halves >> 1) << end;
        fit |= (unsigned)csg_feature_is_cut_behind(store->features, tables, f, s, takes) << halves;
    }
    return fit;
}

/* Whether what the neighbour over side s has of the same sheets can be cut with its halves of all
 * segments between both by `takes`, which is the feature's takes_next. */
static bool neighbour_fits(const csg_feature_store *store, const csg_cell_tables *tables,
                           const csg_feature *f, int s, unsigned takes)
{
    const csg_feature *g = &store->features[f->side[s].beyond];
    unsigned others = g->takes_next;
    for (int k = 0; k < f->side_count; k++) {
        unsigned bit = 1u << f->side[k].beyond_side;
        if (f->flipped >> k & 1 && f->side[k].beyond == f->side[s].beyond)
            others = takes >> k & 1 ? others | bit : others & ~bit;
    }
    return csg_feature_cuts_at(store->features, tables, g, f->side[s].beyond_side, others);
}

static bool all_fit(const csg_feature_store *store, const csg_cell_tables *tables,
                    const csg_feature *f, const unsigned *fit, unsigned takes)
{
    for (int s = 0; s < f->side_count; s++)
        if (f->creased >> s & 1 &&
            !(fit[s] >> ((takes >> s & 1) | (takes >> end_of_piece(f, s) & 1) << 1) & 1))
            return false;
    for (int s = 0; s < f->side_count; s++)
        if (f->flipped >> s & 1 && !neighbour_fits(store, tables, f, s, takes))
            return false;
    return true;
}

/* Looks for a way to share the halves of its flipped sides out that lets the feature be cut. Mostly
 * there is none, since some piece cannot be cut whoever has its ends. */
static bool find_shares(csg_feature_store *store, const csg_cell_tables *tables, csg_feature *f)
{
    unsigned fit[CSG_FEATURE_MOST_SIDES], end = 1u << __builtin_popcount(f->flipped);
    if (is_cut(store, tables, f))
        return true;
    if (!f->flipped)
        return false;
    for (int s = 0; s < f->side_count; s++) {
        if (!(f->creased >> s & 1))
            continue;
        fit[s] = halves_of(store, tables, f, s);
        if (!fit[s])
            return false;
    }
    for (unsigned mask = 0; mask < end; mask++) {
        if (!all_fit(store, tables, f, fit, takes_of(f, mask)))
            continue;
        share_out(store, f, mask);
        return true;
    }
    return false;
}

bool csg_feature_stays_outward(const csg_feature *f)
{
    for (int s = 0; s < f->side_count; s++)
        if (f->creased & ~f->flipped & 1u << s && !stays_outward(f, s))
            return false;
    return true;
}

/* ---- joining -----------------------------------------------------------------------------------
 */

/* Whether two apexes are not one place. */
static bool are_apart(const csg_feature_store *store, const csg_feature *f, const csg_feature *g)
{
    static const double APART = 1e-3; /* cells */
    double square = 0;
    for (int i = 0; i < 3; i++)
        square += ((double)f->at[i] - (double)g->at[i]) * ((double)f->at[i] - (double)g->at[i]);
    return square >= APART * APART * store->cell_size * store->cell_size;
}

/* Whether both apexes can be joined over side s: both ask the same question. */
static bool side_flips(csg_feature_store *store, const csg_cell_tables *tables, csg_feature *f,
                       int s)
{
    csg_feature *g = &store->features[f->side[s].beyond];
    int t = f->side[s].beyond_side, s1 = (s + 1) % f->side_count;
    if (!are_apart(store, f, g))
        return false;
    /* both halves of the flipped segment look the way their sheets do, as they are */
    if (!f->takes_next && !g->takes_next &&
        looks_along(f->at, f->side[s].corner, g->at, f->normal[f->side[s].sheet]) &&
        looks_along(g->at, f->side[s1].corner, f->at, g->normal[g->side[t].sheet]))
        return true;
    return (cuts_at(store, tables, f, s) && cuts_at(store, tables, g, t)) ||
           find_shares(store, tables, f) || find_shares(store, tables, g);
}

/* Whether another side before it joins the same two apexes: they would have an edge twice. Polygons
 * that meet in both segments of one face can. */
static bool is_joined_already(const csg_feature *f, int s)
{
    for (int k = 0; k < s; k++)
        if (f->flipped >> k & 1 && f->side[k].beyond == f->side[s].beyond)
            return true;
    return false;
}

bool csg_feature_side_holds(csg_feature_store *store, const csg_cell_tables *tables, csg_feature *f,
                            int s)
{
    if (!(f->flipped >> s & 1))
        return stays_outward(f, s);
    if (is_joined_already(f, s))
        return false;
    return store->features[f->side[s].beyond].state == CSG_FEATURE_UNSOLVED ||
           side_flips(store, tables, f, s);
}

/* Of what csg_feature_side_holds asks: that which does not depend on the vertex. Sides that are
 * creased stay so, whatever bend() does with the others. */
bool csg_feature_may_hold(const csg_feature_store *store, const csg_feature *f, int corner)
{
    for (int s = 0; s < f->side_count; s++) {
        bool is_far = s != corner && (s + 1) % f->side_count != corner;
        if (!(f->creased >> s & 1))
            continue;
        if (!(f->flipped >> s & 1)) {
            if (is_far && !stays_outward(f, s))
                return false;
            continue;
        }
        const csg_feature *g = &store->features[f->side[s].beyond];
        if (is_joined_already(f, s) ||
            (g->state != CSG_FEATURE_UNSOLVED && !are_apart(store, f, g)))
            return false;
    }
    return true;
}

static void set_bent(csg_feature *f, int s, bool bent)
{
    uint16_t bit = (uint16_t)(1u << s);
    f->bent = (uint16_t)(bent ? f->bent | bit : f->bent & ~bit);
    f->creased = (uint16_t)(bent ? f->creased | bit : f->creased & ~bit);
    f->flipped = (uint16_t)(bent ? f->flipped | bit : f->flipped & ~bit);
    f->takes_next &= f->flipped;
}

void csg_feature_agree(csg_feature_store *store, csg_feature *f)
{
    for (int s = 0; s < f->side_count; s++) {
        csg_feature *g =
            f->side[s].beyond == CSG_FEATURE_NONE ? NULL : &store->features[f->side[s].beyond];
        bool bent = f->bent >> s & 1;
        if (g && bent != (g->bent >> f->side[s].beyond_side & 1))
            set_bent(g, f->side[s].beyond_side, bent);
    }
    share_out(store, f, shares_of(f));
}

/* Flips those sides that the apex reaches across although no crease crosses them, where there is an
 * apex beyond to join it to. False: that does not help, nothing has changed. */
static bool bend(csg_feature_store *store, const csg_cell_tables *tables, csg_feature *f)
{
    csg_feature_whole before;
    csg_feature_keep(&before, f);
    for (int s = 0; s < f->side_count; s++) {
        if (f->creased >> s & 1 || f->side[s].beyond == CSG_FEATURE_NONE ||
            looks_along(f->at, f->side[s].corner, f->side[(s + 1) % f->side_count].corner,
                        f->normal[f->side[s].sheet]))
            continue;
        const csg_feature *g = &store->features[f->side[s].beyond];
        if (g->state != CSG_FEATURE_UNSOLVED && g->state != CSG_FEATURE_BARE &&
            !(g->creased >> f->side[s].beyond_side & 1))
            set_bent(f, s, true);
    }
    if (f->bent == before.feature.bent)
        return false;
    csg_feature_agree(store, f);
    if (find_shares(store, tables, f))
        return true;
    csg_feature_copy(f, &before.feature);
    csg_feature_agree(store, f);
    return false;
}

bool csg_feature_unfolds(csg_feature_store *store, const csg_cell_tables *tables, csg_feature *f)
{
    return f->state != CSG_FEATURE_FOLDED || find_shares(store, tables, f) ||
           bend(store, tables, f);
}

bool csg_feature_holds(csg_feature_store *store, const csg_cell_tables *tables, csg_feature *f)
{
    if (!csg_feature_unfolds(store, tables, f))
        return false;
    for (int s = 0; s < f->side_count; s++)
        if ((f->creased >> s & 1) && !csg_feature_side_holds(store, tables, f, s))
            return false;
    return true;
}
