/* SPDX-License-Identifier: MIT
 * Views; see camera.h.
 */
#include "render/camera.h"

#include <stdarg.h>
#include <stdio.h>

#include "base/mesh_codes.h"

enum { AROUND = 32, MOST_CORNERS = 2 * AROUND };

static const double MARGIN = 1.06; /* how much larger the picture is than what it frames */

/* ---- angles ---------------------------------------------------------------------------------- */

/* Taylor series on [0, pi / 4]. */
static double sine_of(double a)
{
    double s = a * a, term = a, sum = 0;
    for (int k = 1; k < 18; k += 2) {
        sum += term;
        term *= -s / ((k + 1) * (k + 2));
    }
    return sum;
}

static double cosine_of(double a)
{
    double s = a * a, term = 1, sum = 0;
    for (int k = 0; k < 18; k += 2) {
        sum += term;
        term *= -s / ((k + 1) * (k + 2));
    }
    return sum;
}

void csg_view_sine_cosine(double angle_deg, double *sine, double *cosine)
{
    const double degree = 3.14159265358979323846 / 180;
    double turns = floor(angle_deg / 360), a = angle_deg - 360 * turns; /* 0 .. 360 */
    int quarter = (int)floor(a / 90);
    double rest = a - 90 * quarter;
    bool upper = rest > 45;
    double s = upper ? cosine_of((90 - rest) * degree) : sine_of(rest * degree);
    double c = upper ? sine_of((90 - rest) * degree) : cosine_of(rest * degree);
    const double sines[4] = {s, c, -s, -c}, cosines[4] = {c, -s, -c, s};
    *sine = sines[quarter & 3];
    *cosine = cosines[quarter & 3];
}

/* ---- checks ---------------------------------------------------------------------------------- */

__attribute__((format(printf, 2, 3))) static csgm_status refuse(csgm_context *context,
                                                                const char *format, ...)
{
    char message[200];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    csg_diag_plain(&context->diags, CSG_DIAG_BAD_PICTURE, NULL, NULL, "%s", message);
    return CSGM_ERR_ARGUMENT;
}

static bool is_finite(csg_vec3 v)
{
    return isfinite(v.x + v.y + v.z);
}

static csgm_status check(csgm_context *context, const csgm_camera *camera)
{
    if (camera->projection == CSGM_PERSPECTIVE && !(camera->fov_deg >= 1 && camera->fov_deg <= 150))
        return refuse(context, "the angle of view is from 1 to 150 degrees, not %g",
                      camera->fov_deg);
    if (!(camera->zoom > 1e-6 && camera->zoom < 1e6))
        return refuse(context, "the zoom is a number from 1e-6 to 1e6, not %g", camera->zoom);
    if (!(camera->height >= 0 && isfinite(camera->height)))
        return refuse(context, "the height of a picture is a length, not %g", camera->height);
    if (!camera->placed && !(fabs(camera->azimuth_deg) <= 1e6))
        return refuse(context, "a camera's azimuth is from -1e6 to 1e6 degrees, not %g",
                      camera->azimuth_deg);
    if (!camera->placed && !(fabs(camera->elevation_deg) <= 90))
        return refuse(context, "a camera's elevation is from -90 to 90 degrees, not %g",
                      camera->elevation_deg);
    if (!camera->placed)
        return CSGM_OK;
    if (!is_finite(camera->eye) || !is_finite(camera->target) || !is_finite(camera->up))
        return refuse(context, "a camera's eye, target and up are finite numbers");
    csg_vec3 to = csg_vec3_sub(camera->target, camera->eye);
    if (!(csg_vec3_norm(to) > 0) || !is_finite(csg_vec3_normalize(to)))
        return refuse(context, "a camera's eye and target are the same point");
    csg_vec3 side = csg_vec3_cross(csg_vec3_normalize(to), csg_vec3_normalize(camera->up));
    if (!(csg_vec3_norm(side) > 1e-9))
        return refuse(context, "a camera's up points along its line of sight");
    return CSGM_OK;
}

/* ---- placing --------------------------------------------------------------------------------- */

static void set_frame(csg_view *view, csg_vec3 forward, csg_vec3 up)
{
    view->forward = csg_vec3_normalize(forward);
    view->right = csg_vec3_normalize(csg_vec3_cross(view->forward, up));
    view->up = csg_vec3_cross(view->right, view->forward);
}

/* What must be seen: the box's corners, or rings around the cylinder that they sweep. */
static size_t corners_of(csg_box box, bool turns, csg_vec3 out[MOST_CORNERS])
{
    csg_vec3 center = csg_box_center(box), size = csg_box_size(box);
    double radius = sqrt(size.x * size.x + size.y * size.y) / 2;
    size_t count = turns ? MOST_CORNERS : 8;
    for (size_t i = 0; i < count; i++) {
        double s, c, z = i & 1 ? box.max.z : box.min.z;
        csg_view_sine_cosine(360.0 * (double)(i / 2) / AROUND, &s, &c);
        out[i] =
            turns ? csg_vec3_make(center.x + c * radius, center.y + s * radius, z)
                  : csg_vec3_make(i & 2 ? box.max.x : box.min.x, i & 4 ? box.max.y : box.min.y, z);
    }
    return count;
}

/* Half the extent of the corners around the target, across and upwards. */
static void extents(const csg_view *view, csg_vec3 target, const csg_vec3 *corners, size_t count,
                    double *across, double *upwards)
{
    *across = *upwards = 0;
    for (size_t i = 0; i < count; i++) {
        csg_vec3 v = csg_vec3_sub(corners[i], target);
        *across = fmax(*across, fabs(csg_vec3_dot(v, view->right)));
        *upwards = fmax(*upwards, fabs(csg_vec3_dot(v, view->up)));
    }
}

/* How far from the target all corners lie within the angles of view. */
static double distance_for(const csg_view *view, csg_vec3 target, const csg_vec3 *corners,
                           size_t count)
{
    double tangent_y = view->pixel * view->height / 2, tangent_x = view->pixel * view->width / 2;
    double distance = 0;
    for (size_t i = 0; i < count; i++) {
        csg_vec3 v = csg_vec3_sub(corners[i], target);
        double before = -csg_vec3_dot(v, view->forward);
        double x = fabs(csg_vec3_dot(v, view->right)), y = fabs(csg_vec3_dot(v, view->up));
        distance = fmax(distance, before + MARGIN * fmax(x / tangent_x, y / tangent_y));
    }
    return distance;
}

static void place(csg_view *view, const csgm_camera *camera, csg_vec3 *target)
{
    if (camera->placed) {
        *target = camera->target;
        view->eye = camera->eye;
        set_frame(view, csg_vec3_sub(camera->target, camera->eye), camera->up);
        return;
    }
    double sa, ca, se, ce;
    csg_view_sine_cosine(camera->azimuth_deg, &sa, &ca);
    csg_view_sine_cosine(camera->elevation_deg, &se, &ce);
    /* up is the derivative by the elevation, so that looking straight down is no special case */
    csg_vec3 back = csg_vec3_make(sa * ce, -ca * ce, se);
    set_frame(view, csg_vec3_scale(back, -1), csg_vec3_make(-sa * se, ca * se, ce));
}

/* The eye and the size of a pixel. */
static void fit(csg_view *view, const csgm_camera *camera, csg_vec3 target, csg_box frame,
                bool turns)
{
    csg_vec3 corners[MOST_CORNERS];
    size_t count = corners_of(frame, turns, corners);
    double diagonal = csg_vec3_norm(csg_box_size(frame)), distance = diagonal;
    if (!(diagonal > 0))
        diagonal = distance = 1;
    if (view->orthographic) {
        double across, upwards;
        extents(view, target, corners, count, &across, &upwards);
        double half = fmax(upwards, across * view->height / view->width) * MARGIN;
        double height = camera->height > 0 ? camera->height : half > 0 ? 2 * half : 1;
        view->pixel = height / (view->height * camera->zoom);
    } else {
        double s, c;
        csg_view_sine_cosine(camera->fov_deg / 2, &s, &c);
        view->pixel = 2 * s / c / view->height;
        distance = fmax(distance_for(view, target, corners, count), 1e-6 * diagonal);
        view->pixel /= camera->zoom;
    }
    if (!camera->placed)
        view->eye = csg_vec3_sub(target, csg_vec3_scale(view->forward, distance));
    view->nearest = INFINITY;
    for (size_t i = 0; i < count; i++)
        view->nearest =
            fmin(view->nearest, csg_vec3_dot(csg_vec3_sub(corners[i], view->eye), view->forward));
    view->nearest -= 1e-3 * diagonal;
    view->least = 1e-4 * diagonal;
    if (!view->orthographic)
        view->nearest = fmax(view->nearest, 0);
}

csgm_status csg_view_make(csgm_context *context, const csgm_camera *camera, csg_box frame,
                          bool turns, uint32_t width, uint32_t height, csg_view *out)
{
    csgm_status status = check(context, camera);
    if (status != CSGM_OK)
        return status;
    *out = (csg_view){
        .orthographic = camera->projection == CSGM_ORTHOGRAPHIC, .width = width, .height = height};
    csg_vec3 target = csg_box_center(frame);
    place(out, camera, &target);
    fit(out, camera, target, frame, turns);
    return CSGM_OK;
}

/* ---- rays and pixels ------------------------------------------------------------------------- */

void csg_view_ray(const csg_view *view, double x, double y, csg_vec3 *origin, csg_vec3 *direction)
{
    double across = (x - view->width / 2) * view->pixel;
    double upwards = (view->height / 2 - y) * view->pixel;
    csg_vec3 shift =
        csg_vec3_add(csg_vec3_scale(view->right, across), csg_vec3_scale(view->up, upwards));
    if (view->orthographic) {
        *direction = view->forward;
        *origin = csg_vec3_add(view->eye,
                               csg_vec3_add(shift, csg_vec3_scale(view->forward, view->nearest)));
        return;
    }
    csg_vec3 to = csg_vec3_add(view->forward, shift);
    *origin = csg_vec3_add(view->eye, csg_vec3_scale(to, view->nearest));
    *direction = csg_vec3_scale(to, 1 / sqrt(csg_vec3_dot(to, to)));
}

csg_vec3 csg_view_project(const csg_view *view, csg_vec3 point)
{
    csg_vec3 v = csg_vec3_sub(point, view->eye);
    double depth = csg_vec3_dot(v, view->forward);
    double scale = 1 / (view->orthographic ? view->pixel : view->pixel * depth);
    return csg_vec3_make(view->width / 2 + csg_vec3_dot(v, view->right) * scale,
                         view->height / 2 - csg_vec3_dot(v, view->up) * scale, depth);
}
