/* SPDX-License-Identifier: MIT
 * Height fields. The numbers of solids are those of `openscad -o x.off` (2021.01) for
 * surface("table.dat") and for the images in files/.
 */
#include <stdio.h>

#include "outline/outline_support.h"

#include "outline/heights/heights.h"

static csg_problem problem;

static csg_heights read_text(const char *text)
{
    csg_heights heights;
    problem = (csg_problem){""};
    assert_int_equal(csg_heights_from_text(&memory, text, strlen(text), &heights, &problem),
                     CSGM_OK);
    return heights;
}

static csgm_status refuse_text(const char *text)
{
    csg_heights heights;
    problem = (csg_problem){""};
    csgm_status status = csg_heights_from_text(&memory, text, strlen(text), &heights, &problem);
    assert_int_not_equal(status, CSGM_OK);
    assert_int_not_equal(strlen(problem.text), 0);
    assert_null(heights.values);
    return status;
}

static const char table[] = "# comment\n0 1 2\n3 4 5 \n\n6 7 9\n";

static void test_table(void **state)
{
    (void)state;
    csg_heights h = read_text(table);
    assert_int_equal(h.columns, 3);
    assert_int_equal(h.rows, 3);
    support_near(h.values[0], 0, 0);
    support_near(h.values[5], 5, 0); /* column 2 of row 1 */
    support_near(h.values[8], 9, 0);
    support_near(h.lowest, 0, 0);
    csg_heights_release(&h);
    h = read_text("1e2 -3\r\n.5\t+4. # here\r\n");
    support_near(h.values[0], 100, 0);
    support_near(h.values[1], -3, 0);
    support_near(h.values[2], 0.5, 0);
    support_near(h.lowest, -3, 0);
    csg_heights_release(&h);
}

/* Short rows are filled by zeros, which do not count as the lowest value. */
static void test_short_rows(void **state)
{
    (void)state;
    csg_heights h = read_text("2 3 4\n5 6\n");
    assert_int_equal(h.missing, 1);
    support_near(h.values[5], 0, 0);
    support_near(h.lowest, 2, 0);
    csg_heights_release(&h);
}

static void test_bad_tables(void **state)
{
    (void)state;
    assert_int_equal(refuse_text(""), CSGM_ERR_FORMAT);
    assert_int_equal(refuse_text("# nothing\n"), CSGM_ERR_FORMAT);
    assert_int_equal(refuse_text("1 2\n3 x\n"), CSGM_ERR_FORMAT);
    assert_non_null(strstr(problem.text, "line 2"));
    assert_int_equal(refuse_text("1 2\n3 nan\n"), CSGM_ERR_FORMAT);
    assert_int_equal(refuse_text("1 2\n3 inf\n"), CSGM_ERR_FORMAT);
    assert_int_equal(refuse_text("1 2\n3 1e999\n"), CSGM_ERR_FORMAT);
    assert_int_equal(refuse_text("1 2\n3 1e300\n"), CSGM_ERR_FORMAT);
    assert_int_equal(refuse_text("1,2\n3,4\n"), CSGM_ERR_FORMAT);
    assert_int_equal(refuse_text("0x10 2\n3 4\n"), CSGM_ERR_FORMAT);
}

/* One row as wide as there are rows: their product would not fit into memory. */
static void test_huge_table(void **state)
{
    enum { SIDE = 5000 };
    static char text[4 * SIDE + 1];
    (void)state;
    for (int i = 0; i < SIDE; i++)
        memcpy(text + 2 * i, "1 ", 2);
    text[2 * SIDE - 1] = '\n';
    for (int i = 0; i < SIDE; i++)
        memcpy(text + 2 * SIDE + 2 * i, "1\n", 2);
    assert_int_equal(refuse_text(text), CSGM_ERR_LIMIT);
}

static double volume_of(const csg_triangles *t)
{
    double sum = 0;
    for (size_t i = 0; i < t->count; i++) {
        const uint32_t *c = t->corners[i];
        sum += csg_vec3_dot(t->points[c[0]], csg_vec3_cross(t->points[c[1]], t->points[c[2]])) / 6;
    }
    return sum;
}

/* Every edge as often one way as the other. */
static void expect_closed(const csg_triangles *t)
{
    for (size_t i = 0; i < t->count; i++)
        for (int k = 0; k < 3; k++) {
            uint32_t a = t->corners[i][k], b = t->corners[i][(k + 1) % 3];
            int sum = 0, same = 0;
            for (size_t j = 0; j < t->count; j++)
                for (int l = 0; l < 3; l++) {
                    uint32_t c = t->corners[j][l], d = t->corners[j][(l + 1) % 3];
                    same += a == c && b == d;
                    sum += (a == c && b == d) - (a == d && b == c);
                }
            assert_int_equal(sum, 0);
            assert_int_equal(same, 1);
        }
}

static bool has_point(const csg_triangles *t, double x, double y, double z, double tolerance)
{
    for (size_t i = 0; i < t->point_count; i++)
        if (fabs(t->points[i].x - x) + fabs(t->points[i].y - y) + fabs(t->points[i].z - z) <=
            tolerance)
            return true;
    return false;
}

static void expect_box(const csg_triangles *t, csg_box box)
{
    csg_box b = csg_triangles_box(t);
    support_near(b.min.x, box.min.x, 1e-4);
    support_near(b.min.y, box.min.y, 1e-4);
    support_near(b.min.z, box.min.z, 2e-4);
    support_near(b.max.x, box.max.x, 1e-4);
    support_near(b.max.y, box.max.y, 1e-4);
    support_near(b.max.z, box.max.z, 1e-4);
}

static void test_solid(void **state)
{
    static const double expected[][3] = {
        {0, 0, 0},     {1, 0, 1},  {0.5, 0.5, 2}, {1, 1, 4},  {0, 1, 3},  {2, 0, 2},
        {1.5, 0.5, 3}, {2, 1, 5},  {0.5, 1.5, 5}, {1, 2, 7},  {0, 2, 6},  {1.5, 1.5, 6.25},
        {2, 2, 9},     {0, 0, -1}, {0, 1, -1},    {2, 1, -1}, {2, 0, -1}, {0, 2, -1},
        {2, 2, -1},    {1, 0, -1}, {1, 2, -1}};
    csg_triangles t;
    (void)state;
    csg_heights h = read_text(table);
    assert_int_equal(csg_heights_solid(&h, false, &t, &problem), CSGM_OK);
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++)
        assert_true(has_point(&t, expected[i][0], expected[i][1], expected[i][2], 0));
    assert_int_equal(t.count, 16 + 8 * 3);
    expect_closed(&t);
    /* a pyramid's mean over a cell is the mean of its corners and centre with weights 1/6, 1/3 */
    support_near(volume_of(&t), (2 + 3 + 5 + 6.25) + 4, 1e-12);
    csg_triangles_release(&t);
    assert_int_equal(csg_heights_solid(&h, true, &t, &problem), CSGM_OK);
    expect_box(&t, (csg_box){{-1, -1, -1}, {1, 1, 9}});
    csg_triangles_release(&t);
    csg_heights_release(&h);
}

/* The base is never above 0, even under a mesa. */
static void test_base(void **state)
{
    csg_triangles t;
    (void)state;
    csg_heights h = read_text("5 5 5\n5 5 5\n");
    assert_int_equal(csg_heights_solid(&h, false, &t, &problem), CSGM_OK);
    expect_box(&t, (csg_box){{0, 0, 0}, {2, 1, 5}});
    expect_closed(&t);
    support_near(volume_of(&t), 10, 1e-12);
    csg_triangles_release(&t);
    csg_heights_release(&h);
    h = read_text("1\n2\n3\n");
    problem = (csg_problem){""};
    assert_int_equal(csg_heights_solid(&h, false, &t, &problem), CSGM_ERR_SCENE);
    assert_int_not_equal(strlen(problem.text), 0);
    csg_triangles_release(&t);
    csg_heights_release(&h);
}

static csg_heights read_image(const char *name, bool invert, csgm_status expected)
{
    csg_heights heights;
    csg_bytes bytes = support_file(name);
    problem = (csg_problem){""};
    assert_int_equal(csg_heights_from_bytes(&memory, &bytes, invert, &heights, &problem), expected);
    csg_bytes_release(&bytes);
    return heights;
}

static void test_images(void **state)
{
    csg_triangles t;
    (void)state;
    csg_heights h = read_image("gray.png", false, CSGM_OK);
    assert_int_equal(csg_heights_solid(&h, false, &t, &problem), CSGM_OK);
    assert_true(has_point(&t, 0, 0, 3.92157, 1e-5));
    assert_true(has_point(&t, 0.5, 0.5, 15.4902, 1e-4));
    assert_true(has_point(&t, 1.5, 0.5, 42.451, 1e-4));
    expect_box(&t, (csg_box){{0, 0, -1}, {2, 1, 100}});
    csg_triangles_release(&t);
    csg_heights_release(&h);
    h = read_image("rgba.png", false, CSGM_OK);
    support_near(h.values[0], 7.22, 1e-9);
    support_near(h.values[1], 100, 1e-9);
    support_near(h.values[2], 21.26, 1e-9);
    support_near(h.values[3], 71.52, 1e-9);
    csg_heights_release(&h);
    h = read_image("gray.png", true, CSGM_OK);
    assert_int_equal(csg_heights_solid(&h, false, &t, &problem), CSGM_OK);
    assert_true(has_point(&t, 0, 0, -3.52941, 1e-5));
    expect_box(&t, (csg_box){{0, 0, -100.608}, {2, 1, 0.392157}});
    csg_triangles_release(&t);
    csg_heights_release(&h);
}

/* OpenSCAD drops the lower eight bits (50.1961); we do not. */
static void test_sixteen_bits(void **state)
{
    (void)state;
    csg_heights h = read_image("gray16.png", false, CSGM_OK);
    support_near(h.values[2], 100.0 * 0x8040 / 0xffff, 1e-12);
    support_near(h.values[3], 100.0 * 0x1234 / 0xffff, 1e-12);
    csg_heights_release(&h);
    h = read_image("palette_interlaced.png", false, CSGM_OK);
    support_near(h.values[2], 0, 1e-9);
    support_near(h.values[3], 100, 1e-9);
    support_near(h.values[0], 21.26, 1e-9);
    support_near(h.values[1], 7.22, 1e-9);
    csg_heights_release(&h);
}

static void test_bombs(void **state)
{
    (void)state;
    read_image("bomb_sides.png", false, CSGM_ERR_FORMAT);
    assert_int_not_equal(strlen(problem.text), 0);
    read_image("bomb_area.png", false, CSGM_ERR_LIMIT);
    assert_int_not_equal(strlen(problem.text), 0);
}

static void read_damaged(const char *text, size_t length)
{
    csg_heights heights;
    csg_bytes bytes = {&memory, (char *)(uintptr_t)text, length};
    csgm_status status = csg_heights_from_bytes(&memory, &bytes, false, &heights, &problem);
    assert_true(status == CSGM_OK || status == CSGM_ERR_FORMAT || status == CSGM_ERR_LIMIT ||
                status == CSGM_ERR_MEMORY);
    csg_heights_release(&heights);
}

static csgm_status read_starved(const char *text, size_t length)
{
    csg_heights heights;
    csg_triangles t;
    csg_bytes bytes = {&memory, (char *)(uintptr_t)text, length};
    csgm_status status = csg_heights_from_bytes(&memory, &bytes, false, &heights, &problem);
    if (status != CSGM_OK)
        return status;
    status = csg_heights_solid(&heights, false, &t, &problem);
    csg_triangles_release(&t);
    csg_heights_release(&heights);
    return status;
}

static void test_damage(void **state)
{
    static const char *const names[] = {"gray.png", "rgba.png", "palette_interlaced.png"};
    (void)state;
    support_damage(table, strlen(table), 400, read_damaged);
    support_starve(table, strlen(table), read_starved);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        csg_bytes bytes = support_file(names[i]);
        support_damage(bytes.data, bytes.size, 400, read_damaged);
        csg_bytes_release(&bytes);
    }
}

/* libpng may go on without what it was refused, so only leaks are looked for. */
static void test_starved_image(void **state)
{
    (void)state;
    csg_bytes bytes = support_file("palette_interlaced.png");
    for (size_t n = 1; n < 40; n++) {
        support_fail_at(n);
        read_damaged(bytes.data, bytes.size);
        support_fail_at(0);
    }
    csg_bytes_release(&bytes);
}

static void test_no_file(void **state)
{
    csg_bytes bytes;
    (void)state;
    problem = (csg_problem){""};
    assert_int_equal(csg_bytes_read(&memory, "/no/such/file", &bytes, &problem), CSGM_ERR_IO);
    assert_non_null(strstr(problem.text, "No such file"));
    problem = (csg_problem){""};
    assert_int_equal(csg_bytes_read(&memory, support_folder, &bytes, &problem), CSGM_ERR_IO);
    assert_non_null(strstr(problem.text, "folder"));
    assert_int_equal(csg_bytes_read(&memory, "/dev/zero", &bytes, &problem), CSGM_ERR_IO);
}

int main(int argument_count, char **arguments)
{
    support_folder = argument_count > 1 ? arguments[1] : ".";
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_table, support_setup, support_teardown),
        cmocka_unit_test_setup_teardown(test_short_rows, support_setup, support_teardown),
        cmocka_unit_test_setup_teardown(test_bad_tables, support_setup, support_teardown),
        cmocka_unit_test_setup_teardown(test_huge_table, support_setup, support_teardown),
        cmocka_unit_test_setup_teardown(test_solid, support_setup, support_teardown),
        cmocka_unit_test_setup_teardown(test_base, support_setup, support_teardown),
        cmocka_unit_test_setup_teardown(test_images, support_setup, support_teardown),
        cmocka_unit_test_setup_teardown(test_sixteen_bits, support_setup, support_teardown),
        cmocka_unit_test_setup_teardown(test_bombs, support_setup, support_teardown),
        cmocka_unit_test_setup_teardown(test_damage, support_setup, support_teardown),
        cmocka_unit_test_setup_teardown(test_starved_image, support_setup, support_teardown),
        cmocka_unit_test_setup_teardown(test_no_file, support_setup, support_teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
