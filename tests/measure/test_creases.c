/* SPDX-License-Identifier: MIT
 * Creases under blends: Taylor models of fields in which a solid with creases takes part. Boxes of
 * all thicknesses, and solids joined sharply, blended with another solid: models hold the field's
 * values and gradients, and cubes have the integrals and areas of their parts.
 */
#include <inttypes.h>

#include "measure/enclosure.h"
#include "measure/graph_field.h"
#include "measure/graph_support.h"
#include "mesh/mesh_support.h"
#include "scene/operators/blend_kinds.h"
#include "scene/primitives/kinds.h"

enum { CUBES = 200, POINTS = 24 };

static uint64_t seed; /* of the scene */

typedef struct tally {
    uint32_t pieces, values, gradients, volumes, areas;
} tally;

static bool find_pieces(const void *user, const double c[3], double half, csg_taylor_pieces *out)
{
    const mesh_case *m = user;
    return csg_graph_field_pieces(&m->field->tape, c, half, out);
}

static double length_of_difference(const double a[3], csg_vec3 b)
{
    return csg_vec3_norm(csg_vec3_sub(csg_vec3_make(a[0], a[1], a[2]), b));
}

/* Where a piece is the field it has its value and its gradient; some piece may be it everywhere. */
static void try_points(const mesh_case *m, csg_random *random, const csg_taylor_pieces *f,
                       const double c[3], double half, bool has_gradients, tally *seen)
{
    static const double OF_VALUES = 1e-12, OF_GRADIENTS = 1e-9;
    csg_vec3 center = csg_vec3_add(m->field->center, csg_vec3_make(c[0], c[1], c[2]));
    for (int i = 0; i < POINTS; i++) {
        const double x[3] = {csg_random_uniform(random, -half, half),
                             csg_random_uniform(random, -half, half),
                             csg_random_uniform(random, -half, half)};
        csg_sample s = test_sample(m->scene, csg_vec3_add(center, csg_vec3_make(x[0], x[1], x[2])));
        bool any = false;
        for (int n = 0; n < f->count; n++) {
            const csg_taylor *g = &f->of[n].f;
            int there = graph_is_there(&f->of[n], x);
            any |= there >= 0;
            if (there <= 0)
                continue;
            double off = fabs(graph_polynomial_at(g, x) - s.value), room = graph_room_at(g, x);
            if (off > room + OF_VALUES)
                fail_msg("seed %" PRIu64 ": a value is %g off, %g is promised, in piece %d of %d, "
                         "in a cube of half %g",
                         seed, off, room, n, f->count, half);
            double gradient[3], turn = graph_turn_at(g, x);
            graph_gradient_at(g, x, gradient);
            off = length_of_difference(gradient, s.gradient);
            if (has_gradients && off > turn + OF_GRADIENTS)
                fail_msg("seed %" PRIu64 ": a gradient is %g off, %g is promised, in piece %d of "
                         "%d, in a cube of half %g",
                         seed, off, turn, n, f->count, half);
            seen->values += room < 0.1 * half;
            seen->gradients += has_gradients && turn < 0.5;
        }
        if (!any)
            fail_msg("seed %" PRIu64 ": there is no piece at a point in a cube of half %g", seed,
                     half);
    }
}

/* Cubes near the surface, centres and halves exact as floats. */
static void try_scene(const mesh_case *m, csg_random *random, bool has_gradients, tally *seen)
{
    const graph_field field = {find_pieces, m, seed};
    csg_box b = m->field->bounds;
    for (int i = 0; i < CUBES; i++) {
        double half = ldexp(1, -3 - (int)csg_random_below(random, 6)), c[3];
        csg_vec3 p = csg_vec3_make(csg_random_uniform(random, b.min.x, b.max.x),
                                   csg_random_uniform(random, b.min.y, b.max.y),
                                   csg_random_uniform(random, b.min.z, b.max.z));
        csg_taylor_pieces f;
        p = csg_vec3_sub(test_towards_surface(m->scene, p, 4), m->field->center);
        c[0] = half * round(p.x / half);
        c[1] = half * round(p.y / half);
        c[2] = half * round(p.z / half);
        if (!find_pieces(m, c, half, &f))
            continue;
        seen->pieces += f.count > 1;
        try_points(m, random, &f, c, half, has_gradients, seen);
        if (i % 4 || !(f.count > 1 || f.of[0].f.turned > 1e-3))
            continue;
        seen->volumes += graph_try_integrals(&field, c, half);
        seen->areas += graph_try_area(&field, c, half);
    }
}

/* Half of them without any rounding, half of them thin: the middle between two faces, or between
 * all of them, is near the blend. */
static csg_node_id random_box(mesh_case *m, csg_random *random)
{
    double v[4];
    double least = INFINITY;
    for (int k = 0; k < 3; k++) {
        v[k] = csg_random_uniform(random, 0.4, 1);
        v[k] *= k == 0 && csg_random_below(random, 2) ? 0.25 : 1;
        least = fmin(least, v[k]);
    }
    v[3] = csg_random_below(random, 2) ? least * csg_random_uniform(random, 0.1, 0.99) : 0;
    return csg_build_primitive(&m->builder, CSG_NODE_BOX, v, NOWHERE);
}

static csg_node_id random_other(mesh_case *m, csg_random *random)
{
    static const int KINDS[] = {0, 2, 4, 6};
    return make_any_primitive(m, KINDS[csg_random_below(random, 4)], random);
}

/* Blended with a small ball that is mostly far away, so that not the sign alone of what is tried
 * matters. */
static void try_solid(mesh_case *m, csg_node_id solid, csg_random *random, bool has_gradients,
                      tally *seen)
{
    csg_node_id ball = posed_anyhow(m, make_sphere(m, 0.2), random);
    const csg_blend blend = {CSG_BLEND_PARABOLA, 0.1, false};
    mesh_case_compile(m, joined(m, CSG_NODE_UNION, blend, solid, ball));
    try_scene(m, random, has_gradients, seen);
}

static const csg_blend_kind KINDS[] = {CSG_BLEND_ROUND, CSG_BLEND_PARABOLA, CSG_BLEND_HYPERBOLA,
                                       CSG_BLEND_FILLET};
enum { KIND_COUNT = 4 };
static const csg_node_kind JOINS[] = {CSG_NODE_UNION, CSG_NODE_DIFFERENCE, CSG_NODE_INTERSECTION};

static void try_box(uint64_t n, tally *seen)
{
    csg_random random = {.state = seed = 41000 + n};
    const csg_blend blend = {KINDS[n % KIND_COUNT], csg_random_uniform(&random, 0.1, 0.6), false};
    mesh_case m;
    mesh_case_begin(&m, 1);
    csg_node_id box = posed_anyhow(&m, random_box(&m, &random), &random);
    csg_node_id other = posed_anyhow(&m, random_other(&m, &random), &random);
    csg_node_id solid = joined(&m, JOINS[n % 3], blend, box, other);
    try_solid(&m, solid, &random, blend.kind != CSG_BLEND_FILLET, seen);
    mesh_case_end(&m);
}

static void boxes_hold(void **state)
{
    tally seen = {0};
    for (uint64_t i = 0; i < ROUNDS(40) * test_times; i++)
        try_box(test_first_seed + i, &seen);
    assert_true(seen.pieces > ROUNDS(1000) * test_times &&
                seen.values > ROUNDS(60000) * test_times);
    assert_true(seen.gradients > ROUNDS(50000) * test_times);
    assert_true(seen.volumes > ROUNDS(100) * test_times && seen.areas > ROUNDS(25) * test_times);
}

/* In one cube of it a piece whose own error is large in one place and small in the mean shares
 * columns with one that has none there. */
static void columns_of_several_pieces_hold(void **state)
{
    tally seen = {0};
    try_box(60000253, &seen);
}

/* Two solids joined sharply, blended with a third. */
static void joins_hold(void **state)
{
    tally seen = {0};
    for (uint64_t i = 0; i < ROUNDS(40) * test_times; i++) {
        csg_random random = {.state = seed = 43000 + test_first_seed + i};
        const csg_blend blend = {KINDS[i % KIND_COUNT], csg_random_uniform(&random, 0.1, 0.6),
                                 false};
        csg_node_id ids[3];
        mesh_case m;
        mesh_case_begin(&m, 1);
        for (int k = 0; k < 3; k++) {
            ids[k] = k ? random_other(&m, &random) : random_box(&m, &random);
            ids[k] = posed_anyhow(&m, ids[k], &random);
        }
        csg_node_id creased = joined(&m, JOINS[i / 4 % 3], SHARP, ids[0], ids[1]);
        csg_node_id solid = joined(&m, JOINS[i % 3], blend, creased, ids[2]);
        try_solid(&m, solid, &random, blend.kind != CSG_BLEND_FILLET, &seen);
        mesh_case_end(&m);
    }
    assert_true(seen.pieces > ROUNDS(1000) * test_times &&
                seen.values > ROUNDS(60000) * test_times);
    assert_true(seen.gradients > ROUNDS(50000) * test_times);
    assert_true(seen.volumes > ROUNDS(130) * test_times && seen.areas > ROUNDS(30) * test_times);
}

/* Operands of a fillet that do not meet have no say in how others blend. */
static void fillets_with_operands_apart_have_models(void **state)
{
    static const double CENTRE[3] = {2, 0, 1}, HALF = 1.0 / 64;
    const csg_blend fillet = {CSG_BLEND_FILLET, 0.5, false};
    csg_taylor_pieces f;
    mesh_case m;
    mesh_case_begin(&m, 1);
    csg_node_id ids[] = {make_box(&m, 4, 4, 1), moved(&m, make_box(&m, 4, 4, 1), 0, 0, 9),
                         make_cylinder(&m, 2, 9)};
    mesh_case_compile(&m, csg_build_operator(&m.builder, CSG_NODE_UNION, fillet, ids, 3, NOWHERE));
    graph_take_numbers(&m);
    const csg_vec3 o = m.field->center;
    const double c[3] = {CENTRE[0] + 0.2 - o.x, CENTRE[1] - o.y, CENTRE[2] + 0.2 - o.z};
    assert_true(csg_tape_taylor_pieces(&m.field->tape, c, csg_enclosure_radius(HALF), &f));
    mesh_case_end(&m);
}

/* A cube where the nearer face of a box changes, 0.1 inside, and a plane is at different angles to
 * them, that far beyond: the number of its models, 0: none. */
static int count_models(csg_blend blend, double beyond)
{
    static const double CENTRE[3] = {0.9, 0.9, 0}, HALF = 1.0 / 64;
    csg_taylor_pieces f;
    mesh_case m;
    mesh_case_begin(&m, 1);
    csg_node_id box = make_box(&m, 1, 1, 1);
    csg_node_id plane = make_half_space(&m, 0.8, 0.6, 0, 1.36 + beyond);
    mesh_case_compile(&m, joined(&m, CSG_NODE_INTERSECTION, blend, box, plane));
    graph_take_numbers(&m);
    const csg_vec3 o = m.field->center;
    const double c[3] = {CENTRE[0] - o.x, CENTRE[1] - o.y, CENTRE[2] - o.z};
    double radius = csg_enclosure_radius(HALF);
    int count = csg_tape_taylor_pieces(&m.field->tape, c, radius, &f) ? f.count : 0;
    mesh_case_end(&m);
    return count;
}

/* A fillet turns on the angle between its operands' gradients, so its field jumps where that does:
 * no pieces tell of it how large the surface is. A round does not. */
static void blending_fillets_of_creases_have_no_models(void **state)
{
    assert_int_equal(count_models((csg_blend){CSG_BLEND_FILLET, 0.5, false}, 0), 0);
    assert_true(count_models((csg_blend){CSG_BLEND_FILLET, 0.5, false}, 0.5) >
                1); /* nothing blends */
    assert_true(count_models((csg_blend){CSG_BLEND_ROUND, 0.5, false}, 0) > 1);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_hold),
        cmocka_unit_test(joins_hold),
        cmocka_unit_test(blending_fillets_of_creases_have_no_models),
        cmocka_unit_test(columns_of_several_pieces_hold),
        cmocka_unit_test(fillets_with_operands_apart_have_models),
    };
    test_take_search(argc, argv);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
