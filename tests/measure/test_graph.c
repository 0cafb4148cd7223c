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
#include "measure/graph_field.h"
#include "measure/graph_support.h"
#include "mesh/mesh_support.h"
#include "scene/operators/blend_kinds.h"
#include "scene/primitives/kinds.h"
#include "scene/warp_kinds.h"

enum { CUBES = 150, POINTS = 40 };

/* The reference leaves out of a fillet's gradient how its operands' own turn: differences tell. */
static bool has_fillets;
static uint64_t seed; /* of the scene */

typedef struct tally {
    uint32_t known, bent, near, turned;
    uint32_t with_models;            /* cubes */
    uint32_t pieces, volumes, areas; /* where there are several */
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
        double off = graph_polynomial_at(f, x) - side * (graph_room_at(f, x) + BEYOND);
        for (int k = 0; k < 3; k++)
            x[k] -= off / square * f->slope[k];
    }
    double over = side * graph_polynomial_at(f, x) - graph_room_at(f, x);
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
    seen->bent += f.quartic > 0;
    for (int i = 0; i < POINTS; i++) {
        int side = i & 1 ? 1 : -1;
        double x[3];
        if (i % 4 < 2) {
            for (int k = 0; k < 3; k++)
                x[k] = csg_random_uniform(random, -half, half);
            double over = graph_polynomial_at(&f, x);
            side = over > graph_room_at(&f, x) ? 1 : over < -graph_room_at(&f, x) ? -1 : 0;
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
                     seed, value, p.x, p.y, p.z, side > 0 ? "inside" : "outside",
                     graph_room_at(&f, x), half);
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

/* On the surface in the cube: gradients are where they are promised, up to how steep the model is,
 * which may be of another function with the same sign. */
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
        double promised[3], off = 0, room = graph_turn_at(&f, x);
        if (!(fmax(fabs(d.x), fmax(fabs(d.y), fabs(d.z))) <= half &&
              fabs(test_sample(m->scene, on).value) < 1e-12))
            continue;
        graph_gradient_at(&f, x, promised);
        /* where little is promised, it may look back */
        double steep = fmax(csg_dot3(promised, g) / csg_dot3(g, g), 0);
        for (int k = 0; k < 3; k++)
            off += (steep * g[k] - promised[k]) * (steep * g[k] - promised[k]);
        if (sqrt(off) > room + (has_fillets ? 1e-7 : 1e-9))
            fail_msg("seed %" PRIu64 ": a gradient is %g off, %g is promised, in a cube of half %g",
                     seed, sqrt(off), room, half);
        assert_true(room < 1e-9 + csg_taylor_stray(&f, 2 * half));
        seen->turned++;
    }
}

/* Wherever a piece is the field it has its sign, and some piece may be it everywhere. */
static void try_pieces(const mesh_case *m, csg_random *random, const double c[3], double half,
                       tally *seen)
{
    csg_taylor_pieces f;
    if (!csg_graph_field_pieces(&m->field->tape, c, half, &f))
        return;
    seen->with_models++;
    if (f.count < 2)
        return;
    csg_vec3 center = csg_vec3_add(m->field->center, csg_vec3_make(c[0], c[1], c[2]));
    for (int i = 0; i < POINTS; i++) {
        const double x[3] = {csg_random_uniform(random, -half, half),
                             csg_random_uniform(random, -half, half),
                             csg_random_uniform(random, -half, half)};
        csg_vec3 p = csg_vec3_add(center, csg_vec3_make(x[0], x[1], x[2]));
        double value = test_sample(m->scene, p).value;
        bool any = false;
        for (int n = 0; n < f.count; n++) {
            double over = graph_polynomial_at(&f.of[n].f, x), room = graph_room_at(&f.of[n].f, x);
            int there = graph_is_there(&f.of[n], x);
            any |= there >= 0;
            if (there > 0 && fabs(over) > room && over * value < 0)
                fail_msg("seed %" PRIu64 ": f = %g at (%.9g, %.9g, %.9g), piece %d of %d has %g by "
                         "the room of %g, in a cube of half %g",
                         seed, value, p.x, p.y, p.z, n, f.count, over, room, half);
            seen->pieces += there > 0 && fabs(over) > room;
        }
        if (!any)
            fail_msg("seed %" PRIu64 ": no piece at (%.9g, %.9g, %.9g) in a cube of half %g", seed,
                     p.x, p.y, p.z, half);
    }
}

static bool find_of_scene(const void *user, const double c[3], double half, csg_taylor_pieces *out)
{
    const mesh_case *m = user;
    return csg_graph_field_pieces(&m->field->tape, c, half, out);
}

/* Of several pieces, by parts. */
static void try_solid_of_pieces(const mesh_case *m, const double c[3], double half, tally *seen)
{
    const graph_field f = {find_of_scene, m, seed};
    csg_taylor_pieces pieces;
    if (!find_of_scene(m, c, half, &pieces) || pieces.count < 2)
        return;
    seen->volumes += graph_try_integrals(&f, c, half);
    seen->areas += graph_try_area(&f, c, half);
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
        try_pieces(m, random, c, half, seen);
        if (i % 4 == 0)
            try_solid_of_pieces(m, c, half, seen);
    }
}

static void models_hold(void **state)
{
    tally seen = {0};
    for (uint64_t i = 0; i < ROUNDS(80) * test_times; i++) {
        csg_random random = {.state = seed = 31000 + test_first_seed + i};
        mesh_case m;
        mesh_case_begin(&m, 1);
        test_random_shapes = test_random_curves = false;
        test_random_rules = i % 8 == 2;
        test_random_fillets = has_fillets = i % 4 == 3;
        csg_node_id root = test_random_scene(&m.builder, &random, 1 + (unsigned)(i % 4));
        assert_true(root != CSG_NODE_NONE);
        mesh_case_compile(&m, root);
        graph_take_numbers(&m);
        try_scene(&m, &random, &seen);
        mesh_case_end(&m);
    }
    assert_true(seen.known > ROUNDS(1000) * test_times && seen.bent > ROUNDS(500) * test_times);
    assert_true(seen.near > ROUNDS(5000) * test_times && seen.turned > ROUNDS(1000) * test_times);
    assert_true(seen.pieces > ROUNDS(3000) * test_times && seen.volumes > ROUNDS(10) * test_times);
}

/* Two of every kind of primitive, turned, with a blend that the models know. */
static void blends_hold(void **state)
{
    static const csg_blend_kind KINDS[] = {CSG_BLEND_ROUND, CSG_BLEND_FILLET, CSG_BLEND_PARABOLA,
                                           CSG_BLEND_HYPERBOLA, CSG_BLEND_SHARP};
    static const csg_node_kind JOINS[] = {CSG_NODE_UNION, CSG_NODE_DIFFERENCE,
                                          CSG_NODE_INTERSECTION};
    tally seen = {0};
    for (uint64_t i = 0; i < ROUNDS(120) * test_times; i++) {
        csg_random random = {.state = seed = 33000 + test_first_seed + i};
        csg_node_id ids[2];
        mesh_case m;
        mesh_case_begin(&m, 1);
        for (int k = 0; k < 2; k++) {
            double v[CSG_PRIMITIVE_MOST_PARAMETERS] = {0};
            static const uint32_t OF[] = {CSG_NODE_SPHERE,   CSG_NODE_BOX,
                                          CSG_NODE_FRUSTUM,  CSG_NODE_CAPSULE,
                                          CSG_NODE_TORUS,    CSG_NODE_SUPERELLIPSOID,
                                          CSG_NODE_ELLIPSOID};
            csg_primitive_kind kind = (csg_primitive_kind)OF[csg_random_below(&random, 7)];
            csg_primitive_of(kind)->example(&random, v);
            ids[k] = posed_anyhow(&m, csg_build_primitive(&m.builder, kind, v, NOWHERE), &random);
        }
        has_fillets = KINDS[i % 5] == CSG_BLEND_FILLET;
        csg_blend blend = {KINDS[i % 5], csg_random_uniform(&random, 0.05, 0.4), false};
        mesh_case_compile(&m, joined(&m, JOINS[i % 3], blend, ids[0], ids[1]));
        graph_take_numbers(&m);
        try_scene(&m, &random, &seen);
        mesh_case_end(&m);
    }
    assert_true(seen.known > ROUNDS(5000) * test_times && seen.near > ROUNDS(30000) * test_times);
    assert_true(seen.pieces > ROUNDS(20000) * test_times && seen.volumes > ROUNDS(80) * test_times);
    assert_true(seen.turned > ROUNDS(10000) * test_times);
}

/* Its distance in a blend, which has no closed form. */
static void ellipsoids_have_models(void **state)
{
    tally seen = {0};
    has_fillets = false;
    for (uint64_t i = 0; i < ROUNDS(40) * test_times; i++) {
        csg_random random = {.state = seed = 49000 + test_first_seed + i};
        double v[3] = {0};
        mesh_case m;
        mesh_case_begin(&m, 1);
        for (int k = 0; k < 3; k++)
            v[k] = csg_random_uniform(&random, 0.1, 0.8);
        csg_node_id solid = csg_build_primitive(&m.builder, CSG_NODE_ELLIPSOID, v, NOWHERE);
        csg_node_id end = make_half_space(&m, 0, 0, 1, csg_random_uniform(&random, -0.3, 0.3));
        csg_blend blend = {CSG_BLEND_ROUND, csg_random_uniform(&random, 0.1, 0.4), false};
        solid = joined(&m, CSG_NODE_INTERSECTION, blend, posed_anyhow(&m, solid, &random), end);
        mesh_case_compile(&m, solid);
        graph_take_numbers(&m);
        try_scene(&m, &random, &seen);
        mesh_case_end(&m);
    }
    assert_true(seen.known > ROUNDS(1500) * test_times && seen.near > ROUNDS(20000) * test_times);
    assert_true(seen.turned > ROUNDS(10000) * test_times);
}

/* A rounded cylinder cut by a plane or by a cylinder that is flush with one of its faces, so
 * tangent to its rounded edge: where a number as blend ends. */
static void flush_solids_have_models(void **state)
{
    tally seen = {0};
    has_fillets = false;
    for (uint64_t i = 0; i < ROUNDS(20) * test_times; i++) {
        csg_random random = {.state = seed = 47000 + test_first_seed + i};
        double r = csg_random_uniform(&random, 0.3, 1), h = csg_random_uniform(&random, 0.3, 1),
               round = csg_random_uniform(&random, 0.1, 0.5);
        mesh_case m;
        mesh_case_begin(&m, 1);
        csg_node_id cylinder =
            csg_build_primitive(&m.builder, CSG_NODE_FRUSTUM, (double[]){r, r, h, round}, NOWHERE);
        csg_node_id end =
            i % 2 ? make_half_space(&m, 0, 0, 1, h + round) : make_cylinder(&m, r + round, h + 1);
        csg_node_id solid = joined(&m, CSG_NODE_INTERSECTION, SHARP, cylinder, end);
        mesh_case_compile(&m, posed_anyhow(&m, solid, &random));
        graph_take_numbers(&m);
        try_scene(&m, &random, &seen);
        mesh_case_end(&m);
    }
    assert_true(seen.with_models > ROUNDS(2250) * test_times);
}

/* Figures turned about an axis or along an elbow, posed. */
static void warps_hold(void **state)
{
    tally seen = {0};
    has_fillets = false;
    for (uint64_t i = 0; i < ROUNDS(40) * test_times; i++) {
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
        graph_take_numbers(&m);
        try_scene(&m, &random, &seen);
        mesh_case_end(&m);
    }
    assert_true(seen.known > ROUNDS(1500) * test_times && seen.near > ROUNDS(8000) * test_times);
    assert_true(seen.turned > ROUNDS(3000) * test_times);
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
    for (int n = 0; n < 10; n++)
        f.third[n] = csg_random_uniform(random, -2, 2) * bent * bent;
    return f;
}

/* Where along the axis, in [-half, half], the solid begins and ends; the polynomial rises there or
 * falls. */
static void find_ends(const csg_taylor *f, const double at[3], int along, double half,
                      double ends[2])
{
    csg_taylor m = csg_taylor_moved(f, at);
    double c = m.value, b = m.slope[along], a = 0.5 * m.bend[along], t = m.third[along] / 6;
    double low = -half, high = half;
    bool rises = c + (b + (a + t * half) * half) * half > c - (b - (a - t * half) * half) * half;
    for (int step = 0; step < 40; step++) {
        double z = 0.5 * (low + high), value = c + (b + (a + t * z) * z) * z;
        if ((value > 0) == rises)
            high = z;
        else
            low = z;
    }
    ends[0] = rises ? low : -half;
    ends[1] = rises ? half : low;
}

/* By columns along an axis; out: around the cube's centre. */
static void add_columns(const csg_taylor *f, double half, int along, double out[CSG_INTEGRALS])
{
    enum { SIDE = 160 };
    int i = (along + 1) % 3, k = (along + 2) % 3;
    double share = 4 * half * half / (SIDE * SIDE);
    memset(out, 0, CSG_INTEGRALS * sizeof *out);
    for (int a = 0; a < SIDE; a++)
        for (int b = 0; b < SIDE; b++) {
            double x[3] = {0}, ends[2], middle[3], length, rest;
            x[i] = half * ((2 * a + 1.0) / SIDE - 1);
            x[k] = half * ((2 * b + 1.0) / SIDE - 1);
            find_ends(f, x, along, half, ends);
            length = share * (ends[1] - ends[0]);
            memcpy(middle, x, sizeof middle);
            middle[along] = 0.5 * (ends[0] + ends[1]);
            rest = (ends[1] - ends[0]) * (ends[1] - ends[0]) / 12;
            out[CSG_INTEGRAL_ONE] += length;
            for (int n = 0; n < 3; n++) {
                out[CSG_INTEGRAL_X + n] += length * middle[n];
                out[CSG_INTEGRAL_XX + n] +=
                    length * (middle[n] * middle[n] + (n == along ? rest : 0));
            }
            out[CSG_INTEGRAL_XY] += length * middle[0] * middle[1];
            out[CSG_INTEGRAL_XZ] += length * middle[0] * middle[2];
            out[CSG_INTEGRAL_YZ] += length * middle[1] * middle[2];
        }
}

/* The integral over the surface in the cube of 1 - the cosine with the plane's normal. *off: what
 * columns may miss of it. */
static double excess_of(const csg_taylor *f, double half, int along, double *off)
{
    enum { SIDE = 160 };
    int i = (along + 1) % 3, k = (along + 2) % 3;
    int cut = 0;
    double sum = 0, most = 0,
           slope = sqrt(f->slope[0] * f->slope[0] + f->slope[1] * f->slope[1] +
                        f->slope[2] * f->slope[2]);
    for (int n = 0; n < SIDE * SIDE; n++) {
        double x[3], g[3], length = 0, with = 0;
        x[i] = half * ((2 * (n % SIDE) + 1.0) / SIDE - 1);
        x[k] = half * ((2 * (n / SIDE) + 1.0) / SIDE - 1);
        x[along] = 0;
        for (int step = 0; step < 8; step++) {
            graph_gradient_at(f, x, g);
            x[along] -= graph_polynomial_at(f, x) / g[along];
        }
        if (!(fabs(x[along]) < half && fabs(graph_polynomial_at(f, x)) < 1e-9 * half)) {
            cut++;
            continue;
        }
        graph_gradient_at(f, x, g);
        for (int a = 0; a < 3; a++) {
            length += g[a] * g[a];
            with += g[a] * f->slope[a] / slope;
        }
        double here = (sqrt(length) - with) / fabs(g[along]);
        most = fmax(most, here);
        sum += here;
    }
    *off = (1e-4 * sum + (cut ? 0.15 * SIDE * most : 0)) * 4 * half * half / (SIDE * SIDE);
    return sum * 4 * half * half / (SIDE * SIDE);
}

/* As pieces: one. */
static const csg_taylor_pieces *one(const csg_taylor *f)
{
    static csg_taylor_pieces pieces = {.count = 1};
    pieces.of[0].f = *f;
    return &pieces;
}

/* Of the cube's face, on which the section may bend back: cells by their middle and how steep the
 * polynomial is there. */
static double area_of_face(const csg_taylor *f, double half, int axis, int side)
{
    enum { SIDE = 200 };
    int i = (axis + 1) % 3, k = (axis + 2) % 3;
    double sum = 0, cell = 2 * half / SIDE, x[3], g[3];
    x[axis] = side * half;
    for (int n = 0; n < SIDE * SIDE; n++) {
        x[i] = cell * (n % SIDE + 0.5) - half;
        x[k] = cell * (n / SIDE + 0.5) - half;
        graph_gradient_at(f, x, g);
        double steep = fmax(fabs(g[i]), fabs(g[k])) * cell;
        sum += fmin(fmax(0.5 + graph_polynomial_at(f, x) / fmax(steep, 1e-30), 0), 1);
    }
    return sum * cell * cell;
}

typedef struct graph_tally {
    uint32_t known, faces, tight, narrow, close, divided, areas;
} graph_tally;

static bool find_of_polynomial(const void *user, const double c[3], double half,
                               csg_taylor_pieces *out)
{
    out->count = 1;
    out->of[0].f = csg_taylor_moved(user, c);
    out->of[0].condition_count = 0;
    out->of[0].is_partial = false;
    return true;
}

static void try_solid(const csg_taylor *f, double half, graph_tally *seen)
{
    double whole = 8 * half * half * half, wanted[CSG_INTEGRALS], least, most;
    csg_graph graph;
    if (!csg_graph_find(one(f), half, 0, &graph))
        return;
    int up = 0;
    for (int k = 1; k < 3; k++)
        up = fabs(f->slope[k]) > fabs(f->slope[up]) ? k : up;
    add_columns(f, half, up, wanted);
    for (int n = 0; n < CSG_INTEGRALS; n++) {
        bool is_first = n >= CSG_INTEGRAL_X, is_second = n >= CSG_INTEGRAL_XX;
        double scale = whole * (is_second ? half * half : is_first ? half : 1);
        double room = is_second ? graph.second : is_first ? graph.first : graph.error;
        double off = fabs(graph.integrals[n] - wanted[n]);
        if (off > room + 2e-5 * scale)
            fail_msg("seed %" PRIu64 ": integral %d is %g off, %g promised, of %g", seed, n, off,
                     room, scale);
    }
    const graph_field field = {find_of_polynomial, f, seed};
    static const double CENTRE[3] = {0, 0, 0};
    seen->divided += graph_try_integrals(&field, CENTRE, half);
    seen->areas += graph_try_area(&field, CENTRE, half);
    double off, excess = excess_of(f, half, up, &off);
    assert_true(csg_graph_excess(one(f), f->slope, half, 0, &least, &most));
    off += 1e-9 * half * half;
    if (excess > most + off || excess < least - off)
        fail_msg("seed %" PRIu64 ": an area's excess of %g, %g to %g promised", seed, excess, least,
                 most);
    seen->known++;
    seen->narrow += most - least < 0.2 * most;
    seen->tight += graph.error < 1e-3 * whole;
    seen->close += graph.first < 2e-3 * whole * half;
}

static void graphs_hold(void **state)
{
    graph_tally seen = {0};
    for (uint64_t i = 0; i < ROUNDS(500) * test_times; i++) {
        csg_random random = {.state = seed = 35000 + test_first_seed + i};
        double half = exp(csg_random_uniform(&random, -3, 3)), area, error;
        csg_taylor f = random_polynomial(&random, half);
        try_solid(&f, half, &seen);
        int axis = (int)(i % 3), side = i % 2 ? 1 : -1;
        if (csg_graph_face(one(&f), half, axis, side, 0, &area, &error)) {
            double wanted = area_of_face(&f, half, axis, side);
            if (fabs(area - wanted) > error + 1e-3 * half * half)
                fail_msg("seed %" PRIu64 ": a face's area %g for %g, %g promised", seed, area,
                         wanted, error);
            seen.faces++;
        }
    }
    assert_true(seen.known > ROUNDS(300) * test_times && seen.tight > ROUNDS(250) * test_times);
    assert_true(seen.faces > ROUNDS(300) * test_times && seen.narrow > ROUNDS(140) * test_times);
    assert_true(seen.areas > ROUNDS(250) * test_times && seen.close > ROUNDS(250) * test_times &&
                seen.divided > ROUNDS(300) * test_times);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(models_hold),
        cmocka_unit_test(blends_hold),
        cmocka_unit_test(ellipsoids_have_models),
        cmocka_unit_test(flush_solids_have_models),
        cmocka_unit_test(warps_hold),
        cmocka_unit_test(graphs_hold),
    };
    test_take_search(argc, argv);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
