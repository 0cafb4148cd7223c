/* SPDX-License-Identifier: MIT
 * The tape: the scene's field as a flat postorder array, subtrees contiguous, parameters beside
 * it, everything in float relative to the field's centre. Pruning copies a shorter array; the
 * parameters are shared.
 *
 * Signs are folded in: difference becomes intersection, negation moves to the leaves (a negative
 * `sigma`), so that only unions (max and its blends) and intersections (min and theirs) remain.
 *
 * Values combine as soon as they are there: each child of a sharp or folded operator but the first
 * carries the `join` that merges it into its elder siblings' value, so a union of a thousand needs
 * two value slots. A round operator needs all its operands at once and combines them itself.
 */
#ifndef CSG_FIELD_TAPE_H
#define CSG_FIELD_TAPE_H

#include "scene/primitives/primitive.h"

typedef enum csg_op {
    CSG_OP_FIELD,
    CSG_OP_SHAPE,
    CSG_OP_UNION, /* sharp or folded: the joins of its children did the work */
    CSG_OP_INTERSECTION,
    CSG_OP_ROUND_UNION, /* takes `arity` values from the stack */
    CSG_OP_ROUND_INTERSECTION,
    CSG_OP_FILLET_UNION, /* takes `arity` values, the last `planes` of them those of planes */
    CSG_OP_FILLET_INTERSECTION,
    CSG_OP_COMBINE,    /* takes `arity` values from the stack, x, y, z of a formula */
    CSG_OP_SOFTEN,     /* one child: its value becomes a field in [0, 1] */
    CSG_OP_RULE_UNION, /* of fields: its children's joins did the work, what is left it delivers */
    CSG_OP_RULE_INTERSECTION,
    CSG_OP_EMPTY, /* -infinity (or +infinity, negated): only ever the whole tape */
    CSG_OP_FIRST_PRIMITIVE
} csg_op;

/* Primitives stand behind the others, in the order of nodes (scene/primitives/kinds.h). */
#define CSG_OP_OF(PRIMITIVE)                                                                       \
    (CSG_OP_FIRST_PRIMITIVE + (CSG_NODE_##PRIMITIVE - CSG_NODE_FIRST_PRIMITIVE))
static inline bool csg_op_is_primitive(uint8_t op)
{
    return op >= CSG_OP_FIRST_PRIMITIVE;
}
static inline csg_primitive_kind csg_op_node_kind(uint8_t op)
{
    return CSG_NODE_FIRST_PRIMITIVE + op - CSG_OP_FIRST_PRIMITIVE;
}
static inline uint8_t csg_op_of_primitive(csg_primitive_kind kind)
{
    return (uint8_t)(CSG_OP_FIRST_PRIMITIVE + (kind - CSG_NODE_FIRST_PRIMITIVE));
}
/* Whether this is a leaf whose primitive has the trait. */
static inline bool csg_op_has(uint8_t op, unsigned trait)
{
    return csg_op_is_primitive(op) && csg_primitive_of(csg_op_node_kind(op))->traits & trait;
}
/* Whether it is a leaf whose gradient may jump from face to face. */
static inline bool csg_op_has_faces(uint8_t op)
{
    return op == CSG_OP_SHAPE || csg_op_has(op, CSG_TRAIT_FACES);
}
static inline bool csg_op_is_leaf(uint8_t op)
{
    return op < CSG_OP_UNION || op >= CSG_OP_EMPTY;
}
static inline bool csg_op_is_union(uint8_t op)
{
    return op == CSG_OP_UNION || op == CSG_OP_ROUND_UNION || op == CSG_OP_FILLET_UNION ||
           op == CSG_OP_RULE_UNION;
}
/* Works on fields in [0, 1] instead of values. */
static inline bool csg_op_takes_fields(uint8_t op)
{
    return op == CSG_OP_RULE_UNION || op == CSG_OP_RULE_INTERSECTION;
}
static inline bool csg_op_is_round(uint8_t op)
{
    return op == CSG_OP_ROUND_UNION || op == CSG_OP_ROUND_INTERSECTION;
}

static inline bool csg_op_is_fillet(uint8_t op)
{
    return op == CSG_OP_FILLET_UNION || op == CSG_OP_FILLET_INTERSECTION;
}

/* Operators that look at all their operands' values at once. */
static inline bool csg_op_takes_all(uint8_t op)
{
    return csg_op_is_round(op) || csg_op_is_fillet(op) || op == CSG_OP_COMBINE;
}

/* Turns the one value below it into what it delivers. */
static inline bool csg_op_delivers(uint8_t op)
{
    return op == CSG_OP_SOFTEN || csg_op_takes_fields(op);
}

/* How a node's value merges with the value of its elder siblings. */
typedef enum csg_join { CSG_JOIN_NONE, CSG_JOIN_UNION, CSG_JOIN_INTERSECTION } csg_join;

typedef struct csg_tape_node {
    uint8_t op;    /* csg_op */
    uint8_t join;  /* csg_join */
    uint8_t blend; /* operators: csg_blend_kind of the operator; copied to children's joins. SOFTEN:
                      csg_tape_curve */
    uint8_t join_blend;
    uint8_t frame;            /* leaves: csg_leaf_frame */
    bool is_plane;            /* leaves: at which a blend ends, none of its operands: no colour */
    uint16_t planes;          /* fillets: how many of the last children are such */
    uint32_t warp;            /* leaves: index + 1 of the innermost warp above, 0 = none */
    uint32_t parameters;      /* leaves, operators: into the parameters */
    uint32_t join_parameters; /* into the parameters, of the operator that joins */
    uint32_t size;            /* nodes of the subtree, this one included */
    union {
        uint32_t arity;                    /* operators: children */
        const struct csg_shape_near *near; /* shapes: what of it can matter; NULL: all */
    };
} csg_tape_node;

/* Parameters of a leaf: sigma, raise, slack, color, off, turned, then the frame (3 or 12 floats),
 * then its own.
 *   sigma  +-1, or +-(smallest singular value) where the frame is no similarity
 *   raise  what offsets above add to sigma times the leaf's own value
 *   slack  bound on the rounding error of a value of this leaf anywhere in the lattice
 *   color  index into the field's colours */
enum {
    CSG_LEAF_SIGMA,
    CSG_LEAF_RAISE,
    CSG_LEAF_SLACK,
    CSG_LEAF_COLOR,
    CSG_LEAF_OFF,
    CSG_LEAF_TURNED,
    CSG_LEAF_FRAME,
    CSG_LEAF_OWN_OFFSET = CSG_LEAF_FRAME + 3,
    CSG_LEAF_OWN_AFFINE = CSG_LEAF_FRAME + 12
};
/* Parameters of an operator. n is 1 for sharp ones, so that nothing divides by zero; for orthogonal
 * ones it is what offsets above have added to the operands. */
enum { CSG_OPERATOR_N, CSG_OPERATOR_SUPPORT, CSG_OPERATOR_PARAMETERS };
/* Of a fillet, behind those of an operator: whether angles in its own frame are others than in the
 * scene's (it is scaled unequally), and then the rows of the matrix that takes gradients into that
 * frame; how many planes it had before it was pruned, and whether some of its operands are apart. A
 * row for each operand comes next: how far it reaches beyond each plane, its number, how many
 * others are apart from it, and theirs. */
enum {
    CSG_FILLET_IS_SKEWED = CSG_OPERATOR_PARAMETERS,
    CSG_FILLET_TO_OWN,
    CSG_FILLET_PLANES_ONCE = CSG_FILLET_TO_OWN + 9,
    CSG_FILLET_HAS_APART,
    CSG_FILLET_REACHES
};

/* One operation of an expression field over slots of floats, angles in radians. `out` is neither
 * `a` nor `b`; slots 0 to 2 are the point. */
typedef struct csg_tape_step {
    uint8_t op;       /* csg_formula_op with operands */
    uint8_t constant; /* which operand is `value` instead of a slot */
    uint16_t out, a, b;
    float value;
} csg_tape_step;

enum { CSG_CONSTANT_NONE, CSG_CONSTANT_A, CSG_CONSTANT_B };

/* A CSG_OP_FIELD's own parameter is the index of one of these. A CSG_OP_COMBINE has the parameters
 * of such a leaf too; its frame is affine and takes the operands' values to what the formula
 * expects. */
typedef struct csg_tape_formula {
    uint32_t first, count; /* into the steps */
    uint32_t slots, result;
    float low[3], high[3]; /* the domain, in the leaf's own frame */
    float lipschitz;
} csg_tape_formula;

/* A map of points, between the frame of the warp above (or the tape's own, outer = 0) and that of
 * what stands below. */
typedef struct csg_tape_warp {
    uint32_t outer;  /* index + 1 */
    uint8_t kind;    /* csg_warp_kind */
    float frame[12]; /* rows of m, then t: from the outer frame to the warp's own */
    float own[CSG_WARP_PARAMETERS];
} csg_tape_warp;

/* What the scene says where the tape has floats: a double for each parameter of the tape, with the
 * rounding of doubles alone in the place of `off` and `turned`. */
typedef struct csg_tape_exact {
    const double *parameters; /* NULL: not known */
} csg_tape_exact;

/* A tape, whole or pruned: `nodes` of one array over shared parameters. */
typedef struct csg_tape {
    const csg_tape_node *nodes;
    const float *parameters;
    const csg_tape_exact *exact; /* NULL: as its parameters */
    const csg_color *colors;
    const csg_tape_step *steps;
    const csg_tape_formula *formulas;
    const csg_tape_warp *warps;
    csg_shape *const *shapes; /* a CSG_OP_SHAPE's own parameter is an index of these */
    float lipschitz;          /* of the whole field */
    float steepest;           /* of its leaves */
    uint32_t count;
    float waver; /* how far the field strays from one that has the constant `lipschitz` */
    bool turns;  /* some value in the whole tape depends on its operands' gradients */
} csg_tape;

/* Some operands of the fillet do not meet: where two blend with a third one there is a crease. */
static inline bool csg_fillet_has_apart(const csg_tape *tape, const csg_tape_node *fillet)
{
    return tape->parameters[fillet->parameters + CSG_FILLET_HAS_APART] > 0;
}

/* Do two of its operands not meet? Of each the join_parameters, which are where its row begins;
 * planes_once: CSG_FILLET_PLANES_ONCE. */
static inline bool csg_fillet_rows_apart(const float *parameters, uint32_t one, uint32_t other,
                                         uint32_t planes_once)
{
    const float *row = parameters + one + planes_once;
    float number = parameters[other + planes_once];
    for (uint32_t i = 0; i < (uint32_t)row[1]; i++)
        if (row[2 + i] == number)
            return true;
    return false;
}

/* Whether it is known what the scene says. */
static inline bool csg_tape_is_exact(const csg_tape *tape)
{
    return tape->exact && tape->exact->parameters;
}

/* Parameter number `at` as the scene says it, as far as that is known: of leaves, and the length of
 * a blend. */
static inline double csg_tape_number(const csg_tape *tape, uint32_t at)
{
    return csg_tape_is_exact(tape) ? tape->exact->parameters[at] : (double)tape->parameters[at];
}

/* A leaf's own parameters. */
static inline uint32_t csg_tape_own_at(const csg_tape_node *leaf)
{
    bool offset = leaf->frame == CSG_FRAME_OFFSET;
    return leaf->parameters + (offset ? CSG_LEAF_OWN_OFFSET : CSG_LEAF_OWN_AFFINE);
}

static inline const float *csg_tape_own(const csg_tape *tape, const csg_tape_node *leaf)
{
    return tape->parameters + csg_tape_own_at(leaf);
}

/* Of a CSG_OP_SHAPE. */
static inline const csg_shape *csg_tape_shape(const csg_tape *tape, const csg_tape_node *node)
{
    return tape->shapes[(uint32_t)csg_tape_own(tape, node)[0]];
}

/* Of a CSG_OP_FIELD or a CSG_OP_COMBINE. */
static inline const csg_tape_formula *csg_tape_formula_of(const csg_tape *tape,
                                                          const csg_tape_node *node)
{
    return &tape->formulas[(uint32_t)csg_tape_own(tape, node)[0]];
}

static inline uint32_t csg_tape_leaf_count(const csg_tape *tape)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < tape->count; i++)
        count += csg_op_is_leaf(tape->nodes[i].op);
    return count;
}

struct csgm_field {
    csgm_context *context;
    const csgm_scene *scene; /* borrowed */
    csg_arena arena;
    csg_tape tape;
    size_t parameter_count;
    uint32_t color_count; /* 1 = no colours in the scene: only the default */
    bool has_colors, has_materials;
    const csg_color *materials;   /* for each colour: metallic in r, roughness in g; NULL = none */
    struct csg_field_part *parts; /* of a scene with named parts (parts.c); else NULL */
    size_t part_count;
    uint32_t depth;  /* value slots that an evaluation needs */
    csg_vec3 center; /* of the floats */
    csg_box bounds;  /* of the solid (scene/boxes/bounds.h) */
    uint32_t primitive_count, operator_count;
};

/* A part of the scene as a field of its own. */
typedef struct csg_field_part {
    const char *name; /* borrowed of the scene; NULL = none */
    csgm_scene *scene;
    csgm_field *field;
} csg_field_part;

/* Value slots an evaluation of this tape needs. */
uint32_t csg_tape_depth(const csg_tape *tape);

#endif
