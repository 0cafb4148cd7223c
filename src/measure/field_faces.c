/* SPDX-License-Identifier: MIT
 * A field's faces by direction; see field_faces.h.
 */
#include "measure/field_faces.h"

#include <math.h>

#include "base/trace.h"
#include "field/field.h"
#include "measure/area.h"
#include "measure/extent.h"
#include "measure/measure.h"

typedef struct job {
    csg_measure_walk *walk;
    const csgm_measure_options *how;
    csg_vec3 up; /* of unit length */
    double size; /* the longest side of the bounds */
    double area; /* of all, once it is known */
} job;

/* Normals within [least, most] along `up`, at any height; to be narrowed. */
static csg_area_selection along(const job *j, double least, double most)
{
    return (csg_area_selection){.direction = {j->up.x, j->up.y, j->up.z},
                                .least = least,
                                .most = most,
                                .level_low = INFINITY,
                                .level_high = INFINITY};
}

static csgm_status take(const job *j, const csg_area_selection *selection, csgm_interval *out)
{
    csg_area_bounds found;
    csgm_status status = csg_measure_area(j->walk, selection, CSG_AREA_WIDER * j->how->tolerance,
                                          j->area, j->how->most_cubes / CSG_AREA_SHARE, &found);
    *out = (csgm_interval){found.low, found.high};
    return status;
}

/* What the solid stands on: straight down, and within a little of its lowest point. */
static csgm_status take_resting(const job *j, csgm_interval *out)
{
    static const double LEVEL = 1e-4, STRAIGHT_DEG = 0.1, CLOSELY = 0.1; /* of the level */
    const csg_vec3 down = csg_vec3_scale(j->up, -1);
    csg_support_point lowest;
    csgm_status status = csg_measure_reaches(j->walk, &down, 1, CLOSELY * LEVEL * j->size,
                                             j->how->most_cubes / CSG_AREA_SHARE, &lowest);
    if (status != CSGM_OK)
        return status;
    double sine, cosine;
    csg_sin_cos_deg(STRAIGHT_DEG, &sine, &cosine);
    csg_area_selection selection = along(j, -1, -cosine);
    selection.level_low = LEVEL * j->size - lowest.high;
    selection.level_high = LEVEL * j->size - lowest.low;
    return take(j, &selection, out);
}

static csgm_status take_all(job *j, const csgm_face_options *options, csgm_faces *out)
{
    double sine, cosine, ignored;
    csg_sin_cos_deg(options->overhang_deg, &ignored, &cosine);
    csg_sin_cos_deg(options->draft_deg, &sine, &ignored);
    const csg_area_selection overhang = along(j, -1, -cosine), steep = along(j, -sine, sine);
    csgm_status status = take(j, NULL, &out->area);
    j->area = isfinite(out->area.high) ? out->area.high : out->area.low;
    if (status == CSGM_OK)
        status = take(j, &overhang, &out->overhang);
    if (status == CSGM_OK)
        status = take(j, &steep, &out->steep);
    return status == CSGM_OK ? take_resting(j, &out->resting) : status;
}

csgm_status csg_faces_of_field(csgm_context *context, const csgm_field *field,
                               const csgm_face_options *options, const csgm_measure_options *how,
                               csgm_faces *out)
{
    CSG_ZONE(context, "faces");
    const csgm_interval unknown = {0, INFINITY};
    csg_mesh_watch watch = {0};
    csg_measure_walk walk;
    csgm_status status = csg_measure_check_bounds(context, field->bounds);
    if (status != CSGM_OK)
        return status;
    out->area = out->overhang = out->resting = out->steep = unknown;
    csg_mesh_watch_begin(&watch, context, &how->monitor, 0);
    status = csg_measure_walk_begin(&walk, context, field, &watch);
    job j = {.walk = &walk,
             .how = how,
             .up = csg_vec3_normalize(options->up),
             .size = csg_box_longest_side(field->bounds)};
    if (status == CSGM_OK)
        status = take_all(&j, options, out);
    csg_measure_walk_release(&walk);
    return status;
}
