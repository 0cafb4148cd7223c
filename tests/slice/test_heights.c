/* SPDX-License-Identifier: MIT
 * Heights of layers by their cusp: closed forms, and of random scenes that no normal of the surface
 * is more level than its height's profile says.
 */
#include <stdio.h>

#include "mesh/mesh_support.h"
#include "slice/heights.h"
#include "slice/profile.h"

static csg_slice_heights heights_of(mesh_case *c, double least, double most, double cusp)
{
    csg_slice_heights h;
    csg_mesh_watch watch = {0};
    const csgm_slice_options options = {.height = least, .most_height = most, .cusp = cusp};
    csg_mesh_watch_begin(&watch, &c->context, &options.monitor, 0);
    assert_int_equal(csg_slice_heights_find(&h, &c->context, c->field, &watch, &options), CSGM_OK);
    assert_true(h.ends[0] == c->field->bounds.min.z);
    assert_true(h.ends[h.count] >= c->field->bounds.max.z - 1e-6 * least);
    assert_true(h.ends[h.count] <= c->field->bounds.max.z + fmax(least, most));
    for (size_t i = 0; i < h.count; i++) {
        double height = h.ends[i + 1] - h.ends[i];
        assert_true(height >= least * (1 - 1e-9) && height <= fmax(least, most) * (1 + 1e-9));
        assert_true(height >= h.lowest && height <= h.highest);
    }
    return h;
}

static csg_node_id ball(mesh_case *c)
{
    return moved(c, make_sphere(c, 20), 1, -2, 3);
}

/* The most level normal of a layer is at the end that is farther from the middle. */
static void balls(void **state)
{
    static const double R = 20, LEAST = 0.05, MOST = 0.5, CUSP = 0.05;
    mesh_case c;
    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, ball(&c));
    csg_slice_heights h = heights_of(&c, LEAST, MOST, CUSP);
    assert_int_equal(h.sampled, 0);
    for (size_t i = 0; i < h.count; i++) {
        double low = fabs(h.ends[i] - 3), high = fabs(h.ends[i + 1] - 3);
        double height = h.ends[i + 1] - h.ends[i], level = fmin(1, fmax(low, high) / R);
        bool is_last = i + 1 == h.count;
        assert_true(height * level <= CUSP * (1 + 1e-4) || height <= LEAST * (1 + 1e-9));
        assert_true(is_last || height * (level + LEAST / R) >= 0.85 * fmin(CUSP, MOST * level) ||
                    height >= MOST * (1 - 1e-9));
    }
    csg_slice_heights_release(&h, &c.context.memory);
    mesh_case_end(&c);
}

static csg_node_id box(mesh_case *c)
{
    return moved(c, make_box(c, 5, 3, 10), 0.5, 0.25, 2);
}

/* Faces that are level matter where they are alone, and upright edges nowhere. */
static void boxes(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 1);
    mesh_case_compile(&c, box(&c));
    csg_slice_heights h = heights_of(&c, 0.1, 0.5, 0.2);
    assert_true(h.sampled == 0 && h.count <= 46);
    for (size_t i = 0; i < h.count; i++) {
        double height = h.ends[i + 1] - h.ends[i];
        if (h.ends[i] < -8 + 1e-3 || h.ends[i + 1] > 12 - 1e-3)
            assert_true(height <= 0.2 * (1 + 1e-4));
        else if (h.ends[i + 1] < 12 - 0.8)
            assert_true(h.ends[i] < -8 + 0.25 || height >= 0.5 * (1 - 1e-9));
    }
    csg_slice_heights_release(&h, &c.context.memory);
    h = heights_of(&c, 0.3, 0, 0);
    assert_true(h.count == 67 && h.lowest > 0.3 * (1 - 1e-9) && h.highest < 0.3 * (1 + 1e-9));
    csg_slice_heights_release(&h, &c.context.memory);
    mesh_case_end(&c);
}

static void too_many(void **state)
{
    mesh_case c;
    csg_slice_heights h;
    csg_mesh_watch watch = {0};
    mesh_case_begin(&c, 1);
    mesh_case_compile(&c, box(&c));
    for (int i = 0; i < 2; i++) {
        const csgm_slice_options options = {
            .height = 1e-7, .most_height = i ? 2e-7 : 0, .cusp = i ? 1e-7 : 0};
        csg_mesh_watch_begin(&watch, &c.context, &options.monitor, 0);
        assert_int_equal(csg_slice_heights_find(&h, &c.context, c.field, &watch, &options),
                         CSGM_ERR_LIMIT);
        assert_int_equal(c.findings, i + 1);
        csg_slice_heights_release(&h, &c.context.memory);
    }
    mesh_case_end(&c);
}

/* ---- random scenes -----------------------------------------------------------------------------
 */

/* Where the reference changes its sign between two heights. */
static double root_between(const csgm_scene *scene, csg_vec3 p, double from, double to)
{
    bool was = test_sample(scene, (csg_vec3){p.x, p.y, from}).value >= 0;
    for (int i = 0; i < 60; i++) {
        double middle = 0.5 * (from + to);
        if ((test_sample(scene, (csg_vec3){p.x, p.y, middle}).value >= 0) == was)
            from = middle;
        else
            to = middle;
    }
    return 0.5 * (from + to);
}

static void check_normal(const mesh_case *c, const csg_slice_profile *p, csg_vec3 at,
                         const char *what)
{
    csg_sample s = test_sample(c->scene, at);
    double length = csg_vec3_norm(s.gradient), level = fabs(s.gradient.z) / length;
    double index = fmin(fmax(floor((at.z - p->bottom) / p->step), 0), (double)(p->count - 1));
    double said = csg_slice_profile_at(p, (size_t)index);
    if (length > 1e-6 && !(said >= level - 2e-4))
        fail_msg("%s: |n_z| is %g at (%.9g, %.9g, %.9g), not %g at most", what, level, at.x, at.y,
                 at.z, said);
}

/* Along a ray upwards. Returns how often it met the surface. */
static size_t check_ray(const mesh_case *c, const csg_slice_profile *p, csg_random *random,
                        const char *what)
{
    enum { STEPS = 60 };
    csg_box b = c->field->bounds;
    csg_vec3 at = {csg_random_uniform(random, b.min.x, b.max.x),
                   csg_random_uniform(random, b.min.y, b.max.y), b.min.z};
    size_t met = 0;
    bool was = test_sample(c->scene, at).value >= 0;
    double from = at.z;
    for (int i = 1; i <= STEPS; i++) {
        at.z = b.min.z + (b.max.z - b.min.z) * i / STEPS;
        bool is = test_sample(c->scene, at).value >= 0;
        if (is != was) {
            double z = root_between(c->scene, at, from, at.z);
            check_normal(c, p, (csg_vec3){at.x, at.y, z}, what);
            met++;
        }
        was = is;
        from = at.z;
    }
    return met;
}

static void random_scenes(void **state)
{
    enum { RAYS = 150 };
    size_t met = 0, bounded = 0;
    for (uint64_t i = 0; i < ROUNDS(40) * test_times; i++) {
        csg_random random = {.state = 7100 + test_first_seed + i};
        char what[40];
        mesh_case c;
        mesh_case_begin(&c, 2);
        csg_node_id root = test_random_mixed(&c.builder, &random, i);
        assert_true(root != CSG_NODE_NONE);
        mesh_case_compile(&c, root);
        csg_box b = c.field->bounds;
        if (csg_box_is_finite(b) && !csg_box_is_empty(b) && !test_has_debulge(c.scene)) {
            csg_slice_profile p;
            csg_mesh_watch watch = {0};
            const csgm_monitor none = {.user = NULL};
            double least = csg_box_longest_side(b) / (i % 4 ? 8 : 40);
            snprintf(what, sizeof what, "scene %d", (int)i);
            csg_mesh_watch_begin(&watch, &c.context, &none, 0);
            assert_int_equal(
                csg_slice_profile_find(&p, &c.context, c.field, &watch, least, 0.05, 0.95),
                CSGM_OK);
            bounded += p.sampled == 0;
            for (int k = 0; k < RAYS && !p.sampled; k++)
                met += check_ray(&c, &p, &random, what);
            csg_slice_profile_release(&p, &c.context.memory);
        }
        mesh_case_end(&c);
    }
    assert_true(met > ROUNDS(1000) * test_times && bounded > ROUNDS(15) * test_times);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(balls),
        cmocka_unit_test(boxes),
        cmocka_unit_test(too_many),
        cmocka_unit_test(random_scenes),
    };
    test_take_search(argc, argv);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
