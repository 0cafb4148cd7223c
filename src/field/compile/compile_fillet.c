/* SPDX-License-Identifier: MIT
 * Fillets on the tape: the planes behind their operands, and how far the field strays because of
 * them from one with a Lipschitz constant.
 */
#include "field/compile/compile_private.h"

#include <math.h>

#include "field/rule_layout.h"
#include "scene/operators/fillet.h"
#include "scene/primitives/kinds.h"

/* The plane with this number lies where the operand ends that reaches farthest, of those that end
 * (what is empty ends everywhere, at -INFINITY). False: fewer than two do, so that none of the
 * operands' unions ends there. */
static bool find_plane(const csg_compiler *c, const csg_node *node, size_t number, double *d)
{
    csg_fillet_planes planes = csg_scene_fillet_planes(c->scene, node);
    uint32_t ending = 0;
    *d = -INFINITY;
    for (uint32_t k = 0; k < node->child_count; k++) {
        double reach = planes.reaches[k * planes.count + number];
        ending += reach < INFINITY;
        *d = isfinite(reach) ? fmax(*d, reach) : *d;
    }
    *d = isfinite(*d) ? *d : 0;
    return ending > 1;
}

/* Angles between gradients are those of the fillet's own frame, as a solid that is scaled is scaled
 * with its fillets. With the frame's matrix M and the factor of its values, a gradient g of the
 * scene is M^T g / factor there. */
static void pack_frame(const csg_compile_frame *f, float *own)
{
    double largest, smallest;
    csg_affine_singular_values(&f->place, &smallest, &largest);
    own[CSG_FILLET_IS_SKEWED] = largest - smallest > 1e-12 * largest;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++)
            own[CSG_FILLET_TO_OWN + 3 * row + column] =
                (float)(f->place.m[column][row] / f->factor);
}

/* Where the row of operand k begins (field/tape.h), behind the first one's. */
static uint32_t row_of(const csg_fillet_planes *planes, uint32_t k)
{
    uint32_t others = planes->apart ? planes->apart[k] - planes->apart[0] : 0;
    return k * ((uint32_t)planes->count + 2) + others;
}

static bool push_row(csg_compiler *c, const csg_fillet_planes *planes, uint32_t k)
{
    const float unknown = INFINITY;
    uint32_t at, first = planes->apart ? planes->apart[k] : 0;
    uint32_t end = planes->apart ? planes->apart[k + 1] : 0;
    for (size_t i = 0; i < planes->count; i++)
        if (!csg_compile_push(c, &unknown, 1, &at))
            return false;
    if (!csg_compile_push(c, (float[]){(float)k, (float)(end - first)}, 2, &at))
        return false;
    for (uint32_t i = first; i < end; i++)
        if (!csg_compile_push(c, (float[]){(float)planes->apart[i]}, 1, &at))
            return false;
    return true;
}

bool csg_compile_fillet(csg_compiler *c, csg_compile_task *t)
{
    const csg_node *node = &c->scene->nodes[t->node];
    csg_fillet_planes planes = csg_scene_fillet_planes(c->scene, node);
    float own[CSG_FILLET_REACHES] = {(float)t->blend.n, (float)csg_blend_support(t->blend)};
    pack_frame(&t->frame, own);
    own[CSG_FILLET_PLANES_ONCE] = (float)planes.count;
    own[CSG_FILLET_HAS_APART] = planes.apart != NULL;
    if (!csg_compile_push(c, own, CSG_FILLET_REACHES, &t->parameters))
        return false;
    for (uint32_t k = 0; k < node->child_count; k++)
        if (!push_row(c, &planes, k))
            return false;
    for (size_t i = 0; i < planes.count; i++) {
        double d;
        if (!find_plane(c, node, i, &d))
            continue;
        for (uint32_t k = 0; k < node->child_count; k++) {
            double reach = planes.reaches[k * planes.count + i];
            float *row = c->parameters + t->parameters + CSG_FILLET_REACHES + row_of(&planes, k);
            if (reach < INFINITY)
                row[i] = (float)((reach - d) * t->frame.factor);
        }
    }
    return true;
}

uint32_t csg_compile_reaches(const csg_compiler *c, const csg_compile_task *t)
{
    csg_fillet_planes planes = csg_scene_fillet_planes(c->scene, &c->scene->nodes[t->node]);
    return t->parameters + CSG_FILLET_REACHES + row_of(&planes, t->written);
}

bool csg_compile_planes(csg_compiler *c, const csg_compile_task *t, uint32_t *count)
{
    const csg_node *node = &c->scene->nodes[t->node];
    const csg_compile_frame *f = &t->frame;
    csg_fillet_planes planes = csg_scene_fillet_planes(c->scene, node);
    csg_affine place = csg_compile_place(c, f);
    *count = 0;
    for (size_t i = 0; i < planes.count; i++) {
        const csg_fillet_end *end = &planes.ends[i];
        csg_vec3 n = end->normal;
        double d;
        if (!find_plane(c, node, i, &d))
            continue;
        csg_leaf l = {.raise = f->raise};
        if (end->is_round) {
            csg_affine at =
                csg_affine_multiply(csg_affine_translate(end->foot), csg_affine_z_to(n));
            at = csg_affine_multiply(place, at);
            csg_leaf_primitive(&l, &at, f->factor, f->negate, CSG_NODE_CIRCLE, &d);
        } else {
            csg_leaf_primitive(&l, &place, f->factor, f->negate, CSG_NODE_PLANE,
                               (double[]){n.x, n.y, n.z, d});
        }
        l.magnitude += f->magnitude;
        if (!csg_compile_leaf(c, &l, f->color, f->warp))
            return false;
        c->nodes[c->node_count - 1].is_plane = true;
        c->nodes[c->node_count - 1].join_parameters = (uint32_t)i;
        ++*count;
    }
    return true;
}

/* Of a fillet alone: it lies between its largest operand and that plus this. */
static float excess_of(const csg_tape *tape, const csg_tape_node *node)
{
    float r = tape->parameters[node->parameters + CSG_OPERATOR_N];
    return node->arity - node->planes > 2 ? r : (float)CSG_FILLET_PAIR_EXCESS * r;
}

/* Operators of lengths hand on how far their operands stray. */
bool csg_compile_waver(csg_memory *memory, csg_tape *tape)
{
    uint32_t top = 0, depth = csg_tape_depth(tape);
    float *stack = csg_memory_alloc(memory, depth * sizeof *stack);
    if (!stack)
        return false;
    tape->waver = 0;
    for (uint32_t i = 0; i < tape->count; i++) {
        const csg_tape_node *node = &tape->nodes[i];
        if (csg_op_is_leaf(node->op))
            stack[top++] = 0;
        for (uint32_t k = 1; csg_op_takes_all(node->op) && k < node->arity; k++, top--)
            stack[top - 2] = fmaxf(stack[top - 2], stack[top - 1]);
        if (csg_op_is_fillet(node->op)) {
            stack[top - 1] += excess_of(tape, node);
            tape->turns = true;
        }
        bool bends = node->op == CSG_OP_COMBINE || csg_op_delivers(node->op);
        if (bends && stack[top - 1] > 0)
            stack[top - 1] = INFINITY;
        if (csg_blend_turns(node->join_blend) && node->join)
            stack[top - 2] = INFINITY;
        if (node->join) {
            top--;
            stack[top - 1] = fmaxf(stack[top - 1], stack[top]);
        }
    }
    tape->waver = stack[0];
    csg_memory_release(memory, stack, depth * sizeof *stack);
    return true;
}
