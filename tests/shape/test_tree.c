/* SPDX-License-Identifier: MIT
 * The nearest triangle of a tree: the least of all of them, and the same one wherever the search
 * begins; for points beside, within and far from small, large and thin meshes. To the bit, whoever
 * searches: all triangles, the tree, a list of its parts, points in lanes, where many are as near.
 * What groups of triangles say of their sides is what each would say of its own.
 */
#include "shape/polyhedra/edges.h"
#include "shape/polyhedra/tree.h"
#include "shape/shape_kernel.h"
#include "shape/solid_support.h"

static csg_vec3 on_lattice(csg_vec3 p)
{
    return csg_vec3_make(csg_triangle_frame_round(p.x), csg_triangle_frame_round(p.y),
                         csg_triangle_frame_round(p.z));
}

static double squared_to(const csg_tree *tree, uint32_t place, csg_vec3 p)
{
    bool in_face;
    csg_vec3 away = csg_vec3_sub(p, csg_triangle_foot(&tree->triangles[place], p, &in_face));
    return csg_vec3_dot(away, away);
}

static void check(const csg_tree *tree, csg_vec3 p, csg_random *random)
{
    csg_triangle_hit found = csg_tree_nearest(tree, p, 0);
    /* the foot is rounded as p is */
    double error = 1e-14 * (1 + csg_vec3_norm(p)) * sqrt(found.squared) + 1e-10 * found.squared;
    assert_true(fabs(squared_to(tree, found.place, p) - found.squared) <= error);
    for (uint32_t place = 0; place < tree->count; place++)
        assert_true(squared_to(tree, place, p) >= found.squared - error);
    for (int i = 0; i < 3; i++) {
        uint32_t hint = csg_random_below(random, (uint32_t)tree->count);
        csg_triangle_hit again = csg_tree_nearest(tree, p, hint);
        assert_true(again.squared == found.squared && again.place == found.place);
    }
}

static csg_vec3 random_direction(csg_random *random)
{
    return csg_vec3_normalize(solid_random_point(random, 1));
}

/* A mesh of this size about a centre that is within the frame. */
static void check_mesh(csg_random *random, double size, uint32_t columns, uint32_t rows)
{
    solid_case c;
    csg_tree tree;
    csg_arena scratch;
    solid_begin(&c);
    csg_vec3 center = solid_random_point(random, 1 - size);
    solid_add_ball(&c.triangles, center, size / 2, columns, rows,
                   csg_random_below(random, 2) ? 0.5 : 0);
    for (size_t i = 0; i < c.triangles.point_count; i++)
        c.triangles.points[i] = on_lattice(c.triangles.points[i]);
    csg_arena_init(&scratch, &c.memory);
    assert_true(csg_tree_make(&c.memory, &scratch, &c.triangles, &tree));
    csg_arena_reset(&scratch);
    for (int i = 0; i < 60; i++) {
        double away = i % 3 == 0   ? size * csg_random_uniform(random, 0, 2)
                      : i % 3 == 1 ? csg_random_uniform(random, 0, 2)
                                   : csg_random_uniform(random, 1, 2) * ldexp(1, 3 * (i / 3 % 9));
        check(&tree, csg_vec3_add(center, csg_vec3_scale(random_direction(random), away)), random);
    }
    csg_tree_release(&tree);
    csg_triangles_release(&c.triangles);
    assert_int_equal(c.memory.used_bytes, 0);
}

static void test_nearest(void **state)
{
    csg_random random = {1};
    for (int round = 0; round < 12; round++)
        for (int size = 0; size < 4; size++)
            check_mesh(&random, ldexp(0.9, -4 * size), 3 + csg_random_below(&random, 30),
                       3 + csg_random_below(&random, 20));
}

/* ---- ties ----------------------------------------------------------------------------------- */

typedef struct tie_case {
    solid_case c;
    csg_tree tree;
    csg_random random;
} tie_case;

static void begin_ties(tie_case *t, unsigned seed)
{
    csg_arena scratch;
    t->random.state = seed;
    solid_begin(&t->c);
    uint32_t n = 2 + csg_random_below(&t->random, 9);
    double half = ldexp(0.9, -(int)csg_random_below(&t->random, 12));
    csg_vec3 center = solid_random_point(&t->random, seed % 2 ? 0 : 1 - half);
    if (seed % 3) {
        /* flat or slender, some of them */
        csg_vec3 h = {half, ldexp(half, -(int)csg_random_below(&t->random, 25) * (seed % 5 == 0)),
                      ldexp(half, -(int)csg_random_below(&t->random, 25) * (seed % 7 == 0))};
        solid_add_fine_box(&t->c.triangles, csg_vec3_sub(center, h), csg_vec3_add(center, h), n);
    } else {
        solid_add_ball(&t->c.triangles, center, half, 2 * n, n + 1, 0);
    }
    for (size_t i = 0; i < t->c.triangles.point_count; i++)
        t->c.triangles.points[i] = on_lattice(t->c.triangles.points[i]);
    csg_arena_init(&scratch, &t->c.memory);
    assert_true(csg_tree_make(&t->c.memory, &scratch, &t->c.triangles, &t->tree));
    csg_arena_reset(&scratch);
}

/* A mean of some corners, so that several triangles are as near or nearly so; above or below one of
 * them, sometimes by a few roundings. */
static csg_vec3 point_between(tie_case *t)
{
    const csg_triangles *m = &t->c.triangles;
    uint32_t count = 1 + csg_random_below(&t->random, 4);
    csg_vec3 p = {0, 0, 0};
    for (uint32_t i = 0; i < count; i++)
        p = csg_vec3_add(p, m->points[csg_random_below(&t->random, (uint32_t)m->point_count)]);
    p = csg_vec3_scale(p, 1.0 / count);
    double *axis[3] = {&p.x, &p.y, &p.z};
    int power = -4 - (int)csg_random_below(&t->random, 50);
    *axis[csg_random_below(&t->random, 3)] += ldexp(csg_random_uniform(&t->random, -1, 1), power);
    bool is_far = csg_random_below(&t->random, 8) == 0;
    return csg_vec3_scale(p, is_far ? ldexp(1, (int)csg_random_below(&t->random, 40)) : 1);
}

static csg_triangle_hit nearest_of_all(const csg_tree *tree, csg_vec3 p)
{
    csg_triangle_hit best = {INFINITY, 0, 0};
    for (uint32_t place = 0; place < tree->count; place++) {
        double squared = csg_triangle_squared(&tree->triangles[place], p);
        if (squared < best.squared)
            best = (csg_triangle_hit){squared, place, 0};
    }
    return best;
}

static void assert_same(csg_triangle_hit found, csg_triangle_hit wanted)
{
    assert_true(found.squared == wanted.squared);
    assert_int_equal(found.place, wanted.place);
}

/* Up to the greatest distance nothing depends on it, and beyond it there is nothing. */
static void check_most(tie_case *t, const csg_tree_parts *parts, csg_vec3 p,
                       csg_triangle_hit wanted)
{
    const csg_triangle_hit none = {.place = CSG_TREE_NONE};
    csg_vec3 lanes[CSG_SHAPE_LANES];
    csg_triangle_hit hits[CSG_SHAPE_LANES];
    csg_tree_parts near = *parts;
    for (int l = 0; l < CSG_SHAPE_LANES; l++)
        lanes[l] = csg_vec3_add(p, solid_random_point(&t->random, l ? 0.1 : 0));
    for (int k = -1; k <= 1; k++) {
        near.most = k < 0 ? 0.99 * wanted.squared : k ? 1.01 * wanted.squared : wanted.squared;
        bool is_found = wanted.squared <= near.most;
        csg_triangle_hit expected = is_found ? wanted : none;
        expected.squared = is_found ? wanted.squared : near.most;
        uint32_t hint = k ? CSG_TREE_NONE : wanted.place;
        assert_same(csg_tree_nearest_of(&t->tree, &near, p, hint), expected);
        csg_shape_kernel_scalar.nearest_triangles(&t->tree, &near, lanes, CSG_SHAPE_LANES, hint,
                                                  hits);
        assert_same(hits[0], expected);
    }
}

/* A list of what is within reach of a cell around p, as blocks have one. */
static void check_list(tie_case *t, csg_vec3 p, csg_triangle_hit wanted)
{
    enum { MOST = 8 };
    static const double MORE = 0x1p-36;
    double half = ldexp(1, -(int)csg_random_below(&t->random, 30));
    csg_vec3 halves = {half, half, half}, away = solid_random_point(&t->random, half);
    uint32_t items[MOST];
    uint32_t count = csg_tree_narrow(&t->tree, NULL, 0, csg_vec3_add(p, away), halves,
                                     sqrt(wanted.squared) + MORE, items, MOST);
    csg_vec3 lanes[CSG_SHAPE_LANES];
    csg_triangle_hit hits[CSG_SHAPE_LANES];
    assert_true(count > 0);
    const csg_tree_parts parts = {items, count, INFINITY};
    assert_same(csg_tree_nearest_of(&t->tree, &parts, p, CSG_TREE_NONE), wanted);
    for (int l = 0; l < CSG_SHAPE_LANES; l++)
        lanes[l] = csg_vec3_add(p, solid_random_point(&t->random, l ? 0.1 * half : 0));
    csg_shape_kernel_scalar.nearest_triangles(&t->tree, &parts, lanes, CSG_SHAPE_LANES,
                                              CSG_TREE_NONE, hits);
    assert_same(hits[0], wanted);
    check_most(t, &parts, p, wanted);
}

static void check_ties(unsigned seed)
{
    enum { POINTS = 60 };
    tie_case t;
    begin_ties(&t, seed);
    for (int i = 0; i < POINTS; i++) {
        csg_vec3 p = point_between(&t);
        csg_triangle_hit wanted = nearest_of_all(&t.tree, p);
        uint32_t hint = csg_random_below(&t.random, (uint32_t)t.tree.count);
        assert_same(csg_tree_nearest(&t.tree, p, hint), wanted);
        check_list(&t, p, wanted);
    }
    csg_tree_release(&t.tree);
    csg_triangles_release(&t.c.triangles);
}

static unsigned first_seed = 1, last_seed = 200;

static void test_ties(void **state)
{
    for (unsigned seed = first_seed; seed <= last_seed; seed++)
        check_ties(seed);
}

/* ---- groups --------------------------------------------------------------------------------- */

static void find_beside(const csg_tree *tree, const csg_triangles *chain, csg_arena *scratch,
                        uint32_t (*beside)[3])
{
    csg_triangle_edges edges;
    uint32_t *places = csg_arena_alloc(scratch, tree->count * sizeof *places);
    assert_true(places && csg_edges_make(scratch, chain, &edges));
    for (uint32_t i = 0; i < tree->count; i++)
        places[tree->triangles[i].index] = i;
    for (uint32_t half = 0; half < 3 * chain->count; half++) {
        const csg_edge *edge = &edges.edges[edges.of_half[half]];
        const uint32_t *halves = edges.halves + edge->first;
        assert_int_equal(edge->count, 2);
        beside[places[half / 3]][half % 3] = places[halves[halves[0] == half] / 3];
    }
}

/* Of corners: how many lie within a ball. */
static int count_within(const csg_tree_triangle *t, csg_vec3 center, double radius)
{
    const csg_vec3 at[3] = {t->a, csg_vec3_add(t->a, t->ab), csg_vec3_add(t->a, t->ac)};
    int count = 0;
    for (int k = 0; k < 3; k++)
        count += csg_vec3_norm(csg_vec3_sub(at[k], center)) < radius;
    return count;
}

/* Two balls of facets: apart, one within the other, or crossing. */
static void check_groups(csg_random *random, int way)
{
    solid_case c;
    csg_tree tree;
    csg_arena scratch;
    solid_begin(&c);
    csg_vec3 first = solid_random_point(random, 0.05);
    double radius = csg_random_uniform(random, 0.2, 0.3);
    double away = radius * (way == 0 ? 2.2 : way == 1 ? 0.1 : csg_random_uniform(random, 0.7, 1.7));
    csg_vec3 second = csg_vec3_add(first, csg_vec3_scale(random_direction(random), away));
    const csg_vec3 centers[2] = {first, second};
    const double radii[2] = {radius, way == 1 ? radius / 2 : radius};
    for (int k = 0; k < 2; k++)
        solid_add_ball(&c.triangles, centers[k], radii[k], 8 + csg_random_below(random, 20),
                       8 + csg_random_below(random, 12), 0);
    for (size_t i = 0; i < c.triangles.point_count; i++)
        c.triangles.points[i] = on_lattice(c.triangles.points[i]);
    csg_arena_init(&scratch, &c.memory);
    assert_true(csg_tree_make(&c.memory, &scratch, &c.triangles, &tree));
    uint32_t(*beside)[3] = csg_arena_alloc(&scratch, tree.count * sizeof *beside);
    assert_non_null(beside);
    find_beside(&tree, &c.triangles, &scratch, beside);
    uint32_t crossing = 0, plain_count = 0, group = 0;
    for (uint32_t i = 0; i < tree.count; i++) {
        const csg_tree_triangle *t = &tree.triangles[i];
        if (i % CSG_TREE_GROUP == 0)
            group = csg_tree_plain_group(&tree, beside, i);
        bool is_plain = group >> i % CSG_TREE_GROUP & 1;
        for (int k = 0; k < 2 && way == 2; k++)
            if (count_within(t, centers[k], 0.8 * radii[k]) > 0 &&
                count_within(t, centers[k], 1.001 * radii[k]) < 3) {
                assert_false(is_plain); /* facets lie farther out than 0.8 */
                crossing++;
            }
        plain_count += is_plain;
        assert_true(!is_plain || csg_tree_is_clear(&tree, i));
        if (way < 2)
            assert_int_equal(is_plain, !t->is_needle && csg_tree_is_clear(&tree, i));
    }
    assert_true(plain_count > 0 && (way < 2 || crossing > 0));
    csg_arena_reset(&scratch);
    csg_tree_release(&tree);
    csg_triangles_release(&c.triangles);
}

static void test_groups(void **state)
{
    csg_random random = {1};
    for (int round = 0; round < 60; round++)
        check_groups(&random, round % 3);
}

/* Optional: the first seed of ties and the last. */
int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_nearest), cmocka_unit_test(test_ties),
                                       cmocka_unit_test(test_groups)};
    if (argc == 3) {
        first_seed = (unsigned)strtoul(argv[1], NULL, 10);
        last_seed = (unsigned)strtoul(argv[2], NULL, 10);
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
