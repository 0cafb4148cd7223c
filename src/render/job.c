/* SPDX-License-Identifier: MIT
 * Begin, watch and end of a picture; see job.h.
 */
#include "render/job.h"

#include "base/clock.h"
#include "base/mesh_codes.h"

enum { MOST_SAMPLES = 8 };

csgm_render_options csg_render_options_default(void)
{
    return (csgm_render_options){
        .struct_size = sizeof(csgm_render_options),
        .width = 1280,
        .height = 960,
        .samples = 3,
        .camera = {.projection = CSGM_PERSPECTIVE,
                   .fov_deg = 30,
                   .azimuth_deg = 35,
                   .elevation_deg = 25,
                   .up = {0, 0, 1},
                   .zoom = 1},
        .frame = csg_box_empty(),
        .background = {255, 255, 255, 255},
        .occlusion = true,
        .shadows = true,
        .bounds = csg_box_empty(),
        .slice_axis = -1,
        .lazy = true,
        .bounds_used = true,
        .ground = true,
    };
}

static csgm_status refuse(csgm_context *context, const char *what)
{
    csg_diag_plain(&context->diags, CSG_DIAG_BAD_PICTURE, NULL, NULL, "%s", what);
    return CSGM_ERR_ARGUMENT;
}

static csgm_status check(csgm_context *context, const csgm_render_options *options)
{
    if (options->samples < 1 || options->samples > MOST_SAMPLES)
        return refuse(context, "samples are from 1 to 8: so many along each side of a pixel");
    if (!(options->iso_step >= 0 && isfinite(options->iso_step)))
        return refuse(context, "the step between iso-lines is a positive number");
    if (options->slice_axis < -1 || options->slice_axis > 2 || !isfinite(options->slice_at))
        return refuse(context, "a section is at a finite place on the axis x, y or z");
    if (!csg_box_is_empty(options->frame) && !csg_box_is_finite(options->frame))
        return refuse(context, "what the camera frames must be finite");
    return CSGM_OK;
}

csgm_status csg_picture_place(csg_picture *picture, csg_box bounds)
{
    const csgm_render_options *options = picture->options;
    csgm_camera camera = options->slice_axis >= 0 ? csg_slice_camera(options) : options->camera;
    csg_box frame = csg_box_is_empty(options->frame) ? bounds : options->frame;
    if (csg_box_is_empty(frame))
        frame = (csg_box){{-1, -1, -1}, {1, 1, 1}};
    csgm_status status = csg_view_make(picture->context, &camera, frame, options->turns,
                                       options->width, options->height, &picture->view);
    if (status == CSGM_OK)
        picture->lights = csg_lights_make(&picture->view);
    return status;
}

csgm_status csg_picture_begin(csg_picture *picture, csgm_context *context,
                              const csgm_render_options *options, csg_box bounds)
{
    *picture =
        (csg_picture){.context = context, .options = options, .started_s = csg_clock_now_s()};
    if (context->limits.timeout_s > 0)
        picture->deadline_s = picture->started_s + context->limits.timeout_s;
    csgm_status status = check(context, options);
    if (status == CSGM_OK)
        status = csg_picture_place(picture, bounds);
    if (status == CSGM_OK)
        status = csg_image_create(context, options->width, options->height, &picture->image);
    if (status != CSGM_OK)
        return status;
    picture->curve = csg_memory_alloc(&context->memory, sizeof *picture->curve);
    if (!picture->curve)
        return csg_context_no_memory(context);
    csg_light_curve_make(picture->curve);
    return CSGM_OK;
}

csgm_status csg_picture_end(csg_picture *picture, csgm_status status, csgm_image **out)
{
    csg_memory_release(&picture->context->memory, picture->curve, sizeof *picture->curve);
    if (status == CSGM_OK)
        *out = picture->image;
    else
        csg_image_destroy(picture->image);
    return status;
}

/* ---- watching -------------------------------------------------------------------------------- */

bool csg_picture_should_stop(void *user)
{
    csg_picture *picture = user;
    const csgm_monitor *monitor = &picture->options->monitor;
    if (csg_context_is_cancelled(picture->context) ||
        (monitor->cancelled && monitor->cancelled(monitor->user)))
        return true;
    if (picture->deadline_s > 0 && csg_clock_now_s() > picture->deadline_s) {
        atomic_store(&picture->timed_out, true);
        return true;
    }
    return false;
}

void csg_picture_poll(void *job, size_t done, size_t count)
{
    enum { REPORTS_PER_SECOND = 20 };
    csg_picture *picture = *(csg_picture **)job;
    const csgm_monitor *monitor = &picture->options->monitor;
    double now = csg_clock_now_s();
    if (!monitor->progress || now - picture->last_report_s < 1.0 / REPORTS_PER_SECOND)
        return;
    picture->last_report_s = now;
    monitor->progress(monitor->user, CSGM_STAGE_RENDER, (double)done / (double)count);
}

csgm_status csg_picture_why_stopped(csg_picture *picture)
{
    if (atomic_load(&picture->out_of_memory))
        return csg_context_no_memory(picture->context);
    if (!atomic_load(&picture->timed_out))
        return CSGM_CANCELLED;
    csg_diag_plain(&picture->context->diags, CSG_DIAG_TIMEOUT, NULL,
                   "raise --timeout, or draw a smaller picture",
                   "drawing took longer than the limit of %g s",
                   picture->context->limits.timeout_s);
    return CSGM_ERR_LIMIT;
}
