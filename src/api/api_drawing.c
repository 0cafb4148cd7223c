/* SPDX-License-Identifier: MIT
 * Drawings of the public interface: what flat scenes are written as.
 */
#include "api/options.h"
#include "io/drawings/drawings.h"
#include "io/formats.h"
#include "scene/scene.h"
#include "shape/plane/clipper.h"

csgm_drawing_format csgm_drawing_format_from_path(const char *path)
{
    return csg_drawing_format_from_path(path);
}

csgm_drawing_format csgm_drawing_format_from_name(const char *name)
{
    return csg_drawing_format_from_name(name);
}

const char *csgm_drawing_format_name(csgm_drawing_format format)
{
    return csg_drawing_format_name(format);
}

bool csgm_drawing_format_available(csgm_drawing_format format)
{
    return (int)format > CSGM_DRAWING_NONE && format < CSGM_DRAWING_COUNT &&
           csg_clipper_available();
}

size_t csgm_scene_layer_count(const csgm_scene *scene)
{
    return scene && scene->drawing ? scene->drawing->count : 0;
}

static bool is_sound(const csgm_context *context, const csgm_scene *scene,
                     csgm_drawing_format format)
{
    return context && csgm_scene_layer_count(scene) > 0 && (int)format > CSGM_DRAWING_NONE &&
           format < CSGM_DRAWING_COUNT;
}

csgm_status csgm_scene_draw(csgm_context *context, const csgm_scene *scene, const char *path,
                            csgm_drawing_format format, const csgm_write_options *options)
{
    csgm_write_options own = csgm_write_options_default();
    if (!is_sound(context, scene, format) || !path || !csg_options_adopt(&own, sizeof own, options))
        return CSGM_ERR_ARGUMENT;
    return csg_io_draw(context, scene->drawing, path, format, &own);
}

csgm_status csgm_scene_draw_fd(csgm_context *context, const csgm_scene *scene, int fd,
                               const char *name, csgm_drawing_format format,
                               const csgm_write_options *options)
{
    csgm_write_options own = csgm_write_options_default();
    if (!is_sound(context, scene, format) || fd < 0 ||
        !csg_options_adopt(&own, sizeof own, options))
        return CSGM_ERR_ARGUMENT;
    return csg_io_draw_fd(context, scene->drawing, fd, name, format, &own);
}
