/* SPDX-License-Identifier: MIT
 * A field made ready for rays: the solid, or what modifiers of the scene mark (# and %). A picture
 * has one of each at the most, in the same view.
 */
#ifndef CSG_RENDER_LAYER_H
#define CSG_RENDER_LAYER_H

#include "render/job.h"
#include "render/tracer.h"

typedef struct csg_layer {
    const csgm_field *field; /* NULL: there is nothing to draw */
    csgm_field *compiled,
        *clipped;   /* owned; NULL where it is the caller's, and not cut by bounds */
    csg_box bounds; /* what of it is drawn is in here */
    csg_ray_cells cells;
    csg_pixel_rectangle *rectangles;
    csg_tracer tracer;
} csg_layer;

enum { CSG_LAYERS = 1 + CSGM_MARK_COUNT }; /* the solid, and each mark at 1 + its number */

/* The solid's field, met with the options' bounds. What fails is reported. */
csgm_status csg_layer_of_solid(csg_layer *layer, csgm_context *context, const csgm_field *field,
                               const csgm_render_options *options);
/* The marks of the scene whose solid is layers[0]. One that is infinite ends where the solid's
 * bounds do. */
csgm_status csg_layers_of_marks(csg_layer layers[CSG_LAYERS], csgm_context *context,
                                const csgm_scene *scene, const csgm_render_options *options);
/* Cells and tracers; places the picture's camera by what the cells show. */
csgm_status csg_layers_prepare(csg_layer layers[CSG_LAYERS], csg_picture *picture);
void csg_layer_release(csg_layer *layer, csgm_context *context);

#endif
