/* SPDX-License-Identifier: MIT
 * Broken meshes: what was found is said, the field is 1-Lipschitz, its sign is that of a whole
 * winding number, and the solid is the one that was meant.
 */
#include "shape/solid_support.h"

#include <string.h>

#include "shape/polyhedra/repair.h"

static csgm_status try_make(solid_case *b)
{
    return csg_polyhedron_create(&b->memory, &b->triangles, &b->repairs, &b->shape);
}

static double value(const solid_case *b, double x, double y, double z)
{
    csg_vec3 gradient;
    return csg_shape_sample(b->shape, csg_vec3_make(x, y, z), &gradient);
}

/* Every edge as often one way as the other. */
static void check_closed(const csg_triangles *t)
{
    for (size_t i = 0; i < t->count; i++)
        for (int k = 0; k < 3; k++) {
            uint32_t a = t->corners[i][k], b = t->corners[i][(k + 1) % 3];
            int net = 0;
            for (size_t j = 0; j < t->count; j++)
                for (int m = 0; m < 3; m++) {
                    uint32_t c = t->corners[j][m], d = t->corners[j][(m + 1) % 3];
                    net += (a == c && b == d) - (a == d && b == c);
                }
            assert_int_equal(net, 0);
        }
}

static void check_field(const solid_case *b)
{
    csg_random random = {11};
    const csg_triangles *t = csg_polyhedron_triangles(b->shape);
    for (int i = 0; i < 3000; i++) {
        csg_vec3 p = solid_random_point(&random, 1.5);
        double near = i % 2 ? 2 : 0.01;
        csg_vec3 q = csg_vec3_add(p, solid_random_point(&random, near)), g;
        double f = csg_shape_sample(b->shape, p, &g), h = csg_shape_sample(b->shape, q, &g);
        assert_true(fabs(f - h) <= csg_vec3_norm(csg_vec3_sub(p, q)) + 1e-9);
        double w = solid_winding(t, p);
        if (fabs(f) > 1e-6) {
            assert_true(fabs(w - round(w)) < 1e-6);
            assert_int_equal(f > 0, round(w) >= 1);
        }
    }
}

static void make(solid_case *b)
{
    assert_int_equal(try_make(b), CSGM_OK);
    check_field(b);
}

static void end(solid_case *b)
{
    csg_shape_release(b->shape);
    csg_triangles_release(&b->triangles);
    assert_int_equal(b->memory.used_bytes, 0);
}

static void add_ball(solid_case *b, double radius)
{
    solid_add_ball(&b->triangles, csg_vec3_make(0, 0, 0), radius, 24, 12, 0);
}

static void add_box(solid_case *b, double low, double high, bool inwards)
{
    solid_add_box(&b->triangles, csg_vec3_make(low, low, low), csg_vec3_make(high, high, high),
                  inwards);
}

static void test_holes(void **state)
{
    solid_case b;
    solid_begin(&b);
    add_ball(&b, 1);
    solid_remove(&b.triangles, 300);
    solid_remove(&b.triangles, 200);
    solid_remove(&b.triangles, 201);
    make(&b);
    check_closed(csg_polyhedron_triangles(b.shape));
    assert_int_equal(b.repairs.holes, 2); /* two of the three are neighbours */
    assert_int_equal(b.repairs.filled, 3);
    assert_true(value(&b, 0, 0, 0) > 0.9 && value(&b, 1.1, 0, 0) < 0);
    end(&b);
}

/* The lid of a box, and half of a ball: large flat holes. */
static void test_large_holes(void **state)
{
    solid_case b;
    solid_begin(&b);
    solid_add_fine_box(&b.triangles, csg_vec3_make(-1, -1, -1), csg_vec3_make(1, 1, 1), 40);
    b.triangles.count -= 2 * 40 * 40; /* the face at z = 1: a rim of 160 points */
    make(&b);
    assert_int_equal(b.repairs.holes, 1);
    assert_true(b.repairs.filled >= 4 && b.repairs.filled <= 158);
    assert_true(fabs(value(&b, 0.1, 0.2, 0.3) - 0.7) < 1e-9);
    assert_true(fabs(value(&b, 0.1, 0.2, 1.3) + 0.3) < 1e-9);
    assert_true(fabs(solid_volume(csg_polyhedron_triangles(b.shape)) - 8) < 1e-9);
    end(&b);
}

static void test_flipped(void **state)
{
    solid_case b;
    solid_begin(&b);
    add_ball(&b, 1);
    for (size_t i = 0; i < b.triangles.count; i += 5)
        solid_flip(&b.triangles, i);
    size_t expected = (b.triangles.count + 4) / 5;
    make(&b);
    assert_int_equal(b.repairs.flipped, expected);
    assert_int_equal(b.repairs.holes, 0);
    assert_true(value(&b, 0, 0, 0) > 0.9 && csg_polyhedron_is_convex(b.shape));
    end(&b);
}

static void test_inside_out(void **state)
{
    solid_case b;
    solid_begin(&b);
    add_box(&b, -1, 1, true);
    make(&b);
    assert_true(b.repairs.inside_out && b.repairs.flipped == 0);
    assert_true(value(&b, 0, 0, 0) == 1);
    end(&b);
}

static void test_twice(void **state)
{
    solid_case b;
    solid_begin(&b);
    add_box(&b, -1, 1, false);
    add_box(&b, -1, 1, false);
    make(&b);
    assert_int_equal(b.repairs.duplicate, 12);
    assert_int_equal(b.repairs.welded, 8);
    assert_int_equal(csg_polyhedron_triangles(b.shape)->count, 12);
    assert_true(csg_polyhedron_is_convex(b.shape));
    end(&b);
    solid_begin(&b); /* both sides of every triangle, as made for viewing */
    add_box(&b, -1, 1, false);
    add_box(&b, -1, 1, false);
    for (size_t i = 0; i < 12; i++)
        solid_flip(&b.triangles, i);
    make(&b);
    assert_int_equal(b.repairs.duplicate, 12);
    assert_true(value(&b, 0, 0, 0) == 1);
    end(&b);
}

/* Two boxes with a face in common: the wall between them goes. */
static void test_common_face(void **state)
{
    solid_case b;
    solid_begin(&b);
    solid_add_box(&b.triangles, csg_vec3_make(-1, -1, -1), csg_vec3_make(0, 1, 1), false);
    solid_add_box(&b.triangles, csg_vec3_make(0, -1, -1), csg_vec3_make(1, 1, 1), false);
    make(&b);
    assert_true(fabs(solid_volume(csg_polyhedron_triangles(b.shape)) - 8) < 1e-9);
    assert_true(value(&b, 0.3, 0, 0) > 0 && value(&b, -0.3, 0, 0) > 0);
    end(&b);
}

/* Two boxes that share an edge, and two that share a corner. */
static void test_nonmanifold(void **state)
{
    solid_case b;
    solid_begin(&b);
    solid_add_box(&b.triangles, csg_vec3_make(-1, -1, -1), csg_vec3_make(0, 0, 1), false);
    solid_add_box(&b.triangles, csg_vec3_make(0, 0, -1), csg_vec3_make(1, 1, 1), false);
    make(&b);
    assert_int_equal(b.repairs.nonmanifold, 1);
    assert_int_equal(b.repairs.holes, 0);
    assert_true(value(&b, -0.5, -0.5, 0) > 0.4 && value(&b, 0.5, 0.5, 0) > 0.4);
    assert_true(value(&b, -0.5, 0.5, 0) < -0.4);
    assert_false(csg_polyhedron_is_convex(b.shape));
    end(&b);
}

/* Three sheets at one edge: no orientation can close that; something does. */
static void test_fins(void **state)
{
    solid_case b;
    solid_begin(&b);
    add_box(&b, -1, 1, false);
    assert_true(csg_triangles_add_point(&b.triangles, csg_vec3_make(1.3, 0, 1.3)));
    assert_true(csg_triangles_add(&b.triangles, 0, 1, 8));
    make(&b);
    assert_true(b.repairs.nonmanifold >= 1);
    assert_true(value(&b, 0, 0, 0) > 0.2);
    end(&b);
}

static void test_nested(void **state)
{
    for (int kind = 0; kind < 4; kind++) {
        solid_case b;
        solid_begin(&b);
        bool outer = kind & 1, inner = kind & 2;
        add_box(&b, -1, 1, outer);
        add_box(&b, -0.5, 0.5, inner);
        make(&b);
        /* inwards in outwards is a cavity, and so is the whole of it turned over */
        bool cavity = outer != inner;
        assert_int_equal(b.repairs.inside_out, outer);
        assert_int_equal(value(&b, 0, 0, 0) < 0, cavity);
        assert_int_equal(b.repairs.overlapping, !cavity);
        assert_true(value(&b, 0.75, 0, 0) == 0.25);
        end(&b);
    }
}

/* Beside each other, one inside out. */
static void test_one_of_two_inverted(void **state)
{
    solid_case b;
    solid_begin(&b);
    solid_add_box(&b.triangles, csg_vec3_make(-1, -1, -1), csg_vec3_make(0, 1, 1), false);
    solid_add_box(&b.triangles, csg_vec3_make(0.5, -1, -1), csg_vec3_make(1, 1, 1), true);
    make(&b);
    assert_int_equal(b.repairs.flipped, 12);
    assert_true(value(&b, 0.75, 0, 0) == 0.25 && value(&b, -0.5, 0, 0) == 0.5);
    end(&b);
}

/* A seam whose two rims differ by rounding; and corners in the middle of a neighbour's edge. */
static void test_seams(void **state)
{
    solid_case b;
    solid_begin(&b);
    add_ball(&b, 1);
    csg_triangles apart;
    csg_random random = {12};
    csg_triangles_init(&apart, &b.memory);
    for (size_t i = 0; i < b.triangles.count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            csg_vec3 p = b.triangles.points[b.triangles.corners[i][k]];
            assert_true(csg_triangles_add_point(
                &apart, csg_vec3_add(p, solid_random_point(&random, 2e-7))));
        }
    for (uint32_t i = 0; i < b.triangles.count; i++)
        assert_true(csg_triangles_add(&apart, 3 * i, 3 * i + 1, 3 * i + 2));
    csg_triangles_release(&b.triangles);
    b.triangles = apart;
    make(&b);
    assert_int_equal(b.repairs.holes, 0);
    assert_int_equal(csg_polyhedron_triangles(b.shape)->point_count, 24 * 11 + 2);
    end(&b);
}

static void test_t_junction(void **state)
{
    solid_case b;
    solid_begin(&b);
    add_box(&b, -1, 1, false);
    /* the edge from corner 0 to 1 gets a point on one side only */
    assert_true(csg_triangles_add_point(&b.triangles, csg_vec3_make(0.25, -1, -1)));
    for (size_t i = 0; i < b.triangles.count; i++) {
        uint32_t *k = b.triangles.corners[i];
        for (int m = 0; m < 3; m++)
            if (k[m] == 0 && k[(m + 1) % 3] == 1) {
                uint32_t tip = k[(m + 2) % 3];
                k[0] = 0, k[1] = 8, k[2] = tip;
                assert_true(csg_triangles_add(&b.triangles, 8, 1, tip));
                m = 3, i = b.triangles.count;
            }
    }
    make(&b);
    assert_int_equal(b.repairs.holes, 0);
    assert_int_equal(csg_polyhedron_triangles(b.shape)->count, 13);
    assert_true(value(&b, 0, 0, 0) == 1);
    end(&b);
}

/* An open bowl becomes full; a strip with a half turn becomes something closed. */
static void test_sheets(void **state)
{
    solid_case b;
    solid_begin(&b);
    solid_add_ball(&b.triangles, csg_vec3_make(0, 0, 0), 1, 300, 20, 0);
    for (size_t i = b.triangles.count; i-- > 0;) {
        bool above = false;
        for (int k = 0; k < 3; k++)
            above |= b.triangles.points[b.triangles.corners[i][k]].z > 1e-9;
        if (above)
            solid_remove(&b.triangles, i);
    }
    make(&b);
    assert_int_equal(b.repairs.holes, 1);
    assert_int_equal(b.repairs.filled, 298);
    assert_true(value(&b, 0, 0, -0.3) > 0.29 && value(&b, 0, 0, 0.3) < -0.29);
    end(&b);

    solid_begin(&b);
    for (uint32_t i = 0; i < 24; i++) {
        double turn = M_PI * i / 24, around = 2 * M_PI * i / 24;
        for (int side = -1; side <= 1; side += 2) {
            double r = 1 + 0.3 * side * cos(turn), z = 0.3 * side * sin(turn);
            assert_true(csg_triangles_add_point(
                &b.triangles, csg_vec3_make(r * cos(around), r * sin(around), z)));
        }
        uint32_t a = 2 * i, c = i < 23 ? a + 2 : 1, d = i < 23 ? a + 3 : 0;
        assert_true(csg_triangles_add(&b.triangles, a, a + 1, d));
        assert_true(csg_triangles_add(&b.triangles, a, d, c));
    }
    make(&b);
    assert_true(b.repairs.holes > 0);
    check_closed(csg_polyhedron_triangles(b.shape));
    end(&b);
}

static void add_corner_triangle(solid_case *b, csg_vec3 p, csg_vec3 q, csg_vec3 r)
{
    uint32_t first = (uint32_t)b->triangles.point_count;
    assert_true(csg_triangles_add_point(&b->triangles, p) &&
                csg_triangles_add_point(&b->triangles, q) &&
                csg_triangles_add_point(&b->triangles, r) &&
                csg_triangles_add(&b->triangles, first, first + 1, first + 2));
}

/* A loose flat sheet beside a box is nothing; not even a surface. */
static void test_loose_sheet(void **state)
{
    solid_case b;
    solid_begin(&b);
    add_box(&b, -0.5, 0.5, false);
    csg_vec3 p = {0.7, -1, -1}, q = {0.7, 1, -1}, r = {0.9, 1, 1}, s = {0.9, -1, 1};
    add_corner_triangle(&b, p, q, r);
    add_corner_triangle(&b, p, r, s);
    make(&b);
    assert_int_equal(csg_polyhedron_triangles(b.shape)->count, 12);
    assert_true(fabs(value(&b, 0.8, 0, 0) + 0.3) < 1e-11);
    end(&b);
}

/* A loop like an 8, extruded: one lobe runs the other way round, both have the same volume. */
static void test_bow_tie(void **state)
{
    static const double loop[4][2] = {{-1, -1}, {1, 1}, {1, -1}, {-1, 1}};
    static const uint32_t faces[6][4] = {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6},
                                         {3, 0, 4, 7}, {3, 2, 1, 0}, {4, 5, 6, 7}};
    solid_case b;
    solid_begin(&b);
    for (int i = 0; i < 8; i++)
        assert_true(csg_triangles_add_point(&b.triangles,
                                            csg_vec3_make(loop[i % 4][0], loop[i % 4][1], i / 4)));
    for (int i = 0; i < 6; i++)
        assert_true(csg_triangles_add_face(&b.triangles, faces[i], 4));
    make(&b);
    assert_true((value(&b, 0.7, 0, 0.5) > 0) != (value(&b, -0.7, 0, 0.5) > 0));
    end(&b);
}

static void test_nothing_left(void **state)
{
    for (int kind = 0; kind < 7; kind++) {
        solid_case b;
        solid_begin(&b);
        csg_vec3 p = {0, 0, 0}, q = {1, 0.5, 0.25}, r = {0, 1, 0.7};
        if (kind == 1) /* no area */
            add_corner_triangle(&b, p, q, csg_vec3_scale(q, 3));
        if (kind == 2) /* one triangle */
            add_corner_triangle(&b, p, q, r);
        if (kind == 3) /* a flat sheet, not along an axis */
            for (int i = 0; i < 5; i++)
                for (int k = 0; k < 5; k++) {
                    csg_vec3 at = csg_vec3_add(csg_vec3_scale(q, i), csg_vec3_scale(r, k));
                    csg_vec3 far = csg_vec3_add(at, csg_vec3_add(q, r));
                    add_corner_triangle(&b, at, csg_vec3_add(at, q), far);
                    add_corner_triangle(&b, at, far, csg_vec3_add(at, r));
                }
        if (kind == 4)
            add_corner_triangle(&b, p, q, csg_vec3_make(0, NAN, 0));
        if (kind == 5)
            add_corner_triangle(&b, p, q, csg_vec3_make(0, INFINITY, 0));
        if (kind == 6) {
            add_box(&b, -1, 1, false);
            b.triangles.corners[5][1] = 8;
        }
        assert_int_equal(try_make(&b), CSGM_ERR_SCENE);
        assert_null(b.shape);
        end(&b);
    }
}

/* What was mended needs no mending. */
static void test_mended_is_clean(void **state)
{
    csg_random random = {13};
    solid_case b, again;
    solid_begin(&b);
    add_ball(&b, 1);
    for (int i = 0; i < 40; i++)
        solid_remove(&b.triangles, csg_random_below(&random, (uint32_t)b.triangles.count));
    for (int i = 0; i < 40; i++)
        solid_flip(&b.triangles, csg_random_below(&random, (uint32_t)b.triangles.count));
    make(&b);
    solid_begin(&again);
    solid_add_copy(&again.triangles, csg_polyhedron_triangles(b.shape));
    make(&again);
    csg_repairs nothing = {.nonmanifold = again.repairs.nonmanifold,
                           .overlapping = again.repairs.overlapping};
    assert_memory_equal(&again.repairs, &nothing, sizeof nothing);
    for (int i = 0; i < 1000; i++) {
        csg_vec3 p = solid_random_point(&random, 1.5);
        assert_true(value(&b, p.x, p.y, p.z) == value(&again, p.x, p.y, p.z));
    }
    end(&again);
    end(&b);
}

/* ---- soups of triangles over a few lattice points ---------------------------------------------
 */

static void add_soup(solid_case *b, csg_random *random, uint32_t side)
{
    uint32_t points = 4 + csg_random_below(random, 14), count = 1 + csg_random_below(random, 40);
    for (uint32_t i = 0; i < points; i++) {
        double x = csg_random_below(random, side), y = csg_random_below(random, side);
        assert_true(csg_triangles_add_point(&b->triangles,
                                            csg_vec3_make(x, y, csg_random_below(random, side))));
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t p = csg_random_below(random, points), q = csg_random_below(random, points);
        assert_true(csg_triangles_add(&b->triangles, p, q, csg_random_below(random, points)));
    }
}

/* Rows that run along edges and through corners, or just beside them. */
static void check_rows(const solid_case *b, csg_random *random, uint32_t side)
{
    enum { COUNT = 60 };
    float x[COUNT], y[COUNT], z[COUNT], f[COUNT];
    const csg_triangles *t = csg_polyhedron_triangles(b->shape);
    for (int i = 0; i < COUNT; i++) {
        bool begins = i % 5 == 0;
        x[i] = (float)csg_random_uniform(random, -1, side);
        y[i] = begins ? 0.5f * (float)csg_random_below(random, 2 * side) : y[i - 1];
        z[i] = begins ? 0.5f * (float)csg_random_below(random, 2 * side) + (i % 2 ? 1e-6f : 0)
                      : z[i - 1];
    }
    csg_shape_values(b->shape, NULL, NULL, x, y, z, COUNT, f);
    for (int i = 0; i < COUNT; i++) {
        csg_vec3 p = {(double)x[i], (double)y[i], (double)z[i]};
        double distance = solid_distance(t, p), w = solid_winding(t, p);
        assert_true(fabs(fabs((double)f[i]) - distance) < 1e-6 * (1 + distance));
        if (distance > 1e-5) {
            assert_true(fabs(w - round(w)) < 1e-4);
            assert_int_equal(f[i] > 0, round(w) >= 1);
        }
    }
}

static void test_soups(void **state)
{
    csg_random random = {14};
    int made = 0;
    for (int i = 0; i < 500; i++) {
        solid_case b;
        uint32_t side = 2 + csg_random_below(&random, 4);
        solid_begin(&b);
        add_soup(&b, &random, side);
        csgm_status status = try_make(&b);
        assert_true(status == CSGM_OK || status == CSGM_ERR_SCENE);
        if (status == CSGM_OK)
            check_rows(&b, &random, side);
        made += status == CSGM_OK;
        end(&b);
    }
    assert_true(made > 300);
}

/* Loops so long that their filling goes through its shortcuts, from any corner on. */
static void test_large_soup(void **state)
{
    enum { COUNT = 3000 };
    csg_random random = {15};
    csg_triangles t;
    csg_chain chain;
    csg_repairs repairs;
    csg_memory memory;
    csg_arena scratch;
    csg_memory_init(&memory, NULL, 0);
    csg_arena_init(&scratch, &memory);
    csg_triangles_init(&t, &memory);
    for (uint32_t i = 0; i < COUNT; i++)
        assert_true(csg_triangles_add_point(&t, solid_random_point(&random, 1)));
    for (uint32_t i = 0; i < COUNT; i++) {
        uint32_t p = csg_random_below(&random, COUNT), q = csg_random_below(&random, COUNT);
        assert_true(csg_triangles_add(&t, p, q, csg_random_below(&random, COUNT)));
    }
    assert_int_equal(csg_repair(&memory, &scratch, &t, &chain, &repairs), CSGM_OK);
    assert_true(repairs.holes > 10);
    check_closed(&chain.triangles);
    csg_triangles_release(&chain.triangles);
    csg_triangles_release(&t);
    csg_arena_reset(&scratch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_holes),           cmocka_unit_test(test_large_holes),
        cmocka_unit_test(test_flipped),         cmocka_unit_test(test_inside_out),
        cmocka_unit_test(test_twice),           cmocka_unit_test(test_common_face),
        cmocka_unit_test(test_nonmanifold),     cmocka_unit_test(test_fins),
        cmocka_unit_test(test_nested),          cmocka_unit_test(test_one_of_two_inverted),
        cmocka_unit_test(test_seams),           cmocka_unit_test(test_t_junction),
        cmocka_unit_test(test_sheets),          cmocka_unit_test(test_loose_sheet),
        cmocka_unit_test(test_bow_tie),         cmocka_unit_test(test_nothing_left),
        cmocka_unit_test(test_mended_is_clean), cmocka_unit_test(test_soups),
        cmocka_unit_test(test_large_soup),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
