/* SPDX-License-Identifier: MIT
 * Every shape through every format and back: the same triangles, the same bytes a second time.
 */
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/adapter.h"

/* A format with options, as its row says. */
typedef struct way {
    const char *name; /* of the file */
    uint32_t traits;
    bool ascii, draco, meshopt, khr;
    bool keeps_vertices; /* same order and number; else corners are compared triangle by triangle */
} way;

static double coordinate(const csgm_mesh_view *m, uint64_t corner, int axis)
{
    return (&m->origin.x)[axis] +
           (double)m->positions[3 * (uint64_t)m->indices[corner] + (uint64_t)axis];
}

static void expect_near(const char *what, double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%s: %.17g is not %.17g within %g", what, a, b, tolerance);
}

/* Corner by corner, in file order. */
static void same_corners(const way *w, const csgm_mesh_view *a, const csgm_mesh_view *b,
                         double tolerance)
{
    assert_int_equal(a->triangle_count, b->triangle_count);
    for (uint64_t i = 0; i < 3 * a->triangle_count; i++) {
        for (int k = 0; k < 3; k++)
            expect_near(w->name, coordinate(a, i, k), coordinate(b, i, k), tolerance);
        if (w->keeps_vertices)
            assert_int_equal(a->indices[i], b->indices[i]);
    }
}

static void same_attributes(const way *w, const csgm_mesh_view *a, const csgm_mesh_view *b)
{
    assert_int_equal(a->vertex_count, b->vertex_count);
    assert_int_equal(w->traits & CSGM_KEEPS_NORMALS && a->normals, b->normals != NULL);
    assert_int_equal(w->traits & CSGM_KEEPS_COLORS && a->colors, b->colors != NULL);
    for (uint64_t i = 0; b->normals && i < 3 * a->vertex_count; i++)
        assert_true(a->normals[i] == b->normals[i]); /* 0 is -0 */
    for (uint64_t i = 0; b->colors && i < a->vertex_count; i++)
        assert_memory_equal(a->colors + 4 * i, b->colors + 4 * i,
                            w->traits & CSGM_KEEPS_ALPHA ? 4 : 3);
}

/* Volume and area agree: for formats that reorder. */
static void measure(const csgm_mesh_view *m, double out[4])
{
    memset(out, 0, 4 * sizeof *out);
    for (uint64_t i = 0; i < 3 * m->triangle_count; i += 3) {
        double p[3][3], n[3];
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 3; k++)
                p[c][k] = coordinate(m, i + (uint64_t)c, k) - (&m->origin.x)[k];
        for (int k = 0; k < 3; k++) {
            int u = (k + 1) % 3, v = (k + 2) % 3;
            n[k] = (p[1][u] - p[0][u]) * (p[2][v] - p[0][v]) -
                   (p[1][v] - p[0][v]) * (p[2][u] - p[0][u]);
        }
        out[0] += (p[0][0] * n[0] + p[0][1] * n[1] + p[0][2] * n[2]) / 6;
        for (int k = 0; k < 3; k++)
            out[1 + k] += fabs(n[k]) / 2; /* area seen along each axis */
    }
}

static void same_solid(const way *w, const csgm_mesh_view *a, const csgm_mesh_view *b)
{
    double in[4], out[4];
    assert_int_equal(a->triangle_count, b->triangle_count);
    csgm_mesh_view local_a = *a, local_b = *b;
    local_a.origin = local_b.origin = (csgm_vec3){0, 0, 0};
    measure(&local_a, in);
    measure(&local_b, out);
    for (int k = 0; k < 4; k++)
        expect_near(w->name, in[k], out[k], 2e-3 * fabs(in[k]) + 1e-4);
}

/* Names and stretches of parts, in formats that have such. */
static void same_parts(const way *w, const csgm_mesh_view *a, const csgm_mesh_view *b)
{
    bool kept = w->traits & CSGM_KEEPS_NAMES;
    assert_int_equal(b->part_count, kept ? a->part_count : 0);
    for (uint64_t i = 0; i < b->part_count; i++) {
        assert_int_equal(a->parts[i].triangle_count, b->parts[i].triangle_count);
        assert_int_equal(a->parts[i].first_triangle, b->parts[i].first_triangle);
        assert_int_equal(!a->parts[i].name, !b->parts[i].name);
        if (a->parts[i].name)
            assert_string_equal(a->parts[i].name, b->parts[i].name);
    }
}

static void check_way(const way *w, io_shape shape, const char *folder)
{
    io_context io;
    char path[256];
    csgm_write_options options = csg_write_options_default();
    options.ascii = w->ascii;
    options.draco = w->draco;
    options.meshopt = w->meshopt;
    options.meshopt_khr = w->khr;
    io_context_init(&io, 64 << 20);
    csgm_mesh *mesh = io_shape_make(&io.context, shape), *back = NULL;
    csgm_mesh_view view = csg_mesh_view(mesh);
    snprintf(path, sizeof path, "%s/%s", folder, w->name);
    csgm_status status = csg_io_write(&io.context, &view, path, CSGM_FORMAT_AUTO, &options);
    if (shape == IO_EMPTY && w->traits & CSGM_HEEDS_DRACO_BITS) { /* Draco has no empty mesh */
        assert_int_equal(status, CSGM_ERR_UNSUPPORTED);
        csg_mesh_destroy(mesh);
        io_context_check(&io);
        return;
    }
    assert_int_equal(status, CSGM_OK);
    size_t size, again_size;
    uint8_t *bytes = io_file_load(path, &size);
    assert_int_equal(csg_io_write(&io.context, &view, path, CSGM_FORMAT_AUTO, &options), CSGM_OK);
    uint8_t *again = io_file_load(path, &again_size);
    assert_int_equal(size, again_size);
    assert_memory_equal(bytes, again, size);
    free(bytes);
    free(again);
    status = csg_io_read(&io.context, path, CSGM_FORMAT_AUTO, &back);
    if (status)
        fail_msg("%s of %s: %s", w->name, io_shape_names[shape], io.last);
    csgm_mesh_view read = csg_mesh_view(back);
    bool far = shape == IO_FAR;
    bool floats_only = far && !(w->traits & CSGM_KEEPS_DOUBLES);
    if (w->draco || w->meshopt) {
        if (!floats_only) /* floats and 14 bits: only the count survives */
            same_solid(w, &view, &read);
    } else {
        /* floats in steps of 1/32, and up to two of them more so that nothing collapses */
        same_corners(w, &view, &read, floats_only ? 0.08 : far ? 1e-6 : 0);
    }
    assert_int_equal(view.triangle_count, read.triangle_count);
    same_parts(w, &view, &read);
    if (w->keeps_vertices)
        same_attributes(w, &view, &read);
    /* these parts stand in one place; told at both writes */
    bool joins_parts = shape == IO_PARTS && !(w->traits & CSGM_KEEPS_VERTICES);
    assert_int_equal(io.findings, joins_parts ? 2 : 0);
    csg_mesh_destroy(back);
    csg_mesh_destroy(mesh);
    io_context_check(&io);
}

static void check_shapes(const way *w, const char *folder)
{
    for (int shape = 0; shape < IO_SHAPES; shape++)
        check_way(w, (io_shape)shape, folder);
}

static void every_shape_in_every_format(void **state)
{
    (void)state;
    char folder[128], name[32];
    int count = 0;
    io_folder_make(folder, sizeof folder);
    for (int f = CSGM_FORMAT_AUTO + 1; f < CSGM_FORMAT_COUNT; f++) {
        csgm_format format = (csgm_format)f;
        if (!csg_format_available(format, false) || !csg_format_available(format, true))
            continue;
        way w = {.name = name, .traits = csg_format_traits(format)};
        w.draco = w.traits & CSGM_HEEDS_DRACO_BITS;
        w.keeps_vertices = w.traits & CSGM_KEEPS_VERTICES;
        snprintf(name, sizeof name, "a.%s", csg_format_name(format));
        check_shapes(&w, folder);
        w.ascii = w.traits & CSGM_HEEDS_ASCII;
        if (w.ascii)
            check_shapes(&w, folder);
        w.draco = w.traits & CSGM_HEEDS_DRACO && csg_format_available(CSGM_FORMAT_DRC, false);
        w.ascii = w.keeps_vertices = false;
        if (w.draco)
            check_shapes(&w, folder);
        w.meshopt = w.traits & CSGM_HEEDS_MESHOPT && csg_meshopt_available();
        w.draco = false;
        if (w.meshopt)
            check_shapes(&w, folder);
        w.khr = w.meshopt;
        if (w.khr)
            check_shapes(&w, folder);
        count++;
    }
    assert_in_range(count, 4, CSGM_FORMAT_COUNT); /* four need no library */
    io_folder_remove(folder);
}

/* The sphere, where one triangle has a copy of its first corner with a normal of its own. */
static csgm_mesh *make_split(csgm_context *context, const csgm_mesh *from, uint64_t corner)
{
    csgm_mesh *mesh = NULL;
    uint32_t vertex = from->indices[corner];
    assert_int_equal(
        csg_mesh_create(context, from->vertex_count + 1, from->triangle_count, true, false, &mesh),
        CSGM_OK);
    for (uint64_t i = 0; i < mesh->vertex_count; i++) {
        uint64_t old = i > vertex ? i - 1 : i;
        memcpy(mesh->positions + 3 * i, from->positions + 3 * old, 12);
        memcpy(mesh->normals + 3 * i, from->normals + 3 * old, 12);
    }
    mesh->normals[3 * (uint64_t)vertex + 3] *= -1;
    for (uint64_t i = 0; i < 3 * from->triangle_count; i++)
        mesh->indices[i] = from->indices[i] + (from->indices[i] > vertex || i == corner);
    mesh->split = true;
    return mesh;
}

/* A place far behind among the indices takes more bytes than the number of a vertex. */
static void compressed_merges_have_room(void **state)
{
    (void)state;
    char folder[128], path[256];
    if (!csg_meshopt_available())
        skip();
    io_context io;
    io_context_init(&io, 64 << 20);
    io_folder_make(folder, sizeof folder);
    snprintf(path, sizeof path, "%s/a.gltf", folder);
    csgm_write_options options = csg_write_options_default();
    options.meshopt = true;
    csgm_mesh *sphere = io_sphere_make(&io.context, 63, 63);
    for (uint64_t corner = 300; corner < 3 * sphere->triangle_count; corner += 3000) {
        csgm_mesh *mesh = make_split(&io.context, sphere, corner);
        csgm_mesh_view view = csg_mesh_view(mesh);
        assert_int_equal(csg_io_write(&io.context, &view, path, CSGM_FORMAT_AUTO, &options),
                         CSGM_OK);
        size_t size;
        char *text = (char *)io_file_load(path, &size);
        assert_non_null(strstr(text, "EXT_mesh_manifold"));
        assert_null(strstr(text, "\"byteLength\":0,"));
        free(text);
        csg_mesh_destroy(mesh);
    }
    csg_mesh_destroy(sphere);
    io_folder_remove(folder);
    io_context_check(&io);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_shape_in_every_format),
                                       cmocka_unit_test(compressed_merges_have_room)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
