/* SPDX-License-Identifier: MIT
 * A field's picture by the lazy evaluator in double (scene/lazy/lazy.h), ray by ray: slow, for
 * counting evaluations as the literature does.
 */
#ifndef CSG_RENDER_LAZY_SCENE_H
#define CSG_RENDER_LAZY_SCENE_H

#include "render/job.h"

csgm_status csg_render_lazy(csg_picture *picture, const csgm_field *field, csg_box bounds,
                            csgm_render_stats *stats);

#endif
