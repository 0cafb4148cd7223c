/* SPDX-License-Identifier: MIT
 * All features of a mesh, block by block in Morton order, and how they hang together: which side of
 * a polygon leads to which other one, and whether the segment between them is flipped.
 */
#include <math.h>
#include <string.h>

#include "mesh/feature_cut.h"
#include "mesh/feature_smooth.h"

enum { E = CSG_BLOCK_EDGE, NEAR = 5 };

bool csg_feature_store_add(csg_feature_store *store, const csg_feature_room *room, size_t first,
                           size_t count)
{
    if (!count)
        return true;
    const csg_feature_block *blocks = room->blocks + first;
    size_t from = blocks[0].first;
    size_t features = blocks[count - 1].first + blocks[count - 1].count - from;
    if (!csg_memory_reserve(store->memory, (void **)&store->blocks, &store->block_capacity,
                            store->block_count + count, sizeof(csg_feature_block)) ||
        !csg_memory_reserve(store->memory, (void **)&store->features, &store->capacity,
                            store->count + features, sizeof(csg_feature)))
        return false;
    memcpy(store->features + store->count, room->features + from, features * sizeof(csg_feature));
    for (size_t i = 0; i < count; i++) {
        csg_feature_block entry = blocks[i];
        entry.first = (uint32_t)(store->count + entry.first - from);
        store->blocks[store->block_count++] = entry;
    }
    store->count += features;
    return true;
}

bool csg_feature_store_index(csg_feature_store *store)
{
    size_t count = 16;
    while (count < 2 * store->block_count)
        count *= 2;
    store->slots = csg_memory_alloc(store->memory, count * sizeof(uint32_t));
    if (!store->slots)
        return false;
    store->slot_count = count;
    memset(store->slots, 0, count * sizeof(uint32_t));
    for (size_t i = 0; i < store->block_count; i++) {
        size_t slot = csg_lattice_home_slot(store->blocks[i].at, count);
        while (store->slots[slot])
            slot = (slot + 1) & (count - 1);
        store->slots[slot] = (uint32_t)i + 1;
    }
    return true;
}

const csg_feature_block *csg_feature_store_find(const csg_feature_store *store,
                                                const uint32_t at[3])
{
    if (!store->block_count)
        return NULL;
    for (size_t slot = csg_lattice_home_slot(at, store->slot_count); store->slots[slot];
         slot = (slot + 1) & (store->slot_count - 1)) {
        const csg_feature_block *block = &store->blocks[store->slots[slot] - 1];
        if (!memcmp(block->at, at, sizeof block->at))
            return block;
    }
    return NULL;
}

void csg_feature_store_release(csg_feature_store *store)
{
    if (!store->memory)
        return;
    csg_memory_release(store->memory, store->features, store->capacity * sizeof(csg_feature));
    csg_memory_release(store->memory, store->blocks,
                       store->block_capacity * sizeof(csg_feature_block));
    csg_memory_release(store->memory, store->slots, store->slot_count * sizeof(uint32_t));
    *store = (csg_feature_store){0};
}

/* ---- neighbours --------------------------------------------------------------------------------
 */

/* The one face of the cell that both edges lie in, or -1: a diagonal through the cell. */
static int face_between(const csg_cell_tables *tables, uint8_t a, uint8_t b)
{
    unsigned common = tables->faces[a] & tables->faces[b];
    return common ? __builtin_ctz(common) : -1;
}

/* The same lattice edge as the cell beyond a face names it. */
static uint8_t edge_beyond(const csg_cell_tables *tables, uint8_t edge, int axis)
{
    const uint8_t *o = tables->offset[edge];
    unsigned at[3] = {o[0], o[1], o[2]};
    at[axis] ^= 1;
    unsigned along = edge / 4, first = along == 0 ? 1 : 0, second = along == 2 ? 1 : 2;
    return (uint8_t)(4 * along + at[first] + 2 * at[second]);
}

/* The cell beyond a face: moves `at` to its block. False: beyond the lattice. */
static bool step(uint32_t at[3], uint16_t *cell, int axis, bool up)
{
    int c[3] = {*cell & 7, *cell >> 3 & 7, *cell >> 6};
    c[axis] += up ? 1 : -1;
    if (c[axis] < 0 && at[axis] == 0)
        return false;
    at[axis] += c[axis] < 0 ? UINT32_MAX : c[axis] == E;
    c[axis] = (c[axis] + E) % E;
    *cell = (uint16_t)((c[2] * E + c[1]) * E + c[0]);
    return true;
}

/* The feature with a side from edge `from` to edge `to` in that cell. */
static uint32_t feature_with(const csg_feature_store *store, const csg_feature_block *block,
                             uint16_t cell, uint8_t from, uint8_t to, uint8_t *side)
{
    for (uint32_t i = block->first; i < block->first + block->count; i++) {
        const csg_feature *f = &store->features[i];
        for (uint8_t s = 0; f->cell == cell && s < f->side_count; s++)
            if (f->edge[s] == from && f->edge[(s + 1) % f->side_count] == to) {
                *side = s;
                return i;
            }
    }
    return CSG_FEATURE_NONE;
}

static void link_side(csg_feature_store *store, const csg_cell_tables *tables,
                      const csg_feature_block *block, csg_feature *f, int s)
{
    uint8_t from = f->edge[s], to = f->edge[(s + 1) % f->side_count], side = 0;
    int face = face_between(tables, from, to);
    uint32_t at[3] = {block->at[0], block->at[1], block->at[2]};
    uint16_t cell = f->cell;
    if (face < 0 || !step(at, &cell, face / 2, face % 2))
        return;
    const csg_feature_block *beyond = csg_feature_store_find(store, at);
    if (!beyond)
        return;
    uint32_t other = feature_with(store, beyond, cell, edge_beyond(tables, to, face / 2),
                                  edge_beyond(tables, from, face / 2), &side);
    if (other == CSG_FEATURE_NONE)
        return;
    if (!(store->features[other].creased >> side & 1))
        return;
    f->beyond[s] = other;
    f->beyond_side[s] = side;
    f->flipped |= (uint16_t)(1u << s);
}

void csg_feature_link(csg_feature_store *store, const csg_cell_tables *tables, size_t index)
{
    const csg_feature_block *block = &store->blocks[index];
    for (uint32_t i = block->first; i < block->first + block->count; i++) {
        csg_feature *f = &store->features[i];
        for (int s = 0; s < f->side_count; s++)
            if (f->creased >> s & 1)
                link_side(store, tables, block, f, s);
    }
}

void csg_feature_flip(csg_feature_store *store, const csg_cell_tables *tables, size_t index)
{
    const csg_feature_block *block = &store->blocks[index];
    for (uint32_t i = block->first; i < block->first + block->count; i++) {
        csg_feature *f = &store->features[i];
        if (f->creased)
            csg_feature_cut(store->features, tables, f, f->triangle);
    }
}

/* ---- giving up
 * ------------------------------------------------------------------------------------
 */

void csg_feature_demote(csg_feature_store *store, const csg_cell_tables *tables, csg_feature *f)
{
    for (int s = 0; s < f->side_count; s++) {
        if (f->beyond[s] == CSG_FEATURE_NONE)
            continue;
        csg_feature *g = &store->features[f->beyond[s]];
        g->beyond[f->beyond_side[s]] = CSG_FEATURE_NONE;
        g->flipped &= (uint16_t) ~(1u << f->beyond_side[s]);
        g->takes_next &= g->flipped;
        csg_feature_cut(store->features, tables, g, g->triangle);
        f->beyond[s] = CSG_FEATURE_NONE;
    }
    f->creased = f->flipped = f->takes_next = 0;
    f->smooth = true;
    csg_feature_divide(f, tables, 0);
    store->smooth++;
}

static bool is_corner(const csg_feature *f)
{
    return f->sheet_count > 2;
}

/* Whether a way along creases of at most `steps` leads there. */
static bool is_linked(const csg_feature_store *store, const csg_feature *f, uint32_t other,
                      int steps)
{
    for (int s = 0; s < f->side_count; s++) {
        uint32_t next = f->beyond[s];
        if (next == CSG_FEATURE_NONE)
            continue;
        if (next == other ||
            (steps > 1 && is_linked(store, &store->features[next], other, steps - 1)))
            return true;
    }
    return false;
}

/* The cell that an apex lies in: its block in at. False: beyond the lattice. */
static bool cell_of_apex(const csg_feature *f, const csg_lattice *lattice, uint32_t at[3],
                         uint16_t *cell)
{
    uint32_t c[3];
    if (!csg_lattice_cell_of(lattice, f->at, c))
        return false;
    for (int axis = 0; axis < 3; axis++)
        at[axis] = c[axis] / E;
    *cell = (uint16_t)((c[2] % E * E + c[1] % E) * E + c[0] % E);
    return true;
}

/* Whether a feature other than i, not joined to it nearby, has its polygon in that cell; and
 * whether one that is joined has. */
static void hosts_of(const csg_feature_store *store, uint32_t i, const uint32_t at[3],
                     uint16_t cell, bool *stranger, bool *friend)
{
    const csg_feature_block *host = csg_feature_store_find(store, at);
    for (uint32_t k = host ? host->first : 0; host && k < host->first + host->count; k++) {
        const csg_feature *g = &store->features[k];
        if (k == i || g->cell != cell || !g->creased)
            continue;
        bool linked = is_linked(store, &store->features[i], k, NEAR);
        *stranger = *stranger || !linked;
        *friend = *friend || linked;
    }
}

bool csg_feature_is_stray(const csg_feature_store *store, uint32_t block, uint32_t i,
                          const csg_lattice *lattice, uint32_t lowest[3])
{
    const csg_feature *f = &store->features[i];
    uint32_t at[3];
    uint16_t cell;
    bool stranger = false, friend = false;
    lowest[0] = UINT32_MAX;
    if (!f->creased || !cell_of_apex(f, lattice, at, &cell))
        return false;
    hosts_of(store, i, at, cell, &stranger, &friend);
    bool home = cell == f->cell && !memcmp(at, store->blocks[block].at, sizeof at);
    if (!stranger && !friend && !home)
        for (int axis = 0; axis < 3; axis++)
            lowest[axis] = at[axis] * E + (cell >> (3 * axis) & 7);
    return stranger;
}

/* ---- joining -----------------------------------------------------------------------------------
 */

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

/* Apexes this near to each other are one place: cells. */
static const double APART = 1e-3;

static bool are_apart(const csg_feature_store *store, const csg_feature *f, const csg_feature *g)
{
    double square = 0;
    for (int i = 0; i < 3; i++)
        square += ((double)f->at[i] - (double)g->at[i]) * ((double)f->at[i] - (double)g->at[i]);
    return square >= APART * APART * store->cell_size * store->cell_size;
}

/* Whether both halves of a flipped segment look the way their sheets do, as they are. */
static bool flips_plainly(const csg_feature *f, int s, const csg_feature *g, int t)
{
    int s1 = (s + 1) % f->side_count;
    return looks_along(f->at, f->corner[s], g->at, f->normal[f->sheet[s]]) &&
           looks_along(g->at, f->corner[s1], f->at, g->normal[g->sheet[t]]);
}

/* A triangle across a crease that is not flipped looks out between its two sheets. */
static bool stays_outward(const csg_feature *f, int s)
{
    int s1 = (s + 1) % f->side_count;
    float n[3];
    for (int i = 0; i < 3; i++)
        n[i] = f->normal[f->sheet[s]][i] + f->normal[f->sheet[s1]][i];
    return looks_along(f->at, f->corner[s], f->corner[s1], n);
}

/* Gives the feature's flipped sides the halves that the bits of `mask` say, in order. */
static void share_out(csg_feature_store *store, csg_feature *f, unsigned mask)
{
    for (int s = 0; s < f->side_count; s++) {
        if (!(f->flipped >> s & 1))
            continue;
        csg_feature *g = &store->features[f->beyond[s]];
        uint16_t own = (uint16_t)(1u << s), others = (uint16_t)(1u << f->beyond_side[s]);
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

/* Whether the feature and what its neighbours have of the same sheets can be cut. */
static bool is_cut(const csg_feature_store *store, const csg_cell_tables *tables,
                   const csg_feature *f)
{
    uint8_t triangles[CSG_FEATURE_MOST_SIDES][3];
    bool good = csg_feature_cut(store->features, tables, f, triangles);
    for (int s = 0; s < f->side_count && good; s++)
        if (f->flipped >> s & 1)
            good = csg_feature_cuts_at(store->features, tables, &store->features[f->beyond[s]],
                                       f->beyond_side[s]);
    return good;
}

/* Looks for a way to share the halves of its flipped sides out that lets the feature be cut. */
static bool find_shares(csg_feature_store *store, const csg_cell_tables *tables, csg_feature *f)
{
    unsigned before = shares_of(f), end = 1u << __builtin_popcount(f->flipped);
    if (is_cut(store, tables, f))
        return true;
    for (unsigned mask = 0; mask < end; mask++) {
        share_out(store, f, mask);
        if (is_cut(store, tables, f))
            return true;
    }
    share_out(store, f, before);
    return false;
}

/* Both ask the same question. */
static bool side_flips(csg_feature_store *store, const csg_cell_tables *tables, csg_feature *f,
                       int s)
{
    csg_feature *g = &store->features[f->beyond[s]];
    int t = f->beyond_side[s];
    if (!are_apart(store, f, g))
        return false;
    if (!f->takes_next && !g->takes_next && flips_plainly(f, s, g, t))
        return true;
    return (csg_feature_cuts_at(store->features, tables, f, s) &&
            csg_feature_cuts_at(store->features, tables, g, t)) ||
           find_shares(store, tables, f) || find_shares(store, tables, g);
}

size_t csg_feature_settle(csg_feature_store *store, const csg_cell_tables *tables)
{
    size_t changed = 0;
    for (uint32_t i = 0; i < store->count; i++) {
        csg_feature *f = &store->features[i];
        for (int s = 0; s < f->side_count; s++) {
            if (!(f->creased >> s & 1))
                continue;
            csg_feature *g =
                f->beyond[s] == CSG_FEATURE_NONE ? NULL : &store->features[f->beyond[s]];
            if (g ? side_flips(store, tables, f, s) : stays_outward(f, s))
                continue;
            bool both = !g || is_corner(f) == is_corner(g);
            changed++;
            if (g && (both || is_corner(f)))
                csg_feature_demote(store, tables, g);
            if (both || !is_corner(f))
                csg_feature_demote(store, tables, f);
        }
    }
    return changed;
}

/* ---- triangles ---------------------------------------------------------------------------------
 */

/* The sheet of the apex beyond side s that lies in this sheet of the feature. */
static uint8_t sheet_beyond(const csg_feature_store *store, const csg_feature *f, int s,
                            uint8_t sheet)
{
    const csg_feature *g = &store->features[f->beyond[s]];
    int t = f->beyond_side[s];
    return g->sheet[f->sheet[s] == sheet ? (t + 1) % g->side_count : t];
}

void csg_feature_triangle(const csg_feature_store *store, const csg_feature *f, int index,
                          csg_fan_corner corners[3])
{
    const uint8_t *t = f->triangle[index];
    int c = 0;
    while (t[c] >= CSG_FEATURE_BEYOND)
        c++;
    uint8_t sheet = f->sheet[t[c]];
    for (c = 0; c < 3; c++) {
        int s = t[c] - CSG_FEATURE_BEYOND;
        if (t[c] == CSG_FEATURE_APEX)
            corners[c] = (csg_fan_corner){.apex = f, .sheet = sheet};
        else if (s >= 0)
            corners[c] = (csg_fan_corner){.apex = &store->features[f->beyond[s]],
                                          .sheet = sheet_beyond(store, f, s, sheet)};
        else
            corners[c] = (csg_fan_corner){.edge = f->edge[t[c]]};
    }
}
