/* SPDX-License-Identifier: MIT
 * Measures of the public interface.
 */
#include <math.h>

#include "api/measured.h"
#include "api/options.h"
#include "measure/measure.h"

csgm_measure_options csgm_measure_options_default(void)
{
    return (csgm_measure_options){.struct_size = sizeof(csgm_measure_options),
                                  .tolerance = 1e-4,
                                  .density = 1,
                                  .most_cubes = 1 << 24};
}

csgm_measures csgm_measures_default(void)
{
    return (csgm_measures){.struct_size = sizeof(csgm_measures)};
}

bool csg_measure_options_adopt(csgm_measure_options *own, const csgm_measure_options *given)
{
    *own = csgm_measure_options_default();
    return csg_options_adopt(own, sizeof *own, given) && own->tolerance > 0 &&
           isfinite(own->tolerance) && own->density > 0 && isfinite(own->density) &&
           own->most_cubes > 0;
}

bool csg_measured_mesh(const csgm_mesh_view *mesh, const char *part, csgm_mesh_view *out)
{
    uint64_t i = 0;
    *out = *mesh;
    if (!part)
        return true;
    while (i < mesh->part_count && !csg_option_is_name(mesh->parts[i].name, part))
        i++;
    if (i == mesh->part_count)
        return false;
    out->indices += 3 * mesh->parts[i].first_triangle;
    out->triangle_count = mesh->parts[i].triangle_count;
    out->parts = NULL;
    out->part_count = 0;
    return true;
}

bool csg_measured_so_far(csgm_status status)
{
    return status == CSGM_OK || status == CSGM_ERR_LIMIT || status == CSGM_ERR_MEMORY ||
           status == CSGM_CANCELLED;
}

csgm_status csgm_measure_field(csgm_context *context, const csgm_field *field,
                               const csgm_measure_options *options, csgm_measures *out)
{
    csgm_measure_options own;
    csgm_measures made = csgm_measures_default();
    if (!context || !field || !out || !csg_struct_is_known(out, sizeof *out) ||
        !csg_measure_options_adopt(&own, options))
        return CSGM_ERR_ARGUMENT;
    const csgm_field *of = csg_option_part(field, own.part);
    if (!of)
        return CSGM_ERR_ARGUMENT;
    csgm_status status = csg_measure_field(context, of, &own, &made);
    if (csg_measured_so_far(status))
        csg_struct_deliver(out, &made);
    return status;
}

csgm_status csgm_measure_mesh(csgm_context *context, const csgm_mesh_view *mesh,
                              const csgm_measure_options *options, csgm_measures *out)
{
    csgm_measure_options own;
    csgm_measures made = csgm_measures_default();
    if (!context || !mesh || !out || !csg_struct_is_known(out, sizeof *out) ||
        !csg_measure_options_adopt(&own, options))
        return CSGM_ERR_ARGUMENT;
    csgm_mesh_view of;
    if (!csg_measured_mesh(mesh, own.part, &of))
        return CSGM_ERR_ARGUMENT;
    csgm_status status = csg_measure_mesh(context, &of, &own, &made);
    if (csg_measured_so_far(status))
        csg_struct_deliver(out, &made);
    return status;
}
