/* SPDX-License-Identifier: MIT
 * What scenes hold of formulas (formula.h), without the names of their operations.
 */
#ifndef CSG_SCENE_STEP_H
#define CSG_SCENE_STEP_H

#include <stdbool.h>
#include <stdint.h>

#include "base/geometry.h"

typedef struct csg_formula_step {
    uint8_t op; /* csg_formula_op */
    /* Earlier steps; 0 where the operation has fewer operands. X, Y and Z: a = g makes them
     * variables 3 g, 3 g + 1 and 3 g + 2 (csg_formula_variable_of). */
    uint32_t a, b;
    double constant; /* of CONSTANT, else 0 */
} csg_formula_step;

/* What bounds by intervals say of a function g of x >= 0. */
typedef struct csg_profile {
    double slope[2], value[2]; /* least and largest; where nothing is known infinite */
    double support;            /* g is 0 from there on; INFINITY: not seen to be */
} csg_profile;

/* A formula of a scene. */
typedef struct csg_formula {
    uint32_t first, count; /* into the scene's steps */
    double lipschitz;
    bool trusted;        /* the constant was stated as one that is proven, and could not be tried */
    csg_box bounds;      /* finite, or all of space */
    csg_profile profile; /* of a combine node with the blend PROFILE */
    /* the profile itself is the next formula */
    uint8_t joins; /* csg_node_kind of the operator that such a node stands for */
} csg_formula;

/* Values are kept within +- this; it also stands for NaN, with a minus: squares of it are floats.
 */
#define CSG_FORMULA_FAR 1e18

enum {
    CSG_LONGEST_FORMULA = 1 << 16,
    CSG_FORMULA_MOST_VARIABLES = 64, /* what a combine node may have of children */
    CSG_FORMULA_SLOTS = 512 /* most values that a formula may need at once, coordinates included */
};

/* A value and its gradient. */
typedef struct csg_formula_dual {
    double value;
    csg_vec3 gradient;
} csg_formula_dual;

/* What trying a stated Lipschitz constant gave (formula.h). */
typedef struct csg_slope_trial csg_slope_trial;

/* A step while a formula is being built. */
typedef uint32_t csg_formula_id;
#define CSG_FORMULA_NONE UINT32_MAX

typedef struct csg_formula_builder csg_formula_builder;
/* The same for those who build long ones (terms.h). */
typedef csg_formula_builder csg_terms;
typedef csg_formula_id csg_term;

#endif
