/* SPDX-License-Identifier: MIT
 * What is set from outside the scene: a parameter set (-p, -P), then definitions (-D) over it. Each
 * replaces an assignment at the scene's top level before anything is evaluated.
 */
#ifndef CSG_LANG_OVERRIDES_H
#define CSG_LANG_OVERRIDES_H

#include "lang/parse/ast.h"

/* Call after csg_parse_program; goes on after a fault, to report all of them. */
csgm_status csg_overrides_apply(csg_program *program, const csgm_scene_options *options);

#endif
