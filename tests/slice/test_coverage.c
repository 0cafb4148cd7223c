/* SPDX-License-Identifier: MIT
 * How much of each pixel contours enclose: rectangles and triangles by hand, bands, and what is
 * beside the picture.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka wants the four above first */
#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "io/layers/coverage.h"

enum { WIDTH = 8, HEIGHT = 6, STRIDE = WIDTH + 2 };

typedef struct picture {
    uint8_t pixels[HEIGHT][WIDTH];
    double area; /* in pixels */
} picture;

static picture draw(csg_vec2 *points, uint32_t count, csg_vec2 corner, double pixel, uint32_t band)
{
    static double sums[HEIGHT * STRIDE];
    picture out = {.area = 0};
    const csg_outline o = {.points = points, .ends = &count, .point_count = count, .loop_count = 1};
    for (uint32_t first = 0; first < HEIGHT; first += band) {
        uint32_t end = first + band < HEIGHT ? first + band : HEIGHT;
        memset(sums, 0, sizeof sums);
        csg_coverage_add(&o, 2, corner, pixel, WIDTH, first, end, sums);
        for (uint32_t y = first; y < end; y++) {
            double covered = 0;
            csg_coverage_bytes(sums + (size_t)(y - first) * STRIDE, WIDTH, out.pixels[y]);
            for (int x = 0; x < WIDTH; x++) {
                covered += sums[(size_t)(y - first) * STRIDE + (size_t)x];
                out.area += covered;
            }
        }
    }
    return out;
}

/* Scene units are halves: a rectangle from (0.75, 0.5) to (2.5, 1.25) pixels above the lower left
 * corner of a picture with its upper left one at (0, 3), pixels of a half. */
static void rectangles(void **state)
{
    csg_vec2 p[] = {{0.1875, 0.125}, {0.625, 0.125}, {0.625, 0.3125}, {0.1875, 0.3125}};
    picture out = draw(p, 4, (csg_vec2){0, 3}, 0.5, HEIGHT);
    assert_true(fabs(out.area - 1.75 * 0.75) < 1e-12);
    assert_int_equal(out.pixels[5][0], 32);  /* 1/4 by 1/2 */
    assert_int_equal(out.pixels[5][1], 128); /* 1 by 1/2 */
    assert_int_equal(out.pixels[5][2], 64);
    assert_int_equal(out.pixels[4][1], 64); /* 1 by 1/4 */
    assert_int_equal(out.pixels[4][3], 0);
    assert_int_equal(out.pixels[3][1], 0);
}

static void triangles_in_bands(void **state)
{
    csg_vec2 p[] = {{0.05, 0.1}, {1.9, 0.35}, {0.7, 1.45}};
    double area = 0.5 * ((1.9 - 0.05) * (1.45 - 0.1) - (0.35 - 0.1) * (0.7 - 0.05)) * 4 / 0.25;
    picture whole = draw(p, 3, (csg_vec2){0, 3}, 0.5, HEIGHT);
    assert_true(fabs(whole.area - area) < 1e-11);
    for (uint32_t band = 1; band < HEIGHT; band++) {
        picture out = draw(p, 3, (csg_vec2){0, 3}, 0.5, band);
        assert_memory_equal(out.pixels, whole.pixels, sizeof whole.pixels);
    }
    csg_vec2 hole[] = {p[2], p[1], p[0]};
    assert_true(fabs(draw(hole, 3, (csg_vec2){0, 3}, 0.5, 2).area + area) < 1e-11);
}

/* What reaches beyond the picture covers what is in it. */
static void beyond_the_edges(void **state)
{
    csg_vec2 p[] = {{-3, -3}, {9, -3}, {9, 9}, {-3, 9}};
    picture out = draw(p, 4, (csg_vec2){0, 3}, 0.5, 4);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            assert_int_equal(out.pixels[y][x], 255);
    csg_vec2 turned[] = {{1, -3}, {5, 0.75}, {1, 4.5}, {-3, 0.75}};
    assert_true(fabs(draw(turned, 4, (csg_vec2){0, 3}, 0.5, 3).area - WIDTH * HEIGHT) < 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rectangles),
        cmocka_unit_test(triangles_in_bands),
        cmocka_unit_test(beyond_the_edges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
