/* SPDX-License-Identifier: MIT
 * What stands for a hull, a sum or a shadow where nobody will look at it: its box (solid.h).
 */
#include "scene/primitives/kinds.h"
#include "shape/polyhedra/hull.h"
#include "solid/measure.h"

static csg_node_id moved_to(csg_solid_job *job, csg_node_id node, csg_vec3 at)
{
    const csg_affine by = csg_affine_translate(at);
    return csg_solid_moved(job, csg_solid_done(job, node), &by);
}

bool csg_solid_sketch(csg_solid_job *job, csg_box box, csg_node_id *out)
{
    csg_vec3 half = csg_vec3_scale(csg_box_size(box), 0.5);
    const double sizes[4] = {half.x, half.y, half.z, 0};
    if (!job->sketches || !csg_hull_is_available() || !(half.x > 0 && half.y > 0 && half.z > 0))
        return false;
    *out = moved_to(job, csg_build_primitive(job->builder, CSG_NODE_BOX, sizes, job->where),
                    csg_box_center(box));
    return true;
}

bool csg_solid_sketch_flat(csg_solid_job *job, csg_box box, csg_node_id *out)
{
    csg_vec3 half = csg_vec3_scale(csg_box_size(box), 0.5), middle = csg_box_center(box);
    const double sides[3] = {half.x, half.y, 0};
    if (!job->sketches || !(half.x > 0 && half.y > 0 && half.z > 0))
        return false;
    *out = moved_to(job, csg_build_primitive(job->builder, CSG_NODE_RECTANGLE, sides, job->where),
                    csg_vec3_make(middle.x, middle.y, 0));
    return true;
}
