/* SPDX-License-Identifier: MIT
 * Options of pictures; see picture_options.h.
 */
#include "render/picture_options.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/options.h"

/* Exactly `count` finite numbers with commas between. */
static bool read_numbers(const char *text, double *out, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        char *after;
        out[i] = strtod(text, &after);
        bool last = i + 1 == count;
        if (after == text || !isfinite(out[i]) || *after != (last ? '\0' : ','))
            return false;
        text = after + 1;
    }
    return true;
}

static int read_size(cli_app *app, csgm_render_options *out)
{
    const char *text = app->options->size;
    char *after, *end;
    if (!text)
        return CLI_DONE;
    long width = strtol(text, &after, 10);
    long height = *after == 'x' ? strtol(after + 1, &end, 10) : 0;
    if (*text < '0' || *text > '9' || width < 1 || height < 1 || *end || width > UINT32_MAX ||
        height > UINT32_MAX || after[1] < '0' || after[1] > '9')
        return cli_usage_error(app, "as --size 1920x1080", "--size wants WIDTHxHEIGHT, not '%.80s'",
                               text);
    out->width = (uint32_t)width;
    out->height = (uint32_t)height;
    return CLI_DONE;
}

int cli_picture_view(cli_app *app, csgm_camera *camera)
{
    static const struct {
        const char *name;
        double azimuth_deg, elevation_deg;
    } names[] = {{"front", 0, 0}, {"right", 90, 0},   {"back", 180, 0},           {"left", 270, 0},
                 {"top", 0, 90},  {"bottom", 0, -90}, {"corner", 45, 35.26438968}};
    const char *text = app->options->view;
    double angles[2];
    if (!text)
        return CLI_DONE;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(text, names[i].name) == 0) {
            camera->azimuth_deg = names[i].azimuth_deg;
            camera->elevation_deg = names[i].elevation_deg;
            return CLI_DONE;
        }
    if (!read_numbers(text, angles, 2))
        return cli_usage_error(app, "as --view 35,25",
                               "--view wants AZIMUTH,ELEVATION in degrees, or front, right, back, "
                               "left, top, bottom, corner, not '%.80s'",
                               text);
    camera->azimuth_deg = angles[0];
    camera->elevation_deg = angles[1];
    return CLI_DONE;
}

static int read_camera(cli_app *app, csgm_camera *camera)
{
    const cli_options *options = app->options;
    double v[9] = {0, 0, 0, 0, 0, 0, camera->up.x, camera->up.y, camera->up.z};
    if (options->given[CLI_OPTION_fov])
        camera->fov_deg = options->fov;
    if (options->given[CLI_OPTION_zoom])
        camera->zoom = options->zoom;
    camera->height = options->view_height;
    camera->projection = options->projection == 1 ? CSGM_ORTHOGRAPHIC : CSGM_PERSPECTIVE;
    if (camera->height > 0 && camera->projection == CSGM_PERSPECTIVE)
        return cli_usage_error(app, NULL, "--height needs --projection orthographic");
    if (!options->camera)
        return CLI_DONE;
    if (options->view || options->turntable)
        return cli_usage_error(app, NULL, "--camera places the camera, so --%s cannot",
                               options->view ? "view" : "turntable");
    if (!read_numbers(options->camera, v, 6) && !read_numbers(options->camera, v, 9))
        return cli_usage_error(app, "as --camera 100,-200,80,0,0,0",
                               "--camera wants six or nine numbers, not '%.80s'", options->camera);
    camera->placed = true;
    camera->eye = (csgm_vec3){v[0], v[1], v[2]};
    camera->target = (csgm_vec3){v[3], v[4], v[5]};
    camera->up = (csgm_vec3){v[6], v[7], v[8]};
    return CLI_DONE;
}

static int hex_digit(char c)
{
    const char *digits = "0123456789abcdef";
    const char *at = c ? strchr(digits, c >= 'A' && c <= 'F' ? c + 32 : c) : NULL;
    return at ? (int)(at - digits) : -1;
}

/* #rgb, #rrggbb, #rrggbbaa. */
static bool read_hex(const char *text, uint8_t out[4])
{
    size_t length = strlen(text);
    if (*text != '#' || (length != 4 && length != 7 && length != 9))
        return false;
    size_t digits = length == 4 ? 1 : 2;
    out[3] = 255;
    for (size_t i = 0; i < (length - 1) / digits; i++) {
        int high = hex_digit(text[1 + i * digits]), low = hex_digit(text[i * digits + digits]);
        if (high < 0 || low < 0)
            return false;
        out[i] = (uint8_t)(16 * high + low);
    }
    return true;
}

static int read_background(cli_app *app, uint8_t out[4])
{
    const char *text = app->options->background;
    static const struct {
        const char *name, *color;
    } names[] = {
        {"transparent", "#00000000"}, {"white", "#fff"}, {"black", "#000"}, {"gray", "#808080"}};
    for (size_t i = 0; text && i < sizeof names / sizeof *names; i++)
        if (strcmp(text, names[i].name) == 0)
            text = names[i].color;
    if (text && !read_hex(text, out))
        return cli_usage_error(app, "as --background '#f0f0f0'",
                               "--background wants #RRGGBB, #RRGGBBAA, white, black, gray or "
                               "transparent, not '%.80s'",
                               text);
    return CLI_DONE;
}

static int read_slice(cli_app *app, csgm_render_options *out)
{
    const char *text = app->options->slice;
    if (app->options->given[CLI_OPTION_iso] && !text)
        return cli_usage_error(app, NULL, "--iso needs --slice");
    out->iso_step = app->options->iso;
    if (!text)
        return CLI_DONE;
    if (*text < 'x' || *text > 'z' || text[1] != '=' || !read_numbers(text + 2, &out->slice_at, 1))
        return cli_usage_error(app, "as --slice z=10",
                               "--slice wants x=NUMBER, y=NUMBER or z=NUMBER, not '%.80s'", text);
    if (app->options->camera || app->options->view || app->options->turntable)
        return cli_usage_error(app, NULL,
                               "--slice looks along its axis: no --view, --camera or "
                               "--turntable");
    out->slice_axis = *text - 'x';
    return CLI_DONE;
}

static int read_evaluator(cli_app *app, csgm_render_options *out)
{
    const cli_options *options = app->options;
    out->evaluator = options->evaluator == 1 ? CSGM_EVALUATOR_LAZY : CSGM_EVALUATOR_FAST;
    out->lazy = !options->no_lazy;
    out->bounds_used = !options->no_bounds;
    if (out->evaluator == CSGM_EVALUATOR_FAST && (options->no_lazy || options->no_bounds))
        return cli_usage_error(app, NULL, "--%s needs --evaluator lazy",
                               options->no_lazy ? "no-lazy" : "no-bounds");
    if (out->evaluator == CSGM_EVALUATOR_FAST)
        return CLI_DONE;
    if (options->given[CLI_OPTION_bounds])
        return cli_usage_error(app, NULL, "--evaluator lazy draws the whole solid: no --bounds");
    if (!options->given[CLI_OPTION_samples])
        out->samples = 1; /* counts are of one ray per pixel unless asked otherwise */
    return CLI_DONE;
}

int cli_picture_options(cli_app *app, csgm_render_options *out)
{
    const cli_options *options = app->options;
    *out = csgm_render_options_default();
    if (options->given[CLI_OPTION_samples])
        out->samples = (uint32_t)options->samples;
    if (options->given[CLI_OPTION_bounds])
        out->bounds = options->bounds;
    if (options->given[CLI_OPTION_frame])
        out->frame = options->frame;
    out->occlusion = !options->no_occlusion;
    out->shadows = !options->no_shadows;
    out->ground = !options->no_ground;
    out->edges = options->edges;
    out->wireframe = options->wireframe;
    out->flat = options->shading == 1;
    out->turns = options->turntable > 0;
    out->monitor = (csgm_monitor){.progress = cli_console_progress, .user = &app->console};
    int status = read_size(app, out);
    if (status == CLI_DONE)
        status = cli_picture_view(app, &out->camera);
    if (status == CLI_DONE)
        status = read_camera(app, &out->camera);
    if (status == CLI_DONE)
        status = read_background(app, out->background);
    if (status == CLI_DONE)
        status = read_slice(app, out);
    return status == CLI_DONE ? read_evaluator(app, out) : status;
}

int cli_picture_check(cli_app *app, const char *path)
{
    csgm_image_format format = csgm_image_format_from_path(path);
    if (format == CSGM_IMAGE_AUTO)
        return cli_usage_error(app, "use .png or .ppm", "%s is no name of a picture", path);
    if (!csgm_image_format_available(format))
        return cli_usage_error(app, "write a .ppm",
                               "this build cannot write PNG pictures (made without libpng)");
    return CLI_DONE;
}
