/* SPDX-License-Identifier: MIT
 * Soft objects: field functions of a distance, and distances as fields (operators.md 4, 9).
 */
#ifndef CSG_SCENE_SOFT_H
#define CSG_SCENE_SOFT_H

#include <stdbool.h>

typedef enum csg_falloff {
#define CSG_FALLOFF(NAME, name, iso, steepest, steepest_at, doc) CSG_FALLOFF_##NAME,
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
