/* SPDX-License-Identifier: MIT
 * Blends with more parameters than one length: rules (operators.def), and what they act on: smooth
 * unit steps, field functions, the conversion of distances into fields. Definitions in double:
 * rule.c, rule_fields.c, steps.c; what they mean: operators.md 4 to 7.
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

typedef enum csg_blend_kind {
#define CSG_BLEND(NAME, name, area, raw, support, excess, smooth, convex, doc) CSG_BLEND_##NAME,
#include "scene/operators/operators.def"
    CSG_BLEND_COUNT,
    /* Intersection of fields with gradients at right angles, as of an extrusion's outline and its
     * ends: where both are negative -sqrt(a^2 + b^2), so that exact distances give an exact
     * distance. Made by csg_build_extrude only, not in the language. */
    CSG_BLEND_ORTHOGONAL = CSG_BLEND_COUNT,
#define CSG_RULE(NAME, name, space, fold, interval, demand, lipschitz, equal, doc) CSG_BLEND_##NAME,
#include "scene/operators/operators.def"
    CSG_BLEND_END
} csg_blend_kind;

/* A blend with its parameter n of operators.md section 2 (w of section 12 for ROUND). Of a rule n
 * is its index among the rules of the scene or of the builder. */
typedef struct csg_blend {
    csg_blend_kind kind;
    double n; /* > 0; 0 for SHARP and ORTHOGONAL. HYPERBOLA and RECIPROCAL: area, else length */
} csg_blend;

static inline bool csg_blend_is_rule(csg_blend_kind kind)
{
    return kind > CSG_BLEND_ORTHOGONAL;
}
/* Whether it acts on fields in [0, 1] and gives a soft node. */
static inline bool csg_blend_takes_fields(csg_blend_kind kind)
{
    return kind > CSG_BLEND_PROFILE;
}

/* ---- smooth unit steps ------------------------------------------------------------------------
 */

typedef enum csg_step_kind {
#define CSG_STEP(NAME, name, standard, least, most, whole, even, doc) CSG_STEP_##NAME,
#include "scene/operators/steps.def"
#undef CSG_STEP
    CSG_STEP_COUNT
} csg_step_kind;

typedef struct csg_step {
    csg_step_kind kind;
    double parameter;
} csg_step;

const char *csg_step_name(csg_step_kind kind);
/* A sigmoid is 0 or 1 where alpha |t| is this or more; a part in 1e16 of it is lost. */
#define CSG_SIGMOID_END 37.0
/* mu is 0 below -reach and 1 above it. */
double csg_step_reach(csg_step step);
/* mu(t); *slope: mu'(t). */
double csg_step_at(csg_step step, double t, double *slope);

/* Largest values that enclosures need (operators.md 7.1): of s (1 - mu(s)) and s mu(-s) for s >= 0,
 * of u^2 (1 - mu(u)) and u^2 mu(-u) for 0 <= u <= 1, each with the place where it is; K of
 * INTERIOR; h of EXTERIOR. The second of each pair equals the first for an even step. */
typedef struct csg_step_facts {
    double dent[2], dent_at[2], bump[2], bump_at[2];
    double interior, exterior; /* K_int; h */
} csg_step_facts;

csg_step_facts csg_step_find_facts(csg_step step);

/* ---- rules ------------------------------------------------------------------------------------
 */

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
    csg_blend_kind kind;
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
} csg_rule;

const char *csg_rule_name(csg_blend_kind kind); /* as in the scene language */
/* Binary, folded from the left; else all operands at once. */
bool csg_rule_is_fold(csg_blend_kind kind);
/* With the standard parameters. */
csg_rule csg_rule_standard(csg_blend_kind kind);

typedef struct csg_rule_parameter {
    const char *name, *unit, *meaning;
    double standard, least, most;
    bool open; /* least itself is not allowed */
} csg_rule_parameter;
uint32_t csg_rule_parameter_count(csg_blend_kind kind);
csg_rule_parameter csg_rule_parameter_of(csg_blend_kind kind, uint32_t index);

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

/* ARC: the spline's factor at an angle in radians, 1 outside of its knots. */
double csg_spline_at(const csg_spline *spline, double angle, double *slope);
/* N_S and N_A of operators.md 6.5, and m of 6.3 for ranges r1, r2 and kappa = p / (r1 r2). */
double csg_normalise_scale(double u, double m, double *slope);
double csg_normalise_soft(double u, double *slope);
double csg_scale_top(double r1, double r2, double kappa);

/* ---- soft objects -----------------------------------------------------------------------------
 */

typedef enum csg_falloff {
#define CSG_FALLOFF(NAME, name, iso, steepest, doc) CSG_FALLOFF_##NAME,
#include "scene/operators/falloffs.def"
#undef CSG_FALLOFF
    CSG_FALLOFF_COUNT
} csg_falloff;

const char *csg_falloff_name(csg_falloff falloff);
double csg_falloff_iso(csg_falloff falloff);      /* d where P = 1/2 */
double csg_falloff_steepest(csg_falloff falloff); /* largest |P'| */
/* P(d) and P'(d), d >= 0. */
double csg_falloff_at(csg_falloff falloff, double d, double *slope);

/* A SOFT node: F = P(d), d = iso - f (1 - iso) / range, at least 0. */
typedef struct csg_soft {
    csg_falloff falloff;
    double range; /* > 0: how far outside of the child's surface F becomes 0 */
} csg_soft;

/* lambda of F for a child with constant 1. */
double csg_soft_lambda(csg_soft soft);
/* F for the child's f; *slope: dF / df. */
double csg_soft_at(csg_soft soft, double f, double *slope);

/* An operand of a rule of FIELDS. soft: F = clamp(1/2 + slope f, 0, 1); else F = H3(slope f), slope
 * = 1 / range (H3: the step poly(3)). */
typedef struct csg_operand {
    double slope;
    bool soft;
} csg_operand;

/* F for the operand's f; *derivative: dF / df. */
double csg_operand_field(csg_operand operand, double f, double *derivative);

#endif
