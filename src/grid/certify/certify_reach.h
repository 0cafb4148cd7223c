/* SPDX-License-Identifier: MIT
 * From a point to the lattice: does a connected way lead, without a change of sign, from a point to
 * a lattice point near by? The field's Lipschitz constant makes every value a ball of one sign
 * around its point; the way climbs from ball to ball to where the part is thickest.
 */
#ifndef CSG_GRID_CERTIFY_REACH_H
#define CSG_GRID_CERTIFY_REACH_H

#include "field/kernels/kernel.h"
#include "grid/octree/lattice.h"

typedef struct csg_reach {
    const csg_kernel *kernel;
    const csg_tape *tape; /* valid around; values exact up to `band` */
    const csg_lattice *lattice;
    float *scratch;
    size_t scratch_floats;
    double lipschitz, band;
    double noise; /* values this near to zero have no sign: what is thinner is not there */
    double low[3], high[3]; /* where the tape is valid, less two cells */
} csg_reach;

typedef enum csg_reach_state {
    CSG_REACH_SAMPLE,   /* a lattice point of this sign is connected with the point */
    CSG_REACH_UNPROVEN, /* no change of sign was seen on a way, but the balls do not cover it */
    CSG_REACH_NONE      /* the part is thinner than the lattice's cells as far as was looked */
} csg_reach_state;

typedef struct csg_reach_end {
    double at[3];     /* where the part is thickest */
    double thickness; /* there */
} csg_reach_end;

/* Values at count <= CSG_REACH_POINTS points, given as triples. */
enum { CSG_REACH_POINTS = 64 };
void csg_reach_values(const csg_reach *reach, const double (*points)[3], size_t count,
                      double *values);

void csg_reach_gradient(const csg_reach *reach, const double p[3], double gradient[3]);

/* Points from which a way leads to the lattice, with their balls; the latest ones. */
enum { CSG_REACH_TRAIL = 64 };
typedef struct csg_reach_trail {
    double at[CSG_REACH_TRAIL][3], value[CSG_REACH_TRAIL]; /* |f| */
    int8_t sign[CSG_REACH_TRAIL];
    uint32_t count; /* all that were added */
} csg_reach_trail;

/* Whether the ball of p touches that of a point of the trail, or the way up the gradients is one to
 * a lattice point, which then joins the trail: quick, and often enough. */
bool csg_reach_slide(const csg_reach *reach, const double p[3], double value, int sign,
                     csg_reach_trail *trail);

/* sign * value >= 0 is the field at p. Touching the trail is enough, and what led to the lattice
 * joins it; NULL: none is kept. */
csg_reach_state csg_reach_from(const csg_reach *reach, const double p[3], double value, int sign,
                               csg_reach_trail *trail, csg_reach_end *end);

#endif
