/* SPDX-License-Identifier: MIT
 * Triangles of features that run through one another. What stays in its own cell, or goes to the
 * apex next door through the face between both, cannot meet what is in other cells; the rest is
 * tried against the features around it, and polygons whose triangles cross become smooth again.
 */
#include <math.h>
#include <string.h>

#include "mesh/feature.h"

enum { E = CSG_BLOCK_EDGE, MOST_NEAR = 512 };

typedef struct triangle {
    const float *p[3];
    uint32_t owner[2]; /* features; the same one twice where it is one's alone */
} triangle;

static triangle triangle_of(const csg_feature_store *store, uint32_t i, int index)
{
    const csg_feature *f = &store->features[i];
    csg_fan_corner corners[3];
    csg_feature_triangle(store, f, index, corners);
    triangle t = {.owner = {i, i}};
    for (int c = 0; c < 3; c++) {
        const csg_feature *apex = corners[c].apex;
        if (!apex) {
            int k = 0;
            while (f->edge[k] != corners[c].edge)
                k++;
            t.p[c] = f->corner[k];
        } else {
            t.p[c] = apex->at;
            if (apex != f)
                t.owner[1] = (uint32_t)(apex - store->features);
        }
    }
    return t;
}

/* ---- crossing ----------------------------------------------------------------------------------
 */

static void difference(const float *a, const float *b, double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = (double)a[i] - (double)b[i];
}

static void cross(const double *a, const double *b, double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Six times the volume of a tetrahedron; its sign says on which side of (a, b, c) d lies. */
static double volume(const float *a, const float *b, const float *c, const float *d)
{
    double u[3], v[3], w[3], n[3];
    difference(b, a, u);
    difference(c, a, v);
    difference(d, a, w);
    cross(u, v, n);
    return dot(n, w);
}

static bool same_point(const float *a, const float *b)
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* Whether segment pq passes through a triangle, rims included. */
static bool pierces(const float *p, const float *q, const triangle *t)
{
    const float *a = t->p[0], *b = t->p[1], *c = t->p[2];
    double above = volume(a, b, c, p), below = volume(a, b, c, q);
    if ((above > 0) == (below > 0) || above == 0 || below == 0)
        return false;
    double x = volume(p, q, a, b), y = volume(p, q, b, c), z = volume(p, q, c, a);
    return (x >= 0 && y >= 0 && z >= 0) || (x <= 0 && y <= 0 && z <= 0);
}

typedef struct flat {
    double at[3][2];
} flat;

/* Along the axis on which the normal is longest. */
static flat flatten(const triangle *t, const double n[3])
{
    int axis = fabs(n[0]) > fabs(n[1]) ? 0 : 1;
    axis = fabs(n[2]) > fabs(n[axis]) ? 2 : axis;
    flat out;
    for (int c = 0; c < 3; c++) {
        out.at[c][0] = (double)t->p[c][(axis + 1) % 3];
        out.at[c][1] = (double)t->p[c][(axis + 2) % 3];
    }
    return out;
}

static double turn(const double *a, const double *b, const double *c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Whether an edge of one triangle separates both, up to a slack. */
static bool separates(const flat *t, const flat *other, double slack)
{
    double sense = turn(t->at[0], t->at[1], t->at[2]) > 0 ? 1 : -1;
    for (int c = 0; c < 3; c++) {
        bool all = true;
        for (int k = 0; k < 3; k++)
            all = all && sense * turn(t->at[c], t->at[(c + 1) % 3], other->at[k]) <= slack;
        if (all)
            return true;
    }
    return false;
}

/* In one plane, all but: these overlap where no edge separates them. */
static bool overlaps(const triangle *s, const triangle *t, double cell)
{
    double u[3], v[3], n[3], m[3];
    difference(s->p[1], s->p[0], u);
    difference(s->p[2], s->p[0], v);
    cross(u, v, n);
    difference(t->p[1], t->p[0], u);
    difference(t->p[2], t->p[0], v);
    cross(u, v, m);
    double lengths = sqrt(dot(n, n) * dot(m, m));
    if (!(fabs(dot(n, m)) > 0.9999 * lengths))
        return false;
    double length = sqrt(dot(n, n));
    for (int c = 0; c < 3; c++) {
        difference(t->p[c], s->p[0], u);
        if (fabs(dot(u, n)) > 1e-4 * cell * length)
            return false;
    }
    flat a = flatten(s, n), b = flatten(t, n);
    double slack = 1e-6 * cell * cell;
    return !separates(&a, &b, slack) && !separates(&b, &a, slack);
}

static bool meet(const triangle *s, const triangle *t, double cell)
{
    int shared = 0, si = 0, ti = 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            if (same_point(s->p[i], t->p[k])) {
                shared++;
                si = i, ti = k;
            }
    if (shared > 2)
        return true;
    if (overlaps(s, t, cell))
        return true;
    if (shared == 2)
        return false;
    for (int c = 0; c < 3; c++) {
        bool opposite_s = !shared || c == (si + 1) % 3, opposite_t = !shared || c == (ti + 1) % 3;
        if ((opposite_s && pierces(s->p[c], s->p[(c + 1) % 3], t)) ||
            (opposite_t && pierces(t->p[c], t->p[(c + 1) % 3], s)))
            return true;
    }
    return false;
}

/* ---- who is near -------------------------------------------------------------------------------
 */

typedef struct search {
    const csg_feature_store *store;
    const csg_lattice *lattice;
    double low[3], high[3]; /* of the triangle, in cells */
} search;

static void range_of(search *q, const triangle *t)
{
    const double origin[3] = {q->lattice->origin.x, q->lattice->origin.y, q->lattice->origin.z};
    for (int axis = 0; axis < 3; axis++) {
        q->low[axis] = INFINITY, q->high[axis] = -INFINITY;
        for (int c = 0; c < 3; c++) {
            double at = ((double)t->p[c][axis] - origin[axis]) / q->lattice->cell_size;
            q->low[axis] = fmin(q->low[axis], at);
            q->high[axis] = fmax(q->high[axis], at);
        }
    }
}

static void cell_of(const csg_feature_store *store, uint32_t block, uint32_t i, int out[3])
{
    const csg_feature *f = &store->features[i];
    for (int axis = 0; axis < 3; axis++)
        out[axis] = (int)store->blocks[block].at[axis] * E + (f->cell >> (3 * axis) & 7);
}

/* Whether a triangle stays in a cell. */
static bool is_in_cell(const search *q, const int cell[3])
{
    const double slack = 1e-4;
    for (int axis = 0; axis < 3; axis++)
        if (q->low[axis] < cell[axis] - slack || q->high[axis] > cell[axis] + 1 + slack)
            return false;
    return true;
}

/* Features with cells within two of the triangle's. */
static uint32_t features_near(const search *q, uint32_t out[MOST_NEAR])
{
    enum { AROUND = 2 };
    uint32_t count = 0, first[3], last[3];
    for (int axis = 0; axis < 3; axis++) {
        double from = floor(q->low[axis]) - AROUND, to = floor(q->high[axis]) + AROUND;
        first[axis] = from > 0 ? (uint32_t)from / E : 0;
        last[axis] = to > 0 ? (uint32_t)to / E : 0;
    }
    uint32_t at[3];
    for (at[2] = first[2]; at[2] <= last[2]; at[2]++)
        for (at[1] = first[1]; at[1] <= last[1]; at[1]++)
            for (at[0] = first[0]; at[0] <= last[0]; at[0]++) {
                const csg_feature_block *block = csg_feature_store_find(q->store, at);
                for (uint32_t k = 0; block && k < block->count && count < MOST_NEAR; k++) {
                    int cell[3];
                    uint32_t i = block->first + k;
                    cell_of(q->store, (uint32_t)(block - q->store->blocks), i, cell);
                    bool near = true;
                    for (int axis = 0; axis < 3; axis++)
                        near = near && cell[axis] + 1 + AROUND >= q->low[axis] &&
                               cell[axis] - AROUND <= q->high[axis];
                    if (near)
                        out[count++] = i;
                }
            }
    return count;
}

/* The segment between two apexes goes through the face between their cells, each in its own. */
static bool goes_through_face(const search *q, const float *p, const float *r, const int a[3],
                              const int b[3])
{
    const double origin[3] = {q->lattice->origin.x, q->lattice->origin.y, q->lattice->origin.z};
    double x[3], y[3];
    int axis = 0;
    for (int i = 0; i < 3; i++) {
        x[i] = ((double)p[i] - origin[i]) / q->lattice->cell_size;
        y[i] = ((double)r[i] - origin[i]) / q->lattice->cell_size;
        if (x[i] < a[i] || x[i] > a[i] + 1 || y[i] < b[i] || y[i] > b[i] + 1)
            return false;
        axis = a[i] != b[i] ? i : axis;
    }
    double t = (fmax(a[axis], b[axis]) - x[axis]) / (y[axis] - x[axis]);
    for (int i = 0; i < 3; i++) {
        double at = x[i] + t * (y[i] - x[i]);
        if (i != axis && (at < a[i] || at > a[i] + 1))
            return false;
    }
    return true;
}

/* ---- the whole ---------------------------------------------------------------------------------
 */

static uint32_t block_of(const csg_feature_store *store, uint32_t i)
{
    size_t low = 0, high = store->block_count;
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        if (store->blocks[middle].first <= i)
            low = middle;
        else
            high = middle;
    }
    return (uint32_t)low;
}

static bool is_harmless(const search *q, const csg_feature_store *store, const triangle *t,
                        const int home[3])
{
    if (t->owner[0] == t->owner[1])
        return is_in_cell(q, home);
    int other[3];
    cell_of(store, block_of(store, t->owner[1]), t->owner[1], other);
    return goes_through_face(q, store->features[t->owner[0]].at, store->features[t->owner[1]].at,
                             home, other);
}

static bool give_up(csg_feature_store *store, const csg_cell_tables *tables, const triangle *t)
{
    bool changed = false;
    for (int k = 0; k < 2; k++) {
        csg_feature *f = &store->features[t->owner[k]];
        if (f->creased) {
            csg_feature_demote(store, tables, f);
            changed = true;
        }
    }
    return changed;
}

/* The first crossing of a feature's triangles with another's: whether something was given up. */
static bool uncross(csg_feature_store *store, const csg_cell_tables *tables,
                    const csg_lattice *lattice, uint32_t i, const int home[3])
{
    for (int index = 0; index < store->features[i].side_count; index++) {
        triangle s = triangle_of(store, i, index);
        search q = {.store = store, .lattice = lattice};
        uint32_t near[MOST_NEAR];
        range_of(&q, &s);
        if (is_harmless(&q, store, &s, home))
            continue;
        uint32_t count = features_near(&q, near);
        for (uint32_t k = 0; k < count; k++)
            for (int other = 0; other < store->features[near[k]].side_count; other++) {
                triangle t = triangle_of(store, near[k], other);
                if ((near[k] == i && other == index) || !meet(&s, &t, lattice->cell_size))
                    continue;
                bool changed = give_up(store, tables, &s);
                if (give_up(store, tables, &t) || changed)
                    return true;
            }
    }
    return false;
}

size_t csg_feature_uncross(csg_feature_store *store, const csg_cell_tables *tables,
                           const csg_lattice *lattice)
{
    size_t changed = 0;
    for (uint32_t b = 0; b < store->block_count; b++)
        for (uint32_t k = 0; k < store->blocks[b].count; k++) {
            uint32_t i = store->blocks[b].first + k;
            int home[3];
            cell_of(store, b, i, home);
            changed += store->features[i].creased && uncross(store, tables, lattice, i, home);
        }
    return changed;
}
