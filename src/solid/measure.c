/* SPDX-License-Identifier: MIT
 * What is asked of whole nodes: is the field an exact distance, polygons of a flat
 * node, triangles and the tight box of a solid.
 */
#include <math.h>

#include "base/clock.h"
#include "scene/outlines/flatten.h"
#include "scene/primitives/primitive.h"
#include "scene/warp_kinds.h"
#include "solid/measure.h"
#include "solid/pieces.h"

/* ---- exact distances ------------------------------------------------------------------------- */

typedef struct exactness { /* of a node on one side of its surface */
    csg_node_id node;
    bool outside;
} exactness;

typedef struct exact_stack {
    csg_memory *memory;
    exactness *items;
    size_t count, capacity;
    bool of_leaves; /* operators, blends and offsets do not count */
} exact_stack;

static bool add_exactness(exact_stack *stack, csg_node_id node, bool outside)
{
    if (!csg_memory_reserve(stack->memory, (void **)&stack->items, &stack->capacity,
                            stack->count + 1, sizeof *stack->items))
        return false;
    stack->items[stack->count++] = (exactness){node, outside};
    return true;
}

/* Of one operator: a union is exact outside, an intersection inside, where its operands are. */
static bool look_at(const csgm_scene *scene, exactness at, exact_stack *stack)
{
    const csg_node *node = &scene->nodes[at.node];
    bool joins = node->kind == CSG_NODE_UNION && at.outside;
    bool meets =
        (node->kind == CSG_NODE_INTERSECTION || node->kind == CSG_NODE_DIFFERENCE) && !at.outside;
    if (node->kind == CSG_NODE_SHAPE || node->kind == CSG_NODE_EMPTY)
        return true;
    if (csg_node_is_named_primitive(node->kind))
        return csg_primitive_has(node->kind, at.outside || stack->of_leaves ? CSG_TRAIT_OUTSIDE
                                                                            : CSG_TRAIT_INSIDE);
    if (node->kind == CSG_NODE_FIELD || node->kind == CSG_NODE_SOFT ||
        node->kind == CSG_NODE_COMBINE)
        return false;
    if (node->kind == CSG_NODE_TRANSFORM &&
        !csg_affine_is_similarity(&scene->transforms[node->payload]))
        return false;
    if (node->kind == CSG_NODE_OFFSET && !stack->of_leaves &&
        (scene->parameters[node->payload] > 0) != at.outside)
        return false;
    if (node->kind == CSG_NODE_WARP && scene->warps[node->payload].kind != CSG_WARP_REVOLVE &&
        scene->warps[node->payload].kind != CSG_WARP_ELBOW)
        return false;
    if (csg_node_is_operator(node->kind) && !stack->of_leaves && !csg_node_is_plate(node) &&
        (!csg_blend_is_sharp(node->blend) || (!joins && !meets)))
        return false;
    for (uint32_t i = 0; i < node->child_count; i++) {
        bool flips = node->kind == CSG_NODE_DIFFERENCE && i > 0;
        if (!add_exactness(stack, csg_scene_children(scene, node)[i], at.outside != flips))
            return false; /* out of memory: the careful way will say so */
    }
    return true;
}

static bool is_exact(exact_stack *stack, const csgm_scene *scene, csg_node_id node, bool outside)
{
    bool exact = add_exactness(stack, node, outside);
    while (exact && stack->count)
        exact = look_at(scene, stack->items[--stack->count], stack);
    csg_memory_release(stack->memory, stack->items, stack->capacity * sizeof *stack->items);
    return exact;
}

bool csg_distance_is_exact(const csg_solid_job *job, csg_node_id node, bool outside)
{
    return is_exact(&(exact_stack){.memory = job->memory}, job->builder->scene, node, outside);
}

bool csg_distances_are_joined(const csg_solid_job *job, csg_node_id node)
{
    exact_stack stack = {.memory = job->memory, .of_leaves = true};
    return is_exact(&stack, job->builder->scene, node, true);
}

/* ---- sizes ----------------------------------------------------------------------------------- */

static double longest_side(csg_box box, bool flat)
{
    csg_vec3 size = csg_box_size(box);
    return fmax(fmax(size.x, size.y), flat ? 0 : size.z);
}

bool csg_finite_size(csg_solid_job *job, csg_node_id node, double *out)
{
    bool flat = csg_solid_is_flat(job, node);
    csg_box box = csg_build_box(job->builder, node);
    if (job->builder->status != CSGM_OK) {
        csg_solid_done(job, CSG_NODE_NONE);
        return false;
    }
    *out = longest_side(box, flat);
    if (isfinite(*out) && !csg_box_is_empty(box))
        return true;
    csg_solid_note(job, &(csg_solid_reason){.fault = csg_box_is_empty(box) ? CSG_SOLID_NO_SURFACE
                                                                           : CSG_SOLID_UNBOUNDED});
    job->failed = true;
    return false;
}

/* ---- polygons and triangles ------------------------------------------------------------------ */

csgm_status csg_flat_outline(csg_solid_job *job, csg_node_id node, csg_outline *out)
{
    const double fine = 1e-5;
    double size = 1;
    csg_outline_init(out, job->memory);
    if (!csg_finite_size(job, node, &size))
        return job->stop ? CSGM_ERR_MEMORY : CSGM_ERR_SCENE;
    if (!csg_solid_check_time(job))
        return CSGM_ERR_LIMIT;
    return csg_flatten(job->builder, node, fine * size, out);
}

/* In what is left of the evaluation's time. */
static csgm_status tessellate_in_time(csg_solid_job *job, const csgm_scene *scene, uint32_t cells,
                                      csg_triangles *out)
{
    csgm_context *context = job->builder->context;
    double whole = context->limits.timeout_s;
    if (!csg_solid_check_time(job))
        return CSGM_ERR_LIMIT;
    if (job->deadline_s != 0)
        context->limits.timeout_s = fmax(job->deadline_s - csg_clock_now_s(), 1e-3);
    csgm_status status = job->tessellate(context, scene, cells, out);
    context->limits.timeout_s = whole;
    csg_solid_check_time(job);
    return status;
}

csgm_status csg_solid_triangles(csg_solid_job *job, csg_node_id node, csg_triangles *out)
{
    enum { CELLS = 160 };
    return csg_solid_triangles_by(job, node, CELLS, out);
}

csgm_status csg_solid_triangles_by(csg_solid_job *job, csg_node_id node, uint32_t cells,
                                   csg_triangles *out)
{
    csgm_scene *scene = NULL;
    csg_vec3 size = csg_box_size(csg_build_box(job->builder, node));
    csg_triangles_init(out, job->memory);
    if (!(fmin(size.x, fmin(size.y, size.z)) > 0))
        return CSGM_OK; /* nothing but a face or an edge that two solids share */
    if (!job->tessellate)
        return CSGM_ERR_UNSUPPORTED;
    csgm_status status = csg_build_snapshot(job->builder, node, &scene);
    if (status != CSGM_OK)
        return status;
    status = tessellate_in_time(job, scene, cells, out);
    csg_scene_destroy(scene);
    return status;
}

/* The sides of `rough` (within a cell) that agree with `bound` are exact there. */
static csg_box snap(csg_box rough, csg_box bound)
{
    const double cell = 1.5 / 160;
    double slack = cell * longest_side(rough, false);
    double *r = &rough.min.x;
    const double *b = &bound.min.x;
    for (int i = 0; i < 6; i++)
        if (fabs(r[i] - b[i]) < slack)
            r[i] = b[i];
    return rough;
}

static csgm_status box_of_pieces(csg_solid_job *job, const csg_solid_pieces *pieces, double size,
                                 csg_box *out)
{
    *out = csg_box_empty();
    for (size_t i = 0; i < pieces->count; i++) {
        csg_cloud cloud;
        csg_cloud_init(&cloud, job->memory);
        csgm_status status = csg_piece_cloud(job, &pieces->items[i], 1e-7 * size, &cloud);
        for (size_t k = 0; k < cloud.count && status == CSGM_OK; k++) {
            csg_box ball = {cloud.balls[k].at, cloud.balls[k].at};
            *out = csg_box_hull(*out, csg_box_grow(ball, cloud.balls[k].radius));
        }
        csg_cloud_release(&cloud);
        if (status != CSGM_OK)
            return status;
    }
    return CSGM_OK;
}

csgm_status csg_tight_box(csg_solid_job *job, csg_node_id node, csg_box *out)
{
    double size = 0;
    csg_solid_pieces pieces;
    if (!csg_finite_size(job, node, &size))
        return job->stop ? CSGM_ERR_MEMORY : CSGM_ERR_SCENE;
    csg_box bound = csg_build_box(job->builder, node);
    csg_pieces_init(&pieces, job->memory);
    csgm_status status =
        csg_pieces_collect(job->builder->scene, node, &pieces) ? CSGM_OK : CSGM_ERR_MEMORY;
    if (status == CSGM_OK)
        status = box_of_pieces(job, &pieces, size, out);
    csg_pieces_release(&pieces);
    if (status == CSGM_OK)
        *out = snap(*out, bound);
    return status;
}
