/* SPDX-License-Identifier: MIT
 * A mesh's picture: what it leaves of the light (mesh_light.h), the ground's shadow (ground_map.h),
 * then the triangles, tile by tile (draw.h).
 */
#include "base/clock.h"
#include "base/trace.h"
#include "mesh/view.h"
#include "render/draw.h"
#include "render/ground_map.h"

static bool is_any_clear(const csgm_mesh_view *mesh)
{
    for (size_t i = 0; mesh->colors && i < mesh->vertex_count; i++)
        if (mesh->colors[4 * i + 3] < 255)
            return true;
    return false;
}

static bool tile_item(void *user, uint32_t worker, size_t index)
{
    csg_draw *draw = user;
    if (csg_picture_should_stop(draw->picture))
        return false;
    csg_draw_tile(draw, draw->rooms[worker], (uint32_t)(index % draw->columns),
                  (uint32_t)(index / draw->columns));
    return true;
}

csgm_status csg_render_mesh(csgm_context *context, const csgm_mesh_view *mesh,
                            const csgm_render_options *options, csgm_image **out,
                            csgm_render_stats *stats)
{
    CSG_ZONE(context, "render mesh");
    csg_picture picture;
    csg_ground_map ground = {.darkness = NULL};
    csg_mesh_light light = {.widest = 0};
    csgm_render_options own = *options;
    own.slice_axis = -1; /* of scenes */
    *stats = (csgm_render_stats){0};
    csg_box box = csg_view_bounds(mesh);
    csgm_status status = csg_picture_begin(&picture, context, &own, box);
    bool has_ground = status == CSGM_OK && csg_ground_map_is_wanted(&picture, box);
    if (status == CSGM_OK)
        status = csg_mesh_light_make(&light, &picture, mesh, box, has_ground);
    if (status == CSGM_OK && has_ground)
        status = csg_ground_map_make(&ground, &picture, &light, box);
    if (status == CSGM_OK) {
        const csg_view *view = &picture.view;
        csg_draw draw = {.picture = &picture,
                         .view = view,
                         .mesh = mesh,
                         .ground = &ground,
                         .light = &light,
                         .samples = options->samples,
                         .border = options->edges,
                         .is_clear = is_any_clear(mesh),
                         .nearest = view->nearest,
                         .columns = (options->width + CSG_DRAW_TILE - 1) / CSG_DRAW_TILE,
                         .rows = (options->height + CSG_DRAW_TILE - 1) / CSG_DRAW_TILE};
        if (!view->orthographic && draw.nearest < view->least)
            draw.nearest = view->least;
        status = csg_draw_run(&draw, tile_item, stats);
    }
    csg_ground_map_release(&ground, context);
    csg_mesh_light_release(&light, context);
    stats->trace_s = csg_clock_now_s() - picture.started_s - stats->prepare_s;
    stats->memory_peak_bytes = atomic_load(&context->memory.peak_bytes);
    return csg_picture_end(&picture, status, out);
}
