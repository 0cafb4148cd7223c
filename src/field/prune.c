/* SPDX-License-Identifier: MIT
 * Intervals, demands and shorter tapes; see prune.h.
 */
#include "field/prune.h"

#include <math.h>
#include <string.h>

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
    csg_memory_release(pruner->memory, pruner->demand_low, n * sizeof(float));
    csg_memory_release(pruner->memory, pruner->demand_high, n * sizeof(float));
    csg_memory_release(pruner->memory, pruner->dropped, n);
    csg_memory_release(pruner->memory, pruner->stack, n * sizeof(csg_emitted));
    csg_memory_release(pruner->memory, pruner->nodes, n * sizeof(csg_tape_node));
    pruner->low = pruner->high = pruner->demand_low = pruner->demand_high = NULL;
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
    if (n <= pruner->capacity)
        return true;
    release_arrays(pruner);
    pruner->capacity = n;
    pruner->low = csg_memory_alloc(pruner->memory, n * CSG_OCTANTS * sizeof(float));
    pruner->high = csg_memory_alloc(pruner->memory, n * CSG_OCTANTS * sizeof(float));
    pruner->demand_low = csg_memory_alloc(pruner->memory, n * sizeof(float));
    pruner->demand_high = csg_memory_alloc(pruner->memory, n * sizeof(float));
    pruner->dropped = csg_memory_alloc(pruner->memory, n);
    pruner->stack = csg_memory_alloc(pruner->memory, n * sizeof(csg_emitted));
    pruner->nodes = csg_memory_alloc(pruner->memory, n * sizeof(csg_tape_node));
    if (pruner->low && pruner->high && pruner->demand_low && pruner->demand_high &&
        pruner->dropped && pruner->stack && pruner->nodes)
        return true;
    release_arrays(pruner);
    return false;
}

bool csg_prune_octants(csg_pruner *pruner, const csg_tape *tape, const float cx[CSG_OCTANTS],
                       const float cy[CSG_OCTANTS], const float cz[CSG_OCTANTS], float radius)
{
    if (!make_room(pruner, tape))
        return false;
    pruner->tape = tape;
    pruner->slack = pruner->rounding * tape->lipschitz;
    pruner->kernel->intervals(tape, cx, cy, cz, radius + pruner->rounding, pruner->low,
                              pruner->high, pruner->scratch);
    return true;
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

/* Drops operands of a union that cannot matter: those that stay below what the parent can see, or
 * below the largest sibling, by the blend's support. Intersections are the mirror image. */
static uint32_t decide_operands(csg_pruner *pruner, uint32_t node, int octant)
{
    const csg_tape_node *nodes = pruner->tape->nodes, *op = &nodes[node];
    bool is_union = csg_op_is_union(op->op);
    float chi = pruner->tape->parameters[op->parameters + CSG_OPERATOR_SUPPORT];
    float best = -INFINITY; /* the largest lower bound, of mirrored values for intersections */
    uint32_t child = node - 1, best_child = child;
    for (uint32_t k = 0; k < op->arity; k++, child -= nodes[child].size) {
        float bound = is_union ? low_of(pruner, child, octant) : -high_of(pruner, child, octant);
        if (bound > best) {
            best = bound;
            best_child = child;
        }
    }
    float demand = is_union ? pruner->demand_low[node] : -pruner->demand_high[node];
    float threshold = (demand > best ? demand : best) - chi - pruner->slack;
    uint32_t dropped = 0;
    child = node - 1;
    for (uint32_t k = 0; k < op->arity; k++, child -= nodes[child].size) {
        float reach = is_union ? high_of(pruner, child, octant) : -low_of(pruner, child, octant);
        bool drop = reach < threshold && child != best_child;
        pruner->dropped[child] = drop;
        dropped += drop;
        pruner->demand_low[child] = pruner->demand_low[node] - (is_union ? chi : 0);
        pruner->demand_high[child] = pruner->demand_high[node] + (is_union ? 0 : chi);
    }
    return dropped;
}

/* Marks the root of every subtree that cannot matter; returns how many. */
static uint32_t decide(csg_pruner *pruner, int octant, float tau)
{
    const csg_tape *tape = pruner->tape;
    uint32_t dropped = 0, i = tape->count;
    pruner->dropped[i - 1] = false;
    pruner->demand_low[i - 1] = -tau;
    pruner->demand_high[i - 1] = tau;
    while (i > 0) {
        uint32_t node = i - 1;
        if (pruner->dropped[node]) {
            i -= tape->nodes[node].size;
            continue;
        }
        if (!csg_op_is_leaf(tape->nodes[node].op))
            dropped += decide_operands(pruner, node, octant);
        i--;
    }
    return dropped;
}

/* ---- the shorter tape ------------------------------------------------------------------------ */

/* Writes an operator over the last `kept` subtrees: its joins and, unless only one is left, itself.
 */
static void emit_operator(csg_pruner *pruner, const csg_tape_node *op, uint32_t kept,
                          uint32_t *count, csg_emitted *stack, uint32_t *top)
{
    if (kept == 1)
        return; /* the operand stands for its operator */
    csg_tape_node *nodes = pruner->nodes;
    csg_emitted *first = &stack[*top - kept];
    for (uint32_t k = 0; k < kept && !csg_op_is_round(op->op); k++) {
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
    node->size = *count + 1 - first->begin;
    first->root = (*count)++;
    *top -= kept - 1;
}

/* Copies what is not dropped; returns the new length. */
static uint32_t emit(csg_pruner *pruner)
{
    const csg_tape *tape = pruner->tape;
    csg_emitted *stack = pruner->stack;
    uint32_t count = 0, top = 0;
    /* Whether a node lies in a dropped subtree is known from its root, which comes later: mark
     * downwards first. */
    for (uint32_t i = tape->count; i > 0;) {
        uint32_t node = i - 1, size = tape->nodes[node].size;
        if (pruner->dropped[node]) {
            memset(pruner->dropped + i - size, 1, size);
            i -= size;
        } else {
            i--;
        }
    }
    for (uint32_t i = 0; i < tape->count; i++) {
        const csg_tape_node *node = &tape->nodes[i];
        if (pruner->dropped[i])
            continue;
        if (csg_op_is_leaf(node->op)) {
            pruner->nodes[count] = *node;
            pruner->nodes[count].join = CSG_JOIN_NONE;
            stack[top++] = (csg_emitted){count, count};
            count++;
            continue;
        }
        uint32_t kept = 0, child = i - 1;
        for (uint32_t k = 0; k < node->arity; k++, child -= tape->nodes[child].size)
            kept += !pruner->dropped[child];
        emit_operator(pruner, node, kept, &count, stack, &top);
    }
    return count;
}

bool csg_prune_shorten(csg_pruner *pruner, int octant, float tau, csg_arena *arena, csg_tape *out)
{
    *out = *pruner->tape;
    if (out->count == 1 || !decide(pruner, octant, tau))
        return true;
    uint32_t count = emit(pruner);
    csg_tape_node *nodes = csg_arena_alloc(arena, count * sizeof *nodes);
    if (!nodes)
        return false;
    memcpy(nodes, pruner->nodes, count * sizeof *nodes);
    out->nodes = nodes;
    out->count = count;
    return true;
}
