/* SPDX-License-Identifier: MIT
 * DXF. Boxes marked "OpenSCAD" are those that `openscad -o x.svg` (2021.01) gives for
 * import("x.dxf") of the same text; the others are worked out by hand.
 */
#include <stdio.h>
#include <stdlib.h>

#include "outline/outline_support.h"

#include "outline/dxf/dxf.h"

#define PI 3.14159265358979323846

static csg_dxf_report report;
static csg_outline outline;
static char text[1 << 20];

/* Words to lines; a file may be cut into words, since no value here has a blank. */
static size_t lines_of(const char *words)
{
    size_t n = 0;
    for (; *words; words++)
        text[n++] = *words == ' ' ? '\n' : *words;
    text[n++] = '\n';
    text[n] = 0;
    return n;
}

static csgm_status read_with(const csg_dxf_request *options, const char *bytes, size_t length)
{
    csg_dxf_request request = *options;
    request.text = bytes;
    request.length = length;
    request.tolerance = 1e-3;
    return csg_dxf_outline(&memory, &request, &outline, &report);
}

static const csg_dxf_request plain;

static void read_words(const csg_dxf_request *options, const char *before, const char *entities)
{
    static char words[1 << 18];
    snprintf(words, sizeof words, "%s0 SECTION 2 ENTITIES %s 0 ENDSEC 0 EOF", before, entities);
    csgm_status status = read_with(options, text, lines_of(words));
    if (status != CSGM_OK)
        print_error("%s\n", report.problem.text);
    assert_int_equal(status, CSGM_OK);
}

static void read_dxf(const char *entities)
{
    read_words(&plain, "", entities);
}

static void expect(double x0, double y0, double x1, double y1, double area)
{
    support_expect(&outline, x0, y0, x1, y1, area, 2e-3);
    csg_outline_release(&outline);
}

#define LINE(x0, y0, x1, y1) "0 LINE 8 0 10 " #x0 " 20 " #y0 " 11 " #x1 " 21 " #y1 " "
#define OPEN_SQUARE LINE(0, 0, 10, 0) LINE(10, 0, 10, 10) LINE(10, 10, 0, 10)
#define CIRCLE(layer, x, y, r) "0 CIRCLE 8 " #layer " 10 " #x " 20 " #y " 40 " #r " "

/* All OpenSCAD. */
static void test_lines(void **state)
{
    (void)state;
    read_dxf(OPEN_SQUARE LINE(0, 10, 0, 0));
    assert_int_equal(report.entities, 4);
    assert_int_equal(report.unclosed, 0);
    expect(0, 0, 10, 10, 100);
    read_dxf(LINE(0, 0, 10, 0) LINE(10, 0.0001, 10, 10) LINE(10, 10, 0, 10) LINE(0, 10, 0, 0));
    assert_int_equal(report.unclosed, 0);
    expect(0, 0, 10, 10, 100);
    read_dxf(LINE(10, 10, 0, 10) LINE(0, 0, 10, 0) LINE(10, 10, 10, 0) LINE(0, 10, 0, 0));
    expect(0, 0, 10, 10, 100); /* in any order, either way round */
    read_dxf(OPEN_SQUARE);
    assert_int_equal(report.unclosed, 1);
    expect(0, 0, 10, 10, 100);
    read_dxf(LINE(0, 0, 10, 0) LINE(10, 0, 10, 10));
    expect(0, 0, 10, 10, 50);
    read_dxf(OPEN_SQUARE LINE(0, 10, 0, 0) LINE(0, 0, 10, 0)); /* one of them twice */
    assert_int_equal(report.unclosed, 1);
    expect(0, 0, 10, 10, 100);
    read_dxf(OPEN_SQUARE LINE(0, 10, 0, 0) LINE(0, 0, 10, 10)); /* and a diagonal */
    expect(0, 0, 10, 10, 100);
}

/* A gap wider than the reach is two loose ends, and told. */
static void test_gap(void **state)
{
    (void)state;
    read_dxf(LINE(0, 0, 10, 0) LINE(10, 0.01, 10, 10) LINE(10, 10, 0, 10) LINE(0, 10, 0, 0));
    assert_int_equal(report.unclosed, 1);
    expect(0, 0, 10, 10, 100); /* OpenSCAD: box */
    read_dxf(LINE(0, 0, 10, 0));
    assert_int_equal(report.unclosed, 1);
    assert_int_equal(outline.loop_count, 0);
    csg_outline_release(&outline);
}

static void test_curves(void **state)
{
    (void)state;
    read_dxf(CIRCLE(0, 5, 5, 3));
    expect(2, 2, 8, 8, 9 * PI); /* OpenSCAD: box */
    read_dxf("0 ARC 8 0 10 5 20 5 40 3 50 0 51 180 " LINE(2, 5, 8, 5));
    assert_int_equal(report.unclosed, 0);
    expect(2, 5, 8, 8, 4.5 * PI); /* OpenSCAD: box */
    read_dxf("0 ARC 8 0 10 5 20 5 40 3 50 270 51 90 " LINE(5, 2, 5, 8));
    expect(5, 2, 8, 8, 4.5 * PI);
    read_dxf("0 ELLIPSE 8 0 10 5 20 5 11 4 21 0 40 0.5 41 0 42 6.283185307179586");
    expect(1, 3, 9, 7, 8 * PI); /* OpenSCAD: box */
    read_dxf(
        "0 ELLIPSE 8 0 10 5 20 5 11 0 21 4 40 0.5 41 0 42 3.141592653589793 " LINE(5, 1, 5, 9));
    assert_int_equal(report.unclosed, 0);
    expect(3, 1, 5, 9, 4 * PI);
    read_dxf("0 SOLID 8 0 10 0 20 0 11 10 21 0 12 0 22 10 13 10 23 10");
    expect(0, 0, 10, 10, 100);
}

static void test_polylines(void **state)
{
    (void)state;
    read_dxf("0 LWPOLYLINE 8 0 90 3 70 1 10 0 20 0 10 10 20 0 10 10 20 10");
    expect(0, 0, 10, 10, 50); /* OpenSCAD */
    read_dxf("0 LWPOLYLINE 8 0 90 3 70 0 10 0 20 0 10 10 20 0 10 10 20 10");
    assert_int_equal(report.unclosed, 1);
    expect(0, 0, 10, 10, 50); /* OpenSCAD */
    read_dxf("0 LWPOLYLINE 8 0 90 2 70 1 10 0 20 0 42 1 10 10 20 0 42 1");
    expect(0, -5, 10, 5, 25 * PI);
    read_dxf("0 LWPOLYLINE 8 0 90 2 70 1 10 0 20 0 42 -0.41421356237309503 10 10 20 10");
    expect(0, 0, 10, 10, 25 * PI - 50); /* a quarter to the right */
    read_dxf("0 POLYLINE 8 0 66 1 70 1 0 VERTEX 8 0 10 0 20 0 0 VERTEX 8 0 10 10 20 0 42 1 "
             "0 VERTEX 8 0 10 10 20 10 0 SEQEND");
    assert_int_equal(report.entities, 1);
    expect(0, 0, 15, 10, 50 + 12.5 * PI);
}

/* A circle of radius 1 as rational quadratics, and a Bezier curve. */
static void test_splines(void **state)
{
    (void)state;
    read_dxf(
        "0 SPLINE 8 0 70 4 71 2 72 12 73 9 40 0 40 0 40 0 40 1 40 1 40 2 40 2 40 3 40 3 "
        "40 4 40 4 40 4 41 1 41 0.70710678118654752 41 1 41 0.70710678118654752 41 1 "
        "41 0.70710678118654752 41 1 41 0.70710678118654752 41 1 10 1 20 0 10 1 20 1 10 0 20 1 "
        "10 -1 20 1 10 -1 20 0 10 -1 20 -1 10 0 20 -1 10 1 20 -1 10 1 20 0");
    assert_int_equal(report.unclosed, 0);
    expect(-1, -1, 1, 1, PI);
    read_dxf(
        "0 SPLINE 8 0 70 8 71 3 72 8 73 4 40 0 40 0 40 0 40 0 40 1 40 1 40 1 40 1 10 0 20 0 10 "
        "0 20 10 10 10 20 10 10 10 20 0 " LINE(0, 0, 10, 0));
    expect(0, 0, 10, 7.5, 60);
    /* uniform knots: the middle of a quadratic one is on the chord's middle of controls */
    read_dxf("0 SPLINE 8 0 71 2 40 0 40 1 40 2 40 3 40 4 40 5 10 0 20 0 10 2 20 0 10 2 20 2 ");
    assert_int_equal(report.unclosed, 1);
    expect(1, 0, 2, 1, 1.0 / 3);
    read_dxf("0 SPLINE 8 0 71 3 40 0 40 1 10 0 20 0 10 2 20 0 "
             "0 SPLINE 8 0 71 99 10 0 20 0 0 SPLINE 8 0 "
             "0 SPLINE 8 0 71 1 40 3 40 2 40 1 40 0 10 0 20 0 10 1 20 1");
    assert_int_equal(report.ignored, 4);
    assert_string_equal(report.ignored_kind, "SPLINE");
    csg_outline_release(&outline);
}

static void test_options(void **state)
{
    (void)state;
    csg_dxf_request moved = {.scale = 2, .origin = {1, 1}}, centered = {.center = true};
    csg_dxf_request layer = {.layer = "B"}, none = {.layer = "C"};
    read_words(&moved, "", CIRCLE(0, 5, 5, 3));
    expect(2, 2, 14, 14, 36 * PI); /* OpenSCAD */
    read_words(&centered, "", CIRCLE(0, 5, 5, 3));
    expect(-3, -3, 3, 3, 9 * PI);
    read_words(&layer, "", CIRCLE(A, 5, 5, 3) CIRCLE(B, 50, 5, 3));
    expect(47, 2, 53, 8, 9 * PI); /* OpenSCAD */
    read_words(&none, "", CIRCLE(A, 5, 5, 3));
    assert_true(report.not_found);
    assert_int_equal(outline.loop_count, 0);
    csg_outline_release(&outline);
    read_words(&plain, "0 SECTION 2 HEADER 9 $ACADVER 1 AC1015 9 $INSUNITS 70 1 0 ENDSEC ",
               CIRCLE(0, 5, 5, 3));
    support_near(report.unit_mm, 25.4, 0);
    expect(2, 2, 8, 8, 9 * PI); /* OpenSCAD: units are not looked at */
}

/* Even-odd, as OpenSCAD. */
static uint32_t eight(const void *user, double radius)
{
    *(double *)user = radius;
    return 8;
}

/* Polygons of n corners: n / 2 r^2 sin(360 / n). */
static void test_fragments(void **state)
{
    double asked;
    csg_dxf_request octagons = {.fragments = eight, .fragments_user = &asked};
    const double corner = 0.5 * sqrt(0.5);
    (void)state;
    read_words(&octagons, "", CIRCLE(0, 5, 5, 3));
    assert_int_equal(outline.point_count, 8);
    expect(2, 2, 8, 8, 8 * 9 * corner);
    assert_true(asked == 3);
    read_words(&octagons, "",
               "0 ELLIPSE 8 0 10 0 20 0 11 4 21 0 40 0.5 41 0 42 6.283185307179586 ");
    assert_int_equal(outline.point_count, 8);
    expect(-4, -2, 4, 2, 8 * 8 * corner);
    assert_true(asked == 4);
    octagons.scale = 10; /* the radius is the drawing's */
    read_words(&octagons, "",
               "0 ARC 8 0 10 0 20 0 40 1 50 0 51 100 0 LINE 8 0 10 1 20 0 11 0 21 0 "
               "0 LINE 8 0 10 0 20 0 11 -0.17364817766693 21 0.984807753012208 ");
    assert_int_equal(outline.point_count, 5); /* three pieces of 33 1/3 degrees, two of lines */
    assert_true(asked == 1);
    csg_outline_release(&outline);
}

static void test_nesting(void **state)
{
    (void)state;
    read_dxf(CIRCLE(A, 5, 5, 3) CIRCLE(B, 5, 5, 2));
    expect(2, 2, 8, 8, 5 * PI);
    read_dxf(CIRCLE(A, 5, 5, 3) CIRCLE(B, 7, 5, 3));
    double lens = 18 * acos(1.0 / 3) - sqrt(32.0);
    expect(2, 2, 10, 8, 18 * PI - 2 * lens);
}

#define BLOCK "0 SECTION 2 BLOCKS 0 BLOCK 2 bb 10 0 20 0 " CIRCLE(0, 5, 5, 3) "0 ENDBLK 0 ENDSEC "

static void test_blocks(void **state)
{
    (void)state;
    csg_dxf_request layer = {.layer = "B"};
    read_words(&plain, BLOCK, "0 INSERT 8 0 2 bb 10 20 20 0 41 2 42 1 50 90");
    expect(12, 4, 18, 16, 18 * PI); /* OpenSCAD */
    read_words(&plain, BLOCK, "0 INSERT 8 0 2 bb 10 0 20 0 70 2 71 3 44 10 45 20");
    assert_int_equal(report.entities, 6);
    expect(2, 2, 18, 48, 54 * PI);
    /* what stands on layer 0 of a block is on the layer of its insert */
    read_words(&layer, BLOCK, "0 INSERT 8 B 2 bb 10 0 20 0 0 INSERT 8 A 2 bb 10 90 20 0");
    expect(2, 2, 8, 8, 9 * PI);
    /* the base point is what is put down */
    read_words(&plain,
               "0 SECTION 2 BLOCKS 0 BLOCK 2 b 10 5 20 5 " CIRCLE(0, 5, 5, 3) "0 ENDBLK 0 ENDSEC ",
               "0 INSERT 8 0 2 b 10 1 20 2");
    expect(-2, -1, 4, 5, 9 * PI);
    read_words(&plain, "", "0 INSERT 8 0 2 nowhere 10 1 20 2");
    assert_int_equal(report.unresolved, 1);
    csg_outline_release(&outline);
    read_dxf("0 ARC 8 0 10 5 20 5 40 3 50 0 51 180 230 -1 " LINE(-8, 5, -2, 5));
    assert_int_equal(report.unclosed, 0);
    expect(-8, 5, -2, 8, 4.5 * PI);
    read_dxf("0 CIRCLE 8 0 67 1 10 5 20 5 40 3 " CIRCLE(0, 1, 1, 1));
    expect(0, 0, 2, 2, PI);
}

/* A block that holds itself, and ten of ten of ... */
static void test_block_bombs(void **state)
{
    static char words[1 << 16];
    (void)state;
    read_words(&plain,
               "0 SECTION 2 BLOCKS 0 BLOCK 2 a 10 0 20 0 " CIRCLE(
                   0, 5, 5, 3) "0 INSERT 2 a 10 20 20 0 0 ENDBLK 0 ENDSEC ",
               "0 INSERT 8 0 2 a 10 0 20 0");
    assert_true(report.unresolved > 0);
    csg_outline_release(&outline);
    int n = sprintf(words, "0 SECTION 2 BLOCKS 0 BLOCK 2 b0 10 0 20 0 0 POINT 0 ENDBLK ");
    for (int i = 1; i < 12; i++)
        n += sprintf(words + n,
                     "0 BLOCK 2 b%d 10 0 20 0 0 INSERT 2 b%d 70 1000 71 1000 44 1 45 1 0 ENDBLK ",
                     i, i - 1);
    sprintf(words + n, "0 ENDSEC 0 SECTION 2 ENTITIES 0 INSERT 2 b11 0 ENDSEC 0 EOF");
    assert_int_equal(read_with(&plain, text, lines_of(words)), CSGM_ERR_LIMIT);
    assert_int_equal(outline.point_count, 0);
}

static void test_ignored(void **state)
{
    (void)state;
    read_dxf("0 MTEXT 8 0 1 hello 0 POINT 8 0 10 1 20 1 " CIRCLE(0, 1, 1, 1) CIRCLE(0, 1, 1, -1));
    assert_int_equal(report.ignored, 3);
    assert_string_equal(report.ignored_kind, "MTEXT");
    expect(0, 0, 2, 2, PI);
}

static void expect_refused(const char *bytes, size_t length, csgm_status expected)
{
    assert_int_equal(read_with(&plain, bytes, length), expected);
    assert_int_not_equal(strlen(report.problem.text), 0);
    assert_int_equal(outline.point_count, 0);
}

static void test_refused(void **state)
{
    static const char binary[] = "AutoCAD Binary DXF\r\n\x1a\0\0\0SECTION";
    (void)state;
    expect_refused("", 0, CSGM_ERR_FORMAT);
    expect_refused("solid x", 7, CSGM_ERR_FORMAT);
    expect_refused(binary, sizeof binary, CSGM_ERR_FORMAT);
    assert_non_null(strstr(report.problem.text, "binary"));
    expect_refused("AC1018\0\0", 8, CSGM_ERR_FORMAT);
    assert_non_null(strstr(report.problem.text, "DWG"));
    /* numbers that are none or too large are 0 */
    read_dxf(LINE(0, 0, nan, 0) LINE(1e300, 0, 10, 10) LINE(10, 10, 0, 0) LINE(inf, 5, -inf, 5));
    csg_box box = csg_outline_box(&outline);
    assert_true(outline.loop_count == 0 || csg_box_is_finite(box));
    csg_outline_release(&outline);
}

static csgm_status read_sample(const char *bytes, size_t length)
{
    csgm_status status = read_with(&plain, bytes, length);
    csg_outline_release(&outline);
    return status;
}

static void read_damaged(const char *bytes, size_t length)
{
    csgm_status status = read_sample(bytes, length);
    assert_true(status == CSGM_OK || status == CSGM_ERR_FORMAT || status == CSGM_ERR_LIMIT);
    assert_true(status == CSGM_OK || report.problem.text[0]);
}

static void test_damage(void **state)
{
    (void)state;
    size_t length = lines_of(
        BLOCK
        "0 SECTION 2 ENTITIES 0 INSERT 8 0 2 bb 10 20 20 0 41 2 42 1 50 90 70 2 44 9 " OPEN_SQUARE
        "0 LWPOLYLINE 8 0 90 2 70 1 10 0 20 0 42 1 10 10 20 0 42 1 "
        "0 POLYLINE 8 0 66 1 70 1 0 VERTEX 8 0 10 0 20 0 0 VERTEX 8 0 10 10 20 0 42 1 "
        "0 VERTEX 8 0 10 10 20 10 0 SEQEND "
        "0 SPLINE 8 0 71 2 40 0 40 1 40 2 40 3 40 4 40 5 10 0 20 0 10 2 20 0 10 2 20 2 "
        "0 ELLIPSE 8 0 10 5 20 5 11 0 21 4 40 0.5 41 0 42 3.1 0 ENDSEC 0 EOF");
    char *copy = malloc(length + 1);
    assert_non_null(copy);
    memcpy(copy, text, length + 1);
    support_damage(copy, length, 2000, read_damaged);
    support_starve(copy, length, read_sample);
    free(copy);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define TEST(name) cmocka_unit_test_setup_teardown(name, support_setup, support_teardown)
        TEST(test_lines),   TEST(test_gap),     TEST(test_curves),    TEST(test_polylines),
        TEST(test_splines), TEST(test_options), TEST(test_fragments), TEST(test_nesting),
        TEST(test_blocks),  TEST(test_ignored), TEST(test_refused),   TEST(test_block_bombs),
        TEST(test_damage),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
