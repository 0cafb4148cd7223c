/* SPDX-License-Identifier: MIT
 * Blends with more parameters than one length: rules (operators.def). Definitions in double:
 * rule.c, rule_fields.c, rule_lengths.c; what they mean: operators.md 5 to 7.
 *
 * A rule of FIELDS is G(F1, F2, ...) with F in [0, 1], 1/2 on the surface; operands are clamped on
 * entry, the result is not. An intersection is an operator of its own; a difference is the
 * intersection of the first operand with the others' complements 1 - F. A rule of LENGTHS is a
 * union G(f1, f2) with the intersection -G(-f1, -f2) and the difference -G(-f1, f2).
 * The complement of any result is the dual operator on the complements: 1 - G(F) = G'(1 - F).
 */
#ifndef CSG_SCENE_RULE_H
#define CSG_SCENE_RULE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "scene/operators/blend.h"
#include "scene/operators/steps.h"

enum {
    CSG_RULE_PARAMETERS = 4,
    CSG_RULE_KNOTS = 18 /* of a profile, its two ends included */
};

/* Factors by angle (radians, ascending): a cubic spline, level at its ends (operators.md 5.5). */
typedef struct csg_spline {
    uint32_t count; /* of knots; 0: the factor 1 everywhere */
    bool settled;
    double angle[CSG_RULE_KNOTS], factor[CSG_RULE_KNOTS], slope[CSG_RULE_KNOTS];
    double degrees[CSG_RULE_KNOTS]; /* once settled: the angles as given */
} csg_spline;

/* Filled in: kind, parameters, step, range, points or profile. csg_rule_settle finds the rest. */
typedef struct csg_rule {
    uint32_t kind;                          /* csg_blend_kind */
    double parameters[CSG_RULE_PARAMETERS]; /* in the order of operators.def */
    csg_step step;                          /* EXTERIOR, INTERIOR */
    double range;                           /* for distances; 0: by the size of the operands */
    csg_spline spline;                      /* ARC; before it is settled: angles in degrees, and
                                             * the profile alone without the ends */
    uint32_t profile;                       /* PROFILE: among the builder's formulas */
    uint32_t point_count; /* ARC: 2 and more points of space, see csg_build_rule */
    double points[CSG_RULE_KNOTS][3];
    /* settled; [0] of the union, [1] of the intersection */
    bool monotone[2];
    double k[2];          /* for two operands, 0 where their number decides (csg_rule_slope) */
    csg_step_facts facts; /* EXTERIOR, INTERIOR */
    double most_excess;   /* EXTERIOR with eps > delta: of delta; else 0 */
} csg_rule;

const char *csg_rule_name(uint32_t kind); /* as in the scene language */
/* Binary, folded from the left; else all operands at once. */
bool csg_rule_is_fold(uint32_t kind);
/* With the standard parameters. */
csg_rule csg_rule_standard(uint32_t kind);
/* That of soft nodes which are joined sharply. */
csg_rule csg_rule_of_fields(void);

typedef struct csg_rule_parameter {
    const char *name, *unit, *meaning;
    double standard, least, most;
    bool open; /* least itself is not allowed */
} csg_rule_parameter;
uint32_t csg_rule_parameter_count(uint32_t kind);
csg_rule_parameter csg_rule_parameter_of(uint32_t kind, uint32_t index);

/* But for the range; before or after both are settled. */
bool csg_rule_is_same(const csg_rule *a, const csg_rule *b);
/* NULL, or one sentence about what is wrong, with its range; of a rule whose points were resolved
 * or that has none. */
const char *csg_rule_problem(const csg_rule *rule, char *text, size_t size);
/* After csg_rule_problem found none. */
void csg_rule_settle(csg_rule *rule);
/* As a call of the scene language; range 0: not said. Not for PROFILE. */
void csg_rule_print(const csg_rule *rule, double range,
                    void (*sink)(void *user, const char *text, size_t length), void *user);
/* The rule as a solid scaled by `factor` needs it. */
csg_rule csg_rule_scale(const csg_rule *rule, double factor);
/* chi of a rule of LENGTHS; INFINITY for FIELDS. */
double csg_rule_support(const csg_rule *rule);
/* Of a rule of LENGTHS: how far a union exceeds its larger operand (EXTERIOR) or stays below it
 * (INTERIOR); INFINITY for FIELDS. */
double csg_rule_excess(const csg_rule *rule);
/* Lipschitz constant of G for operands with these constants. */
double csg_rule_slope(const csg_rule *rule, bool is_union, const double *slopes, size_t count);

/* G and its partial derivatives: of fields F, or of two values f. For EXTERIOR and INTERIOR the
 * union alone. cosine: of the operands' gradients, for debulge (0 where it is not used). */
double csg_rule_apply(const csg_rule *rule, bool is_union, const double *values, size_t count,
                      double cosine, double *partials);

/* What G can be for operands in low..high (operators.md 7.2, 7.3, 5.5, 6.7; else the corners), as
 * csg_rule_apply; cosines: range of the cosine; partials: room. Rounding is not widened. */
void csg_rule_enclose(const csg_rule *rule, bool is_union, const double *low, const double *high,
                      size_t count, const double cosines[2], double *partials, double out[2]);

/* EXTERIOR, INTERIOR: between which the partial derivative of a union by its first operand lies
 * where that is more than the second one by t in low..high; the other one is 1 minus it. k: the
 * rule's, which is all that is known of steps that are not even and of an EXTERIOR whose steps
 * overlap. Rounding is not widened. */
void csg_rule_bound_share(const csg_rule *rule, double k, double low, double high, double out[2]);

/* ARC: the spline's factor at an angle in radians, 1 outside of its knots. */
double csg_spline_at(const csg_spline *spline, double angle, double *slope);
/* N_S and N_A of operators.md 6.5, and m of 6.3 for ranges r1, r2 and kappa = p / (r1 r2). */
double csg_normalise_scale(double u, double m, double *slope);
double csg_normalise_soft(double u, double *slope);
double csg_scale_top(double r1, double r2, double kappa);

#endif
