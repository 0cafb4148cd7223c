/* SPDX-License-Identifier: MIT
 * Inspection of meshes whose counts are known by hand, and of random triangle soups against a
 * slow count that shares nothing with it.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/clock.h"
#include "base/random.h"
#include "mesh/inspect.h"
#include "mesh/small_meshes.h"

static void assert_near(double value, double expected, double tolerance)
{
    assert_true(fabs(value - expected) <= tolerance);
}

static csgm_mesh_check inspect(const float *positions, uint64_t vertices, const uint32_t *indices,
                               uint64_t triangles)
{
    csgm_context context = {0};
    csg_memory_init(&context.memory, NULL, 0);
    csgm_mesh_view view = {.positions = positions,
                           .indices = indices,
                           .vertex_count = vertices,
                           .triangle_count = triangles};
    csgm_mesh_check check;
    assert_int_equal(csg_mesh_inspect(&context, &view, 0, &check), CSGM_OK);
    assert_int_equal(atomic_load(&context.memory.used_bytes), 0);
    return check;
}

static void assert_closed(const csgm_mesh_check *check)
{
    assert_int_equal(check->boundary_edges, 0);
    assert_int_equal(check->nonmanifold_edges, 0);
    assert_int_equal(check->misoriented_edges, 0);
    assert_int_equal(check->nonmanifold_vertices, 0);
    assert_int_equal(check->degenerate_triangles, 0);
    assert_int_equal(check->index_out_of_range, 0);
}

#define COUNT(array) (sizeof(array) / sizeof *(array))

static void test_cube(void **state)
{
    csgm_mesh_check check = inspect(cube_positions, 8, cube_indices, 12);
    assert_closed(&check);
    assert_int_equal(check.euler, 2);
    assert_int_equal(check.components, 1);
    assert_int_equal(check.genus, 0);
    assert_near(check.area, 6, 1e-14);
    assert_near(check.volume, 1, 1e-14);
    assert_near(check.min_angle_deg, 45, 1e-9);
    assert_near(check.bounds.max.z, 1, 0);
    assert_near(check.bounds.min.x, 0, 0);
}

static void test_origin_moves_the_bounds_only(void **state)
{
    csgm_context context = {0};
    csg_memory_init(&context.memory, NULL, 0);
    csgm_mesh_view view = {.origin = {1e9, -1e9, 5},
                           .positions = cube_positions,
                           .indices = cube_indices,
                           .vertex_count = 8,
                           .triangle_count = 12};
    csgm_mesh_check check;
    assert_int_equal(csg_mesh_inspect(&context, &view, 0, &check), CSGM_OK);
    assert_near(check.volume, 1, 1e-14);
    assert_near(check.bounds.min.x, 1e9, 0);
    assert_near(check.bounds.max.y, -1e9 + 1, 0);
}

static void test_hole(void **state)
{
    csgm_mesh_check check = inspect(tetra_positions, 4, tetra_indices, 3);
    assert_int_equal(check.boundary_edges, 3);
    assert_int_equal(check.euler, 1);
    assert_int_equal(check.nonmanifold_vertices, 0);
}

static void test_flipped_triangle(void **state)
{
    uint32_t indices[12];
    memcpy(indices, tetra_indices, sizeof indices);
    indices[0] = 1;
    indices[2] = 0;
    indices[1] = 2;
    csgm_mesh_check check = inspect(tetra_positions, 4, indices, 4);
    assert_int_equal(check.misoriented_edges, 3);
    assert_int_equal(check.boundary_edges, 0);
    assert_int_equal(check.euler, 2);
}

/* One vertex with two fans, two components. */
static void test_touching_vertex(void **state)
{
    float positions[21];
    uint32_t indices[24];
    small_touching_tetrahedra(positions, indices);
    csgm_mesh_check check = inspect(positions, 7, indices, 8);
    assert_int_equal(check.nonmanifold_vertices, 1);
    assert_int_equal(check.nonmanifold_edges, 0);
    assert_int_equal(check.misoriented_edges, 0);
    assert_int_equal(check.components, 2);
    assert_int_equal(check.euler, 3);
    assert_near(check.volume, 1.0 / 3, 1e-14);
}

/* Two tetrahedra with an edge in common: that edge is used four times. */
static void test_touching_edge(void **state)
{
    const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1};
    uint32_t indices[24];
    const uint32_t second[] = {0, 1, 4, 5};
    for (int i = 0; i < 12; i++) {
        indices[i] = tetra_indices[i];
        indices[12 + i] = second[tetra_indices[i]];
    }
    csgm_mesh_check check = inspect(positions, 6, indices, 8);
    assert_int_equal(check.nonmanifold_edges, 1);
    assert_int_equal(check.boundary_edges, 0);
    assert_int_equal(check.components, 1);
    assert_int_equal(check.euler, 6 - 11 + 8);
}

static void test_broken_indices(void **state)
{
    const uint32_t indices[] = {0, 1, 9, 0, 0, 1, UINT32_MAX, UINT32_MAX, 2, 0, 2, 1};
    csgm_mesh_check check = inspect(tetra_positions, 4, indices, 4);
    assert_int_equal(check.index_out_of_range, 3);
    assert_int_equal(check.degenerate_triangles, 1);
    assert_int_equal(check.boundary_edges, 3);
    assert_int_equal(check.unused_vertices, 1);
    assert_int_equal(check.components, 1);
    assert_int_equal(check.euler, 1);
}

static void test_empty(void **state)
{
    csgm_mesh_check check = inspect(NULL, 0, NULL, 0);
    assert_closed(&check);
    assert_int_equal(check.euler, 0);
    assert_int_equal(check.components, 0);
    check = inspect(tetra_positions, 4, NULL, 0);
    assert_int_equal(check.unused_vertices, 4);
    assert_near(check.min_angle_deg, 0, 0);
}

static void test_slivers(void **state)
{
    const float positions[] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0};
    const uint32_t indices[] = {0, 1, 2, 0, 1, 3};
    csgm_mesh_check check = inspect(positions, 4, indices, 2);
    assert_int_equal(check.zero_area_triangles, 1);
    assert_near(check.min_angle_deg, 0, 0);
    assert_near(check.area, 0.5, 1e-14);
    const uint32_t right[] = {0, 2, 3};
    check = inspect(positions, 4, right, 1);
    assert_near(check.min_angle_deg, 26.56505117707799, 1e-12);
}

/* A torus of n by m quads. */
static void test_torus(void **state)
{
    enum { N = 40, M = 16 };
    static float positions[3 * N * M];
    static uint32_t indices[6 * N * M];
    const double tau = 2 * acos(-1);
    for (uint32_t i = 0; i < N * M; i++) {
        double a = tau * (i / M) / N, b = tau * (i % M) / M;
        positions[3 * i] = (float)((3 + cos(b)) * cos(a));
        positions[3 * i + 1] = (float)((3 + cos(b)) * sin(a));
        positions[3 * i + 2] = (float)sin(b);
        uint32_t right = (i + M) % (N * M), up = i / M * M + (i + 1) % M;
        uint32_t both = right / M * M + (i + 1) % M;
        const uint32_t quad[] = {i, right, both, i, both, up};
        memcpy(indices + 6 * i, quad, sizeof quad);
    }
    csgm_mesh_check check = inspect(positions, N * M, indices, 2 * N * M);
    assert_closed(&check);
    assert_int_equal(check.euler, 0);
    assert_int_equal(check.genus, 1);
    assert_true(check.volume > 0.95 * 0.5 * tau * tau * 3 && check.volume < 0.5 * tau * tau * 3);
}

/* ---- soups: counts by brute force ----------------------------------------------------- */

enum { SOUP_VERTICES = 12, SOUP_TRIANGLES = 40 };

static void count_slowly(const uint32_t *indices, size_t triangles, csgm_mesh_check *check)
{
    uint32_t forward[SOUP_VERTICES][SOUP_VERTICES] = {{0}};
    bool used[SOUP_VERTICES] = {false};
    uint64_t edges = 0, faces = 0, vertices = 0;
    *check = (csgm_mesh_check){0};
    for (size_t t = 0; t < triangles; t++) {
        const uint32_t *v = indices + 3 * t;
        if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) {
            check->degenerate_triangles++;
            continue;
        }
        faces++;
        for (int k = 0; k < 3; k++) {
            forward[v[k]][v[(k + 1) % 3]]++;
            used[v[k]] = true;
        }
    }
    for (size_t a = 0; a < SOUP_VERTICES; a++) {
        vertices += used[a];
        for (size_t b = a + 1; b < SOUP_VERTICES; b++) {
            uint32_t uses = forward[a][b] + forward[b][a];
            edges += uses > 0;
            check->boundary_edges += uses == 1;
            check->nonmanifold_edges += uses > 2;
            check->misoriented_edges += uses == 2 && forward[a][b] != 1;
        }
    }
    check->unused_vertices = SOUP_VERTICES - vertices;
    check->euler = (int64_t)vertices - (int64_t)edges + (int64_t)faces;
}

static bool share_edge(const uint32_t *a, const uint32_t *b)
{
    int common = 0;
    for (int i = 0; i < 9; i++)
        common += a[i / 3] == b[i % 3];
    return common >= 2;
}

static bool is_degenerate(const uint32_t *v)
{
    return v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
}

/* Labels spread along `joined` pairs until nothing changes; returns how many are left. */
static uint64_t count_groups(const uint32_t *indices, const size_t *triangles, size_t count)
{
    size_t label[SOUP_TRIANGLES];
    for (size_t i = 0; i < count; i++)
        label[i] = i;
    for (bool changed = true; changed;) {
        changed = false;
        for (size_t i = 0; i < count * count; i++) {
            size_t a = i / count, b = i % count;
            if (label[b] < label[a] &&
                share_edge(indices + 3 * triangles[a], indices + 3 * triangles[b])) {
                label[a] = label[b];
                changed = true;
            }
        }
    }
    uint64_t groups = 0;
    for (size_t i = 0; i < count; i++)
        groups += label[i] == i;
    return groups;
}

/* Fans at a vertex: its triangles, joined by edges that end there. Two triangles at the vertex may
 * also share the edge opposite to it alone, which does not join them: they then have all three
 * vertices in common and share the other edges too. */
static void count_groups_slowly(const uint32_t *indices, size_t triangles, csgm_mesh_check *check)
{
    size_t list[SOUP_TRIANGLES], count = 0;
    for (size_t t = 0; t < triangles; t++)
        if (!is_degenerate(indices + 3 * t))
            list[count++] = t;
    check->components = count_groups(indices, list, count);
    for (uint32_t v = 0; v < SOUP_VERTICES; v++) {
        count = 0;
        for (size_t t = 0; t < triangles; t++) {
            const uint32_t *corner = indices + 3 * t;
            if (!is_degenerate(corner) && (corner[0] == v || corner[1] == v || corner[2] == v))
                list[count++] = t;
        }
        check->nonmanifold_vertices += count_groups(indices, list, count) > 1;
    }
}

static void test_soups(void **state)
{
    csg_random random = {7};
    float positions[3 * SOUP_VERTICES];
    uint32_t indices[3 * SOUP_TRIANGLES];
    for (int round = 0; round < 2000; round++) {
        for (size_t i = 0; i < COUNT(positions); i++)
            positions[i] = (float)csg_random_uniform(&random, -1, 1);
        size_t triangles = csg_random_below(&random, SOUP_TRIANGLES);
        for (size_t i = 0; i < COUNT(indices); i++)
            indices[i] = csg_random_below(&random, SOUP_VERTICES);
        csgm_mesh_check fast = inspect(positions, SOUP_VERTICES, indices, triangles), slow;
        count_slowly(indices, triangles, &slow);
        count_groups_slowly(indices, triangles, &slow);
        assert_int_equal(fast.boundary_edges, slow.boundary_edges);
        assert_int_equal(fast.nonmanifold_edges, slow.nonmanifold_edges);
        assert_int_equal(fast.misoriented_edges, slow.misoriented_edges);
        assert_int_equal(fast.degenerate_triangles, slow.degenerate_triangles);
        assert_int_equal(fast.unused_vertices, slow.unused_vertices);
        assert_int_equal(fast.euler, slow.euler);
        assert_int_equal(fast.components, slow.components);
        assert_int_equal(fast.nonmanifold_vertices, slow.nonmanifold_vertices);
    }
}

/* A fan of 20 000 triangles around vertex 0: one bucket holds most half-edges. */
static void test_star(void **state)
{
    enum { RIM = 20000 };
    static float positions[3 * (RIM + 1)];
    static uint32_t indices[3 * RIM];
    for (uint32_t i = 0; i < RIM; i++) {
        positions[3 * i + 3] = (float)cos(i * 2 * acos(-1) / RIM);
        positions[3 * i + 4] = (float)sin(i * 2 * acos(-1) / RIM);
        const uint32_t triangle[] = {0, i + 1, (i + 1) % RIM + 1};
        memcpy(indices + 3 * i, triangle, sizeof triangle);
    }
    csgm_mesh_check check = inspect(positions, RIM + 1, indices, RIM);
    assert_int_equal(check.boundary_edges, RIM);
    assert_int_equal(check.euler, 1);
    assert_int_equal(check.nonmanifold_vertices, 0);
}

/* ---- parts ------------------------------------------------------------------------ */

enum { CUBE_CORNERS = 36 };

/* Two cubes that touch in a face, each corner of a triangle a vertex of its own, as files have them
 * that keep creases. `cut`: the triangles of the first part end in the midst of the first cube. */
static csgm_mesh_check inspect_two_cubes(bool has_parts, bool cut)
{
    float positions[2 * CUBE_CORNERS * 3];
    uint32_t indices[2 * CUBE_CORNERS];
    for (size_t i = 0; i < 2 * CUBE_CORNERS; i++) {
        const float *at = cube_positions + 3 * (size_t)cube_indices[i % CUBE_CORNERS];
        positions[3 * i] = at[0] + (i < CUBE_CORNERS ? 0 : 1);
        positions[3 * i + 1] = at[1];
        positions[3 * i + 2] = at[2];
        indices[i] = (uint32_t)i;
    }
    const uint64_t first = cut ? 5 : 12;
    const csgm_mesh_part parts[] = {{.triangle_count = first},
                                    {.first_triangle = first, .triangle_count = 24 - first}};
    csgm_context context = {0};
    csg_memory_init(&context.memory, NULL, 0);
    csgm_mesh_view view = {.positions = positions,
                           .indices = indices,
                           .vertex_count = COUNT(indices),
                           .triangle_count = COUNT(indices) / 3,
                           .parts = has_parts ? parts : NULL,
                           .part_count = has_parts ? 2 : 0};
    csgm_mesh_check check;
    assert_int_equal(csg_mesh_inspect(&context, &view, 0, &check), CSGM_OK);
    assert_int_equal(atomic_load(&context.memory.used_bytes), 0);
    return check;
}

/* Each is closed for itself; without parts, edges of the face they share are used four times. */
static void test_parts_that_touch(void **state)
{
    csgm_mesh_check check = inspect_two_cubes(true, false);
    assert_closed(&check);
    assert_int_equal(check.components, 2);
    check = inspect_two_cubes(false, false);
    assert_int_equal(check.boundary_edges, 0);
    assert_int_equal(check.nonmanifold_edges, 5); /* four and the diagonal */
    (void)state;
}

/* A solid whose parts are not solids, as one that is cut by its materials: they are joined. */
static void test_parts_that_are_open(void **state)
{
    csgm_mesh_check check = inspect_two_cubes(true, true);
    assert_int_equal(check.boundary_edges, 0);
    assert_int_equal(check.nonmanifold_edges, 5);
    (void)state;
}

/* Copies stand one after the other; the last of a part and the first of the next have one place. */
static void test_split_parts(void **state)
{
    static const uint32_t indices[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 4,
                                       5, 6, 7, 5, 8, 6, 5, 7, 8, 6, 8, 7};
    static const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0,
                                      1, 0, 0, 1, 1, 0, 1, 0, 1, 1, 0, 0, 2};
    static const csgm_mesh_part parts[] = {{.triangle_count = 4},
                                           {.first_triangle = 4, .triangle_count = 4}};
    csgm_context context = {0};
    csg_memory_init(&context.memory, NULL, 0);
    csgm_mesh_view view = {.positions = positions,
                           .indices = indices,
                           .vertex_count = 9,
                           .triangle_count = 8,
                           .parts = parts,
                           .part_count = 2,
                           .split = true};
    csgm_mesh_check check;
    assert_int_equal(csg_mesh_inspect(&context, &view, 0, &check), CSGM_OK);
    assert_closed(&check);
    assert_int_equal(check.components, 2);
    (void)state;
}

/* ---- limits ----------------------------------------------------------------------- */

static bool is_cancelled(void *user)
{
    return --*(int *)user < 0;
}

/* The clock is looked at from the beginning on, and between and within all passes. */
static void test_time(void **state)
{
    csgm_context context = {.limits = {.timeout_s = 1}};
    csg_memory_init(&context.memory, NULL, 0);
    csgm_mesh_view view = {.positions = cube_positions,
                           .indices = cube_indices,
                           .vertex_count = 8,
                           .triangle_count = 12};
    csgm_mesh_check check;
    assert_int_equal(csg_mesh_inspect(&context, &view, csg_clock_now_s() - 2, &check),
                     CSGM_ERR_LIMIT);
    assert_int_equal(context.diags.errors, 1);
    assert_int_equal(csg_mesh_inspect(&context, &view, 0, &check), CSGM_OK);
    int looks = 0, left = 0;
    context.cancelled = is_cancelled;
    context.cancel_user = &left;
    for (csgm_status status = CSGM_CANCELLED; status != CSGM_OK; looks++) {
        left = looks;
        status = csg_mesh_inspect(&context, &view, 0, &check);
        assert_true(status == CSGM_OK || status == CSGM_CANCELLED);
        assert_int_equal(atomic_load(&context.memory.used_bytes), 0);
    }
    assert_true(looks > 12); /* six passes: in the first step of each, and after it */
    (void)state;
}

static void *no_memory(void *user, size_t size_bytes)
{
    int *left = user;
    return (*left)-- > 0 ? test_malloc(size_bytes) : NULL;
}

static void give_back(void *user, void *memory, size_t size_bytes)
{
    (void)user;
    (void)size_bytes;
    test_free(memory);
}

static void test_no_memory(void **state)
{
    for (int allowed = 0; allowed < 4; allowed++) {
        int left = allowed;
        csgm_context context = {0};
        csg_memory_init(&context.memory, &(csgm_allocator){no_memory, give_back, &left}, 0);
        csgm_mesh_view view = {.positions = cube_positions,
                               .indices = cube_indices,
                               .vertex_count = 8,
                               .triangle_count = 12};
        csgm_mesh_check check;
        assert_int_equal(csg_mesh_inspect(&context, &view, 0, &check), CSGM_ERR_MEMORY);
        assert_int_equal(context.diags.errors, 1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cube),
        cmocka_unit_test(test_origin_moves_the_bounds_only),
        cmocka_unit_test(test_hole),
        cmocka_unit_test(test_flipped_triangle),
        cmocka_unit_test(test_touching_vertex),
        cmocka_unit_test(test_touching_edge),
        cmocka_unit_test(test_broken_indices),
        cmocka_unit_test(test_empty),
        cmocka_unit_test(test_slivers),
        cmocka_unit_test(test_torus),
        cmocka_unit_test(test_soups),
        cmocka_unit_test(test_star),
        cmocka_unit_test(test_parts_that_touch),
        cmocka_unit_test(test_parts_that_are_open),
        cmocka_unit_test(test_split_parts),
        cmocka_unit_test(test_time),
        cmocka_unit_test(test_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
