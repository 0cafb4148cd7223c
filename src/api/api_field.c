/* SPDX-License-Identifier: MIT
 * Fields of the public interface: a scene compiled to a tape, evaluated at arrays of points.
 */
#include "base/trace.h"
#include "field/field.h"

csgm_status csgm_field_compile(csgm_context *context, const csgm_scene *scene, csgm_field **out)
{
    if (!out)
        return CSGM_ERR_ARGUMENT;
    *out = NULL;
    if (!context || !scene)
        return CSGM_ERR_ARGUMENT;
    CSG_ZONE(context, "compile");
    csgm_field *field;
    csgm_status status = csg_field_compile(context, scene, &field);
    if (status != CSGM_OK)
        return status;
    status = csg_field_compile_parts(field);
    csg_zone_count(context, "nodes", field->tape.count);
    if (status == CSGM_OK)
        *out = field;
    else
        csg_field_destroy(field);
    return status;
}

void csgm_field_destroy(csgm_field *field)
{
    csg_field_destroy(field);
}

bool csgm_field_part(const csgm_field *field, size_t index, const char **name)
{
    bool is_whole = field->part_count == 0;
    if (index >= field->part_count + is_whole)
        return false;
    *name = is_whole ? NULL : field->parts[index].name;
    return true;
}

void csgm_field_eval(const csgm_field *field, const float *x, const float *y, const float *z,
                     float *out, size_t count)
{
    csg_field_eval(field, x, y, z, out, count);
}
