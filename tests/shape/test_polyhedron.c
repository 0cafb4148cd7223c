/* SPDX-License-Identifier: MIT
 * The field of a polyhedron: against boxes and balls, against all triangles one by one, against
 * solid angles; on points that lie on, above and beside edges; and the same whatever the batch.
 */
#include "shape/solid_support.h"

#include <limits.h>
#include <string.h>

#include "rounds.h"
#include "shape/shape_kernel.h"

static double value(const solid_case *c, csg_vec3 p)
{
    csg_vec3 gradient;
    double f = csg_shape_sample(c->shape, p, &gradient);
    assert_true(f == f);
    assert_true(fabs(csg_vec3_norm(gradient) - 1) < 1e-9);
    return f;
}

/* ---- against formulas -------------------------------------------------------------------------
 */

static double box_value(csg_vec3 p, double half)
{
    double x = fabs(p.x) - half, y = fabs(p.y) - half, z = fabs(p.z) - half;
    double outside =
        sqrt(fmax(x, 0) * fmax(x, 0) + fmax(y, 0) * fmax(y, 0) + fmax(z, 0) * fmax(z, 0));
    return -(outside + fmin(fmax(x, fmax(y, z)), 0));
}

static void check_box(const solid_case *c, csg_vec3 p, double half)
{
    double f = value(c, p), true_value = box_value(p, half);
    assert_true(fabs(f - true_value) < 1e-11);
    if (fabs(true_value) > 1e-11)
        assert_int_equal(f > 0, true_value > 0);
}

static void test_box(void **state)
{
    csg_random random = {1};
    solid_case c;
    solid_begin(&c);
    solid_add_box(&c.triangles, csg_vec3_make(-1, -1, -1), csg_vec3_make(1, 1, 1), false);
    solid_make(&c);
    csg_repairs nothing = {0};
    assert_memory_equal(&c.repairs, &nothing, sizeof nothing);
    assert_true(csg_polyhedron_is_convex(c.shape));
    for (int i = 0; i < 20000; i++)
        check_box(&c, solid_random_point(&random, 2), 1);
    solid_end(&c);
}

/* Around corners, edges and diagonals of every face, as near as 1e-9; and exactly in their planes.
 */
static void test_near_edges(void **state)
{
    static const double steps[] = {-1e-3, -1e-6, -1e-9, 0, 1e-9, 1e-6, 1e-3};
    csg_random random = {2};
    solid_case c;
    solid_begin(&c);
    solid_add_fine_box(&c.triangles, csg_vec3_make(-1, -1, -1), csg_vec3_make(1, 1, 1), 4);
    solid_make(&c);
    assert_int_equal(c.repairs.welded, 6 * 25 - 98);
    assert_true(csg_polyhedron_is_convex(c.shape));
    for (int i = 0; i < 20000; i++) {
        double at[3];
        for (int k = 0; k < 3; k++)
            at[k] = csg_random_below(&random, 9) * 0.25 - 1 + steps[csg_random_below(&random, 7)];
        check_box(&c, csg_vec3_make(at[0], at[1], at[2]), 1);
    }
    solid_end(&c);
}

static void test_ball(void **state)
{
    csg_random random = {3};
    solid_case c;
    solid_begin(&c);
    solid_add_ball(&c.triangles, csg_vec3_make(5, 6, 7), 2, 96, 48, 0);
    solid_make(&c);
    double sagitta = 2 * (1 - cos(M_PI / 48) * cos(M_PI / 96));
    for (int i = 0; i < 5000; i++) {
        csg_vec3 p = solid_random_point(&random, 3);
        double f = value(&c, csg_vec3_add(p, csg_vec3_make(5, 6, 7)));
        assert_true(f <= 2 - csg_vec3_norm(p) + 1e-9);
        assert_true(f >= 2 - csg_vec3_norm(p) - sagitta);
    }
    assert_true(csg_polyhedron_is_convex(c.shape));
    solid_end(&c);
}

/* ---- against all triangles --------------------------------------------------------------------
 */

static void check_against_all(solid_case *c, csg_random *random, double half, int count)
{
    solid_make(c);
    const csg_triangles *mended = csg_polyhedron_triangles(c->shape);
    for (int i = 0; i < count; i++) {
        csg_vec3 p = solid_random_point(random, half);
        double f = value(c, p), distance = solid_distance(mended, p), w = solid_winding(mended, p);
        assert_true(fabs(fabs(f) - distance) < 1e-9 * half);
        if (distance > 1e-6 * half) {
            assert_true(fabs(w - round(w)) < 1e-6);
            assert_int_equal(f > 0, round(w) >= 1);
        }
    }
}

static void test_solids_of_all_kinds(void **state)
{
    csg_random random = {4};
    for (int kind = 0; kind < 6; kind++) {
        solid_case c;
        solid_begin(&c);
        csg_vec3 zero = {0, 0, 0};
        if (kind == 0)
            solid_add_ball(&c.triangles, zero, 1, 24, 16, 0.4);
        if (kind == 1) /* cuts itself */
            solid_add_ball(&c.triangles, zero, 1, 24, 16, 1.7);
        if (kind == 2) { /* two that overlap */
            solid_add_ball(&c.triangles, csg_vec3_make(-0.4, 0, 0), 0.8, 20, 10, 0);
            solid_add_ball(&c.triangles, csg_vec3_make(0.4, 0.1, 0), 0.8, 20, 10, 0.1);
        }
        if (kind == 3) { /* long thin needles */
            solid_add_ball(&c.triangles, zero, 1, 700, 3, 0.3);
        }
        if (kind == 4) /* nothing but a cloud of corners */
            for (int i = 0; i < 40; i++) {
                csg_vec3 p = solid_random_point(&random, 1);
                solid_add_box(&c.triangles, p, csg_vec3_add(p, csg_vec3_make(0.3, 0.2, 0.1)),
                              false);
            }
        if (kind == 5) /* a loose soup, closed by whatever it takes */
            for (int i = 0; i < 60; i++) {
                for (int k = 0; k < 3; k++)
                    assert_true(
                        csg_triangles_add_point(&c.triangles, solid_random_point(&random, 1)));
                for (uint32_t k = 0; k < 3; k++)
                    assert_true(csg_triangles_add(
                        &c.triangles, csg_random_below(&random, (uint32_t)c.triangles.point_count),
                        csg_random_below(&random, (uint32_t)c.triangles.point_count),
                        csg_random_below(&random, (uint32_t)c.triangles.point_count)));
            }
        check_against_all(&c, &random, 1.5, 1500);
        if (kind == 1 || kind == 2)
            assert_true(c.repairs.overlapping);
        solid_end(&c);
    }
}

/* A fan of triangles a thousand million times longer than wide. */
static void test_needles(void **state)
{
    csg_random random = {5};
    solid_case c;
    solid_begin(&c);
    solid_add_box(&c.triangles, csg_vec3_make(0, 0, 0), csg_vec3_make(1, 1e-9, 1e-9), false);
    solid_add_box(&c.triangles, csg_vec3_make(-1, -1, 0.5), csg_vec3_make(1, 1, 0.5 + 1e-8), false);
    solid_make(&c);
    for (int i = 0; i < 2000; i++) {
        csg_vec3 p = solid_random_point(&random, 1);
        csg_vec3 a = {fmax(fmin(p.x, 1), 0), 0, 0}, b = {p.x, p.y, 0.5};
        double to_rod = csg_vec3_norm(csg_vec3_sub(p, a)),
               to_sheet = csg_vec3_norm(csg_vec3_sub(p, b));
        assert_true(fabs(fabs(value(&c, p)) - fmin(to_rod, to_sheet)) < 1e-7);
    }
    solid_end(&c);
}

/* ---- batches ----------------------------------------------------------------------------------
 */

enum { POINTS = 4000 };

static void fill_points(csg_random *random, float *x, float *y, float *z)
{
    for (int i = 0; i < POINTS; i++) {
        if (i % 4 == 0) { /* else the row goes on */
            x[i] = (float)csg_random_uniform(random, -1.4, 1.4);
            y[i] = (float)csg_random_uniform(random, -1.4, 1.4);
            z[i] = (float)csg_random_uniform(random, -1.4, 1.4);
            continue;
        }
        x[i] = x[i - 1] + (float)csg_random_uniform(random, -0.5, 0.5);
        y[i] = y[i - 1];
        z[i] = z[i - 1] + (i % 8 == 7 ? 0.01f : 0);
    }
}

static void test_batches(void **state)
{
    static float x[POINTS], y[POINTS], z[POINTS], all[POINTS], f[POINTS], g[3][POINTS];
    csg_random random = {6};
    solid_case c;
    solid_begin(&c);
    solid_add_ball(&c.triangles, csg_vec3_make(0, 0, 0), 1, 60, 30, 1.2);
    solid_make(&c);
    fill_points(&random, x, y, z);
    csg_shape_values(c.shape, NULL, NULL, x, y, z, POINTS, all);
    csg_shape_gradients(c.shape, NULL, NULL, x, y, z, POINTS, f, g[0], g[1], g[2]);
    assert_memory_equal(all, f, sizeof f);
    for (int i = 0; i < POINTS; i++) {
        csg_vec3 gradient;
        csg_vec3 p = {(double)x[i], (double)y[i], (double)z[i]};
        float one, other[4];
        csg_shape_values(c.shape, NULL, NULL, x + i, y + i, z + i, 1, &one);
        assert_memory_equal(&one, &all[i], sizeof one);
        csg_shape_gradients(c.shape, NULL, NULL, x + i, y + i, z + i, 1, other, other + 1,
                            other + 2, other + 3);
        for (int k = 0; k < 3; k++)
            assert_memory_equal(&other[k + 1], &g[k][i], sizeof one);
        assert_true((float)csg_shape_sample(c.shape, p, &gradient) == one);
        assert_true((float)gradient.x == g[0][i] && (float)gradient.y == g[1][i]);
    }
    solid_end(&c);
}

/* Points that lie together are searched together: by lanes as one by one, to the bit. */
static void check_packet(const solid_case *c, csg_random *random)
{
    enum { MOST = 150 };
    float x[MOST], y[MOST], z[MOST], f[MOST], lanes[4][MOST], one[4];
    const csg_triangles *t = csg_polyhedron_triangles(c->shape);
    csg_vec3 at = t->points[csg_random_below(random, (uint32_t)t->point_count)];
    double spread = pow(10, csg_random_uniform(random, -7, 0.5));
    uint32_t count = 1 + csg_random_below(random, MOST);
    for (uint32_t i = 0; i < count; i++) {
        csg_vec3 p = csg_vec3_add(at, solid_random_point(random, spread));
        x[i] = (float)p.x, y[i] = (float)p.y, z[i] = (float)p.z;
    }
    csg_shape_values(c->shape, &csg_shape_kernel_scalar, NULL, x, y, z, count, f);
    csg_shape_gradients(c->shape, &csg_shape_kernel_scalar, NULL, x, y, z, count, lanes[0],
                        lanes[1], lanes[2], lanes[3]);
    assert_memory_equal(f, lanes[0], count * sizeof *f);
    for (uint32_t i = 0; i < count; i++) {
        csg_shape_gradients(c->shape, NULL, NULL, x + i, y + i, z + i, 1, one, one + 1, one + 2,
                            one + 3);
        for (int k = 0; k < 4; k++)
            assert_memory_equal(&lanes[k][i], &one[k], sizeof *one);
    }
}

static void test_packets(void **state)
{
    csg_random random = {8};
    for (uint32_t i = 0; i < 12; i++) {
        solid_case c;
        solid_begin(&c);
        solid_add_ball(&c.triangles, csg_vec3_make(0, 0, 0), 1, 5 + 20 * i, 4 + 10 * i,
                       i % 3 ? 0.5 : 0);
        if (i % 4 == 1) /* needles */
            solid_add_box(&c.triangles, csg_vec3_make(0.9, 0, 0), csg_vec3_make(1.5, 1e-9, 1e-9),
                          false);
        if (i % 4 == 2) /* ties, and shells that cross */
            solid_add_fine_box(&c.triangles, csg_vec3_make(-1, -1, -1), csg_vec3_make(1, 1, 1), 7);
        solid_make(&c);
        for (int k = 0; k < ROUNDS(60); k++)
            check_packet(&c, &random);
        solid_end(&c);
    }
}

/* f(p + h g) - f(p) = h wherever there is one nearest point. */
/* ---- parts that matter in a cell ---------------------------------------------------------------
 */

enum { CELL_POINTS = 48 };

typedef struct near_list {
    csg_shape_near *near;
    size_t bytes;
} near_list;

static near_list narrow(solid_case *c, const csg_shape_near *among, const csg_shape_cell *cell)
{
    uint32_t items[CSG_SHAPE_MOST_NEAR];
    uint32_t count = csg_shape_narrow(c->shape, among, cell, items);
    assert_in_range(count, 1, CSG_SHAPE_MOST_NEAR);
    near_list list = {.bytes = sizeof *list.near + count * sizeof *items};
    list.near = csg_memory_alloc(&c->memory, list.bytes);
    list.near->limit = cell->reach;
    list.near->count = count;
    memcpy(list.near->items, items, count * sizeof *items);
    return list;
}

/* Up to its reach every bit as by the whole shape, the sign everywhere. */
static void check_cell(const solid_case *c, const near_list *list, const csg_shape_cell *cell,
                       csg_random *random)
{
    float x[CELL_POINTS], y[CELL_POINTS], z[CELL_POINTS], all[CELL_POINTS], g[8][CELL_POINTS];
    for (int i = 0; i < CELL_POINTS; i++) {
        csg_vec3 at = solid_random_point(random, 1);
        x[i] = (float)(cell->center.x + 0.999 * at.x * cell->half.x);
        y[i] = (float)(cell->center.y + 0.999 * at.y * cell->half.y);
        z[i] = (float)(cell->center.z + 0.999 * at.z * cell->half.z);
    }
    csg_shape_values(c->shape, NULL, NULL, x, y, z, CELL_POINTS, all);
    csg_shape_gradients(c->shape, NULL, NULL, x, y, z, CELL_POINTS, g[0], g[1], g[2], g[3]);
    csg_shape_gradients(c->shape, &csg_shape_kernel_scalar, list->near, x, y, z, CELL_POINTS, g[4],
                        g[5], g[6], g[7]);
    for (int i = 0; i < CELL_POINTS; i++) {
        assert_int_equal(signbit(g[4][i]), signbit(all[i]));
        assert_true(fabsf(g[4][i]) >= fabsf(all[i]));
        for (int k = 0; k < 4 && fabs((double)all[i]) < cell->reach * (1 - 1e-6); k++)
            assert_true(g[k][i] == g[4 + k][i]);
        csg_shape_values(c->shape, NULL, list->near, x + i, y + i, z + i, 1, g[0]);
        assert_true(g[0][0] == g[4][i]);
    }
}

/* A cell and one within it. Every other time both are around a place of the surface, and hardly
 * anything but what is in them is listed. */
static void check_cells(solid_case *c, csg_random *random)
{
    bool is_tight = csg_random_below(random, 2);
    double half = csg_random_uniform(random, 0.02, 0.5), share = is_tight ? 1e-3 : 1;
    const csg_triangles *t = csg_polyhedron_triangles(c->shape);
    csg_vec3 at = is_tight ? t->points[csg_random_below(random, (uint32_t)t->point_count)]
                           : solid_random_point(random, 1.2);
    csg_shape_cell large = {.center = at, .half = {half, half, half}};
    csg_vec3 away = solid_random_point(random, share * half / 2), ignored;
    csg_shape_cell small = {.center = csg_vec3_add(large.center, away),
                            .half = csg_vec3_scale(large.half, 0.4)};
    large.reach = fabs(csg_shape_sample(c->shape, large.center, &ignored)) + csg_vec3_norm(away) +
                  csg_random_uniform(random, 0, share * half);
    small.reach = fmax(fabs(csg_shape_sample(c->shape, small.center, &ignored)),
                       csg_random_uniform(random, 0, large.reach));
    near_list outer = narrow(c, NULL, &large), inner = narrow(c, outer.near, &small);
    check_cell(c, &outer, &large, random);
    check_cell(c, &inner, &small, random);
    csg_memory_release(&c->memory, inner.near, inner.bytes);
    csg_memory_release(&c->memory, outer.near, outer.bytes);
}

static void test_cells(void **state)
{
    csg_random random = {77};
    for (uint32_t i = 0; i < 24; i++) {
        solid_case c;
        solid_begin(&c);
        solid_add_ball(&c.triangles, csg_vec3_make(0.2, 0, 0), 0.7, 6 + 5 * i, 4 + 3 * i,
                       i % 3 ? 0.3 : 0);
        if (i % 2) /* shells that cross */
            solid_add_fine_box(&c.triangles, csg_vec3_make(-0.9, -0.4, -0.3),
                               csg_vec3_make(0.3, 0.5, 0.45), 1 + i / 4);
        solid_make(&c);
        for (int k = 0; k < ROUNDS(25); k++)
            check_cells(&c, &random);
        solid_end(&c);
    }
}

/* A deep star around an axis, as its long triangles wind up: where nearer ones may be left out of a
 * list, the nearest of those in it does not tell the side. */
static void test_cells_of_long_triangles(void **state)
{
    csg_random random = {5};
    for (uint32_t i = 0; i < 12; i++) {
        solid_case c;
        solid_begin(&c);
        solid_add_ball(&c.triangles, csg_vec3_make(0, 0, 0), 1, 40 + 20 * i, 10 + 5 * i, 0);
        for (size_t v = 0; v < c.triangles.point_count; v++) {
            csg_vec3 *p = &c.triangles.points[v];
            double r = hypot(p->x, p->y), angle = atan2(p->y, p->x);
            double wave = r * (0.6 + 0.35 * cos(5 * angle));
            p->x = wave * cos(angle + 2 * p->z);
            p->y = wave * sin(angle + 2 * p->z);
        }
        solid_make(&c);
        for (int k = 0; k < ROUNDS(400); k++)
            check_cells(&c, &random);
        solid_end(&c);
    }
}

static void test_gradients(void **state)
{
    csg_random random = {7};
    solid_case c;
    solid_begin(&c);
    solid_add_ball(&c.triangles, csg_vec3_make(0, 0, 0), 1, 60, 30, 0.2);
    solid_make(&c);
    int unlike = 0;
    for (int i = 0; i < 2000; i++) {
        csg_vec3 p = solid_random_point(&random, 1.3), g;
        double f = csg_shape_sample(c.shape, p, &g);
        double up = value(&c, csg_vec3_add(p, csg_vec3_scale(g, 1e-6)));
        assert_true(up - f <= 1.000001e-6);
        unlike += fabs(up - f - 1e-6) > 1e-9;
    }
    assert_true(unlike < 20); /* next to the medial axis */
    solid_end(&c);
}

static void test_far_and_not_numbers(void **state)
{
    static const double far[] = {1e3, 1e9, 1e17, 1e19, 1e30, 1e150};
    solid_case c;
    solid_begin(&c);
    solid_add_box(&c.triangles, csg_vec3_make(-1, -1, -1), csg_vec3_make(1, 1, 1), false);
    solid_make(&c);
    for (size_t i = 0; i < sizeof far / sizeof *far; i++) {
        csg_vec3 p = {far[i], -far[i] / 2, far[i] / 3};
        assert_true(fabs(value(&c, p) / box_value(p, 1) - 1) < 1e-12);
    }
    float x[4] = {NAN, INFINITY, 3e38f, 0}, y[4] = {0, 0, -3e38f, -INFINITY}, z[4] = {0}, f[4],
          g[12];
    csg_shape_gradients(c.shape, NULL, NULL, x, y, z, 4, f, g, g + 4, g + 8);
    for (int i = 0; i < 4; i++)
        assert_true(f[i] < 0);
    for (int i = 0; i < 12; i++)
        assert_true(fabsf(g[i]) <= 1.0001f);
    solid_end(&c);
}

/* The same solid a hundred powers of two up and down, and far from zero. */
static void test_scales(void **state)
{
    static const double scales[] = {0x1p-100, 1e-12, 1, 1e12, 0x1p100};
    for (size_t i = 0; i < sizeof scales / sizeof *scales; i++) {
        csg_random random = {8};
        solid_case c;
        solid_begin(&c);
        double s = scales[i], shift = i == 2 ? 1e6 : 0;
        solid_add_box(&c.triangles, csg_vec3_make(shift - s, -s, -s),
                      csg_vec3_make(shift + s, s, s), false);
        solid_make(&c);
        assert_true(fabs(c.shape->box.min.x - (shift - s)) <= 1e-11 * s);
        assert_true(fabs(c.shape->box.max.y - s) <= 1e-11 * s);
        for (int k = 0; k < 1000; k++) {
            csg_vec3 p = solid_random_point(&random, 2), at = csg_vec3_scale(p, s);
            at.x += shift;
            assert_true(fabs(value(&c, at) / s - box_value(p, 1)) < 1e-9);
        }
        solid_end(&c);
    }
}

/* ---- the object -------------------------------------------------------------------------------
 */

static void test_convex(void **state)
{
    for (int kind = 0; kind < 4; kind++) {
        solid_case c;
        solid_begin(&c);
        solid_add_ball(&c.triangles, csg_vec3_make(0, 0, 0), 1, 20, 10, kind == 1 ? 0.3 : 0);
        if (kind == 2)
            solid_add_box(&c.triangles, csg_vec3_make(2, 0, 0), csg_vec3_make(3, 1, 1), false);
        if (kind == 3)
            solid_add_box(&c.triangles, csg_vec3_make(-0.1, -0.1, -0.1),
                          csg_vec3_make(0.1, 0.1, 0.1), true);
        solid_make(&c);
        assert_int_equal(csg_polyhedron_is_convex(c.shape), kind == 0);
        solid_end(&c);
    }
}

static void test_hash(void **state)
{
    uint64_t hashes[3];
    for (int i = 0; i < 3; i++) {
        solid_case c;
        solid_begin(&c);
        solid_add_ball(&c.triangles, csg_vec3_make(0, 0, 0), 1, 20, 10, i == 2 ? 0.01 : 0);
        solid_make(&c);
        hashes[i] = csg_shape_hash(c.shape);
        solid_end(&c);
    }
    assert_true(hashes[0] == hashes[1] && hashes[0] != hashes[2]);
}

/* Triangles with a hole, a flipped one and an inverted piece, so that every step has work. */
static void test_every_allocation_fails(void **state)
{
    solid_case c;
    solid_begin(&c);
    solid_add_ball(&c.triangles, csg_vec3_make(0, 0, 0), 1, 20, 10, 0);
    solid_add_box(&c.triangles, csg_vec3_make(2, 0, 0), csg_vec3_make(2.5, 1, 1), true);
    solid_flip(&c.triangles, 30);
    solid_remove(&c.triangles, 40);
    solid_remove(&c.triangles, 41);
    for (size_t k = 0; k < c.triangles.point_count; k += 7)
        c.triangles.points[k].x += 1e-8;
    csgm_status status = CSGM_ERR_MEMORY;
    long n = 0;
    for (; status != CSGM_OK; n++) {
        failing_memory f;
        csg_shape *shape = NULL;
        failing_init(&f, n);
        status = csg_polyhedron_create(&f.memory, &c.triangles, NULL, &shape);
        assert_true(status == CSGM_OK || (status == CSGM_ERR_MEMORY && !shape));
        csg_shape_release(shape);
        assert_int_equal(f.memory.used_bytes, 0);
        assert_int_equal(f.allocator.live, 0);
    }
    assert_true(n > 8);
    solid_end(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_box),
        cmocka_unit_test(test_near_edges),
        cmocka_unit_test(test_ball),
        cmocka_unit_test(test_solids_of_all_kinds),
        cmocka_unit_test(test_needles),
        cmocka_unit_test(test_batches),
        cmocka_unit_test(test_packets),
        cmocka_unit_test(test_cells),
        cmocka_unit_test(test_cells_of_long_triangles),
        cmocka_unit_test(test_gradients),
        cmocka_unit_test(test_far_and_not_numbers),
        cmocka_unit_test(test_scales),
        cmocka_unit_test(test_convex),
        cmocka_unit_test(test_hash),
        cmocka_unit_test(test_every_allocation_fails),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
