/* SPDX-License-Identifier: MIT
 * Checks of options that several public functions take.
 */
#ifndef CSG_API_OPTIONS_H
#define CSG_API_OPTIONS_H

#include "csgmesh/csgmesh.h"

/* NULL is sound: the defaults. */
bool csg_scene_options_are_sound(const csgm_scene_options *options);

#endif
