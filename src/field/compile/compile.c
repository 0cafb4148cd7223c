/* SPDX-License-Identifier: MIT
 * Scene -> tape: a walk over the tree with an explicit stack that carries each node's frame down
 * (place, scale, sign, colour) and writes nodes in postorder.
 */
#include <string.h>

#include "base/elementary.h"
#include "field/compile/compile_curve.h"
#include "field/compile/compile_formula.h"
#include "field/compile/compile_private.h"
#include "field/kernels/dispatch.h"
#include "field/kernels/warp_kernel.h"
#include "field/rule_layout.h"
#include "scene/primitives/kinds.h"
#include "scene/primitives/point.h"

typedef csg_compile_frame frame;
typedef csg_compile_task task;
typedef csg_compiler compiler;

bool csg_compile_push(compiler *c, const float *values, size_t count, uint32_t *at)
{
    if (c->parameter_count + count > UINT32_MAX ||
        !csg_memory_reserve(&c->context->memory, (void **)&c->parameters, &c->parameter_capacity,
                            c->parameter_count + count, sizeof(float)))
        return false;
    *at = (uint32_t)c->parameter_count;
    memcpy(c->parameters + c->parameter_count, values, count * sizeof(float));
    c->parameter_count += count;
    return true;
}

static csg_tape_node *push_node(compiler *c)
{
    if (c->node_count >= UINT32_MAX ||
        !csg_memory_reserve(&c->context->memory, (void **)&c->nodes, &c->node_capacity,
                            c->node_count + 1, sizeof(csg_tape_node)))
        return NULL;
    csg_tape_node *node = &c->nodes[c->node_count++];
    memset(node, 0, sizeof *node);
    return node;
}

/* Colour and material of the solids in this frame get a number. */
static bool push_color(compiler *c, frame *f)
{
    size_t count = c->color_count, bytes = sizeof(csg_color);
    csg_memory *memory = &c->context->memory;
    /* Neighbouring solids mostly share one colour; an index must be exact in a float. */
    if (count && !memcmp(&c->colors[count - 1], &f->paint, bytes) &&
        !memcmp(&c->materials[count - 1], &f->material, bytes)) {
        f->color = (uint32_t)count - 1;
        return true;
    }
    if (count >= 1 << 24 ||
        !csg_memory_reserve(memory, (void **)&c->colors, &c->color_capacity, count + 1, bytes) ||
        !csg_memory_reserve(memory, (void **)&c->materials, &c->material_capacity, count + 1,
                            bytes))
        return false;
    f->color = (uint32_t)count;
    c->colors[count] = f->paint;
    c->materials[count] = f->material;
    c->color_count++;
    return true;
}

/* The outermost colour and the outermost material hold. */
static bool take_look(compiler *c, frame *f, const csg_look *look)
{
    bool paints = look->has_color && !f->colored, shades = look->has_material && !f->shaded;
    if (paints)
        f->paint = look->color;
    if (shades)
        f->material = (csg_color){look->metallic, look->roughness, 0, 0};
    f->colored |= paints;
    f->shaded |= shades;
    c->field->has_colors |= paints;
    c->field->has_materials |= shades;
    return (!paints && !shades) || push_color(c, f);
}

/* ---- leaves ------------------------------------------------------------------------------- */

csg_affine csg_compile_place(const compiler *c, const frame *f)
{
    csg_affine place = f->place;
    if (f->warp)
        return place;
    place.t[0] -= c->field->center.x;
    place.t[1] -= c->field->center.y;
    place.t[2] -= c->field->center.z;
    return place;
}

/* The formula's steps join the tape's, and the leaf names them. */
static bool take_formula(compiler *c, csg_leaf *l, const csg_formula *formula)
{
    csg_memory *memory = &c->context->memory;
    l->own[0] = (double)c->formula_count;
    l->own_count = 1;
    if (c->formula_count >= 1 << 24 || /* an index must be exact in a float */
        !csg_memory_reserve(memory, (void **)&c->formulas, &c->formula_capacity,
                            c->formula_count + 1, sizeof *c->formulas) ||
        !csg_formula_compile(memory, c->scene->steps, formula, &c->steps, &c->step_count,
                             &c->step_capacity, &c->formulas[c->formula_count]))
        return false;
    c->formula_count++;
    return true;
}

/* A formula has no sizes that could be scaled: its frame is the whole map. */
static bool place_field(compiler *c, csg_leaf *l, const frame *f, const csg_node *node)
{
    const csg_formula *formula = &c->scene->formulas[node->payload];
    csg_affine place = csg_compile_place(c, f);
    l->op = CSG_OP_FIELD;
    csg_leaf_place(l, &place);
    l->sigma = f->negate ? -f->factor : f->factor;
    /* How far a shift of the point by its rounding moves the value. */
    l->magnitude = formula->lipschitz * csg_vec3_norm(l->offset);
    return take_formula(c, l, formula);
}

static void place_shape(compiler *c, csg_leaf *l, const frame *f, const csg_node *node)
{
    csg_affine place = csg_compile_place(c, f);
    csg_box box = c->scene->shapes[node->payload]->box;
    double x = fmax(fabs(box.min.x), fabs(box.max.x)), y = fmax(fabs(box.min.y), fabs(box.max.y));
    double z = fmax(fabs(box.min.z), fabs(box.max.z));
    l->op = CSG_OP_SHAPE;
    csg_leaf_place(l, &place);
    l->sigma = f->negate ? -f->factor : f->factor;
    l->own[0] = node->payload;
    l->own_count = 1;
    l->magnitude =
        csg_hypot(csg_hypot(x, y), isfinite(z) ? z : 0) * f->factor + csg_vec3_norm(l->offset);
}

bool csg_compile_leaf(compiler *c, const csg_leaf *l, uint32_t color, uint32_t warp)
{
    float values[CSG_LEAF_MOST_PARAMETERS];
    size_t count = csg_leaf_pack(l, color, values);
    csg_tape_node *node = push_node(c);
    if (!node || !csg_compile_push(c, values, count, &node->parameters))
        return false;
    if (c->exact && node->parameters + count <= c->exact_count)
        csg_leaf_numbers(l, c->exact + node->parameters);
    node->op = l->op;
    node->frame = (uint8_t)l->frame;
    node->warp = warp;
    node->size = 1;
    return true;
}

/* Of a node that delivers: its first leaf's colour. */
static void take_color(compiler *c, const csg_tape_node *node, uint32_t begin)
{
    uint32_t delivery = node->parameters + (node->op == CSG_OP_SOFTEN ? 0 : CSG_RULE_DELIVER);
    c->parameters[delivery + CSG_DELIVER_COLOR] =
        c->parameters[c->nodes[begin].parameters + CSG_LEAF_COLOR];
}

/* Values written since node `begin` become what the operator above takes. */
static bool write_entry(compiler *c, const frame *f, uint32_t begin)
{
    float values[CSG_SOFTEN_PARAMETERS];
    csg_tape_curve curve = csg_soften_pack_operand(f->entry, f->entry_factor, values);
    csg_deliver_pack(f->form, false, 0, 0, values);
    csg_tape_node *node = push_node(c);
    if (!node || !csg_compile_push(c, values, CSG_SOFTEN_PARAMETERS, &node->parameters))
        return false;
    node->op = CSG_OP_SOFTEN;
    node->blend = (uint8_t)curve;
    node->arity = 1;
    node->size = (uint32_t)c->node_count - begin;
    take_color(c, node, begin);
    return true;
}

/* Whether operands of a sharp operator can be those of the one above: max of max, min of min. */
static bool is_alike(const compiler *c, const task *above, bool is_union)
{
    return above && csg_node_is_operator(c->scene->nodes[above->node].kind) &&
           csg_blend_is_sharp(above->blend.kind) && above->is_union == is_union;
}

/* The last node written completes a child of this operator. */
static void mark_join(compiler *c, task *group)
{
    csg_tape_node *node = &c->nodes[c->node_count - 1];
    bool at_once = group->combines || csg_blend_is_round(group->blend.kind) ||
                   csg_blend_is_fillet(group->blend.kind);
    if (group->written && !at_once) {
        node->join = group->is_union ? CSG_JOIN_UNION : CSG_JOIN_INTERSECTION;
        node->join_blend = (uint8_t)group->blend.kind;
        node->join_parameters = group->parameters;
    }
    if (csg_blend_is_fillet(group->blend.kind))
        node->join_parameters = csg_compile_reaches(c, group);
    bool is_end = group->written && c->scene->nodes[group->node].flags & CSG_FLAG_ENDED;
    node->is_plane |= is_end && c->scene->look_count > 0;
    group->written++;
}

static bool push_blend(compiler *c, task *t)
{
    if (csg_blend_is_fillet(t->blend.kind))
        return csg_compile_fillet(c, t);
    float values[CSG_OPERATOR_PARAMETERS] = {csg_blend_is_sharp(t->blend.kind) ? 1.0f
                                                                               : (float)t->blend.n,
                                             (float)csg_blend_support(t->blend)};
    if (csg_blend_is_orthogonal(t->blend.kind))
        values[CSG_OPERATOR_N] = (float)t->frame.raise;
    return csg_compile_push(c, values, CSG_OPERATOR_PARAMETERS, &t->parameters);
}

/* With its length as the scene says it, where that is asked for. */
static bool begin_blend(compiler *c, task *t)
{
    bool has_length = !csg_blend_is_sharp(t->blend.kind) && !csg_blend_is_orthogonal(t->blend.kind);
    if (!push_blend(c, t))
        return false;
    if (has_length && c->exact && t->parameters + CSG_OPERATOR_PARAMETERS <= c->exact_count)
        c->exact[t->parameters + CSG_OPERATOR_N] = t->blend.n;
    return true;
}

static uint8_t op_of(const task *t)
{
    if (t->combines)
        return CSG_OP_COMBINE;
    if (t->softens)
        return CSG_OP_SOFTEN;
    if (csg_blend_is_round(t->blend.kind))
        return t->is_union ? CSG_OP_ROUND_UNION : CSG_OP_ROUND_INTERSECTION;
    if (csg_blend_is_fillet(t->blend.kind))
        return t->is_union ? CSG_OP_FILLET_UNION : CSG_OP_FILLET_INTERSECTION;
    if (csg_blend_takes_fields(t->blend.kind))
        return t->is_union ? CSG_OP_RULE_UNION : CSG_OP_RULE_INTERSECTION;
    return t->is_union ? CSG_OP_UNION : CSG_OP_INTERSECTION;
}

/* After its operands. */
static bool write_operator(compiler *c, const task *t)
{
    uint32_t planes = 0;
    if (csg_blend_is_fillet(t->blend.kind) && !csg_compile_planes(c, t, &planes))
        return false;
    csg_tape_node *node = push_node(c);
    if (!node)
        return false;
    node->op = op_of(t);
    if (t->combines)
        node->frame = CSG_FRAME_AFFINE;
    node->blend = (uint8_t)(t->softens ? (int)t->curve : (int)t->blend.kind);
    node->parameters = t->parameters;
    node->arity = t->written + planes;
    node->planes = (uint16_t)planes;
    node->size = (uint32_t)c->node_count - t->begin;
    return true;
}

static bool write_curve(compiler *c, const csg_node *node, const frame *f, task *above)
{
    csg_curve curve = csg_curve_make(node->kind, csg_scene_parameters(c->scene, node));
    csg_curve pieces[CSG_CURVE_MOST_PIECES];
    csg_affine place = csg_compile_place(c, f);
    size_t count = csg_curve_cut(&curve, pieces);
    bool alike = count == 1 || (f->form == CSG_FORM_VALUE && is_alike(c, above, !f->negate));
    task own = {.begin = (uint32_t)c->node_count, .is_union = !f->negate};
    if (!alike && !begin_blend(c, &own))
        return false;
    for (size_t i = 0; i < count; i++) {
        csg_leaf l = {.raise = f->raise};
        csg_leaf_primitive(&l, &place, f->factor, f->negate, node->kind, pieces[i].at[0]);
        l.magnitude += f->magnitude;
        if (!csg_compile_leaf(c, &l, f->color, f->warp))
            return false;
        if (!alike || i + 1 < count)
            mark_join(c, alike ? above : &own);
    }
    return alike || write_operator(c, &own);
}

static bool compile_leaf(compiler *c, const csg_node *node, const frame *f, task *above)
{
    uint32_t begin = (uint32_t)c->node_count;
    csg_leaf l = {.op = CSG_OP_EMPTY, .sigma = f->negate ? -1 : 1};
    if (node->kind == CSG_NODE_FIELD) {
        if (!place_field(c, &l, f, node))
            return false;
    } else if (node->kind == CSG_NODE_SHAPE) {
        place_shape(c, &l, f, node);
    } else if (node->kind != CSG_NODE_EMPTY && !csg_node_is_curve(node->kind)) {
        csg_affine place = csg_compile_place(c, f);
        csg_leaf_primitive(&l, &place, f->factor, f->negate, node->kind,
                           csg_scene_parameters(c->scene, node));
    }
    l.magnitude += f->magnitude;
    l.raise = f->raise;
    bool done = csg_node_is_curve(node->kind) ? write_curve(c, node, f, above)
                                              : csg_compile_leaf(c, &l, f->color, f->warp);
    return done && (f->form == CSG_FORM_VALUE || write_entry(c, f, begin));
}

/* ---- operators ------------------------------------------------------------------------------ */

/* Whether children join it: an operator, fields combined by a formula, a soft node. */
static bool is_group(const compiler *c, const task *t)
{
    return t->combines || t->softens || csg_node_is_operator(c->scene->nodes[t->node].kind);
}

/* The parameters of an expression field over the operands' values: they come times the factor of
 * the frame, and so must the result. */
static bool push_combination(compiler *c, const csg_node *node, const frame *f, uint32_t *at)
{
    const csg_formula *formula = &c->scene->formulas[node->payload];
    csg_leaf l = {.op = CSG_OP_COMBINE, .frame = CSG_FRAME_AFFINE, .raise = f->raise};
    l.to_own = csg_affine_scale(csg_vec3_make(1 / f->factor, 1 / f->factor, 1 / f->factor));
    l.sigma = (f->negate ? -f->factor : f->factor) / formula->lipschitz;
    float values[CSG_LEAF_MOST_PARAMETERS];
    if (!take_formula(c, &l, formula))
        return false;
    return csg_compile_push(c, values, csg_leaf_pack(&l, 0, values), at);
}

/* Whether the node gives a field to an operator that takes one, or takes values for one. */
static bool delivers_field(const csg_node *node)
{
    bool takes = csg_node_is_operator(node->kind) && csg_blend_takes_fields(node->blend);
    return takes || node->kind == CSG_NODE_SOFT;
}

/* The form in which a node that has a field hands it up. */
static csg_form form_of(const frame *f)
{
    return f->is_raised ? CSG_FORM_VALUE : f->form;
}

/* As a value: F - 1/2 over lambda, with the frame's factor and sign. */
static void pack_delivery(const compiler *c, const task *t, bool flip, float *values)
{
    double scale = t->frame.factor / csg_scene_softness(c->scene, t->node);
    csg_deliver_pack(form_of(&t->frame), flip, t->frame.negate ? -scale : scale, t->frame.raise,
                     values);
}

static bool begin_soft(compiler *c, const csg_node *node, task *t)
{
    const double *p = csg_scene_parameters(c->scene, node);
    float values[CSG_SOFTEN_PARAMETERS];
    t->softens = true;
    csg_soft soft = {.range = p[0], .falloff = (csg_falloff)p[1]};
    t->curve = csg_soften_pack_soft(soft, t->frame.factor, values);
    pack_delivery(c, t, false, values);
    return csg_compile_push(c, values, CSG_SOFTEN_PARAMETERS, &t->parameters);
}

static bool begin_rule(compiler *c, const csg_node *node, const csg_rule *rule, task *t)
{
    float values[CSG_RULE_MOST_PARAMETERS] = {0};
    double support = csg_scene_support(c->scene, node);
    bool takes_fields = csg_blend_takes_fields(rule->kind);
    if (takes_fields) /* its value is negated, not its operands */
        t->is_union = node->kind == CSG_NODE_UNION;
    size_t count =
        csg_rule_pack(rule, t->is_union, t->frame.factor, support, &t->blend.kind, values);
    c->field->tape.turns |= csg_blend_turns(t->blend.kind);
    if (takes_fields)
        pack_delivery(c, t, csg_rule_works_on_complements(rule->kind, t->is_union),
                      values + CSG_RULE_DELIVER);
    return csg_compile_push(c, values, count, &t->parameters);
}

/* outer: the group that the operator stands in, or NULL. */
static bool begin_operator(compiler *c, const csg_node *node, uint32_t outer, task *t)
{
    const csg_rule *rule = csg_scene_rule(c->scene, node);
    t->is_union = (node->kind == CSG_NODE_UNION) != t->frame.negate;
    t->blend = csg_blend_scale(csg_scene_blend(c->scene, node), t->frame.factor);
    if (rule)
        return begin_rule(c, node, rule, t);
    const task *above = outer != UINT32_MAX ? &c->tasks[outer] : NULL;
    bool is_nested = csg_blend_is_sharp(t->blend.kind) && !(node->flags & CSG_FLAG_ENDED) &&
                     is_alike(c, above, t->is_union);
    if (is_nested) {
        t->group = outer; /* max of max, min of min: one operator */
        return true;
    }
    return begin_blend(c, t);
}

static bool begin_task(compiler *c, csg_node_id id, const frame *f)
{
    if (!csg_memory_reserve(&c->context->memory, (void **)&c->tasks, &c->task_capacity,
                            c->task_count + 1, sizeof(task)))
        return false;
    const csg_node *node = &c->scene->nodes[id];
    uint32_t index = (uint32_t)c->task_count,
             outer = index ? c->tasks[index - 1].group : UINT32_MAX;
    task t = {.node = id, .frame = *f, .group = index, .begin = (uint32_t)c->node_count};
    if (csg_node_is_operator(node->kind)) {
        if (!begin_operator(c, node, outer, &t))
            return false;
    } else if (node->kind == CSG_NODE_SOFT) {
        if (!begin_soft(c, node, &t))
            return false;
    } else if (node->kind == CSG_NODE_COMBINE) {
        t.combines = true;
        if (!push_combination(c, node, f, &t.parameters))
            return false;
    } else {
        /* transforms, colours, offsets, warps: their child joins in their place */
        t.group = index ? outer : index;
    }
    c->tasks[c->task_count++] = t;
    return true;
}

static void join_child(compiler *c, task *group)
{
    if (!is_group(c, group))
        return; /* nothing above but nodes of one child */
    mark_join(c, group);
}

static bool end_task(compiler *c)
{
    uint32_t index = (uint32_t)--c->task_count;
    task t = c->tasks[index];
    if (t.group != index || !is_group(c, &t))
        return true;
    if (!write_operator(c, &t))
        return false;
    const csg_tape_node *node = &c->nodes[c->node_count - 1];
    if (csg_op_delivers(node->op))
        take_color(c, node, t.begin);
    bool is_field = delivers_field(&c->scene->nodes[t.node]) && !t.frame.is_raised;
    if (t.frame.form != CSG_FORM_VALUE && !is_field && !write_entry(c, &t.frame, t.begin))
        return false;
    if (index)
        join_child(c, &c->tasks[c->tasks[index - 1].group]);
    return true;
}

/* The frame of an operand of an operator that takes fields: signs and offsets end there. */
static void operand_frame(const compiler *c, const task *t, const csg_node *node, frame *f)
{
    uint32_t index = t->next_child;
    bool is_complement = csg_rule_works_on_complements(node->blend, t->is_union) !=
                         (node->kind == CSG_NODE_DIFFERENCE && index > 0);
    f->negate = f->is_raised = false;
    f->raise = 0;
    f->form = is_complement ? CSG_FORM_COMPLEMENT : CSG_FORM_FIELD;
    f->entry = csg_scene_operand(c->scene, node, index);
    f->entry_factor = f->factor;
}

/* The frame below a warp. */
static bool warp_frame(compiler *c, const csg_warp *warp, frame *f)
{
    csg_affine place = csg_compile_place(c, f), to_own;
    csg_tape_warp made = {.outer = f->warp, .kind = warp->kind};
    csg_affine_invert(place, &to_own); /* build.h admits only invertible maps */
    for (int i = 0; i < 9; i++)
        made.frame[i] = (float)to_own.m[i / 3][i % 3];
    for (int i = 0; i < 3; i++)
        made.frame[9 + i] = (float)to_own.t[i];
    csg_warp_pack(warp, made.own);
    csg_box bounds = c->field->bounds;
    double extent = csg_box_is_finite(bounds) ? csg_vec3_norm(csg_box_size(bounds)) : 0;
    f->magnitude += csg_warp_magnitude(warp, extent) * f->factor;
    if (c->warp_count >= UINT32_MAX - 1 ||
        !csg_memory_reserve(&c->context->memory, (void **)&c->warps, &c->warp_capacity,
                            c->warp_count + 1, sizeof *c->warps))
        return false;
    c->warps[c->warp_count++] = made;
    f->place = csg_affine_identity();
    f->factor *= csg_warp_scale(warp);
    f->warp = (uint32_t)c->warp_count;
    return true;
}

/* The frame of the child about to be visited. */
static bool child_frame(compiler *c, const task *t, frame *f)
{
    const csg_node *node = &c->scene->nodes[t->node];
    *f = t->frame;
    if (node->kind == CSG_NODE_TRANSFORM) {
        const csg_affine *matrix = &c->scene->transforms[node->payload];
        double smallest, largest;
        csg_affine_singular_values(matrix, &smallest, &largest);
        f->place = csg_affine_multiply(t->frame.place, *matrix);
        f->factor *= smallest;
    } else if (node->kind == CSG_NODE_COLOR) {
        return take_look(c, f, &c->scene->looks[node->payload]);
    } else if (node->kind == CSG_NODE_OFFSET) {
        f->raise += (f->negate ? -f->factor : f->factor) * csg_scene_parameters(c->scene, node)[0];
        f->is_raised = true;
    } else if (node->kind == CSG_NODE_COMBINE || node->kind == CSG_NODE_SOFT) {
        f->negate = false;
        f->raise = 0;
        f->form = CSG_FORM_VALUE;
    } else if (node->kind == CSG_NODE_WARP) {
        return warp_frame(c, &c->scene->warps[node->payload], f);
    } else if (csg_node_is_operator(node->kind)) {
        f->form = CSG_FORM_VALUE;
        if (csg_blend_takes_fields(node->blend))
            operand_frame(c, t, node, f);
        else if (node->kind == CSG_NODE_DIFFERENCE && t->next_child > 0)
            f->negate = !f->negate;
    }
    return true;
}

/* Solids without a colour or material of their own, next to others. */
const csg_color csg_default_color = {0.78f, 0.78f, 0.8f, 1.0f};
const csg_color csg_default_material = {0.0f, 0.6f, 0.0f, 0.0f};

static bool compile_tree(compiler *c)
{
    frame outermost = {.place = csg_affine_identity(),
                       .factor = 1,
                       .paint = csg_default_color,
                       .material = csg_default_material};
    const csg_node *root = &c->scene->nodes[c->scene->root];
    if (!push_color(c, &outermost))
        return false;
    if (!root->child_count)
        return compile_leaf(c, root, &outermost, NULL);
    if (!begin_task(c, c->scene->root, &outermost))
        return false;
    while (c->task_count) {
        task *t = &c->tasks[c->task_count - 1];
        const csg_node *node = &c->scene->nodes[t->node];
        if (t->next_child == node->child_count) {
            if (!end_task(c))
                return false;
            continue;
        }
        frame f;
        if (!child_frame(c, t, &f))
            return false;
        csg_node_id child = csg_scene_children(c->scene, node)[t->next_child++];
        if (c->scene->nodes[child].child_count) {
            if (!begin_task(c, child, &f))
                return false;
        } else {
            if (!compile_leaf(c, &c->scene->nodes[child], &f, &c->tasks[t->group]))
                return false;
            join_child(c, &c->tasks[t->group]);
        }
    }
    return true;
}

/* ---- the field --------------------------------------------------------------------------------
 */

/* Meets all that is written so far with a box around the field's centre. */
static bool write_clip(compiler *c, csg_box box)
{
    csg_vec3 half = csg_vec3_scale(csg_box_size(box), 0.5);
    const csg_affine centre = csg_affine_identity();
    csg_leaf l = {0};
    csg_leaf_primitive(&l, &centre, 1, false, CSG_NODE_BOX, (double[]){half.x, half.y, half.z, 0});
    const float sharp[CSG_OPERATOR_PARAMETERS] = {[CSG_OPERATOR_N] = 1};
    uint32_t parameters;
    if (!csg_compile_push(c, sharp, CSG_OPERATOR_PARAMETERS, &parameters) ||
        !csg_compile_leaf(c, &l, 0, 0))
        return false;
    csg_tape_node *node = &c->nodes[c->node_count - 1];
    node->join = CSG_JOIN_INTERSECTION;
    node->join_parameters = parameters;
    node = push_node(c);
    if (!node)
        return false;
    node->op = CSG_OP_INTERSECTION;
    node->parameters = parameters;
    node->arity = 2;
    node->size = (uint32_t)c->node_count;
    return true;
}

static bool compile_field(compiler *c, const csg_box *clip)
{
    csgm_field *field = c->field;
    const csgm_scene *scene = c->scene;
    field->scene = scene;
    field->bounds = scene->bounds[scene->root];
    if (clip)
        field->bounds = csg_box_intersect(field->bounds, *clip);
    field->center = csg_field_center(clip ? *clip : field->bounds);
    csg_field_count(scene, field);
    field->tape.lipschitz = (float)csg_scene_lipschitz(scene);
    if (clip)
        field->tape.lipschitz = fmaxf(field->tape.lipschitz, 1);
    return compile_tree(c) && (!clip || write_clip(c, *clip)) && csg_compile_keep(c) &&
           csg_compile_waver(&c->context->memory, &field->tape);
}

static void release(compiler *c)
{
    csg_memory *memory = &c->context->memory;
    csg_memory_release(memory, c->nodes, c->node_capacity * sizeof *c->nodes);
    csg_memory_release(memory, c->parameters, c->parameter_capacity * sizeof *c->parameters);
    csg_memory_release(memory, c->colors, c->color_capacity * sizeof *c->colors);
    csg_memory_release(memory, c->materials, c->material_capacity * sizeof *c->materials);
    csg_memory_release(memory, c->tasks, c->task_capacity * sizeof *c->tasks);
    csg_memory_release(memory, c->steps, c->step_capacity * sizeof *c->steps);
    csg_memory_release(memory, c->formulas, c->formula_capacity * sizeof *c->formulas);
    csg_memory_release(memory, c->warps, c->warp_capacity * sizeof *c->warps);
}

static csgm_status compile(csgm_context *context, const csgm_scene *scene, const csg_box *clip,
                           csgm_field **out)
{
    compiler c = {.context = context, .scene = scene, .field = csg_field_create(context)};
    bool done = c.field && compile_field(&c, clip);
    release(&c);
    if (!done) {
        csg_field_destroy(c.field);
        return csg_context_no_memory(context);
    }
    *out = c.field;
    return CSGM_OK;
}

/* The field is compiled once more, into one that is forgotten. */
bool csg_field_exact(csgm_context *context, const csgm_field *field, csg_arena *arena,
                     csg_tape_exact *out)
{
    size_t count = field->parameter_count;
    double *exact = csg_arena_alloc(arena, (count + 1) * sizeof *exact);
    compiler c = {.context = context,
                  .scene = field->scene,
                  .field = csg_field_create(context),
                  .exact = exact,
                  .exact_count = count};
    *out = (csg_tape_exact){NULL};
    for (size_t i = 0; exact && i < count; i++)
        exact[i] = (double)field->tape.parameters[i];
    bool done = exact && c.field && compile_field(&c, NULL);
    bool is_same = done && c.parameter_count == count &&
                   !memcmp(c.parameters, field->tape.parameters, count * sizeof *c.parameters);
    if (is_same) /* not a part of the scene, or one that was cut */
        out->parameters = exact;
    release(&c);
    if (c.field)
        csg_field_destroy(c.field);
    return done;
}

csgm_status csg_field_compile(csgm_context *context, const csgm_scene *scene, csgm_field **out)
{
    return compile(context, scene, NULL, out);
}

csgm_status csg_field_clip(csgm_context *context, const csgm_field *field, csg_box box,
                           csgm_field **out)
{
    return compile(context, field->scene, &box, out);
}
