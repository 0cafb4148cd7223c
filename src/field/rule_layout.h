/* SPDX-License-Identifier: MIT
 * How soft nodes and operators with a rule lay out their parameters on the tape (tape.h). Only who
 * packs or runs them includes this.
 */
#ifndef CSG_FIELD_RULE_LAYOUT_H
#define CSG_FIELD_RULE_LAYOUT_H

#include "field/tape.h"
#include "scene/operators/rule.h"

/* Which field function a SOFTEN node is: P of soft(), the step H_3, or 1/2 + rate v kept in [0, 1].
 */
typedef enum csg_tape_curve {
#define CSG_FALLOFF(NAME, name, iso, steepest, steepest_at, doc) CSG_CURVE_##NAME,
#include "scene/operators/falloffs.def"
#undef CSG_FALLOFF
    CSG_CURVE_STEP,
    CSG_CURVE_CLAMP
} csg_tape_curve;

/* A SOFTEN node and an operator on fields deliver scale (F - level) + shift kept in low..high:
 *   as a value       scale +-1 / lambda, level 1/2, shift what offsets above add
 *   as a field       1, 0, 0 in 0..1
 *   as a complement  -1, 1, 0 in 0..1 */
enum {
    CSG_DELIVER_SCALE,
    CSG_DELIVER_LEVEL,
    CSG_DELIVER_SHIFT,
    CSG_DELIVER_LOW,
    CSG_DELIVER_HIGH,
    CSG_DELIVER_COLOR, /* index; where F has reached 0 or 1, since pruning may have changed then
                          what it is made of */
    CSG_DELIVER_PARAMETERS
};
/* Parameters of a SOFTEN node: the delivery's, then P(iso - rate v), H_3(rate v) or the clamp of
 * 1/2 + rate v. */
enum { CSG_SOFTEN_RATE = CSG_DELIVER_PARAMETERS, CSG_SOFTEN_ISO, CSG_SOFTEN_PARAMETERS };
/* Parameters of an operator on fields: as of any operator, the delivery's, then its own. The joins
 * of SOFT_SUM and SOFT_SET are the sum, of SCALE_SET the scale function B: of the operands or of
 * their complements (csg_rule_works_on_complements). */
enum {
    CSG_RULE_DELIVER = CSG_OPERATOR_PARAMETERS,
    CSG_RULE_OWN = CSG_RULE_DELIVER + CSG_DELIVER_PARAMETERS,
    CSG_RICCI_EXPONENT = CSG_RULE_OWN,
    CSG_SCALE_R1 = CSG_RULE_OWN,
    CSG_SCALE_R2,
    CSG_SCALE_KAPPA,
    CSG_SCALE_TOP, /* of N_S: from there on it is 1 */
    CSG_SCALE_BEND,
    CSG_SCALE_LIFT,  /* h of normalise_turned (soft_formulas.h) */
    CSG_SCALE_OMEGA, /* 0: does not turn */
    CSG_ARC_A = CSG_RULE_OWN,
    CSG_ARC_B,
    CSG_ARC_MONOTONE, /* with its profile */
    CSG_ARC_KNOTS,    /* of the profile, 0 = none; then angle, 1 / width, factor, step to the next
                         factor, slope and next slope times the width, of each stretch */
    CSG_ARC_STRETCHES
};
enum {
    CSG_STRETCH_ANGLE,
    CSG_STRETCH_INVERSE,
    CSG_STRETCH_FACTOR,
    CSG_STRETCH_RISE,
    CSG_STRETCH_SLOPE,
    CSG_STRETCH_NEXT_SLOPE,
    CSG_STRETCH_PARAMETERS,
    CSG_ARC_MOST_PARAMETERS = CSG_ARC_STRETCHES + CSG_RULE_KNOTS * CSG_STRETCH_PARAMETERS
};
/* By how much of m the top of N_S is lowered. */
#define CSG_SCALE_HAIR 1.5e-6
/* Parameters of EXTERIOR and INTERIOR: as of any operator, then the step and its facts
 * (csg_step_facts; scene/operators/rule.h). */
enum {
    CSG_SMOOTH_STEP = CSG_OPERATOR_PARAMETERS,
    CSG_SMOOTH_DEGREE, /* or alpha */
    CSG_SMOOTH_DELTA,
    CSG_SMOOTH_EPS,
    CSG_SMOOTH_REACH, /* mu is 0 and 1 from there on */
    CSG_SMOOTH_EVEN,
    CSG_SMOOTH_K,
    CSG_SMOOTH_DENT,                          /* two */
    CSG_SMOOTH_DENT_AT = CSG_SMOOTH_DENT + 2, /* two */
    CSG_SMOOTH_BUMP = CSG_SMOOTH_DENT_AT + 2, /* two */
    CSG_SMOOTH_BUMP_AT = CSG_SMOOTH_BUMP + 2, /* two */
    CSG_SMOOTH_PARAMETERS = CSG_SMOOTH_BUMP_AT + 2
};

#endif
