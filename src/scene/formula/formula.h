/* SPDX-License-Identifier: MIT
 * Expression fields: a formula in the coordinates of a point, as a flat array of steps in which
 * operands come before their users and the last step is the result. The builder folds constants
 * and makes equal steps one.
 *
 * Inside its bounds a formula's field is its value; outside it is the value at the nearest point
 * of the bounds, so that one Lipschitz constant holds everywhere and nothing is evaluated where it
 * was not meant to be. Where a formula has no value (NaN) the point is far outside.
 */
#ifndef CSG_SCENE_FORMULA_H
#define CSG_SCENE_FORMULA_H

#include "base/table.h"
#include "scene/formula/step.h"

typedef enum csg_formula_op {
#define CSG_FORMULA_OP(NAME, name, arity) CSG_FORMULA_##NAME,
#include "scene/formula/formula.def"
#undef CSG_FORMULA_OP
    CSG_FORMULA_OP_COUNT
} csg_formula_op;

/* One operand; neither a leaf nor two. */
static inline bool csg_formula_op_is_unary(csg_formula_op op)
{
    return op > CSG_FORMULA_Z && op < CSG_FORMULA_ADD;
}
/* Which variable an X, Y or Z is: 0, 1, 2 are the coordinates of a point, or the first three of
 * the values that a formula combines, which may be more. */
static inline uint32_t csg_formula_variable_of(const csg_formula_step *step)
{
    return (uint32_t)step->op - CSG_FORMULA_X + 3 * step->a;
}
/* "sin"; static storage. */
const char *csg_formula_op_name(csg_formula_op op);
uint32_t csg_formula_op_arity(csg_formula_op op);

/* ---- building ----------------------------------------------------------------------------- */

struct csg_formula_builder {
    csg_memory *memory;
    csg_formula_step *steps;
    csg_table table; /* of the steps */
    size_t count, capacity;
    size_t most;   /* steps: CSG_LONGEST_FORMULA */
    bool too_long; /* NONE was returned for CSG_LONGEST_FORMULA, not for memory */
};

void csg_formula_begin(csg_formula_builder *builder, csg_memory *memory);
void csg_formula_end(csg_formula_builder *builder);
/* NONE: out of memory, or too long. Operands must not be NONE. */
csg_formula_id csg_formula_constant(csg_formula_builder *builder, double value);
csg_formula_id csg_formula_apply(csg_formula_builder *builder, csg_formula_op op, csg_formula_id a,
                                 csg_formula_id b);
/* The variable of this number. */
csg_formula_id csg_formula_variable(csg_formula_builder *builder, uint32_t number);
/* The steps that the result needs, operands close before their users, into `out` (room for
 * builder->count); returns how many, 0 when out of memory. */
uint32_t csg_formula_collect(const csg_formula_builder *builder, csg_formula_id result,
                             csg_formula_step *out);

/* The number of the last variable that is read and 1, at least 3. */
uint32_t csg_formula_variables(const csg_formula_step *steps, uint32_t count);
/* Values that an evaluation in this order has to keep at once, constants not counted. */
bool csg_formula_width(csg_memory *memory, const csg_formula_step *steps, uint32_t count,
                       uint32_t *out);

/* ---- values and bounds ---------------------------------------------------------------------- */

/* One operation on numbers, in degrees. */
double csg_formula_value(csg_formula_op op, double a, double b);

/* Value and gradient at p (zero at critical points); work: room for formula->count. */
csg_formula_dual csg_formula_evaluate(const csg_formula_step *steps, const csg_formula *formula,
                                      csg_vec3 p, csg_formula_dual *work);

/* The same of csg_formula_variables values, in all of their space: the gradient is by variables
 * 3 group, 3 group + 1, 3 group + 2. */
csg_formula_dual csg_formula_evaluate_group(const csg_formula_step *steps,
                                            const csg_formula *formula, const double *values,
                                            uint32_t group, csg_formula_dual *work);

/* A Lipschitz constant on the box by interval arithmetic, as tight as some hundred parts of the
 * box make it; INFINITY where that finds none. NAN: out of memory. */
double csg_formula_lipschitz(csg_memory *memory, const csg_formula_step *steps, uint32_t count,
                             csg_box box);

typedef enum csg_slope_verdict {
    CSG_SLOPE_UNDECIDED,
    CSG_SLOPE_PROVEN, /* up to rounding */
    CSG_SLOPE_REFUTED /* by more than rounding */
} csg_slope_verdict;

/* What became of a Lipschitz constant that somebody stated. */
struct csg_slope_trial {
    csg_slope_verdict verdict;
    double
        bound; /* unless it is refuted: a constant that holds, perhaps INFINITY; NAN: no memory */
    csg_vec3 place; /* where it is refuted: a point beside which */
    double slope;   /* the formula changes by as much along one unit of length */
};

/* With the work of csg_formula_lipschitz; a constant that this gives is proven. */
csg_slope_trial csg_formula_try_lipschitz(csg_memory *memory, const csg_formula_step *steps,
                                          uint32_t count, csg_box box, double stated);
/* An upper bound of the sum of the partial derivatives' sizes anywhere; INFINITY where interval
 * arithmetic finds none. NAN: out of memory. */
double csg_formula_partials_sum(csg_memory *memory, const csg_formula_step *steps, uint32_t count);
/* Bounds of the value and of the derivative by x for x in low..high, y = z = 0; infinite where
 * nothing is known. False: out of memory. */
bool csg_formula_ranges(csg_memory *memory, const csg_formula_step *steps, uint32_t count,
                        double low, double high, double value[2], double slope[2]);
/* Bounds of the value in the box, by interval arithmetic on up to a thousand parts of it; infinite
 * where nothing is known. False: out of memory. */
bool csg_formula_values(csg_memory *memory, const csg_formula_step *steps, uint32_t count,
                        csg_box box, double values[2]);
/* +1, -1 or 0 for each of so many variables: the formula never falls, never rises, or neither is
 * known (also without memory). */
void csg_formula_trends(csg_memory *memory, const csg_formula_step *steps, uint32_t count,
                        uint32_t variables, int *trends);

#endif
