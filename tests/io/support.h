/* SPDX-License-Identifier: MIT
 * Small meshes made in code, a context with its findings counted, files as byte arrays.
 */
#ifndef CSG_TESTS_IO_SUPPORT_H
#define CSG_TESTS_IO_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka wants the four above first */
#include <cmocka.h>

#include "io/formats.h"

typedef struct io_context {
    csgm_context context;
    uint32_t findings;
    char last[512]; /* message of the last finding */
    uint32_t last_line;
    uint16_t last_code;
} io_context;

void io_context_init(io_context *io, uint64_t memory_limit_bytes);
/* Fails the test when memory is still held. */
void io_context_check(const io_context *io);

typedef enum io_shape {
    IO_TETRAHEDRON,
    IO_CUBE,
    IO_SPHERE, /* about 2000 triangles, normals, colours */
    IO_EMPTY,
    IO_FAR,       /* the sphere around (1e5, -2e5, 3e5) */
    IO_TWO_CUBES, /* sharing one edge: not a manifold */
    IO_PARTS,     /* a sphere without a name, two with; materials: one, mixed, another */
    IO_SHAPES
} io_shape;

extern const char *const io_shape_names[IO_SHAPES];
csgm_mesh *io_shape_make(csgm_context *context, io_shape shape);
/* A sphere of 2 * columns * (rows - 1) triangles. */
csgm_mesh *io_sphere_make(csgm_context *context, uint32_t columns, uint32_t rows);

/* A fresh folder, removed with all in it by io_folder_remove. */
const char *io_folder_make(char *path, size_t size);
void io_folder_remove(const char *path);
int io_folder_count(const char *path); /* entries in it */
/* Terminated; *size_bytes without the terminator. NULL when unreadable. free() it. */
uint8_t *io_file_load(const char *path, size_t *size_bytes);

#endif
