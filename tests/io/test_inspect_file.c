/* SPDX-License-Identifier: MIT
 * A file that is gone through in runs has the figures that it has when it is read as a whole, to
 * the bit, in a memory that holds neither; and what is wrong with it is said in the same words.
 */
#include "support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/random.h"
#include "rounds.h"

enum { NARROW = 1900000 };

static void expect_same(const char *what, const csgm_file_figures *a, const csgm_file_figures *b)
{
    const csgm_mesh_check *x = &a->check, *y = &b->check;
    if (a->vertices != b->vertices || a->triangles != b->triangles ||
        a->has_normals != b->has_normals || a->has_colors != b->has_colors)
        fail_msg("%s: other counts", what);
    if (x->boundary_edges != y->boundary_edges || x->nonmanifold_edges != y->nonmanifold_edges ||
        x->misoriented_edges != y->misoriented_edges ||
        x->nonmanifold_vertices != y->nonmanifold_vertices ||
        x->degenerate_triangles != y->degenerate_triangles ||
        x->unused_vertices != y->unused_vertices ||
        x->zero_area_triangles != y->zero_area_triangles || x->euler != y->euler ||
        x->components != y->components || x->genus != y->genus)
        fail_msg(
            "%s: edges %d %d %d, fans %d, euler %d, components %d and not %d %d %d, %d, %d, %d",
            what, (int)x->boundary_edges, (int)x->nonmanifold_edges, (int)x->misoriented_edges,
            (int)x->nonmanifold_vertices, (int)x->euler, (int)x->components, (int)y->boundary_edges,
            (int)y->nonmanifold_edges, (int)y->misoriented_edges, (int)y->nonmanifold_vertices,
            (int)y->euler, (int)y->components);
    const double p[5] = {x->area, x->volume, x->min_angle_deg, x->max_aspect, x->bounds.min.x};
    const double q[5] = {y->area, y->volume, y->min_angle_deg, y->max_aspect, y->bounds.min.x};
    if (memcmp(p, q, sizeof p) != 0 || memcmp(&x->bounds, &y->bounds, sizeof x->bounds) != 0)
        fail_msg("%s: other measures", what);
}

/* The status of both ways, and their messages, are the same. Returns it. */
static csgm_status inspect_both(const char *path, csgm_file_figures *found)
{
    io_context wide, narrow;
    io_context_init(&wide, 0);
    io_context_init(&narrow, NARROW);
    csgm_file_figures whole = {0}, runs = {0};
    csgm_status status = csg_io_inspect(&wide.context, path, CSGM_FORMAT_AUTO, &whole);
    csgm_status other = csg_io_inspect(&narrow.context, path, CSGM_FORMAT_AUTO, &runs);
    if (status != other || strcmp(wide.last, narrow.last) != 0)
        fail_msg("%s: %d %s, and in runs %d %s", path, status, wide.last, other, narrow.last);
    if (!status)
        expect_same(path, &whole, &runs);
    assert_true(narrow.context.memory.peak_bytes <= NARROW);
    if (!status) /* reading it would have taken more */
        assert_true(wide.context.memory.peak_bytes > NARROW);
    io_context_check(&wide);
    io_context_check(&narrow);
    *found = runs;
    return status;
}

static void change(const char *path, long at, const void *bytes, size_t count)
{
    FILE *file = fopen(path, "r+b");
    assert_non_null(file);
    assert_int_equal(fseek(file, at, at < 0 ? SEEK_END : SEEK_SET), 0);
    assert_int_equal(fwrite(bytes, 1, count, file), count);
    fclose(file);
}

/* A sphere of 40 000 triangles, with some of them broken or none. */
static csgm_mesh *make_mesh(csgm_context *context, bool broken)
{
    csgm_mesh *mesh = io_sphere_make(context, 160, 126);
    for (uint64_t t = 7; broken && t + 2 < mesh->triangle_count; t += 5000) {
        uint32_t *v = mesh->indices + 3 * t;
        memcpy(v + 3, v, 3 * sizeof *v); /* its edges are used three times */
        v[6] = v[7];                     /* twice the same vertex */
        v[0] = mesh->indices[0];         /* elsewhere */
    }
    return mesh;
}

static void write_as(const csgm_mesh *mesh, csgm_context *context, const char *path)
{
    csgm_mesh_view view = csg_mesh_view(mesh);
    csgm_write_options options = csg_write_options_default();
    assert_int_equal(csg_io_write(context, &view, path, CSGM_FORMAT_AUTO, &options), CSGM_OK);
}

static void same_figures(void **state)
{
    (void)state;
    static const char *const names[] = {"a.stl", "a.ply"};
    io_context io;
    char folder[200], path[300];
    io_context_init(&io, 0);
    io_folder_make(folder, sizeof folder);
    for (int broken = 0; broken < 2; broken++) {
        csgm_mesh *mesh = make_mesh(&io.context, broken);
        for (size_t i = 0; i < 2; i++) {
            csgm_file_figures found;
            snprintf(path, sizeof path, "%s/%s", folder, names[i]);
            write_as(mesh, &io.context, path);
            assert_int_equal(inspect_both(path, &found), CSGM_OK);
            assert_int_equal(found.triangles, mesh->triangle_count);
            if (broken) {
                assert_true(found.check.boundary_edges && found.check.nonmanifold_edges);
                assert_true(found.check.degenerate_triangles);
            } else {
                assert_int_equal(found.check.boundary_edges, 0);
                assert_int_equal(found.check.euler, 2);
                assert_int_equal(found.check.components, 1);
            }
        }
        csg_mesh_destroy(mesh);
    }
    io_folder_remove(folder);
    io_context_check(&io);
}

/* Doubles, far from zero, so that there is an origin; other byte orders, properties, elements. */
static void other_headers(void **state)
{
    (void)state;
    enum { COLUMNS = 120, ROWS = 300 };
    char folder[200], path[300];
    io_folder_make(folder, sizeof folder);
    snprintf(path, sizeof path, "%s/a.ply", folder);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fprintf(file,
            "ply\nformat binary_big_endian 1.0\nelement vertex %d\nproperty uchar red\n"
            "property double z\nproperty double y\nproperty double x\nproperty uchar green\n"
            "property uchar blue\nelement edge 2\nproperty short a\nelement face %d\n"
            "property ushort flag\nproperty list ushort uint vertex_indices\nend_header\n",
            COLUMNS * ROWS, (COLUMNS - 1) * (ROWS - 1));
    for (int v = 0; v < COLUMNS * ROWS; v++) {
        const double at[3] = {1e6 + 0.1 * (v % 7), 3e6 + 0.3 * (v / COLUMNS), 0.7 * (v % COLUMNS)};
        fputc(1, file);
        for (int k = 0; k < 3; k++) {
            uint64_t bits;
            memcpy(&bits, &at[k], sizeof bits);
            for (int b = 56; b >= 0; b -= 8)
                fputc((int)(bits >> b & 255), file);
        }
        fputs("ab", file);
    }
    fputs("edge", file);
    for (int f = 0; f < (COLUMNS - 1) * (ROWS - 1); f++) {
        int corner = f % (COLUMNS - 1) + COLUMNS * (f / (COLUMNS - 1));
        const int quad[4] = {corner, corner + 1, corner + COLUMNS + 1, corner + COLUMNS};
        fwrite("xy\0\4", 1, 4, file);
        for (int k = 0; k < 4; k++)
            for (int b = 24; b >= 0; b -= 8)
                fputc(quad[k] >> b & 255, file);
    }
    fclose(file);
    csgm_file_figures found;
    assert_int_equal(inspect_both(path, &found), CSGM_OK);
    assert_true(found.has_colors && !found.has_normals);
    assert_int_equal(found.triangles, 2 * (COLUMNS - 1) * (ROWS - 1));
    assert_int_equal(found.check.boundary_edges, 2 * (COLUMNS + ROWS - 2));
    assert_int_equal(found.check.components, 1);
    assert_int_equal(unlink(path), 0);
    io_folder_remove(folder);
}

static void same_words(void **state)
{
    (void)state;
    static const uint8_t nothing[4] = {0, 0, 0xC0, 0x7F}, many[4] = {0xFF, 0xFF, 0xFF, 0x7F};
    io_context io;
    char folder[200], path[300];
    csgm_file_figures found;
    io_context_init(&io, 0);
    io_folder_make(folder, sizeof folder);
    csgm_mesh *mesh = make_mesh(&io.context, false);
    snprintf(path, sizeof path, "%s/a.stl", folder);
    write_as(mesh, &io.context, path);
    change(path, -30, nothing, 4); /* the last triangle's */
    assert_int_equal(inspect_both(path, &found), CSGM_ERR_FORMAT);
    snprintf(path, sizeof path, "%s/a.ply", folder);
    write_as(mesh, &io.context, path);
    change(path, -4, many, 4); /* a vertex that is not there */
    assert_int_equal(inspect_both(path, &found), CSGM_ERR_FORMAT);
    change(path, -13, "\4", 1); /* four corners, of which there are three */
    write_as(mesh, &io.context, path);
    change(path, -13, "\4", 1);
    assert_int_equal(inspect_both(path, &found), CSGM_ERR_FORMAT);
    csg_mesh_destroy(mesh);
    io_folder_remove(folder);
    io_context_check(&io);
}

/* Bytes changed anywhere, most of them in the head: the same figures or the same refusal, unless
 * what came out has no runs and no room. */
static void changed_bytes(void **state)
{
    (void)state;
    static const char *const names[] = {"a.ply", "a.stl"};
    enum { CHANGES = ROUNDS(12) };
    io_context io;
    char folder[200], path[300];
    csg_random random = {7};
    io_context_init(&io, 0);
    io_folder_make(folder, sizeof folder);
    csgm_mesh *mesh = make_mesh(&io.context, false);
    uint32_t answered = 0;
    for (uint32_t i = 0; i < 2 * CHANGES; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i % 2]);
        write_as(mesh, &io.context, path);
        for (int k = 0; k < 3; k++) {
            uint8_t byte = (uint8_t)csg_random_next(&random);
            uint32_t span = csg_random_next(&random) % 2 ? 250 : 1000000;
            change(path, (long)(csg_random_next(&random) % span), &byte, 1);
        }
        io_context wide, narrow;
        io_context_init(&wide, 0);
        io_context_init(&narrow, NARROW);
        csgm_file_figures whole = {0}, runs = {0};
        csgm_status status = csg_io_inspect(&wide.context, path, CSGM_FORMAT_AUTO, &whole);
        csgm_status other = csg_io_inspect(&narrow.context, path, CSGM_FORMAT_AUTO, &runs);
        if (other != CSGM_ERR_MEMORY && (status != other || strcmp(wide.last, narrow.last) != 0))
            fail_msg("change %d: %d %s, and in runs %d %s", (int)i, status, wide.last, other,
                     narrow.last);
        if (!other)
            expect_same(path, &whole, &runs);
        answered += other != CSGM_ERR_MEMORY;
        io_context_check(&wide);
        io_context_check(&narrow);
    }
    assert_true(answered > CHANGES);
    csg_mesh_destroy(mesh);
    io_folder_remove(folder);
    io_context_check(&io);
}

/* Too little even for the triangles' sets is said, and ends at once. */
static void too_narrow(void **state)
{
    (void)state;
    io_context io, narrow;
    char folder[200], path[300];
    csgm_file_figures found;
    io_context_init(&io, 0);
    io_folder_make(folder, sizeof folder);
    csgm_mesh *mesh = make_mesh(&io.context, false);
    snprintf(path, sizeof path, "%s/a.stl", folder);
    write_as(mesh, &io.context, path);
    csg_mesh_destroy(mesh);
    for (uint64_t limit = 1000; limit < 1000000; limit += 50000) {
        io_context_init(&narrow, limit);
        csgm_status status = csg_io_inspect(&narrow.context, path, CSGM_FORMAT_AUTO, &found);
        assert_int_equal(status, CSGM_ERR_MEMORY);
        assert_int_equal(narrow.findings, 1);
        io_context_check(&narrow);
    }
    io_folder_remove(folder);
    io_context_check(&io);
}

/* The sets of its triangles alone would take more than there is: a closed manifold needs none. */
static void large_manifold(void **state)
{
    (void)state;
    io_context io;
    char folder[200], path[300];
    csgm_file_figures found;
    io_context_init(&io, 0);
    io_folder_make(folder, sizeof folder);
    csgm_mesh *mesh = io_sphere_make(&io.context, 700, 350);
    assert_true(mesh->triangle_count * sizeof(uint32_t) > NARROW);
    snprintf(path, sizeof path, "%s/a.ply", folder);
    write_as(mesh, &io.context, path);
    assert_int_equal(inspect_both(path, &found), CSGM_OK);
    assert_int_equal(found.check.euler, 2);
    csg_mesh_destroy(mesh);
    io_folder_remove(folder);
    io_context_check(&io);
}

/* Vertices in the order in which triangles have them, as where meshes are made. */
static void put_in_order(csgm_mesh *mesh)
{
    uint64_t count = mesh->vertex_count;
    uint32_t *number = malloc(count * sizeof *number), next = 0;
    float *positions = malloc(3 * count * sizeof *positions);
    assert_true(number && positions);
    memset(number, 0xFF, count * sizeof *number);
    memcpy(positions, mesh->positions, 3 * count * sizeof *positions);
    for (uint64_t i = 0; i < 3 * mesh->triangle_count; i++) {
        uint32_t v = mesh->indices[i];
        if (number[v] == UINT32_MAX) {
            number[v] = next++;
            memcpy(mesh->positions + 3 * (size_t)number[v], positions + 3 * (size_t)v,
                   3 * sizeof *positions);
        }
        mesh->indices[i] = number[v];
    }
    free(number);
    free(positions);
}

/* Two spheres, one behind the other, and a vertex of the one that the other has in the place of one
 * of its own; NONE: all stay. */
static csgm_mesh *make_pair(csgm_context *context, uint32_t from, uint32_t to)
{
    csgm_mesh *one = io_sphere_make(context, 160, 126), *pair;
    put_in_order(one);
    uint32_t vertices = (uint32_t)one->vertex_count;
    assert_int_equal(csg_mesh_create(context, 2 * one->vertex_count, 2 * one->triangle_count, false,
                                     false, &pair),
                     CSGM_OK);
    for (uint32_t v = 0; v < 2 * vertices; v++) {
        memcpy(pair->positions + 3 * (size_t)v, one->positions + 3 * (size_t)(v % vertices),
               3 * sizeof(float));
        pair->positions[3 * (size_t)v] += v < vertices ? 0 : 100;
    }
    for (size_t i = 0; i < 6 * one->triangle_count; i++) {
        size_t half = 3 * one->triangle_count;
        uint32_t v = one->indices[i % half] + (i < half ? 0 : vertices);
        pair->indices[i] = v == from ? to : v;
    }
    csg_mesh_destroy(one);
    return pair;
}

/* In the order of a pack of cards. */
static void shuffle(csgm_mesh *mesh)
{
    csg_random random = {11};
    for (uint64_t t = mesh->triangle_count - 1; t > 0; t--) {
        uint32_t kept[3], *a = mesh->indices + 3 * t;
        uint32_t *b = mesh->indices + 3 * (csg_random_next(&random) % (t + 1));
        memcpy(kept, a, sizeof kept);
        memcpy(a, b, sizeof kept);
        memcpy(b, kept, sizeof kept);
    }
}

/* Two fans at one vertex, each closed in a run of its own, before the run that the vertex counts to
 * or behind it; and triangles in no order at all. */
static void fans_far_apart(void **state)
{
    (void)state;
    enum { FIRST = 500, SECOND = 30000, PAIRS = 3, SHUFFLED = ROUNDS(PAIRS) };
    static const uint32_t pairs[PAIRS][2] = {{UINT32_MAX, 0}, {FIRST, SECOND}, {SECOND, FIRST}};
    io_context io;
    char folder[200], path[300];
    csgm_file_figures found;
    io_context_init(&io, 0);
    io_folder_make(folder, sizeof folder);
    snprintf(path, sizeof path, "%s/a.ply", folder);
    for (int i = 0; i < PAIRS + SHUFFLED; i++) {
        int k = i < PAIRS ? i : 2 * PAIRS - 1 - i; /* a pair that is joined is shuffled first */
        csgm_mesh *mesh = make_pair(&io.context, pairs[k][0], pairs[k][1]);
        if (i >= PAIRS)
            shuffle(mesh);
        write_as(mesh, &io.context, path);
        assert_int_equal(inspect_both(path, &found), CSGM_OK);
        assert_int_equal(found.check.components, 2);
        assert_int_equal(found.check.nonmanifold_vertices, k > 0);
        assert_int_equal(found.check.unused_vertices, k > 0);
        csg_mesh_destroy(mesh);
    }
    io_folder_remove(folder);
    io_context_check(&io);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_figures),   cmocka_unit_test(other_headers),
        cmocka_unit_test(same_words),     cmocka_unit_test(changed_bytes),
        cmocka_unit_test(too_narrow),     cmocka_unit_test(large_manifold),
        cmocka_unit_test(fans_far_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
