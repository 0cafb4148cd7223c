/* SPDX-License-Identifier: MIT
 * Mesh -> Draco, bare (.drc) or for the glTF extension. Draco cannot hold a mesh without triangles,
 * quantises positions and normals, and drops degenerate triangles, which is said as a warning.
 * Bare files keep sRGB colours; glTF hands in linear ones.
 */
#include "base/mesh_codes.h"
#include "io/writers.h"

csgm_status csg_write_draco(csg_sink *sink, const csgm_mesh_view *mesh,
                            const csg_draco_mesh *colors, const csgm_write_options *options,
                            csg_draco_encoded *out)
{
    csg_draco_mesh source = *colors;
    source.positions = mesh->positions;
    source.normals = mesh->normals;
    source.indices = mesh->indices;
    source.vertex_count = mesh->vertex_count;
    source.triangle_count = mesh->triangle_count;
    csg_draco_settings settings = {options->draco_position_bits, options->draco_normal_bits,
                                   options->draco_level};
    csg_adapter_error error = {{0}};
    csgm_status status = csg_draco_encode(&source, &settings, out, &error);
    if (status == CSGM_ERR_MEMORY)
        return csg_context_no_memory(sink->context);
    if (status) {
        csg_diag_plain(&sink->context->diags, CSG_DIAG_ENCODER_FAILED, sink->name,
                       "write a format without compression", "cannot compress: %s", error.text);
        return status;
    }
    if (out->triangle_count < mesh->triangle_count)
        csg_diag_plain(&sink->context->diags, CSG_DIAG_TRIANGLES_LOST, sink->name, NULL,
                       "Draco left out %llu degenerate triangles",
                       (unsigned long long)(mesh->triangle_count - out->triangle_count));
    return CSGM_OK;
}

/* Snaps to 2^bits - 1 steps; Draco itself keeps whole numbers exact. */
static uint8_t snap(uint8_t value, uint32_t bits)
{
    if (bits >= 8)
        return value;
    uint32_t steps = (1u << bits) - 1;
    uint32_t step = (value * steps * 2 + 255) / 510;
    return (uint8_t)((step * 510 + steps) / (2 * steps));
}

/* The whole mesh around the file's own origin, rounded to its floats; colours snapped. */
typedef struct scratch {
    float *positions;
    uint8_t *colors;
    size_t position_bytes, color_bytes;
} scratch;

static bool fill(scratch *s, csg_memory *memory, const csgm_mesh_view *mesh, uint32_t bits)
{
    *s = (scratch){.position_bytes = 12 * (size_t)mesh->vertex_count,
                   .color_bytes = 4 * (size_t)mesh->vertex_count};
    if (csg_view_is_offset(mesh)) {
        s->positions = csg_memory_alloc(memory, s->position_bytes);
        if (!s->positions)
            return false;
        for (uint64_t i = 0; i < 3 * mesh->vertex_count; i++)
            s->positions[i] = (float)csg_view_coordinate(mesh, i / 3, (int)(i % 3));
    }
    if (mesh->colors && bits < 8) {
        s->colors = csg_memory_alloc(memory, s->color_bytes);
        if (!s->colors)
            return false;
        for (uint64_t i = 0; i < 4 * mesh->vertex_count; i++)
            s->colors[i] = snap(mesh->colors[i], bits);
    }
    return true;
}

csgm_status csg_drc_write(csg_sink *sink, const csgm_mesh_view *mesh,
                          const csgm_write_options *options)
{
    if (!mesh->triangle_count)
        return csg_write_refuse(sink, "write PLY or GLB, which can be empty",
                                "Draco cannot hold a mesh without triangles");
    csg_memory *memory = &sink->context->memory;
    scratch s;
    csgm_status status = CSGM_ERR_MEMORY;
    if (!fill(&s, memory, mesh, options->draco_color_bits)) {
        csg_context_no_memory(sink->context);
    } else {
        csgm_mesh_view moved = *mesh;
        moved.positions = s.positions ? s.positions : mesh->positions;
        csg_draco_mesh colors = {.colors = s.colors ? s.colors : mesh->colors, .color_bytes = 1};
        csg_draco_encoded encoded;
        status = csg_write_draco(sink, &moved, &colors, options, &encoded);
        if (!status) {
            csg_sink_put(sink, encoded.bytes, encoded.size_bytes);
            csg_draco_release(&encoded);
        }
    }
    csg_memory_release(memory, s.positions, s.position_bytes);
    csg_memory_release(memory, s.colors, s.color_bytes);
    return status;
}
