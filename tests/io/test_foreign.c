/* SPDX-License-Identifier: MIT
 * Forms that csgmesh itself does not write: other byte orders and types, polygons, strips, node
 * trees, creased normals; and what writing promises beyond the round trip: limits, options, exact
 * colours.
 */
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "io/format_table.h"
#include "rounds.h"

static csgm_mesh *read_as(io_context *io, const char *name, const void *bytes, size_t size)
{
    csgm_mesh *mesh = NULL;
    csgm_status status =
        csg_io_read_memory(&io->context, bytes, size, name, CSGM_FORMAT_AUTO, &mesh);
    if (status)
        fail_msg("%s: %s", name, io->last);
    return mesh;
}

static csgm_mesh *read_text(io_context *io, const char *name, const char *text)
{
    return read_as(io, name, text, strlen(text));
}

static void expect_position(const csgm_mesh *mesh, uint64_t i, double x, double y, double z)
{
    const double expected[3] = {x, y, z};
    for (uint64_t k = 0; k < 3; k++)
        if (fabs((double)mesh->positions[3 * i + k] - expected[k]) > 1e-6)
            fail_msg("vertex %d axis %d: %g, not %g", (int)i, (int)k,
                     (double)mesh->positions[3 * i + k], expected[k]);
}

static void expect_triangle(const csgm_mesh *mesh, uint64_t i, uint32_t a, uint32_t b, uint32_t c)
{
    assert_true(i < mesh->triangle_count);
    assert_int_equal(mesh->indices[3 * i], a);
    assert_int_equal(mesh->indices[3 * i + 1], b);
    assert_int_equal(mesh->indices[3 * i + 2], c);
}

static void ply_of_other_types(void **state)
{
    (void)state;
    io_context io;
    io_context_init(&io, 0);
    static const char head[] =
        "ply\r\nformat binary_big_endian 1.0\r\ncomment hello\r\nelement note 1\r\n"
        "property list ushort char words\r\nelement vertex 4\r\nproperty uchar red\r\n"
        "property short z\r\nproperty double x\r\nproperty uchar green\r\nproperty uchar blue\r\n"
        "property float y\r\nelement face 1\r\nproperty uchar flags\r\n"
        "property list int ushort vertex_index\r\nend_header\r\n";
    uint8_t file[sizeof head + 256], *at = file + sizeof head - 1;
    memcpy(file, head, sizeof head - 1);
    memcpy(at, "\0\003abc", 5);
    at += 5;
    for (int i = 0; i < 4; i++) {
        static const uint8_t one_double[2][8] = {{0}, {0x3F, 0xF0}};
        static const uint8_t two_float[2][4] = {{0}, {0x40, 0}};
        *at++ = (uint8_t)(10 + i);
        memcpy(at, "\377\376", 2); /* z = -2 */
        memcpy(at + 2, one_double[i & 1], 8);
        at[10] = 20;
        at[11] = 30;
        memcpy(at + 12, two_float[i >> 1], 4);
        at += 16;
    }
    memcpy(at, "\7\0\0\0\4\0\0\0\1\0\3\0\2", 13);
    at += 13;
    csgm_mesh *mesh = read_as(&io, "a.ply", file, (size_t)(at - file));
    assert_int_equal(mesh->vertex_count, 4);
    assert_int_equal(mesh->triangle_count, 2);
    expect_position(mesh, 3, 1, 2, -2);
    expect_triangle(mesh, 0, 0, 1, 3);
    expect_triangle(mesh, 1, 0, 3, 2);
    assert_memory_equal(mesh->colors + 8, "\14\24\36\377", 4);
    assert_null(mesh->normals);
    csg_mesh_destroy(mesh);
    io_context_check(&io);
}

static void obj_of_other_forms(void **state)
{
    (void)state;
    io_context io;
    io_context_init(&io, 0);
    csgm_mesh *mesh = read_text(&io, "a.obj",
                                "mtllib a.mtl\no cube\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\r\n"
                                "v 1 1 0 0 0 1\nv 0 1 0 1 1 1 # white\nvt 0 0\nvn 0 0 1\n"
                                "g side\ns off\nusemtl m\nf 1/1/1 2/1/1 \\\n 3/1/1 -1/-1/-1\n");
    assert_int_equal(mesh->vertex_count, 4);
    expect_triangle(mesh, 0, 0, 1, 2);
    expect_triangle(mesh, 1, 0, 2, 3);
    assert_memory_equal(mesh->colors + 4, "\0\377\0\377", 4);
    assert_non_null(mesh->normals);
    assert_true(mesh->normals[3 * 3 + 2] == 1);
    csg_mesh_destroy(mesh);
    /* a crease: two normals at one vertex keep the vertex whole and leave the normals out */
    mesh = read_text(&io, "b.obj",
                     "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 -1\nvn 0 -1 0\n"
                     "f 1//1 3//1 2//1\nf 1//2 2//2 4//2\n");
    assert_int_equal(mesh->vertex_count, 4);
    assert_null(mesh->normals);
    csg_mesh_destroy(mesh);
    io_context_check(&io);
}

static void off_of_other_forms(void **state)
{
    (void)state;
    io_context io;
    io_context_init(&io, 0);
    csgm_mesh *mesh = read_text(&io, "a.off",
                                "STCNOFF\n# comment\n\n4 2 0\n0 0 0  0 0 1  1.0 0.5 0. 1.0  0 0\n"
                                "1 0 0  0 0 1  1. .5 0. 0.5  0 0\n1 1 0 0 0 1 255 128 0 255 0 0\n"
                                "0 1 0 0 0 1 1 2 3 4 0 0\n4 0 1 2 3 255 0 0\n3 0 1 2\n");
    assert_int_equal(mesh->triangle_count, 3);
    expect_triangle(mesh, 1, 0, 2, 3);
    assert_memory_equal(mesh->colors, "\377\200\0\377\377\200\0\200\377\200\0\377\1\2\3\4", 16);
    assert_true(mesh->normals[2] == 1);
    csg_mesh_destroy(mesh);
    io_context_check(&io);
}

/* Reads a PLY without an extension by its first bytes, from a pipe. */
static void pipe_is_told_by_content(void **state)
{
    (void)state;
    io_context io;
    io_context_init(&io, 0);
    int ends[2];
    csgm_mesh *mesh = io_shape_make(&io.context, IO_CUBE), *back = NULL;
    csgm_mesh_view view = csg_mesh_view(mesh);
    for (int format = CSGM_FORMAT_AUTO + 1; format < CSGM_FORMAT_COUNT; format++) {
        if (!csg_format_available((csgm_format)format, true) ||
            !csg_format_available((csgm_format)format, false) ||
            !*csg_format_find((csgm_format)format)->first_bytes)
            continue;
        assert_int_equal(pipe(ends), 0);
        assert_int_equal(csg_io_write_fd(&io.context, &view, ends[1], "standard output",
                                         (csgm_format)format, NULL),
                         CSGM_OK);
        close(ends[1]);
        assert_int_equal(
            csg_io_read_fd(&io.context, ends[0], "standard input", CSGM_FORMAT_AUTO, &back),
            CSGM_OK);
        close(ends[0]);
        assert_int_equal(back->triangle_count, 12);
        csg_mesh_destroy(back);
    }
    csg_mesh_destroy(mesh);
    io_context_check(&io);
}

/* ---- glTF ------------------------------------------------------------------------- */

/* Three vertices (0 0 0), (1 0 0), (0 1 0) with stride 16, then indices 0 1 2 as bytes. */
static void fill_triangle(uint8_t buffer[52])
{
    static const float corners[3][4] = {{0, 0, 0, 9}, {1, 0, 0, 9}, {0, 1, 0, 9}};
    memcpy(buffer, corners, 48);
    memcpy(buffer + 48, "\0\1\2\0", 4);
}

#define TRIANGLE_PARTS                                                                             \
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"      \
    "{\"bufferView\":1,\"componentType\":5121,\"count\":3,\"type\":\"SCALAR\"}],"                  \
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48,\"byteStride\":16},"                         \
    "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":3}],"                                          \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],"

static void nodes_are_applied_and_turned(void **state)
{
    (void)state;
    if (!csg_format_available(CSGM_FORMAT_GLTF, true))
        skip();
    io_context io;
    io_context_init(&io, 0);
    char folder[128], path[256];
    uint8_t buffer[52];
    io_folder_make(folder, sizeof folder);
    fill_triangle(buffer);
    snprintf(path, sizeof path, "%s/a b.bin", folder);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(buffer, 1, sizeof buffer, file), sizeof buffer);
    fclose(file);
    snprintf(path, sizeof path, "%s/a.gltf", folder);
    /* a parent that moves up by 5 (glTF's y), a child twice as large, a mirrored sibling, a stray
     */
    csgm_mesh *mesh = read_text(
        &io, path,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,2]}],"
        "\"nodes\":[{\"translation\":[0,5,0],\"children\":[1]},{\"mesh\":0,\"scale\":[2,2,2]},"
        "{\"mesh\":0,\"scale\":[-1,1,1],\"rotation\":[0,0,0,1]},{\"mesh\":0}]," TRIANGLE_PARTS
        "\"buffers\":[{\"byteLength\":52,\"uri\":\"a%20b.bin\"}]}");
    assert_int_equal(mesh->vertex_count, 6);
    assert_int_equal(mesh->triangle_count, 2);
    expect_position(mesh, 0, 0, 0, 5000); /* y up became z up, metres millimetres */
    expect_position(mesh, 1, 2000, 0, 5000);
    expect_position(mesh, 2, 0, 0, 7000);
    expect_triangle(mesh, 0, 0, 1, 2);
    expect_position(mesh, 4, -1000, 0, 0);
    expect_triangle(mesh, 1, 3, 5, 4); /* mirrored: turned around */
    csg_mesh_destroy(mesh);
    io_folder_remove(folder);
    io_context_check(&io);
}

static void strips_become_triangles(void **state)
{
    (void)state;
    if (!csg_format_available(CSGM_FORMAT_GLTF, true))
        skip();
    io_context io;
    io_context_init(&io, 0);
    /* positions of signed bytes, normalised, without indices, strip of four; an older file of
     * ours, whose numbers are taken as they are */
    csgm_mesh *mesh = read_text(
        &io, "a.gltf",
        "{\"asset\":{\"version\":\"2.0\",\"generator\":\"csgmesh "
        "0.1.0\"},\"extensionsRequired\":[\"KHR_mesh_quantization\"],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5120,\"normalized\":true,\"count\":4,"
        "\"type\":\"VEC3\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":16,\"byteStride\":4}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":5}]}],"
        "\"buffers\":[{\"byteLength\":16,\"uri\":"
        "\"data:application/octet-stream;base64,AAAAAH8AAAAAfwAAf38AAA==\"}]}");
    assert_int_equal(mesh->triangle_count, 2);
    expect_triangle(mesh, 0, 0, 1, 2);
    expect_triangle(mesh, 1, 2, 1, 3);
    expect_position(mesh, 3, 1, 0, 1);
    csg_mesh_destroy(mesh);
    io_context_check(&io);
}

/* ---- writing ---------------------------------------------------------------------- */

static void all_colors_survive_gltf(void **state)
{
    (void)state;
    if (!csg_format_available(CSGM_FORMAT_GLB, true))
        skip();
    io_context io;
    io_context_init(&io, 0);
    csgm_mesh *mesh = io_sphere_make(&io.context, 40, 26), *back = NULL;
    csgm_mesh_view view = csg_mesh_view(mesh);
    for (uint64_t i = 0; i < 4 * view.vertex_count; i++)
        mesh->colors[i] = (uint8_t)(i / 4 + 64 * (i % 4));
    char folder[128], path[256];
    io_folder_make(folder, sizeof folder);
    snprintf(path, sizeof path, "%s/a.glb", folder);
    assert_int_equal(csg_io_write(&io.context, &view, path, CSGM_FORMAT_AUTO, NULL), CSGM_OK);
    assert_int_equal(csg_io_read(&io.context, path, CSGM_FORMAT_AUTO, &back), CSGM_OK);
    assert_memory_equal(mesh->colors, back->colors, 4 * view.vertex_count);
    csg_mesh_destroy(back);
    csg_mesh_destroy(mesh);
    io_folder_remove(folder);
    io_context_check(&io);
}

static size_t draco_size(io_context *io, const csgm_mesh_view *view, csgm_write_options options)
{
    char folder[128], path[256];
    size_t size;
    io_folder_make(folder, sizeof folder);
    snprintf(path, sizeof path, "%s/a.drc", folder);
    assert_int_equal(csg_io_write(&io->context, view, path, CSGM_FORMAT_AUTO, &options), CSGM_OK);
    free(io_file_load(path, &size));
    io_folder_remove(folder);
    return size;
}

/* The scene's coordinates, to the bit, whatever the file's root does to them. */
static void units_come_back(void **state)
{
    (void)state;
    if (!csg_format_available(CSGM_FORMAT_GLB, true))
        skip();
    io_context io;
    char folder[128], path[256];
    io_context_init(&io, 0);
    io_folder_make(folder, sizeof folder);
    snprintf(path, sizeof path, "%s/a.glb", folder);
    csgm_mesh *mesh = io_sphere_make(&io.context, 40, 26);
    for (int unit = CSGM_UNIT_NONE; unit <= CSGM_UNIT_IN; unit++)
        for (int up = 0; up < 2; up++)
            for (int far = 0; far < 2; far++) {
                csgm_mesh *back = NULL;
                csgm_write_options options = csg_write_options_default();
                options.unit = (csgm_unit)unit;
                options.y_up = up;
                mesh->origin = far ? (csgm_vec3){1024, -2048.5, 4096} : (csgm_vec3){0, 0, 0};
                csgm_mesh_view view = csg_mesh_view(mesh);
                assert_int_equal(csg_io_write(&io.context, &view, path, CSGM_FORMAT_AUTO, &options),
                                 CSGM_OK);
                assert_int_equal(csg_io_read(&io.context, path, CSGM_FORMAT_AUTO, &back), CSGM_OK);
                const double *a = &mesh->origin.x, *b = &back->origin.x;
                for (uint64_t i = 0; i < 3 * view.vertex_count; i++)
                    assert_true((float)(a[i % 3] + (double)mesh->positions[i]) ==
                                (float)(b[i % 3] + (double)back->positions[i]));
                csg_mesh_destroy(back);
            }
    csg_mesh_destroy(mesh);
    io_folder_remove(folder);
    io_context_check(&io);
}

/* One colour is a material's; each byte of it comes back, and that there was none, too. */
static void single_colors_come_back(void **state)
{
    (void)state;
    if (!csg_format_available(CSGM_FORMAT_GLB, true))
        skip();
    io_context io;
    char folder[128], path[256];
    io_context_init(&io, 0);
    io_folder_make(folder, sizeof folder);
    snprintf(path, sizeof path, "%s/a.glb", folder);
    csgm_mesh *mesh = io_shape_make(&io.context, IO_TETRAHEDRON);
    csgm_mesh_view view = csg_mesh_view(mesh);
    uint8_t colors[4 * 4];
    assert_int_equal(view.vertex_count, 4);
    for (int level = 0; level <= 256; level++) {
        csgm_mesh *back = NULL;
        for (int i = 0; i < 16; i++)
            colors[i] = (uint8_t)(level + i % 4 * 85);
        view.colors = level < 256 ? colors : NULL;
        assert_int_equal(csg_io_write(&io.context, &view, path, CSGM_FORMAT_AUTO, NULL), CSGM_OK);
        assert_int_equal(csg_io_read(&io.context, path, CSGM_FORMAT_AUTO, &back), CSGM_OK);
        if (level < 256)
            assert_memory_equal(back->colors, colors, sizeof colors);
        else
            assert_null(back->colors);
        csg_mesh_destroy(back);
    }
    csg_mesh_destroy(mesh);
    io_folder_remove(folder);
    io_context_check(&io);
}

static void draco_options_count(void **state)
{
    (void)state;
    if (!csg_format_available(CSGM_FORMAT_DRC, false))
        skip();
    io_context io;
    io_context_init(&io, 0);
    csgm_mesh *mesh = io_sphere_make(&io.context, 100, 60);
    csgm_mesh_view view = csg_mesh_view(mesh);
    csgm_write_options usual = csg_write_options_default(), other = usual;
    size_t size = draco_size(&io, &view, usual);
    other.draco_position_bits = 20;
    assert_true(draco_size(&io, &view, other) > size);
    other = usual;
    other.draco_normal_bits = 5;
    assert_true(draco_size(&io, &view, other) < size);
    other = usual;
    other.draco_color_bits = 3;
    assert_true(draco_size(&io, &view, other) < size);
    other = usual;
    other.draco_level = 0;
    assert_true(draco_size(&io, &view, other) > size);
    csg_mesh_destroy(mesh);
    io_context_check(&io);
}

/* 2.2 GB of zeros that are never touched for writing stand in for a mesh of 180 million vertices.
 */
static void four_gigabytes_are_refused(void **state)
{
    (void)state;
#ifdef TEST_SANITIZED /* two gigabytes of one loop: the optimised build has them */
    skip();
#endif
    const uint64_t vertices = 180000000;
    io_context io;
    io_context_init(&io, 0);
    void *zeros =
        mmap(NULL, vertices * 12, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (zeros == MAP_FAILED)
        skip();
    csgm_mesh_view view = {.positions = zeros,
                           .normals = zeros,
                           .colors = zeros,
                           .indices = zeros,
                           .vertex_count = vertices,
                           .triangle_count = 2};
    assert_int_equal(csg_io_write(&io.context, &view, "/dev/null", CSGM_FORMAT_GLB, NULL),
                     CSGM_ERR_UNSUPPORTED);
    assert_non_null(strstr(io.last, "4 GiB"));
    munmap(zeros, vertices * 12);
    io_context_check(&io);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ply_of_other_types),           cmocka_unit_test(obj_of_other_forms),
        cmocka_unit_test(off_of_other_forms),           cmocka_unit_test(pipe_is_told_by_content),
        cmocka_unit_test(nodes_are_applied_and_turned), cmocka_unit_test(strips_become_triangles),
        cmocka_unit_test(all_colors_survive_gltf),      cmocka_unit_test(draco_options_count),
        cmocka_unit_test(four_gigabytes_are_refused),   cmocka_unit_test(units_come_back),
        cmocka_unit_test(single_colors_come_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
