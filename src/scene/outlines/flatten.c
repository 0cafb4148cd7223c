/* SPDX-License-Identifier: MIT
 * Flat nodes to outlines (flatten.h): a walk down notes the nodes, parents before children, with
 * the tolerance in each one's own frame; a walk back makes their outlines on a stack.
 */
#include "scene/outlines/flatten.h"

#include "scene/outlines/trace.h"
#include "scene/primitives/kinds.h"
#include "scene/tree/figures.h"
#include "shape/plane/polygons.h"
#include "shape/plane/region.h"

typedef struct step {
    csg_node_id node;
    double tolerance;
} step;

typedef struct flattener {
    csg_scene_builder *builder;
    csg_memory *memory;
    step *steps; /* parents before children */
    step *waiting;
    csg_outline *done; /* outlines of nodes whose parents are not made yet */
    size_t step_count, step_capacity, waiting_count, waiting_capacity, done_count, done_capacity;
} flattener;

static const csg_node *node_at(const flattener *f, csg_node_id id)
{
    return &f->builder->scene->nodes[id];
}

/* ---- down --------------------------------------------------------------------------------- */

/* Whether its outline comes from those of its children. */
static bool is_made_of_children(const csg_node *node)
{
    switch ((csg_node_kind)node->kind) {
    case CSG_NODE_TRANSFORM:
    case CSG_NODE_COLOR:
    case CSG_NODE_OFFSET:
        return true;
    case CSG_NODE_UNION:
    case CSG_NODE_INTERSECTION:
    case CSG_NODE_DIFFERENCE:
        return csg_blend_is_sharp(node->blend);
    case CSG_NODE_EMPTY:
    case CSG_NODE_FIELD:
    case CSG_NODE_SHAPE:
    case CSG_NODE_WARP:
    case CSG_NODE_COMBINE:
    case CSG_NODE_SOFT:
    case CSG_NODE_FIRST_PRIMITIVE:
        break;
    }
    return false;
}

/* The most by which the plane part of the map stretches. */
static double stretch_of(const csg_affine *map)
{
    double a = map->m[0][0], b = map->m[0][1], c = map->m[1][0], d = map->m[1][1];
    double squares = a * a + b * b + c * c + d * d, det = a * d - b * c;
    double rest = sqrt(fmax(squares * squares - 4 * det * det, 0));
    return sqrt(0.5 * (squares + rest));
}

static bool push_step(flattener *f, step **steps, size_t *count, size_t *capacity, step s)
{
    void *data = *steps;
    if (!csg_memory_reserve(f->memory, &data, capacity, *count + 1, sizeof s))
        return false;
    *steps = data;
    (*steps)[(*count)++] = s;
    return true;
}

static bool plan(flattener *f, csg_node_id root, double tolerance)
{
    const csgm_scene *scene = f->builder->scene;
    if (!push_step(f, &f->waiting, &f->waiting_count, &f->waiting_capacity,
                   (step){root, tolerance}))
        return false;
    while (f->waiting_count) {
        step s = f->waiting[--f->waiting_count];
        const csg_node *node = node_at(f, s.node);
        if (!push_step(f, &f->steps, &f->step_count, &f->step_capacity, s))
            return false;
        if (!is_made_of_children(node))
            continue;
        if (node->kind == CSG_NODE_TRANSFORM)
            s.tolerance /= stretch_of(&scene->transforms[node->payload]);
        for (uint32_t k = 0; k < node->child_count; k++) {
            s.node = csg_scene_children(scene, node)[k];
            if (!push_step(f, &f->waiting, &f->waiting_count, &f->waiting_capacity, s))
                return false;
        }
    }
    return true;
}

/* ---- leaves ------------------------------------------------------------------------------- */

static bool add_circle(csg_outline *out, double radius, double tolerance)
{
    return csg_outline_arc(out, (csg_vec2){0, 0}, radius, 0, 360, tolerance) &&
           csg_outline_close(out);
}

static bool add_rectangle(csg_outline *out, const double *parameters, double tolerance)
{
    double round = parameters[2], x = parameters[0] - round, y = parameters[1] - round;
    const csg_vec2 centers[4] = {{x, y}, {-x, y}, {-x, -y}, {x, -y}};
    for (int k = 0; k < 4; k++) {
        csg_vec2 c = centers[k];
        csg_vec2 from = {c.x + (k == 0   ? round
                                : k == 2 ? -round
                                         : 0),
                         c.y + (k == 1   ? round
                                : k == 3 ? -round
                                         : 0)};
        if (!csg_outline_add(out, from) ||
            (round > 0 && !csg_outline_arc(out, c, round, 90 * k, 90, tolerance)))
            return false;
    }
    return csg_outline_close(out);
}

static csgm_status trace_node(flattener *f, csg_node_id node, csg_outline *out)
{
    csgm_scene *scene;
    csgm_status status = csg_build_snapshot(f->builder, node, &scene);
    if (status)
        return status;
    status = csg_trace(scene, CSG_TRACE_CELLS, out);
    csg_scene_destroy(scene);
    return status;
}

static csgm_status make_leaf(flattener *f, step s, csg_outline *out)
{
    const csgm_scene *scene = f->builder->scene;
    const csg_node *node = node_at(f, s.node);
    bool is_room = true;
    if (node->kind == CSG_NODE_CIRCLE)
        is_room = add_circle(out, csg_scene_parameters(scene, node)[0], s.tolerance);
    else if (node->kind == CSG_NODE_RECTANGLE)
        is_room = add_rectangle(out, csg_scene_parameters(scene, node), s.tolerance);
    else if (node->kind == CSG_NODE_SHAPE && scene->shapes[node->payload]->kind == CSG_SHAPE_REGION)
        is_room = csg_outline_append(out, csg_region_outline(scene->shapes[node->payload]));
    else if (node->kind != CSG_NODE_EMPTY)
        return trace_node(f, s.node, out);
    return is_room ? CSGM_OK : CSGM_ERR_MEMORY;
}

/* ---- what is made of children ------------------------------------------------------------- */

static void turn_round(csg_outline *outline)
{
    for (size_t loop = 0; loop < outline->loop_count; loop++) {
        size_t i = csg_outline_first(outline, loop), j = outline->ends[loop] - 1;
        for (; i < j; i++, j--) {
            csg_vec2 p = outline->points[i];
            outline->points[i] = outline->points[j];
            outline->points[j] = p;
        }
    }
}

static void place(csg_outline *outline, const csg_affine *map)
{
    csg_outline_transform(outline, map);
    if (map->m[0][0] * map->m[1][1] - map->m[0][1] * map->m[1][0] < 0)
        turn_round(outline); /* a reflection */
}

/* *first becomes what `made` is; status as it was made. */
static csgm_status replace(csg_outline *first, csg_outline *made, csgm_status status)
{
    if (status)
        return status;
    csg_outline_release(first);
    *first = *made;
    return CSGM_OK;
}

static csgm_status combine(csg_polygons_op op, csg_outline *first, const csg_outline *other)
{
    csg_outline made;
    return replace(first, &made, csg_polygons_combine(op, first, other, &made));
}

/* operands[0] becomes the outline of the operator. */
static csgm_status operate(csg_node_kind kind, csg_outline *operands, size_t count)
{
    csgm_status status = CSGM_OK;
    if (kind == CSG_NODE_INTERSECTION) {
        for (size_t k = 1; k < count && !status; k++)
            status = combine(CSG_POLYGONS_INTERSECTION, &operands[0], &operands[k]);
        return status;
    }
    /* the loops of several may overlap: they are read by their winding numbers */
    size_t first = kind == CSG_NODE_UNION ? 0 : 1;
    for (size_t k = first + 1; k < count; k++) {
        if (!csg_outline_append(&operands[first], &operands[k]))
            return CSGM_ERR_MEMORY;
    }
    if (kind == CSG_NODE_DIFFERENCE)
        return combine(CSG_POLYGONS_DIFFERENCE, &operands[0], &operands[1]);
    csg_outline made;
    return replace(&operands[0], &made, csg_polygons_clean(&operands[0], CSG_FILL_NONZERO, &made));
}

static csgm_status make_of_children(flattener *f, step s, csg_outline *operands)
{
    const csgm_scene *scene = f->builder->scene;
    const csg_node *node = node_at(f, s.node);
    csg_outline made;
    if (node->kind == CSG_NODE_TRANSFORM)
        place(&operands[0], &scene->transforms[node->payload]);
    if (node->kind == CSG_NODE_OFFSET)
        return replace(&operands[0], &made,
                       csg_polygons_offset(&operands[0], csg_scene_parameters(scene, node)[0],
                                           CSG_CORNER_ROUND, s.tolerance, &made));
    return csg_node_is_operator(node->kind) && node->child_count > 1
               ? operate((csg_node_kind)node->kind, operands, node->child_count)
               : CSGM_OK;
}

/* ---- back up ------------------------------------------------------------------------------ */

/* The outlines of a node's children are the last ones on the stack, in their order. */
static csgm_status make(flattener *f, step s)
{
    const csg_node *node = node_at(f, s.node);
    uint32_t count = is_made_of_children(node) ? node->child_count : 0;
    void *done = f->done;
    if (!csg_memory_reserve(f->memory, &done, &f->done_capacity, f->done_count + 1,
                            sizeof *f->done))
        return CSGM_ERR_MEMORY;
    f->done = done;
    csg_outline *operands = &f->done[f->done_count - count];
    if (!count) {
        csg_outline_init(operands, f->memory);
        f->done_count++;
        return make_leaf(f, s, operands);
    }
    csgm_status status = make_of_children(f, s, operands);
    while (count-- > 1)
        csg_outline_release(&f->done[--f->done_count]);
    return status;
}

/* What is traced is beyond words. */
static bool add_to_key(const flattener *f, const csg_node *node, csg_figure_key *key)
{
    const csgm_scene *scene = f->builder->scene;
    bool ok = csg_figure_key_word(key, node->kind) && csg_figure_key_word(key, node->child_count);
    if (node->kind == CSG_NODE_TRANSFORM) {
        const csg_affine *map = &scene->transforms[node->payload];
        return ok && csg_figure_key_numbers(key, map->m[0], 2) &&
               csg_figure_key_numbers(key, map->m[1], 2) && csg_figure_key_numbers(key, map->t, 2);
    }
    if (node->kind == CSG_NODE_CIRCLE || node->kind == CSG_NODE_RECTANGLE ||
        node->kind == CSG_NODE_OFFSET)
        return ok && csg_figure_key_numbers(key, csg_scene_parameters(scene, node),
                                            csg_node_parameter_count(node));
    if (node->kind == CSG_NODE_SHAPE && scene->shapes[node->payload]->kind == CSG_SHAPE_REGION)
        return ok && csg_figure_key_shape(key, scene->shapes[node->payload]);
    key->is_known = key->is_known && (node->kind == CSG_NODE_EMPTY || is_made_of_children(node));
    return ok;
}

/* Does its outline depend on the tolerance? */
static bool is_curved(const flattener *f, const csg_node *node)
{
    return node->kind == CSG_NODE_CIRCLE || node->kind == CSG_NODE_OFFSET ||
           (node->kind == CSG_NODE_RECTANGLE &&
            csg_scene_parameters(f->builder->scene, node)[2] > 0);
}

/* Of the steps from `first` on. */
static bool make_key(const flattener *f, size_t first, csg_figure_key *key)
{
    double tolerance = 0;
    for (size_t i = first; i < f->step_count; i++)
        if (is_curved(f, node_at(f, f->steps[i].node)))
            tolerance = f->steps[first].tolerance;
    bool ok = csg_figure_key_numbers(key, &tolerance, 1);
    for (size_t i = first; i < f->step_count && key->is_known && ok; i++)
        ok = add_to_key(f, node_at(f, f->steps[i].node), key);
    return ok;
}

/* The steps from `first` up to, not with, `end`, the last one first. */
static csgm_status make_steps(flattener *f, size_t first, size_t end)
{
    csgm_status status = CSGM_OK;
    for (size_t i = end; i-- > first && !status;)
        status = csg_memory_has_ended(f->memory) ? CSGM_ERR_MEMORY : make(f, f->steps[i]);
    return status;
}

/* What was made before, as if the steps had been made. */
static csgm_status take_known(flattener *f, const csg_outline *known)
{
    void *done = f->done;
    if (!csg_memory_reserve(f->memory, &done, &f->done_capacity, f->done_count + 1,
                            sizeof *f->done))
        return CSGM_ERR_MEMORY;
    f->done = done;
    csg_outline_init(&f->done[f->done_count], f->memory);
    return csg_outline_append(&f->done[f->done_count++], known) ? CSGM_OK : CSGM_ERR_MEMORY;
}

/* The outline is the only one on the stack. Transforms around a figure are no part of what is
 * looked for: the same figure in many places and sizes is made once. */
static csgm_status flatten_tree(flattener *f, csg_node_id root, double tolerance)
{
    size_t lead = 0;
    csg_figure_key key;
    csg_figure_key_init(&key, f->memory);
    if (!plan(f, root, tolerance))
        return CSGM_ERR_MEMORY;
    while (node_at(f, f->steps[lead].node)->kind == CSG_NODE_TRANSFORM ||
           node_at(f, f->steps[lead].node)->kind == CSG_NODE_COLOR)
        lead++;
    key.is_known = f->step_count - lead > 1; /* a leaf costs no more than finding it */
    csgm_status status = make_key(f, lead, &key) ? CSGM_OK : CSGM_ERR_MEMORY;
    const csg_outline *known =
        status == CSGM_OK ? csg_figures_find(f->builder->figures, &key) : NULL;
    if (known)
        status = take_known(f, known);
    else if (status == CSGM_OK)
        status = make_steps(f, lead, f->step_count);
    if (status == CSGM_OK && !known && !csg_figures_keep(&f->builder->figures, &key, &f->done[0]))
        status = CSGM_ERR_MEMORY;
    csg_figure_key_release(&key);
    return status == CSGM_OK ? make_steps(f, 0, lead) : status;
}

csgm_status csg_flatten(csg_scene_builder *builder, csg_node_id flat, double tolerance,
                        csg_outline *out)
{
    flattener f = {.builder = builder, .memory = &builder->context->memory};
    csg_outline_init(out, f.memory);
    if (flat >= builder->scene->node_count)
        return CSGM_ERR_SCENE;
    bool is_empty = builder->scene->nodes[flat].kind == CSG_NODE_EMPTY;
    if (!is_empty && !csg_build_is_flat(builder, flat))
        return CSGM_ERR_SCENE;
    csgm_status status = flatten_tree(&f, flat, tolerance);
    if (!status)
        *out = f.done[--f.done_count];
    while (f.done_count)
        csg_outline_release(&f.done[--f.done_count]);
    csg_memory_release(f.memory, f.done, f.done_capacity * sizeof *f.done);
    csg_memory_release(f.memory, f.steps, f.step_capacity * sizeof *f.steps);
    csg_memory_release(f.memory, f.waiting, f.waiting_capacity * sizeof *f.waiting);
    return status;
}
