/* SPDX-License-Identifier: MIT */
#include "outline/outline_support.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/random.h"

csg_memory memory;
static size_t countdown;

static void *counting_alloc(void *user, size_t size)
{
    (void)user;
    if (countdown == 1)
        return NULL;
    countdown -= countdown > 0;
    return malloc(size);
}

static void counting_release(void *user, void *pointer, size_t size)
{
    (void)user, (void)size;
    free(pointer);
}

void support_fail_at(size_t n)
{
    countdown = n;
}

int support_setup(void **state)
{
    csgm_allocator allocator = {counting_alloc, counting_release, NULL};
    (void)state;
    countdown = 0;
    csg_memory_init(&memory, &allocator, (uint64_t)256 << 20);
    return 0;
}

int support_teardown(void **state)
{
    (void)state;
    return memory.used_bytes == 0 ? 0 : -1;
}

void support_near_at(double a, double b, double tolerance, const char *file, int line)
{
    if (!(fabs(a - b) <= tolerance)) {
        print_error("%.17g is not %.17g within %g\n", a, b, tolerance);
        _fail(file, line);
    }
}

const char *support_folder;

csg_bytes support_file(const char *name)
{
    char path[1024];
    csg_bytes bytes;
    csg_problem problem = {""};
    snprintf(path, sizeof path, "%s/%s", support_folder, name);
    assert_int_equal(csg_bytes_read(&memory, path, &bytes, &problem), CSGM_OK);
    return bytes;
}

double support_area(const csg_outline *outline)
{
    double sum = 0;
    for (size_t loop = 0; loop < outline->loop_count; loop++) {
        size_t first = csg_outline_first(outline, loop), end = outline->ends[loop];
        for (size_t i = first; i < end; i++) {
            csg_vec2 a = outline->points[i], b = outline->points[i + 1 < end ? i + 1 : first];
            sum += (a.x * b.y - b.x * a.y) / 2;
        }
    }
    return sum;
}

void support_clean(csg_outline *outline)
{
    csg_outline clean;
    assert_int_equal(csg_polygons_clean(outline, CSG_FILL_NONZERO, &clean), CSGM_OK);
    csg_outline_release(outline);
    *outline = clean;
}

void support_expect(csg_outline *outline, double x0, double y0, double x1, double y1, double area,
                    double tolerance)
{
    support_clean(outline);
    csg_box box = csg_outline_box(outline);
    support_near(box.min.x, x0, tolerance);
    support_near(box.min.y, y0, tolerance);
    support_near(box.max.x, x1, tolerance);
    support_near(box.max.y, y1, tolerance);
    support_near(support_area(outline), area, tolerance * (x1 - x0 + y1 - y0));
}

void support_damage(const char *text, size_t length, int rounds,
                    void (*reader)(const char *text, size_t length))
{
    csg_random random = {7};
    for (int round = 0; round < rounds; round++) {
        char *copy = malloc(2 * length + 1);
        size_t size = length, at = csg_random_next(&random) % length;
        assert_non_null(copy);
        memcpy(copy, text, length);
        switch (round % 4) {
        case 0:
            size = at;
            break;
        case 1:
            copy[at] = (char)csg_random_next(&random);
            break;
        case 2:
            copy[at] = "0123456789-.eE<>\"\n #"[csg_random_next(&random) % 20];
            break;
        default:
            memcpy(copy + length, text + at, length - at);
            size = 2 * length - at;
        }
        char *exact = malloc(size + 1);
        assert_non_null(exact);
        memcpy(exact, copy, size);
        exact[size] = 0;
        reader(exact, size);
        free(exact);
        free(copy);
    }
}

void support_starve(const char *text, size_t length,
                    csgm_status (*reader)(const char *text, size_t length))
{
    csgm_status status = CSGM_ERR_MEMORY;
    for (size_t n = 1; n < 10000 && status != CSGM_OK; n++) {
        support_fail_at(n);
        status = reader(text, length);
        assert_true(status == CSGM_OK || status == CSGM_ERR_MEMORY);
        assert_true(memory.used_bytes == 0);
    }
    support_fail_at(0);
    assert_int_equal(status, CSGM_OK);
}
