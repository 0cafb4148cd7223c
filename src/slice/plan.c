/* SPDX-License-Identifier: MIT
 * The plan of all layers; see plan.h.
 */
#include "slice/plan.h"

#include <float.h>
#include <math.h>

#include "field/kernels/dispatch.h"

/* The root is wider than the solid by this share, and begins there, so that faces at round
 * coordinates are not on lines of the lattice, where a contour would have to keep off corners. */
static const double MARGIN = 0.0137, BEFORE = 0.0061;

size_t csg_slice_layers_below(const csg_slice_plan *plan, double z)
{
    size_t low = 0, high = plan->layer_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (plan->z[middle] < z)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static double largest_coordinate(csg_box box)
{
    return fmax(
        fmax(fmax(fabs(box.min.x), fabs(box.max.x)), fmax(fabs(box.min.y), fabs(box.max.y))),
        fmax(fabs(box.min.z), fabs(box.max.z)));
}

void csg_slice_plan_make(csg_slice_plan *plan, csgm_context *context, const csgm_field *field,
                         csg_mesh_watch *watch, double tolerance, const double *z,
                         size_t layer_count)
{
    *plan = (csg_slice_plan){.context = context,
                             .field = field,
                             .watch = watch,
                             .kernel = csg_kernel_for(context->isa),
                             .tolerance = tolerance,
                             .z = z,
                             .layer_count = layer_count};
    csg_box b = {csg_vec3_sub(field->bounds.min, field->center),
                 csg_vec3_sub(field->bounds.max, field->center)};
    double edge = csg_box_longest_side(b) * (1 + MARGIN);
    plan->corner[0] = b.min.x - BEFORE * edge;
    plan->corner[1] = b.min.y - BEFORE * edge;
    plan->corner[2] = b.min.z - BEFORE * edge;
    plan->step = edge;
    while (plan->levels < CSG_SLICE_LEAST_LEVELS ||
           (plan->levels < CSG_SLICE_DEEPEST &&
            plan->step * CSG_SLICE_CUBES_IN_TOLERANCE > tolerance)) {
        plan->step /= 2;
        plan->levels++;
    }
    double height =
        layer_count > 1 ? (z[layer_count - 1] - z[0]) / (double)(layer_count - 1) : edge;
    while (plan->slab_level < CSG_SLICE_SLAB_LEVELS && plan->slab_level < plan->levels &&
           ldexp(edge, -plan->slab_level - 1) >= CSG_SLICE_SLAB_LAYERS * height)
        plan->slab_level++;
    double reach = largest_coordinate(b) + edge * MARGIN;
    plan->rounding = (float)(32 * (double)FLT_EPSILON * reach * sqrt(3.0));
    plan->bounds = csg_box_grow(b, (double)plan->rounding + 1e-12 * csg_vec3_norm(field->center));
}
