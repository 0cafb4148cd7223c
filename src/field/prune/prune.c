/* SPDX-License-Identifier: MIT
 * Intervals, demands and shorter tapes; see prune.h.
 */
#include "field/prune/prune.h"

#include <math.h>
#include <string.h>

#include "field/gradients/cone_fillet.h"
#include "field/prune/prune_fields.h"
#include "field/prune/prune_shapes.h"
#include "field/same_leaf.h"
#include "scene/operators/blend_kinds.h"

void csg_pruner_init(csg_pruner *pruner, csg_memory *memory, const csg_kernel *kernel,
                     float rounding)
{
    *pruner = (csg_pruner){.memory = memory, .kernel = kernel, .rounding = rounding};
}

static void release_arrays(csg_pruner *pruner)
{
    size_t n = pruner->capacity;
    csg_memory_release(pruner->memory, pruner->low, n * CSG_OCTANTS * sizeof(float));
    csg_memory_release(pruner->memory, pruner->high, n * CSG_OCTANTS * sizeof(float));
    csg_memory_release(pruner->memory, pruner->turns, n * 2 * CSG_OCTANTS * sizeof(float));
    csg_memory_release(pruner->memory, pruner->dropped, n);
    csg_memory_release(pruner->memory, pruner->stack, n * sizeof(csg_emitted));
    csg_memory_release(pruner->memory, pruner->nodes, n * sizeof(csg_tape_node));
    pruner->low = pruner->high = pruner->turns = NULL;
    pruner->dropped = NULL;
    pruner->stack = NULL;
    pruner->nodes = NULL;
    pruner->capacity = 0;
}

void csg_pruner_release(csg_pruner *pruner)
{
    release_arrays(pruner);
    csg_memory_release(pruner->memory, pruner->scratch, pruner->scratch_capacity * sizeof(float));
    pruner->scratch = NULL;
    pruner->scratch_capacity = 0;
}

static bool make_room(csg_pruner *pruner, const csg_tape *tape)
{
    size_t scratch = csg_kernel_scratch_floats(csg_tape_depth(tape));
    if (!csg_memory_reserve(pruner->memory, (void **)&pruner->scratch, &pruner->scratch_capacity,
                            scratch, sizeof(float)))
        return false;
    size_t n = tape->count;
    if (n <= pruner->capacity && (pruner->turns || !tape->turns))
        return true;
    n = n > pruner->capacity ? n : pruner->capacity;
    release_arrays(pruner);
    pruner->capacity = n;
    pruner->low = csg_memory_alloc(pruner->memory, n * CSG_OCTANTS * sizeof(float));
    pruner->high = csg_memory_alloc(pruner->memory, n * CSG_OCTANTS * sizeof(float));
    if (tape->turns) /* no other tape needs them */
        pruner->turns = csg_memory_alloc(pruner->memory, n * 2 * CSG_OCTANTS * sizeof(float));
    pruner->dropped = csg_memory_alloc(pruner->memory, n);
    pruner->stack = csg_memory_alloc(pruner->memory, n * sizeof(csg_emitted));
    pruner->nodes = csg_memory_alloc(pruner->memory, n * sizeof(csg_tape_node));
    if (pruner->low && pruner->high && pruner->dropped && pruner->stack && pruner->nodes &&
        (pruner->turns || !tape->turns))
        return true;
    release_arrays(pruner);
    return false;
}

/* How far the operands of each fillet turn from each other in each cube. */
static void find_turns(csg_pruner *pruner, const float cx[CSG_OCTANTS], const float cy[CSG_OCTANTS],
                       const float cz[CSG_OCTANTS], float radius)
{
    const csg_tape *tape = pruner->tape;
    for (uint32_t i = 0; i < tape->count; i++)
        for (int o = 0; o < CSG_OCTANTS && csg_op_is_fillet(tape->nodes[i].op); o++) {
            csg_fillet_turns turns = csg_fillet_find_turns(
                tape, &tape->nodes[i], (const float[]){cx[o], cy[o], cz[o]}, (double)radius);
            float *out = pruner->turns + ((size_t)i * CSG_OCTANTS + (size_t)o) * 2;
            out[0] = turns.least;
            out[1] = turns.most;
        }
}

bool csg_prune_octants(csg_pruner *pruner, const csg_tape *tape, const float cx[CSG_OCTANTS],
                       const float cy[CSG_OCTANTS], const float cz[CSG_OCTANTS], float radius)
{
    if (!make_room(pruner, tape))
        return false;
    pruner->tape = tape;
    pruner->decided = false;
    memcpy(pruner->center[0], cx, sizeof pruner->center[0]);
    memcpy(pruner->center[1], cy, sizeof pruner->center[1]);
    memcpy(pruner->center[2], cz, sizeof pruner->center[2]);
    pruner->radius = radius + pruner->rounding;
    pruner->slack = pruner->rounding * tape->steepest;
    if (tape->turns)
        find_turns(pruner, cx, cy, cz, pruner->radius);
    pruner->kernel->intervals(tape, cx, cy, cz, pruner->radius, tape->turns ? pruner->turns : NULL,
                              pruner->low, pruner->high, pruner->scratch);
    return true;
}

bool csg_prune_cube(csg_pruner *pruner, const csg_tape *tape, const float center[3], float radius)
{
    float c[3][CSG_OCTANTS]; /* all eight alike */
    for (int axis = 0; axis < 3; axis++)
        for (int octant = 0; octant < CSG_OCTANTS; octant++)
            c[axis][octant] = center[axis];
    return csg_prune_octants(pruner, tape, c[0], c[1], c[2], radius);
}

static float low_of(const csg_pruner *pruner, uint32_t node, int octant)
{
    return pruner->low[(size_t)node * CSG_OCTANTS + (size_t)octant];
}

static float high_of(const csg_pruner *pruner, uint32_t node, int octant)
{
    return pruner->high[(size_t)node * CSG_OCTANTS + (size_t)octant];
}

csg_cell_state csg_prune_state(const csg_pruner *pruner, int octant)
{
    uint32_t root = pruner->tape->count - 1;
    if (low_of(pruner, root, octant) > pruner->slack)
        return CSG_CELL_INSIDE;
    if (high_of(pruner, root, octant) < -pruner->slack)
        return CSG_CELL_OUTSIDE;
    return CSG_CELL_SURFACE;
}

/* ---- demands --------------------------------------------------------------------------------- */

enum { ALL_OCTANTS = (1 << CSG_OCTANTS) - 1 };

static float *lanes(float *of_nodes, uint32_t node)
{
    return of_nodes + (size_t)node * CSG_OCTANTS;
}

/* The largest lower bound among a union's operands, for each octant, and whose it is. turn = -1
 * mirrors an intersection. */
static void find_best(const csg_tape_node *nodes, uint32_t node, float *lower, float turn,
                      float best[CSG_OCTANTS], uint32_t best_child[CSG_OCTANTS])
{
    uint32_t child = node - 1 - nodes[node].planes; /* these are leaves */
    for (int o = 0; o < CSG_OCTANTS; o++) {
        best[o] = -INFINITY;
        best_child[o] = child;
    }
    for (uint32_t k = nodes[node].planes; k < nodes[node].arity; k++, child -= nodes[child].size) {
        const float *bound = lanes(lower, child);
        for (int o = 0; o < CSG_OCTANTS; o++) {
            bool more = turn * bound[o] > best[o];
            best[o] = more ? turn * bound[o] : best[o];
            best_child[o] = more ? child : best_child[o];
        }
    }
}

/* Bit o is set where the child stays below the threshold in octant o and is not the best. */
static uint8_t below(const float *reach, float turn, const float threshold[CSG_OCTANTS],
                     uint32_t child, const uint32_t best_child[CSG_OCTANTS])
{
    int drop[CSG_OCTANTS], mask = 0;
    for (int o = 0; o < CSG_OCTANTS; o++)
        drop[o] = (turn * reach[o] < threshold[o]) & (child != best_child[o]);
    for (int o = 0; o < CSG_OCTANTS; o++)
        mask |= drop[o] << o;
    return (uint8_t)mask;
}

/* A demand takes the place of the interval, which nobody needs any more. */
static void set_demand(csg_pruner *pruner, uint32_t node, const float *low, const float *high)
{
    const csg_tape_node *of = &pruner->tape->nodes[node];
    float *to_low = lanes(pruner->low, node), *to_high = lanes(pruner->high, node);
    if (of->op == CSG_OP_SHAPE) {
        pruner->has_shapes = true;
        for (int o = 0; o < CSG_OCTANTS; o++) {
            csg_shape_demand demand =
                csg_prune_shape_demand(pruner->tape, of, to_low[o], to_high[o], low[o], high[o]);
            to_low[o] = demand.reach;
            to_high[o] = demand.middle;
        }
    } else if (!csg_op_is_leaf(of->op)) {
        memcpy(to_low, low, CSG_OCTANTS * sizeof *low);
        memcpy(to_high, high, CSG_OCTANTS * sizeof *high);
    }
}

static void fill(float lanes_of_one[CSG_OCTANTS], float value)
{
    for (int o = 0; o < CSG_OCTANTS; o++)
        lanes_of_one[o] = value;
}

/* Of fields combined by a formula any value may matter. */
static void demand_all(csg_pruner *pruner, uint32_t node)
{
    const csg_tape_node *nodes = pruner->tape->nodes, *op = &nodes[node];
    uint32_t child = node - 1;
    float low[CSG_OCTANTS], high[CSG_OCTANTS];
    fill(low, -INFINITY);
    fill(high, INFINITY);
    for (uint32_t k = 0; k < op->arity; k++, child -= nodes[child].size) {
        pruner->dropped[child] = pruner->dropped[node];
        set_demand(pruner, child, low, high);
    }
}

/* The operands of an operator on fields give what it takes, or soften what does. */
static void demand_fields(csg_pruner *pruner, uint32_t node)
{
    const csg_tape_node *op = &pruner->tape->nodes[node];
    if (op->op != CSG_OP_SOFTEN) {
        csg_field_ranges ranges = {pruner->tape, pruner->low, pruner->high, pruner->dropped};
        pruner->dropped_any |= csg_prune_fields(ranges, node);
        return; /* what stands below are fields too: no shape */
    }
    uint32_t child = node - 1;
    float low[CSG_OCTANTS], high[CSG_OCTANTS];
    csg_soften_demand(pruner->tape, op, &low[0], &high[0]);
    fill(low, low[0]);
    fill(high, high[0]);
    pruner->dropped[child] = pruner->dropped[node];
    set_demand(pruner, child, low, high);
}

/* How far any two operands together reach beyond the plane with this number, at least. */
static float least_beyond(const csg_pruner *pruner, uint32_t node, uint32_t number)
{
    const csg_tape_node *nodes = pruner->tape->nodes, *op = &nodes[node];
    float least = INFINITY, next = INFINITY;
    uint32_t child = node - 1 - op->planes;
    for (uint32_t k = op->planes; k < op->arity; k++, child -= nodes[child].size) {
        float beyond = pruner->tape->parameters[nodes[child].join_parameters + number];
        next = fminf(next, fmaxf(least, beyond));
        least = fminf(least, beyond);
    }
    return next;
}

/* Drops planes at which a fillet does not end there: the operands, grown by what the fillet can add
 * to them, do not reach them, or the parent cannot see so far. */
static void decide_planes(csg_pruner *pruner, uint32_t node, const float *demand_low,
                          const float *demand_high)
{
    const csg_tape_node *nodes = pruner->tape->nodes, *op = &nodes[node];
    bool is_union = csg_op_is_union(op->op);
    float turn = is_union ? 1.0f : -1.0f, reach[CSG_OCTANTS];
    float r = pruner->tape->parameters[op->parameters + CSG_OPERATOR_N];
    float *upper = is_union ? pruner->high : pruner->low;
    float *lower = is_union ? pruner->low : pruner->high;
    uint32_t child = node - 1 - op->planes;
    for (int o = 0; o < CSG_OCTANTS; o++)
        reach[o] = -INFINITY;
    for (uint32_t k = op->planes; k < op->arity; k++, child -= nodes[child].size)
        for (int o = 0; o < CSG_OCTANTS; o++)
            reach[o] = fmaxf(reach[o], turn * lanes(upper, child)[o] + r);
    for (uint32_t plane = node - op->planes; plane < node; plane++) {
        float beyond = least_beyond(pruner, node, nodes[plane].join_parameters) - pruner->slack;
        uint8_t mask = pruner->dropped[node];
        for (int o = 0; o < CSG_OCTANTS; o++) {
            float seen = is_union ? demand_high[o] : -demand_low[o];
            float from = turn * lanes(lower, plane)[o] + beyond;
            mask |= (uint8_t)((from > fminf(reach[o], seen)) << o);
        }
        pruner->dropped[plane] = mask;
        pruner->dropped_any |= mask;
    }
}

/* Drops operands of a union that cannot matter: those that stay below what the parent can see, or
 * below the largest sibling, by the blend's support. Intersections are the mirror image. */
static void decide_operands(csg_pruner *pruner, uint32_t node, const float *demand_low,
                            const float *demand_high)
{
    const csg_tape_node *nodes = pruner->tape->nodes, *op = &nodes[node];
    if (op->op == CSG_OP_COMBINE) {
        demand_all(pruner, node);
        return;
    }
    if (csg_op_delivers(op->op)) {
        demand_fields(pruner, node);
        return;
    }
    if (op->planes)
        decide_planes(pruner, node, demand_low, demand_high);
    bool is_union = csg_op_is_union(op->op);
    /* INTERIOR is not above its larger operand. */
    bool is_smooth = op->blend == CSG_BLEND_EXTERIOR || op->blend == CSG_BLEND_INTERIOR;
    float chi = pruner->tape->parameters[op->parameters + CSG_OPERATOR_SUPPORT];
    float turn = is_union ? 1.0f : -1.0f, threshold[CSG_OCTANTS];
    float edge = turn * pruner->tape->parameters[op->parameters + CSG_OPERATOR_N] - pruner->slack;
    float *lower = is_union ? pruner->low : pruner->high;
    float *upper = is_union ? pruner->high : pruner->low;
    uint32_t best_child[CSG_OCTANTS], child = node - 1 - op->planes;
    float child_low[CSG_OCTANTS], child_high[CSG_OCTANTS];
    bool has_colors = !op->planes && nodes[node - 1].is_plane; /* those of what ends there */
    find_best(nodes, node, lower, turn, threshold, best_child);
    for (int o = 0; o < CSG_OCTANTS; o++) {
        float demand = is_union ? demand_low[o] : -demand_high[o];
        threshold[o] = (demand > threshold[o] ? demand : threshold[o]) - chi - pruner->slack;
        if (op->blend == CSG_BLEND_ORTHOGONAL) /* at the edge both matter */
            threshold[o] = fminf(threshold[o], edge);
        child_low[o] = demand_low[o] - (is_union || is_smooth ? chi : 0);
        child_high[o] = demand_high[o] + (is_union && !is_smooth ? 0 : chi);
        if (op->blend == CSG_BLEND_ORTHOGONAL && is_union)
            child_low[o] = fminf(child_low[o], edge);
        else if (op->blend == CSG_BLEND_ORTHOGONAL)
            child_high[o] = fmaxf(child_high[o], -edge);
    }
    for (uint32_t k = op->planes; k < op->arity; k++, child -= nodes[child].size) {
        uint8_t mask = pruner->dropped[node];
        if (!has_colors || nodes[child].is_plane)
            mask |= below(lanes(upper, child), turn, threshold, child, best_child);
        pruner->dropped[child] = mask;
        pruner->dropped_any |= mask;
        set_demand(pruner, child, child_low, child_high);
    }
}

/* Marks every node that cannot matter, all octants at once: long tapes are read only twice. */
static void decide(csg_pruner *pruner, float tau)
{
    const csg_tape *tape = pruner->tape;
    uint32_t root = tape->count - 1;
    float low[CSG_OCTANTS], high[CSG_OCTANTS];
    pruner->decided = true;
    pruner->has_shapes = tape->nodes[root].op == CSG_OP_SHAPE;
    pruner->dropped_any = pruner->dropped[root] = 0;
    pruner->tau = tau + tape->waver; /* no Lipschitz constant bounds what wavers */
    fill(low, -pruner->tau);
    fill(high, pruner->tau);
    for (uint32_t i = tape->count; i > 0;) {
        uint32_t node = i - 1, size = tape->nodes[node].size;
        if (pruner->dropped[node] == ALL_OCTANTS) {
            memset(pruner->dropped + i - size, ALL_OCTANTS, size);
            i -= size;
            continue;
        }
        if (node == root && !csg_op_is_leaf(tape->nodes[node].op))
            decide_operands(pruner, node, low, high);
        else if (!csg_op_is_leaf(tape->nodes[node].op))
            decide_operands(pruner, node, lanes(pruner->low, node), lanes(pruner->high, node));
        i--;
    }
}

/* ---- the shorter tape ------------------------------------------------------------------------ */

/* Whether a subtree is nowhere more than a plane among what it is the intersection of, sharp or
 * rounded, which only takes off; turned around, of unions. */
static bool ends_at(const csg_pruner *pruner, uint32_t root, const csg_tape_node *plane,
                    bool is_union)
{
    const csg_tape_node *nodes = pruner->nodes, *node = &nodes[root];
    const float *parameters = pruner->tape->parameters;
    if (csg_op_is_leaf(node->op)) {
        const float *p = parameters + node->parameters, *q = parameters + plane->parameters;
        return p[CSG_LEAF_SIGMA] == q[CSG_LEAF_SIGMA] && p[CSG_LEAF_RAISE] == q[CSG_LEAF_RAISE] &&
               csg_tape_is_same_leaf(pruner->tape, node, plane);
    }
    bool takes_off = node->blend == CSG_BLEND_SHARP || csg_op_is_round(node->op);
    bool is_among = false;
    uint32_t child = root - 1;
    if (!takes_off || csg_op_is_union(node->op) != is_union)
        return false;
    for (uint32_t k = 0; k < node->arity; k++, child -= nodes[child].size)
        is_among = is_among || ends_at(pruner, child, plane, is_union);
    return is_among;
}

/* Planes at which blends end (CSG_FLAG_ENDED) are nothing to what is left where that ends there
 * anyhow: a sharp join of the two would look like a crease. Returns how many subtrees are left. */
static uint32_t drop_ends(const csg_pruner *pruner, const csg_tape_node *op, uint32_t kept,
                          uint32_t *count, const csg_emitted *stack, uint32_t *top)
{
    bool is_sharp = op->op == CSG_OP_UNION || op->op == CSG_OP_INTERSECTION;
    while (is_sharp && op->blend == CSG_BLEND_SHARP && kept > 1) {
        const csg_tape_node *last = &pruner->nodes[*count - 1];
        bool is_end = csg_op_is_primitive(last->op) && csg_op_has(last->op, CSG_TRAIT_LINEAR);
        bool is_known = false;
        for (uint32_t k = 2; k <= kept && is_end && !is_known; k++)
            is_known = ends_at(pruner, stack[*top - k].root, last, op->op == CSG_OP_UNION);
        if (!is_known)
            break;
        --*count;
        --*top;
        kept--;
    }
    return kept;
}

/* Writes an operator over the last `kept` subtrees: its joins and, unless only one is left, itself.
 */
static void emit_operator(csg_pruner *pruner, const csg_tape_node *op, uint32_t kept,
                          uint32_t *count, csg_emitted *stack, uint32_t *top)
{
    csg_tape_node *nodes = pruner->nodes;
    uint32_t planes = 0;
    kept = drop_ends(pruner, op, kept, count, stack, top);
    while (op->planes && nodes[stack[*top - 1 - planes].root].is_plane)
        planes++;
    if (kept - planes == 1 && csg_prune_is_identity(pruner->tape, op)) {
        *count -= planes;
        *top -= planes;
        nodes[stack[*top - 1].root].join_parameters = op->join_parameters;
        return; /* the operand stands for its operator */
    }
    csg_emitted *first = &stack[*top - kept];
    for (uint32_t k = 0; k < kept && !csg_op_takes_all(op->op); k++) {
        csg_tape_node *operand = &nodes[first[k].root];
        operand->join = CSG_JOIN_NONE;
        if (k > 0)
            operand->join = csg_op_is_union(op->op) ? CSG_JOIN_UNION : CSG_JOIN_INTERSECTION;
        operand->join_blend = op->blend;
        operand->join_parameters = op->parameters;
    }
    csg_tape_node *node = &nodes[*count];
    *node = *op;
    node->join = CSG_JOIN_NONE;
    node->arity = kept;
    node->planes = (uint16_t)planes;
    node->size = *count + 1 - first->begin;
    first->root = (*count)++;
    *top -= kept - 1;
}

/* Copies what is not dropped in the octant; returns the new length. */
static uint32_t emit(csg_pruner *pruner, int octant)
{
    const csg_tape *tape = pruner->tape;
    const uint8_t *dropped = pruner->dropped;
    csg_emitted *stack = pruner->stack;
    uint32_t count = 0, top = 0;
    for (uint32_t i = 0; i < tape->count; i++) {
        const csg_tape_node *node = &tape->nodes[i];
        if (dropped[i] >> octant & 1)
            continue;
        if (csg_op_is_leaf(node->op)) {
            pruner->nodes[count] = *node;
            pruner->nodes[count].join = CSG_JOIN_NONE;
            stack[top++] = (csg_emitted){count, count, i};
            count++;
            continue;
        }
        uint32_t kept = 0, first = i + 1 - node->size;
        while (kept < top && stack[top - 1 - kept].source >= first)
            kept++;
        emit_operator(pruner, node, kept, &count, stack, &top);
    }
    return count;
}

/* The root keeps its interval, which says whether there is a surface. */
static csg_shape_demand demand_on_shape(const csg_pruner *pruner, uint32_t node, int octant)
{
    const csg_tape *tape = pruner->tape;
    csg_shape_demand known = {low_of(pruner, node, octant), high_of(pruner, node, octant)};
    return node + 1 < tape->count ? known
                                  : csg_prune_shape_demand(tape, &tape->nodes[node], known.reach,
                                                           known.middle, -pruner->tau, pruner->tau);
}

/* Lists for the shapes that are left. */
static bool narrow_shapes(csg_pruner *pruner, int octant, csg_arena *arena, bool *shortened)
{
    const csg_tape *tape = pruner->tape;
    csg_shape_cube cube = {.radius = pruner->radius};
    for (int axis = 0; axis < 3; axis++)
        cube.center[axis] = pruner->center[axis][octant];
    uint32_t to = 0; /* leaves keep their order */
    for (uint32_t i = 0; i < tape->count; i++) {
        if (pruner->dropped[i] >> octant & 1 || tape->nodes[i].op != CSG_OP_SHAPE)
            continue;
        csg_shape_demand demand = demand_on_shape(pruner, i, octant);
        while (pruner->nodes[to].op != CSG_OP_SHAPE)
            to++;
        if (!csg_prune_shape(pruner->kernel, tape, &pruner->nodes[to++], &cube, demand, arena,
                             shortened))
            return false;
    }
    return true;
}

static bool copy_nodes(csg_arena *arena, const csg_tape_node *nodes, uint32_t count, csg_tape *out)
{
    csg_tape_node *copy = csg_arena_alloc(arena, count * sizeof *copy);
    if (!copy)
        return false;
    memcpy(copy, nodes, count * sizeof *copy);
    out->nodes = copy;
    out->count = count;
    return true;
}

bool csg_prune_shorten(csg_pruner *pruner, int octant, float tau, csg_arena *arena, csg_tape *out)
{
    *out = *pruner->tape;
    if (out->count == 1 && out->nodes->op != CSG_OP_SHAPE)
        return true;
    if (!pruner->decided)
        decide(pruner, tau);
    bool shortened = pruner->dropped_any >> octant & 1;
    if (!shortened && !pruner->has_shapes)
        return true;
    csg_arena_mark mark = csg_arena_get_mark(arena);
    uint32_t count = emit(pruner, octant);
    if (pruner->has_shapes && !narrow_shapes(pruner, octant, arena, &shortened))
        return false;
    if (shortened)
        return copy_nodes(arena, pruner->nodes, count, out);
    csg_arena_release_to(arena, mark);
    return true;
}

bool csg_prune_copy(csg_tape *tape, csg_arena *arena)
{
    csg_tape_node *copy = csg_arena_alloc(arena, tape->count * sizeof *copy);
    if (!copy)
        return false;
    memcpy(copy, tape->nodes, tape->count * sizeof *copy);
    for (uint32_t i = 0; i < tape->count; i++)
        if (copy[i].op == CSG_OP_SHAPE && !csg_prune_copy_shape(&copy[i], arena))
            return false;
    tape->nodes = copy;
    return true;
}
