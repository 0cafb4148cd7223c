/* SPDX-License-Identifier: MIT
 * What is proven of random scenes of every family against two meshes of them, one finer than the
 * other: their difference says how far the finer one may be off. Volume, area and centroid.
 */
#include <float.h>

#include "measure/measure.h"
#include "mesh/mesh_support.h"

enum { COARSE = 48, FINE = 96, FINEST = 192 };

static csgm_measure_options roughly(void)
{
    return (csgm_measure_options){.struct_size = sizeof(csgm_measure_options),
                                  .tolerance = 0.01,
                                  .density = 1,
                                  .most_cubes = 1 << 16};
}

/* How far x is outside of the interval, in units of what it may be off by. */
static double beyond(csgm_interval interval, double x, double coarser, double least)
{
    double room = 2 * fabs(x - coarser) + least;
    return fmax(interval.low - x, x - interval.high) / room;
}

/* Of the finest mesh so far against the one before. */
static double worst_of(const csgm_measures *m, const csgm_mesh_check *fine,
                       const csgm_mesh_check *coarse, double size, const char **what)
{
    static const double LEAST = 2e-4;
    double area = beyond(m->area, fine->area, coarse->area, LEAST * fine->area);
    double volume = beyond(m->volume, fine->volume, coarse->volume, LEAST * size * fine->area);
    *what = area > volume ? "area" : "volume";
    return fmax(area, volume);
}

static bool try_scene(mesh_case *m, uint64_t seed)
{
    const csgm_measure_options how = roughly();
    csgm_measures measures = {.struct_size = sizeof(csgm_measures)};
    csg_box b = m->field->bounds;
    if (!csg_box_is_finite(b) || csg_box_is_empty(b))
        return false;
    csgm_status status = csg_measure_field(&m->context, m->field, &how, &measures);
    if (status == CSGM_ERR_SCENE)
        return false;
    assert_int_equal(status, CSGM_OK);
    const uint32_t resolutions[] = {COARSE, FINE, FINEST};
    csgm_mesh_check before = {.volume = 0};
    const char *what = "";
    double worst = INFINITY;
    for (int i = 0; i < 3 && (i < 2 || worst > 1); i++) {
        csgm_mesh_options options = mesh_options(resolutions[i]);
        if (mesh_build(m, &options) != CSGM_OK)
            return false;
        csgm_mesh_view view = csg_mesh_view(m->mesh);
        assert_int_equal(csg_mesh_inspect(&m->context, &view, 0, &m->check), CSGM_OK);
        if (i)
            worst = worst_of(&measures, &m->check, &before, csg_box_longest_side(b), &what);
        before = m->check;
    }
    if (worst > 1)
        fail_msg("seed %llu: the %s is %g or %g, proven is %.9g .. %.9g and %.9g .. %.9g, which is "
                 "%g times what a mesh is off by",
                 (unsigned long long)seed, what, m->check.volume, m->check.area,
                 measures.volume.low, measures.volume.high, measures.area.low, measures.area.high,
                 worst);
    return true;
}

static bool try_seed(uint64_t seed, uint64_t i)
{
    csg_random random = {.state = seed};
    mesh_case m;
    mesh_case_begin(&m, 1);
    csg_node_id root = test_random_mixed(&m.builder, &random, i);
    assert_true(root != CSG_NODE_NONE);
    mesh_case_compile(&m, root);
    bool is_tried = try_scene(&m, seed);
    mesh_case_end(&m);
    return is_tried;
}

static void measures_hold(void **state)
{
    uint32_t tried = 0;
    for (uint64_t i = 0; i < ROUNDS(12) * test_times; i++)
        tried += try_seed(31000 + test_first_seed + i, i);
    assert_true(tried > ROUNDS(4) * test_times);
}

/* Blends interior and exterior, whose operators stand behind the part of a tape that is enclosed.
 */
static void measures_of_rules_hold(void **state)
{
    assert_true(try_seed(24751008, 8));
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(measures_hold),
                                       cmocka_unit_test(measures_of_rules_hold)};
    test_take_search(argc, argv);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
