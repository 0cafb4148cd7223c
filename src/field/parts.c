/* SPDX-License-Identifier: MIT
 * The parts of a field's scene, each compiled as a field of its own.
 */
#include "scene/tree/parts.h"

#include <string.h>

#include "field/field.h"

static csgm_status compile_part(csgm_field *field, const csg_parts *parts, size_t index)
{
    csg_field_part *part = &field->parts[index];
    part->name = csg_parts_name(parts, index);
    csgm_status status = csg_parts_scene(parts, index, &part->scene);
    if (status == CSGM_ERR_MEMORY)
        return csg_context_no_memory(field->context);
    return status == CSGM_OK ? csg_field_compile(field->context, part->scene, &part->field)
                             : status;
}

csgm_status csg_field_compile_parts(csgm_field *field)
{
    csg_parts parts;
    csgm_status status = csg_parts_find(&parts, field->scene);
    if (status == CSGM_OK && parts.count) {
        field->parts =
            csg_memory_alloc(&field->context->memory, parts.count * sizeof *field->parts);
        status = field->parts ? CSGM_OK : CSGM_ERR_MEMORY;
    }
    if (status == CSGM_ERR_MEMORY)
        csg_context_no_memory(field->context);
    if (status == CSGM_OK && parts.count) {
        field->part_count = parts.count;
        memset(field->parts, 0, parts.count * sizeof *field->parts);
    }
    for (size_t i = 0; i < parts.count && status == CSGM_OK; i++)
        status = compile_part(field, &parts, i);
    csg_parts_reset(&parts);
    return status;
}

void csg_field_release_parts(csgm_field *field)
{
    for (size_t i = 0; i < field->part_count; i++) {
        csg_field_destroy(field->parts[i].field);
        csg_scene_destroy(field->parts[i].scene);
    }
    csg_memory_release(&field->context->memory, field->parts,
                       field->part_count * sizeof *field->parts);
    field->parts = NULL;
    field->part_count = 0;
}
