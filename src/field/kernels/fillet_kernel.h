/* SPDX-License-Identifier: MIT
 * The fillet operator: all pieces of all operands at once, with their gradients
 * (scene/operators/fillet.h, operators.md 16). Part of kernel.c, in a file of its own.
 *
 * A point at a time, in double: what comes out depends on the pieces in reach alone, not on which
 * others pruning has left, nor on their order.
 */
#ifndef CSG_FIELD_FILLET_KERNEL_H
#define CSG_FIELD_FILLET_KERNEL_H

#include <math.h>

#include "base/select.h"
#include "field/kernels/batch.h"
#include "scene/operators/fillet.h"

/* Value of piece k: values[k * stride + i], its channels channels[(k * per + c) * stride + i], of
 * which the first three are its gradient. */
typedef struct fillet_arrays {
    float *values, *channels;
    size_t stride;
    uint32_t per;
} fillet_arrays;

/* The tree below a fillet. All of it fits into the work of csg_kernel_arrays: two terms with their
 * bounds for each piece. */
typedef struct fillet_tree {
    csg_fillet_term *terms;
    csg_fillet_piece *of_piece;
    double (*bounds)[2];
    uint32_t count, pieces;
} fillet_tree;

static csg_fillet_term fillet_operator(const csg_tape *tape, const csg_tape_node *node)
{
    static const uint8_t kinds[] = {
        [CSG_OP_UNION] = CSG_FILLET_MAX,
        [CSG_OP_INTERSECTION] = CSG_FILLET_MIN,
        [CSG_OP_FILLET_UNION] = CSG_FILLET_UNITE,
        [CSG_OP_FILLET_INTERSECTION] = CSG_FILLET_MEET,
    };
    const float *p = tape->parameters + node->parameters;
    csg_fillet_term term = {.kind = kinds[node->op], .size = node->arity};
    if (csg_op_is_fillet(node->op))
        term.radius = (double)p[CSG_OPERATOR_N];
    return term;
}

/* Terms have their operands' number for a size to begin with. */
static void fillet_find_sizes(fillet_tree *tree)
{
    for (uint32_t i = 0; i < tree->count; i++) {
        csg_fillet_term *term = &tree->terms[i];
        uint32_t operands = term->kind == CSG_FILLET_PIECE ? 0 : term->size;
        term->size = 1;
        for (; operands > 0; operands--)
            term->size += tree->terms[i - term->size].size;
    }
}

static fillet_tree fillet_tree_of(const csg_tape *tape, const csg_tape_node *root, float *work)
{
    uint32_t pieces = csg_tape_held_count(root), piece = pieces, most = 2 * pieces, at = most;
    fillet_tree tree = {.pieces = pieces};
    tree.bounds = (double(*)[2])(void *)work;
    tree.of_piece = (csg_fillet_piece *)(void *)(tree.bounds + most);
    tree.terms = (csg_fillet_term *)(void *)(tree.of_piece + pieces);
    for (const csg_tape_node *n = root, *end = root - root->size; n != end;) {
        int is_piece = n != root && n->held == CSG_HELD_PIECE;
        if (is_piece) {
            tree.terms[--at] =
                (csg_fillet_term){.kind = CSG_FILLET_PIECE, .piece = --piece, .size = 1};
        } else if (n->arity > 1) { /* one operand stands for its operator */
            tree.terms[--at] = fillet_operator(tape, n);
        }
        n -= is_piece ? n->size : 1;
    }
    tree.terms += at;
    tree.count = most - at;
    fillet_find_sizes(&tree);
    return tree;
}

/* The result takes the place of the first piece: value, gradient and `colors` more channels. */
static void fillet_combine(const fillet_tree *tree, const fillet_arrays *a, int colors,
                           size_t count)
{
    for (size_t i = 0; i < count; i++) {
        for (uint32_t k = 0; k < tree->pieces; k++) {
            csg_fillet_piece *p = &tree->of_piece[k];
            const float *channels = a->channels + (size_t)k * a->per * a->stride + i;
            p->f = (double)a->values[k * a->stride + i];
            for (int c = 0; c < 3; c++)
                p->g[c] = (double)channels[(size_t)c * a->stride];
            p->paint = colors ? (double)channels[3 * a->stride] : 0;
        }
        csg_fillet_piece made =
            csg_fillet_evaluate(tree->terms, tree->count, tree->of_piece, tree->bounds);
        a->values[i] = (float)made.f;
        for (int c = 0; c < 3; c++)
            a->channels[(size_t)c * a->stride + i] = (float)made.g[c];
        if (colors)
            a->channels[3 * a->stride + i] = (float)made.paint;
    }
}

/* The three largest of the operands' ends in cube o. */
static void fillet_three(const float *ends, uint32_t operands, float turn, size_t o, float most[3])
{
    most[0] = most[1] = most[2] = -INFINITY;
    for (uint32_t k = 0; k < operands; k++) {
        float v = turn * ends[k * CSG_OCTANTS + o];
        for (int place = 0; place < 3; place++)
            if (v > most[place]) {
                float next = most[place];
                most[place] = v;
                v = next;
            }
    }
}

/* What the operands' ranges allow, for eight cubes; low and high: a slot per operand, the result in
 * the first. turns: least and most 1 - cos of the operands' angles for each cube; NULL: any. */
static void fillet_intervals(const csg_tape *tape, const csg_tape_node *node, const float *turns,
                             float *low, float *high)
{
    const float turn = csg_op_is_union(node->op) ? 1.0f : -1.0f;
    const double r = (double)tape->parameters[node->parameters + CSG_OPERATOR_N];
    float *lower = turn > 0 ? low : high, *upper = turn > 0 ? high : low;
    for (size_t o = 0; o < CSG_OCTANTS; o++) {
        float most[3], least[3];
        fillet_three(upper, node->arity, turn, o, most);
        fillet_three(lower, node->arity, turn, o, least);
        double from = turns ? (double)turns[2 * o] : 0, to = turns ? (double)turns[2 * o + 1] : 2;
        double bound = csg_fillet_bound(r, (double)most[0] - (double)most[1],
                                        (double)most[0] - (double)most[2], to);
        double sure = csg_fillet_least(r, (double)least[0] - (double)least[1], from, to);
        float top = bound > 0 ? most[0] + (float)(bound + 1e-6 * r) : most[0];
        float bottom = sure > 0 ? least[0] + (float)(sure - 1e-6 * r) : least[0];
        lower[o] = turn * larger(least[0], bottom);
        upper[o] = turn * top;
    }
}

#endif
