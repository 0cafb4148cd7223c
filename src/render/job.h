/* SPDX-License-Identifier: MIT
 * What all kinds of pictures share: the checked options, the view, the image, stopping and
 * progress.
 */
#ifndef CSG_RENDER_JOB_H
#define CSG_RENDER_JOB_H

#include "base/pool.h"
#include "render/render.h"
#include "render/shade.h"

typedef struct csg_picture {
    csgm_context *context;
    const csgm_render_options *options;
    csg_view view; /* in the scene's frame */
    csg_lights lights;
    csg_light_curve *curve;
    csgm_image *image;
    double started_s, deadline_s, last_report_s;
    atomic_bool out_of_memory, timed_out;
} csg_picture;

/* Checks, places the camera by the options' frame or else by `bounds`, makes the image. Reports
 * what fails; the picture must be released either way. */
csgm_status csg_picture_begin(csg_picture *picture, csgm_context *context,
                              const csgm_render_options *options, csg_box bounds);
/* Places the camera anew, by tighter bounds. */
csgm_status csg_picture_place(csg_picture *picture, csg_box bounds);
/* Hands the image out when status is CSGM_OK. */
csgm_status csg_picture_end(csg_picture *picture, csgm_status status, csgm_image **out);

bool csg_picture_should_stop(void *picture); /* any worker */
/* A csg_pool_poll; job: any struct whose first member is the csg_picture pointer. */
void csg_picture_poll(void *job, size_t done, size_t count);
csgm_status csg_picture_why_stopped(csg_picture *picture); /* reported where need be */

/* Rows of pixels, one after the other, as work for the pool. */
static inline uint8_t *csg_picture_pixel(const csg_picture *picture, uint32_t x, uint32_t y)
{
    return picture->image->pixels + 4 * ((size_t)y * picture->image->width + x);
}

/* slice.c */
csgm_status csg_render_slice(csg_picture *picture, const csgm_field *field, csg_box bounds,
                             csgm_render_stats *stats);
/* The view of a section: from the positive side of the axis. */
csgm_camera csg_slice_camera(const csgm_render_options *options);

#endif
