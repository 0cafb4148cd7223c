/* SPDX-License-Identifier: MIT
 * From the camera of the options and a box to a view: rays through pixels, and points to pixels.
 * Everything in the scene's frame, in double; pixel coordinates from the upper left corner, y down.
 * Angles go through polynomials, not libm, so that a picture is the same on every machine.
 */
#ifndef CSG_RENDER_CAMERA_H
#define CSG_RENDER_CAMERA_H

#include "base/context.h"
#include "base/geometry.h"

typedef struct csg_view {
    csg_vec3 eye, right, up, forward; /* unit, at right angles */
    bool orthographic;
    double pixel;         /* side of a pixel: at distance 1; orthographic: in scene units */
    double width, height; /* of the picture, in pixels */
    double nearest;       /* along forward: nothing of the framed box is nearer; >= 0 */
    double least; /* a distance that counts as none: what is drawn of triangles lies beyond it */
} csg_view;

/* Checks the camera (reports, CSGM_ERR_ARGUMENT) and places it so that `frame`, which is finite and
 * not empty, fits. turns: it must fit from any azimuth (turntables). */
csgm_status csg_view_make(csgm_context *context, const csgm_camera *camera, csg_box frame,
                          bool turns, uint32_t width, uint32_t height, csg_view *out);

/* Through a pixel coordinate; *direction is a unit vector, and so is *origin's lead: the ray begins
 * where the view's nearest plane is. */
void csg_view_ray(const csg_view *view, double x, double y, csg_vec3 *origin, csg_vec3 *direction);

/* Pixel coordinates and the distance along forward. */
csg_vec3 csg_view_project(const csg_view *view, csg_vec3 point);

/* Sine and cosine of an angle in degrees, error below 1e-15. */
void csg_view_sine_cosine(double angle_deg, double *sine, double *cosine);

#endif
