/* SPDX-License-Identifier: MIT
 * glTF and GLB -> mesh: takes the container apart, hands the document to the adapter, and joins the
 * parts that come back, each moved by its node and turned from glTF's Y up to our Z up. Linear
 * colours become sRGB. Parts without normals leave the whole mesh without.
 */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/mesh_codes.h"
#include "io/adapter.h"
#include "io/beneath.h"
#include "io/color.h"
#include "io/reader.h"

typedef struct loaded {
    struct loaded *next;
    uint8_t *bytes;
    size_t size_bytes;
} loaded;

typedef struct gltf {
    csg_input *input;
    csg_mesh_builder *builder;
    loaded *files; /* named by the document; kept until it is read */
} gltf;

/* ---- a part ----------------------------------------------------------------------- */

/* Rows of [m | t] after turning (x, y, z) to (x, -z, y). */
static void z_up(const double in[12], double out[12])
{
    for (int c = 0; c < 4; c++) {
        out[c] = in[c];
        out[4 + c] = -in[8 + c];
        out[8 + c] = in[4 + c];
    }
}

/* Cofactors: they take normals along, up to length; returns the determinant. */
static double cofactors(const double m[12], double out[9])
{
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
            out[3 * r + c] = m[4 * r1 + c1] * m[4 * r2 + c2] - m[4 * r1 + c2] * m[4 * r2 + c1];
        }
    return m[0] * out[0] + m[1] * out[1] + m[2] * out[2];
}

static void move_normal(const double cofactor[9], double sign, const float in[3], float out[3])
{
    double n[3], length = 0;
    for (int r = 0; r < 3; r++) {
        n[r] = sign * (cofactor[3 * r] * (double)in[0] + cofactor[3 * r + 1] * (double)in[1] +
                       cofactor[3 * r + 2] * (double)in[2]);
        length += n[r] * n[r];
    }
    length = sqrt(length);
    /* a pure rotation keeps the bits of a normal that is of unit length but for rounding */
    double scale = fabs(length - 1) < 1e-5 || !(length > 0) || !isfinite(length) ? 1 : 1 / length;
    for (int r = 0; r < 3; r++)
        out[r] = isfinite(n[r]) ? (float)(n[r] * scale + 0.0) : 0;
}

static csgm_status add_vertex(gltf *g, const csg_adapter_part *part, uint64_t i,
                              const double place[12], const double cofactor[9], double sign)
{
    double position[3];
    float normal[3];
    uint8_t color[4] = {0, 0, 0, 255};
    const float *p = part->positions + 3 * i;
    for (int r = 0; r < 3; r++) {
        const double *row = place + 4 * r;
        position[r] =
            row[0] * (double)p[0] + row[1] * (double)p[1] + row[2] * (double)p[2] + row[3];
        if (!isfinite(position[r]))
            return csg_read_broken(g->input, 0, "a vertex has a coordinate that is not finite");
    }
    if (part->normals)
        move_normal(cofactor, sign, part->normals + 3 * i, normal);
    for (uint64_t k = 0; part->colors && k < part->color_components; k++) {
        float value = part->colors[part->color_components * i + k];
        color[k] = k < 3 ? csg_color_to_srgb(value) : csg_color_to_byte(value);
    }
    csg_builder_vertex(g->builder, position, part->normals ? normal : NULL,
                       part->colors ? color : NULL);
    return CSGM_OK;
}

/* A node that mirrors turns its triangles around. */
static csgm_status add_part(void *user, const csg_adapter_part *part, const double transform[12])
{
    gltf *g = user;
    double place[12], cofactor[9];
    z_up(transform, place);
    double determinant = cofactors(place, cofactor);
    bool mirrored = determinant < 0;
    uint64_t first = g->builder->vertex_count;
    csgm_status status = CSGM_OK;
    if (part->begins)
        csg_builder_part(g->builder, part->name && *part->name ? part->name : NULL);
    csg_builder_material(g->builder, part->material);
    if (first + part->vertex_count > UINT32_MAX)
        return csg_read_unsupported(g->input, "more than 4294967295 vertices in all");
    for (uint64_t i = 0; i < part->vertex_count && !status && !g->builder->failed; i++)
        status = add_vertex(g, part, i, place, cofactor, mirrored ? -1 : 1);
    for (uint64_t i = 0; i < part->index_count && !status && !g->builder->failed; i += 3) {
        uint32_t corner[3];
        for (uint64_t k = 0; k < 3; k++)
            corner[k] = (uint32_t)first + part->indices[i + k];
        csg_builder_triangle(g->builder, corner[0], corner[mirrored ? 2 : 1],
                             corner[mirrored ? 1 : 2]);
    }
    return !status && g->builder->failed ? csg_builder_why_failed(g->builder) : status;
}

/* ---- files beside it -------------------------------------------------------------- */

/* The file that the document names, below the document's own folder: nowhere else is looked. *fd is
 * open when CSGM_OK. */
static csgm_status open_beside(const gltf *g, const char *uri, int *fd)
{
    *fd = strstr(uri, "://") ? -1 : csg_open_beside(g->input->context, g->input->path, uri);
    if (*fd >= 0)
        return CSGM_OK;
    if (strstr(uri, "://") || uri[0] == '/' || errno == EXDEV || errno == ELOOP)
        return csg_read_unsupported(g->input, "it names '%.100s', which is not a file beside it",
                                    uri);
    csg_diag_plain(&g->input->context->diags, CSG_DIAG_MESH_UNREADABLE, g->input->path, NULL,
                   "cannot read '%.100s', which it names: %s", uri, strerror(errno));
    return CSGM_ERR_IO;
}

static csgm_status load(void *user, const char *uri, const uint8_t **bytes, size_t *size_bytes)
{
    gltf *g = user;
    csg_memory *memory = &g->input->context->memory;
    int fd;
    csgm_status status = open_beside(g, uri, &fd);
    if (status)
        return status;
    loaded *file = csg_memory_alloc(memory, sizeof *file);
    status = file ? csg_input_load(g->input->context, uri, fd, &file->bytes, &file->size_bytes)
                  : csg_context_no_memory(g->input->context);
    close(fd);
    if (!file)
        return status;
    if (status) {
        csg_memory_release(memory, file, sizeof *file);
        return status;
    }
    file->next = g->files;
    g->files = file;
    *bytes = file->bytes;
    *size_bytes = file->size_bytes;
    return CSGM_OK;
}

static void release_files(gltf *g)
{
    csg_memory *memory = &g->input->context->memory;
    while (g->files) {
        loaded *file = g->files;
        g->files = file->next;
        csg_memory_release(memory, file->bytes, file->size_bytes);
        csg_memory_release(memory, file, sizeof *file);
    }
}

static void note_unit(void *user, csgm_unit unit)
{
    csg_builder_unit(((gltf *)user)->builder, unit);
}

static void note_left_out(void *user, const char *what)
{
    csg_builder_leave_out(((gltf *)user)->builder, what);
}

static bool allows(void *user, uint64_t bytes)
{
    gltf *g = user;
    return csg_memory_allows(&g->input->context->memory, bytes);
}

/* ---- the container ---------------------------------------------------------------- */

typedef struct chunks {
    const uint8_t *json, *bin;
    size_t json_bytes, bin_bytes;
} chunks;

enum { GLB_HEADER = 12, CHUNK_HEADER = 8 };

/* Header, then chunks of {size, kind, bytes}: JSON, perhaps BIN, perhaps others that are skipped.
 */
static csgm_status split_glb(const csg_input *input, chunks *out)
{
    uint64_t size = input->size_bytes, at = GLB_HEADER;
    if (size < GLB_HEADER + CHUNK_HEADER)
        return csg_read_broken(input, 0, "the file ends inside the GLB header");
    if (csg_load_u32(input->bytes + 4) != 2)
        return csg_read_unsupported(input, "glTF version %u is not read, only 2",
                                    csg_load_u32(input->bytes + 4));
    uint64_t told = csg_load_u32(input->bytes + 8);
    if (told > size)
        return csg_read_broken(input, 0, "the file ends too soon: it says %llu bytes and has %llu",
                               (unsigned long long)told, (unsigned long long)size);
    for (int chunk = 0; at + CHUNK_HEADER <= told; chunk++) {
        uint64_t length = csg_load_u32(input->bytes + at);
        const uint8_t *kind = input->bytes + at + 4, *data = kind + 4;
        if (length > told - at - CHUNK_HEADER)
            return csg_read_broken(input, 0,
                                   "at byte %llu: a chunk goes beyond the end of the file",
                                   (unsigned long long)at);
        if (chunk == 0 && memcmp(kind, "JSON", 4) == 0) {
            out->json = data;
            out->json_bytes = length;
        } else if (chunk == 1 && memcmp(kind, "BIN", 4) == 0) {
            out->bin = data;
            out->bin_bytes = length;
        }
        at += CHUNK_HEADER + ((length + 3) & ~(uint64_t)3);
    }
    return out->json ? CSGM_OK
                     : csg_read_broken(input, 0, "the first chunk of the GLB is not JSON");
}

csgm_status csg_gltf_read(csg_input *input, csg_mesh_builder *builder)
{
    gltf g = {.input = input, .builder = builder};
    chunks parts = {.json = input->bytes, .json_bytes = input->size_bytes};
    if (input->size_bytes >= 4 && memcmp(input->bytes, "glTF", 4) == 0) {
        parts = (chunks){0};
        csgm_status status = split_glb(input, &parts);
        if (status)
            return status;
    }
    csg_gltf_calls calls = {.part = add_part,
                            .load = load,
                            .unit = note_unit,
                            .left_out = note_left_out,
                            .allows = allows,
                            .user = &g,
                            .most_bytes = csg_memory_left(&input->context->memory)};
    csg_adapter_error error = {.text = ""};
    csgm_status status = csg_gltf_parse((const char *)parts.json, parts.json_bytes, parts.bin,
                                        parts.bin_bytes, &calls, &error);
    release_files(&g);
    if (!status || !error.text[0])
        return status;
    if (status == CSGM_ERR_MEMORY)
        return csg_context_no_memory(input->context);
    if (status == CSGM_ERR_UNSUPPORTED)
        return csg_read_unsupported(input, "%s", error.text);
    return csg_read_broken(input, 0, "%s", error.text);
}

csgm_status csg_glb_read(csg_input *input, csg_mesh_builder *builder)
{
    return csg_gltf_read(input, builder); /* it looks at the first bytes, not at the name */
}
