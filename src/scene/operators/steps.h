/* SPDX-License-Identifier: MIT
 * Smooth unit steps (operators.md 7.1): what EXTERIOR and INTERIOR blend by.
 */
#ifndef CSG_SCENE_STEPS_H
#define CSG_SCENE_STEPS_H

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

#endif
