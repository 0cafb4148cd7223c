/* SPDX-License-Identifier: MIT
 * A blend as scenes hold it, and the facts of blends and rules. Which kinds there are:
 * blend_kinds.h, which only those include who ask for one by name, so that a row of operators.def
 * does not rebuild everything.
 */
#ifndef CSG_SCENE_BLEND_H
#define CSG_SCENE_BLEND_H

#include <stdbool.h>
#include <stdint.h>

/* A blend with its parameter n of operators.md section 2 (w of section 12 for ROUND). Of a rule n
 * is its index among the rules of the scene or of the builder. */
typedef struct csg_blend {
    uint32_t kind; /* csg_blend_kind */
    double n; /* > 0; 0 for ORTHOGONAL and, but for idle nodes, for SHARP. HYPERBOLA and RECIPROCAL:
                 area, else length */
    bool is_number; /* ROUND: solids that meet blend, and end flush (tree/numbers.h) */
} csg_blend;

/* max and min, the first kind. */
#define CSG_SHARP ((csg_blend){0, 0, false})

static inline bool csg_blend_is_sharp(uint32_t kind)
{
    return kind == 0;
}
/* The two blends that are made without being asked for by name; widths > 0. */
csg_blend csg_blend_round(double width);
/* What a number means. */
csg_blend csg_blend_number(double radius);
csg_blend csg_blend_fillet(double radius);
bool csg_blend_is_round(uint32_t kind);
bool csg_blend_is_profile(uint32_t kind);
bool csg_blend_is_interior(uint32_t kind);
/* The intersection of fields at right angles (blend_kinds.h). */
bool csg_blend_is_orthogonal(uint32_t kind);
bool csg_blend_is_rule(uint32_t kind);
/* Whether it acts on fields in [0, 1] and gives a soft node. */
bool csg_blend_takes_fields(uint32_t kind);
/* Whether its value depends on its operands' gradients, too: no formula of values says it. */
bool csg_blend_is_fillet(uint32_t kind);

const char *csg_blend_name(uint32_t kind); /* as in the scene language */
/* n for the language's width w (operators.md 13). */
double csg_blend_raw(uint32_t kind, double width);
/* chi: operands that differ by this or more do not blend; INFINITY for some, and for rules
 * (csg_scene_support). */
double csg_blend_support(csg_blend blend);
/* Largest value of G - max over `operands` operands; INFINITY for rules (csg_scene_excess). */
double csg_blend_excess(csg_blend blend, uint32_t operands);
bool csg_blend_is_fold(uint32_t kind);
/* smooth and convex of operators.def; false for ORTHOGONAL and for rules. */
bool csg_blend_is_smooth(uint32_t kind);
bool csg_blend_is_convex(uint32_t kind);
/* The blend as a solid scaled by `factor` needs it: areas grow with its square. Rules stay as they
 * are (csg_rule_scale). */
csg_blend csg_blend_scale(csg_blend blend, double factor);

#endif
