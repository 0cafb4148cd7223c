/* SPDX-License-Identifier: MIT
 * See support.h.
 */
#include "support.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static void on_diag(void *user, const csgm_diag *diag)
{
    io_context *io = user;
    io->findings++;
    io->last_line = diag->line;
    io->last_code = diag->code;
    snprintf(io->last, sizeof io->last, "%s", diag->message);
}

void io_context_init(io_context *io, uint64_t memory_limit_bytes)
{
    memset(io, 0, sizeof *io);
    csg_memory_init(&io->context.memory, NULL, memory_limit_bytes);
    io->context.diags = (csg_diag_sink){.on_diag = on_diag, .user = io};
}

void io_context_check(const io_context *io)
{
    assert_int_equal(io->context.memory.used_bytes, 0);
}

const char *const io_shape_names[IO_SHAPES] = {"tetrahedron", "cube",      "sphere", "empty",
                                               "far",         "two_cubes", "parts"};

csgm_mesh *io_sphere_make(csgm_context *context, uint32_t columns, uint32_t rows)
{
    csgm_mesh *mesh = NULL;
    uint64_t vertices = 2 + (uint64_t)columns * (rows - 1);
    assert_int_equal(
        csg_mesh_create(context, vertices, 2 * (uint64_t)columns * (rows - 1), true, true, &mesh),
        CSGM_OK);
    for (uint64_t i = 0; i < vertices; i++) {
        uint64_t row = i == 0 ? 0 : i == vertices - 1 ? rows : 1 + (i - 1) / columns;
        double latitude = M_PI * (double)row / rows;
        double longitude = i ? 2 * M_PI * (double)((i - 1) % columns) / columns : 0;
        double n[3] = {sin(latitude) * cos(longitude), sin(latitude) * sin(longitude),
                       cos(latitude)};
        for (int k = 0; k < 3; k++) {
            mesh->normals[3 * i + (uint64_t)k] = (float)n[k];
            mesh->positions[3 * i + (uint64_t)k] = (float)(10 * n[k] + k);
            mesh->colors[4 * i + (uint64_t)k] = (uint8_t)lrint(127.5 * (1 + n[k]));
        }
        mesh->colors[4 * i + 3] = 255;
    }
    uint32_t *t = mesh->indices;
    for (uint32_t c = 0; c < columns; c++) {
        uint32_t d = (c + 1) % columns, last = (uint32_t)vertices - 1;
        *t++ = 0, *t++ = 1 + c, *t++ = 1 + d;
        for (uint32_t r = 0; r + 2 < rows; r++) {
            uint32_t a = 1 + r * columns + c, b = 1 + r * columns + d;
            *t++ = a, *t++ = a + columns, *t++ = b + columns;
            *t++ = a, *t++ = b + columns, *t++ = b;
        }
        *t++ = last, *t++ = last - columns + d, *t++ = last - columns + c;
    }
    return mesh;
}

static csgm_mesh *from_arrays(csgm_context *context, const float *positions, uint64_t vertices,
                              const uint32_t *indices, uint64_t triangles)
{
    csgm_mesh *mesh = NULL;
    assert_int_equal(csg_mesh_create(context, vertices, triangles, false, false, &mesh), CSGM_OK);
    if (vertices)
        memcpy(mesh->positions, positions, vertices * 12);
    if (triangles)
        memcpy(mesh->indices, indices, triangles * 12);
    return mesh;
}

/* Corners numbered by the bits of x, y, z; two triangles per face. */
static const uint32_t cube_indices[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                          2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};

static csgm_mesh *cubes_make(csgm_context *context, bool two)
{
    float positions[16 * 3];
    uint32_t indices[72], name[8];
    for (uint32_t i = 0; i < 16; i++)
        for (uint32_t k = 0; k < 3; k++)
            positions[3 * i + k] = (float)(i >> k & 1) * 0.7f + (i >= 8 && k < 2 ? 0.7f : 0);
    for (uint32_t i = 0; i < 8; i++) /* the second cube's edge at x = y = 0.7 is the first's */
        name[i] = i % 4 == 0 ? 3 + (i & 4) : 8 + i;
    for (uint32_t i = 0; i < 36; i++) {
        indices[i] = cube_indices[i];
        indices[36 + i] = name[cube_indices[i]];
    }
    return from_arrays(context, positions, two ? 16 : 8, indices, two ? 24 : 12);
}

/* Three spheres in a row. */
static csgm_mesh *parts_make(csgm_context *context)
{
    static const char *const names[3] = {NULL, "Deckel \303\266ben", "a <b> & \"c\" \\d"};
    csgm_mesh *one = io_sphere_make(context, 12, 8), *mesh = NULL;
    size_t vertices = (size_t)one->vertex_count, triangles = (size_t)one->triangle_count;
    assert_int_equal(csg_mesh_create(context, 3 * vertices, 3 * triangles, true, true, &mesh),
                     CSGM_OK);
    assert_int_equal(csg_mesh_add_materials(mesh), CSGM_OK);
    for (size_t part = 0; part < 3; part++) {
        size_t first = part * vertices;
        assert_int_equal(csg_mesh_add_part(mesh, names[part], part * triangles), CSGM_OK);
        memcpy(mesh->positions + 3 * first, one->positions, vertices * 12);
        memcpy(mesh->normals + 3 * first, one->normals, vertices * 12);
        memcpy(mesh->colors + 4 * first, one->colors, vertices * 4);
        for (size_t i = 0; i < vertices; i++) {
            mesh->positions[3 * (first + i)] += 20 * (float)part;
            mesh->materials[2 * (first + i)] = part == 1 ? (uint16_t)(100 * (i % 101)) : 10000;
            mesh->materials[2 * (first + i) + 1] = (uint16_t)(2500 * part);
        }
        for (size_t i = 0; i < 3 * triangles; i++)
            mesh->indices[3 * part * triangles + i] = one->indices[i] + (uint32_t)first;
    }
    csg_mesh_destroy(one);
    return mesh;
}

csgm_mesh *io_shape_make(csgm_context *context, io_shape shape)
{
    static const float corners[12] = {0, 0, 0, 1, 0, 0, 0, 1.1f, 0, 0, 0.1f, 1e-3f};
    static const uint32_t faces[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
    csgm_mesh *mesh;
    switch (shape) {
    case IO_TETRAHEDRON:
        return from_arrays(context, corners, 4, faces, 4);
    case IO_CUBE:
        return cubes_make(context, false);
    case IO_TWO_CUBES:
        return cubes_make(context, true);
    case IO_SPHERE:
        return io_sphere_make(context, 40, 26);
    case IO_FAR:
        mesh = io_sphere_make(context, 40, 26);
        mesh->origin = (csgm_vec3){1e5, -2e5, 3e5};
        return mesh;
    case IO_PARTS:
        return parts_make(context);
    case IO_EMPTY:
    case IO_SHAPES:
        break;
    }
    return from_arrays(context, NULL, 0, NULL, 0);
}

/* ---- files ------------------------------------------------------------------------ */

const char *io_folder_make(char *path, size_t size)
{
    const char *base = getenv("TMPDIR");
    snprintf(path, size, "%s/csgmesh-io-XXXXXX", base ? base : "/tmp");
    assert_non_null(mkdtemp(path));
    return path;
}

void io_folder_remove(const char *path)
{
    char name[4096];
    DIR *folder = opendir(path);
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder));) {
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0)
            continue;
        snprintf(name, sizeof name, "%s/%s", path, entry->d_name);
        if (unlink(name) != 0)
            assert_int_equal(rmdir(name), 0);
    }
    closedir(folder);
    assert_int_equal(rmdir(path), 0);
}

int io_folder_count(const char *path)
{
    int count = 0;
    DIR *folder = opendir(path);
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder));)
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    closedir(folder);
    return count;
}

uint8_t *io_file_load(const char *path, size_t *size_bytes)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return NULL;
    struct stat state;
    assert_int_equal(fstat(fileno(file), &state), 0);
    uint8_t *bytes = malloc((size_t)state.st_size + 1);
    assert_non_null(bytes);
    *size_bytes = fread(bytes, 1, (size_t)state.st_size, file);
    bytes[*size_bytes] = 0;
    fclose(file);
    return bytes;
}
