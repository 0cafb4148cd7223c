/* SPDX-License-Identifier: MIT
 * See outline_support.h.
 */
#include "outline_support.h"

#include <stdlib.h>

void failing_init(failing_memory *f, long left)
{
    const csgm_allocator allocator = {failing_alloc, failing_release, &f->allocator};
    f->allocator = (failing){left, 0};
    csg_memory_init(&f->memory, &allocator, 0);
}

void add_star(csg_outline *outline, csg_random *random, csg_vec2 center, double inner, double outer,
              int corners, bool clockwise)
{
    for (int i = 0; i < corners; i++) {
        double turn = (clockwise ? corners - i : i) * 2 * 3.14159265358979323846 / corners;
        double radius = csg_random_uniform(random, inner, outer);
        assert_true(csg_outline_add(
            outline, (csg_vec2){center.x + radius * cos(turn), center.y + radius * sin(turn)}));
    }
    assert_true(csg_outline_close(outline));
}

void add_rectangle(csg_outline *outline, double x0, double y0, double x1, double y1)
{
    const csg_vec2 corners[4] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    for (int i = 0; i < 4; i++)
        assert_true(csg_outline_add(outline, corners[i]));
    assert_true(csg_outline_close(outline));
}

void add_scribble(csg_outline *outline, csg_random *random, double size, int corners)
{
    for (int i = 0; i < corners; i++)
        assert_true(csg_outline_add(outline, (csg_vec2){csg_random_uniform(random, -size, size),
                                                        csg_random_uniform(random, -size, size)}));
    assert_true(csg_outline_close(outline));
}

typedef struct walk {
    const csg_outline *outline;
    size_t loop, i;
    csg_vec2 a, b;
} walk;

static bool next_segment(walk *w)
{
    const csg_outline *o = w->outline;
    while (w->loop < o->loop_count && w->i >= o->ends[w->loop])
        w->loop++;
    if (w->loop >= o->loop_count)
        return false;
    size_t next = w->i + 1 < o->ends[w->loop] ? w->i + 1 : csg_outline_first(o, w->loop);
    w->a = o->points[w->i++];
    w->b = o->points[next];
    return true;
}

double area_of(const csg_outline *outline)
{
    double area = 0;
    for (walk w = {.outline = outline}; next_segment(&w);)
        area += 0.5 * (w.a.x * w.b.y - w.a.y * w.b.x);
    return area;
}

int winding_of(const csg_outline *outline, csg_vec2 p)
{
    double turn = 0;
    for (walk w = {.outline = outline}; next_segment(&w);) {
        double ax = w.a.x - p.x, ay = w.a.y - p.y, bx = w.b.x - p.x, by = w.b.y - p.y;
        turn += atan2(ax * by - ay * bx, ax * bx + ay * by);
    }
    return (int)lrint(turn / (2 * 3.14159265358979323846));
}

double distance_of(const csg_outline *outline, csg_vec2 p)
{
    double best = INFINITY;
    for (walk w = {.outline = outline}; next_segment(&w);) {
        double ux = w.b.x - w.a.x, uy = w.b.y - w.a.y, px = p.x - w.a.x, py = p.y - w.a.y;
        double t = fmin(fmax((px * ux + py * uy) / (ux * ux + uy * uy), 0), 1);
        best = fmin(best, hypot(px - t * ux, py - t * uy));
    }
    return best;
}

/* ---- triangles ---------------------------------------------------------------------------- */

typedef struct edge {
    uint32_t from, to;
    int sign; /* -1: of the outline */
} edge;

static int compare_edges(const void *left, const void *right)
{
    const edge *a = left, *b = right;
    uint32_t low_a = a->from < a->to ? a->from : a->to, low_b = b->from < b->to ? b->from : b->to;
    uint32_t high_a = a->from ^ a->to ^ low_a, high_b = b->from ^ b->to ^ low_b;
    return low_a != low_b ? (low_a > low_b) - (low_a < low_b)
                          : (high_a > high_b) - (high_a < high_b);
}

/* The first point at the same place. */
static uint32_t place_of(const csg_outline *outline, size_t point)
{
    csg_vec2 p = outline->points[point];
    for (size_t i = 0; i < point; i++) {
        if (outline->points[i].x == p.x && outline->points[i].y == p.y)
            return (uint32_t)i;
    }
    return (uint32_t)point;
}

static size_t add_outline_edges(const csg_outline *outline, edge *edges)
{
    size_t n = 0;
    for (size_t loop = 0; loop < outline->loop_count; loop++) {
        size_t first = csg_outline_first(outline, loop), end = outline->ends[loop];
        for (size_t i = first; i < end; i++) {
            uint32_t from = place_of(outline, i),
                     to = place_of(outline, i + 1 < end ? i + 1 : first);
            if (from != to)
                edges[n++] = (edge){from, to, -1};
        }
    }
    return n;
}

static void check_edges(const csg_outline *outline, const uint32_t *indices, size_t count)
{
    edge *edges = malloc((count + outline->point_count) * sizeof *edges);
    assert_non_null(edges);
    size_t n = add_outline_edges(outline, edges);
    for (size_t i = 0; i < count; i += 3) {
        for (size_t k = 0; k < 3; k++)
            edges[n++] = (edge){indices[i + k], indices[i + (k + 1) % 3], 1};
    }
    qsort(edges, n, sizeof *edges, compare_edges);
    for (size_t i = 0, end; i < n; i = end) {
        int forward = 0, backward = 0; /* of the triangles; an edge of the outline counts as used */
        for (end = i; end < n && !compare_edges(&edges[i], &edges[end]); end++) {
            bool is_forward = edges[end].from < edges[end].to;
            *(is_forward ? &forward : &backward) += edges[end].sign;
        }
        assert_int_equal(forward, backward);
    }
    free(edges);
}

void check_triangles(const csg_outline *outline, const uint32_t *indices, size_t count,
                     double slack)
{
    double area = 0, turned = 0;
    assert_int_equal(count % 3, 0);
    for (size_t i = 0; i < count; i += 3) {
        assert_true(indices[i] < outline->point_count);
        csg_vec2 a = outline->points[indices[i]], b = outline->points[indices[i + 1]],
                 c = outline->points[indices[i + 2]];
        double twice = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        assert_true(indices[i] != indices[i + 1] && indices[i + 1] != indices[i + 2] &&
                    indices[i + 2] != indices[i]);
        area += 0.5 * twice;
        turned -= twice < 0 ? 0.5 * twice : 0;
    }
    double expected = area_of(outline);
    assert_true(fabs(area - expected) <= 1e-9 * (1 + fabs(expected)));
    assert_true(turned <= slack);
    check_edges(outline, indices, count);
}
