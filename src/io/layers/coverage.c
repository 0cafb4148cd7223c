/* SPDX-License-Identifier: MIT
 * See coverage.h. Each segment adds to the sums of a row what changes from a pixel to the next: a
 * pixel that it runs through gets the part to its right, the next one the rest of its height. So
 * coverage is the running sum along a row.
 */
#include "io/layers/coverage.h"

#include <math.h>

/* A piece in one pixel: it falls by `fall` rows, its middle is `at` of the pixel's width from the
 * left. */
static void add_piece(double *sums, uint32_t column, double at, double fall)
{
    sums[column] += fall * (1 - at);
    sums[column + 1] += fall * at;
}

/* A segment within one row, from x0 to x1 in pixels. */
static void add_in_row(double *sums, uint32_t width, double x0, double x1, double fall)
{
    double low = fmin(fmax(fmin(x0, x1), 0), width), high = fmin(fmax(fmax(x0, x1), 0), width);
    double whole = fabs(x1 - x0);
    if (!(whole > 0) || high <= low) { /* upright, or beside the picture */
        double at = fmin(fmax(0.5 * (x0 + x1), 0), width);
        add_piece(sums, (uint32_t)at, at - floor(at), fall);
        return;
    }
    if (fmin(x0, x1) < 0)
        sums[0] += fall * (low - fmin(x0, x1)) / whole;
    if (fmax(x0, x1) > width)
        sums[width] += fall * (fmax(x0, x1) - high) / whole;
    for (double from = low, to; from < high; from = to) {
        to = fmin(floor(from) + 1, high);
        add_piece(sums, (uint32_t)from, 0.5 * (from + to) - floor(from),
                  fall * (to - from) / whole);
    }
}

/* From p to q in pixels, y downwards. */
static void add_segment(csg_vec2 p, csg_vec2 q, uint32_t width, uint32_t first, uint32_t end,
                        double *sums)
{
    double sign = q.y > p.y ? 1 : -1, slope = (q.x - p.x) / (q.y - p.y);
    double top = fmax(fmin(p.y, q.y), first), bottom = fmin(fmax(p.y, q.y), end);
    for (double from = top, to; from < bottom; from = to) {
        uint32_t row = (uint32_t)from;
        to = fmin(row + 1.0, bottom);
        double x0 = p.x + (from - p.y) * slope, x1 = p.x + (to - p.y) * slope;
        add_in_row(sums + (size_t)(row - first) * (width + 2), width, x0, x1, sign * (to - from));
    }
}

void csg_coverage_add(const csg_outline *o, double scale, csg_vec2 corner, double pixel,
                      uint32_t width, uint32_t first, uint32_t end, double *sums)
{
    for (size_t loop = 0; loop < o->loop_count; loop++) {
        size_t start = csg_outline_first(o, loop);
        for (size_t i = start; i < o->ends[loop]; i++) {
            csg_vec2 a = o->points[i], b = o->points[i + 1 < o->ends[loop] ? i + 1 : start];
            csg_vec2 p = {(a.x * scale - corner.x) / pixel, (corner.y - a.y * scale) / pixel};
            csg_vec2 q = {(b.x * scale - corner.x) / pixel, (corner.y - b.y * scale) / pixel};
            add_segment(p, q, width, first, end, sums);
        }
    }
}

void csg_coverage_bytes(const double *sums, uint32_t width, uint8_t *out)
{
    double covered = 0;
    for (uint32_t i = 0; i < width; i++) {
        covered += sums[i];
        out[i] = (uint8_t)(255 * fmin(fmax(covered, 0), 1) + 0.5);
    }
}
