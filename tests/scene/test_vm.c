/* SPDX-License-Identifier: MIT
 * Scenes as formulas and as .vm tapes: the same values as the reference, also after a tape was read
 * back; operations that only tapes have; tapes that are wrong.
 */
#include "scene/operators/blend_kinds.h"
#include "scene_fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "collected_text.h"
#include "random_blend.h"
#include "random_scene.h"
#include "scene/formula/formula.h"
#include "scene/formula/formulate.h"
#include "scene/formula/terms.h"
#include "scene/formula/vm.h"
#include "scene/primitives/kinds.h"
#include "scene/primitives/primitive.h"
#include "scene/reference.h"
#include "shape/polyhedra/polyhedron.h"
#include "star.h"

/* A finished formula. */
typedef struct finished {
    csg_formula_step *steps;
    csg_formula_dual *work;
    csg_formula formula;
    size_t room;
} finished;

static finished seal_formula(csg_terms *terms, csg_term result)
{
    finished f = {.room = terms->count};
    f.steps = calloc(f.room, sizeof *f.steps);
    f.work = calloc(f.room, sizeof *f.work);
    assert_true(f.steps && f.work);
    f.formula.bounds = csg_box_all();
    f.formula.count = csg_formula_collect(terms, result, f.steps);
    assert_true(f.formula.count > 0);
    return f;
}

static double value(const finished *f, csg_vec3 p)
{
    return csg_formula_evaluate(f->steps, &f->formula, p, f->work).value;
}

static void release(finished *f)
{
    free(f->steps);
    free(f->work);
}

static void check_close(double got, double wanted, csg_vec3 p, const char *what)
{
    if (!(fabs(got - wanted) <= 1e-6 * (1 + fabs(wanted))))
        fail_msg("%s at (%.9g, %.9g, %.9g): %.12g, not %.12g", what, p.x, p.y, p.z, got, wanted);
}

/* Takes the scene over. */
static void check_scene(csgm_scene *scene, csg_random *random, const char *what)
{
    csg_terms terms, read;
    csg_term result;
    csg_node_id obstacle = 0;
    csg_vm_problem problem;
    text tape = {0};
    csg_formula_begin(&terms, &context.memory);
    terms.most = 1u << 22;
    assert_int_equal(csg_formulate(scene, &terms, &result, &obstacle), CSGM_OK);
    finished direct = seal_formula(&terms, result);
    assert_int_equal(csg_vm_print(scene, collect, &tape), CSGM_OK);
    csg_formula_begin(&read, &context.memory);
    read.most = 1u << 22;
    csgm_status status = csg_vm_read(&read, tape.data, tape.length, &result, &problem);
    if (status != CSGM_OK)
        print_error("line %zu: %s\n", problem.line, problem.text);
    assert_int_equal(status, CSGM_OK);
    finished back = seal_formula(&read, result);
    for (int i = 0; i < 60; i++) {
        double reach = i % 3 ? 1.2 : 5;
        csg_vec3 p = csg_vec3_make(csg_random_uniform(random, -reach, reach),
                                   csg_random_uniform(random, -reach, reach),
                                   csg_random_uniform(random, -reach, reach));
        double wanted = csg_reference_eval(scene, p, &status).value;
        check_close(value(&direct, p), wanted, p, what);
        check_close(value(&back, p), wanted, p, what);
    }
    release(&direct);
    release(&back);
    free(tape.data);
    csg_formula_end(&terms);
    csg_formula_end(&read);
    csg_scene_destroy(scene);
    assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
}

static void test_primitives(void **state)
{
    csg_random random = {1};
    for (csg_primitive_kind kind = CSG_NODE_FIRST_PRIMITIVE; kind < CSG_NODE_PRIMITIVES_END; kind++)
        for (int i = 0; i < 60 && !csg_primitive_has(kind, CSG_TRAIT_CURVE); i++) /* chords only */
            check_scene(test_seal(&builder, test_random_primitive(&builder, &random, kind, NULL)),
                        &random, csg_node_kind_name(kind));
}

static void test_thin_ellipsoids(void **state)
{
    csg_random random = {2};
    for (int i = 0; i < 200; i++) {
        double axes[3];
        for (int k = 0; k < 3; k++)
            axes[k] = pow(10, csg_random_uniform(&random, -2, 0.5));
        if (i % 4 == 0)
            axes[1] = axes[2];
        check_scene(
            test_seal(&builder, csg_build_primitive(&builder, CSG_NODE_ELLIPSOID, axes, NOWHERE)),
            &random, "ellipsoid");
    }
}

static void test_blends(void **state)
{
    csg_random random = {3};
    for (int i = 0; i < 300; i++) {
        csg_node_id nodes[6];
        csg_blend_kind kind = (csg_blend_kind)(i % CSG_BLEND_FILLET);
        size_t count = 2 + csg_random_below(&random, 5);
        for (size_t k = 0; k < count; k++) {
            csg_affine place = test_random_affine(&random, 0.5, 1, 0.5);
            nodes[k] = csg_build_transform(
                &builder, &place, test_random_primitive(&builder, &random, CSG_NODE_BOX, NULL),
                NOWHERE);
        }
        csg_node_id node =
            csg_build_operator(&builder, CSG_NODE_UNION + (unsigned)(i % 3),
                               test_random_blend(&random, kind), nodes, count, NOWHERE);
        check_scene(test_seal(&builder, node), &random, csg_blend_name(kind));
    }
}

static void test_random_trees(void **state)
{
    test_random_shapes = true;
    for (uint64_t seed = 0; seed < 200; seed++) {
        csg_random random = {seed};
        csg_node_id node = test_random_scene(&builder, &random, 1 + (unsigned)seed % 12);
        check_scene(test_seal(&builder, node), &random, "a random scene");
    }
    test_random_shapes = false;
}

static double in_turn(int corner, csg_random *random)
{
    return corner % 2 ? 0.4 : 1;
}

static void test_regions(void **state)
{
    csg_random random = {4};
    csg_shape *star = test_star(&context.memory, 10, in_turn, &random);
    csg_node_id node = csg_build_shape(&builder, star, NOWHERE);
    check_scene(test_seal(&builder, csg_build_extrude(&builder, node, -0.5, 0.7, NOWHERE)), &random,
                "a star");
}

static csgm_scene *tetrahedra(unsigned count)
{
    static const uint32_t sides[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    csg_triangles triangles;
    csg_shape *shape = NULL;
    csg_triangles_init(&triangles, &context.memory);
    for (uint32_t k = 0; k < count; k++) {
        const csg_vec3 points[4] = {
            {3 * k, 0, 0}, {3 * k + 1, 0, 0.2}, {3 * k, 1, 0}, {3 * k, 0, 1}};
        for (int i = 0; i < 4; i++) {
            assert_true(csg_triangles_add_point(&triangles, points[i]));
            assert_true(csg_triangles_add(&triangles, 4 * k + sides[i][0], 4 * k + sides[i][1],
                                          4 * k + sides[i][2]));
        }
    }
    assert_int_equal(csg_polyhedron_create(&context.memory, &triangles, NULL, &shape), CSGM_OK);
    csg_triangles_release(&triangles);
    return test_seal(&builder, csg_build_shape(&builder, shape, NOWHERE));
}

static void test_polyhedra(void **state)
{
    csg_random random = {5};
    text tape = {0};
    check_scene(tetrahedra(1), &random, "a tetrahedron");
    csgm_scene *two = tetrahedra(2);
    assert_int_equal(csg_vm_print(two, collect, &tape), CSGM_ERR_UNSUPPORTED);
    assert_int_equal(context.diags.errors, 1);
    assert_null(tape.data);
    csg_scene_destroy(two);
    context.diags.errors = 0;
    assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
}

/* ---- tapes of others ---------------------------------------------------------------------------
 */

static csgm_status read_tape(const char *tape, finished *out, csg_vm_problem *problem)
{
    csg_terms terms;
    csg_term result;
    csg_formula_begin(&terms, &context.memory);
    csgm_status status = csg_vm_read(&terms, tape, strlen(tape), &result, problem);
    if (status == CSGM_OK)
        *out = seal_formula(&terms, result);
    csg_formula_end(&terms);
    return status;
}

static void test_operations(void **state)
{
    static const struct {
        const char *tape;
        double at[3], wanted; /* of the tape itself: negative inside */
    } rows[] = {
        {"a var-x\nb square a", {3, 0, 0}, 9},
        {"# a comment\n\n  0x10\tvar-y \r\n0x20 recip 0x10\r\n", {0, 4, 0}, 0.25},
        {"a var-x\nb sin a", {2, 0, 0}, 0.90929742682568171},
        {"a var-x\nb cos a\nc const 1e0\nd add b c", {2, 0, 0}, 0.58385316345285764},
        {"a var-x\nb atan a", {2, 0, 0}, 1.1071487177940904},
        {"a var-x\nb var-y\nc atan2 a b", {1, -2, 0}, 2.677945044588987},
        {"a var-x\nb ceil a", {1.2, 0, 0}, 2},
        {"a var-x\nb round a", {1.7, 0, 0}, 2},
        {"a var-x\nb floor a", {-1.2, 0, 0}, -2},
        {"a var-x\nb not a", {0, 0, 0}, 1},
        {"a var-x\nb not a", {0.1, 0, 0}, 0},
        {"a var-x\nb var-y\nc compare a b", {1, 2, 0}, -1},
        {"a var-x\nb var-y\nc compare a b", {2, 1, 0}, 1},
        {"a var-x\nb var-y\nc compare a b", {2, 2, 0}, 0},
        {"a var-x\nb var-y\nc and a b", {2, 5, 0}, 5},
        {"a var-x\nb var-y\nc and a b", {0, 5, 0}, 0},
        {"a var-x\nb var-y\nc or a b", {2, 5, 0}, 2},
        {"a var-x\nb var-y\nc or a b", {0, 5, 0}, 5},
        {"a var-x\nb const 3\nc mod a b", {7, 0, 0}, 1},
        {"a var-x\nb const 3\nc mod a b", {-7, 0, 0}, 2},
        {"a var-x\nb const -3\nc mod a b", {-7, 0, 0}, 2},
        {"a var-x\nb const 2.5\nc pow a b", {4, 0, 0}, 32},
        {"a var-x\nb const 3\nc nth-root a b", {-27, 0, 0}, -3},
        {"a var-x\nb const 2\nc nth-root a b", {49, 0, 0}, 7},
        {"a var-x\nb exp a\nc ln b\nd abs c\ne neg d\nf sqrt b\ng tan a\nh asin g\ni acos g\n"
         "j var-z\nk div j a\nl min k a\nm max l b\nn sub m j",
         {0.5, 0, 2},
         -0.35127872929987186},
    };
    finished f;
    csg_vm_problem problem;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        csgm_status status = read_tape(rows[i].tape, &f, &problem);
        if (status != CSGM_OK)
            print_error("%s: %zu %s\n", rows[i].tape, problem.line, problem.text);
        assert_int_equal(status, CSGM_OK);
        csg_vec3 p = {rows[i].at[0], rows[i].at[1], rows[i].at[2]};
        check_close(-value(&f, p), rows[i].wanted, p, rows[i].tape);
        release(&f);
    }
}

static void test_wrong_tapes(void **state)
{
    static const struct {
        const char *tape;
        size_t line;
        const char *says;
    } rows[] = {
        {"", 0, "it has no steps"},
        {"# nothing\n", 0, "it has no steps"},
        {"a\n", 1, "a line needs a name and an operation"},
        {"a var-x\n\nb cube a\n", 3, "there is no operation 'cube'"},
        {"a var-x\nb add a\n", 2, "add takes 2 operands, not 1"},
        {"a var-x\nb neg a a\n", 2, "neg takes 1 operand, not 2"},
        {"a var-x a a a\n", 1, "var-x takes 0 operands, not 3"},
        {"a neg b\nb var-x", 1, "no line above is named 'b'"},
        {"a neg a", 1, "no line above is named 'a'"},
        {"a var-x\na var-y", 2, "a line above is named 'a' too"},
        {"a const 1x", 1, "'1x' is no number"},
        {"a const 1e999", 1, "the number '1e999' is not finite"},
        {"a const nan", 1, "the number 'nan' is not finite"},
        {"a const "
         "00000000000000000000000000000000000000000000000000000000000000000000000000000001",
         1, "'0000000000000000000000000000000000000000' is no number"},
    };
    finished f;
    csg_vm_problem problem;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_int_equal(read_tape(rows[i].tape, &f, &problem), CSGM_ERR_FORMAT);
        assert_int_equal(problem.line, rows[i].line);
        assert_string_equal(problem.text, rows[i].says);
    }
}

/* More steps than formulas may have, and memory that runs out on the way. */
static void test_limits(void **state)
{
    enum { LINES = CSG_LONGEST_FORMULA + 10 };
    char *tape = malloc((size_t)LINES * 40);
    size_t length = (size_t)sprintf(tape, "v0 var-x\n");
    finished f;
    csg_vm_problem problem;
    for (int i = 1; i < LINES; i++)
        length += (size_t)sprintf(tape + length, "v%d %s v%d\n", i, i % 2 ? "sin" : "exp", i - 1);
    assert_int_equal(read_tape(tape, &f, &problem), CSGM_ERR_FORMAT);
    assert_true(problem.line > LINES / 3);
    assert_string_equal(problem.text, "it has more than 65536 operations");
    tape[length / 4] = '\0';
    *strrchr(tape, '\n') = '\0';
    uint64_t used = atomic_load(&context.memory.used_bytes);
    for (size_t more = 1000; more < 300000; more *= 2) {
        context.memory.limit_bytes = used + more;
        assert_int_equal(read_tape(tape, &f, &problem), CSGM_ERR_MEMORY);
        assert_int_equal(atomic_load(&context.memory.used_bytes), used);
    }
    free(tape);
}

static void test_no_memory(void **state)
{
    csg_random random = {6};
    test_random_shapes = true;
    csgm_scene *scene = test_seal(&builder, test_random_scene(&builder, &random, 8));
    test_random_shapes = false;
    uint64_t used = atomic_load(&context.memory.used_bytes), limit = context.memory.limit_bytes;
    csgm_status status = CSGM_ERR_MEMORY;
    int failures = 0;
    for (uint64_t more = 0; status != CSGM_OK; more += more / 8 + 500, failures++) {
        text tape = {0};
        context.memory.limit_bytes = used + more;
        status = csg_vm_print(scene, collect, &tape);
        assert_true(status == CSGM_OK || status == CSGM_ERR_MEMORY);
        assert_int_equal(atomic_load(&context.memory.used_bytes), used);
        free(tape.data);
    }
    assert_true(failures > 10);
    context.memory.limit_bytes = limit;
    context.diags.errors = 0;
    csg_scene_destroy(scene);
    assert_int_equal(csg_build_begin(&builder, &context), CSGM_OK);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, begin, end)
    const struct CMUnitTest tests[] = {
        TEST(test_primitives),   TEST(test_thin_ellipsoids), TEST(test_blends),
        TEST(test_random_trees), TEST(test_regions),         TEST(test_polyhedra),
        TEST(test_operations),   TEST(test_wrong_tapes),     TEST(test_limits),
        TEST(test_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
