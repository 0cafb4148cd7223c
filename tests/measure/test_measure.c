/* SPDX-License-Identifier: MIT
 * Measures by the C interface: what is proven when an allocation is refused, time is up or cubes
 * are; options of older versions; parts; closed forms are in tests/cli/test_measure.py.
 */
#include "measure/solid.h"

#include <math.h>

static const char TEXT[] = "difference() { cube(2, center = true); sphere(0.5); }\n";
static const double VOLUME = 8 - 0.52359877559829887, DENSITY = 3;

static csgm_measure_options options_to(double tolerance)
{
    csgm_measure_options options = csgm_measure_options_default();
    options.tolerance = tolerance;
    options.density = DENSITY;
    return options;
}

static void assert_true_measures(const csgm_measures *m)
{
    const double moment = (8 * 8.0 / 12 - 0.52359877559829887 * 0.1) * DENSITY;
    assert_holds(m->volume, VOLUME);
    assert_holds(m->mass, VOLUME * DENSITY);
    for (int k = 0; k < 3; k++) {
        assert_holds(m->centroid[k], 0);
        assert_holds(m->inertia[k], moment);
        assert_holds(m->inertia[3 + k], 0);
        assert_holds(m->bounds[k], -1);
        assert_holds(m->bounds[3 + k], 1);
    }
}

static void check_refused(const csgm_measures *m, bool done)
{
    assert_int_equal(m->is_reached, done);
    assert_true_measures(m);
}

static void test_any_allocation_may_fail(void **state)
{
    assert_true(measure_with_refusals(TEXT, options_to(0.05), check_refused) > 10);
}

static void test_limits(void **state)
{
    solid s;
    csgm_context_options options = csgm_context_options_default();
    csgm_measure_options measure = options_to(1e-9);
    csgm_measures m = csgm_measures_default();
    measure.most_cubes = 10000;
    assert_int_equal(open_solid(&s, options, TEXT), CSGM_OK);
    assert_int_equal(csgm_measure_field(s.context, s.field, &measure, &m), CSGM_OK);
    assert_false(m.is_reached);
    assert_true(m.cubes > 0);
    assert_true_measures(&m);
    assert_true(m.volume.high - m.volume.low < 0.1);
    close_solid(&s);
    options.limits.timeout_s = 1e-9;
    m = csgm_measures_default();
    assert_int_equal(open_solid(&s, csgm_context_options_default(), TEXT), CSGM_OK);
    csgm_context *late;
    assert_int_equal(csgm_context_create(&options, &late), CSGM_OK);
    assert_int_equal(csgm_measure_field(late, s.field, &measure, &m), CSGM_ERR_LIMIT);
    assert_false(m.is_reached);
    assert_true_measures(&m);
    csgm_context_destroy(late);
    close_solid(&s);
}

static bool always(void *user)
{
    return true;
}

static void test_cancelled(void **state)
{
    solid s;
    csgm_measure_options measure = options_to(1e-4);
    csgm_measures m = csgm_measures_default();
    measure.monitor.cancelled = always;
    assert_int_equal(open_solid(&s, csgm_context_options_default(), TEXT), CSGM_OK);
    assert_int_equal(csgm_measure_field(s.context, s.field, &measure, &m), CSGM_CANCELLED);
    assert_true_measures(&m);
    close_solid(&s);
}

static void test_options(void **state)
{
    solid s;
    assert_int_equal(
        open_solid(&s, csgm_context_options_default(), "part(\"a\") cube(1); part(\"b\") cube(2);"),
        CSGM_OK);
    for (int i = 0; i < 7; i++) {
        csgm_measure_options o = options_to(1e-2);
        csgm_measures m = csgm_measures_default();
        switch (i) {
        case 0:
            o.tolerance = 0;
            break;
        case 1:
            o.tolerance = NAN;
            break;
        case 2:
            o.density = INFINITY;
            break;
        case 3:
            o.most_cubes = 0;
            break;
        case 4:
            o.part = "c";
            break;
        case 5:
            o.struct_size--;
            break;
        default:
            m.struct_size += 8;
        }
        assert_int_equal(csgm_measure_field(s.context, s.field, &o, &m), CSGM_ERR_ARGUMENT);
        assert_true(m.volume.high <= 0);
    }
    csgm_measure_options o = options_to(1e-2);
    csgm_measures m = csgm_measures_default();
    o.part = "b";
    m.struct_size = offsetof(csgm_measures, centroid); /* as if a version ended there */
    assert_int_equal(csgm_measure_field(s.context, s.field, &o, &m), CSGM_OK);
    assert_holds(m.volume, 8);
    assert_true(m.centroid[0].high <= 0 && m.centroid[0].low >= 0);
    close_solid(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_any_allocation_may_fail),
        cmocka_unit_test(test_limits),
        cmocka_unit_test(test_cancelled),
        cmocka_unit_test(test_options),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
