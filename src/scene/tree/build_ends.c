/* SPDX-License-Identifier: MIT
 * A soft solid's field does not fall below its plateau, -1 / (2 lambda), however far away; to a
 * blend of lengths that reaches beyond the plateau it would be near everywhere. Such an operand is
 * cut by the box in which it is above its plateau (Nguyen's improved function, operators.md 3.2 and
 * 9): within the box nothing changes, since its sides are farther away than the surface is, and
 * outside the field falls as the distance from the box does.
 */
#include "scene/boxes/bounds.h"
#include "scene/operators/rule.h"
#include "scene/reference.h"
#include "scene/tree/build_private.h"
#include "scene/tree/check.h"

/* What is above this share of the plateau's depth is in the box. */
#define DEPTH 0.999
/* Times the box's size: where the field has reached its plateau. */
#define FAR 1e3

/* A sealed soft solid's plateau as a depth > 0, and the box in which it is above that; false: it
 * has none. */
static bool plateau_of(csg_scene_builder *builder, const csgm_scene *scene, double *depth,
                       csg_box *box)
{
    csg_box solid = csg_bounds_of_solid(scene);
    if (csg_box_is_empty(solid) || !csg_box_is_finite(solid))
        return false;
    csg_vec3 beyond = csg_box_center(solid);
    beyond.x += FAR * csg_box_longest_side(solid);
    csgm_status status = CSGM_OK;
    *depth = -csg_reference_eval(scene, beyond, &status).value;
    csg_memory *memory = &builder->context->memory;
    size_t bytes = scene->node_count * sizeof(csg_node_bounds);
    csg_node_bounds *bounds = csg_memory_alloc(memory, bytes);
    if (status == CSGM_OK)
        status = bounds ? csg_bounds_compute(scene, DEPTH * *depth, bounds) : CSGM_ERR_MEMORY;
    if (status == CSGM_OK)
        *box = bounds[scene->root].level_box;
    else
        csg_check_fail(builder, status, "%s", "");
    csg_memory_release(memory, bounds, bytes);
    return status == CSGM_OK && *depth > 0 && csg_box_is_finite(*box) && !csg_box_is_empty(*box);
}

static csg_node_id with_an_end(csg_scene_builder *builder, csg_node_id operand, double support)
{
    csgm_scene *scene = NULL;
    double depth = 0;
    csg_box box;
    csgm_status status = csg_build_snapshot(builder, operand, &scene);
    if (status != CSGM_OK) {
        csg_check_fail(builder, status, "%s", "");
        return CSG_NODE_NONE;
    }
    bool ends = plateau_of(builder, scene, &depth, &box);
    csg_scene_destroy(scene);
    if (builder->status != CSGM_OK)
        return CSG_NODE_NONE;
    csg_span where = builder->scene->nodes[operand].where;
    return ends && !(support <= depth) ? csg_build_cut(builder, operand, box, where) : operand;
}

double csg_build_support(const csg_scene_builder *builder, csg_blend blend)
{
    if (csg_blend_is_profile(blend.kind)) /* its function is found with its operands */
        return INFINITY;
    return csg_blend_is_rule(blend.kind) ? csg_rule_support(&builder->scene->rules[(size_t)blend.n])
                                         : csg_blend_support(blend);
}

bool csg_build_end_plateaus(csg_scene_builder *builder, csg_node_kind kind, double support,
                            csg_node_id *operands, size_t count)
{
    if (!(support > 0) || kind == CSG_NODE_INTERSECTION)
        return true;
    for (size_t i = kind == CSG_NODE_DIFFERENCE; i < count; i++) {
        uint8_t flags = builder->scene->nodes[operands[i]].flags;
        if ((flags & CSG_FLAG_SOFT) && !(flags & CSG_FLAG_FLAT))
            operands[i] = with_an_end(builder, operands[i], support);
        if (operands[i] == CSG_NODE_NONE)
            return false;
    }
    return true;
}
