/* SPDX-License-Identifier: MIT
 * Evaluates a lazy tree at a point: from the root down with an explicit stack, one frame for each
 * node that is being evaluated. A frame asks for its operands one by one, the one with the largest
 * bound first, leaves out those that cannot matter any more, and is then computed by the reference
 * (operators.md 3.4; the algorithms of the paper are the case of two operands).
 */
#include "scene/lazy/lazy.h"

#include "scene/lazy/lazy_private.h"
#include "scene/operators/blend_kinds.h"

/* A value at or below the floor may come out as any other such value, and one at or above the
 * ceiling too: whoever asked cannot see a difference. */
typedef struct demand {
    double floor, ceiling;
} demand;

typedef struct frame {
    csg_vec3 at, inner; /* where it is asked, where it asks its children */
    double bound;       /* no value of the node is larger */
    double bounds[2];   /* the same of its first two operands; NAN: not looked at yet */
    demand seen;        /* of the value */
    demand united;      /* the same of an operator's union (operand_sign) */
    double best;        /* largest operand of that union so far */
    size_t slot;        /* of its first operand's sample */
    csg_node_id node;
    uint32_t first;     /* the operand that was asked first */
    uint32_t asked;     /* the one that is being evaluated */
    uint32_t next;      /* the one to look at now */
    uint32_t evaluated; /* how many were */
} frame;

typedef struct evaluation {
    const csg_lazy *lazy;
    frame *frames;
    csg_sample *samples;
    csg_reference_work work;
    size_t depth;
} evaluation;

csg_lazy_options csg_lazy_options_default(double band)
{
    return (csg_lazy_options){true, CSG_LAZY_EXACT, band, true};
}

/* ---- creation ------------------------------------------------------------------------------ */

/* Rules of lengths leave their results as they are outside their support, too. */
static double support_of(const csgm_scene *tree, const csg_node *node)
{
    bool operates = csg_node_is_operator(node->kind);
    bool ends =
        operates && (node->blend == CSG_BLEND_EXTERIOR || node->blend == CSG_BLEND_INTERIOR);
    return ends || csg_lazy_is_plain(node) ? csg_scene_support(tree, node) : NAN;
}

static csgm_status measure(csg_lazy *lazy)
{
    const csgm_scene *tree = &lazy->tree;
    csg_arena scratch;
    csg_arena_init(&scratch, &lazy->context->memory);
    size_t *depths = csg_arena_calloc(&scratch, tree->node_count, sizeof *depths);
    size_t *slots = csg_arena_calloc(&scratch, tree->node_count, sizeof *slots);
    bool ok = depths && slots;
    for (size_t i = 0; ok && i < tree->node_count; i++) {
        const csg_node *node = &tree->nodes[i];
        for (uint32_t k = 0; k < node->child_count; k++) {
            csg_node_id child = csg_scene_children(tree, node)[k];
            depths[i] = depths[child] > depths[i] ? depths[child] : depths[i];
            slots[i] = slots[child] > slots[i] ? slots[child] : slots[i];
        }
        depths[i] += 1;
        slots[i] += node->child_count;
        lazy->operands = node->child_count > lazy->operands ? node->child_count : lazy->operands;
        lazy->supports[i] = support_of(tree, node);
    }
    for (size_t i = 0; i < tree->formula_count; i++)
        lazy->steps = tree->formulas[i].count > lazy->steps ? tree->formulas[i].count : lazy->steps;
    lazy->depth = ok ? depths[tree->root] : 0;
    lazy->slots = ok ? slots[tree->root] : 0;
    csg_arena_reset(&scratch);
    return ok ? CSGM_OK : CSGM_ERR_MEMORY;
}

static csgm_status fill(csg_lazy *lazy, const csgm_scene *scene, const csg_lazy_options *options)
{
    csgm_status status = csg_lazy_grow_tree(lazy, scene);
    if (status != CSGM_OK)
        return status;
    size_t nodes = lazy->tree.node_count;
    lazy->bounds = csg_arena_calloc(&lazy->arena, nodes, sizeof *lazy->bounds);
    lazy->supports = csg_arena_calloc(&lazy->arena, nodes, sizeof *lazy->supports);
    if (!lazy->bounds || !lazy->supports)
        return CSGM_ERR_MEMORY;
    status = csg_lazy_find_bounds(lazy, options);
    if (status == CSGM_OK)
        status = measure(lazy);
    if (status != CSGM_OK)
        return status;
    lazy->identity = csg_arena_calloc(&lazy->arena, lazy->operands, sizeof *lazy->identity);
    if (!lazy->identity)
        return CSGM_ERR_MEMORY;
    for (size_t k = 0; k < lazy->operands; k++)
        lazy->identity[k] = (csg_node_id)k;
    return CSGM_OK;
}

csgm_status csg_lazy_create(const csgm_scene *scene, const csg_lazy_options *options,
                            csg_lazy **out)
{
    csgm_context *context = scene->context;
    csg_lazy *lazy = csg_memory_alloc(&context->memory, sizeof *lazy);
    if (!lazy)
        return csg_context_no_memory(context);
    *lazy = (csg_lazy){
        .context = context, .lazy = options->lazy, .demand = options->lazy && options->demand};
    lazy->lipschitz = csg_scene_lipschitz(scene);
    csg_arena_init(&lazy->arena, &context->memory);
    csgm_status status = fill(lazy, scene, options);
    if (status == CSGM_OK) {
        *out = lazy;
        return CSGM_OK;
    }
    csg_lazy_destroy(lazy);
    return status == CSGM_ERR_MEMORY ? csg_context_no_memory(context) : status;
}

void csg_lazy_destroy(csg_lazy *lazy)
{
    if (!lazy)
        return;
    csg_memory *memory = &lazy->context->memory;
    csg_arena_reset(&lazy->arena);
    csg_memory_release(memory, lazy, sizeof *lazy);
}

/* ---- facts --------------------------------------------------------------------------------- */

/* What a node counts when that many of its operands were evaluated. */
static uint32_t weight(const csg_node *node, uint32_t evaluated)
{
    if (node->kind == CSG_NODE_COMBINE || csg_node_is_operator(node->kind))
        return evaluated > 2 ? evaluated - 1 : 1;
    return node->child_count == 0;
}

uint64_t csg_lazy_node_count(const csg_lazy *lazy)
{
    uint64_t count = 0;
    for (size_t i = 0; i < lazy->tree.node_count; i++)
        count += weight(&lazy->tree.nodes[i], lazy->tree.nodes[i].child_count);
    return count;
}

double csg_lazy_lipschitz(const csg_lazy *lazy)
{
    return lazy->lipschitz;
}

size_t csg_lazy_scratch_bytes(const csg_lazy *lazy)
{
    return lazy->depth * sizeof(frame) + lazy->slots * sizeof(csg_sample) +
           2 * lazy->operands * sizeof(double) + lazy->steps * sizeof(csg_formula_dual);
}

static evaluation begin(const csg_lazy *lazy, void *scratch)
{
    evaluation e = {.lazy = lazy, .frames = scratch};
    e.samples = (csg_sample *)(e.frames + lazy->depth);
    e.work.values = (double *)(e.samples + lazy->slots);
    e.work.partials = e.work.values + lazy->operands;
    e.work.steps = (csg_formula_dual *)(e.work.partials + lazy->operands);
    return e;
}

/* ---- evaluation ---------------------------------------------------------------------------- */

static double bound_at(const csg_lazy *lazy, csg_node_id node, csg_vec3 p)
{
    const csg_lazy_bound *bound = &lazy->bounds[node];
    if (!bound->is_known)
        return INFINITY;
    return bound->lambda * csg_box_field(bound->box, p) - bound->below;
}

static double away(double x, double low, double high)
{
    return x < low ? low - x : x > high ? high - x : 0;
}

/* Of csg_box_field: towards the box outside, away from the nearest face inside. */
static csg_vec3 box_gradient(csg_box box, csg_vec3 p)
{
    csg_vec3 out = {away(p.x, box.min.x, box.max.x), away(p.y, box.min.y, box.max.y),
                    away(p.z, box.min.z, box.max.z)};
    if (csg_box_is_empty(box))
        return (csg_vec3){0, 0, 0};
    if (out.x != 0 || out.y != 0 || out.z != 0)
        return csg_vec3_normalize(out);
    const double distances[6] = {p.x - box.min.x, box.max.x - p.x, p.y - box.min.y,
                                 box.max.y - p.y, p.z - box.min.z, box.max.z - p.z};
    int nearest = 0;
    for (int i = 1; i < 6; i++)
        nearest = distances[i] < distances[nearest] ? i : nearest;
    double sign = nearest % 2 ? -1 : 1;
    return (csg_vec3){nearest / 2 == 0 ? sign : 0, nearest / 2 == 1 ? sign : 0,
                      nearest / 2 == 2 ? sign : 0};
}

/* An operator is the union of its operands with these signs, times the first sign (reference.c). */
static double operand_sign(const csg_node *node, uint32_t index)
{
    return node->kind == CSG_NODE_INTERSECTION || (node->kind == CSG_NODE_DIFFERENCE && index == 0)
               ? -1
               : 1;
}

static demand times_sign(demand d, double sign)
{
    return sign > 0 ? d : (demand){-d.ceiling, -d.floor};
}

static double below(double x)
{
    return nextafter(nextafter(x, -INFINITY), -INFINITY);
}

/* Of a child whose value v becomes scale * v + shift: rounded so that it asks for more rather than
 * less. */
static demand inner_demand(demand d, double scale, double shift)
{
    return (demand){below((d.floor - shift) / scale), -below(-(d.ceiling - shift) / scale)};
}

/* What operand number `index` is asked for: in a sharp union nothing up to the best so far or the
 * floor, in a blended one nothing that is outside the best's support, and nothing more once it is
 * above the ceiling, since a plain union is at least as large as its operands. */
static demand operand_demand(const csg_lazy *lazy, const frame *f, uint32_t index)
{
    const demand all = {-INFINITY, INFINITY};
    const csg_node *node = &lazy->tree.nodes[f->node];
    if (!lazy->demand)
        return all;
    if (node->kind == CSG_NODE_COLOR)
        return f->seen;
    if (node->kind == CSG_NODE_TRANSFORM)
        return inner_demand(f->seen, lazy->tree.scales[node->payload], 0);
    if (node->kind == CSG_NODE_WARP)
        return inner_demand(f->seen, csg_warp_scale(&lazy->tree.warps[node->payload]), 0);
    if (node->kind == CSG_NODE_OFFSET)
        return inner_demand(f->seen, 1, csg_scene_parameters(&lazy->tree, node)[0]);
    double support = lazy->supports[f->node];
    if (isnan(support))
        return all;
    demand d = {support > 0 ? below(f->best - support) : fmax(f->best, f->united.floor),
                f->united.ceiling};
    return times_sign(d, operand_sign(node, index));
}

static void enter(evaluation *e, csg_node_id id, csg_vec3 p, double bound, demand seen, size_t slot)
{
    const csgm_scene *tree = &e->lazy->tree;
    const csg_node *node = &tree->nodes[id];
    const demand all = {-INFINITY, INFINITY};
    e->frames[e->depth++] =
        (frame){.at = p,
                .inner = csg_reference_inner_point(tree, node, p),
                .bound = bound,
                .bounds = {NAN, NAN},
                .seen = seen,
                .united = csg_lazy_is_plain(node) ? times_sign(seen, operand_sign(node, 0)) : all,
                .best = -INFINITY,
                .slot = slot,
                .node = id,
                .first = UINT32_MAX,
                .asked = UINT32_MAX};
}

static double operand_bound(const csg_lazy *lazy, frame *f, uint32_t index)
{
    const csg_node_id *children = csg_scene_children(&lazy->tree, &lazy->tree.nodes[f->node]);
    if (index >= 2)
        return bound_at(lazy, children[index], f->inner);
    if (isnan(f->bounds[index]))
        f->bounds[index] = bound_at(lazy, children[index], f->inner);
    return f->bounds[index];
}

/* The operand most likely to decide: of a union the one with the largest bound, of an intersection
 * the smallest, of a difference the minuend. */
static uint32_t choose_first(const csg_lazy *lazy, frame *f, const csg_node *node)
{
    if (node->kind == CSG_NODE_DIFFERENCE)
        return 0;
    double sign = operand_sign(node, 0), most = -INFINITY;
    uint32_t first = 0;
    for (uint32_t k = 0; k < node->child_count; k++) {
        double bound = sign * operand_bound(lazy, f, k);
        if (bound > most)
            first = k;
        most = fmax(most, bound);
    }
    return first;
}

/* Whether operand number `index` can be left out, its value being `bound` or less. The first test
 * is the one that blends make on values: subtraction rounds monotonely, so no bit changes. */
static bool is_left_out(const csg_lazy *lazy, frame *f, uint32_t index, double bound)
{
    const csg_node *node = &lazy->tree.nodes[f->node];
    double support = lazy->supports[f->node];
    if (f->best >= f->united.ceiling && f->best > -INFINITY)
        return true;
    if (operand_sign(node, index) > 0)
        return f->best - bound >= support ||
               (support == 0 && f->united.floor > -INFINITY && bound <= f->united.floor);
    if (-bound >= f->united.ceiling) { /* it is above the ceiling: its bound will do for it */
        f->best = fmax(f->best, -bound);
        return true;
    }
    return false;
}

/* Stands for an operand that was left out: nothing of the union, or what is above its ceiling. */
static csg_sample left_out(const frame *f, const csg_node *node, uint32_t index, double bound)
{
    double sign = operand_sign(node, index);
    bool decides = sign < 0 && -bound >= f->united.ceiling;
    return (csg_sample){decides ? bound : -sign * INFINITY, {0, 0, 0}};
}

/* Enters the next operand that can matter; false when there is none. */
static bool ask_next(evaluation *e, frame *f)
{
    const csg_lazy *lazy = e->lazy;
    const csg_node *node = &lazy->tree.nodes[f->node];
    const csg_node_id *children = csg_scene_children(&lazy->tree, node);
    bool choosy = lazy->lazy && !isnan(lazy->supports[f->node]);
    bool begins = choosy && f->first == UINT32_MAX;
    if (begins)
        f->first = choose_first(lazy, f, node);
    while (begins || f->next < node->child_count) {
        uint32_t k = begins ? f->first : f->next++;
        if (k == f->first && !begins)
            continue;
        begins = false;
        double bound = operand_bound(lazy, f, k);
        if (choosy && is_left_out(lazy, f, k, bound)) {
            e->samples[f->slot + k] = left_out(f, node, k, bound);
            continue;
        }
        f->asked = k;
        enter(e, children[k], f->inner, bound, operand_demand(lazy, f, k),
              f->slot + node->child_count);
        return true;
    }
    return false;
}

static csg_sample sample_of(const evaluation *e, const frame *f)
{
    const csg_lazy *lazy = e->lazy;
    csg_sample out = csg_reference_node(&lazy->tree, &lazy->tree.nodes[f->node], f->at,
                                        e->samples + f->slot, lazy->identity, &e->work);
    if (f->bound < out.value) {
        const csg_lazy_bound *bound = &lazy->bounds[f->node];
        out.value = f->bound;
        out.gradient = csg_vec3_scale(box_gradient(bound->box, f->at), bound->lambda);
    }
    return out;
}

static void receive(evaluation *e, frame *f, csg_sample operand)
{
    double value = operand_sign(&e->lazy->tree.nodes[f->node], f->asked) * operand.value;
    f->best = value > f->best ? value : f->best;
    f->evaluated++;
    e->samples[f->slot + f->asked] = operand;
}

csg_sample csg_lazy_eval(const csg_lazy *lazy, csg_vec3 p, void *scratch, csg_lazy_counts *counts)
{
    evaluation e = begin(lazy, scratch);
    csg_node_id root = lazy->tree.root;
    uint64_t total = 0;
    csg_sample result = {NAN, {0, 0, 0}};
    enter(&e, root, p, bound_at(lazy, root, p), (demand){-INFINITY, INFINITY}, 0);
    while (e.depth) {
        frame *f = &e.frames[e.depth - 1];
        if (ask_next(&e, f))
            continue;
        total += weight(&lazy->tree.nodes[f->node], f->evaluated);
        result = sample_of(&e, f);
        if (--e.depth)
            receive(&e, &e.frames[e.depth - 1], result);
    }
    if (counts) {
        counts->top_level++;
        counts->total += total;
    }
    return result;
}
