/* SPDX-License-Identifier: MIT
 * A pair of parts as a scene for pictures.
 */
#ifndef CSG_CLEARANCE_EXHIBIT_H
#define CSG_CLEARANCE_EXHIBIT_H

#include "csgmesh/clearance.h"
#include "scene/scene.h"

/* As csgm_clear_exhibit, whose arguments are in range. CSGM_ERR_ARGUMENT: the scene lacks a part of
 * that name. What fails otherwise is reported. */
csgm_status csg_clear_exhibit(const csgm_scene *scene, const csgm_clear_pair *pair, int solid,
                              double mark, csgm_scene **out);

#endif
