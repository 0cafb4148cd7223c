/* SPDX-License-Identifier: MIT
 * The walk; see cover.h. What of a piece projects into a triangle is as far from it as its corners
 * are, since the distance to one triangle is convex. What lies beyond an edge goes to the triangle
 * on the other side of that. Which triangle a piece is held against is a guess that may be wrong
 * without harm: it is settled by the distances of its corners alone.
 */
#include "shape/polyhedra/cover.h"

#include <string.h>

/* ---- who is across an edge ------------------------------------------------------------------ */

/* The lists of edges.h know all half-edges of an edge, and take five times the memory. Here so many
 * are looked through around a point: in the middle of a fan there may be millions, but its edges
 * are found from their other ends. */
enum { AROUND_MOST = 64 };

typedef struct halves {
    const csg_triangles *chain;
    const csg_tree *tree;
    uint32_t *starts; /* per point, and one more */
    uint32_t *list;   /* 3 place + corner, grouped by the point that they start from */
} halves;

/* The point at a corner of a triangle, by its place. */
static uint32_t point_at(const halves *h, uint32_t place, uint32_t corner)
{
    return h->chain->corners[h->tree->triangles[place].index][corner];
}

static uint32_t start_of(const halves *h, uint32_t half)
{
    return point_at(h, half / 3, half % 3);
}

static uint32_t end_of(const halves *h, uint32_t half)
{
    return point_at(h, half / 3, half % 3 < 2 ? half % 3 + 1 : 0);
}

static void group_halves(halves *h, uint32_t half_count)
{
    for (uint32_t half = 0; half < half_count; half++)
        h->starts[start_of(h, half) + 1]++;
    for (size_t i = 1; i <= h->chain->point_count; i++)
        h->starts[i] += h->starts[i - 1];
    for (uint32_t half = 0; half < half_count; half++)
        h->list[h->starts[start_of(h, half)]++] = half;
    /* each start has moved to the next one's place */
    memmove(h->starts + 1, h->starts, h->chain->point_count * sizeof *h->starts);
    h->starts[0] = 0;
}

static void match_half(const halves *h, uint32_t half, csg_across *across)
{
    uint32_t start = start_of(h, half), end = end_of(h, half);
    uint32_t begin = h->starts[end], count = h->starts[end + 1] - begin;
    for (uint32_t i = 0; i < count && count <= AROUND_MOST; i++) {
        uint32_t other = h->list[begin + i];
        if (end_of(h, other) != start)
            continue;
        across[half / 3].places[half % 3] = other / 3;
        across[other / 3].places[other % 3] = half / 3;
        return;
    }
}

bool csg_across_make(csg_arena *scratch, const csg_triangles *chain, const csg_tree *tree,
                     csg_across *across)
{
    uint32_t half_count = (uint32_t)(3 * tree->count);
    csg_arena_mark mark = csg_arena_get_mark(scratch);
    halves h = {.chain = chain, .tree = tree};
    h.starts = csg_arena_calloc(scratch, chain->point_count + 1, sizeof *h.starts);
    h.list = csg_arena_alloc(scratch, half_count * sizeof *h.list);
    if (!h.starts || !h.list)
        return false;
    group_halves(&h, half_count);
    for (size_t place = 0; place < tree->count; place++)
        across[place] = (csg_across){{CSG_ACROSS_NONE, CSG_ACROSS_NONE, CSG_ACROSS_NONE}};
    for (uint32_t half = 0; half < half_count; half++)
        if (across[half / 3].places[half % 3] == CSG_ACROSS_NONE)
            match_half(&h, half, across);
    csg_arena_release_to(scratch, mark);
    return true;
}

/* ---- the walk ------------------------------------------------------------------------------- */

enum { STACK = 16, STEPS_MOST = 64 };

/* How far a corner is inside each edge of a triangle: barycentric coordinates, times their sum. And
 * its height above the triangle's plane, times the normal's length. */
typedef struct seat {
    double inside[3], height;
} seat;

/* Of a triangle's height: what is no more than this beyond an edge counts as on it, so that what
 * was cut at an edge is not cut again on its other side. */
static const double ON_EDGE = 0x1p-40;

/* A piece above a triangle, while what is beyond its edges is cut off. */
typedef struct footing {
    csg_vec3 corners[CSG_PIECE_CORNERS];
    seat seats[CSG_PIECE_CORNERS];
    uint32_t count;
    double whole;     /* the normal's length, squared: the sum of the coordinates */
    double snapped;   /* how far what counts as on an edge may be from the triangle */
    double limits[3]; /* what is more than this beyond an edge, squared, is too far away */
} footing;

typedef struct walk {
    const csg_tree *tree;
    const csg_across *across;
    double enough, bound;
    csg_piece stack[STACK]; /* hint: the triangle that a piece is held against */
    uint32_t depth;
} walk;

static void take_seats(const walk *w, const csg_piece *piece, const csg_tree_triangle *t,
                       footing *f)
{
    csg_vec3 normal = csg_vec3_cross(t->ab, t->ac), bc = csg_vec3_sub(t->ac, t->ab);
    csg_vec3 to_b = csg_vec3_cross(t->ac, normal), to_c = csg_vec3_cross(normal, t->ab);
    double whole = csg_vec3_dot(normal, normal), limit = w->enough * w->enough * whole;
    double ab2 = csg_vec3_dot(t->ab, t->ab), ac2 = csg_vec3_dot(t->ac, t->ac);
    f->count = piece->count;
    f->whole = whole;
    f->snapped = 4 * ON_EDGE * sqrt(fmax(ab2, ac2));
    f->limits[0] = limit * ab2;
    f->limits[1] = limit * csg_vec3_dot(bc, bc);
    f->limits[2] = limit * ac2;
    for (uint32_t i = 0; i < piece->count; i++) {
        csg_vec3 ap = csg_vec3_sub(piece->corners[i], t->a);
        double b = csg_vec3_dot(ap, to_b), c = csg_vec3_dot(ap, to_c);
        f->corners[i] = piece->corners[i];
        f->seats[i] = (seat){{c, whole - b - c, b}, csg_vec3_dot(ap, normal)};
        for (int k = 0; k < 3; k++)
            if (fabs(f->seats[i].inside[k]) <= ON_EDGE * whole)
                f->seats[i].inside[k] = 0;
    }
}

/* Whether some corner is beyond an edge; *is_far: by more than is near enough. */
static bool is_some_beyond(const footing *f, bool *is_far)
{
    bool is_some = false;
    *is_far = false;
    for (uint32_t i = 0; i < f->count; i++)
        for (int k = 0; k < 3; k++) {
            double s = f->seats[i].inside[k];
            is_some |= s < 0;
            *is_far |= s < 0 && s * s > f->limits[k];
        }
    return is_some;
}

/* What of a piece lies beyond an edge. */
typedef enum share { NONE_BEYOND, SOME_BEYOND, ALL_BEYOND } share;

static share share_beyond(const footing *f, int edge)
{
    uint32_t inside = 0, beyond = 0;
    for (uint32_t i = 0; i < f->count; i++) {
        inside += f->seats[i].inside[edge] > 0;
        beyond += f->seats[i].inside[edge] < 0;
    }
    return !beyond ? NONE_BEYOND : inside ? SOME_BEYOND : ALL_BEYOND;
}

/* The distance of what projects into the triangle. */
static double highest(const footing *f)
{
    double most = 0;
    for (uint32_t i = 0; i < f->count; i++)
        most = fmax(most, f->seats[i].height * f->seats[i].height);
    return sqrt(most / f->whole) + f->snapped;
}

static seat between(const seat *from, const seat *to, double part, int edge)
{
    seat s = {.height = from->height + part * (to->height - from->height)};
    for (int k = 0; k < 3; k++)
        s.inside[k] = from->inside[k] + part * (to->inside[k] - from->inside[k]);
    s.inside[edge] = 0;
    return s;
}

/* Takes what is beyond an edge off; beyond->count is below 3 where there is nothing. False:
 * rounding has made the piece so far from convex that the edge's line crosses it more than twice,
 * and corners might be more than there is room for. */
static bool cut_off(footing *f, int edge, csg_piece *beyond)
{
    csg_vec3 corners[CSG_PIECE_CORNERS];
    seat seats[CSG_PIECE_CORNERS];
    uint32_t count = 0, outside = 0, crossings = 0;
    for (uint32_t i = 0; i < f->count; i++) {
        uint32_t j = i + 1 < f->count ? i + 1 : 0;
        csg_vec3 p = f->corners[i], q = f->corners[j];
        double here = f->seats[i].inside[edge], there = f->seats[j].inside[edge];
        if (here >= 0) {
            corners[count] = p;
            seats[count++] = f->seats[i];
        }
        if (here <= 0)
            beyond->corners[outside++] = p;
        if ((here > 0 && there < 0) || (here < 0 && there > 0)) {
            if (++crossings > 2)
                return false;
            double part = here / (here - there);
            corners[count] = csg_vec3_add(p, csg_vec3_scale(csg_vec3_sub(q, p), part));
            seats[count] = between(&f->seats[i], &f->seats[j], part, edge);
            beyond->corners[outside++] = corners[count++];
        }
    }
    beyond->count = outside;
    f->count = count;
    memcpy(f->corners, corners, count * sizeof *corners);
    memcpy(f->seats, seats, count * sizeof *seats);
    return true;
}

static bool settle(walk *w, double bound)
{
    w->bound = fmax(w->bound, bound);
    return bound <= w->enough;
}

/* Puts what is beyond an edge on the stack, to be held against the triangle across it. */
static bool hand_over(walk *w, uint32_t place, int edge, footing *f)
{
    csg_piece *beyond = &w->stack[w->depth];
    if (!cut_off(f, edge, beyond))
        return false;
    beyond->hint = w->across[place].places[edge];
    if (beyond->count < 3)
        return true;
    w->depth++;
    return beyond->hint != CSG_ACROSS_NONE;
}

/* Cuts a piece along the edges of its triangle. What lies between two triangles that meet in a
 * ridge, above neither, is cut off at the ends of their edge before it is handed on, and then near
 * enough to it. */
static bool cut_all(walk *w, uint32_t place, footing *f)
{
    const csg_tree_triangle *t = &w->tree->triangles[place];
    uint32_t ignored;
    bool is_cut = false;
    for (int k = 0; k < 3; k++) {
        if (share_beyond(f, k) != SOME_BEYOND)
            continue;
        if (!hand_over(w, place, k, f))
            return false;
        is_cut = true;
    }
    for (int k = 0; k < 3 && f->count >= 3; k++) {
        if (share_beyond(f, k) != ALL_BEYOND)
            continue;
        csg_piece rest;
        rest.count = f->count;
        memcpy(rest.corners, f->corners, f->count * sizeof *f->corners);
        double bound = is_cut ? csg_piece_bound(&rest, t, &ignored) : INFINITY;
        return bound <= w->enough ? settle(w, bound) : hand_over(w, place, k, f);
    }
    return f->count < 3 || settle(w, highest(f));
}

/* Holds the piece on top of the stack against its triangle; false: the walk ends here. */
static bool take_step(walk *w)
{
    const csg_piece *piece = &w->stack[--w->depth];
    uint32_t place = piece->hint, ignored;
    const csg_tree_triangle *t = &w->tree->triangles[place];
    if (t->is_needle)
        return settle(w, csg_piece_bound(piece, t, &ignored));
    footing f;
    bool is_far;
    take_seats(w, piece, t, &f);
    if (!is_some_beyond(&f, &is_far))
        return settle(w, highest(&f));
    double bound = is_far ? INFINITY : csg_piece_bound(piece, t, &ignored);
    if (bound <= w->enough)
        return settle(w, bound);
    return f.count + 3 <= CSG_PIECE_CORNERS && w->depth + 3 <= STACK && cut_all(w, place, &f);
}

bool csg_triangle_is_covered(const csg_tree *tree, const csg_across *across, const csg_vec3 v[3],
                             uint32_t begin, double enough, double *bound)
{
    walk w;
    w.tree = tree;
    w.across = across;
    w.enough = enough;
    w.bound = 0;
    w.depth = 1;
    w.stack[0].count = 3;
    w.stack[0].hint = begin;
    memcpy(w.stack[0].corners, v, 3 * sizeof *v);
    for (int steps = 0; w.depth; steps++)
        if (steps == STEPS_MOST || !take_step(&w))
            return false;
    *bound = w.bound;
    return true;
}
