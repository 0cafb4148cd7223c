/* SPDX-License-Identifier: MIT
 * What is said of the ways between poses: closed forms, what is known to be the same part in
 * another place and what is not, and random screws whose ways are looked at pose by pose.
 * test_steps WAYS SEED.
 */
#include "clearance_support.h"

#include <stdlib.h>

#include "base/geometry.h"
#include "base/random.h"

enum { TEXT = 2400 };

static uint32_t way_count = 12;
static uint64_t first_seed = 1;

/* Of the only pair, over the poses. */
static csgm_clear_pair look(const csgm_clear_options *options, const char *const *texts,
                            size_t count)
{
    csgm_context *context = NULL;
    csgm_clearances *c = NULL;
    csgm_context_options of_context = csgm_context_options_default();
    of_context.threads = 2;
    assert_int_equal(csgm_context_create(&of_context, &context), CSGM_OK);
    assert_int_equal(csgm_clearances_create(context, options, &c), CSGM_OK);
    for (size_t i = 0; i < count; i++) {
        csgm_status status = clear_add(context, c, texts[i]);
        if (status != CSGM_OK)
            fail_msg("status %d of %s", status, texts[i]);
    }
    csgm_clear_pair out = *csgm_clearances_get(c, 0);
    assert_null(csgm_clearances_get(c, 1));
    out.names[0] = out.names[1] = NULL;
    csgm_clearances_destroy(c);
    csgm_context_destroy(context);
    return out;
}

/* The same with one number that changes. */
static csgm_clear_pair look_over(const csgm_clear_options *options, const char *scene,
                                 const double *values, size_t count)
{
    char texts[8][TEXT];
    const char *all[8];
    assert_true(count <= 8);
    for (size_t i = 0; i < count; i++) {
        snprintf(texts[i], TEXT, "t = %.17g;\n%s", values[i], scene);
        all[i] = texts[i];
    }
    return look(options, all, count);
}

/* ---- closed forms ------------------------------------------------------------------------------
 */

/* A ball on an arm that turns past a ball: inside of it, where the arc comes nearer than its ends
 * and its chord. */
static void test_arc(void **state)
{
    static const char scene[] = "part(\"a\") translate([10, 0, 0]) sphere(1);\n"
                                "part(\"b\") rotate(t) translate([%g, 0, 0]) sphere(1);\n";
    const double radii[] = {7.9, 8.02, 12.1, 11.95};
    for (int i = 0; i < 4; i++) {
        char text[400];
        double gap = fabs(10 - radii[i]) - 2; /* half way */
        snprintf(text, sizeof text, scene, radii[i]);
        csgm_clear_pair p = look_over(NULL, text, (const double[]){-6, 6, 18}, 3);
        assert_int_equal(p.steps, 2);
        assert_int_equal(p.state, CSGM_CLEAR_APART);
        assert_int_equal(p.steps_open, gap < 0);
        assert_int_equal(p.first_open, gap < 0);
        if (gap > 0)
            assert_true(p.gap_between > 0 && p.gap_between <= gap);
    }
}

/* A plate that swings through a bar, and one that swings past it. */
static void test_through(void **state)
{
    static const char scene[] = "part(\"bar\") cube([1, 1, 9], center = true);\n"
                                "part(\"plate\") translate([0, %g, 0]) rotate([0, 0, t])"
                                " translate([4, 0, 0]) cube([6, 0.1, 2], center = true);\n";
    char text[400];
    snprintf(text, sizeof text, scene, 0.0);
    csgm_clear_pair p = look_over(NULL, text, (const double[]){0, 20}, 2);
    assert_int_equal(p.steps_open, 0);
    snprintf(text, sizeof text, scene, -6.0); /* its axis is below the bar */
    p = look_over(NULL, text, (const double[]){45, 60, 120}, 3);
    assert_int_equal(p.state, CSGM_CLEAR_APART);
    assert_int_equal(p.poses_bad + p.poses_open, 0);
    assert_int_equal(p.steps_open, 1);
    assert_int_equal(p.first_open, 2);
}

/* A block that slides along a bar at a distance of 0.5. */
static void test_min_gap(void **state)
{
    static const char scene[] = "part(\"a\") cube([20, 2, 2], center = true);\n"
                                "part(\"b\") translate([t, 2.5, 0]) cube(2, center = true);\n";
    csgm_clear_options options = csgm_clear_options_default();
    csgm_clear_pair p = look_over(&options, scene, (const double[]){-4, 0, 4}, 3);
    assert_int_equal(p.steps_open, 0);
    assert_true(p.gap_between > 0.2 && p.gap_between <= 0.5);
    options.min_gap = 0.49;
    p = look_over(&options, scene, (const double[]){-4, 0, 4}, 3);
    assert_int_equal(p.steps_open, 0);
    assert_true(p.gap_between >= 0.49 && p.gap_between <= 0.5);
    options.min_gap = 0.51;
    p = look_over(&options, scene, (const double[]){-4, 0, 4}, 3);
    assert_int_equal(p.steps_open, 2);
}

/* ---- what is the same part ---------------------------------------------------------------------
 */

static size_t open_of(const char *b)
{
    char text[TEXT];
    snprintf(text, sizeof text,
             "part(\"a\") translate([0, 0, -9]) cube(2, center = true);\n"
             "part(\"b\") %s\n",
             b);
    csgm_clear_pair p = look_over(NULL, text, (const double[]){0, 1, 2}, 3);
    assert_int_equal(p.steps, 2);
    return p.steps_open;
}

static void test_same_part(void **state)
{
    static const char *const moved[] = {
        "translate([t, 0, 0]) difference(blend = 0.2) { cube(2); sphere(1); }",
        "rotate([t, 2 * t, 0]) scale([1, 2, 0.5]) union(blend = 0.3) { sphere(1); cube(1); }",
        "difference() { translate([t, 0, 0]) cube(2); translate([t, 0, 0]) sphere(1); }",
        "rotate(10 * t) linear_extrude(3, twist = 40) square([2, 1]);",
        "rotate(10 * t) linear_extrude(3) union(blend = 0.2) { circle(1); translate([1, 0]) "
        "circle(1); }",
        "translate([0, t, 0]) mirror([1, 0, 0]) torus(2, 0.5);",
        "translate([0, t, 0]) { sphere(1); translate([2, 0, 0]) sphere(1); }",
        "translate([t, 0, 0]) offset3d(0.2) cube(2);",
        "rotate([0, t, 0]) intersection() { field(function (p) 1 - norm(p)); cube(2, center = "
        "true); }",
        "translate([t, 0, 0]) polyhedron(points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],"
        " faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]);",
    };
    static const char *const changed[] = {
        "sphere(1 + t / 10);",
        "scale(1 + t / 10) sphere(1);",
        "union() { translate([t, 0, 0]) sphere(1); sphere(1.5); }",
        "union(blend = 0.5 + t / 10) { cube(1); sphere(0.6); }",
        "scale(1 + t / 10) union(blend = 0.2) { scale(1 / (1 + t / 10)) cube(1); "
        "scale(1 / (1 + t / 10)) sphere(0.6); }",
        "linear_extrude(3, twist = 10 * t) square([2, 1]);",
        "scale([t == 1 ? -1 : 1, 1, 1]) translate([1, 2, 3]) cube([1, 2, 3]);",
        "twist(10) translate([t, 0, 0]) cube([1, 1, 4], center = true);",
    };
    for (size_t i = 0; i < sizeof moved / sizeof *moved; i++)
        if (open_of(moved[i]) != 0)
            fail_msg("is the same: %s", moved[i]);
    for (size_t i = 0; i < sizeof changed / sizeof *changed; i++)
        if (open_of(changed[i]) == 0)
            fail_msg("is not the same: %s", changed[i]);
}

/* Parts that touch and move as one: nothing comes nearer. */
static void test_together(void **state)
{
    static const char scene[] =
        "module m() rotate([t, 2 * t, 3 * t]) translate([t, 5, 0]) children();\n"
        "part(\"a\") m() cube(2);\n"
        "part(\"b\") m() translate([2, 0, 0]) rotate(30) cube(2);\n";
    csgm_clear_pair p = look_over(NULL, scene, (const double[]){0, 10, 40, 40}, 4);
    assert_int_equal(p.steps, 3);
    assert_int_equal(p.steps_open, 0);
    assert_true(p.gap_between <= p.gap.low);
    static const char apart[] = "part(\"a\") cube(2);\n"
                                "if (t != 1) part(\"b\") translate([3, 0, 0]) cube(2);\n"
                                "if (t == 1) part(\"c\") translate([9, 0, 0]) cube(2);\n";
    csgm_context *context = NULL;
    csgm_clearances *c = NULL;
    char text[TEXT];
    assert_int_equal(csgm_context_create(NULL, &context), CSGM_OK);
    assert_int_equal(csgm_clearances_create(context, NULL, &c), CSGM_OK);
    for (int i = 0; i < 4; i++) { /* "b" is there at poses 0, 2 and 3 */
        snprintf(text, sizeof text, "t = %d;\n%s", i, apart);
        assert_int_equal(clear_add(context, c, text), CSGM_OK);
    }
    assert_int_equal(csgm_clearances_get(c, 0)->poses, 3);
    assert_int_equal(csgm_clearances_get(c, 0)->steps, 1);
    csgm_clearances_destroy(c);
    csgm_context_destroy(context);
}

/* ---- random screws ------------------------------------------------------------------------------
 */

static double between(csg_random *r, double low, double high)
{
    return csg_random_uniform(r, low, high);
}

static csg_vec3 random_vector(csg_random *r, double size)
{
    double x = between(r, -size, size), y = between(r, -size, size);
    return csg_vec3_make(x, y, between(r, -size, size));
}

typedef struct screw {
    csg_vec3 axis, through;
    double angle_deg, shift;
} screw;

static csg_affine along(const screw *s, double share)
{
    csg_affine turn = csg_affine_rotate(share * s->angle_deg, s->axis);
    csg_affine there = csg_affine_translate(s->through),
               back = csg_affine_translate(csg_vec3_scale(s->through, -1)),
               shift = csg_affine_translate(csg_vec3_scale(s->axis, share * s->shift));
    return csg_affine_multiply(shift, csg_affine_multiply(there, csg_affine_multiply(turn, back)));
}

static void put_matrix(char text[TEXT], const csg_affine *a, const char *solid, const char *name)
{
    char matrix[1000];
    int used = 0;
    for (int i = 0; i < 3; i++)
        used +=
            snprintf(matrix + used, sizeof matrix - (size_t)used, "[%.17g, %.17g, %.17g, %.17g], ",
                     a->m[i][0], a->m[i][1], a->m[i][2], a->t[i]);
    snprintf(text, TEXT, "part(\"%s\") multmatrix([%s[0, 0, 0, 1]]) %s\n", name, matrix, solid);
}

/* Both at one share of the way, in a frame that moves as it likes. */
static csgm_clear_pair at_share(const csgm_clear_options *options, const screw *s,
                                const csg_affine *start, const csg_affine frames[2],
                                const char *const solids[2], const double *shares, size_t count)
{
    static char texts[2][2 * TEXT];
    const char *all[2] = {texts[0], texts[1]};
    for (size_t i = 0; i < count; i++) {
        char a[TEXT], b[TEXT];
        csg_affine moved = csg_affine_multiply(along(s, shares[i]), *start);
        moved = csg_affine_multiply(frames[i], moved);
        put_matrix(a, &frames[i], solids[0], "a");
        put_matrix(b, &moved, solids[1], "b");
        snprintf(texts[i], sizeof texts[i], "%s%s", a, b);
    }
    return look(options, all, count);
}

/* On a way that is covered, no pose is worse than was said. Returns whether it is. */
static bool try_way(csg_random *r, uint32_t *grazing)
{
    static const char *const kinds[] = {
        "cube([3, 1, 2], center = true);", "capsule([-1, 0, 0], [2, 1, 0], 0.6, 0.3);",
        "torus(1.5, 0.4);",
        "linear_extrude(2, center = true, twist = 50) square([3, 1], center = true);",
        "difference(blend = 0.1) { cube(2, center = true); sphere(1.2); }"};
    enum { LOOKS = 9 };
    csg_affine none = csg_affine_identity();
    const csg_affine still[2] = {none, none};
    const char *solids[2] = {kinds[csg_random_below(r, 5)], kinds[csg_random_below(r, 5)]};
    csg_vec3 axis = csg_vec3_normalize(random_vector(r, 1));
    double most = csg_random_below(r, 3) ? 60 : 179;
    screw s = {axis, random_vector(r, 3), between(r, -most, most), between(r, -1, 1)};
    csg_affine turn =
        csg_affine_rotate(between(r, 0, 360), csg_vec3_normalize(random_vector(r, 1)));
    csg_affine start =
        csg_affine_multiply(csg_affine_translate(csg_vec3_scale(
                                csg_vec3_normalize(random_vector(r, 1)), between(r, 2, 4))),
                            turn);
    /* the frame that both are in goes far meanwhile */
    csg_affine away = csg_affine_multiply(csg_affine_translate(random_vector(r, 30)),
                                          csg_affine_rotate(between(r, 0, 360), axis));
    const csg_affine frames[2] = {none, away};
    csgm_clear_options options = csgm_clear_options_default();
    options.tolerance = 0.01;
    options.most_pairs = 1 << 17; /* an eighth of the default */
    csgm_clear_pair p = at_share(&options, &s, &start, frames, solids, (const double[]){0, 1}, 2);
    assert_int_equal(p.steps, 1);
    if (p.steps_open)
        return false;
    double least = INFINITY;
    for (int i = 0; i <= LOOKS; i++) {
        double share = (double)i / LOOKS;
        csgm_clear_pair q = at_share(&options, &s, &start, still, solids, &share, 1);
        assert_int_not_equal(q.state, CSGM_CLEAR_INTERFERING);
        least = fmin(least, q.by_boxes ? INFINITY : q.gap.high);
    }
    if (p.gap_between > least)
        fail_msg("on the way the gap is %g, not %g as was said", least, p.gap_between);
    *grazing += least < 0.5;
    return true;
}

static void test_random_screws(void **state)
{
    uint32_t covered = 0, grazing = 0;
    for (uint32_t i = 0; i < way_count; i++) {
        csg_random r = {first_seed + i};
        covered += try_way(&r, &grazing);
    }
    printf("%u ways, %u covered, %u of them with less than 0.5 on the way\n", way_count, covered,
           grazing);
    assert_true(covered > way_count / 8 && covered < way_count);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_arc),      cmocka_unit_test(test_through),
        cmocka_unit_test(test_min_gap),  cmocka_unit_test(test_same_part),
        cmocka_unit_test(test_together), cmocka_unit_test(test_random_screws),
    };
    if (argc > 1)
        way_count = (uint32_t)strtoul(argv[1], NULL, 10);
    if (argc > 2)
        first_seed = strtoull(argv[2], NULL, 10);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
