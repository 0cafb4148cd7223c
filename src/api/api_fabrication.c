/* SPDX-License-Identifier: MIT
 * Oriented boxes and faces by direction, of the public interface.
 */
#include <math.h>

#include "api/measured.h"
#include "api/options.h"
#include "measure/faces.h"
#include "measure/field_faces.h"
#include "measure/oriented.h"

/* ---- oriented boxes ----------------------------------------------------------------------------
 */

csgm_oriented_box csgm_oriented_box_default(void)
{
    return (csgm_oriented_box){.struct_size = sizeof(csgm_oriented_box)};
}

csgm_status csgm_oriented_box_of_field(csgm_context *context, const csgm_field *field,
                                       const csgm_measure_options *options, csgm_oriented_box *out)
{
    csgm_measure_options own;
    csgm_oriented_box made = csgm_oriented_box_default();
    if (!context || !field || !out || !csg_struct_is_known(out, sizeof *out) ||
        !csg_measure_options_adopt(&own, options))
        return CSGM_ERR_ARGUMENT;
    const csgm_field *of = csg_option_part(field, own.part);
    if (!of)
        return CSGM_ERR_ARGUMENT;
    csgm_status status = csg_oriented_box_of_field(context, of, &own, &made);
    if (csg_measured_so_far(status))
        csg_struct_deliver(out, &made);
    return status;
}

csgm_status csgm_oriented_box_of_mesh(csgm_context *context, const csgm_mesh_view *mesh,
                                      const csgm_measure_options *options, csgm_oriented_box *out)
{
    csgm_measure_options own;
    csgm_oriented_box made = csgm_oriented_box_default();
    csgm_mesh_view of;
    if (!context || !mesh || !out || !csg_struct_is_known(out, sizeof *out) ||
        !csg_measure_options_adopt(&own, options) || !csg_measured_mesh(mesh, own.part, &of))
        return CSGM_ERR_ARGUMENT;
    csgm_status status = csg_oriented_box_of_mesh(context, &of, &own, &made);
    if (csg_measured_so_far(status))
        csg_struct_deliver(out, &made);
    return status;
}

/* ---- faces -------------------------------------------------------------------------------------
 */

csgm_face_options csgm_face_options_default(void)
{
    return (csgm_face_options){.struct_size = sizeof(csgm_face_options),
                               .up = {0, 0, 1},
                               .overhang_deg = 45,
                               .draft_deg = 1};
}

csgm_faces csgm_faces_default(void)
{
    return (csgm_faces){.struct_size = sizeof(csgm_faces)};
}

static bool is_angle(double degrees)
{
    return degrees > 0 && degrees < 90;
}

static bool adopt(csgm_face_options *own, const csgm_face_options *given)
{
    *own = csgm_face_options_default();
    if (!csg_options_adopt(own, sizeof *own, given))
        return false;
    double length = csg_vec3_norm(own->up);
    return length > 0 && isfinite(length) && is_angle(own->overhang_deg) &&
           is_angle(own->draft_deg);
}

csgm_status csgm_faces_of_mesh(csgm_context *context, const csgm_mesh_view *mesh,
                               const csgm_face_options *options, csgm_faces *out)
{
    csgm_face_options own;
    csgm_faces made = csgm_faces_default();
    csgm_mesh_view of;
    if (!context || !mesh || !out || !csg_struct_is_known(out, sizeof *out) ||
        !adopt(&own, options) || !csg_measured_mesh(mesh, own.part, &of))
        return CSGM_ERR_ARGUMENT;
    csgm_status status = csg_faces_of_mesh(context, &of, &own, &made);
    if (status == CSGM_OK)
        csg_struct_deliver(out, &made);
    return status;
}

csgm_status csgm_faces_of_field(csgm_context *context, const csgm_field *field,
                                const csgm_face_options *options, const csgm_measure_options *how,
                                csgm_faces *out)
{
    csgm_face_options own;
    csgm_measure_options closely;
    csgm_faces made = csgm_faces_default();
    if (!context || !field || !out || !csg_struct_is_known(out, sizeof *out) ||
        !adopt(&own, options) || !csg_measure_options_adopt(&closely, how))
        return CSGM_ERR_ARGUMENT;
    const csgm_field *of = csg_option_part(field, own.part);
    if (!of)
        return CSGM_ERR_ARGUMENT;
    csgm_status status = csg_faces_of_field(context, of, &own, &closely, &made);
    if (csg_measured_so_far(status))
        csg_struct_deliver(out, &made);
    return status;
}
