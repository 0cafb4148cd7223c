/* SPDX-License-Identifier: MIT
 * Taylor models of tapes hold what they promise: in random cubes of random scenes points that a
 * model has inside are inside by the reference, points just beyond its rooms, too. And graphs: of
 * random polynomials the volume below them and their areas on faces are within the errors of what
 * columns add up to.
 */
#include <inttypes.h>
#include <stdlib.h>

#include "field/taylor/tape_taylor.h"
#include "measure/enclosure.h"
#include "measure/graph.h"
#include "mesh/mesh_support.h"
#include "scene/operators/blend_kinds.h"
#include "scene/primitives/kinds.h"
#include "scene/warp_kinds.h"

enum { CUBES = 150, POINTS = 40 };

static double polynomial_at(const csg_taylor *f, const double x[3])
{
    const double *b = f->bend;
    return f->value + f->slope[0] * x[0] + f->slope[1] * x[1] + f->slope[2] * x[2] +
           0.5 * (b[0] * x[0] * x[0] + b[1] * x[1] * x[1] + b[2] * x[2] * x[2]) +
           b[3] * x[0] * x[1] + b[4] * x[0] * x[2] + b[5] * x[1] * x[2];
}

static double room_at(const csg_taylor *f, const double x[3])
{
    double square = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
    return f->error + f->cubic * square * sqrt(square);
}

/* The reference leaves out of a fillet's gradient how its operands' own turn: differences tell. */
static bool has_fillets;
static uint64_t seed; /* of the scene */

typedef struct tally {
    uint32_t known, bent, near, turned;
} tally;

/* Along the slope from a random point to where the polynomial is its room and a little more, or as
 * much less. */
static bool find_edge(const csg_taylor *f, csg_random *random, double half, int side, double x[3])
{
    static const double BEYOND = 1e-11;
    double square = 0;
    for (int k = 0; k < 3; k++) {
        x[k] = csg_random_uniform(random, -half, half);
        square += f->slope[k] * f->slope[k];
    }
    for (int i = 0; i < 30; i++) {
        double off = polynomial_at(f, x) - side * (room_at(f, x) + BEYOND);
        for (int k = 0; k < 3; k++)
            x[k] -= off / square * f->slope[k];
    }
    double over = side * polynomial_at(f, x) - room_at(f, x);
    return square > 0.01 && over > 0 && over < 2 * BEYOND &&
           fmax(fabs(x[0]), fmax(fabs(x[1]), fabs(x[2]))) <= half;
}

static void try_cube(const mesh_case *m, csg_random *random, const double c[3], double half,
                     tally *seen)
{
    csg_taylor f;
    if (!csg_tape_taylor(&m->field->tape, c, csg_enclosure_radius(half), &f))
        return;
    csg_vec3 center = csg_vec3_add(m->field->center, csg_vec3_make(c[0], c[1], c[2]));
    seen->known++;
    seen->bent += f.cubic > 0;
    for (int i = 0; i < POINTS; i++) {
        int side = i & 1 ? 1 : -1;
        double x[3];
        if (i % 4 < 2) {
            for (int k = 0; k < 3; k++)
                x[k] = csg_random_uniform(random, -half, half);
            double over = polynomial_at(&f, x);
            side = over > room_at(&f, x) ? 1 : over < -room_at(&f, x) ? -1 : 0;
        } else if (!find_edge(&f, random, half, side, x)) {
            continue;
        } else {
            seen->near++;
        }
        csg_vec3 p = csg_vec3_add(center, csg_vec3_make(x[0], x[1], x[2]));
        double value = test_sample(m->scene, p).value;
        if (side * value < 0)
            fail_msg("seed %" PRIu64 ": f = %g at (%.9g, %.9g, %.9g), called %s by the room of %g, "
                     "in a cube of half %g",
                     seed, value, p.x, p.y, p.z, side > 0 ? "inside" : "outside", room_at(&f, x),
                     half);
    }
}

static void gradient_at(const csg_taylor *f, const double x[3], double out[3])
{
    static const int AT[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
    for (int i = 0; i < 3; i++) {
        out[i] = f->slope[i];
        for (int k = 0; k < 3; k++)
            out[i] += f->bend[AT[i][k]] * x[k];
    }
}

static csg_vec3 gradient_of(const mesh_case *m, csg_vec3 p)
{
    static const double STEP = 1e-5;
    double g[3];
    if (!has_fillets)
        return test_sample(m->scene, p).gradient;
    for (int k = 0; k < 3; k++) {
        const csg_vec3 e = csg_vec3_make(STEP * (k == 0), STEP * (k == 1), STEP * (k == 2));
        g[k] = (test_sample(m->scene, csg_vec3_add(p, e)).value -
                test_sample(m->scene, csg_vec3_sub(p, e)).value) /
               (2 * STEP);
    }
    return csg_vec3_make(g[0], g[1], g[2]);
}

/* On the surface in the cube: gradients are where they are promised. */
static void try_gradients(const mesh_case *m, csg_random *random, const double c[3], double half,
                          tally *seen)
{
    csg_taylor f;
    if (!csg_tape_taylor(&m->field->tape, c, csg_enclosure_radius(half), &f))
        return;
    csg_vec3 center = csg_vec3_add(m->field->center, csg_vec3_make(c[0], c[1], c[2]));
    for (int i = 0; i < POINTS / 4; i++) {
        csg_vec3 d = csg_vec3_make(csg_random_uniform(random, -half, half),
                                   csg_random_uniform(random, -half, half),
                                   csg_random_uniform(random, -half, half));
        csg_vec3 on = test_towards_surface(m->scene, csg_vec3_add(center, d), 6);
        csg_vec3 gradient = gradient_of(m, on);
        d = csg_vec3_sub(on, center);
        const double x[3] = {d.x, d.y, d.z}, g[3] = {gradient.x, gradient.y, gradient.z};
        double promised[3], off = 0, square = csg_vec3_dot(d, d);
        if (!(fmax(fabs(d.x), fmax(fabs(d.y), fabs(d.z))) <= half &&
              fabs(test_sample(m->scene, on).value) < 1e-12))
            continue;
        gradient_at(&f, x, promised);
        for (int k = 0; k < 3; k++)
            off += (g[k] - promised[k]) * (g[k] - promised[k]);
        if (sqrt(off) > f.turned + f.twice * square + (has_fillets ? 1e-7 : 1e-9))
            fail_msg("seed %" PRIu64 ": a gradient is %g off, %g is promised, in a cube of half %g",
                     seed, sqrt(off), f.turned + f.twice * square, half);
        assert_true(f.turned + f.twice * square < 1e-9 + csg_taylor_stray(&f, 2 * half));
        seen->turned++;
    }
}

/* Cubes near the surface, centres and halves exact as floats. */
static void try_scene(const mesh_case *m, csg_random *random, tally *seen)
{
    csg_box b = m->field->bounds;
    if (!csg_box_is_finite(b) || csg_box_is_empty(b))
        return;
    for (int i = 0; i < CUBES; i++) {
        double half = ldexp(1, -2 - (int)csg_random_below(random, 8)), c[3];
        csg_vec3 p = csg_vec3_make(csg_random_uniform(random, b.min.x, b.max.x),
                                   csg_random_uniform(random, b.min.y, b.max.y),
                                   csg_random_uniform(random, b.min.z, b.max.z));
        p = csg_vec3_sub(test_towards_surface(m->scene, p, 4), m->field->center);
        c[0] = half * round(p.x / half);
        c[1] = half * round(p.y / half);
        c[2] = half * round(p.z / half);
        try_cube(m, random, c, half, seen);
        try_gradients(m, random, c, half, seen);
    }
}

static void models_hold(void **state)
{
    tally seen = {0};
    for (uint64_t i = 0; i < 80 * test_times; i++) {
        csg_random random = {.state = seed = 31000 + test_first_seed + i};
        mesh_case m;
        mesh_case_begin(&m, 1);
        test_random_shapes = test_random_curves = false;
        test_random_rules = i % 8 == 2;
        test_random_fillets = has_fillets = i % 4 == 3;
        csg_node_id root = test_random_scene(&m.builder, &random, 1 + (unsigned)(i % 4));
        assert_true(root != CSG_NODE_NONE);
        mesh_case_compile(&m, root);
        try_scene(&m, &random, &seen);
        mesh_case_end(&m);
    }
    assert_true(seen.known > 1000 * test_times && seen.bent > 500 * test_times);
    assert_true(seen.near > 5000 * test_times && seen.turned > 1000 * test_times);
}

/* Two of every kind of primitive, turned, with a blend that the models know. */
static void blends_hold(void **state)
{
    static const csg_blend_kind KINDS[] = {CSG_BLEND_ROUND, CSG_BLEND_FILLET, CSG_BLEND_PARABOLA,
                                           CSG_BLEND_HYPERBOLA, CSG_BLEND_SHARP};
    static const csg_node_kind JOINS[] = {CSG_NODE_UNION, CSG_NODE_DIFFERENCE,
                                          CSG_NODE_INTERSECTION};
    tally seen = {0};
    for (uint64_t i = 0; i < 120 * test_times; i++) {
        csg_random random = {.state = seed = 33000 + test_first_seed + i};
        csg_node_id ids[2];
        mesh_case m;
        mesh_case_begin(&m, 1);
        for (int k = 0; k < 2; k++) {
            double v[CSG_PRIMITIVE_MOST_PARAMETERS] = {0};
            static const uint32_t OF[] = {CSG_NODE_SPHERE, CSG_NODE_BOX, CSG_NODE_FRUSTUM,
                                          CSG_NODE_CAPSULE, CSG_NODE_TORUS};
            csg_primitive_kind kind = (csg_primitive_kind)OF[csg_random_below(&random, 5)];
            csg_primitive_of(kind)->example(&random, v);
            ids[k] = posed_anyhow(&m, csg_build_primitive(&m.builder, kind, v, NOWHERE), &random);
        }
        has_fillets = KINDS[i % 5] == CSG_BLEND_FILLET;
        csg_blend blend = {KINDS[i % 5], csg_random_uniform(&random, 0.05, 0.4)};
        mesh_case_compile(&m, joined(&m, JOINS[i % 3], blend, ids[0], ids[1]));
        try_scene(&m, &random, &seen);
        mesh_case_end(&m);
    }
    assert_true(seen.known > 5000 * test_times && seen.near > 30000 * test_times);
    assert_true(seen.turned > 10000 * test_times);
}

/* Figures turned about an axis or along an elbow, posed. */
static void warps_hold(void **state)
{
    tally seen = {0};
    has_fillets = false;
    for (uint64_t i = 0; i < 40 * test_times; i++) {
        csg_random random = {.state = seed = 35000 + test_first_seed + i};
        double v[CSG_PRIMITIVE_MOST_PARAMETERS] = {0};
        csg_primitive_kind kind = i % 2 ? CSG_NODE_CIRCLE : CSG_NODE_RECTANGLE;
        csg_affine lie =
            csg_affine_rotate(csg_random_uniform(&random, -180, 180), csg_vec3_make(0, 0, 1));
        csg_warp warp = {.kind = i % 4 < 2 ? CSG_WARP_REVOLVE : CSG_WARP_ELBOW,
                         .parameters = {csg_random_uniform(&random, 5, 85)}};
        mesh_case m;
        mesh_case_begin(&m, 1);
        csg_primitive_of(kind)->example(&random, v);
        lie = csg_affine_multiply(csg_affine_translate(csg_vec3_make(2.5, 0.3, 0)), lie);
        csg_node_id node = csg_build_primitive(&m.builder, kind, v, NOWHERE);
        node = csg_build_transform(&m.builder, &lie, node, NOWHERE);
        node = csg_build_warp(&m.builder, &warp, node, NOWHERE);
        if (warp.kind == CSG_WARP_ELBOW)
            node = csg_build_cut(&m.builder, node, (csg_box){{-3, -4, -4}, {6, 4, 4}}, NOWHERE);
        mesh_case_compile(&m, posed_anyhow(&m, node, &random));
        try_scene(&m, &random, &seen);
        mesh_case_end(&m);
    }
    assert_true(seen.known > 1500 * test_times && seen.near > 8000 * test_times);
    assert_true(seen.turned > 3000 * test_times);
}

/* ---- graphs ------------------------------------------------------------------------------------
 */

static csg_taylor random_polynomial(csg_random *random, double half)
{
    csg_taylor f = {.value = half * csg_random_uniform(random, -1, 1)};
    double bent = exp(csg_random_uniform(random, -6, -1)) / half;
    for (int k = 0; k < 3; k++)
        f.slope[k] = csg_random_uniform(random, -1, 1);
    for (int n = 0; n < 6; n++)
        f.bend[n] = csg_random_uniform(random, -bent, bent);
    return f;
}

/* How much of the segment from a to b the polynomial is positive on, as a share. */
static double share_of(const csg_taylor *f, const double a[3], const double b[3])
{
    double x[3], v[3]; /* at 0, 1/2, 1: a parabola */
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            x[k] = a[k] + 0.5 * i * (b[k] - a[k]);
        v[i] = polynomial_at(f, x);
    }
    double square = 2 * (v[0] - 2 * v[1] + v[2]), line = v[2] - v[0] - square;
    double roots[4] = {0, 1, 0, 0}, under = line * line - 4 * square * v[0];
    if (under > 0) {
        double q = -0.5 * (line + copysign(sqrt(under), line));
        roots[2] = fmin(fmax(q / square, 0), 1);
        roots[3] = fmin(fmax(v[0] / q, 0), 1);
    }
    double least = fmin(roots[2], roots[3]), most = fmax(roots[2], roots[3]), sum = 0;
    const double ends[4] = {0, isfinite(least) ? least : 0, isfinite(most) ? most : 0, 1};
    for (int i = 0; i < 3; i++) {
        double t = 0.5 * (ends[i] + ends[i + 1]);
        if ((square * t + line) * t + v[0] > 0)
            sum += ends[i + 1] - ends[i];
    }
    return sum;
}

/* By columns along an axis; axes: 2 of the cube, 1 of its face. */
static double columns_of(const csg_taylor *f, double half, int along, int face, double at)
{
    enum { SIDE = 160 };
    double sum = 0;
    int i = (along + 1) % 3, k = (along + 2) % 3;
    for (int a = 0; a < SIDE; a++)
        for (int b = 0; b < (face < 0 ? SIDE : 1); b++) {
            double from[3], to[3];
            from[i] = half * ((2 * a + 1.0) / SIDE - 1);
            from[k] = half * ((2 * b + 1.0) / SIDE - 1);
            if (face >= 0) {
                from[face == i ? k : i] = half * ((2 * a + 1.0) / SIDE - 1);
                from[face] = at;
            }
            from[along] = -half;
            to[i] = from[i];
            to[k] = from[k];
            to[along] = half;
            sum += share_of(f, from, to) / (face < 0 ? SIDE * SIDE : SIDE);
        }
    return sum * (face < 0 ? 8 * half * half * half : 4 * half * half);
}

/* The integral over the surface in the cube of 1 - the cosine with the plane's normal. */
static double excess_of(const csg_taylor *f, double half, int along)
{
    enum { SIDE = 160 };
    int i = (along + 1) % 3, k = (along + 2) % 3;
    double sum = 0, slope = sqrt(f->slope[0] * f->slope[0] + f->slope[1] * f->slope[1] +
                                 f->slope[2] * f->slope[2]);
    for (int n = 0; n < SIDE * SIDE; n++) {
        double x[3], g[3], length = 0, with = 0;
        x[i] = half * ((2 * (n % SIDE) + 1.0) / SIDE - 1);
        x[k] = half * ((2 * (n / SIDE) + 1.0) / SIDE - 1);
        x[along] = 0;
        for (int step = 0; step < 8; step++) {
            gradient_at(f, x, g);
            x[along] -= polynomial_at(f, x) / g[along];
        }
        if (!(fabs(x[along]) < half && fabs(polynomial_at(f, x)) < 1e-9 * half))
            continue;
        gradient_at(f, x, g);
        for (int a = 0; a < 3; a++) {
            length += g[a] * g[a];
            with += g[a] * f->slope[a] / slope;
        }
        sum += (sqrt(length) - with) / fabs(g[along]);
    }
    return sum * 4 * half * half / (SIDE * SIDE);
}

static int steepest_but(const csg_taylor *f, int but)
{
    int up = but == 0;
    for (int k = 0; k < 3; k++)
        up = k != but && fabs(f->slope[k]) > fabs(f->slope[up]) ? k : up;
    return up;
}

static void graphs_hold(void **state)
{
    uint32_t known = 0, faces = 0, tight = 0, narrow = 0;
    for (uint64_t i = 0; i < 500 * test_times; i++) {
        csg_random random = {.state = 35000 + test_first_seed + i};
        double half = exp(csg_random_uniform(&random, -3, 3)), area, error;
        csg_taylor f = random_polynomial(&random, half);
        csg_graph graph;
        if (csg_graph_find(&f, half, &graph)) {
            double whole = 8 * half * half * half;
            double wanted = columns_of(&f, half, steepest_but(&f, -1), -1, 0);
            double off = fabs(graph.volume - wanted), moved = wanted - graph.plane[0];
            if (off > graph.error + 2e-5 * whole)
                fail_msg("seed %d: %g off, %g promised, of %g", (int)i, off, graph.error, whole);
            assert_true(moved <= graph.gained + 2e-5 * whole);
            assert_true(moved >= -graph.lost - 2e-5 * whole);
            double excess = excess_of(&f, half, steepest_but(&f, -1)), least, most;
            assert_true(csg_graph_excess(&f, half, &least, &most));
            if (excess > most + 1e-4 * half * half || excess < least - 1e-4 * half * half)
                fail_msg("seed %d: an area's excess of %g, %g to %g promised", (int)i, excess,
                         least, most);
            narrow += most - least < 0.2 * most;
            tight += graph.error < 1e-3 * whole;
            known++;
        }
        int axis = (int)(i % 3), side = i % 2 ? 1 : -1;
        if (csg_graph_face(&f, half, axis, side, &area, &error)) {
            csg_taylor moved = f;
            double wanted = columns_of(&moved, half, steepest_but(&f, axis), axis, side * half);
            if (fabs(area - wanted) > error + 1e-3 * half * half)
                fail_msg("seed %d: a face's area %g for %g, %g promised", (int)i, area, wanted,
                         error);
            faces++;
        }
    }
    assert_true(known > 300 * test_times && tight > 200 * test_times);
    assert_true(faces > 250 * test_times && narrow > 20 * test_times);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(models_hold),
        cmocka_unit_test(blends_hold),
        cmocka_unit_test(warps_hold),
        cmocka_unit_test(graphs_hold),
    };
    test_take_search(argc, argv);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
