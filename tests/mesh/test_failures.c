/* SPDX-License-Identifier: MIT
 * Builds that do not end well: cancelled at any moment, out of time, over the memory limit, and
 * with each allocation refused in turn. Each says why, once, and gives back what it took.
 */
#include "base/mesh_codes.h"
#include "mesh/mesh_support.h"

#include <stdatomic.h>
#include <stdlib.h>

/* Blends, colours and enough blocks for several items of work. */
static csg_node_id some_solid(mesh_case *c)
{
    csg_node_id ball = csg_build_color(&c->builder, (csg_color){1, 0, 0, 1},
                                       moved(c, make_sphere(c, 0.6), 0.4, 0.1, 0), NOWHERE);
    csg_node_id box = turned(c, make_box(c, 0.7, 0.4, 0.5), 25, csg_vec3_make(0.6, 0.8, 0));
    return joined(c, CSG_NODE_UNION, ROUND(0.2), ball, box);
}

static uint64_t used_bytes(mesh_case *c)
{
    return atomic_load(&c->context.memory.used_bytes);
}

/* ---- watching and cancelling -------------------------------------------------------------------
 */

typedef struct watcher {
    atomic_int asked;
    int cancel_at;        /* the question that is answered with yes; < 0: never */
    double last_fraction; /* of the stage */
    int last_stage, reports;
    bool is_wrong;
} watcher;

static bool is_cancelled(void *user)
{
    watcher *w = user;
    int asked = atomic_fetch_add(&w->asked, 1);
    return w->cancel_at >= 0 && asked >= w->cancel_at;
}

static void watch(void *user, csgm_stage stage, double fraction)
{
    watcher *w = user;
    if ((int)stage != w->last_stage)
        w->last_fraction = 0;
    w->is_wrong |= (int)stage < w->last_stage || fraction < w->last_fraction || fraction > 1;
    w->last_stage = (int)stage;
    w->last_fraction = fraction;
    w->reports++;
}

static void test_cancelled(void **state)
{
    for (uint32_t threads = 1; threads <= 3; threads += 2) {
        mesh_case c;
        mesh_case_begin(&c, threads);
        mesh_case_compile(&c, some_solid(&c));
        uint64_t before = used_bytes(&c);
        csgm_mesh_options options = mesh_options(100);
        watcher w = {.cancel_at = -1, .last_stage = CSGM_STAGE_OCTREE};
        options.monitor = (csgm_monitor){watch, is_cancelled, &w};
        mesh_build_closed(&c, &options, "not cancelled");
        assert_true(w.reports > 0 && !w.is_wrong);
        int questions = atomic_load(&w.asked);
        assert_true(questions > 4);
        csg_mesh_destroy(c.mesh);
        c.mesh = NULL;
        for (int at = 0; at < questions; at++) {
            w = (watcher){.cancel_at = at, .last_stage = CSGM_STAGE_OCTREE};
            assert_int_equal(mesh_build(&c, &options), CSGM_CANCELLED);
            assert_null(c.mesh);
            assert_int_equal(c.findings, 0);
            assert_int_equal(used_bytes(&c), before);
        }
        mesh_case_end(&c);
    }
}

static void test_timeout(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, some_solid(&c));
    uint64_t before = used_bytes(&c);
    c.context.limits.timeout_s = 1e-9; /* over before it begins */
    csgm_mesh_options options = mesh_options(100);
    assert_int_equal(mesh_build(&c, &options), CSGM_ERR_LIMIT);
    assert_int_equal(c.last_code, CSG_DIAG_TIMEOUT);
    assert_int_equal(c.findings, 1);
    assert_null(c.mesh);
    assert_int_equal(used_bytes(&c), before);
    c.context.limits.timeout_s = 1e6;
    mesh_build_closed(&c, &options, "in time");
    mesh_case_end(&c);
}

/* ---- memory ------------------------------------------------------------------------------------
 */

static void test_memory_limit(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 2);
    mesh_case_compile(&c, some_solid(&c));
    uint64_t before = used_bytes(&c);
    csgm_mesh_options options = mesh_options(64);
    bool fitted = false, refused = false;
    uint64_t earlier = atomic_load(&c.context.memory.peak_bytes);
    for (uint64_t room = 1 << 10; !fitted; room *= 2) {
        assert_true(room < 1 << 30);
        c.context.memory.limit_bytes = before + room;
        csgm_status status = mesh_build(&c, &options);
        uint64_t peak = atomic_load(&c.context.memory.peak_bytes);
        assert_true(peak <= earlier || peak <= before + room);
        fitted = status == CSGM_OK;
        if (fitted)
            break;
        refused = true;
        assert_int_equal(status, CSGM_ERR_MEMORY);
        assert_int_equal(c.last_code, CSG_DIAG_OUT_OF_MEMORY);
        assert_int_equal(c.findings, 1);
        assert_null(c.mesh);
        assert_int_equal(used_bytes(&c), before);
    }
    assert_true(refused);
    c.context.memory.limit_bytes = 0;
    mesh_case_end(&c);
}

typedef struct failing {
    atomic_long calls;
    long fail_at; /* 1 = the next call; 0 = never */
} failing;

static void *failing_alloc(void *user, size_t size_bytes)
{
    failing *f = user;
    return atomic_fetch_add(&f->calls, 1) + 1 == f->fail_at ? NULL : malloc(size_bytes);
}

static void failing_release(void *user, void *memory, size_t size_bytes)
{
    free(memory);
}

static void check_each_allocation(uint32_t threads, bool prune)
{
    mesh_case c;
    failing f = {.fail_at = 0};
    mesh_case_begin(&c, threads);
    mesh_case_compile(&c, some_solid(&c));
    uint64_t before = used_bytes(&c);
    csgm_allocator original = c.context.memory.allocator;
    c.context.memory.allocator = (csgm_allocator){failing_alloc, failing_release, &f};
    csgm_mesh_options options = mesh_options(24);
    options.bounds = (csg_box){{-0.5, -2, -2}, {2, 2, 2}}; /* clips: a field more to lose */
    options.prune = prune;
    long n = 1;
    for (;; n++) {
        atomic_store(&f.calls, 0);
        f.fail_at = n;
        csgm_status status = mesh_build(&c, &options);
        if (status == CSGM_OK && atomic_load(&f.calls) < n)
            break; /* every allocation has had its turn */
        assert_int_equal(status, CSGM_ERR_MEMORY);
        assert_int_equal(c.last_code, CSG_DIAG_OUT_OF_MEMORY);
        assert_int_equal(c.findings, 1);
        assert_null(c.mesh);
        assert_int_equal(used_bytes(&c), before);
    }
    assert_true(n > 10);
    f.fail_at = 0;
    mesh_build_closed(&c, &options, "after all that");
    csg_mesh_destroy(c.mesh);
    c.mesh = NULL;
    c.context.memory.allocator = original;
    mesh_case_end(&c);
}

static void test_each_allocation(void **state)
{
    check_each_allocation(1, true);
    check_each_allocation(1, false);
    check_each_allocation(3, true);
}

/* ---- receivers that stop
 * -------------------------------------------------------------------------- */

typedef struct stopper {
    atomic_int runs;
    int stop_at;
    csgm_status begin;
} stopper;

static csgm_status stopper_begin(void *user, const csg_mesh_counts *counts)
{
    return ((stopper *)user)->begin;
}

static bool stopper_put(void *user, const csg_mesh_run *run)
{
    stopper *s = user;
    return atomic_fetch_add(&s->runs, 1) < s->stop_at;
}

static void test_receiver_stops(void **state)
{
    mesh_case c;
    mesh_case_begin(&c, 3);
    mesh_case_compile(&c, some_solid(&c));
    uint64_t before = used_bytes(&c);
    csgm_mesh_options options = mesh_options(100);
    stopper s = {.stop_at = 1 << 30};
    csg_mesh_receiver receiver = {.user = &s, .begin = stopper_begin, .put = stopper_put};
    assert_int_equal(csg_mesh_stream(&c.context, c.field, &options, &receiver, NULL, NULL),
                     CSGM_OK);
    int runs = atomic_load(&s.runs);
    assert_true(runs > 1);
    for (int at = 0; at < runs; at += 1 + runs / 5) {
        s = (stopper){.stop_at = at};
        assert_int_not_equal(csg_mesh_stream(&c.context, c.field, &options, &receiver, NULL, NULL),
                             CSGM_OK);
        assert_int_equal(used_bytes(&c), before);
    }
    s = (stopper){.stop_at = 1 << 30, .begin = CSGM_ERR_IO};
    assert_int_equal(csg_mesh_stream(&c.context, c.field, &options, &receiver, NULL, NULL),
                     CSGM_ERR_IO);
    assert_int_equal(atomic_load(&s.runs), 0);
    assert_int_equal(used_bytes(&c), before);
    mesh_case_end(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cancelled),      cmocka_unit_test(test_timeout),
        cmocka_unit_test(test_memory_limit),   cmocka_unit_test(test_each_allocation),
        cmocka_unit_test(test_receiver_stops),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
