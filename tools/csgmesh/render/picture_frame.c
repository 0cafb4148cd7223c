/* SPDX-License-Identifier: MIT
 * See picture_frame.h.
 */
#include "render/picture_frame.h"

#include <math.h>
#include <string.h>

#include "core/options.h"
#include "render/picture_options.h"

static const double TANGENT = 0.26794919243; /* of 15 degrees, half the angle of view */

static double dot(csgm_vec3 a, csgm_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

cli_frame cli_frame_make(csgm_box box, csgm_vec3 toward, int width, int height)
{
    csgm_vec3 lo = box.min, hi = box.max, n = toward;
    double flat = sqrt(n.x * n.x + n.y * n.y);
    cli_frame f = {.middle = {(lo.x + hi.x) / 2, (lo.y + hi.y) / 2, (lo.z + hi.z) / 2},
                   .right = {-n.y / flat, n.x / flat, 0},
                   .toward = n,
                   .width = width,
                   .height = height};
    f.up = (csgm_vec3){-n.z * n.x / flat, -n.z * n.y / flat, flat};
    for (int i = 0; i < 8; i++) {
        csgm_vec3 corner = {(i & 1 ? hi.x : lo.x) - f.middle.x, (i & 2 ? hi.y : lo.y) - f.middle.y,
                            (i & 4 ? hi.z : lo.z) - f.middle.z};
        double wide = fabs(dot(corner, f.right)) * height / width, high = fabs(dot(corner, f.up));
        f.distance = fmax(f.distance, dot(corner, n) + fmax(wide, high) / TANGENT);
    }
    f.distance = f.distance > 0 ? 1.06 * f.distance : 1;
    f.eye = (csgm_vec3){f.middle.x + f.distance * n.x, f.middle.y + f.distance * n.y,
                        f.middle.z + f.distance * n.z};
    return f;
}

void cli_frame_aim(const cli_frame *frame, csgm_render_options *out)
{
    out->width = (uint32_t)frame->width;
    out->height = (uint32_t)frame->height;
    out->camera.placed = true;
    out->camera.target = frame->middle;
    out->camera.eye = frame->eye;
}

bool cli_frame_project(const cli_frame *f, csgm_vec3 p, int *x, int *y)
{
    csgm_vec3 at = {p.x - f->middle.x, p.y - f->middle.y, p.z - f->middle.z};
    double depth = f->distance - dot(at, f->toward);
    double scale = f->height / 2.0 / (TANGENT * depth);
    double across = f->width / 2.0 + scale * dot(at, f->right);
    double down = f->height / 2.0 - scale * dot(at, f->up);
    if (!(depth > 0) || !(across >= 0 && across < f->width && down >= 0 && down < f->height))
        return false;
    *x = (int)across;
    *y = (int)down;
    return true;
}

csgm_vec3 cli_frame_toward(double azimuth_deg, double elevation_deg)
{
    const double degree = 0.017453292519943295, grid = 1e9, least = 1e-6;
    double azimuth = azimuth_deg * degree, elevation = elevation_deg * degree;
    double level = fmax(round(cos(elevation) * grid) / grid, least);
    return (csgm_vec3){level * round(sin(azimuth) * grid) / grid,
                       -level * round(cos(azimuth) * grid) / grid,
                       round(sin(elevation) * grid) / grid};
}

bool cli_frame_view(cli_app *app, csgm_vec3 *toward)
{
    csgm_camera camera = {.azimuth_deg = 0};
    if (!app->options->view || cli_picture_view(app, &camera) != CLI_DONE)
        return false;
    *toward = cli_frame_toward(camera.azimuth_deg, camera.elevation_deg);
    return true;
}

void cli_canvas_image(cli_canvas *canvas, int x, int y, const csgm_image_view *image)
{
    for (uint32_t row = 0; row < image->height; row++)
        memcpy(canvas->pixels + 4 * (((size_t)y + row) * canvas->width + (size_t)x),
               image->pixels + 4 * (size_t)row * image->width, 4 * (size_t)image->width);
}

csgm_status cli_canvas_write(cli_app *app, const cli_canvas *canvas, const char *path)
{
    csgm_image_view view = {canvas->width, canvas->height, canvas->pixels};
    csgm_image *image = NULL;
    csgm_status status = csgm_image_create(app->context, &view, &image);
    if (status == CSGM_OK)
        status = csgm_image_write(app->context, image, path, CSGM_IMAGE_AUTO);
    csgm_image_destroy(image);
    return status;
}
