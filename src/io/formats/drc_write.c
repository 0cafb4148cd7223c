/* SPDX-License-Identifier: MIT
 * Mesh -> Draco, bare (.drc) or for the glTF extension. Draco cannot hold a mesh without triangles,
 * quantises positions and normals, and drops degenerate triangles, which is said as a warning.
 * Bare files keep sRGB colours; glTF hands in linear ones.
 */
#include "base/mesh_codes.h"
#include "io/rounding.h"
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
    csg_adapter_error error = {.text = ""};
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

static csgm_status compress(csg_sink *sink, const csgm_mesh_view *mesh, const uint8_t *bytes,
                            const csgm_write_options *options)
{
    csg_draco_mesh colors = {.colors = bytes, .color_bytes = 1};
    csg_draco_encoded encoded;
    csgm_status status = csg_write_draco(sink, mesh, &colors, options, &encoded);
    if (status)
        return status;
    csg_sink_put(sink, encoded.bytes, encoded.size_bytes);
    csg_draco_release(&encoded);
    return CSGM_OK;
}

/* With colours of fewer bits where they are asked for. */
static csgm_status compress_snapped(csg_sink *sink, const csgm_mesh_view *mesh,
                                    const csgm_write_options *options)
{
    uint32_t bits = options->draco_color_bits;
    if (!mesh->colors || bits >= 8)
        return compress(sink, mesh, mesh->colors, options);
    size_t color_bytes = 4 * (size_t)mesh->vertex_count;
    uint8_t *colors = csg_memory_alloc(&sink->context->memory, color_bytes);
    if (!colors)
        return csg_context_no_memory(sink->context);
    for (size_t i = 0; i < color_bytes; i++)
        colors[i] = snap(mesh->colors[i], bits);
    csgm_status status = compress(sink, mesh, colors, options);
    csg_memory_release(&sink->context->memory, colors, color_bytes);
    return status;
}

csgm_status csg_drc_write(csg_sink *sink, const csgm_mesh_view *mesh,
                          const csgm_write_options *options)
{
    if (!mesh->triangle_count)
        return csg_write_refuse(sink, "write PLY or GLB, which can be empty",
                                "Draco cannot hold a mesh without triangles");
    csg_rounding grid = csg_rounding_of_draco(mesh, options->draco_position_bits, false);
    csg_rounded rounded;
    csgm_status status = csg_round_mesh(sink->context, mesh, &grid, sink->name, "Draco", &rounded);
    if (status)
        return status;
    status = compress_snapped(sink, &rounded.mesh, options);
    csg_rounded_release(sink->context, &rounded);
    return status;
}
