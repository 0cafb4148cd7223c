/* SPDX-License-Identifier: MIT
 * See delaunay.h. Half-edge h runs from indices[h] to the next corner of its triangle.
 */
#include "shape/plane/delaunay.h"

#include <stdlib.h>

#include "base/elementary.h"
#include "base/orient.h"

#define NONE UINT32_MAX

typedef struct half_edge {
    uint32_t low, high, half;
} half_edge;

typedef struct flipper {
    const csg_vec2 *points;
    uint32_t *corners; /* the indices */
    uint32_t *across;  /* per half-edge: the other way along the same edge; NONE: the rim */
    uint32_t *stack;   /* half-edges to look at */
    uint8_t *waits;    /* per half-edge: it is on the stack */
    size_t depth;
} flipper;

static uint32_t next_of(uint32_t h)
{
    return h % 3 == 2 ? h - 2 : h + 1;
}
static uint32_t previous_of(uint32_t h)
{
    return h % 3 == 0 ? h + 2 : h - 1;
}

static int compare(const void *a, const void *b)
{
    const half_edge *x = a, *y = b;
    if (x->low != y->low)
        return x->low < y->low ? -1 : 1;
    if (x->high != y->high)
        return x->high < y->high ? -1 : 1;
    return x->half < y->half ? -1 : 1;
}

/* Edges of two triangles that run along them in opposite ways. */
static void match(flipper *f, half_edge *edges, size_t count)
{
    for (uint32_t h = 0; h < count; h++) {
        uint32_t a = f->corners[h], b = f->corners[next_of(h)];
        edges[h] = (half_edge){a < b ? a : b, a < b ? b : a, h};
        f->across[h] = NONE;
        f->waits[h] = 0;
    }
    qsort(edges, count, sizeof *edges, compare);
    for (size_t i = 0, end; i < count; i = end) {
        for (end = i + 1;
             end < count && edges[end].low == edges[i].low && edges[end].high == edges[i].high;)
            end++;
        uint32_t h = edges[i].half, g = end - i == 2 ? edges[i + 1].half : h;
        if (f->corners[h] != f->corners[g]) {
            f->across[h] = g;
            f->across[g] = h;
        }
    }
}

static void look_again(flipper *f, uint32_t h)
{
    if (f->across[h] == NONE || f->waits[h])
        return;
    f->waits[h] = 1;
    f->stack[f->depth++] = h;
}

/* Of the angle at p between the ways to a and b: its sine and cosine, times both lengths. */
static void angle_at(csg_vec2 p, csg_vec2 a, csg_vec2 b, double *sine, double *cosine)
{
    double ax = a.x - p.x, ay = a.y - p.y, bx = b.x - p.x, by = b.y - p.y;
    *sine = ax * by - ay * bx;
    *cosine = ax * bx + ay * by;
}

/* The angles that face the edge are more than half a turn together, and the other diagonal lies in
 * both triangles. */
static bool is_flipped(const flipper *f, uint32_t h)
{
    static const double CERTAIN = 1e-9;
    uint32_t g = f->across[h];
    csg_vec2 a = f->points[f->corners[h]], b = f->points[f->corners[g]],
             c = f->points[f->corners[previous_of(h)]], d = f->points[f->corners[previous_of(g)]];
    double sine[2], cosine[2];
    angle_at(c, a, b, &sine[0], &cosine[0]);
    angle_at(d, b, a, &sine[1], &cosine[1]);
    double size = csg_hypot(sine[0], cosine[0]) * csg_hypot(sine[1], cosine[1]);
    return sine[0] * cosine[1] + cosine[0] * sine[1] < -CERTAIN * size &&
           csg_orient_plane(c, a, d) > 0 && csg_orient_plane(d, b, c) > 0;
}

/* The edge from a to b becomes one from d to c. */
static void flip(flipper *f, uint32_t h)
{
    uint32_t g = f->across[h], h_last = previous_of(h), g_last = previous_of(g);
    uint32_t beyond_h = f->across[g_last], beyond_g = f->across[h_last];
    f->corners[h] = f->corners[g_last];
    f->corners[g] = f->corners[h_last];
    f->across[h] = beyond_h;
    f->across[g] = beyond_g;
    if (beyond_h != NONE)
        f->across[beyond_h] = h;
    if (beyond_g != NONE)
        f->across[beyond_g] = g;
    f->across[h_last] = g_last;
    f->across[g_last] = h_last;
    look_again(f, h);
    look_again(f, next_of(h));
    look_again(f, g);
    look_again(f, next_of(g));
}

static void flip_all(flipper *f, size_t count)
{
    enum { MOST_FLIPS = 100 }; /* per half-edge */
    for (uint32_t h = 0; h < count; h++)
        if (f->across[h] > h)
            look_again(f, h);
    uint64_t left = (uint64_t)count * MOST_FLIPS;
    while (f->depth && left) {
        uint32_t h = f->stack[--f->depth];
        f->waits[h] = 0;
        if (f->across[h] == NONE || !is_flipped(f, h))
            continue;
        flip(f, h);
        left--;
    }
}

bool csg_delaunay_improve(const csg_outline *outline, csg_memory *memory, uint32_t *indices,
                          size_t count)
{
    size_t bytes = count * sizeof(uint32_t), edge_bytes = count * sizeof(half_edge);
    if (!count)
        return true;
    flipper f = {.points = outline->points,
                 .corners = indices,
                 .across = csg_memory_alloc(memory, bytes),
                 .stack = csg_memory_alloc(memory, bytes),
                 .waits = csg_memory_alloc(memory, count)};
    half_edge *edges = csg_memory_alloc(memory, edge_bytes);
    bool done = f.across && f.stack && f.waits && edges;
    if (done) {
        match(&f, edges, count);
        flip_all(&f, count);
    }
    csg_memory_release(memory, f.across, bytes);
    csg_memory_release(memory, f.stack, bytes);
    csg_memory_release(memory, f.waits, count);
    csg_memory_release(memory, edges, edge_bytes);
    return done;
}
