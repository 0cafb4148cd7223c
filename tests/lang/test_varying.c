/* SPDX-License-Identifier: MIT
 * Blends by a radius that varies: random operators of balls and half-spaces, whose fields are known
 * in closed form, with radii of all kinds of formulas. The field is that of the round operator's
 * definition (operators.md 12: the largest root of sum max(r + f_i - G, 0)^2 = r^2, by bisection),
 * divided by the constant of operators.md 19; it never refutes its Lipschitz constant, and its
 * gradient is that of central differences.
 *
 *   test_lang_varying [COUNT [SEED]]     so many random trees, from this seed on
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "lang/bench_failing.h"
#include "lang/bench_fixture.h"
#include "scene/formula/formula.h"
#include "scene/reference.h"

static uint32_t count = 200;
static uint64_t first_seed = 1;

enum { MOST = 4, RADII = 6, POINTS = 24 };

typedef struct operand {
    bool is_ball;
    csg_vec3 at; /* centre, or unit normal */
    double size; /* radius, or distance */
} operand;

typedef struct tree {
    operand operands[MOST];
    uint32_t operand_count, radius, kind;
    char scene[2048];
} tree;

/* Of the box of the balls, -8 .. 8 at most; all are 0.2 to 4. */
static const char *const radii[RADII] = {
    "1.5",
    "2 + p.x / 10",
    "max(0.2, min(3, 1 + 0.3 * p.z))",
    "1 + norm(p) / 8",
    "1.5 + sin(40 * p.x) * cos(30 * p.y) / 2",
    "let (q = p.y / 8) 1 + q * q * q / 2 + abs(p.x) / 16",
};

static double radius_at(uint32_t radius, csg_vec3 p)
{
    const double degree = acos(-1) / 180;
    double q = p.y / 8;
    switch (radius) {
    case 0:
        return 1.5;
    case 1:
        return 2 + p.x / 10;
    case 2:
        return fmax(0.2, fmin(3, 1 + 0.3 * p.z));
    case 3:
        return 1 + csg_vec3_norm(p) / 8;
    case 4:
        return 1.5 + sin(40 * p.x * degree) * cos(30 * p.y * degree) / 2;
    default:
        return 1 + q * q * q / 2 + fabs(p.x) / 16;
    }
}

/* A bound of its slope, at most so tight as intervals make it. */
static const double slopes[RADII] = {0, 0.1, 0.3, 0.125, 0.45, 0.21};

static csg_vec3 draw_point(csg_random *random, double size)
{
    return csg_vec3_make(csg_random_uniform(random, -size, size),
                         csg_random_uniform(random, -size, size),
                         csg_random_uniform(random, -size, size));
}

static void draw(tree *t, csg_random *random)
{
    static const char *const kinds[3] = {"union", "intersection", "difference"};
    t->kind = csg_random_below(random, 3);
    t->operand_count = 2 + csg_random_below(random, MOST - 1);
    t->radius = csg_random_below(random, RADII);
    int used = snprintf(t->scene, sizeof t->scene, "%s(blend = function (p) %s) {\n",
                        kinds[t->kind], radii[t->radius]);
    for (uint32_t i = 0; i < t->operand_count; i++) {
        operand *o = &t->operands[i];
        o->is_ball = i == 0 || csg_random_below(random, 3) > 0;
        o->size = csg_random_uniform(random, 1, 4);
        o->at = draw_point(random, 3);
        if (!o->is_ball)
            o->at = csg_vec3_normalize(o->at);
        used += snprintf(t->scene + used, sizeof t->scene - (size_t)used,
                         o->is_ball ? "  translate([%.17g, %.17g, %.17g]) sphere(%.17g);\n"
                                    : "  plane([%.17g, %.17g, %.17g], %.17g);\n",
                         o->at.x, o->at.y, o->at.z, o->size);
    }
    snprintf(t->scene + used, sizeof t->scene - (size_t)used, "}\n");
}

static double field_of(const operand *o, csg_vec3 p)
{
    return o->is_ball ? o->size - csg_vec3_norm(csg_vec3_sub(p, o->at))
                      : o->size - csg_vec3_dot(o->at, p);
}

/* The round union by its definition. */
static double round_union(double f, double h, double r)
{
    double low = fmax(f, h), high = low + r;
    for (int i = 0; i < 100; i++) {
        double g = (low + high) / 2, x = fmax(r + f - g, 0), y = fmax(r + h - g, 0);
        *(x * x + y * y > r * r ? &low : &high) = g;
    }
    return (low + high) / 2;
}

static double wanted(const tree *t, csg_vec3 p, double r)
{
    double value = field_of(&t->operands[0], p);
    for (uint32_t i = 1; i < t->operand_count; i++) {
        double f = field_of(&t->operands[i], p);
        value = t->kind == 0   ? round_union(value, f, r)
                : t->kind == 1 ? -round_union(-value, -f, r)
                               : -round_union(-value, f, r);
    }
    return value;
}

static csg_sample sample(csg_vec3 p)
{
    csgm_status status = CSGM_OK;
    csg_sample s = csg_reference_eval(b.scene, p, &status);
    assert_int_equal(status, CSGM_OK);
    return s;
}

static csg_vec3 along(csg_vec3 p, int axis, double by)
{
    (&p.x)[axis] += by;
    return p;
}

/* Central differences with two steps; beside kinks they do not agree, and nothing is asked. How
 * many components were compared. */
static uint32_t check_gradient(csg_vec3 p, csg_vec3 gradient)
{
    uint32_t compared = 0;
    for (int axis = 0; axis < 3; axis++) {
        double slope[2], step = 1e-4;
        for (int i = 0; i < 2; i++, step /= 4)
            slope[i] = (sample(along(p, axis, step)).value - sample(along(p, axis, -step)).value) /
                       (2 * step);
        if (fabs(slope[0] - slope[1]) > 1e-6)
            continue;
        assert_true(fabs(slope[1] - (&gradient.x)[axis]) < 1e-5);
        compared++;
    }
    return compared;
}

/* Where the radius is taken: in the solids' box and a sixteenth of it around. */
static csg_vec3 clamped(const tree *t, csg_vec3 p)
{
    csg_box box = csg_box_empty();
    for (uint32_t i = 0; i < t->operand_count; i++) {
        const operand *o = &t->operands[i];
        csg_box one = o->is_ball ? csg_box_grow((csg_box){o->at, o->at}, o->size) : csg_box_all();
        bool first = i == 0;
        if (first)
            box = one;
        else if (t->kind == 0)
            box = csg_box_hull(box, one);
        else if (t->kind == 1)
            box = csg_box_intersect(box, one);
    }
    if (!csg_box_is_finite(box))
        return p;
    box = csg_box_grow(box, csg_box_longest_side(box) / 16);
    return csg_vec3_make(fmin(fmax(p.x, box.min.x), box.max.x),
                         fmin(fmax(p.y, box.min.y), box.max.y),
                         fmin(fmax(p.z, box.min.z), box.max.z));
}

/* The value is that of the definition, divided by a constant that is no larger than stated, where
 * the box that the solid is cut by is not nearer. */
static uint32_t check_points(const tree *t, csg_random *random)
{
    const double share = 1 - sqrt(0.5);
    double constant = 1 + (t->operand_count - 1) * share * slopes[t->radius] * 1.05 + 1e-5;
    uint32_t compared = 0;
    for (int i = 0; i < POINTS; i++) {
        csg_vec3 p = draw_point(random, 7), q = draw_point(random, 7);
        if (i % 2)
            q = csg_vec3_add(p, csg_vec3_scale(q, 1e-4));
        csg_sample s = sample(p), sq = sample(q);
        double value = wanted(t, p, radius_at(t->radius, clamped(t, p)));
        assert_true(fabs(s.value - sq.value) <= csg_vec3_norm(csg_vec3_sub(p, q)) + 1e-12);
        assert_true(csg_vec3_norm(s.gradient) <= 1 + 1e-9);
        assert_true((s.value > 1e-9) <= (value > 0) && (s.value < -1e-9) <= (value < 0));
        if (s.value > 0) {
            if (s.value > value * (1 + 1e-9) || s.value < value / constant - 1e-9)
                print_error("%s%g is not %g / %g\n", t->scene, s.value, value, constant);
            assert_true(s.value <= value * (1 + 1e-9) && s.value >= value / constant - 1e-9);
        }
        compared += check_gradient(p, s.gradient);
    }
    return compared;
}

static void random_radii_keep_their_promises(void **state)
{
    (void)state;
    uint32_t made = 0, compared = 0;
    for (uint64_t n = 0; n < count; n++) {
        csg_random random = {first_seed + n};
        tree t;
        draw(&t, &random);
        csgm_status status = bench_compile_bytes(&b, t.scene, strlen(t.scene), NULL);
        if (status != CSGM_OK) { /* in all of space not every radius is known to stay above 0 */
            if (!strstr(b.text, "blend's radius"))
                print_error("%s%s", t.scene, b.text);
            assert_non_null(strstr(b.text, "blend's radius"));
            continue;
        }
        made++;
        compared += check_points(&t, &random);
    }
    print_message("%u of %u made, %u derivatives compared\n", made, count, compared);
    assert_true(made > count / 2 && compared > made * POINTS);
}

/* Bounds of values hold, and parts make them tight. */
static void values_are_enclosed(void **state)
{
    (void)state;
    csg_memory *memory = &b.context.memory;
    const csg_box box = {{-1, -2, 0}, {3, 1, 2}};
    csg_formula_builder terms;
    csg_formula_begin(&terms, memory);
    csg_formula_id x = csg_formula_apply(&terms, CSG_FORMULA_X, 0, 0);
    csg_formula_id y = csg_formula_apply(&terms, CSG_FORMULA_Y, 0, 0);
    /* x (2 - x) + y: from -5 to 2, each x and y counted for itself from -5 to 10 */
    csg_formula_id rest =
        csg_formula_apply(&terms, CSG_FORMULA_SUB, csg_formula_constant(&terms, 2), x);
    csg_formula_id f = csg_formula_apply(&terms, CSG_FORMULA_ADD,
                                         csg_formula_apply(&terms, CSG_FORMULA_MUL, x, rest), y);
    csg_formula_step *steps = csg_memory_alloc(memory, terms.count * sizeof *steps);
    uint32_t steps_count = csg_formula_collect(&terms, f, steps);
    double values[2];
    assert_true(csg_formula_values(memory, steps, steps_count, box, values));
    assert_true(values[0] <= -5 && values[0] > -5.7 && values[1] >= 2 && values[1] < 2.7);
    assert_true(csg_formula_values(memory, steps, steps_count, csg_box_all(), values));
    assert_true(values[0] == -INFINITY && values[1] == INFINITY);
    csg_memory_release(memory, steps, terms.count * sizeof *steps);
    csg_formula_end(&terms);
}

static void expect_refusal(const char *scene, const char *message)
{
    assert_int_not_equal(bench_compile_bytes(&b, scene, strlen(scene), NULL), CSGM_OK);
    if (!strstr(b.text, message))
        print_error("%s\n%s", scene, b.text);
    assert_non_null(strstr(b.text, message));
}

static void what_is_no_radius_is_refused(void **state)
{
    (void)state;
    expect_refusal("union(blend = function (p) p.x) { sphere(2); cube(2); }",
                   "the blend's radius may fall to -2.25 in the box of the solids");
    expect_refusal("union(blend = function (p) 1 / p.x) { sphere(2); cube(2); }",
                   "cannot be told in the box of the solids");
    expect_refusal("union(blend = function (p) 1 + p.x * p.x) { sphere(2); plane(); }",
                   "cannot be told in all of space");
    expect_refusal("union(blend = function (p) \"a\") { sphere(2); cube(2); }",
                   "it must give a number");
    expect_refusal("linear_extrude(1) union(blend = function (p) 1) { circle(2); square(2); }",
                   "not between figures");
}

/* No radius: the sharp operator, with its gradient. */
static void no_radius_is_sharp(void **state)
{
    (void)state;
    const char *scene = "union(blend = function (p) 0 * p.x) { sphere(2);"
                        " translate([3, 0, 0]) sphere(2); }";
    assert_int_equal(bench_compile_bytes(&b, scene, strlen(scene), NULL), CSGM_OK);
    csg_sample s = sample(csg_vec3_make(1, 0, 0));
    assert_true(s.value == 1 && s.gradient.x == -1 && s.gradient.y == 0);
}

static csgm_status attempt(bench *poor)
{
    static const char scene[] = "difference(blend = function (p) 2 + p.x * 3) { sphere(0.5);"
                                " sphere(0.4); union() { } cube(0.3); }";
    return bench_compile_bytes(poor, scene, sizeof scene - 1, NULL);
}

static void any_allocation_may_fail(void **state)
{
    (void)state;
    assert_true(bench_fail_every(attempt, 80, 12) > 60);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_radii_keep_their_promises), cmocka_unit_test(no_radius_is_sharp),
        cmocka_unit_test(any_allocation_may_fail),          cmocka_unit_test(values_are_enclosed),
        cmocka_unit_test(what_is_no_radius_is_refused),
    };
    if (argc > 1)
        count = (uint32_t)strtoul(argv[1], NULL, 10);
    if (argc > 2)
        first_seed = strtoull(argv[2], NULL, 10);
    return cmocka_run_group_tests(tests, open_bench, close_bench);
}
