/* SPDX-License-Identifier: MIT
 * Layers by the C interface: each allocation fails once, and nothing is left or lost; options of
 * older versions and out of range.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka wants the four above first */
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "csgmesh/slicing.h"
#include "failing.h"

static const char TEXT[] = "difference() { cube(2, center = true); sphere(0.5); }\n";

static csgm_status open_field(csgm_context_options options, csgm_context **context,
                              csgm_scene **scene, csgm_field **field)
{
    *context = NULL;
    *scene = NULL;
    *field = NULL;
    options.threads = 1;
    csgm_status status = csgm_context_create(&options, context);
    if (status == CSGM_OK)
        status = csgm_scene_parse(*context, TEXT, strlen(TEXT), "test", NULL, scene);
    return status == CSGM_OK ? csgm_field_compile(*context, *scene, field) : status;
}

static void close_field(csgm_context *context, csgm_scene *scene, csgm_field *field)
{
    csgm_field_destroy(field);
    csgm_scene_destroy(scene);
    csgm_context_destroy(context);
}

static void any_allocation_may_fail(csgm_layers_format format, double most_height)
{
    static const char path[] = "slice-failures.tmp";
    bool done = false;
    int refused = 0;
    for (long n = 0; !done; n++) {
        failing f = {.left = n};
        csgm_context_options options = csgm_context_options_default();
        options.allocator = (csgm_allocator){failing_alloc, failing_release, &f};
        csgm_context *context;
        csgm_scene *scene;
        csgm_field *field;
        if (open_field(options, &context, &scene, &field) == CSGM_OK) {
            csgm_slice_options slice = csgm_slice_options_default();
            csgm_slice_stats stats = csgm_slice_stats_default();
            slice.height = 0.5;
            slice.most_height = most_height;
            slice.cusp = most_height / 2;
            slice.tolerance = 0.02;
            slice.sync = false;
            csgm_status status = csgm_slice_field(context, field, path, format, &slice, &stats);
            done = status == CSGM_OK;
            refused += !done;
            assert_true(done || status == CSGM_ERR_MEMORY);
            assert_true(done ? stats.layers > 1 && stats.layers <= 4 : !stats.layers);
            assert_int_equal(access(path, F_OK) == 0, done);
        }
        close_field(context, scene, field);
        assert_int_equal(f.live, 0);
    }
    remove(path);
    assert_true(refused > 10);
}

static void of_svg(void **state)
{
    any_allocation_may_fail(CSGM_LAYERS_SVG, 0);
}

static void of_heights(void **state)
{
    any_allocation_may_fail(CSGM_LAYERS_CLI, 0.8);
}

static void of_masks(void **state)
{
    if (csgm_layers_format_available(CSGM_LAYERS_ZIP))
        any_allocation_may_fail(CSGM_LAYERS_ZIP, 0);
}

static void of_3mf(void **state)
{
    if (csgm_layers_format_available(CSGM_LAYERS_3MF))
        any_allocation_may_fail(CSGM_LAYERS_3MF, 0);
}

static void options_out_of_range(void **state)
{
    csgm_context *context;
    csgm_scene *scene;
    csgm_field *field;
    assert_int_equal(open_field(csgm_context_options_default(), &context, &scene, &field), CSGM_OK);
    for (int i = 0; i < 13; i++) {
        csgm_slice_options o = csgm_slice_options_default();
        csgm_layers_format format = CSGM_LAYERS_SVG;
        o.height = i == 0 ? 0 : i == 1 ? -1 : i == 2 ? (double)NAN : 1;
        o.tolerance = i == 3 ? -1 : 0;
        o.pixel = i == 4 ? 0 : 1;
        o.unit = i == 5 ? (csgm_unit)77 : CSGM_UNIT_MM;
        format = i == 6 ? CSGM_LAYERS_NONE : i == 7 ? CSGM_LAYERS_COUNT : format;
        o.most_height = i == 8 ? 0.5 : i == 9 ? (double)INFINITY : i == 10 ? -1 : i == 11 ? 2 : 0;
        o.cusp = i == 8 || i == 9 || i == 12 ? 0.1 : 0;
        assert_int_equal(csgm_slice_field(context, field, "/dev/null", format, &o, NULL),
                         CSGM_ERR_ARGUMENT);
    }
    csgm_slice_options o = csgm_slice_options_default();
    o.height = 1;
    o.part = "none";
    assert_int_equal(csgm_slice_field(context, field, "/dev/null", CSGM_LAYERS_CLI, &o, NULL),
                     CSGM_ERR_ARGUMENT);
    o.part = NULL;
    assert_int_equal(csgm_slice_field(context, field, "/dev/null", CSGM_LAYERS_CLI, &o, NULL),
                     CSGM_OK);
    close_field(context, scene, field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(of_svg),
        cmocka_unit_test(of_heights),
        cmocka_unit_test(of_masks),
        cmocka_unit_test(of_3mf),
        cmocka_unit_test(options_out_of_range),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
