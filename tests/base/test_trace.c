/* SPDX-License-Identifier: MIT
 * Zones come out nested and with their counts, whole or not at all; lanes are handed on; a pool's
 * workers have zones of their own; whatever fails to be allocated, nothing is left behind.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/pool.h"
#include "base/trace.h"
#include "failing.h"

enum { TEXT_MOST = 1 << 22 };

typedef struct text {
    char *bytes;
    size_t length;
} text;

static void add(void *user, const char *bytes, size_t length)
{
    text *t = user;
    assert_true(t->length + length < TEXT_MOST);
    memcpy(t->bytes + t->length, bytes, length);
    t->length += length;
    t->bytes[t->length] = '\0';
}

static char *printed(csgm_trace *trace)
{
    text t = {malloc(TEXT_MOST), 0};
    assert_non_null(t.bytes);
    csg_trace_print(trace, add, &t);
    return t.bytes;
}

static size_t count_of(const char *in, const char *what)
{
    size_t count = 0;
    for (const char *at = in; (at = strstr(at, what)) != NULL; at++)
        count++;
    return count;
}

static double number_after(const char *in, const char *zone, const char *key)
{
    const char *at = strstr(in, zone);
    assert_non_null(at);
    at = strstr(at, key);
    assert_non_null(at);
    return strtod(at + strlen(key), NULL);
}

static void test_zones(void **state)
{
    csgm_trace *trace;
    assert_int_equal(csg_trace_create(NULL, 0, &trace), CSGM_OK);
    csg_trace_lanes *lanes = csg_trace_enter(trace, 1);
    assert_string_equal(csg_trace_open_name(lanes), "");
    csg_trace_begin(lanes, "outer", "a \"b\"\\\n\xff.txt");
    {
        csgm_context context = {.trace = lanes};
        CSG_ZONE(&context, "inner");
        assert_string_equal(csg_trace_open_name(lanes), "inner");
        csg_zone_count(&context, "cells", 7);
        csg_zone_count(&context, "blocks", 9);
    }
    assert_string_equal(csg_trace_open_name(lanes), "outer");
    csg_trace_begin(lanes, "left open", NULL);
    csg_trace_leave(lanes); /* ends both */
    char *json = printed(trace);
    assert_non_null(strstr(json, "\"args\":{\"cells\":7,\"blocks\":9}"));
    assert_non_null(strstr(json, "\"args\":{\"of\":\"a \\\"b\\\"\\\\??.txt\"}"));
    assert_int_equal(count_of(json, "\"ph\":\"X\""), 3);
    double outer = number_after(json, "\"outer\"", "\"ts\":"),
           inner = number_after(json, "\"inner\"", "\"ts\":");
    assert_true(outer <= inner);
    assert_true(outer + number_after(json, "\"outer\"", "\"dur\":") >=
                inner + number_after(json, "\"inner\"", "\"dur\":"));
    free(json);
    csg_trace_destroy(trace);
}

static void test_without(void **state)
{
    csgm_context context = {.trace = NULL};
    CSG_ZONE(&context, "nothing");
    csg_zone_count(&context, "cells", 7);
    csg_trace_leave(NULL);
    csg_trace_destroy(NULL);
}

static void test_depth(void **state)
{
    enum { DEPTH = 100, KEPT = 64 };
    csgm_trace *trace;
    assert_int_equal(csg_trace_create(NULL, 0, &trace), CSGM_OK);
    csg_trace_lanes *lanes = csg_trace_enter(trace, 1);
    for (int i = 0; i < DEPTH; i++)
        csg_trace_begin(lanes, "zone", NULL);
    csg_trace_count(lanes, "cells", 1);
    for (int i = 0; i < DEPTH; i++)
        csg_trace_end(lanes);
    csg_trace_end(lanes); /* one too many */
    csg_trace_leave(lanes);
    char *json = printed(trace);
    assert_int_equal(count_of(json, "\"ph\":\"X\""), KEPT);
    assert_int_equal(csg_trace_dropped(trace), DEPTH - KEPT);
    free(json);
    csg_trace_destroy(trace);
}

static void test_full(void **state)
{
    enum { ZONES = 5000, BYTES = 200000 };
    csgm_trace *trace;
    assert_int_equal(csg_trace_create(NULL, BYTES, &trace), CSGM_OK);
    csg_trace_lanes *lanes = csg_trace_enter(trace, 1);
    for (int i = 0; i < ZONES; i++) {
        csg_trace_begin(lanes, "zone", NULL);
        csg_trace_end(lanes);
    }
    csg_trace_leave(lanes);
    char *json = printed(trace), dropped[64];
    size_t kept = count_of(json, "\"ph\":\"X\"");
    assert_in_range(kept, 1, ZONES - 1);
    assert_int_equal(kept + csg_trace_dropped(trace), ZONES);
    snprintf(dropped, sizeof dropped, "\"dropped_zones\":%zu}", (size_t)csg_trace_dropped(trace));
    assert_non_null(strstr(json, dropped));
    free(json);
    csg_trace_destroy(trace);
}

static void test_lanes_are_handed_on(void **state)
{
    csgm_trace *trace;
    assert_int_equal(csg_trace_create(NULL, 0, &trace), CSGM_OK);
    csg_trace_lanes *first = csg_trace_enter(trace, 2);
    for (int i = 0; i < 3; i++) {
        csg_trace_lanes *later = csg_trace_enter(trace, 1);
        csg_trace_begin(later, "later", NULL);
        csg_trace_leave(later);
    }
    csg_trace_begin(first, "first", NULL);
    csg_trace_leave(first);
    char *json = printed(trace);
    assert_int_equal(count_of(json, "thread_name"), 2); /* the second had nothing to do */
    assert_int_equal(count_of(json, "\"ph\":\"X\",\"pid\":1,\"tid\":2,"), 3);
    assert_int_equal(count_of(json, "\"ph\":\"X\",\"pid\":1,\"tid\":0,"), 1);
    free(json);
    csg_trace_destroy(trace);
}

static bool spend_time(void *user, uint32_t worker, size_t index)
{
    volatile double *sums = user;
    for (int i = 0; i < 1000; i++)
        sums[worker] += (double)index;
    return true;
}

static void test_loops(void **state)
{
    enum { ITEMS = 2000, THREADS = 4 };
    csg_memory memory;
    csgm_trace *trace;
    double sums[THREADS] = {0};
    csg_memory_init(&memory, NULL, 0);
    assert_int_equal(csg_trace_create(NULL, 0, &trace), CSGM_OK);
    csg_pool *pool = csg_pool_create(&memory, THREADS);
    csg_trace_lanes *lanes = csg_trace_enter(trace, csg_pool_threads(pool));
    csg_pool_set_trace(pool, lanes);
    csg_trace_begin(lanes, "work", NULL);
    assert_true(csg_pool_run(pool, ITEMS, spend_time, NULL, sums));
    csg_trace_end(lanes);
    csg_pool_destroy(pool);
    csg_trace_leave(lanes);
    char *json = printed(trace);
    size_t items = 0;
    for (const char *at = json; (at = strstr(at, "\"items\":")) != NULL; at++)
        items += strtoul(at + strlen("\"items\":"), NULL, 10);
    assert_int_equal(items, ITEMS);
    assert_int_equal(count_of(json, "\"cat\":\"loop\",\"name\":\"work\""),
                     count_of(json, "\"caller\":0"));
    free(json);
    csg_trace_destroy(trace);
}

static void test_no_memory(void **state)
{
    bool done = false;
    for (long n = 0; !done; n++) {
        failing f = {.left = n};
        csgm_allocator allocator = {failing_alloc, failing_release, &f};
        csgm_trace *trace = NULL;
        if (csg_trace_create(&allocator, 0, &trace) == CSGM_OK) {
            csg_trace_lanes *lanes = csg_trace_enter(trace, 2);
            if (lanes) {
                csg_trace_begin(lanes, "zone", "note");
                csg_trace_end(lanes);
                csg_trace_leave(lanes);
                done = csg_trace_dropped(trace) == 0 && f.left >= 0;
                free(printed(trace));
            }
        }
        csg_trace_destroy(trace);
        assert_int_equal(f.live, 0);
        assert_true(n < 100);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_zones),
        cmocka_unit_test(test_without),
        cmocka_unit_test(test_depth),
        cmocka_unit_test(test_full),
        cmocka_unit_test(test_lanes_are_handed_on),
        cmocka_unit_test(test_loops),
        cmocka_unit_test(test_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
