/* SPDX-License-Identifier: MIT
 * Text. Boxes and areas are those of `openscad -o x.svg` (2021.01) for text(...) with the same
 * arguments and $fn = 64, on Debian 12 with fonts-liberation and fonts-dejavu-core; without these
 * two the tests are skipped. Letters are the same to the last bit: the tolerance is of the digits
 * that are kept here.
 */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "outline/outline_support.h"

#include "base/random.h"
#include "outline/letters/text.h"

static const char sans[] = "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf";
static const char dejavu[] = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
static csg_fonts *fonts;
static csg_text_report report;
static csg_outline outline;

static int setup(void **state)
{
    support_setup(state);
    return csg_fonts_create(&memory, &fonts) == CSGM_OK ? 0 : -1;
}

static int teardown(void **state)
{
    csg_fonts_destroy(fonts);
    return support_teardown(state);
}

static csg_text_request request_of(const char *text)
{
    return (csg_text_request){
        .text = text, .length = strlen(text), .size = 10, .spacing = 1, .pieces = 64 / 8 + 1};
}

static void set(const csg_text_request *request)
{
    csgm_status status = csg_text_outline(fonts, request, &outline, &report);
    if (status != CSGM_OK)
        print_error("%s\n", report.problem.text);
    assert_int_equal(status, CSGM_OK);
}

static void expect(double x0, double x1, double y0, double y1, double area)
{
    const double tolerance = 6e-5, area_tolerance = 2e-5;
    support_near(report.position.x, x0, tolerance);
    support_near(report.position.y, y0, tolerance);
    support_near(report.extent.x, x1 - x0, 2 * tolerance);
    support_near(report.extent.y, y1 - y0, 2 * tolerance);
    support_clean(&outline);
    support_near(support_area(&outline), area, area_tolerance * area);
    csg_outline_release(&outline);
}

static void test_alignment(void **state)
{
    static const struct {
        csg_halign halign;
        csg_valign valign;
        double size, spacing, x0, x1, y0, y1, area;
    } cases[] = {
        {CSG_HALIGN_LEFT, CSG_VALIGN_BASELINE, 10, 1, 1.1393, 23.4055, -2.8820, 9.5548, 79.2306},
        {CSG_HALIGN_LEFT, CSG_VALIGN_BASELINE, 20, 1, 2.2786, 46.8109, -5.7640, 19.1096, 316.924},
        {CSG_HALIGN_LEFT, CSG_VALIGN_BASELINE, 1, 1, 0.1139, 2.3405, -0.2882, 0.9555, 0.7923},
        {CSG_HALIGN_CENTER, CSG_VALIGN_BASELINE, 10, 1, -10.9207, 11.3454, -2.8820, 9.5548,
         79.2306},
        {CSG_HALIGN_RIGHT, CSG_VALIGN_BASELINE, 10, 1, -22.9807, -0.7146, -2.8820, 9.5548, 79.2306},
        {CSG_HALIGN_LEFT, CSG_VALIGN_TOP, 10, 1, 1.1393, 23.4055, -12.2132, 0.2235, 79.2306},
        {CSG_HALIGN_LEFT, CSG_VALIGN_CENTER, 10, 1, 1.1393, 23.4055, -6.1382, 6.2985, 79.2306},
        {CSG_HALIGN_LEFT, CSG_VALIGN_BOTTOM, 10, 1, 1.1393, 23.4055, -0.0632, 12.3735, 79.2306},
        {CSG_HALIGN_LEFT, CSG_VALIGN_BASELINE, 10, 1.5, 1.1393, 31.6938, -2.8820, 9.5548, 79.2306},
        {CSG_HALIGN_RIGHT, CSG_VALIGN_BASELINE, 10, 1.5, -35.0407, -4.4862, -2.8820, 9.5548,
         79.2306},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        csg_text_request request = request_of("Hxg");
        request.halign = cases[i].halign;
        request.valign = cases[i].valign;
        request.size = cases[i].size;
        request.spacing = cases[i].spacing;
        set(&request);
        assert_string_equal(report.font, "Liberation Sans:style=Regular");
        assert_false(report.font_missing);
        expect(cases[i].x0, cases[i].x1, cases[i].y0, cases[i].y1, cases[i].area);
    }
}

static void test_fonts(void **state)
{
    static const struct {
        const char *text, *font;
        double x0, x1, y0, y1, area;
    } cases[] = {
        {"AV To fi ffi", NULL, 0.0271, 58.6949, -0.1356, 10.0634, 159.298},
        {"Ag", "Liberation Serif:style=Bold", 0.1356, 16.6034, -3.0651, 9.1683, 67.757},
        {"Ag", "DejaVu Sans", 0.1085, 16.8327, -2.8864, 10.1248, 64.839},
        {"Ag", "Liberation Sans:style=Bold Italic", -0.2848, 18.0410, -2.8820, 9.5548, 84.122},
        {"Ag", dejavu, 0.1085, 16.8327, -2.8864, 10.1248, 64.839},
        {"\xc3\xa9 \xc3\xa0 \xc3\xbc \xc3\xb1", NULL, 0.5900, 40.7839, -0.1356, 10.2261, 102.281},
        {"\xce\x95\xce\xbb\xce\xbb\xce\xb7\xce\xbd\xce\xb9\xce\xba\xce\xac", NULL, 1.1393, 54.1936,
         -2.8753, 10.4635, 168.217},
        {"\xd9\x85\xd8\xb1\xd8\xad\xd8\xa8\xd8\xa7", "DejaVu Sans", 1.3088, 30.4272, -3.3906,
         10.5516, 72.846},
        {" A", NULL, 3.0471, 12.2561, 0, 9.5548, 27.525}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        csg_text_request request = request_of(cases[i].text);
        request.font = cases[i].font;
        set(&request);
        assert_false(report.font_missing);
        assert_false(report.style_missing);
        assert_int_equal(report.lent, 0);
        assert_int_equal(report.missing_count, 0);
        expect(cases[i].x0, cases[i].x1, cases[i].y0, cases[i].y1, cases[i].area);
    }
}

static void test_directions(void **state)
{
    static const struct {
        csg_text_direction direction;
        csg_halign halign;
        csg_valign valign;
        double x0, x1, y0, y1;
    } cases[] = {
        {CSG_TEXT_RTL, CSG_HALIGN_LEFT, CSG_VALIGN_BASELINE, 0.5832, 23.2220, -2.8820, 9.5548},
        {CSG_TEXT_RTL, CSG_HALIGN_CENTER, CSG_VALIGN_BASELINE, -11.4768, 11.1620, -2.8820, 9.5548},
        {CSG_TEXT_TTB, CSG_HALIGN_LEFT, CSG_VALIGN_BASELINE, -3.7582, 3.9995, -36.9362, -1.4721},
        {CSG_TEXT_BTT, CSG_HALIGN_LEFT, CSG_VALIGN_BASELINE, -3.7582, 3.9995, -36.4847, -1.1438},
        {CSG_TEXT_TTB, CSG_HALIGN_CENTER, CSG_VALIGN_CENTER, -7.5488, 0.2089, -17.8428, 17.6213},
        {CSG_TEXT_TTB, CSG_HALIGN_RIGHT, CSG_VALIGN_TOP, -11.3394, -3.5817, 1.2505, 36.7147},
        {CSG_TEXT_TTB, CSG_HALIGN_LEFT, CSG_VALIGN_BOTTOM, -3.7582, 3.9995, -36.9362, -1.4721},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        csg_text_request request = request_of("Hxg");
        request.direction = cases[i].direction;
        request.halign = cases[i].halign;
        request.valign = cases[i].valign;
        set(&request);
        expect(cases[i].x0, cases[i].x1, cases[i].y0, cases[i].y1, 79.2306);
    }
}

/* Turned over. */
static void test_negative_size(void **state)
{
    (void)state;
    csg_text_request request = request_of("Hg");
    request.size = -10;
    request.pieces = 2; /* OpenSCAD's fewest, and what it takes for a negative size */
    set(&request);
    expect(-16.6237, -1.1393, -9.5548, 2.8820, 61.2541);
    request.size = 0;
    set(&request);
    assert_int_equal(outline.loop_count, 0);
    csg_outline_release(&outline);
    request = request_of("");
    set(&request);
    assert_int_equal(outline.loop_count, 0);
    csg_outline_release(&outline);
}

static void test_missing_font(void **state)
{
    (void)state;
    csg_text_request request = request_of("A");
    request.font = "No Such Font";
    set(&request);
    assert_true(report.font_missing);
    assert_true(strlen(report.font) > 0);
    csg_outline_release(&outline);
    request.font = "Liberation Sans:style=Wiggly";
    set(&request);
    assert_false(report.font_missing);
    assert_true(report.style_missing);
    csg_outline_release(&outline);
    request.font = "/no/such/file.ttf";
    assert_int_equal(csg_text_outline(fonts, &request, &outline, &report), CSGM_ERR_IO);
    assert_int_not_equal(strlen(report.problem.text), 0);
    request.font = "/etc/passwd";
    assert_int_equal(csg_text_outline(fonts, &request, &outline, &report), CSGM_ERR_FORMAT);
    assert_int_not_equal(strlen(report.problem.text), 0);
}

/* Liberation Sans has no Arabic; DejaVu Sans has, and lends it: the same area as set in it. */
static void test_lent_glyphs(void **state)
{
    (void)state;
    csg_text_request request = request_of("\xd9\x85\xd8\xb1\xd8\xad\xd8\xa8\xd8\xa7");
    set(&request);
    assert_string_equal(report.font, "Liberation Sans:style=Regular");
    assert_int_equal(report.lent, 5);
    assert_int_equal(report.missing_count, 0);
    assert_int_equal(strncmp(report.other, "DejaVu Sans", 11), 0);
    expect(1.3088, 30.4272, -3.3906, 10.5516, 72.846);
}

static void test_missing_glyphs(void **state)
{
    (void)state;
    csg_text_request request = request_of("A\xf3\xb0\x80\x81\n\xff"
                                          "B\xf3\xb0\x80\x81");
    set(&request);
    assert_int_equal(report.missing_count, 2); /* the private one, the line end */
    assert_int_equal(report.missing[0], 0xf0001);
    assert_int_equal(report.missing[1], '\n');
    csg_outline_release(&outline);
    /* marks and joiners are no characters of their own */
    request = request_of("e\xcc\x81\xe2\x80\x8dx\xef\xb8\x8f");
    set(&request);
    assert_int_equal(report.missing_count, 0);
    csg_outline_release(&outline);
}

#ifdef WITH_FRIBIDI
static double left_of(const char *text)
{
    csg_text_request request = request_of(text);
    request.font = "DejaVu Sans";
    set(&request);
    double left = report.position.x;
    csg_outline_release(&outline);
    return left;
}

static double extent_of(const char *text)
{
    csg_text_request request = request_of(text);
    request.font = "DejaVu Sans";
    set(&request);
    double extent = report.advance.x;
    csg_outline_release(&outline);
    return extent;
}

static double width_of(const char *text)
{
    csg_text_request request = request_of(text);
    request.font = "DejaVu Sans";
    set(&request);
    double width = report.extent.x;
    csg_outline_release(&outline);
    return width;
}

/* The order of runs, by where the narrow "I" (a bar) stands. */
static void test_mixed_directions(void **state)
{
    (void)state;
    /* Arabic first: it stands at the right, the Latin word and the digits at the left */
    support_near(left_of("\xd8\xad\xd8\xad I"), left_of("I"), 1e-9);
    support_near(left_of("I \xd8\xad\xd8\xad"), left_of("I"), 1e-9);
    assert_true(left_of("\xd8\xad\xd8\xad 17") < left_of("17 ") + 1e-9);
    support_near(left_of("\xd8\xad\xd8\xad 17"), left_of("17"), 1e-9);
    /* Latin first: what stands between the two, and at the end, is of the whole */
    support_near(extent_of("I \xd8\xad\xd8\xad! I"),
                 extent_of("I ") + extent_of("\xd8\xad\xd8\xad") + extent_of("! I"), 1e-9);
    csg_text_request request = request_of("I \xd8\xad\xd8\xad!");
    request.font = "DejaVu Sans";
    set(&request);
    double right = report.position.x + report.extent.x;
    csg_outline_release(&outline);
    support_near(right, extent_of("I \xd8\xad\xd8\xad") + left_of("!") + width_of("!"), 1e-9);
    /* a number stays whole: "1,234" begins with its 1 at the very left */
    support_near(left_of("\xd7\x90\xd7\x91 1,234"), left_of("1,234"), 1e-9);
    /* and nothing is lost */
    support_near(extent_of("\xd8\xad\xd8\xad I"), extent_of("\xd8\xad\xd8\xad ") + extent_of("I"),
                 1e-9);
}
#endif

static void test_added_file(void **state)
{
    csg_problem problem = {""};
    (void)state;
    assert_int_equal(csg_fonts_add_file(fonts, dejavu, &problem), CSGM_OK);
    assert_int_equal(csg_fonts_add_file(fonts, "/no/such.ttf", &problem), CSGM_ERR_IO);
    csg_text_request request = request_of("A");
    request.font = "DejaVu Sans";
    set(&request);
    assert_false(report.font_missing);
    csg_outline_release(&outline);
}

static void test_metrics(void **state)
{
    csg_font_metrics metrics;
    (void)state;
    assert_int_equal(csg_text_font_metrics(fonts, sans, 10, &metrics, &report), CSGM_OK);
    support_near(metrics.ascent, 1854.0 / 2048 * 1000 / 72, 1e-9); /* hhea of the font */
    support_near(metrics.descent, -434.0 / 2048 * 1000 / 72, 1e-9);
    assert_true(metrics.interline >= metrics.ascent - metrics.descent);
    csg_text_request request = request_of("Hxg");
    request.valign = CSG_VALIGN_TOP;
    set(&request);
    support_near(report.ascent, 9.5548, 2e-3);
    support_near(report.descent, -2.8820, 2e-3);
    support_near(report.advance.x, 24.12, 5e-3);
    support_near(report.offset.y, -9.3312, 2e-3);
    csg_outline_release(&outline);
}

static void test_absurd(void **state)
{
    static char many[CSG_TEXT_MOST_CHARACTERS * 4 + 2];
    (void)state;
    csg_text_request request = request_of("A");
    request.size = NAN;
    assert_int_equal(csg_text_outline(fonts, &request, &outline, &report), CSGM_ERR_SCENE);
    request.size = 1e300;
    assert_int_equal(csg_text_outline(fonts, &request, &outline, &report), CSGM_ERR_SCENE);
    request.size = 10;
    request.spacing = INFINITY;
    assert_int_equal(csg_text_outline(fonts, &request, &outline, &report), CSGM_ERR_SCENE);
    memset(many, ' ', sizeof many - 1);
    request = request_of(many);
    assert_int_equal(csg_text_outline(fonts, &request, &outline, &report), CSGM_ERR_LIMIT);
    assert_int_not_equal(strlen(report.problem.text), 0);
}

/* A font file with bytes changed: refused, or set with whatever it draws. */
static void read_font(const char *bytes, size_t size)
{
    csg_font *font = NULL;
    csg_problem problem = {""};
    csg_bytes copy = {&memory, csg_memory_alloc(&memory, size + 1), size};
    assert_non_null(copy.data);
    memcpy(copy.data, bytes, size);
    csgm_status status = csg_font_open(&copy, 0, &font, &problem);
    assert_true(status == CSGM_OK || status == CSGM_ERR_FORMAT);
    csg_outline_init(&outline, &memory);
    csg_font_pen pen = {.scale = 1e-4, .tolerance = 0.1};
    for (uint32_t glyph = 0; status == CSGM_OK && glyph < 60; glyph++)
        assert_int_equal(csg_font_outline(font, glyph, &pen, &outline), CSGM_OK);
    csg_outline_release(&outline);
    csg_font_close(font);
}

static void test_broken_fonts(void **state)
{
    csg_bytes bytes;
    csg_problem problem = {""};
    (void)state;
    assert_int_equal(csg_bytes_read(&memory, sans, &bytes, &problem), CSGM_OK);
    support_damage(bytes.data, bytes.size, 40, read_font);
    csg_random random = {3}; /* and in the first 4 KiB, where the tables of tables are */
    for (int round = 0; round < 200; round++) {
        uint32_t at = csg_random_below(&random, 4096);
        char before = bytes.data[at];
        bytes.data[at] = (char)csg_random_next(&random);
        read_font(bytes.data, bytes.size);
        bytes.data[at] = before;
    }
    csg_bytes_release(&bytes);
}

static csgm_status set_starved(const char *text, size_t length)
{
    csg_fonts *own;
    csg_text_request request = request_of(text);
    request.length = length;
    request.font = sans;
    csgm_status status = csg_fonts_create(&memory, &own);
    if (status != CSGM_OK)
        return status;
    status = csg_text_outline(own, &request, &outline, &report);
    csg_outline_release(&outline);
    csg_fonts_destroy(own);
    return status == CSGM_ERR_FORMAT ? CSGM_ERR_MEMORY
                                     : status; /* FreeType may take it for broken */
}

static void test_starved(void **state)
{
    (void)state;
    csg_fonts_destroy(fonts);
    fonts = NULL;
    support_starve("Ag", 2, set_starved);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)
        TEST(test_alignment),        TEST(test_fonts),        TEST(test_directions),
        TEST(test_negative_size),    TEST(test_missing_font), TEST(test_lent_glyphs),
        TEST(test_missing_glyphs),   TEST(test_added_file),   TEST(test_metrics),
        TEST(test_absurd),           TEST(test_broken_fonts), TEST(test_starved),
#ifdef WITH_FRIBIDI
        TEST(test_mixed_directions),
#endif
    };
    if (access(sans, R_OK) != 0 || access(dejavu, R_OK) != 0) {
        puts("skipped: fonts-liberation or fonts-dejavu-core is not installed");
        return 77;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
