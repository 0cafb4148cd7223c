/* SPDX-License-Identifier: MIT
 * What the files of rules share; see rule.h.
 */
#ifndef CSG_SCENE_RULE_PRIVATE_H
#define CSG_SCENE_RULE_PRIVATE_H

#include "scene/operators/rule.h"

/* csg_rule_apply of EXTERIOR and INTERIOR. */
double csg_rule_lengths(const csg_rule *rule, const double *values, double *partials);
/* Whether it is an EXTERIOR of a local step that is wider than delta: its steps at -delta and at
 * delta overlap, so that nothing is known of its shape but what csg_rule_scan_exterior finds. */
bool csg_rule_is_wide(const csg_rule *rule);
typedef struct csg_exterior_facts {
    double least, most; /* excess, of delta */
    double k;
} csg_exterior_facts;
csg_exterior_facts csg_rule_scan_exterior(const csg_rule *rule);
/* What EXTERIOR adds to the larger operand, and INTERIOR takes from it, where they differ by t >= 0
 * and the first is the larger (right) or not; *slope: its derivative. */
double csg_rule_exterior_excess(const csg_rule *rule, bool right, double t, double *slope);
double csg_rule_interior_dent(const csg_rule *rule, bool right, double t, double *slope);

/* ARC without its profile. */
double csg_plain_arc(const csg_rule *rule, bool is_union, const double *values, double *partials);
/* B of operators.md 6.3. */
double csg_scale_function(double r1, double r2, double kappa, const double x[2],
                          double partials[2]);
/* SCALE_SET with its ranges times `turn`, normalised as with `top_turn`. */
double csg_scale_set(const csg_rule *rule, bool is_union, double turn, double top_turn,
                     const double *values, double *partials);

#endif
