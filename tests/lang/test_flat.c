/* SPDX-License-Identifier: MIT
 * Flat scenes: layers of their drawing, what is refused, and memory that runs out.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "lang/bench_failing.h"
#include "lang/bench_fixture.h"
#include "shape/plane/drawing.h"

static csgm_scene_options by(csgm_flat flat)
{
    return (csgm_scene_options){.struct_size = sizeof(csgm_scene_options), .flat = flat};
}

static csgm_status draw(const char *scene, csgm_flat flat)
{
    const csgm_scene_options options = by(flat);
    return bench_compile_bytes(&b, scene, strlen(scene), &options);
}

static double area_of(const csg_outline *outline)
{
    double sum = 0;
    for (size_t loop = 0; loop < outline->loop_count; loop++) {
        size_t first = csg_outline_first(outline, loop), end = outline->ends[loop];
        for (size_t i = first; i < end; i++) {
            csg_vec2 p = outline->points[i], q = outline->points[i + 1 < end ? i + 1 : first];
            sum += (p.x * q.y - p.y * q.x) / 2;
        }
    }
    return sum;
}

static void check_layer(size_t index, const char *name, bool has_color, double area)
{
    const csg_drawn_layer *layer = &b.scene->drawing->layers[index];
    assert_int_equal(layer->has_color, has_color);
    if (name)
        assert_string_equal(layer->name, name);
    else
        assert_null(layer->name);
    if (fabs(area_of(&layer->outline) - area) > 1e-3 * area)
        fail_msg("layer %zu: area %g, not %g", index, area_of(&layer->outline), area);
}

static void layers_are_parts_and_colours(void **state)
{
    (void)state;
    assert_int_equal(draw("color(\"red\") square(10); part(\"a\") { circle(5); color(\"red\")"
                          " square(2); } color(\"red\") translate([5, 0]) square(10);"
                          " mirror([1, 0]) scale([2, 1]) difference() { square(6); translate([1, "
                          "1]) square(2); }",
                          CSGM_FLAT_DRAWING),
                     CSGM_OK);
    assert_int_equal(b.code_count, 0);
    assert_int_equal(b.scene->drawing->count, 4);
    check_layer(0, NULL, true, 150);
    check_layer(1, "a", false, 25 * acos(-1));
    check_layer(2, "a", true, 4);
    check_layer(3, NULL, false, 64);
    assert_int_equal(draw("color(\"red\") color(\"blue\") square(1);", CSGM_FLAT_DRAWING), CSGM_OK);
    assert_true(b.scene->drawing->layers[0].color[0] == 1); /* the outer one holds */
    assert_int_equal(draw("difference() { square(2); square(3); }", CSGM_FLAT_DRAWING), CSGM_OK);
    assert_int_equal(b.scene->drawing->count, 0);
}

static void plates_and_drawings(void **state)
{
    (void)state;
    assert_int_equal(draw("square(1);", CSGM_FLAT_PLATE), CSGM_OK);
    assert_null(b.scene->drawing);
    assert_true(bench_has(&b, -322));
    assert_int_equal(draw("square(1);", CSGM_FLAT_BOTH), CSGM_OK);
    assert_int_equal(b.scene->drawing->count, 1);
    assert_true(bench_has(&b, -322));
    assert_int_equal(draw("square(1);", CSGM_FLAT_DRAWING), CSGM_OK);
    assert_int_equal(b.code_count, 0);
    assert_int_equal(draw("cube(1); square(1); sphere(1);", CSGM_FLAT_DRAWING), CSGM_OK);
    assert_non_null(strstr(b.text, "2 solids are left out"));
    assert_int_equal(draw("cube(1); !square(1);", CSGM_FLAT_DRAWING), CSGM_OK);
    assert_int_equal(b.scene->drawing->count, 1);
    assert_int_equal(draw("cube(1);", CSGM_FLAT_DRAWING), CSGM_ERR_SCENE);
    assert_true(bench_has(&b, 337));
    assert_int_equal(draw("cube(1); square(1);", CSGM_FLAT_BOTH), CSGM_ERR_SCENE);
    assert_true(bench_has(&b, 337));
    assert_int_equal(draw("projection(cut = true) plane([1, 0, 0], 0);", CSGM_FLAT_DRAWING),
                     CSGM_ERR_SCENE);
    assert_non_null(strstr(b.text, "no bounds"));
}

static csgm_status draw_flat_scene(bench *poor)
{
    static const char scene[] = "color(\"red\") square(10); part(\"a\") mirror([1, 1]) circle(5);"
                                " union(blend = 1) { square(3); circle(2); }";
    const csgm_scene_options options = by(CSGM_FLAT_DRAWING);
    return bench_compile_bytes(poor, scene, strlen(scene), &options);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    assert_true(bench_fail_every(draw_flat_scene, 300, 40) > 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_are_parts_and_colours),
        cmocka_unit_test(plates_and_drawings),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, open_bench, close_bench);
}
