/* SPDX-License-Identifier: MIT
 * Symmetries of tapes; see symmetry.h. With g a map and F a tape's field, F(g x) = F(x) if the
 * tree of F(g x), which has the same operators and leaves that are turned, is the tree of F, where
 * operands may stand in another order if their operator does not tell them apart.
 */
#include "measure/symmetry.h"

#include <math.h>
#include <string.h>

#include "field/kernels/batch.h"
#include "scene/operators/blend.h"
#include "scene/operators/blend_kinds.h"
#include "scene/primitives/curve.h"
#include "scene/primitives/kinds.h"

enum {
    MAPS = 48,
    NODES_MOST = 4096,      /* of a tape that is looked at */
    DEPTH_MOST = 64,        /* of operators in each other */
    COMPARED_MOST = 1 << 20 /* leaves, for all maps together */
};

typedef struct finder {
    const csg_tape *tape;
    csg_arena *arena;
    const csg_symmetry *g;
    uint32_t *partners; /* of each leaf a the leaf b that is f_a(g x) */
    double *apart;      /* of each leaf b how far that is from it, like CSG_LEAF_OFF and _TURNED */
    int compared, depth;
    bool out_of_memory;
} finder;

static csg_symmetry map_of(int index)
{
    static const int ORDERS[][3] = {{0, 1, 2}, {1, 0, 2}, {0, 2, 1},
                                    {2, 1, 0}, {1, 2, 0}, {2, 0, 1}};
    csg_symmetry s;
    for (int i = 0; i < 3; i++) {
        s.axes[i] = ORDERS[index / CSG_OCTANTS][i];
        s.sign[i] = index >> i & 1 ? -1 : 1;
    }
    return s;
}

void csg_symmetry_map(const csg_symmetry *s, const double from[3], double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = s->sign[i] * from[s->axes[i]];
}

bool csg_symmetry_keeps(const csg_symmetry *s, const double direction[3])
{
    double to[3];
    csg_symmetry_map(s, direction, to);
    return to[0] == direction[0] && to[1] == direction[1] && to[2] == direction[2];
}

/* ---- leaves ------------------------------------------------------------------------------------
 */

static const float *parameters_of(const finder *f, uint32_t leaf)
{
    return f->tape->parameters + f->tape->nodes[leaf].parameters;
}

/* The map into the leaf's own frame: m x + t. */
static void place_of(const finder *f, uint32_t leaf, double m[3][3], double t[3])
{
    const float *frame = parameters_of(f, leaf) + CSG_LEAF_FRAME;
    bool is_affine = f->tape->nodes[leaf].frame == CSG_FRAME_AFFINE;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            m[i][k] = is_affine ? (double)frame[3 * i + k] : i == k;
        t[i] = is_affine ? (double)frame[9 + i] : -(double)frame[i];
    }
}

static const float *own_of(const finder *f, uint32_t leaf)
{
    return csg_tape_own(f->tape, &f->tape->nodes[leaf]);
}

/* A map of a primitive's own frame under which its field is what it was. */
static bool is_own(const csg_symmetry *h, unsigned mirrors)
{
    bool swaps = h->axes[0] != 0 || h->axes[1] != 1;
    bool is_xy = h->axes[2] == 2, is_yz = h->axes[0] == 0;
    for (int i = 0; i < 3; i++)
        if (h->sign[i] < 0 && !(mirrors >> i & 1))
            return false;
    return !swaps || ((mirrors & CSG_MIRROR_XY || is_yz) && (mirrors & CSG_MIRROR_YZ || is_xy));
}

/* b's parameters are those of a's image, but for so much. No more than what floats make of them is
 * allowed: planes around leaves (halves.c) have room for twice that, slacks for much more, and what
 * takes off and turned at their word finds them widened. */
static bool is_close(finder *f, uint32_t a, uint32_t b, double place, double turn)
{
    const float *of_a = parameters_of(f, a), *of_b = parameters_of(f, b);
    if (!(place <= (double)of_b[CSG_LEAF_OFF] && turn <= (double)of_b[CSG_LEAF_TURNED]))
        return false;
    f->partners[a] = b;
    f->apart[2 * a] = place + (double)of_a[CSG_LEAF_OFF];
    f->apart[2 * a + 1] = turn + (double)of_a[CSG_LEAF_TURNED];
    return true;
}

/* A plane has all of its place in its own parameters. */
static bool is_plane_image(finder *f, uint32_t a, uint32_t b)
{
    const float *from = own_of(f, a), *to = own_of(f, b);
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        double d = f->g->sign[i] * (double)from[i] - (double)to[f->g->axes[i]];
        sum += d * d;
    }
    return is_close(f, a, b, fabs((double)from[3] - (double)to[3]), sqrt(sum));
}

/* m_a g x + t_a = h (m_b x + t_b), h a map of their own frame. */
static bool is_placed(finder *f, uint32_t a, uint32_t b, unsigned mirrors)
{
    double from[3][3], to[3][3], turned[3][3], t_from[3], t_to[3];
    double sigma = fabs((double)parameters_of(f, a)[CSG_LEAF_SIGMA]);
    place_of(f, a, from, t_from);
    place_of(f, b, to, t_to);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            turned[i][f->g->axes[k]] = f->g->sign[k] * from[i][k];
    for (int n = 0; n < MAPS; n++) {
        const csg_symmetry h = map_of(n);
        double place = 0, turn = 0;
        if (!is_own(&h, mirrors))
            continue;
        for (int i = 0; i < 3; i++) {
            double d = t_from[i] - h.sign[i] * t_to[h.axes[i]];
            place += d * d;
            for (int k = 0; k < 3; k++) {
                double e = turned[i][k] - h.sign[i] * to[h.axes[i]][k];
                turn += e * e;
            }
        }
        if (is_close(f, a, b, sigma * sqrt(place), sigma * sqrt(turn)))
            return true;
    }
    return false;
}

static bool is_image_leaf(finder *f, uint32_t a, uint32_t b)
{
    const csg_tape_node *from = &f->tape->nodes[a], *to = &f->tape->nodes[b];
    const float *of_a = parameters_of(f, a), *of_b = parameters_of(f, b);
    if (++f->compared > COMPARED_MOST || from->warp || to->warp || !csg_op_is_primitive(from->op) ||
        from->is_plane != to->is_plane)
        return false;
    csg_primitive_kind kind = csg_op_node_kind(from->op);
    if (csg_node_is_curve(kind) || of_a[CSG_LEAF_SIGMA] != of_b[CSG_LEAF_SIGMA] ||
        of_a[CSG_LEAF_RAISE] != of_b[CSG_LEAF_RAISE])
        return false;
    const csg_primitive *primitive = csg_primitive_of(kind);
    if (primitive->traits & CSG_TRAIT_LINEAR)
        return is_plane_image(f, a, b);
    size_t own_bytes = (size_t)primitive->own_count * sizeof(float);
    return !memcmp(own_of(f, a), own_of(f, b), own_bytes) &&
           is_placed(f, a, b, primitive->mirrors(own_of(f, a)));
}

/* ---- trees -------------------------------------------------------------------------------------
 */

/* Operands in any order. */
static bool is_commutative(const csg_tape_node *node)
{
    bool is_sharp = (node->op == CSG_OP_UNION || node->op == CSG_OP_INTERSECTION) &&
                    csg_blend_is_sharp(node->blend);
    return is_sharp || csg_op_is_round(node->op);
}

/* Operands, each of which has to become itself: of a function of values alone, or of fillets, which
 * turn on angles between gradients in a frame that is no more than turned. */
static bool is_told_apart(const finder *f, uint32_t a)
{
    const csg_tape_node *node = &f->tape->nodes[a];
    if (csg_op_is_fillet(node->op))
        return !(f->tape->parameters[node->parameters + CSG_FILLET_IS_SKEWED] > 0);
    return (node->op == CSG_OP_UNION || node->op == CSG_OP_INTERSECTION) &&
           node->blend < CSG_BLEND_FILLET;
}

static void find_operands(const finder *f, uint32_t node, uint32_t *out)
{
    const csg_tape_node *nodes = f->tape->nodes;
    uint32_t at = node;
    for (uint32_t k = nodes[node].arity; k-- > 0;) {
        out[k] = at - 1;
        at -= nodes[at - 1].size;
    }
}

static bool is_image(finder *f, uint32_t a, uint32_t b);

/* `to` is put in the order of the images. */
static bool are_images(finder *f, const uint32_t *from, uint32_t *to, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t k = i;
        while (k < count && !is_image(f, from[i], to[k]))
            k++;
        if (k == count)
            return false;
        uint32_t image = to[k];
        to[k] = to[i];
        to[i] = image;
    }
    return true;
}

/* A fillet's planes change places where all of its operands reach as far beyond the one as beyond
 * the other. */
static bool are_planes_images(finder *f, const uint32_t *operands, uint32_t count,
                              const uint32_t *from, uint32_t *to, uint32_t planes)
{
    const csg_tape_node *nodes = f->tape->nodes;
    if (!are_images(f, from, to, planes))
        return false;
    for (uint32_t i = 0; i < planes; i++)
        for (uint32_t k = 0; k < count; k++) {
            const float *reaches = f->tape->parameters + nodes[operands[k]].join_parameters;
            if (reaches[nodes[from[i]].join_parameters] != reaches[nodes[to[i]].join_parameters])
                return false;
        }
    return true;
}

/* Each operand has to become itself. */
static bool is_kept(finder *f, uint32_t node, const uint32_t *operands, uint32_t *to)
{
    const csg_tape_node *of = &f->tape->nodes[node];
    uint32_t planes = csg_op_is_fillet(of->op) ? of->planes : 0, count = of->arity - planes;
    for (uint32_t i = 0; i < count; i++)
        if (!is_image(f, operands[i], operands[i]))
            return false;
    return are_planes_images(f, operands, count, operands + count, to + count, planes);
}

static bool is_image_of_operator(finder *f, uint32_t a, uint32_t b)
{
    const csg_tape_node *from = &f->tape->nodes[a], *to = &f->tape->nodes[b];
    uint32_t count = from->arity;
    const float *of = f->tape->parameters;
    bool is_any_order = is_commutative(from);
    if (to->arity != count || from->size != to->size || from->blend != to->blend ||
        memcmp(of + from->parameters, of + to->parameters, CSG_OPERATOR_PARAMETERS * sizeof *of) ||
        (!is_any_order && !(a == b && is_told_apart(f, a))))
        return false;
    csg_arena_mark mark = csg_arena_get_mark(f->arena);
    uint32_t *operands = csg_arena_alloc(f->arena, 2 * count * sizeof *operands);
    f->out_of_memory |= !operands;
    bool is_same = operands != NULL;
    if (is_same) {
        find_operands(f, a, operands);
        find_operands(f, b, operands + count);
        is_same = is_any_order ? are_images(f, operands, operands + count, count)
                               : is_kept(f, a, operands, operands + count);
    }
    csg_arena_release_to(f->arena, mark);
    return is_same;
}

/* Of what the subtrees of a and b are, is f_a(g x) = f_b(x)? */
static bool is_image(finder *f, uint32_t a, uint32_t b)
{
    const csg_tape_node *nodes = f->tape->nodes;
    if (nodes[a].op != nodes[b].op || f->out_of_memory)
        return false;
    if (csg_op_is_leaf(nodes[a].op))
        return is_image_leaf(f, a, b);
    f->depth++;
    bool is_same = f->depth <= DEPTH_MOST && is_image_of_operator(f, a, b);
    f->depth--;
    return is_same;
}

/* ---- all of them -------------------------------------------------------------------------------
 */

/* No less than that. */
static float rounded_up(double value)
{
    static const double UP = 1 + 0x1p-22;
    return (float)(value * UP);
}

/* What is meant by a leaf is within its room, and so what is meant by the image is within the
 * partner's. */
static void widen(const finder *f, float *parameters)
{
    for (uint32_t a = 0; a < f->tape->count; a++) {
        if (!csg_op_is_leaf(f->tape->nodes[a].op))
            continue;
        float *of = parameters + f->tape->nodes[f->partners[a]].parameters;
        of[CSG_LEAF_OFF] = fmaxf(of[CSG_LEAF_OFF], rounded_up(f->apart[2 * a]));
        of[CSG_LEAF_TURNED] = fmaxf(of[CSG_LEAF_TURNED], rounded_up(f->apart[2 * a + 1]));
    }
}

bool csg_symmetries_find(csg_tape *tape, size_t parameter_count, csg_arena *arena,
                         csg_symmetries *out)
{
    uint32_t count = tape->count;
    out->count = 0;
    if (!count || count > NODES_MOST)
        return true;
    float *parameters = csg_arena_alloc(arena, (parameter_count + 1) * sizeof *parameters);
    uint32_t *partners = csg_arena_alloc(arena, count * sizeof *partners);
    double *apart = csg_arena_alloc(arena, 2 * count * sizeof *apart);
    if (!parameters || !partners || !apart)
        return false;
    finder f = {.tape = tape, .arena = arena, .partners = partners, .apart = apart};
    memcpy(parameters, tape->parameters, parameter_count * sizeof *parameters);
    for (int n = 1; n < MAPS && !f.out_of_memory; n++) { /* the first one is the identity */
        const csg_symmetry g = map_of(n);
        f.g = &g;
        if (!is_image(&f, count - 1, count - 1))
            continue;
        widen(&f, parameters);
        out->of[out->count++] = g;
    }
    if (out->count)
        tape->parameters = parameters;
    return !f.out_of_memory;
}
