/* SPDX-License-Identifier: MIT
 * SVG. Boxes marked "OpenSCAD" are those that `openscad -o x.svg` (2021.01) gives for
 * import("x.svg") of the same text; the others are worked out by hand.
 */
#include <stdio.h>
#include <stdlib.h>

#include "outline/outline_support.h"

#include "outline/svg/svg.h"
#include "outline/svg/svg_path.h"

#define PI 3.14159265358979323846

static csg_svg_report report;
static csg_outline outline;

static csgm_status read_with(const csg_svg_request *options, const char *text, size_t length)
{
    csg_svg_request request = *options;
    request.text = text;
    request.length = length;
    request.tolerance = request.tolerance > 0 ? request.tolerance : 1e-3;
    return csg_svg_outline(&memory, &request, &outline, &report);
}

static const csg_svg_request plain;

/* <svg attributes>inside</svg> */
static void read_svg(const csg_svg_request *options, const char *attributes, const char *inside)
{
    char text[4096];
    int length = snprintf(text, sizeof text,
                          "<svg xmlns='http://www.w3.org/2000/svg' "
                          "xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' "
                          "xmlns:xlink='http://www.w3.org/1999/xlink' %s>%s</svg>",
                          attributes, inside);
    assert_in_range(length, 1, sizeof text - 1);
    csgm_status status = read_with(options, text, (size_t)length);
    if (status != CSGM_OK)
        print_error("%s\n", report.problem.text);
    assert_int_equal(status, CSGM_OK);
}

static void expect(double x0, double y0, double x1, double y1, double area)
{
    support_expect(&outline, x0, y0, x1, y1, area, 2e-3);
    csg_outline_release(&outline);
}

static void expect_nothing(void)
{
    assert_int_equal(outline.loop_count, 0);
    csg_outline_release(&outline);
}

static const char rectangle[] = "<rect x='10' y='20' width='30' height='5'/>";
static const char page[] = "width='100mm' height='100mm' viewBox='0 0 100 100'";

/* All OpenSCAD. */
static void test_page(void **state)
{
    static const struct {
        const char *attributes;
        double dpi, x0, y0, x1, y1;
    } pages[] = {
        {"", 0, 10, -25, 40, -20},
        {"", 96, 10, -25, 40, -20},
        {"width='100' height='50'", 0, 10, -7.3611, 40, -2.3611},
        {"width='100' height='50'", 96, 10, -11.7708, 40, -6.77083},
        {"width='100mm' height='50mm'", 0, 10, 25, 40, 30},
        {"width='100mm' height='50mm' viewBox='0 0 200 100'", 0, 5, 37.5, 20, 40},
        {"viewBox='0 0 200 100'", 0, 3.52777, 26.4583, 14.1111, 28.2222},
        {"width='100px' height='50px' viewBox='0 0 200 100'", 0, 1.32291, 9.92188, 5.29166,
         10.5833},
        {"width='100' height='50' viewBox='0 0 200 100'", 96, 1.32291, 9.92188, 5.29166, 10.5833},
        {"width='100mm' height='80mm' viewBox='0 0 200 100'", 0, 5, 52.5, 20, 55},
        {"width='100mm' height='80mm' viewBox='0 0 200 100' preserveAspectRatio='none'", 0, 5, 60,
         20, 64},
        {"width='100mm' height='80mm' viewBox='0 0 200 100' preserveAspectRatio='xMinYMin meet'", 0,
         5, 67.5, 20, 70},
        {"width='100mm' height='80mm' viewBox='0 0 200 100' preserveAspectRatio='xMidYMid slice'",
         0, -22, 60, 2, 64},
        {"width='100%' height='100%' viewBox='0 0 200 100'", 0, 10, 75, 40, 80},
        {"width='100%' height='100%'", 0, 10, -25, 40, -20},
        {"width='1in' height='1in' viewBox='0 0 100 100'", 0, 2.53999, 19.05, 10.16, 20.32}};
    (void)state;
    for (size_t i = 0; i < sizeof pages / sizeof *pages; i++) {
        csg_svg_request options = {.dpi = pages[i].dpi};
        read_svg(&options, pages[i].attributes, rectangle);
        expect(pages[i].x0, pages[i].y0, pages[i].x1, pages[i].y1,
               (pages[i].x1 - pages[i].x0) * (pages[i].y1 - pages[i].y0));
    }
}

/* OpenSCAD adds the corner's y where SVG subtracts it. */
static void test_view_box_corner(void **state)
{
    (void)state;
    read_svg(&plain, "width='100mm' height='50mm' viewBox='5 7 200 100'", rectangle);
    expect(2.5, 41, 17.5, 43.5, 37.5);
}

static void test_center(void **state)
{
    (void)state;
    csg_svg_request options = {.center = true};
    read_svg(&options, "width='100mm' height='50mm' viewBox='0 0 200 100'", rectangle);
    expect(-7.5, -1.25, 7.5, 1.25, 37.5); /* OpenSCAD */
}

/* Open lines are strokes. All boxes OpenSCAD. */
static void test_strokes(void **state)
{
    (void)state;
    read_svg(&plain, page, "<path d='M10 10 L30 10 L30 30'/>");
    expect(9.5, 69.5, 30.5, 90.5, 41);
    read_svg(&plain, page, "<path d='M10 10 L30 10 L30 30' style='fill:none;stroke-width:2'/>");
    expect(9, 69, 31, 91, 84);
    read_svg(&plain, page, "<path d='M10 10 L30 10 L30 30 Z' fill='none' stroke-width='2'/>");
    expect(10, 70, 30, 90, 200);
    read_svg(&plain, page, "<path d='M10 10 L30 10 L30 30 L10 10'/>");
    expect(10, 70, 30, 90, 200);
    read_svg(&plain, page, "<line x1='10' y1='10' x2='30' y2='10'/>");
    expect(9.5, 89.5, 30.5, 90.5, 21);
    read_svg(&plain, page,
             "<line x1='10' y1='10' x2='30' y2='10' stroke-width='2' stroke-linecap='butt'/>");
    expect(10, 89, 30, 91, 40);
    read_svg(&plain, page,
             "<line x1='10' y1='10' x2='30' y2='10' stroke-width='2' stroke-linecap='round'/>");
    expect(9, 89, 31, 91, 40 + PI);
    read_svg(&plain, page,
             "<path d='M10 10 L30 10 L30 30' stroke-width='2' stroke-linejoin='bevel' "
             "stroke-linecap='butt'/>");
    expect(10, 70, 31, 91, 80 - 1 + 0.5);
    read_svg(&plain, page,
             "<path d='M10 10 L30 10 L30 30' stroke-width='2' stroke-linejoin='round' "
             "stroke-linecap='butt'/>");
    expect(10, 70, 31, 91, 80 - 1 + PI / 4);
    read_svg(&plain, page, "<g transform='scale(2)'><path d='M10 10 L30 10'/></g>");
    expect(19, 79, 61, 81, 84);
    read_svg(&plain, page, "<polyline points='10,10 30,10 30,30'/>");
    expect(9.5, 69.5, 30.5, 90.5, 41);
    /* a needle's miter is longer than the limit of 4 */
    read_svg(&plain, page,
             "<path d='M10 50 L60 51 L10 52' stroke-width='2' stroke-linecap='butt'/>");
    support_clean(&outline);
    assert_true(csg_outline_box(&outline).max.x < 61);
    csg_outline_release(&outline);
    read_svg(&plain, page,
             "<path d='M10 50 L60 51 L10 52' stroke-width='2' stroke-linecap='butt' "
             "stroke-miterlimit='100'/>");
    support_clean(&outline);
    support_near(csg_outline_box(&outline).max.x, 60 + sqrt(2501), 1e-6);
    csg_outline_release(&outline);
}

/* What is filled and not stroked is an area, though it be open. */
static void test_filled_open_path(void **state)
{
    (void)state;
    read_svg(&plain, page, "<path d='M10 10 L30 10 L30 30' stroke='none' fill='red'/>");
    expect(10, 70, 30, 90, 200);
}

static void test_shapes(void **state)
{
    (void)state;
    read_svg(&plain, page, "<rect x='10' y='10' width='10' height='6' rx='2'/>");
    expect(10, 84, 20, 90, 60 - (4 - PI) * 4); /* OpenSCAD: box */
    read_svg(&plain, page, "<rect x='10' y='10' width='10' height='6' rx='50' ry='1'/>");
    expect(10, 84, 20, 90, 60 - (4 - PI) * 5);
    read_svg(&plain, page, "<circle cx='10' cy='10' r='5' fill='none' stroke='black'/>");
    expect(5, 85, 15, 95, 25 * PI); /* OpenSCAD: box */
    read_svg(&plain, page, "<ellipse cx='10' cy='10' rx='5' ry='2'/>");
    expect(5, 88, 15, 92, 10 * PI);
    read_svg(&plain, page, "<polygon points='10,10 30,10 30,30' fill='none'/>");
    expect(10, 70, 30, 90, 200);
    read_svg(&plain, page, "<rect x='1cm' y='10%' width='5mm' height='1in'/>");
    expect(96 / 2.54, 90 - 96, 96 / 2.54 + 5 * 96 / 25.4, 90, 96 * 5 * 96 / 25.4);
    read_svg(&plain, page, "<rect width='0' height='5'/><circle r='-1'/><ellipse rx='1'/>");
    expect_nothing();
}

static void test_paths(void **state)
{
    static const struct {
        const char *d;
        double x0, y0, x1, y1, area;
    } paths[] = {
        {"M0 0H10V10H0Z", 0, 0, 10, 10, 100},
        {"m5,5h10v10h-10zm20,0h10v10h-10z", 5, 5, 35, 15, 200},
        {"M0 0 10 0 10 10 0 10Z", 0, 0, 10, 10, 100},
        {"M0 0l10 0l0 10l-10 0z", 0, 0, 10, 10, 100},
        {"M10 0A5 5 0 0 1 0 0Z", 0, 0, 10, 5, PI * 12.5},
        {"M0 0A5 5 0 0 1 10 0Z", 0, -5, 10, 0, PI * 12.5},
        {"M0 0a5 5 0 1010 0z", 0, 0, 10, 5, PI * 12.5}, /* flags without blanks */
        {"M10 0A10 10 0 0 1 0 10L0 0Z", 0, 0, 10, 10, PI * 25},
        {"M10 0A10 10 0 1 0 0 10L0 0Z", -10, -10, 10, 10, PI * 75},
        {"M-1 0A.5 .5 0 0 0 1 0Z", -1, 0, 1, 1, PI / 2}, /* grown to reach */
        {"M-4 0A4 2 90 0 0 4 0Z", -4, 0, 4, 8, PI * 16},
        {"M0 0Q5 10 10 0Z", 0, 0, 10, 5, 100.0 / 3},
        {"M0 0Q5 10 10 0T20 0Z", 0, -5, 20, 5, 200.0 / 3},
        {"M0 0C0 10 10 10 10 0Z", 0, 0, 10, 7.5, 60},
        {"M0 0C0 10 10 10 10 0S20 -10 20 0Z", 0, -7.5, 20, 7.5, 120},
        {"M0 0 5-5 .5.5Z", 0, -5, 5, 0.5, 2.5},
    };
    (void)state;
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        char inside[200];
        snprintf(inside, sizeof inside, "<path transform='scale(1,-1)' d='%s'/>", paths[i].d);
        read_svg(&plain, "", inside);
        assert_int_equal(report.broken, 0);
        expect(paths[i].x0, paths[i].y0, paths[i].x1, paths[i].y1, paths[i].area);
    }
}

/* Drawn up to the mistake. */
static void test_broken_paths(void **state)
{
    static const char *const paths[] = {"M0 0H10V10H0Z L", "M0 0H10V10H0Z M3 4 5",
                                        "M0 0H10V10H0Z A1 1 0 2 0 5 5", "M0 0H10V10H0Z 5 5",
                                        "M0 0H10V10H0Z hello"};
    (void)state;
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        char inside[200];
        snprintf(inside, sizeof inside, "<path d='%s'/>", paths[i]);
        read_svg(&plain, "", inside);
        assert_int_equal(report.broken, 1);
        expect(0, -10, 10, 0, 100);
    }
    read_svg(&plain, "", "<path d='L5 5 6 6'/>");
    assert_int_equal(report.broken, 1);
    expect_nothing();
    read_svg(&plain, "", "<path d='M0 0H1e999V10Z'/><path d='M0 0H1e300V10Z'/>");
    assert_int_equal(report.broken, 2);
    expect_nothing();
}

static void test_tolerance(void **state)
{
    (void)state;
    csg_svg_request coarse = {.tolerance = 0.5}, fine = {.tolerance = 1e-4};
    read_svg(&coarse, page, "<g transform='scale(10)'><circle cx='5' cy='5' r='5'/></g>");
    size_t few = outline.point_count;
    csg_outline_release(&outline);
    read_svg(&fine, page, "<g transform='scale(10)'><circle cx='5' cy='5' r='5'/></g>");
    size_t many = outline.point_count;
    for (size_t i = 0; i < many; i++) {
        csg_vec2 a = outline.points[i], b = outline.points[(i + 1) % many];
        double r = hypot((a.x + b.x) / 2 - 50, (a.y + b.y) / 2 - 50);
        assert_true(r > 50 - 1e-4 && r <= 50 + 1e-6);
    }
    csg_outline_release(&outline);
    assert_in_range(few, 12, 64);
    assert_true(many > 10 * few);
}

static void test_transforms(void **state)
{
    (void)state;
    read_svg(&plain, page,
             "<g transform='translate(10,20) rotate(90)'><rect x='1' y='1' width='5' height='6' "
             "transform='skewX(45) scale(2,1)'/></g>");
    expect(3, 61, 9, 77, 60); /* OpenSCAD: box */
    read_svg(&plain, "",
             "<rect width='2' height='1' transform='matrix(0 1 -1 0 5 0), rotate(90 0 0)"
             " scale(2) skewY(0) translate(1)'/>");
    expect(-1, 0, 3, 2, 8);
    read_svg(&plain, "", "<rect width='2' height='1' transform='rotate(180,1,1)'/>");
    expect(0, -2, 2, -1, 2);
    read_svg(&plain, "", "<rect width='2' height='1' transform='spin(180)'/>");
    assert_int_equal(report.broken, 1);
    expect(0, -1, 2, 0, 2);
    read_svg(&plain, "", "<rect width='2' height='1' transform='scale(0)'/>");
    expect_nothing();
}

static void test_fill_rules(void **state)
{
    (void)state;
    read_svg(&plain, page, "<path fill-rule='evenodd' d='M0 0H10V10H0Z M2 2 H8 V8 H2Z'/>");
    expect(0, 90, 10, 100, 64); /* OpenSCAD, with either rule */
    read_svg(&plain, page, "<path d='M0 0H10V10H0Z M2 2 H8 V8 H2Z'/>");
    expect(0, 90, 10, 100, 100);
    read_svg(&plain, page, "<path d='M0 0H10V10H0Z M2 2 V8 H8 V2Z'/>");
    expect(0, 90, 10, 100, 64);
    read_svg(&plain, page,
             "<g style='fill : red; fill-rule : evenodd'><path d='M0 0H10V10H0ZM2 2H8V8H2Z'/></g>");
    expect(0, 90, 10, 100, 64);
    read_svg(&plain, page, "<path d='M0 0H10V10H0Z'/><path d='M2 2 V8 H8 V2Z'/>");
    expect(0, 90, 10, 100, 100); /* OpenSCAD */
}

static void test_use(void **state)
{
    (void)state;
    read_svg(&plain, page,
             "<defs><rect id='a' x='10' y='10' width='5' height='6'/></defs>"
             "<use xlink:href='#a' x='20' y='1'/>");
    expect(30, 83, 35, 89, 30);
    read_svg(&plain, page,
             "<rect id='a' x='10' y='10' width='5' height='6'/>"
             "<use href='#a' x='20' y='1' transform='scale(2)'/>");
    expect(10, 66, 70, 90, 150);
    read_svg(&plain, page,
             "<symbol id='a' viewBox='0 0 10 10'><rect x='1' y='1' width='5' height='6'/></symbol>"
             "<use href='#a' x='20' y='1' width='20' height='20'/>");
    expect(22, 85, 32, 97, 120);
    read_svg(&plain, page,
             "<svg x='10' y='10' width='50' height='50' viewBox='0 0 10 10'>"
             "<rect x='1' y='1' width='5' height='6'/></svg>");
    expect(15, 55, 40, 85, 750);
    read_svg(&plain, page, "<use href='#b'/><use href='other.svg#a'/><use/>");
    assert_int_equal(report.unresolved, 3);
    expect_nothing();
}

static void test_use_of_itself(void **state)
{
    (void)state;
    read_svg(&plain, page, "<g id='a'><rect width='5' height='6'/><use href='#a' x='10'/></g>");
    assert_int_equal(report.unresolved, 1);
    csg_outline_release(&outline);
}

/* Ten uses of ten uses of ... */
static void test_use_bomb(void **state)
{
    static char text[20000];
    size_t n = 0;
    (void)state;
    n += (size_t)sprintf(text + n, "<svg><g id='g0'><rect width='1' height='1'/></g>");
    for (int i = 1; i < 12; i++) {
        n += (size_t)sprintf(text + n, "<g id='g%d'>", i);
        for (int k = 0; k < 10; k++)
            n += (size_t)sprintf(text + n, "<use href='#g%d'/>", i - 1);
        n += (size_t)sprintf(text + n, "</g>");
    }
    n += (size_t)sprintf(text + n, "</svg>");
    assert_int_equal(read_with(&plain, text, n), CSGM_ERR_LIMIT);
    assert_int_not_equal(strlen(report.problem.text), 0);
    assert_int_equal(outline.point_count, 0);
}

static void test_hidden(void **state)
{
    (void)state;
    read_svg(&plain, page, "<rect width='5' height='6' display='none'/>");
    expect_nothing();
    read_svg(&plain, page, "<g style='fill:red; display : none;'><rect width='5' height='6'/></g>");
    expect_nothing();
    read_svg(&plain, page,
             "<text>x</text><image/><style>a{}</style><wurst/><foo:bar xmlns:foo='x'/>"
             "<clipPath id='c'><rect width='9' height='9'/></clipPath>"
             "<rect width='5' height='6' clip-path='url(#c)'/>");
    assert_int_equal(report.texts, 1);
    assert_int_equal(report.images, 1);
    assert_int_equal(report.sheets, 1);
    assert_int_equal(report.unknown, 1);
    assert_int_equal(report.clips, 1);
    assert_int_equal(report.shapes, 1);
    expect(0, 94, 5, 100, 30);
}

static void test_choice(void **state)
{
    static const char layers[] =
        "<g inkscape:groupmode='layer' inkscape:label='L1' id='g1'>"
        "<rect x='1' y='1' width='5' height='6'/></g>"
        "<g inkscape:groupmode='layer' inkscape:label='L2' id='g2'>"
        "<rect x='11' y='1' width='5' height='6'/><rect id='r' x='21' width='1' height='1'/></g>";
    (void)state;
    csg_svg_request by_layer = {.layer = "L1"}, by_name = {.layer = "g2"}, by_id = {.id = "r"},
                    none = {.id = "nobody"};
    read_svg(&by_layer, page, layers);
    assert_false(report.not_found);
    expect(1, 93, 6, 99, 30);
    read_svg(&by_name, page, layers);
    expect(11, 93, 22, 100, 31);
    read_svg(&by_id, page, layers);
    expect(21, 99, 22, 100, 1);
    read_svg(&none, page, layers);
    assert_true(report.not_found);
    expect_nothing();
}

static void expect_refused(const char *text, csgm_status expected)
{
    assert_int_equal(read_with(&plain, text, strlen(text)), expected);
    assert_int_not_equal(strlen(report.problem.text), 0);
    assert_int_equal(outline.point_count, 0);
}

static void test_refused(void **state)
{
    (void)state;
    expect_refused("", CSGM_ERR_FORMAT);
    expect_refused("<svg", CSGM_ERR_FORMAT);
    expect_refused("<svg><g></svg>", CSGM_ERR_FORMAT);
    expect_refused("<html/>", CSGM_ERR_FORMAT);
    expect_refused("PK\3\4", CSGM_ERR_FORMAT);
    /* entities of entities */
    static char bomb[4096];
    int n =
        sprintf(bomb, "<!DOCTYPE svg [<!ENTITY a0 'aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa'>");
    for (int i = 1; i < 12; i++)
        n += sprintf(bomb + n, "<!ENTITY a%d '&a%d;&a%d;&a%d;&a%d;&a%d;&a%d;&a%d;&a%d;'>", i, i - 1,
                     i - 1, i - 1, i - 1, i - 1, i - 1, i - 1, i - 1);
    sprintf(bomb + n, "]><svg><text>&a11;</text></svg>");
    csgm_status status = read_with(&plain, bomb, strlen(bomb));
    assert_true(status == CSGM_ERR_FORMAT || status == CSGM_ERR_LIMIT);
    /* a file of this machine */
    static const char outside[] = "<!DOCTYPE svg [<!ENTITY e SYSTEM 'file:///etc/passwd'>]>"
                                  "<svg><path d='&e;'/></svg>";
    expect_refused(outside, CSGM_ERR_FORMAT);
}

static void test_deep(void **state)
{
    static char text[1 << 16];
    (void)state;
    size_t n = (size_t)sprintf(text, "<svg>");
    for (int i = 0; i < 10000; i++)
        n += (size_t)sprintf(text + n, "<g>");
    expect_refused(text, CSGM_ERR_LIMIT);
}

static const char sample[] =
    "<?xml version='1.0'?><svg xmlns='http://www.w3.org/2000/svg' width='50mm' height='40mm' "
    "viewBox='0 0 50 40'><defs><g id='k'><circle r='3'/></g></defs>"
    "<path style='fill:none;stroke-width:2;stroke-linecap:round' d='M1 1C2 5 3 5 4 1S5 5 6 6'/>"
    "<use href='#k' x='20' y='20'/><rect rx='1' width='9' height='4' transform='rotate(20)'/>"
    "<path fill-rule='evenodd' d='M10 10h20v20h-20zM12 12A3 4 20 1 1 15 18Q4 4 5 6T8 8z'/></svg>";

static csgm_status read_sample(const char *text, size_t length)
{
    csg_svg_request options = {.tolerance = 0.05};
    csgm_status status = read_with(&options, text, length);
    csg_outline_release(&outline);
    return status;
}

static void read_damaged(const char *text, size_t length)
{
    csgm_status status = read_sample(text, length);
    assert_true(status == CSGM_OK || status == CSGM_ERR_FORMAT || status == CSGM_ERR_LIMIT);
    assert_true(status == CSGM_OK || report.problem.text[0]);
}

static void test_damage(void **state)
{
    (void)state;
    support_damage(sample, strlen(sample), 2000, read_damaged);
    support_starve(sample, strlen(sample), read_sample);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define TEST(name) cmocka_unit_test_setup_teardown(name, support_setup, support_teardown)
        TEST(test_page),          TEST(test_view_box_corner),  TEST(test_center),
        TEST(test_strokes),       TEST(test_filled_open_path), TEST(test_shapes),
        TEST(test_paths),         TEST(test_broken_paths),     TEST(test_tolerance),
        TEST(test_transforms),    TEST(test_fill_rules),       TEST(test_use),
        TEST(test_use_of_itself), TEST(test_use_bomb),         TEST(test_hidden),
        TEST(test_choice),        TEST(test_refused),          TEST(test_deep),
        TEST(test_damage),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
