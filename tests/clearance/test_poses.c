/* SPDX-License-Identifier: MIT
 * Parts over poses by the C interface: the worst pose, parts that come and go, what is proven when
 * an allocation is refused or time is up, options of older versions, the same for any threads.
 */
#include "clearance_support.h"

#include <stdlib.h>

#include "failing.h"

static const char THREE[] = "part(\"a\") cube(2, center = true);\n"
                            "part(\"b\") translate([%g, 0, 0]) sphere(1);\n"
                            "part(\"c\") translate([0, 0, 30]) sphere(1);\n";

static csgm_context *open_context(uint32_t threads)
{
    csgm_context *context = NULL;
    csgm_context_options options = csgm_context_options_default();
    options.threads = threads;
    assert_int_equal(csgm_context_create(&options, &context), CSGM_OK);
    return context;
}

static csgm_status add_at(csgm_context *context, csgm_clearances *clearances, double x)
{
    char text[400];
    snprintf(text, sizeof text, THREE, x);
    return clear_add(context, clearances, text);
}

static csgm_clearances *look_at(csgm_context *context, const csgm_clear_options *options,
                                const double *x, size_t count)
{
    csgm_clearances *clearances = NULL;
    assert_int_equal(csgm_clearances_create(context, options, &clearances), CSGM_OK);
    for (size_t i = 0; i < count; i++)
        assert_int_equal(add_at(context, clearances, x[i]), CSGM_OK);
    return clearances;
}

static void test_worst_pose(void **state)
{
    const double x[] = {4, 3, 2.25, 3.5, 2.5, 2.25};
    csgm_context *context = open_context(2);
    csgm_clear_options options = csgm_clear_options_default();
    options.tolerance = 1e-3;
    csgm_clearances *c = look_at(context, &options, x, 6);
    const csgm_clear_pair *p = csgm_clearances_get(c, 0);
    assert_string_equal(p->names[0], "a");
    assert_string_equal(p->names[1], "b");
    assert_int_equal(p->state, CSGM_CLEAR_APART);
    assert_int_equal(p->pose, 2);
    assert_true(p->gap.low <= 0.25 && p->gap.high >= 0.25 && p->gap.high < 0.252);
    assert_int_equal(p->poses, 6);
    assert_int_equal(p->poses_bad + p->poses_open, 0);
    p = csgm_clearances_get(c, 1);
    assert_true(p->by_boxes && p->gap.low > 27.9 && p->gap.low <= 28);
    assert_non_null(csgm_clearances_get(c, 2));
    assert_null(csgm_clearances_get(c, 3));
    csgm_clearances_destroy(c);
    options.min_gap = 0.6;
    c = look_at(context, &options, x, 6);
    assert_int_equal(csgm_clearances_get(c, 0)->poses_bad, 3);
    csgm_clearances_destroy(c);
    const double through[] = {4, 1.5, 0.5, 1, 4};
    c = look_at(context, NULL, through, 5);
    p = csgm_clearances_get(c, 0);
    assert_int_equal(p->state, CSGM_CLEAR_INTERFERING);
    assert_int_equal(p->poses_bad, 3);
    assert_int_equal(p->pose, 2);
    csgm_clearances_destroy(c);
    csgm_context_destroy(context);
}

static void test_what_is_as_it_was_is_not_looked_at_again(void **state)
{
    const double x[] = {3, 3, 3};
    csgm_context *context = open_context(1);
    csgm_clearances *once = look_at(context, NULL, x, 1), *c = look_at(context, NULL, x, 3);
    const csgm_clear_pair *p = csgm_clearances_get(c, 0), *q = csgm_clearances_get(once, 0);
    assert_true(q->pairs > 0);
    assert_int_equal(p->pairs, q->pairs);
    assert_int_equal(p->poses, 3);
    csgm_clearances_destroy(c);
    csgm_clearances_destroy(once);
    csgm_context_destroy(context);
}

static void test_same_for_any_threads(void **state)
{
    const double x[] = {4, 2.3, 1.9, 2.1};
    csgm_clear_pair found[2][3];
    for (uint32_t i = 0; i < 2; i++) {
        csgm_context *context = open_context(1 + 3 * i);
        csgm_clearances *c = look_at(context, NULL, x, 4);
        for (size_t k = 0; k < 3; k++) {
            memcpy(&found[i][k], csgm_clearances_get(c, k), sizeof found[i][k]);
            found[i][k].names[0] = found[i][k].names[1] = NULL;
        }
        csgm_clearances_destroy(c);
        csgm_context_destroy(context);
    }
    assert_memory_equal(found[0], found[1], sizeof found[0]);
}

static void test_parts_come_and_go(void **state)
{
    csgm_context *context = open_context(1);
    csgm_clearances *c = NULL;
    const char *name;
    assert_int_equal(csgm_clearances_create(context, NULL, &c), CSGM_OK);
    assert_int_equal(add_at(context, c, 3), CSGM_OK);
    assert_int_equal(clear_add(context, c, "part(\"d\") cube(1); part(\"a\") cube(1);"), CSGM_OK);
    assert_int_equal(csgm_clearances_get(c, 0)->poses, 1);
    assert_int_equal(csgm_clearances_get(c, 3)->state, CSGM_CLEAR_INTERFERING);
    assert_true(csgm_clearances_part(c, 3, &name));
    assert_string_equal(name, "d");
    assert_false(csgm_clearances_part(c, 4, &name));
    assert_int_equal(clear_add(context, c, "part(\"a\") cube(1);"), CSGM_ERR_SCENE);
    csgm_clearances_destroy(c);
    csgm_context_destroy(context);
}

static void test_names(void **state)
{
    static const char *const one[] = {"c"}, *const wrong[] = {"a", "x"};
    const double x[] = {3};
    csgm_context *context = open_context(1);
    csgm_clear_options options = csgm_clear_options_default();
    options.parts = one;
    options.part_count = 1;
    csgm_clearances *c = look_at(context, &options, x, 1);
    assert_string_equal(csgm_clearances_get(c, 0)->names[0], "a");
    assert_string_equal(csgm_clearances_get(c, 1)->names[0], "b");
    assert_null(csgm_clearances_get(c, 2));
    assert_false(csgm_clearances_get(c, 0)->by_boxes);
    csgm_clearances_destroy(c);
    options.parts = wrong;
    options.part_count = 2;
    assert_int_equal(csgm_clearances_create(context, &options, &c), CSGM_OK);
    assert_int_equal(add_at(context, c, 3), CSGM_ERR_ARGUMENT);
    csgm_clearances_destroy(c);
    csgm_context_destroy(context);
}

/* Whatever is refused: nothing wrong is told, nothing is lost. */
static void test_any_allocation_may_fail(void **state)
{
    bool done = false;
    int refused = 0;
    for (long n = 0; !done; n++) {
        failing f = {.left = n};
        csgm_context *context = NULL;
        csgm_clearances *c = NULL;
        csgm_context_options options = csgm_context_options_default();
        options.allocator = (csgm_allocator){failing_alloc, failing_release, &f};
        options.threads = 1;
        csgm_status status = csgm_context_create(&options, &context);
        if (status == CSGM_OK)
            status = csgm_clearances_create(context, NULL, &c);
        if (status == CSGM_OK)
            status = add_at(context, c, 2.2);
        if (status == CSGM_OK)
            status = add_at(context, c, 2.4); /* with the step */
        const csgm_clear_pair *p = c ? csgm_clearances_get(c, 0) : NULL;
        done = status == CSGM_OK;
        refused += !done;
        assert_true(done || status == CSGM_ERR_MEMORY);
        if (p && p->poses) {
            assert_true(p->gap.low <= 0.2 && p->gap.high >= 0.2);
            assert_int_not_equal(p->state, CSGM_CLEAR_INTERFERING);
            assert_true(done || p->state == CSGM_CLEAR_APART || p->poses_open == 1);
            assert_true(p->steps_open <= p->steps && p->gap_between <= 0.2);
            assert_true(!done || (p->steps == 1 && !p->steps_open && p->gap_between > 0.05));
        }
        csgm_clearances_destroy(c);
        csgm_context_destroy(context);
        assert_int_equal(f.live, 0);
    }
    assert_true(refused > 10);
}

static void test_limits(void **state)
{
    csgm_context *context = NULL;
    csgm_clearances *c = NULL;
    csgm_context_options options = csgm_context_options_default();
    csgm_clear_options few = csgm_clear_options_default();
    options.limits.timeout_s = 1e-9;
    assert_int_equal(csgm_context_create(&options, &context), CSGM_OK);
    assert_int_equal(csgm_clearances_create(context, NULL, &c), CSGM_OK);
    csgm_status status = add_at(context, c, 2.2);
    assert_true(status == CSGM_ERR_LIMIT);
    csgm_clearances_destroy(c);
    csgm_context_destroy(context);
    context = open_context(2);
    few.most_pairs = 20;
    few.tolerance = 1e-4;
    c = look_at(context, &few, (const double[]){2.0001}, 1);
    const csgm_clear_pair *p = csgm_clearances_get(c, 0);
    assert_int_equal(p->state, CSGM_CLEAR_UNDECIDED);
    assert_int_equal(p->poses_open, 1);
    assert_true(p->size > 0 && p->gap.low <= 0.0001 && p->gap.high >= 0.0001);
    csgm_clearances_destroy(c);
    csgm_context_destroy(context);
}

/* Of two boxes and a ball: what is solid, what is marked, where the red balls are. */
static void test_exhibit(void **state)
{
    static const char text[] =
        "part(\"a\") cube(2, center = true);\n"
        "part(\"b\") rotate(30) translate([3.2, 0, 0]) cube(2, center = true);\n"
        "translate([0, 0, 30]) sphere(1);\n";
    const csgm_vec3 in_a = {-0.9, 0, 0}, in_b = {2.771281292110204, 1.6, 0}, in_c = {0, 0, 30};
    csgm_context *context = open_context(1);
    csgm_clearances *c = NULL;
    csgm_scene *scene = NULL, *shown = NULL;
    assert_int_equal(csgm_clearances_create(context, NULL, &c), CSGM_OK);
    assert_int_equal(csgm_scene_parse(context, text, strlen(text), "test", NULL, &scene), CSGM_OK);
    assert_int_equal(csgm_clearances_add(c, scene), CSGM_OK);
    csgm_clear_pair pair = *csgm_clearances_get(c, 2);
    assert_string_equal(pair.names[1], "b");
    for (int solid = 0; solid < 2; solid++) {
        assert_int_equal(csgm_clear_exhibit(context, scene, &pair, solid, 0.1, &shown), CSGM_OK);
        const csgm_scene *other = csgm_scene_get_marked(shown, CSGM_MARK_HIGHLIGHT),
                         *rest = csgm_scene_get_marked(shown, CSGM_MARK_BACKGROUND);
        assert_true((csgm_scene_eval(shown, in_a, NULL) > 0) == (solid == 0));
        assert_true((csgm_scene_eval(shown, in_b, NULL) > 0) == (solid == 1));
        assert_true(csgm_scene_eval(other, solid ? in_a : in_b, NULL) > 0);
        assert_true(csgm_scene_eval(other, solid ? in_b : in_a, NULL) < 0);
        assert_true(csgm_scene_eval(rest, in_c, NULL) > 0.99);
        assert_true(csgm_scene_eval(shown, in_c, NULL) < 0);
        csgm_vec3 middle = {(pair.nearest[0].x + pair.nearest[1].x) / 2,
                            (pair.nearest[0].y + pair.nearest[1].y) / 2,
                            (pair.nearest[0].z + pair.nearest[1].z) / 2};
        for (int k = 0; k < 2; k++)
            assert_true(csgm_scene_eval(shown, pair.nearest[k], NULL) > 0.099);
        assert_float_equal(csgm_scene_eval(shown, middle, NULL), 0.04, 1e-9); /* the rod */
        csgm_scene_destroy(shown);
    }
    pair.state = CSGM_CLEAR_INTERFERING; /* then nearest points are not known */
    assert_int_equal(csgm_clear_exhibit(context, scene, &pair, 0, 0.1, &shown), CSGM_OK);
    assert_true(csgm_scene_eval(shown, pair.nearest[1], NULL) < 0);
    csgm_scene_destroy(shown);
    pair.names[1] = "x";
    assert_int_equal(csgm_clear_exhibit(context, scene, &pair, 0, 0, &shown), CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_clear_exhibit(context, scene, &pair, 2, 0, &shown), CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_clear_exhibit(context, scene, &pair, 0, -1, &shown), CSGM_ERR_ARGUMENT);
    assert_null(shown);
    csgm_scene_destroy(scene);
    csgm_clearances_destroy(c);
    csgm_context_destroy(context);
}

static void test_any_allocation_of_an_exhibit_may_fail(void **state)
{
    static const char text[] = "part(\"a\") cube(2);\npart(\"b\") cube(1);\nsphere(9);\n";
    csgm_clear_pair pair = {.names = {"a", "b"}, .state = CSGM_CLEAR_INTERFERING};
    csgm_status status = CSGM_ERR_MEMORY;
    int refused = 0;
    for (long n = 0; status == CSGM_ERR_MEMORY; n++) {
        failing f = {.left = 1000000};
        csgm_context *context = NULL;
        csgm_scene *scene = NULL, *shown = NULL;
        csgm_context_options options = csgm_context_options_default();
        options.allocator = (csgm_allocator){failing_alloc, failing_release, &f};
        options.threads = 1;
        assert_int_equal(csgm_context_create(&options, &context), CSGM_OK);
        assert_int_equal(csgm_scene_parse(context, text, strlen(text), "test", NULL, &scene),
                         CSGM_OK);
        f.left = n;
        status = csgm_clear_exhibit(context, scene, &pair, 0, 0, &shown);
        assert_true((status == CSGM_OK) == (shown != NULL));
        refused += status == CSGM_ERR_MEMORY;
        csgm_scene_destroy(shown);
        csgm_scene_destroy(scene);
        csgm_context_destroy(context);
        assert_int_equal(f.live, 0);
    }
    assert_int_equal(status, CSGM_OK);
    assert_true(refused > 10);
}

static void test_wrong_arguments(void **state)
{
    csgm_context *context = open_context(1), *other = open_context(1);
    csgm_clearances *c = NULL;
    csgm_clear_options options = csgm_clear_options_default();
    options.min_gap = -1;
    assert_int_equal(csgm_clearances_create(context, &options, &c), CSGM_ERR_ARGUMENT);
    options = csgm_clear_options_default();
    options.struct_size = 7;
    assert_int_equal(csgm_clearances_create(context, &options, &c), CSGM_ERR_ARGUMENT);
    assert_null(c);
    assert_int_equal(csgm_clearances_create(context, NULL, &c), CSGM_OK);
    assert_int_equal(add_at(other, c, 3), CSGM_ERR_ARGUMENT); /* a scene of another context */
    assert_int_equal(
        clear_add(context, c, "part(\"a\") plane([0, 0, 1], 0); part(\"b\") sphere(1);"),
        CSGM_ERR_SCENE);
    csgm_clearances_destroy(c);
    csgm_clearances_destroy(NULL);
    csgm_context_destroy(other);
    csgm_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_worst_pose),
        cmocka_unit_test(test_what_is_as_it_was_is_not_looked_at_again),
        cmocka_unit_test(test_same_for_any_threads),
        cmocka_unit_test(test_parts_come_and_go),
        cmocka_unit_test(test_names),
        cmocka_unit_test(test_any_allocation_may_fail),
        cmocka_unit_test(test_limits),
        cmocka_unit_test(test_exhibit),
        cmocka_unit_test(test_any_allocation_of_an_exhibit_may_fail),
        cmocka_unit_test(test_wrong_arguments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
