/* SPDX-License-Identifier: MIT
 * The evaluated tree of solids: flat arrays, index links. Children have smaller indices than
 * their parent and each node has at most one parent, so a loop upwards over the nodes is bottom-up
 * and a loop downwards is top-down: no recursion, however deep the tree.
 *
 * Field of a node (f > 0 inside):
 *   primitive      its exact signed distance in its own frame
 *   field          its formula (scene/formula/formula.h), Lipschitz constant as stated there
 *   shape          exact signed distance of explicit geometry (shape/shape.h)
 *   transform M    f(p) = s g(M^-1 p), s = smallest singular value of M: Lipschitz constant kept;
 *                  for similarities this is the exact distance again
 *   color          its child, whatever it says of it (csg_look)
 *   offset         its child plus r
 *   warp           scene/primitives/warp.h
 *   combine        F(children) / K: a formula whose x, y, z are the fields of up to three children,
 *                  K >= 1 a bound on the sum of its partial derivatives' sizes
 *   soft           (F - 1/2) / lambda, F = P(d) in [0, 1] of its child's f (csg_soft): a soft node
 *   operator       scene/operators/operators.def; difference is the intersection of the first child
 *                  with the negated others. A fillet looks at its operands' gradients, and its
 * value may jump where an operand's gradient does. One that takes fields (csg_rule, FIELDS) gives a
 * soft node again, (G(F1, F2, ...) - 1/2) / lambda empty          -infinity
 *
 * A flat node's field does not depend on z: a figure of the plane. A soft node's f + 1/2 times its
 * softness lambda is a field F in [0, 1] (before an operator's excess); transforms, colours and
 * warps of soft nodes are soft, and sharp operators with soft operands only. Lipschitz constants:
 * 1, but for formulas and for EXTERIOR and INTERIOR, whose K multiplies their operands'
 * (csg_scene_slopes).
 */
#ifndef CSG_SCENE_SCENE_H
#define CSG_SCENE_SCENE_H

#include <stdint.h>

#include "base/context.h"
#include "base/geometry.h"
#include "base/span.h"
#include "scene/formula/step.h"
#include "scene/node_kinds.h"
#include "scene/operators/blend.h"
#include "scene/primitives/warp.h"
#include "shape/shape.h"

/* scene/operators/: rule.h, soft.h; who looks into them includes those, so that a row of
 * their tables does not rebuild everything. */
typedef struct csg_rule csg_rule;
typedef struct csg_soft csg_soft;
typedef struct csg_operand csg_operand;

typedef uint32_t csg_node_id;
#define CSG_NODE_NONE UINT32_MAX

/* "sphere", "union", ...; static storage. */
const char *csg_node_kind_name(csg_node_kind kind);
/* Doubles in a primitive's payload; a field and a shape have none. */
uint32_t csg_primitive_parameter_count(csg_primitive_kind kind);

typedef struct csg_color {
    float r, g, b, a; /* 0..1, sRGB */
} csg_color;

/* What a COLOR node says of the solids below; of each thing the outermost node that says it holds.
 */
typedef struct csg_look {
    csg_color color;
    float metallic, roughness; /* 0..1 */
    bool has_color, has_material;
    uint32_t part; /* 1 + index into part_names; 0 = none (parts.h) */
} csg_look;

/* What an inner node says of colour and material, where the outer ones say nothing. */
void csg_look_take_inner(csg_look *outer, const csg_look *inner);

/* PLATEAU: while a scene is built, the field may stay above a value however far away
 * (tree/build_ends.c). Of operators whose blend was a number (tree/numbers.h): NUMBER, so that it
 * is printed as one; UNGROUPED and UNENDED, until what that means has been put into the tree.
 * ENDED: a sharp intersection of a union and what the union ends at, which shapes it but has no
 * colour; the union is the first child. */
enum {
    CSG_FLAG_FLAT = 1,
    CSG_FLAG_SOFT = 2,
    CSG_FLAG_PLATEAU = 4,
    CSG_FLAG_NUMBER = 8,
    CSG_FLAG_UNGROUPED = 16,
    CSG_FLAG_UNENDED = 32,
    CSG_FLAG_ENDED = 64
};

/* What holds operands of a union: half-spaces with this normal, or, where is_round, cylinders
 * without end around the axis through `foot` along it. */
typedef struct csg_fillet_end {
    csg_vec3 normal, foot;
    bool is_round;
} csg_fillet_end;

/* Parameters of an operator that takes fields, and of a sharp one with soft operands only. */
enum { CSG_OPERATOR_RULE, CSG_OPERATOR_RANGE, CSG_OPERATOR_LAMBDA, CSG_OPERATOR_FIELD_PARAMETERS };
/* Of a fillet: n, of a union its planes (operators/union_ends.h) among the normals and reaches
 * of the scene, and which of its solids do not meet (operators/apart.h). */
enum {
    CSG_FILLET_N,
    CSG_FILLET_FIRST_NORMAL,
    CSG_FILLET_FIRST_REACH,
    CSG_FILLET_PLANES,
    CSG_FILLET_APART,    /* 1 + where among `apart` of the scene it begins; 0: all may meet */
    CSG_FILLET_APART_BY, /* no two of the solids meet: how far they are apart, roughly; else 0 */
    CSG_FILLET_PARAMETERS
};
/* Of a soft node. */
enum { CSG_SOFT_RANGE, CSG_SOFT_FALLOFF, CSG_SOFT_LAMBDA, CSG_SOFT_PARAMETERS };

typedef struct csg_node {
    uint8_t kind;         /* csg_node_kind */
    uint8_t blend;        /* operators: csg_blend_kind */
    uint8_t flags;        /* CSG_FLAG_ */
    uint8_t warps;        /* most warps on a way to a leaf, this one included */
    uint32_t first_child; /* into children */
    uint32_t child_count;
    uint32_t payload; /* primitives: into parameters; fields and combine: into formulas; shapes:
                         into shapes; transforms: into transforms; colours: into looks; offsets:
                         into parameters, where r is; warps: into warps; operators: into parameters,
                         where n is, and what CSG_OPERATOR_ says behind it; soft: into
                         parameters, CSG_SOFT_ */
    csg_span where;
} csg_node;

/* A source text that spans point into, kept so that later findings can show the line. */
typedef struct csg_scene_text {
    const char *name, *text;
    uint32_t length;
} csg_scene_text;

struct csgm_scene {
    csgm_context *context;
    csg_arena arena; /* holds all arrays, once sealed */
    csg_node *nodes;
    csg_node_id *children;
    double *parameters;
    csg_affine *transforms;
    csg_affine *inverses; /* once sealed: of transforms */
    double *scales;       /* once sealed: smallest singular values of transforms */
    csg_look *looks;
    csg_formula *formulas;
    csg_formula_step *steps; /* of all formulas */
    csg_shape **shapes;      /* one reference each */
    csg_warp *warps;
    csg_rule *rules;      /* csg_blend.n of a rule is an index into them */
    csg_fillet_end *ends; /* once sealed: of all fillets */
    double *reaches;      /* once sealed: how far each operand reaches towards them */
    uint32_t *apart;      /* once sealed: of each fillet that has such, operands that do not meet */
    double *softness; /* once sealed: lambda of each soft node, else 0; NULL where none is soft */
    size_t node_count, child_count, parameter_count, transform_count, look_count, formula_count,
        step_count, shape_count, warp_count, rule_count;
    const char **part_names; /* once sealed owned by arena */
    uint32_t part_count;
    double slope;     /* once sealed: of the root, where a rule or a soft node is; else 0 */
    csg_node_id root; /* never NONE: an empty scene has an EMPTY node */
    csg_box *bounds;  /* per node, in its own frame: contains {f >= 0} (bounds.h) */
    const char **dependencies; /* files read, owned by arena */
    size_t dependency_count;
    const csg_scene_text *texts; /* a span's source is an index; copied into arena, or borrowed */
    size_t text_count;
    csgm_scene *marked[CSGM_MARK_COUNT]; /* owned; NULL: nothing is marked so */
    struct csg_drawing *drawing; /* owned; NULL: none was asked for (shape/plane/drawing.h) */
    double parse_s, evaluate_s;  /* wall time it took to get here; filled by lang/ */
};

static inline const csg_node_id *csg_scene_children(const csgm_scene *scene, const csg_node *node)
{
    return scene->children + node->first_child;
}
static inline const double *csg_scene_parameters(const csgm_scene *scene, const csg_node *node)
{
    return scene->parameters + node->payload;
}
csg_blend csg_scene_blend(const csgm_scene *scene, const csg_node *node);

/* Whether it is a flat node between two planes (csg_build_plate), as extrusions are. */
bool csg_node_is_plate(const csg_node *node);
/* Whether it is an operator that looks at its operands' gradients (operators/fillet.h). */
bool csg_node_is_fillet(const csg_node *node);
/* Whether it is an operator whose blend, a number, joins nothing: a sharp one, whose n it is. */
bool csg_node_is_idle(const csg_node *node);
/* Whether it is a union that adds nothing beyond half-spaces that hold its operands
 * (operators/union_ends.h). */
bool csg_node_ends_flush(const csg_node *node);
/* How far the operands of a fillet, a union, reach in its own frame: operand k lies within
 * csg_fillet_towards(ends[i], p) <= reaches[k * count + i]. */
typedef struct csg_fillet_planes {
    const csg_fillet_end *ends;
    const double *reaches; /* INFINITY: there is no end, or none is known */
    size_t count;
    /* NULL: all of them may meet. Else operand k does not meet those whose numbers are from
     * apart[apart[k]] to before apart[apart[k + 1]]. */
    const uint32_t *apart;
} csg_fillet_planes;
bool csg_fillet_planes_are_apart(const csg_fillet_planes *planes, uint32_t a, uint32_t b);
csg_fillet_planes csg_scene_fillet_planes(const csgm_scene *scene, const csg_node *node);
/* How far p lies along the plane's normal, or off the axis; *away: the direction in which it grows.
 */
double csg_fillet_towards(const csg_fillet_end *end, csg_vec3 p, csg_vec3 *away);

/* The rule of an operator that has one, else NULL. */
const csg_rule *csg_scene_rule(const csgm_scene *scene, const csg_node *node);
/* lambda of a soft node, in its own frame: F = 1/2 + lambda f. 0 where it is not soft. */
static inline double csg_scene_softness(const csgm_scene *scene, csg_node_id id)
{
    return scene->softness ? scene->softness[id] : 0;
}
csg_soft csg_scene_soft(const csgm_scene *scene, const csg_node *node);
/* Doubles that a node has among the parameters. */
uint32_t csg_node_parameter_count(const csg_node *node);
/* How operand number `index` of an operator that takes fields becomes one (csg_operand_field). */
csg_operand csg_scene_operand(const csgm_scene *scene, const csg_node *node, uint32_t index);
/* chi of an operator node, in its own frame; INFINITY for one that takes fields. */
double csg_scene_support(const csgm_scene *scene, const csg_node *node);
/* By how much a union can exceed its largest operand, and an intersection (INTERIOR) its smallest;
 * INFINITY for one that takes fields. */
double csg_scene_excess(const csgm_scene *scene, const csg_node *node);

bool csg_scene_has_colors(const csgm_scene *scene);

/* Gives back a sealed scene, the struct itself too. NULL is a no-op. */
void csg_scene_destroy(csgm_scene *scene);

/* Lipschitz constant of every node's field, in its own frame; out: room for node_count. A
 * SCALE_SET with debulge has none: this is the one for a constant angle of the gradients. */
void csg_scene_slopes(const csgm_scene *scene, double *out);
/* That of the root: the largest of its leaves' where no rule has a K. */
double csg_scene_lipschitz(const csgm_scene *scene);

#endif
