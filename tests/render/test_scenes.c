/* SPDX-License-Identifier: MIT
 * Pictures of fields: silhouettes against closed forms, what is in front and of which colour,
 * shadows, sections, and the same bytes for any threads, instruction set and evaluator.
 */
#include "render_support.h"

static const char blended[] = "difference(blend = 0.1) {\n"
                              "  union(blend = 0.3) { sphere(r = 1);\n"
                              "    translate([0.8, 0, 0]) color(\"red\") cube(0.9); }\n"
                              "  cylinder(r = 0.3, h = 4, center = true); }\n";

static void test_silhouettes(void **state)
{
    render_case c;
    render_begin(&c, 2, CSGM_ISA_AUTO, "translate([5, -3, 2]) sphere(r = 1);");
    csgm_render_options options = front_options(256, 4);
    options.frame = (csgm_box){{3, -5, 0}, {7, -1, 4}};
    double pixel = 4.0 / 256;
    for (uint32_t samples = 1; samples <= 8; samples *= 2) {
        options.samples = samples;
        render_scene(&c, &options);
        double area = covered(&c) * pixel * pixel / 3.14159265358979;
        assert_true(fabs(area - 1) < (samples == 1 ? 0.004 : 0.0015));
    }
    options.camera.projection = CSGM_PERSPECTIVE;
    options.camera.height = 0;
    options.camera.placed = true;
    options.camera.eye = (csgm_vec3){5, -9, 2};
    options.camera.target = (csgm_vec3){5, -3, 2};
    options.camera.fov_deg = 40;
    render_scene(&c, &options);
    double radius = 1 / sqrt(36 - 1.0) / tan(20 * 3.14159265358979 / 180) * 128;
    assert_true(fabs(sqrt(covered(&c) / 3.14159265358979) / radius - 1) < 0.001);
    render_end(&c);
}

/* A fold of interior unions has a proven slope that is hundreds of times the real one: the picture
 * is still that of the ball around all the others. */
static void test_loose_bound(void **state)
{
    render_case c, ball;
    render_begin(&ball, 1, CSGM_ISA_AUTO, "sphere(r = 1);");
    csgm_render_options options = front_options(128, 3);
    options.shadows = true;
    render_scene(&ball, &options);
    render_begin(&c, 1, CSGM_ISA_AUTO,
                 "union(blend = interior(eps = 0.001))\n"
                 "  for (i = [0 : 30]) sphere(r = 1 - 0.005 * i);\n");
    assert_true(csgm_scene_get_info(c.scene).lipschitz > 100);
    render_scene(&c, &options);
    assert_true(fabs(covered(&c) / covered(&ball) - 1) <
                0.004); /* a 25th of a pixel around is 0.002 */
    int differ = 0;
    for (uint32_t y = 0; y < 128; y++)
        for (uint32_t x = 0; x < 128; x++)
            differ += abs(pixel_at(&c, x, y)[0] - pixel_at(&ball, x, y)[0]) > 16;
    assert_true(differ < 60);
    render_end(&ball);
    render_end(&c);
}

/* The lazy evaluator sees the same ball there: where f / lambda is small the surface may be far. */
static void test_loose_bound_lazily(void **state)
{
    render_case c;
    render_begin(&c, 2, CSGM_ISA_AUTO,
                 "union(blend = interior(eps = 0.001))\n"
                 "  for (i = [0 : 30]) sphere(r = 1 - 0.005 * i);\n");
    assert_true(csgm_scene_get_info(c.scene).lipschitz > 100);
    csgm_render_options options = front_options(48, 3);
    options.samples = 1;
    options.occlusion = options.shadows = false;
    render_scene(&c, &options);
    double exact = covered(&c);
    options.evaluator = CSGM_EVALUATOR_LAZY;
    render_scene(&c, &options);
    assert_true(fabs(covered(&c) / exact - 1) < 0.01);
    render_end(&c);
}

static void test_front_hides_back(void **state)
{
    static const char text[] =
        "color(\"red\") translate([0, -1, 0]) cube([1, 0.2, 1], center = true);\n"
        "color(\"blue\") translate([0, 1, 0]) cube([2, 0.2, 2], center = true);\n";
    render_case c;
    render_begin(&c, 1, CSGM_ISA_AUTO, text);
    csgm_render_options options = front_options(100, 4);
    render_scene(&c, &options);
    const uint8_t *middle = pixel_at(&c, 50, 50);
    assert_true(middle[0] > 100 && middle[2] < 60 && middle[3] == 255);
    const uint8_t *beside = pixel_at(&c, 50, 30);
    assert_true(beside[2] > 100 && beside[0] < 60 && beside[3] == 255);
    assert_int_equal(pixel_at(&c, 50, 10)[3], 0);
    options.camera.azimuth_deg = 180;
    render_scene(&c, &options);
    assert_true(pixel_at(&c, 50, 50)[2] > 100 && pixel_at(&c, 50, 50)[0] < 60);
    /* seen from above, with y upwards: red is below blue */
    options.camera.azimuth_deg = 0;
    options.camera.elevation_deg = 90;
    render_scene(&c, &options);
    assert_true(pixel_at(&c, 50, 75)[0] > 100 && pixel_at(&c, 50, 25)[2] > 100);
    render_end(&c);
}

static void test_bounds_cut(void **state)
{
    render_case c;
    render_begin(&c, 1, CSGM_ISA_AUTO, "sphere(r = 1);");
    csgm_render_options options = front_options(128, 4);
    options.bounds = (csgm_box){{0, -2, -2}, {2, 2, 2}};
    render_scene(&c, &options);
    double area = covered(&c) * (4.0 / 128) * (4.0 / 128);
    assert_true(fabs(area - 3.14159265358979 / 2) < 0.01);
    render_end(&c);
}

/* A ball over a plate: its shadow, and where it touches, its occlusion. */
static void test_light(void **state)
{
    static const char text[] =
        "translate([0, 0, -1.1]) cube([8, 8, 0.2], center = true); sphere(r = 1);";
    render_case c;
    csgm_image *plain = NULL;
    render_begin(&c, 2, CSGM_ISA_AUTO, text);
    csgm_render_options options = front_options(160, 8);
    options.camera.elevation_deg = 60;
    render_scene(&c, &options);
    plain = c.image;
    c.image = NULL;
    options.shadows = true;
    render_scene(&c, &options);
    csgm_image_view a = csgm_image_get_view(plain), b = csgm_image_get_view(c.image);
    uint64_t darker = 0, brighter = 0;
    for (size_t i = 0; i < (size_t)160 * 160; i++) {
        darker += b.pixels[4 * i] + 20 < a.pixels[4 * i];
        brighter += b.pixels[4 * i] > a.pixels[4 * i] + 12;
    }
    assert_true(darker > 600 && darker < 6000);
    assert_true(brighter < 60); /* edges only */
    assert_true(c.stats.shadow_rays > 1000);
    options.shadows = false;
    options.occlusion = true;
    render_scene(&c, &options);
    b = csgm_image_get_view(c.image);
    /* the open plate stays as it was */
    size_t open = 4 * (size_t)(130 * 160 + 20);
    assert_true(abs(a.pixels[open] - b.pixels[open]) <= 1);
    uint64_t closed = 0;
    for (size_t i = 0; i < (size_t)160 * 160; i++)
        closed += b.pixels[4 * i] + 6 < a.pixels[4 * i];
    assert_true(closed > 100 && closed < 4000);
    csgm_image_destroy(plain);
    render_end(&c);
}

static void test_same_bytes(void **state)
{
    static const csgm_isa isas[] = {CSGM_ISA_SCALAR, CSGM_ISA_SSE2, CSGM_ISA_AVX2, CSGM_ISA_AVX512,
                                    CSGM_ISA_AUTO};
    csgm_render_options options = csgm_render_options_default();
    options.width = 200;
    options.height = 150;
    render_case first, c;
    render_begin(&first, 1, CSGM_ISA_AUTO, blended);
    render_scene(&first, &options);
    for (size_t i = 0; i < sizeof isas / sizeof *isas; i++) {
        render_begin(&c, (uint32_t)(1 + i % 4), isas[i], blended);
        render_scene(&c, &options);
        assert_same_image(first.image, c.image, csgm_context_isa(c.context));
        assert_int_equal(first.stats.point_evaluations, c.stats.point_evaluations);
        assert_int_equal(first.stats.primitive_evaluations, c.stats.primitive_evaluations);
        render_end(&c);
    }
    render_end(&first);
}

/* Pruned floats and the plain double evaluation see the same surface. */
static void test_evaluators_agree(void **state)
{
    render_case c;
    render_begin(&c, 2, CSGM_ISA_AUTO, blended);
    csgm_render_options options = csgm_render_options_default();
    options.width = options.height = 120;
    options.samples = 1;
    options.occlusion = options.shadows = false;
    memset(options.background, 0, sizeof options.background);
    options.frame = (csgm_box){{-1.2, -1.2, -1.2}, {2, 1.2, 1.2}};
    render_scene(&c, &options);
    csgm_image *fast = c.image;
    c.image = NULL;
    options.evaluator = CSGM_EVALUATOR_LAZY;
    uint64_t totals[3];
    csgm_image *images[3];
    for (int i = 0; i < 3; i++) {
        options.lazy = i < 1;
        options.bounds_used = i < 2;
        render_scene(&c, &options);
        totals[i] = c.stats.total_evaluations;
        images[i] = c.image;
        c.image = NULL;
    }
    csgm_image_view a = csgm_image_get_view(fast), b = csgm_image_get_view(images[0]);
    int differ = 0;
    for (size_t i = 0; i < (size_t)120 * 120; i++)
        differ += a.pixels[4 * i + 3] != b.pixels[4 * i + 3];
    assert_true(differ <= 8);
    assert_same_image(images[0], images[1], "lazy and not");
    assert_true(totals[0] < totals[1]);
    assert_true(c.stats.top_level_evaluations > 120 * 120);
    csgm_image_destroy(fast);
    for (int i = 0; i < 3; i++)
        csgm_image_destroy(images[i]);
    render_end(&c);
}

/* Many small things: deep cells, halved reach, most of the tape dropped. */
static void test_many_solids(void **state)
{
    static const char text[] = "for (i = [0 : 11]) for (j = [0 : 11]) for (k = [0 : 11])\n"
                               "  translate([i, j, k]) sphere(r = 0.3);\n";
    render_case c;
    render_begin(&c, 2, CSGM_ISA_AUTO, text);
    csgm_render_options options = front_options(240, 12);
    options.frame = (csgm_box){{-0.5, -0.5, -0.5}, {11.5, 11.5, 11.5}};
    render_scene(&c, &options);
    double area = covered(&c) * (12.0 / 240) * (12.0 / 240);
    assert_true(fabs(area / (144 * 3.14159265358979 * 0.09) - 1) < 0.02);
    double per_hit = (double)c.stats.primitive_evaluations / (double)c.stats.rays;
    assert_true(per_hit < 200); /* 1728 of them for each step otherwise */
    render_end(&c);
}

static void test_section(void **state)
{
    render_case c;
    render_begin(&c, 2, CSGM_ISA_AUTO, "sphere(r = 1);");
    csgm_render_options options = front_options(256, 4);
    options.slice_axis = 2;
    options.slice_at = 0.6; /* a circle of 0.8 */
    options.camera.height = 4;
    options.camera.zoom = 1;
    options.iso_step = 100; /* no lines */
    render_scene(&c, &options);
    csgm_image_view view = csgm_image_get_view(c.image);
    uint64_t warm = 0, dark = 0;
    double pixel = 4 / 0.8 / 256; /* a section shows more around */
    for (size_t i = 0; i < (size_t)256 * 256; i++) {
        const uint8_t *p = view.pixels + 4 * i;
        assert_int_equal(p[3], 255);
        dark += p[0] < 60 && p[2] < 60;
        warm += p[0] > p[2];
    }
    double area = ((double)warm + (double)dark / 2) * pixel * pixel;
    assert_true(fabs(area - 3.14159265358979 * 0.64) < 0.12);
    assert_true(dark > 150 && dark < 800);
    render_end(&c);
}

static void test_nothing_in_sight(void **state)
{
    render_case c;
    render_begin(&c, 1, CSGM_ISA_AUTO, "sphere(r = 1);");
    csgm_render_options options = front_options(32, 4);
    options.camera.placed = true;
    options.camera.eye = (csgm_vec3){0, 0, 10};
    options.camera.target = (csgm_vec3){0, 0, 20};
    options.camera.up = (csgm_vec3){0, 1, 0};
    options.camera.projection = CSGM_PERSPECTIVE;
    options.background[1] = 77;
    options.background[3] = 255;
    render_scene(&c, &options);
    assert_int_equal(c.warnings, 1);
    assert_int_equal(pixel_at(&c, 16, 16)[1], 77);
    render_end(&c);
}

/* Far from soft objects the field is constant, and tells no distance: light falls on them as on
 * solids, but for the soft edges of shadows. */
static void test_light_on_soft_objects(void **state)
{
    static const char *const scenes[2] = {
        "union() { translate([0, 0, 3]) sphere(2); translate([0, 0, -1]) cube([14, 14, 2], center "
        "= "
        "true); translate([4, 0, 7]) sphere(1.5); }",
        "union() { soft(range = 0.3) translate([0, 0, 3]) sphere(2); soft(range = 0.3) "
        "translate([0, "
        "0, -1]) cube([14, 14, 2], center = true); translate([4, 0, 7]) sphere(1.5); }"};
    render_case c[2];
    csgm_render_options options = front_options(128, 18);
    options.camera.elevation_deg = 30;
    options.shadows = options.occlusion = true;
    options.frame = (csgm_box){{-8, -8, -3}, {8, 8, 9}};
    for (int i = 0; i < 2; i++) {
        render_begin(&c[i], 1, CSGM_ISA_AUTO, scenes[i]);
        render_scene(&c[i], &options);
    }
    int differ = 0, shown = (int)covered(&c[0]);
    for (uint32_t y = 0; y < 128; y++)
        for (uint32_t x = 0; x < 128; x++)
            differ += abs(pixel_at(&c[0], x, y)[0] - pixel_at(&c[1], x, y)[0]) > 16;
    assert_true(shown > 4000);
    if (differ > shown / 12)
        fail_msg("%d of %d pixels differ", differ, shown);
    render_end(&c[0]);
    render_end(&c[1]);
}

static bool is_reddish(const uint8_t *p)
{
    return p[3] == 255 && p[0] > p[1] + 40 && p[0] > p[2] + 40;
}

static bool is_gray(const uint8_t *p)
{
    return p[0] == p[1] && p[1] == p[2];
}

/* # over the solid and through it, % before it and before nothing; what is behind is hidden. */
static void test_marks(void **state)
{
    static const char plain[] = "translate([-2, 0, 0]) cube(2, center = true);";
    static const char marked[] =
        "translate([-2, 0, 0]) cube(2, center = true);\n"
        "translate([-2, 0, 0]) intersection() { #sphere(1.2); plane([0, 1, 0], -1.1); }\n"
        "%translate([2, 0, 0]) cube(2, center = true);\n"
        "%translate([-2, 9, 0]) cube(1, center = true);\n";
    render_case c, without;
    csgm_render_options options = front_options(96, 6);
    options.frame = (csgm_box){{-3, -3, -3}, {3, 3, 3}};
    render_begin(&without, 1, CSGM_ISA_AUTO, plain);
    render_begin(&c, 2, CSGM_ISA_AUTO, marked);
    render_scene(&without, &options);
    render_scene(&c, &options);
    assert_true(is_reddish(pixel_at(&c, 16, 48)));
    const uint8_t *corner = pixel_at(&c, 4, 35), *same = pixel_at(&without, 4, 35);
    assert_memory_equal(corner, same, 4);
    assert_true(is_gray(pixel_at(&c, 80, 48)));
    assert_int_equal(pixel_at(&c, 80, 48)[3], 128);
    assert_int_equal(pixel_at(&c, 48, 48)[3], 0);
    assert_true(fabs(covered(&c) - covered(&without) - 0.5 * 32 * 32) < 96);
    options.camera.azimuth_deg = 180; /* from the back the small % is before the solid */
    render_scene(&c, &options);
    render_scene(&without, &options);
    assert_true(memcmp(pixel_at(&c, 80, 48), pixel_at(&without, 80, 48), 4) != 0);
    assert_true(is_gray(pixel_at(&c, 16, 48)));
    render_end(&c);
    render_end(&without);
}

/* Nothing but what is marked has a picture too, a section shows none of it; what is infinite ends
 * where the solid does. */
static void test_marks_alone(void **state)
{
    render_case c;
    csgm_render_options options = front_options(64, 4);
    render_begin(&c, 1, CSGM_ISA_AUTO, "%sphere(r = 1);");
    render_scene(&c, &options);
    assert_true(covered(&c) > 0);
    options.slice_axis = 1;
    render_scene(&c, &options);
    assert_int_equal(c.warnings, 1); /* of the scene alone */
    render_end(&c);
    render_begin(&c, 1, CSGM_ISA_AUTO, "cube(2, center = true); %plane([0, 0, -1], 0);");
    options.slice_axis = -1;
    render_scene(&c, &options);
    assert_true(fabs(covered(&c) - 32 * 32) < 1);
    render_end(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_silhouettes),
        cmocka_unit_test(test_loose_bound),
        cmocka_unit_test(test_loose_bound_lazily),
        cmocka_unit_test(test_front_hides_back),
        cmocka_unit_test(test_bounds_cut),
        cmocka_unit_test(test_light),
        cmocka_unit_test(test_same_bytes),
        cmocka_unit_test(test_evaluators_agree),
        cmocka_unit_test(test_many_solids),
        cmocka_unit_test(test_section),
        cmocka_unit_test(test_nothing_in_sight),
        cmocka_unit_test(test_light_on_soft_objects),
        cmocka_unit_test(test_marks),
        cmocka_unit_test(test_marks_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
