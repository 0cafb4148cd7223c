/* SPDX-License-Identifier: MIT
 * A camera that a command places itself, so that it knows where in its picture a point is.
 */
#ifndef CLI_PICTURE_FRAME_H
#define CLI_PICTURE_FRAME_H

#include "core/cli.h"
#include "render/picture_text.h"

typedef struct cli_frame {
    csgm_vec3 middle, right, up, toward, eye; /* unit vectors at right angles; toward: to the eye */
    double distance;                          /* from the middle to the eye */
    int width, height;                        /* pixels */
} cli_frame;

/* As near as all corners of the box allow. toward: a unit vector not along z. */
cli_frame cli_frame_make(csgm_box box, csgm_vec3 toward, int width, int height);
/* The size and the camera of a picture. */
void cli_frame_aim(const cli_frame *frame, csgm_render_options *out);
/* In pixels from the upper left corner. False: not in the picture. */
bool cli_frame_project(const cli_frame *frame, csgm_vec3 point, int *x, int *y);

/* Where azimuth and elevation look from, in degrees, as those of csgm_camera. Rounded, so that the
 * last bits of a libm are not seen, and never quite along z, so that there is an up. */
csgm_vec3 cli_frame_toward(double azimuth_deg, double elevation_deg);
/* What --view says. False: it is not given. */
bool cli_frame_view(cli_app *app, csgm_vec3 *toward);

/* A picture into the canvas; x, y: of its upper left corner. All of it is within the canvas. */
void cli_canvas_image(cli_canvas *canvas, int x, int y, const csgm_image_view *image);
/* All of the canvas into a file. CSGM_OK, or why not (reported). */
csgm_status cli_canvas_write(cli_app *app, const cli_canvas *canvas, const char *path);

#endif
