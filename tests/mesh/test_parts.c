/* SPDX-License-Identifier: MIT
 * Meshes of several parts: each is what its own scene gives on the common lattice, progress never
 * goes back, and every allocation of finding, compiling and meshing them may fail.
 */
#include "mesh/mesh_support.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "scene/operators/blend_kinds.h"
#include "scene/operators/rule.h"
#include "scene/tree/parts.h"

static csg_node_id named(mesh_case *c, const char *name, csg_node_id node)
{
    return csg_build_part(&c->builder, name, node, NOWHERE);
}

static csg_node_id shaded(mesh_case *c, float metallic, csg_node_id node)
{
    csg_look look = {.metallic = metallic, .roughness = 0.5f, .has_material = true};
    return csg_build_look(&c->builder, &look, node, NOWHERE);
}

/* Two parts, one of two materials that blend, one of two places; a solid in none; all of it turned
 * and moved. A name below the blend is lost. */
static csg_node_id some_parts(mesh_case *c, double x)
{
    csg_node_id pair = joined(c, CSG_NODE_UNION, ROUND(0.3), shaded(c, 1, make_sphere(c, 0.6)),
                              named(c, "lost", moved(c, make_sphere(c, 0.5), 0.6, 0, 0)));
    csg_node_id lid = named(c, "lid", pair);
    csg_node_id bolts =
        joined(c, CSG_NODE_UNION, SHARP, moved(c, make_box(c, 0.3, 0.3, 0.3), 2, 0, 0),
               named(c, "inner", moved(c, make_sphere(c, 0.4), -2, 0, 0)));
    bolts = named(c, "bolt", bolts);
    csg_node_id rest = moved(c, make_cylinder(c, 0.4, 0.5), 0, 2, 0);
    csg_node_id all =
        joined(c, CSG_NODE_UNION, SHARP, lid, joined(c, CSG_NODE_UNION, SHARP, bolts, rest));
    return moved(c, turned(c, all, 20, csg_vec3_make(0, 0.6, 0.8)), x, 0, 0);
}

static void begin(mesh_case *c, uint32_t threads, double x)
{
    mesh_case_begin(c, threads);
    mesh_case_compile(c, some_parts(c, x));
    assert_int_equal(csg_field_compile_parts(c->field), CSGM_OK);
}

/* The scene is the union of its parts. */
static void check_union(const mesh_case *c)
{
    csg_random random = {7};
    for (int i = 0; i < 1000; i++) {
        csg_vec3 p = test_point(&random, 4);
        double most = -INFINITY;
        for (size_t k = 0; k < c->field->part_count; k++)
            most = fmax(most, test_sample(c->field->parts[k].scene, p).value);
        test_near(most, test_sample(c->scene, p).value, 1e-12);
    }
}

static csg_node_id ruled(mesh_case *c, csg_blend_kind kind, double width)
{
    csg_rule rule = csg_rule_standard(kind);
    rule.parameters[0] = rule.parameters[1] = width;
    csg_blend blend = csg_build_rule(&c->builder, &rule);
    return joined(c, CSG_NODE_UNION, blend, make_sphere(c, 0.8),
                  moved(c, make_sphere(c, 0.6), 0.9, 0, 0));
}

/* Parts keep the rules of their blends, the first of them too. */
static void test_rules(void **state)
{
    (void)state;
    mesh_case c;
    mesh_case_begin(&c, 1);
    csg_node_id inner = named(&c, "inner", ruled(&c, CSG_BLEND_INTERIOR, 0.3));
    csg_node_id outer = named(&c, "outer", moved(&c, ruled(&c, CSG_BLEND_EXTERIOR, 0.2), 3, 0, 0));
    mesh_case_compile(&c, joined(&c, CSG_NODE_UNION, SHARP, inner, outer));
    assert_int_equal(csg_field_compile_parts(c.field), CSGM_OK);
    assert_int_equal(c.field->part_count, 2);
    check_union(&c);
    mesh_case_end(&c);
}

static void test_units(void **state)
{
    (void)state;
    mesh_case c;
    csg_parts parts;
    begin(&c, 1, 0);
    assert_int_equal(csg_parts_find(&parts, c.scene), CSGM_OK);
    assert_int_equal(parts.count, 3);
    assert_null(csg_parts_name(&parts, 0));
    assert_string_equal(csg_parts_name(&parts, 1), "lid");
    assert_string_equal(csg_parts_name(&parts, 2), "bolt");
    assert_int_equal(parts.unit_count, 4);
    assert_int_equal(parts.lost_count, 2);
    check_union(&c);
    csg_parts_reset(&parts);
    mesh_case_end(&c);
}

/* Every vertex of a part lies where the part meshed alone, in the same bounds, has it. */
static void test_parts_are_their_scenes(void **state)
{
    (void)state;
    for (int far = 0; far < 2; far++) {
        mesh_case c;
        begin(&c, 2, far ? 1e6 : 0);
        csgm_mesh_options options = mesh_options(60);
        mesh_build_closed(&c, &options, "parts");
        csgm_mesh_view view = csg_mesh_view(c.mesh);
        assert_int_equal(view.part_count, 3);
        assert_non_null(view.materials);
        assert_int_equal(c.check.components, 4);
        assert_true(!far || fabs(view.origin.x - 1e6) < 10);
        options.bounds = csg_box_empty();
        for (size_t i = 0; i < 3; i++)
            options.bounds = csg_box_hull(options.bounds, c.field->parts[i].field->bounds);
        uint64_t triangle = 0, vertex = 0;
        for (size_t i = 0; i < 3; i++) {
            csgm_mesh *alone = NULL;
            assert_int_equal(
                csg_mesh_build(&c.context, c.field->parts[i].field, &options, &alone, NULL),
                CSGM_OK);
            assert_int_equal(view.parts[i].first_triangle, triangle);
            assert_int_equal(view.parts[i].triangle_count, alone->triangle_count);
            for (uint64_t k = 0; k < 3 * alone->triangle_count; k++)
                assert_int_equal(view.indices[3 * triangle + k], alone->indices[k] + vertex);
            for (uint64_t k = 0; k < 3 * alone->vertex_count; k++) {
                double shift = (&alone->origin.x)[k % 3] - (&view.origin.x)[k % 3];
                double have = (double)view.positions[3 * vertex + k];
                assert_true(fabs(have - ((double)alone->positions[k] + shift)) < 1e-5);
            }
            triangle += alone->triangle_count;
            vertex += alone->vertex_count;
            csg_mesh_destroy(alone);
        }
        mesh_case_end(&c);
    }
}

/* Mixed where they blend, one where they do not, the default where nothing is said. */
static void test_materials(void **state)
{
    (void)state;
    mesh_case c;
    begin(&c, 1, 0);
    csgm_mesh_options options = mesh_options(60);
    mesh_build_closed(&c, &options, "materials");
    csgm_mesh_view view = csg_mesh_view(c.mesh);
    int shares[3] = {0};
    for (uint64_t t = 0; t < view.triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            const uint16_t *pair = view.materials + 2 * (size_t)view.indices[3 * t + (uint64_t)k];
            bool lid = t >= view.parts[1].first_triangle && t < view.parts[2].first_triangle;
            if (!lid)
                assert_true(pair[0] == 0 && pair[1] == 6000);
            else
                shares[pair[0] == 0 ? 0 : pair[0] == 10000 ? 2 : 1]++;
            if (lid) /* one proportion for both */
                assert_true(abs(pair[1] - (6000 - pair[0] / 10)) <= 1);
        }
    assert_true(shares[0] > 100 && shares[1] > 20 && shares[2] > 100);
    mesh_case_end(&c);
}

typedef struct watcher {
    double last;
    int reports;
    bool wrong;
    atomic_int asked;
    int cancel_at;
} watcher;

static void watch(void *user, csgm_stage stage, double fraction)
{
    watcher *w = user;
    w->wrong |= stage != CSGM_STAGE_MESH || fraction < w->last || fraction > 1;
    w->last = fraction;
    w->reports++;
}

static bool cancelled(void *user)
{
    watcher *w = user;
    return w->cancel_at && atomic_fetch_add(&w->asked, 1) >= w->cancel_at;
}

static void test_watched(void **state)
{
    (void)state;
    mesh_case c;
    begin(&c, 2, 0);
    uint64_t before = atomic_load(&c.context.memory.used_bytes);
    watcher w = {0};
    csgm_mesh_options options = mesh_options(200);
    options.monitor = (csgm_monitor){watch, cancelled, &w};
    mesh_build_closed(&c, &options, "watched");
    assert_false(w.wrong);
    assert_true(w.reports > 0 && w.last > 0.4);
    csg_mesh_destroy(c.mesh);
    c.mesh = NULL;
    for (int at = 1; at < 30; at += 7) {
        w = (watcher){.cancel_at = at};
        assert_int_equal(mesh_build(&c, &options), CSGM_CANCELLED);
        assert_int_equal(atomic_load(&c.context.memory.used_bytes), before);
    }
    mesh_case_end(&c);
}

/* ---- allocations that fail ----------------------------------------------------------------- */

typedef struct failing {
    atomic_long calls;
    long fail_at;
} failing;

static void *failing_alloc(void *user, size_t bytes)
{
    failing *f = user;
    return atomic_fetch_add(&f->calls, 1) + 1 == f->fail_at ? NULL : malloc(bytes);
}

static void failing_release(void *user, void *memory, size_t bytes)
{
    (void)user, (void)bytes;
    free(memory);
}

static csgm_status compile_and_build(mesh_case *c)
{
    csgm_mesh_options options = mesh_options(16);
    csgm_status status = csg_field_compile_parts(c->field);
    if (status == CSGM_OK)
        status = mesh_build(c, &options);
    csg_mesh_destroy(c->mesh);
    c->mesh = NULL;
    csg_field_release_parts(c->field);
    return status;
}

static void test_each_allocation(void **state)
{
    (void)state;
    mesh_case c;
    failing f = {0};
    mesh_case_begin(&c, 1);
    mesh_case_compile(&c, some_parts(&c, 0));
    uint64_t before = atomic_load(&c.context.memory.used_bytes);
    csgm_allocator original = c.context.memory.allocator;
    c.context.memory.allocator = (csgm_allocator){failing_alloc, failing_release, &f};
    long n = 1;
    for (;; n++) {
        atomic_store(&f.calls, 0);
        f.fail_at = n;
        c.findings = 0;
        c.context.diags.errors = 0; /* the cap is not for tests */
        csgm_status status = compile_and_build(&c);
        assert_int_equal(atomic_load(&c.context.memory.used_bytes), before);
        if (status == CSGM_OK)
            break;
        assert_int_equal(status, CSGM_ERR_MEMORY);
        assert_int_equal(c.findings, 1);
    }
    assert_true(n > 50);
    c.context.memory.allocator = original;
    mesh_case_end(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rules),
        cmocka_unit_test(test_units),
        cmocka_unit_test(test_parts_are_their_scenes),
        cmocka_unit_test(test_materials),
        cmocka_unit_test(test_watched),
        cmocka_unit_test(test_each_allocation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
