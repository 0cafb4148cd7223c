/* SPDX-License-Identifier: MIT
 * What is proven of two parts against closed forms, and of random pairs of primitives against their
 * exact distances. test_pairs COUNT SEED.
 */
#include "clearance_support.h"

#include <stdlib.h>

#include "base/geometry.h"
#include "base/random.h"

static uint32_t count = 150;
static uint64_t seed = 1;

static csgm_clear_options within(double tolerance)
{
    static const char *const both[] = {"a", "b"};
    csgm_clear_options options = csgm_clear_options_default();
    options.tolerance = tolerance;
    options.parts = both; /* so that boxes are not asked */
    options.part_count = 2;
    return options;
}

static csgm_clear_pair look_at(double tolerance, const char *a, const char *b)
{
    char text[2000];
    csgm_clear_options options = within(tolerance);
    snprintf(text, sizeof text, "part(\"a\") %s part(\"b\") %s", a, b);
    return clear_pair(&options, text);
}

static void assert_gap(const csgm_clear_pair *p, double gap, double tolerance)
{
    if (p->state != CSGM_CLEAR_APART || !(p->gap.low <= gap) || !(p->gap.high >= gap) ||
        !(p->gap.high - p->gap.low <= 1.001 * tolerance))
        fail_msg("state %d, gap %.9g .. %.9g for %.9g", p->state, p->gap.low, p->gap.high, gap);
    const csgm_vec3 a = p->nearest[0], b = p->nearest[1];
    double apart = csg_vec3_norm(csg_vec3_sub(a, b));
    assert_true(fabs(apart - p->gap.high) < 1e-9);
}

static void test_balls(void **state)
{
    csgm_clear_pair p = look_at(1e-3, "sphere(10);", "translate([25, 3, 1]) sphere(8);");
    assert_gap(&p, sqrt(635) - 18, 1e-3);
    p = look_at(1e-3, "sphere(10);", "translate([0, 0, 18]) sphere(8);");
    assert_int_equal(p.state, CSGM_CLEAR_TOUCHING);
    assert_true(p.gap.low <= 0 && p.gap.high <= 1e-3);
    p = look_at(1e-3, "sphere(10);", "translate([0, 0, 15]) sphere(8);");
    assert_int_equal(p.state, CSGM_CLEAR_INTERFERING);
    /* the lens of two balls (Weisstein) */
    double lens = M_PI * 9 * (225 + 2 * 15 * 8 - 3 * 64 + 2 * 15 * 10 + 6 * 8 * 10 - 3 * 100) / 180;
    assert_true(p.volume.low <= lens && p.volume.high >= lens && p.volume.low > 0.5 * lens);
    assert_true(csg_vec3_norm(p.inside) < 10);
    assert_true(csg_vec3_norm(csg_vec3_sub(p.inside, csg_vec3_make(0, 0, 15))) < 8);
}

static void test_boxes(void **state)
{
    csgm_clear_pair p = look_at(1e-3, "cube([10, 20, 30]);", "translate([10.5, 3, 1]) cube(5);");
    assert_gap(&p, 0.5, 1e-3);
    assert_true(p.pairs < 1000); /* plane faces need few cubes, however fine */
    p = look_at(1e-3, "cube([10, 20, 30]);", "translate([11, 22, 32]) cube(5);");
    assert_gap(&p, 3, 1e-3); /* a corner and a corner */
    p = look_at(1e-3, "cube(10, center = true);",
                "translate([12, 0, 0]) rotate([0, 45, 0]) cube(4, center = true);");
    assert_gap(&p, 7 - 2 * sqrt(2), 1e-3); /* a face and an edge along it */
    p = look_at(1e-3, "cube([10, 20, 30]);", "translate([10, 3, 1]) cube(5);");
    assert_int_equal(p.state, CSGM_CLEAR_TOUCHING);
    p = look_at(1e-3, "cube([10, 20, 30]);", "translate([9, 3, 1]) cube(5);");
    assert_int_equal(p.state, CSGM_CLEAR_INTERFERING);
    assert_true(p.volume.low <= 25 && p.volume.high >= 25 && p.volume.low > 12);
}

static void test_one_in_the_other(void **state)
{
    const char *hole = "difference() { cube(30, center = true); sphere(10); }";
    csgm_clear_pair p = look_at(0.02, hole, "translate([1, 0, 0]) sphere(8);");
    assert_gap(&p, 1, 0.02);
    p = look_at(0.02, hole, "sphere(10);");
    assert_int_equal(p.state, CSGM_CLEAR_TOUCHING);
    p = look_at(0.02, "sphere(10);",
                "translate([2, 1, 0]) sphere(1);"); /* nested, surfaces apart */
    assert_int_equal(p.state, CSGM_CLEAR_INTERFERING);
    p = look_at(0.02, hole, "cube(9, center = true);");
    assert_gap(&p, 10 - 4.5 * sqrt(3), 0.02);
}

static void test_min_gap_is_decided(void **state)
{
    csgm_clear_options options = within(0.5);
    const char *text = "part(\"a\") sphere(10); part(\"b\") translate([25, 0, 0]) sphere(8);";
    options.min_gap = 6.95; /* the tolerance alone would leave it open */
    csgm_clear_pair p = clear_pair(&options, text);
    assert_true(p.gap.low >= 6.95 && p.poses_bad == 0 && p.poses_open == 0);
    options.min_gap = 7.05;
    p = clear_pair(&options, text);
    assert_true(p.gap.high < 7.05 && p.poses_bad == 1);
}

static void test_empty_and_far(void **state)
{
    csgm_clear_options options = csgm_clear_options_default();
    csgm_clear_pair p =
        clear_pair(&options, "part(\"a\") sphere(1); part(\"b\") translate([1e3, 0, "
                             "0]) sphere(1);");
    assert_true(p.by_boxes && p.pairs == 0 && p.gap.low > 997 && p.gap.low <= 998);
    p = look_at(1e-3, "sphere(1);",
                "intersection() { sphere(1); translate([5, 0, 0]) sphere(1); }");
    assert_int_equal(p.state, CSGM_CLEAR_APART);
}

/* ---- random pairs ------------------------------------------------------------------------------
 */

static csg_vec3 random_vector(csg_random *r, double size)
{
    double x = csg_random_uniform(r, -size, size), y = csg_random_uniform(r, -size, size);
    return csg_vec3_make(x, y, csg_random_uniform(r, -size, size));
}

/* A solid whose distance from a point is known: a point, a segment or a box, grown by a radius. */
typedef struct solid {
    char text[400];
    csg_vec3 half, at, turn; /* of the box, in its own frame */
    csg_affine place, back;
    double radius;
    int kind;
} solid;

/* The text of the solid where it is. */
static void write(solid *s)
{
    char body[200];
    if (s->kind == 0)
        snprintf(body, sizeof body, "sphere(%.17g);", s->radius);
    else if (s->kind == 1)
        snprintf(body, sizeof body, "capsule([0, 0, %.17g], [0, 0, %.17g], %.17g);", -s->half.z,
                 s->half.z, s->radius);
    else
        snprintf(body, sizeof body, "cube([%.17g, %.17g, %.17g], center = true);", 2 * s->half.x,
                 2 * s->half.y, 2 * s->half.z);
    snprintf(s->text, sizeof s->text,
             "translate([%.17g, %.17g, %.17g]) rotate([%.17g, %.17g, %.17g]) %s", s->at.x, s->at.y,
             s->at.z, s->turn.x, s->turn.y, s->turn.z, body);
}

static solid random_solid(csg_random *r, double spread)
{
    solid s;
    int kind = s.kind = (int)csg_random_below(r, 3);
    s.at = random_vector(r, spread);
    s.turn = random_vector(r, 180);
    s.half = csg_vec3_make(csg_random_uniform(r, 0.5, 4), csg_random_uniform(r, 0.5, 4),
                           csg_random_uniform(r, 0.5, 4));
    s.radius = kind == 2 ? 0 : csg_random_uniform(r, 0.5, 3);
    if (kind < 2)
        s.half = csg_vec3_make(0, 0, kind == 0 ? 0 : s.half.z);
    csg_affine x = csg_affine_rotate(s.turn.x, csg_vec3_make(1, 0, 0));
    csg_affine y = csg_affine_rotate(s.turn.y, csg_vec3_make(0, 1, 0));
    csg_affine z = csg_affine_rotate(s.turn.z, csg_vec3_make(0, 0, 1));
    s.place = csg_affine_multiply(csg_affine_translate(s.at),
                                  csg_affine_multiply(z, csg_affine_multiply(y, x)));
    assert_true(csg_affine_invert(s.place, &s.back));
    write(&s);
    return s;
}

/* The point of the box nearest to p. */
static csg_vec3 nearest_of(const solid *s, csg_vec3 p)
{
    csg_vec3 q = csg_affine_point(&s->back, p);
    q.x = fmin(fmax(q.x, -s->half.x), s->half.x);
    q.y = fmin(fmax(q.y, -s->half.y), s->half.y);
    q.z = fmin(fmax(q.z, -s->half.z), s->half.z);
    return csg_affine_point(&s->place, q);
}

/* Of two boxes, by alternating projections (Cheney and Goldstein), between bounds: the points that
 * are found, and the planes through them. Negative where they meet for sure. Returns the direction.
 */
static csg_vec3 distance_of(const solid *a, const solid *b, double *low, double *high)
{
    csg_vec3 p = a->at, q = b->at, d = {0, 0, 1};
    *high = INFINITY;
    *low = 0;
    for (int i = 0; i < 20000 && *high - *low > 1e-9; i++) {
        q = nearest_of(b, p);
        p = nearest_of(a, q);
        d = csg_vec3_normalize(csg_vec3_sub(q, p));
        csg_vec3 of_a = csg_affine_covector(&a->place, d), of_b = csg_affine_covector(&b->place, d);
        double reach_a = csg_vec3_dot(d, a->at) + fabs(of_a.x) * a->half.x +
                         fabs(of_a.y) * a->half.y + fabs(of_a.z) * a->half.z;
        double reach_b = csg_vec3_dot(d, b->at) - fabs(of_b.x) * b->half.x -
                         fabs(of_b.y) * b->half.y - fabs(of_b.z) * b->half.z;
        *high = csg_vec3_norm(csg_vec3_sub(q, p));
        *low = fmax(*low, reach_b - reach_a);
    }
    *low -= a->radius + b->radius;
    *high -= a->radius + b->radius;
    return d;
}

/* Moves b so that they are nearly in touch: they are `by` apart then, or overlap by less than -by.
 */
static void bring_near(const solid *a, solid *b, double by, double *low, double *high)
{
    csg_vec3 d = distance_of(a, b, low, high);
    if (!(*low > 0) || *high - *low > 1e-6)
        return;
    csg_vec3 move = csg_vec3_scale(d, by - *high);
    b->at = csg_vec3_add(b->at, move);
    b->place = csg_affine_multiply(csg_affine_translate(move), b->place);
    assert_true(csg_affine_invert(b->place, &b->back));
    write(b);
    distance_of(a, b, low, high);
}

static void test_random_pairs(void **state)
{
    static const double T = 2e-3;
    csg_random r = {seed};
    uint32_t apart = 0, touching = 0, interfering = 0;
    for (uint32_t i = 0; i < count; i++) {
        solid a = random_solid(&r, 4), b = random_solid(&r, 4);
        double low, high;
        if (i % 3 == 0)
            bring_near(&a, &b, csg_random_uniform(&r, -4, 4) * T, &low, &high);
        else
            distance_of(&a, &b, &low, &high);
        csgm_clear_pair p = look_at(T, a.text, b.text);
        apart += p.state == CSGM_CLEAR_APART;
        touching += p.state == CSGM_CLEAR_TOUCHING;
        interfering += p.state == CSGM_CLEAR_INTERFERING;
        bool is_true = p.state == CSGM_CLEAR_APART
                           ? p.gap.low <= high + 1e-6 && p.gap.high >= low - 1e-6
                       : p.state == CSGM_CLEAR_TOUCHING    ? fabs(high) < 2 * T
                       : p.state == CSGM_CLEAR_INTERFERING ? low < 1e-6
                                                           : false;
        if (!is_true || (low > T && p.state != CSGM_CLEAR_APART) ||
            (p.state == CSGM_CLEAR_APART && p.gap.high - p.gap.low > 0.1 * p.gap.high + T))
            fail_msg(
                "pair %u of seed %llu: state %d, gap %.9g .. %.9g, exactly %.9g .. %.9g:\n%s\n%s",
                i, (unsigned long long)seed, p.state, p.gap.low, p.gap.high, low, high, a.text,
                b.text);
    }
    printf("%u apart, %u touching, %u interfering\n", apart, touching, interfering);
    assert_true(apart > count / 5 && interfering > count / 5 && touching > count / 100);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_balls),
        cmocka_unit_test(test_boxes),
        cmocka_unit_test(test_one_in_the_other),
        cmocka_unit_test(test_min_gap_is_decided),
        cmocka_unit_test(test_empty_and_far),
        cmocka_unit_test(test_random_pairs),
    };
    if (argc > 1)
        count = (uint32_t)strtoul(argv[1], NULL, 10);
    if (argc > 2)
        seed = strtoull(argv[2], NULL, 10);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
