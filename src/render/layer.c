/* SPDX-License-Identifier: MIT
 * Fields made ready for rays; see layer.h: their bounds, an octree of short tapes (cells.h), where
 * its cells are in the picture.
 */
#include "render/layer.h"

#include <float.h>
#include <string.h>

#include "base/mesh_codes.h"
#include "field/kernels/dispatch.h"
#include "scene/boxes/bounds.h"

/* ---- bounds ---------------------------------------------------------------------------------- */

static csgm_status clip(csg_layer *layer, csgm_context *context)
{
    if (csg_box_contains_box(layer->bounds, layer->field->bounds))
        return CSGM_OK;
    csgm_status status = csg_field_clip(context, layer->field, layer->bounds, &layer->clipped);
    if (status == CSGM_OK) {
        layer->bounds = csg_box_intersect(layer->bounds, layer->clipped->bounds);
        layer->field = csg_box_is_empty(layer->bounds) ? NULL : layer->clipped;
    }
    return status;
}

csgm_status csg_layer_of_solid(csg_layer *layer, csgm_context *context, const csgm_field *field,
                               const csgm_render_options *options)
{
    layer->bounds = csg_box_is_empty(options->bounds) ? field->bounds : options->bounds;
    if (csg_box_is_empty(layer->bounds))
        return CSGM_OK;
    layer->field = field;
    if (!csg_box_is_empty(options->bounds) && !csg_box_is_finite(options->bounds)) {
        csg_diag_plain(&context->diags, CSG_DIAG_BAD_BOUNDS, NULL, NULL,
                       "the bounds must be finite numbers");
        return CSGM_ERR_ARGUMENT;
    }
    if (!csg_box_is_finite(layer->bounds)) {
        csg_diag_plain(&context->diags, CSG_DIAG_UNBOUNDED, NULL,
                       "give --bounds X0,Y0,Z0,X1,Y1,Z1, or intersect the solid with a cube",
                       "the solid reaches to infinity, so there is no box to draw");
        return CSGM_ERR_SCENE;
    }
    return options->slice_axis >= 0 ? CSGM_OK : clip(layer, context);
}

static csgm_status add_mark(csg_layer *layer, csgm_context *context, const csgm_scene *scene,
                            csg_box bounds)
{
    csgm_status status = csg_field_compile(context, scene, &layer->compiled);
    if (status != CSGM_OK)
        return status;
    layer->bounds = csg_box_is_finite(layer->compiled->bounds)
                        ? csg_box_intersect(layer->compiled->bounds, bounds)
                        : bounds;
    if (csg_box_is_empty(layer->bounds) || !csg_box_is_finite(layer->bounds))
        return CSGM_OK;
    layer->field = layer->compiled;
    return clip(layer, context);
}

csgm_status csg_layers_of_marks(csg_layer layers[CSG_LAYERS], csgm_context *context,
                                const csgm_scene *scene, const csgm_render_options *options)
{
    csgm_status status = CSGM_OK;
    for (int i = 0; i < CSGM_MARK_COUNT && status == CSGM_OK; i++) {
        const csgm_scene *marked = scene ? scene->marked[i] : NULL;
        if (!marked)
            continue;
        csg_box bounds = options->bounds;
        if (csg_box_is_empty(bounds))
            bounds =
                csg_box_is_finite(csg_bounds_of_solid(marked)) ? csg_box_all() : layers[0].bounds;
        status = add_mark(&layers[1 + i], context, marked, bounds);
    }
    return status;
}

/* ---- views ------------------------------------------------------------------------------------
 */

static csg_box moved_box(csg_box box, csg_vec3 by)
{
    return (csg_box){csg_vec3_sub(box.min, by), csg_vec3_sub(box.max, by)};
}

/* How far from the surface a ray may stop: a part of a pixel. Returns the largest in the solid's
 * box. */
static double set_tolerance(csg_layer *layer)
{
    csg_tracer *tracer = &layer->tracer;
    const csg_view *view = &tracer->view;
    csg_box box = moved_box(layer->bounds, layer->field->center);
    double diagonal = csg_vec3_norm(csg_box_size(box)), share = 0.04 * view->pixel;
    double far = csg_vec3_norm(csg_vec3_sub(csg_box_center(box), view->eye)) + diagonal;
    double near = view->orthographic ? share : share * view->nearest;
    tracer->near_tolerance = (float)fmax(near, 64 * (double)FLT_EPSILON * (diagonal + 1e-30));
    tracer->tolerance_slope = view->orthographic ? 0 : (float)share;
    return (double)tracer->near_tolerance + (double)tracer->tolerance_slope * far;
}

/* The octree's depth follows from the size of a pixel where the solid is. */
static csgm_status make_cells(csg_layer *layer, csg_picture *picture)
{
    const csg_view *view = &layer->tracer.view;
    csg_box box = moved_box(layer->bounds, layer->field->center);
    double side = csg_box_longest_side(box);
    double away = csg_vec3_norm(csg_vec3_sub(csg_box_center(box), view->eye));
    double pixels = side / (view->pixel * (view->orthographic ? 1 : fmax(away, 1e-3 * side)));
    int level = 4;
    for (double cell = pixels / 16; cell > 16 && level < 10; cell /= 2)
        level++;
    csg_ray_cells_options options = {.wide = layer->tracer.occlusion || layer->tracer.shadows,
                                     .band = (float)(4 * set_tolerance(layer)) *
                                             layer->field->tape.lipschitz,
                                     .most_level = level,
                                     .cancelled = csg_picture_should_stop,
                                     .user = picture};
    csgm_status status =
        csg_ray_cells_create(picture->context, layer->field, box, &options, &layer->cells);
    return status == CSGM_CANCELLED ? csg_picture_why_stopped(picture) : status;
}

static void set_light(csg_tracer *tracer, const csg_lights *lights, const csg_view *view)
{
    csg_vec3 key = csg_vec3_from_floats(lights->key);
    csg_vec3 u = csg_vec3_normalize(csg_vec3_cross(key, view->right));
    csg_vec3 v = csg_vec3_cross(key, u);
    memcpy(tracer->light, lights->key, sizeof tracer->light);
    const double across[2][3] = {{u.x, u.y, u.z}, {v.x, v.y, v.z}};
    for (int i = 0; i < 2; i++)
        for (int axis = 0; axis < 3; axis++)
            tracer->light_across[i][axis] = (float)across[i][axis];
}

/* The solid's bounds are only known to contain it; the cells of its surface are nearer. */
static csg_box surface_box(const csg_layer *layer)
{
    csg_box box = csg_box_empty();
    for (size_t i = 0; i < layer->cells.count; i++) {
        const csg_ray_cell *cell = &layer->cells.cells[i];
        csg_vec3 c = csg_vec3_from_floats(cell->center);
        if (cell->is_leaf && cell->has_surface)
            box = csg_box_hull(box, csg_box_grow((csg_box){c, c}, (double)cell->half));
    }
    return csg_box_intersect(moved_box(box, csg_vec3_scale(layer->field->center, -1)),
                             layer->bounds);
}

static void set_view(csg_layer *layer, const csg_picture *picture)
{
    csg_tracer *tracer = &layer->tracer;
    tracer->view = picture->view;
    tracer->view.eye = csg_vec3_sub(picture->view.eye, layer->field->center);
    set_light(tracer, &picture->lights, &picture->view);
    set_tolerance(layer);
}

static bool is_any_clear(const csgm_field *field)
{
    for (uint32_t i = 0; i < field->color_count; i++)
        if (field->tape.colors[i].a < 1)
            return true;
    return false;
}

/* Marks are seen through: light and shadow are the solid's. */
static csgm_status make_tracer(csg_layer *layer, csg_picture *picture, bool is_solid)
{
    const csgm_field *field = layer->field;
    layer->tracer = (csg_tracer){
        .kernel = csg_kernel_for(picture->context->isa),
        .field = field,
        .cells = &layer->cells,
        .inverse_lipschitz = 1 / field->tape.lipschitz,
        .occlusion = is_solid && picture->options->occlusion,
        .shadows = is_solid && picture->options->shadows,
        .colors = is_solid && field->has_colors && field->color_count > 1,
    };
    layer->tracer.is_clear = layer->tracer.colors && is_any_clear(field);
    set_view(layer, picture);
    return make_cells(layer, picture);
}

static csgm_status make_rectangles(csg_layer *layer, csgm_context *context)
{
    layer->rectangles =
        csg_memory_alloc(&context->memory, layer->cells.count * sizeof *layer->rectangles);
    if (!layer->rectangles)
        return csg_context_no_memory(context);
    layer->tracer.rectangles = layer->rectangles;
    csg_tracer_find_rectangles(&layer->tracer, layer->rectangles);
    return CSGM_OK;
}

csgm_status csg_layers_prepare(csg_layer layers[CSG_LAYERS], csg_picture *picture)
{
    csgm_status status = CSGM_OK;
    csg_box tight = csg_box_empty();
    for (int i = 0; i < CSG_LAYERS && status == CSGM_OK; i++)
        if (layers[i].field)
            status = make_tracer(&layers[i], picture, i == 0);
    for (int i = 0; i < CSG_LAYERS && status == CSGM_OK; i++)
        if (layers[i].field)
            tight = csg_box_hull(tight, surface_box(&layers[i]));
    if (status == CSGM_OK && !csg_box_is_empty(tight)) {
        status = csg_picture_place(picture, tight);
        for (int i = 0; i < CSG_LAYERS; i++)
            if (layers[i].field) /* tolerances only become smaller: the eye comes nearer */
                set_view(&layers[i], picture);
    }
    for (int i = 0; i < CSG_LAYERS && status == CSGM_OK; i++)
        if (layers[i].field)
            status = make_rectangles(&layers[i], picture->context);
    return status;
}

void csg_layer_release(csg_layer *layer, csgm_context *context)
{
    csg_memory_release(&context->memory, layer->rectangles,
                       layer->cells.count * sizeof *layer->rectangles);
    if (layer->cells.context)
        csg_ray_cells_release(&layer->cells);
    csg_field_destroy(layer->clipped);
    csg_field_destroy(layer->compiled);
}
