/* SPDX-License-Identifier: MIT
 * Points that are in a part for certain: near its surface, for the gap's upper bound, and in two
 * parts at once.
 */
#ifndef CSG_CLEARANCE_PLACES_H
#define CSG_CLEARANCE_PLACES_H

#include "clearance/part.h"

/* Proven by the tape's interval at the point, rounding included. Scene units. *out_of_memory is set
 * where that is why it is false. */
bool csg_clear_is_inside(const csg_clear_part *part, uint32_t worker, csg_vec3 at,
                         bool *out_of_memory);

/* Walks to the surface, and from there inwards until it is proven to be inside. False: it did not
 * get there, or memory was short. */
bool csg_clear_settle(const csg_clear_part *part, uint32_t worker, csg_vec3 near, csg_vec3 *out,
                      bool *out_of_memory);

/* Climbs from `from` to where both fields are larger. False: no point on the way is proven to be in
 * both. */
bool csg_clear_find_common(const csg_clear_part *a, const csg_clear_part *b, uint32_t worker,
                           csg_vec3 from, double step, csg_vec3 *out, bool *out_of_memory);

#endif
