/* SPDX-License-Identifier: MIT
 * $fn, $fa and $fs: how many edges a circle has, and circles, frusta and balls with these.
 */
#ifndef CSG_SOLID_FACETS_H
#define CSG_SOLID_FACETS_H

#include "solid/solid.h"

typedef struct csg_facet_rule {
    double fn, fa, fs; /* as in OpenSCAD */
    bool exact;        /* facets are wanted everywhere */
} csg_facet_rule;

/* Edges of a circle of this radius, as OpenSCAD counts them. */
uint32_t csg_fragments(const csg_facet_rule *rule, double radius);
/* The same where facets are asked for ($fn from 3 to 16, or everywhere), else 0: round. */
uint32_t csg_facets(const csg_facet_rule *rule, double radius);

double csg_cosine_deg(double degrees); /* exact for multiples of 90 */
double csg_sine_deg(double degrees);

/* Nodes in place of CIRCLE, of a frustum between z = -half and half, of SPHERE. */
csg_node_id csg_faceted_circle(csg_solid_job *job, double radius, uint32_t count);
csg_node_id csg_faceted_frustum(csg_solid_job *job, const double radii[2], double half,
                                uint32_t count);
csg_node_id csg_faceted_sphere(csg_solid_job *job, double radius, uint32_t count);

#endif
