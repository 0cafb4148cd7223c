/* SPDX-License-Identifier: MIT
 * Whether a triangle is near a mesh: closed forms beside a box and an edge of it, and random
 * triangles near balls against all that is known of points spread over them; the same by a walk.
 */
#include "shape/polyhedra/cover.h"
#include "shape/polyhedra/within.h"
#include "shape/solid_support.h"

enum { PLENTY = 1 << 16 };

typedef struct fixture {
    solid_case c;
    csg_tree tree;
} fixture;

static void make_tree(fixture *f)
{
    csg_arena scratch;
    for (size_t i = 0; i < f->c.triangles.point_count; i++) {
        csg_vec3 *p = &f->c.triangles.points[i];
        *p = csg_triangle_frame_round_point(*p);
    }
    csg_arena_init(&scratch, &f->c.memory);
    assert_true(csg_tree_make(&f->c.memory, &scratch, &f->c.triangles, &f->tree));
    csg_arena_reset(&scratch);
}

static void end(fixture *f)
{
    csg_tree_release(&f->tree);
    csg_triangles_release(&f->c.triangles);
}

static csg_within ask(const fixture *f, const csg_vec3 v[3], double limit, csg_vec3 *beyond)
{
    csg_within_search search = {.tree = &f->tree, .limit = limit};
    csg_within found = csg_triangle_is_within(&search, v, PLENTY);
    assert_true(search.pieces > 0);
    *beyond = search.beyond;
    return found;
}

/* The answer turns just where the largest distance is. */
static void assert_farthest(const fixture *f, const csg_vec3 v[3], double farthest)
{
    csg_vec3 beyond;
    assert_int_equal(ask(f, v, farthest * (1 + 1e-9), &beyond), CSG_WITHIN);
    assert_int_equal(ask(f, v, farthest * (1 - 1e-6), &beyond), CSG_WITHIN_BEYOND);
    assert_true(solid_distance(&f->c.triangles, beyond) > farthest * (1 - 1e-6));
}

static void test_closed_forms(void **state)
{
    (void)state;
    fixture f;
    solid_begin(&f.c);
    solid_add_fine_box(&f.c.triangles, csg_vec3_make(-0.5, -0.5, -0.5),
                       csg_vec3_make(0.5, 0.5, 0.5), 5);
    make_tree(&f);
    /* over many triangles of one face; a corner cut off, whose middle is a third of 0.3 from three
     * faces; through the middle; beyond an edge */
    const csg_vec3 above[3] = {{-0.4, -0.45, 0.53}, {0.45, -0.4, 0.53}, {0.1, 0.45, 0.53}};
    const csg_vec3 cut[3] = {{0.2, 0.5, 0.5}, {0.5, 0.2, 0.5}, {0.5, 0.5, 0.2}};
    const csg_vec3 middle[3] = {{-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0, 0.5, 0}};
    const csg_vec3 beyond_edge[3] = {{0.6, 0.4, 0.6}, {0.6, -0.4, 0.6}, {0.5, 0, 0.5}};
    assert_farthest(&f, above, 0.03);
    assert_farthest(&f, cut, 0.1);
    assert_farthest(&f, beyond_edge, 0.1 * sqrt(2));
    csg_vec3 beyond;
    assert_int_equal(ask(&f, middle, 0.5, &beyond), CSG_WITHIN);
    assert_int_equal(ask(&f, middle, 0.2, &beyond), CSG_WITHIN_BEYOND);
    /* a triangle of the mesh itself */
    const csg_tree_triangle *own = &f.tree.triangles[7];
    const csg_vec3 same[3] = {own->a, csg_vec3_add(own->a, own->ab), csg_vec3_add(own->a, own->ac)};
    assert_int_equal(ask(&f, same, 1e-14, &beyond), CSG_WITHIN);
    end(&f);
}

/* Too few pieces are no answer, and said to be none. */
static void test_limits(void **state)
{
    (void)state;
    fixture f;
    solid_begin(&f.c);
    solid_add_ball(&f.c.triangles, csg_vec3_make(0, 0, 0), 0.9, 24, 24, 0.2);
    make_tree(&f);
    const csg_vec3 v[3] = {{-1, -0.7, 0}, {1, -0.7, 0}, {0, 1, 0}};
    double slack = csg_piece_slack(&f.tree);
    assert_true(slack > 0 && slack < 1e-9);
    csg_within_search search = {.tree = &f.tree, .limit = 0.95};
    assert_int_equal(csg_triangle_is_within(&search, v, 3), CSG_WITHIN_OPEN);
    assert_int_equal(csg_triangle_is_within(&search, v, PLENTY), CSG_WITHIN);
    end(&f);
}

static csg_vec3 point_of(const csg_vec3 v[3], double a, double b)
{
    csg_vec3 p = csg_vec3_add(v[0], csg_vec3_scale(csg_vec3_sub(v[1], v[0]), a));
    return csg_vec3_add(p, csg_vec3_scale(csg_vec3_sub(v[2], v[0]), b));
}

/* The largest distance of places that are evenly spread. */
static double sampled(const fixture *f, const csg_vec3 v[3])
{
    enum { N = 12 };
    double most = 0;
    for (int i = 0; i <= N; i++)
        for (int k = 0; i + k <= N; k++)
            most = fmax(most,
                        solid_distance(&f->c.triangles, point_of(v, (double)i / N, (double)k / N)));
    return most;
}

static void test_random(void **state)
{
    (void)state;
    enum { MESHES = 6, TRIANGLES = 12 };
    int answers[3] = {0};
    for (unsigned seed = 1; seed <= MESHES; seed++) {
        fixture f;
        csg_random random = {seed};
        solid_begin(&f.c);
        solid_add_ball(&f.c.triangles, csg_vec3_make(0, 0, 0), 0.6, 6 + 3 * seed, 6 + 2 * seed,
                       0.1 * seed);
        make_tree(&f);
        for (int i = 0; i < TRIANGLES; i++) {
            csg_vec3 v[3], first = csg_vec3_normalize(solid_random_point(&random, 1)), beyond;
            for (int k = 0; k < 3; k++)
                v[k] = csg_vec3_add(csg_vec3_scale(first, 0.6), solid_random_point(&random, 0.2));
            double seen = sampled(&f, v), limit = seen * csg_random_uniform(&random, 0.6, 1.4);
            csg_within found = ask(&f, v, limit, &beyond);
            answers[found]++;
            if (seen > limit * (1 + 1e-9))
                assert_int_equal(found, CSG_WITHIN_BEYOND);
            if (found == CSG_WITHIN_BEYOND)
                assert_true(solid_distance(&f.c.triangles, beyond) > limit * (1 - 1e-9));
            else
                assert_int_equal(found, CSG_WITHIN);
        }
        end(&f);
    }
    assert_true(answers[CSG_WITHIN] > 10 && answers[CSG_WITHIN_BEYOND] > 10);
}

/* ---- by a walk ------------------------------------------------------------------------------ */

static csg_across *make_across(fixture *f, csg_arena *scratch)
{
    csg_across *across = csg_arena_alloc(scratch, f->tree.count * sizeof *across);
    assert_non_null(across);
    assert_true(csg_across_make(scratch, &f->c.triangles, &f->tree, across));
    return across;
}

/* Closed meshes have somebody across each edge, who sees the same edge from the other side. The
 * middle of the bottom is a fan of more triangles than are looked through. */
static void test_across(void **state)
{
    (void)state;
    fixture f;
    csg_arena scratch;
    solid_begin(&f.c);
    solid_add_ball(&f.c.triangles, csg_vec3_make(0, 0, 0), 0.9, 100, 6, 0.2);
    make_tree(&f);
    csg_arena_init(&scratch, &f.c.memory);
    const csg_across *across = make_across(&f, &scratch);
    for (size_t place = 0; place < f.tree.count; place++)
        for (int k = 0; k < 3; k++) {
            const uint32_t *own = f.c.triangles.corners[f.tree.triangles[place].index];
            uint32_t other = across[place].places[k];
            assert_true(other < f.tree.count && other != place);
            const uint32_t *theirs = f.c.triangles.corners[f.tree.triangles[other].index];
            int shared = 0;
            for (int i = 0; i < 3; i++)
                shared += theirs[i] == own[(k + 1) % 3] && theirs[(i + 1) % 3] == own[k];
            assert_int_equal(shared, 1);
        }
    csg_arena_reset(&scratch);
    end(&f);
}

static void test_walk_closed_forms(void **state)
{
    (void)state;
    fixture f;
    csg_arena scratch;
    double bound;
    solid_begin(&f.c);
    solid_add_fine_box(&f.c.triangles, csg_vec3_make(-0.5, -0.5, -0.5),
                       csg_vec3_make(0.5, 0.5, 0.5), 5);
    make_tree(&f);
    csg_arena_init(&scratch, &f.c.memory);
    const csg_across *across = make_across(&f, &scratch);
    /* over some triangles of one face, and along a ridge beyond which nothing projects */
    const csg_vec3 cases[2][3] = {{{-0.3, -0.35, 0.53}, {0.25, -0.2, 0.53}, {0.1, 0.25, 0.53}},
                                  {{0.51, 0.4, 0.51}, {0.51, -0.4, 0.51}, {0.505, 0, 0.505}}};
    const double farthest[2] = {0.03, 0.01 * sqrt(2)};
    for (int i = 0; i < 2; i++) {
        uint32_t begin = csg_tree_nearest(&f.tree, cases[i][0], 0).place;
        assert_true(csg_triangle_is_covered(&f.tree, across, cases[i], begin,
                                            farthest[i] * (1 + 1e-9), &bound));
        assert_true(bound >= farthest[i] * (1 - 1e-9) && bound <= farthest[i] * (1 + 1e-9));
        assert_false(csg_triangle_is_covered(&f.tree, across, cases[i], begin,
                                             farthest[i] * (1 - 1e-6), &bound));
    }
    csg_arena_reset(&scratch);
    end(&f);
}

/* What the walk shows is true, and it shows most of what is near. */
static void test_walk_random(void **state)
{
    (void)state;
    enum { MESHES = 8, TRIANGLES = 200 };
    int near = 0, covered = 0;
    for (unsigned seed = 1; seed <= MESHES; seed++) {
        fixture f;
        csg_arena scratch;
        csg_random random = {seed};
        solid_begin(&f.c);
        solid_add_ball(&f.c.triangles, csg_vec3_make(0, 0, 0), 0.6, 20 + seed, 16 + seed,
                       0.05 * seed);
        make_tree(&f);
        csg_arena_init(&scratch, &f.c.memory);
        const csg_across *across = make_across(&f, &scratch);
        for (int i = 0; i < TRIANGLES; i++) {
            csg_vec3 v[3], at = csg_vec3_normalize(solid_random_point(&random, 1)), beyond;
            for (int k = 0; k < 3; k++) {
                v[k] = csg_vec3_add(csg_vec3_scale(at, 0.6), solid_random_point(&random, 0.1));
                csg_triangle_hit hit = csg_tree_nearest(&f.tree, v[k], 0);
                bool in_face;
                v[k] = csg_triangle_foot(&f.tree.triangles[hit.place], v[k], &in_face);
            }
            double seen = sampled(&f, v), limit = seen * csg_random_uniform(&random, 0.8, 1.8);
            double bound = INFINITY;
            uint32_t begin = csg_tree_nearest(&f.tree, v[0], 0).place;
            bool is_covered = csg_triangle_is_covered(&f.tree, across, v, begin, limit, &bound);
            near += ask(&f, v, limit, &beyond) == CSG_WITHIN;
            covered += is_covered;
            if (is_covered) {
                assert_true(bound <= limit && bound >= seen * (1 - 1e-9));
                assert_int_equal(ask(&f, v, bound * (1 + 1e-9), &beyond), CSG_WITHIN);
            }
        }
        csg_arena_reset(&scratch);
        end(&f);
    }
    assert_true(near > MESHES * TRIANGLES / 3);
    assert_true(covered > near / 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_closed_forms),
        cmocka_unit_test(test_limits),
        cmocka_unit_test(test_random),
        cmocka_unit_test(test_across),
        cmocka_unit_test(test_walk_closed_forms),
        cmocka_unit_test(test_walk_random),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
