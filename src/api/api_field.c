/* SPDX-License-Identifier: MIT
 * Fields of the public interface: a scene compiled to a tape, evaluated at arrays of points.
 */
#include "field/field.h"

csgm_status csgm_field_compile(csgm_context *context, const csgm_scene *scene, csgm_field **out)
{
    if (!out)
        return CSGM_ERR_ARGUMENT;
    *out = NULL;
    if (!context || !scene)
        return CSGM_ERR_ARGUMENT;
    return csg_field_compile(context, scene, out);
}

void csgm_field_destroy(csgm_field *field)
{
    csg_field_destroy(field);
}

void csgm_field_eval(const csgm_field *field, const float *x, const float *y, const float *z,
                     float *out, size_t count)
{
    csg_field_eval(field, x, y, z, out, count);
}
