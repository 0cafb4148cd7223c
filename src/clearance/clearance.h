/* SPDX-License-Identifier: MIT
 * Parts over poses: who is clear of whom.
 */
#ifndef CSG_CLEARANCE_CLEARANCE_H
#define CSG_CLEARANCE_CLEARANCE_H

#include "base/context.h"
#include "csgmesh/clearance.h"

/* Options are complete and in range. NULL: out of memory (reported). */
csgm_clearances *csg_clearances_create(csgm_context *context, const csgm_clear_options *options);
void csg_clearances_destroy(csgm_clearances *clearances);

/* As csgm_clearances_add. CSGM_ERR_ARGUMENT: a part that was asked for is not there (not reported).
 */
csgm_status csg_clearances_add(csgm_clearances *clearances, const csgm_scene *scene);

const csgm_clear_pair *csg_clearances_get(const csgm_clearances *clearances, size_t index);
/* The names seen so far; false: there are no more. *name: NULL where a part has none. */
bool csg_clearances_part(const csgm_clearances *clearances, size_t index, const char **name);
csgm_context *csg_clearances_context(const csgm_clearances *clearances);
double csg_clearances_tolerance(const csgm_clearances *clearances);

#endif
