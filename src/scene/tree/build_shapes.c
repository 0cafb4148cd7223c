/* SPDX-License-Identifier: MIT
 * Building what is neither a primitive nor an operator of the language: shapes, offsets,
 * extrusions, warps, and copies.
 */
#include "base/elementary.h"
#include "scene/boxes/bounds.h"
#include "scene/operators/blend_kinds.h"
#include "scene/primitives/kinds.h"
#include "scene/tree/build_private.h"
#include "scene/tree/check.h"
#include "scene/warp_kinds.h"

#include <string.h>

bool csg_build_is_flat(const csg_scene_builder *builder, csg_node_id node)
{
    return node < builder->scene->node_count && builder->scene->nodes[node].flags & CSG_FLAG_FLAT;
}

/* ---- shapes -----------------------------------------------------------------------------------
 */

static bool append_shape(csg_scene_builder *builder, csg_shape *shape)
{
    csgm_scene *scene = builder->scene;
    void *shapes = scene->shapes;
    if (!csg_memory_reserve(&builder->context->memory, &shapes, &builder->shape_capacity,
                            scene->shape_count + 1, sizeof *scene->shapes)) {
        csg_build_no_memory(builder);
        return false;
    }
    scene->shapes = shapes;
    scene->shapes[scene->shape_count++] = shape;
    return true;
}

csg_node_id csg_build_shape(csg_scene_builder *builder, csg_shape *shape, csg_span where)
{
    if (builder->status != CSGM_OK || !csg_build_reserve_node(builder) ||
        !append_shape(builder, shape)) {
        csg_shape_release(shape);
        return CSG_NODE_NONE;
    }
    csg_node node = {.kind = CSG_NODE_SHAPE,
                     .flags = shape->kind == CSG_SHAPE_REGION ? CSG_FLAG_FLAT : 0,
                     .payload = (uint32_t)builder->scene->shape_count - 1,
                     .where = where};
    return csg_build_append(builder, node, NULL, 0);
}

/* ---- offsets and extrusions --------------------------------------------------------------------
 */

static csg_node_id offset(csg_scene_builder *builder, double r, csg_node_id child, csg_span where)
{
    csgm_scene *scene = builder->scene;
    csg_node *node = &scene->nodes[child];
    if (node->kind == CSG_NODE_OFFSET) {
        double *sum = &scene->parameters[node->payload];
        return (*sum += r) == 0 ? csg_scene_children(scene, node)[0] : child;
    }
    if (!csg_build_reserve_node(builder) || !csg_build_reserve_children(builder, 1) ||
        !csg_build_reserve_parameters(builder, 1))
        return CSG_NODE_NONE;
    csg_node fresh = {
        .kind = CSG_NODE_OFFSET, .payload = (uint32_t)scene->parameter_count, .where = where};
    scene->parameters[scene->parameter_count++] = r;
    return csg_build_append(builder, fresh, &child, 1);
}

csg_node_id csg_build_offset(csg_scene_builder *builder, double r, csg_node_id child,
                             csg_span where)
{
    if (!csg_build_is_usable(builder, child) || !csg_check_offset(builder, r))
        return CSG_NODE_NONE;
    return r == 0 || builder->scene->nodes[child].kind == CSG_NODE_EMPTY
               ? child
               : offset(builder, r, child, where);
}

/* An operator of two that csg_build_operator does not offer. */
static csg_node_id meet(csg_scene_builder *builder, csg_blend_kind blend, csg_node_id a,
                        csg_node_id b, csg_span where)
{
    csgm_scene *scene = builder->scene;
    if (!csg_build_reserve_node(builder) || !csg_build_reserve_children(builder, 2) ||
        !csg_build_reserve_parameters(builder, 1))
        return CSG_NODE_NONE;
    csg_node node = {.kind = CSG_NODE_INTERSECTION,
                     .blend = (uint8_t)blend,
                     .payload = (uint32_t)scene->parameter_count,
                     .where = where};
    scene->parameters[scene->parameter_count++] = 0;
    return csg_build_append(builder, node, (csg_node_id[]){a, b}, 2);
}

static csg_node_id plate(csg_scene_builder *builder, csg_blend_kind blend, csg_node_id child,
                         double half, double middle, csg_span where)
{
    csg_affine place = csg_affine_translate(csg_vec3_make(0, 0, middle));
    csg_node_id slab = csg_build_primitive(builder, CSG_NODE_SLAB, &half, where);
    if (slab != CSG_NODE_NONE)
        slab = csg_build_transform(builder, &place, slab, where);
    return slab == CSG_NODE_NONE ? slab : meet(builder, blend, child, slab, where);
}

csg_node_id csg_build_plate(csg_scene_builder *builder, csg_node_id child, double half,
                            double middle, csg_span where)
{
    if (!csg_build_is_usable(builder, child))
        return CSG_NODE_NONE;
    if (builder->scene->nodes[child].kind == CSG_NODE_EMPTY)
        return child;
    if (csg_build_is_flat(builder, child))
        return plate(builder, CSG_BLEND_ORTHOGONAL, child, half, middle, where);
    csg_check_fail(builder, CSGM_ERR_SCENE, "what is extruded must be flat");
    return CSG_NODE_NONE;
}

csg_node_id csg_build_extrude(csg_scene_builder *builder, csg_node_id child, double low,
                              double high, csg_span where)
{
    if (!csg_build_is_usable(builder, child))
        return CSG_NODE_NONE;
    if (builder->scene->nodes[child].kind == CSG_NODE_EMPTY)
        return child;
    bool exact = csg_build_is_flat(builder, child);
    double half = (high - low) / 2;
    return plate(builder, exact ? CSG_BLEND_ORTHOGONAL : CSG_BLEND_SHARP, child, half, low + half,
                 where);
}

/* ---- warps -------------------------------------------------------------------------------------
 */

static csg_node_id append_warp(csg_scene_builder *builder, const csg_warp *warp, csg_node_id child,
                               csg_span where)
{
    csgm_scene *scene = builder->scene;
    void *warps = scene->warps;
    if (!csg_build_reserve_node(builder) || !csg_build_reserve_children(builder, 1))
        return CSG_NODE_NONE;
    if (!csg_memory_reserve(&builder->context->memory, &warps, &builder->warp_capacity,
                            scene->warp_count + 1, sizeof *scene->warps))
        return csg_build_no_memory(builder);
    scene->warps = warps;
    scene->warps[scene->warp_count] = *warp;
    csg_node node = {.kind = CSG_NODE_WARP,
                     .flags = csg_warp_traits(warp->kind) & CSG_WARP_IS_FLAT ? CSG_FLAG_FLAT : 0,
                     .payload = (uint32_t)scene->warp_count++,
                     .where = where};
    return csg_build_append(builder, node, &child, 1);
}

/* Beyond its reach a twist or a taper holds the field; a wall around it makes it fall again. Inside
 * the solid the wall is farther away than the surface. */
static csg_node_id wall(csg_scene_builder *builder, double radius, csg_span where)
{
    return csg_build_primitive(builder, CSG_NODE_CIRCLE, &radius, where);
}

/* The half-space on the side of +z from the line z = radius, turned about it by `angle`. */
static csg_node_id end_plane(csg_scene_builder *builder, double radius, double angle, double side,
                             csg_span where)
{
    /* the end lies in direction (sin angle, -cos angle) from the line */
    double nx = side * csg_cos(angle), nz = side * csg_sin(angle);
    return csg_build_half_space(builder, csg_vec3_make(nx, 0, nz), nz * radius, where);
}

/* A box around the bent bar, and the wedge in which its angles lie. */
static csg_node_id bend_room(csg_scene_builder *builder, const csg_warp *warp, csg_box child,
                             csg_span where)
{
    csg_box box = csg_warp_box(warp, child, false);
    box = csg_box_grow(box, 0.25 * csg_box_longest_side(box));
    csg_node_id room = csg_build_block(builder, box, where);
    const csg_blend sharp = CSG_SHARP;
    double radius = warp->parameters[CSG_BEND_RADIUS], angle = warp->parameters[CSG_BEND_ANGLE];
    csg_node_id ends[2] = {end_plane(builder, radius, angle, 1, where),
                           end_plane(builder, radius, -angle, -1, where)};
    if (room == CSG_NODE_NONE || ends[0] == CSG_NODE_NONE || ends[1] == CSG_NODE_NONE)
        return CSG_NODE_NONE;
    bool narrow = csg_cos(angle) >= 0; /* below 180 degrees the wedge is convex */
    csg_node_id wedge = csg_build_operator(builder, narrow ? CSG_NODE_INTERSECTION : CSG_NODE_UNION,
                                           sharp, ends, 2, where);
    if (wedge == CSG_NODE_NONE)
        return CSG_NODE_NONE;
    return csg_build_operator(builder, CSG_NODE_INTERSECTION, sharp, (csg_node_id[]){room, wedge},
                              2, where);
}

/* What is left of a warp that is cut, child: the box of what it warps. */
static csg_node_id room_of(csg_scene_builder *builder, const csg_warp *warp, csg_box child,
                           csg_span where)
{
    const double *v = warp->parameters;
    switch ((csg_warp_kind)warp->kind) {
    case CSG_WARP_TWIST:
        return wall(builder, v[CSG_TWIST_REACH], where);
    case CSG_WARP_TAPER:
        return wall(builder, v[CSG_TAPER_REACH] * fmax(1, fmax(v[CSG_TAPER_X], v[CSG_TAPER_Y])),
                    where);
    case CSG_WARP_BEND:
        return bend_room(builder, warp, child, where);
    case CSG_WARP_REVOLVE: /* these are not cut */
    case CSG_WARP_ELBOW:
    case CSG_WARP_SLICE:
    case CSG_WARP_COUNT:
        break;
    }
    return CSG_NODE_NONE;
}

/* Checks and settles the warp of a child that is not empty. *box: of the child's solid, where the
 * warp needs it; false after a failure. */
static bool settle(csg_scene_builder *builder, csg_warp *warp, csg_node_id child, csg_box *box)
{
    const char *why = "";
    bool needs_box = csg_warp_traits(warp->kind) & CSG_WARP_IS_CUT;
    *box = needs_box ? csg_build_box(builder, child) : csg_box_all();
    if (builder->status != CSGM_OK)
        return false;
    if (!csg_warp_settle(warp, *box, &why))
        csg_check_fail(builder, CSGM_ERR_SCENE, "%s", why);
    return builder->status == CSGM_OK;
}

csg_node_id csg_build_bare_warp(csg_scene_builder *builder, const csg_warp *given,
                                csg_node_id child, csg_span where)
{
    csg_warp warp = *given;
    csg_box box;
    if (!csg_build_is_usable(builder, child) || !csg_check_warp(builder, &warp, child))
        return CSG_NODE_NONE;
    if (builder->scene->nodes[child].kind == CSG_NODE_EMPTY)
        return child;
    return settle(builder, &warp, child, &box) ? append_warp(builder, &warp, child, where)
                                               : CSG_NODE_NONE;
}

csg_node_id csg_build_warp(csg_scene_builder *builder, const csg_warp *given, csg_node_id child,
                           csg_span where)
{
    csg_warp warp = *given;
    csg_box box;
    if (!csg_build_is_usable(builder, child) || !csg_check_warp(builder, &warp, child))
        return CSG_NODE_NONE;
    if (builder->scene->nodes[child].kind == CSG_NODE_EMPTY)
        return child;
    if (!settle(builder, &warp, child, &box))
        return CSG_NODE_NONE;
    if (csg_box_is_empty(box))
        return csg_build_empty(builder, where);
    csg_node_id warped = append_warp(builder, &warp, child, where);
    if (warped == CSG_NODE_NONE || !(csg_warp_traits(warp.kind) & CSG_WARP_IS_CUT))
        return warped;
    csg_node_id room = room_of(builder, &warp, box, where);
    return room == CSG_NODE_NONE ? room
                                 : csg_build_operator(builder, CSG_NODE_INTERSECTION, CSG_SHARP,
                                                      (csg_node_id[]){warped, room}, 2, where);
}

/* ---- copies and looks ---------------------------------------------------------------------------
 */

csg_box csg_build_box(csg_scene_builder *builder, csg_node_id node)
{
    csgm_scene *scene;
    csgm_status status = csg_build_snapshot(builder, node, &scene);
    if (status != CSGM_OK) {
        if (builder->status == CSGM_OK)
            csg_check_fail(builder, status, "%s", "");
        return csg_box_empty();
    }
    csg_box box = csg_bounds_of_solid(scene);
    csg_scene_destroy(scene);
    return box;
}

/* A copy of one node over copies of its children. */
static csg_node_id copy_node(csg_scene_builder *builder, csg_node_id id, csg_node_id *copies)
{
    csgm_scene *scene = builder->scene;
    csg_node node = scene->nodes[id];
    uint32_t count = node.child_count;
    uint32_t own = csg_node_parameter_count(&node);
    if (!csg_build_reserve_node(builder) || !csg_build_reserve_children(builder, count) ||
        !csg_build_reserve_parameters(builder, own))
        return CSG_NODE_NONE;
    if (node.kind == CSG_NODE_SHAPE) {
        csg_shape *shape = scene->shapes[node.payload];
        if (!append_shape(builder, shape))
            return CSG_NODE_NONE;
        csg_shape_retain(shape);
        node.payload = (uint32_t)scene->shape_count - 1;
    } else if (own) {
        for (uint32_t i = 0; i < own; i++)
            scene->parameters[scene->parameter_count + i] = scene->parameters[node.payload + i];
        node.payload = (uint32_t)scene->parameter_count;
        scene->parameter_count += own;
    } else if (node.kind == CSG_NODE_TRANSFORM || node.kind == CSG_NODE_COLOR) {
        /* folding changes these in place */
        return node.kind == CSG_NODE_TRANSFORM
                   ? csg_build_append_transform(builder, scene->transforms[node.payload], copies[0],
                                                node.where)
                   : csg_build_append_look(builder, &scene->looks[node.payload], copies[0],
                                           node.where);
    }
    return csg_build_append(builder, node, copies, count); /* formulas and warps are shared */
}

/* Nodes whose copies are wanted, parents before children. */
typedef struct copying {
    csg_node_id *order, *copies, *stack, *operands;
    size_t order_count, order_capacity, stack_count, stack_capacity, copies_capacity,
        operand_capacity;
} copying;

static bool plan_copy(csg_scene_builder *builder, csg_node_id root, copying *c)
{
    csg_memory *memory = &builder->context->memory;
    const csgm_scene *scene = builder->scene;
    for (csg_node_id at = root;; at = c->stack[--c->stack_count]) {
        const csg_node *node = &scene->nodes[at];
        if (!csg_memory_reserve(memory, (void **)&c->order, &c->order_capacity, c->order_count + 1,
                                sizeof at) ||
            !csg_memory_reserve(memory, (void **)&c->stack, &c->stack_capacity,
                                c->stack_count + node->child_count, sizeof at))
            return false;
        c->order[c->order_count++] = at;
        for (uint32_t i = 0; i < node->child_count; i++)
            c->stack[c->stack_count++] = csg_scene_children(scene, node)[i];
        if (!c->stack_count)
            return true;
    }
}

/* Backwards: the copies of a node's children are the last ones on the stack, the first on top. */
static csg_node_id make_copies(csg_scene_builder *builder, copying *c)
{
    csg_memory *memory = &builder->context->memory;
    size_t top = 0;
    if (!csg_memory_reserve(memory, (void **)&c->copies, &c->copies_capacity, c->order_count,
                            sizeof *c->copies))
        return csg_build_no_memory(builder);
    for (size_t i = c->order_count; i-- > 0;) {
        uint32_t count = builder->scene->nodes[c->order[i]].child_count;
        if (!csg_memory_reserve(memory, (void **)&c->operands, &c->operand_capacity, count,
                                sizeof *c->operands))
            return csg_build_no_memory(builder);
        /* The stack gave the last child first, so its copy was made last of them. */
        for (uint32_t k = 0; k < count; k++)
            c->operands[count - 1 - k] = c->copies[--top];
        csg_node_id copy = copy_node(builder, c->order[i], c->operands);
        if (copy == CSG_NODE_NONE)
            return copy;
        c->copies[top++] = copy;
    }
    return c->copies[0];
}

csg_node_id csg_build_copy(csg_scene_builder *builder, csg_node_id node)
{
    copying c = {0};
    if (!csg_build_is_usable(builder, node))
        return CSG_NODE_NONE;
    csg_memory *memory = &builder->context->memory;
    csg_node_id copy =
        plan_copy(builder, node, &c) ? make_copies(builder, &c) : csg_build_no_memory(builder);
    csg_memory_release(memory, c.order, c.order_capacity * sizeof *c.order);
    csg_memory_release(memory, c.stack, c.stack_capacity * sizeof *c.stack);
    csg_memory_release(memory, c.copies, c.copies_capacity * sizeof *c.copies);
    csg_memory_release(memory, c.operands, c.operand_capacity * sizeof *c.operands);
    return copy;
}
