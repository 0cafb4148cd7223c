/* SPDX-License-Identifier: MIT
 * A soft solid's field does not fall below its plateau, -1 / (2 lambda), however far away; to a
 * blend of lengths that reaches beyond the plateau it would be near everywhere. Such an operand is
 * cut by the box in which it is above its plateau (Nguyen's improved function, operators.md 3.2 and
 * 9): within the box nothing changes, since its sides are farther away than the surface is, and
 * outside the field falls as the distance from the box does. A figure of the plane is cut by a
 * rectangle. Of a sharp union that has others beside it each is cut for itself: the box of all may
 * hold much where nothing is.
 */
#include "scene/boxes/bounds.h"
#include "scene/operators/rule.h"
#include "scene/primitives/kinds.h"
#include "scene/reference.h"
#include "scene/tree/build_private.h"
#include "scene/tree/check.h"

/* What is above this share of the plateau's depth is in the box. */
#define DEPTH 0.999
/* Times the box's size: where the field has reached its plateau. */
#define FAR 1e3

/* Nodes between an operand and what is cut; what stands deeper is cut as a whole. */
enum { DEEPEST = 64 };

/* A figure's box has no end along z. */
static csg_box across(csg_box box, bool is_flat)
{
    if (is_flat)
        box.min.z = box.max.z = 0;
    return box;
}

/* A sealed soft solid's plateau as a depth > 0, and the box in which it is above that; false: it
 * has none. */
static bool plateau_of(csg_scene_builder *builder, const csgm_scene *scene, double *depth,
                       csg_box *box)
{
    bool is_flat = scene->nodes[scene->root].flags & CSG_FLAG_FLAT;
    csg_box solid = across(csg_bounds_of_solid(scene), is_flat);
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
        *box = across(bounds[scene->root].level_box, is_flat);
    else
        csg_check_fail(builder, status, "%s", "");
    csg_memory_release(memory, bounds, bytes);
    return status == CSGM_OK && *depth > 0 && csg_box_is_finite(*box) && !csg_box_is_empty(*box);
}

static csg_node_id cut(csg_scene_builder *builder, csg_node_id operand, csg_box box, csg_span where)
{
    if (!(builder->scene->nodes[operand].flags & CSG_FLAG_FLAT))
        return csg_build_cut(builder, operand, box, where);
    csg_vec3 half = csg_vec3_scale(csg_box_size(box), 0.5);
    csg_affine place = csg_affine_translate(csg_box_center(box));
    csg_node_id frame =
        csg_build_primitive(builder, CSG_NODE_RECTANGLE, (double[]){half.x, half.y, 0}, where);
    if (frame != CSG_NODE_NONE)
        frame = csg_build_transform(builder, &place, frame, where);
    if (frame == CSG_NODE_NONE)
        return frame;
    return csg_build_operator(builder, CSG_NODE_INTERSECTION, CSG_SHARP,
                              (csg_node_id[]){operand, frame}, 2, where);
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
    return ends && !(support <= depth) ? cut(builder, operand, box, where) : operand;
}

static csg_node_id ended(csg_scene_builder *builder, csg_node_id id, double support, int depth);

/* A sharp union whose operands are ended, as far as they need it. */
static csg_node_id union_of_ended(csg_scene_builder *builder, csg_node_id id, double support,
                                  int depth)
{
    csg_node node = builder->scene->nodes[id];
    csg_memory *memory = &builder->context->memory;
    size_t bytes = node.child_count * sizeof(csg_node_id);
    csg_node_id *made = csg_memory_alloc(memory, bytes);
    bool is_same = true, failed = !made;
    if (!made)
        return csg_build_no_memory(builder);
    for (uint32_t k = 0; k < node.child_count && !failed; k++) {
        csg_node_id child = builder->scene->children[node.first_child + k];
        made[k] = ended(builder, child, support, depth);
        is_same &= made[k] == child;
        failed = made[k] == CSG_NODE_NONE;
    }
    if (failed)
        id = CSG_NODE_NONE;
    else if (!is_same)
        id = csg_build_operator(builder, CSG_NODE_UNION, CSG_SHARP, made, node.child_count,
                                node.where);
    csg_memory_release(memory, made, bytes);
    return id;
}

/* What is placed or coloured, with an ended solid below. */
static csg_node_id around_ended(csg_scene_builder *builder, csg_node_id id, double support,
                                int depth)
{
    csg_node node = builder->scene->nodes[id];
    csg_node_id child = builder->scene->children[node.first_child];
    double least = 1, most = 1;
    if (node.kind == CSG_NODE_TRANSFORM)
        csg_affine_singular_values(&builder->scene->transforms[node.payload], &least, &most);
    csg_node_id made = ended(builder, child, support / least, depth);
    if (made == child || made == CSG_NODE_NONE)
        return made == child ? id : made;
    if (node.kind == CSG_NODE_TRANSFORM) {
        csg_affine matrix = builder->scene->transforms[node.payload];
        return csg_build_transform(builder, &matrix, made, node.where);
    }
    csg_look look = builder->scene->looks[node.payload];
    return csg_build_look(builder, &look, made, node.where);
}

static csg_node_id ended(csg_scene_builder *builder, csg_node_id id, double support, int depth)
{
    csg_node node = builder->scene->nodes[id];
    bool is_mixed = !(node.flags & CSG_FLAG_SOFT) && depth < DEEPEST;
    if (!(node.flags & CSG_FLAG_PLATEAU))
        return id;
    if (is_mixed && node.kind == CSG_NODE_UNION && csg_blend_is_sharp(node.blend))
        return union_of_ended(builder, id, support, depth + 1);
    if (is_mixed && (node.kind == CSG_NODE_TRANSFORM || node.kind == CSG_NODE_COLOR))
        return around_ended(builder, id, support, depth + 1);
    return with_an_end(builder, id, support);
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
        operands[i] = ended(builder, operands[i], support, 0);
        if (operands[i] == CSG_NODE_NONE)
            return false;
    }
    return true;
}
