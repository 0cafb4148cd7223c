/* SPDX-License-Identifier: MIT
 * Pictures of the public interface: checks the arguments and calls render.
 */
#include <string.h>

#include "api/options.h"
#include "api/view.h"
#include "render/render.h"

csgm_image_format csgm_image_format_from_path(const char *path)
{
    return path ? csg_image_format_from_path(path) : CSGM_IMAGE_AUTO;
}

bool csgm_image_format_available(csgm_image_format format)
{
    return csg_image_format_available(format);
}

csgm_status csgm_image_create(csgm_context *context, const csgm_image_view *view, csgm_image **out)
{
    if (!out)
        return CSGM_ERR_ARGUMENT;
    *out = NULL;
    if (!context || !view || !view->pixels)
        return CSGM_ERR_ARGUMENT;
    csgm_status status = csg_image_create(context, view->width, view->height, out);
    if (status == CSGM_OK)
        memcpy((*out)->pixels, view->pixels, csg_image_bytes(*out));
    return status;
}

csgm_image_view csgm_image_get_view(const csgm_image *image)
{
    return (csgm_image_view){image->width, image->height, image->pixels};
}

void csgm_image_destroy(csgm_image *image)
{
    csg_image_destroy(image);
}

csgm_status csgm_image_write(csgm_context *context, const csgm_image *image, const char *path,
                             csgm_image_format format)
{
    if (!context || !image || !path || format >= CSGM_IMAGE_FORMAT_COUNT)
        return CSGM_ERR_ARGUMENT;
    return csg_image_write(context, image, path, format);
}

csgm_status csgm_image_write_fd(csgm_context *context, const csgm_image *image, int fd,
                                const char *name, csgm_image_format format)
{
    if (!context || !image || !name || fd < 0 || format >= CSGM_IMAGE_FORMAT_COUNT)
        return CSGM_ERR_ARGUMENT;
    return csg_image_write_fd(context, image, fd, name, format);
}

csgm_render_options csgm_render_options_default(void)
{
    return csg_render_options_default();
}

/* The options to take; NULL where they are of no version that this one knows. */
static const csgm_render_options *options_of(const csgm_render_options *options,
                                             csgm_render_options *own)
{
    *own = csg_render_options_default();
    return csg_options_adopt(own, sizeof *own, options) ? own : NULL;
}

csgm_status csgm_render_scene(csgm_context *context, const csgm_field *field,
                              const csgm_render_options *options, csgm_image **out,
                              csgm_render_stats *stats)
{
    csgm_render_options own;
    csgm_render_stats ignored;
    options = options_of(options, &own);
    if (!out)
        return CSGM_ERR_ARGUMENT;
    *out = NULL;
    if (!context || !field || !options)
        return CSGM_ERR_ARGUMENT;
    return csg_render_scene(context, field, options, out, stats ? stats : &ignored);
}

csgm_status csgm_render_mesh(csgm_context *context, const csgm_mesh_view *mesh,
                             const csgm_render_options *options, csgm_image **out,
                             csgm_render_stats *stats)
{
    csgm_render_options own;
    csgm_render_stats ignored;
    options = options_of(options, &own);
    if (!out)
        return CSGM_ERR_ARGUMENT;
    *out = NULL;
    if (!context || !csg_view_is_sound(mesh) || !options)
        return CSGM_ERR_ARGUMENT;
    return csg_render_mesh(context, mesh, options, out, stats ? stats : &ignored);
}
