/* SPDX-License-Identifier: MIT
 * Pictures: of a field by sphere tracing (scene.c), of its section (slice.c), of triangles
 * (mesh.c).
 */
#ifndef CSG_RENDER_RENDER_H
#define CSG_RENDER_RENDER_H

#include "field/field.h"
#include "render/image.h"

csgm_render_options csg_render_options_default(void);

/* Each checks its options and reports what fails; *out is set on CSGM_OK. */
csgm_status csg_render_scene(csgm_context *context, const csgm_field *field,
                             const csgm_render_options *options, csgm_image **out,
                             csgm_render_stats *stats);
csgm_status csg_render_mesh(csgm_context *context, const csgm_mesh_view *mesh,
                            const csgm_render_options *options, csgm_image **out,
                            csgm_render_stats *stats);

#endif
