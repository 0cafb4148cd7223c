/* SPDX-License-Identifier: MIT
 * Draco file -> mesh. Colours are taken as sRGB, as csgmesh writes them.
 */
#include <math.h>

#include "io/adapter.h"
#include "io/color.h"
#include "io/reader.h"

static csgm_status add_vertices(const csg_input *input, csg_mesh_builder *builder,
                                const csg_adapter_part *part)
{
    for (uint64_t i = 0; i < part->vertex_count; i++) {
        double position[3];
        uint8_t color[4] = {0, 0, 0, 255};
        for (uint64_t k = 0; k < 3; k++) {
            position[k] = (double)part->positions[3 * i + k];
            if (!isfinite(position[k]))
                return csg_read_broken(input, 0, "vertex %llu has a coordinate that is not finite",
                                       (unsigned long long)i);
        }
        for (uint64_t k = 0; part->colors && k < part->color_components; k++)
            color[k] = csg_color_to_byte(part->colors[part->color_components * i + k]);
        if (!csg_builder_vertex(builder, position, part->normals ? part->normals + 3 * i : NULL,
                                part->colors ? color : NULL))
            return CSGM_OK;
    }
    return CSGM_OK;
}

csgm_status csg_drc_read(csg_input *input, csg_mesh_builder *builder)
{
    csg_draco_decoded decoded;
    csg_adapter_error error = {.text = ""};
    csgm_status status =
        csg_draco_decode(input->bytes, input->size_bytes, NULL,
                         csg_memory_left(&input->context->memory), &decoded, &error);
    if (error.is_limit)
        csg_memory_allows(&input->context->memory, UINT64_MAX / 2); /* it is noted as refused */
    if (status == CSGM_ERR_MEMORY)
        return csg_context_no_memory(input->context);
    if (status)
        return csg_read_broken(input, 0, "not a whole Draco mesh: %s", error.text);
    const csg_adapter_part *part = &decoded.part;
    csg_builder_reserve(builder, part->vertex_count, part->index_count / 3);
    status = add_vertices(input, builder, part);
    for (uint64_t i = 0; i < part->index_count && !status && !builder->failed; i += 3)
        csg_builder_triangle(builder, part->indices[i], part->indices[i + 1], part->indices[i + 2]);
    csg_draco_release_decoded(&decoded);
    return status;
}
