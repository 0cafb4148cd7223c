/* SPDX-License-Identifier: MIT
 * Scenes of the public interface: text in, sealed tree out, and what one may ask of it.
 */
#include <stdatomic.h>
#include <string.h>

#include "api/options.h"
#include "api/services.h"
#include "base/pool.h"
#include "lang/lang.h"
#include "scene/boxes/bounds.h"
#include "scene/reference.h"
#include "scene/tree/numbers.h"
#include "text/folders.h"

csgm_scene_options csgm_scene_options_default(void)
{
    return (csgm_scene_options){.struct_size = sizeof(csgm_scene_options)};
}

bool csg_scene_options_adopt(csgm_scene_options *options, const csgm_scene_options *given)
{
    *options = csgm_scene_options_default();
    if (!csg_options_adopt(options, sizeof *options, given) ||
        (options->define_count && !options->defines) ||
        (options->include_dir_count && !options->include_dirs) ||
        !options->parameter_file != !options->parameter_set ||
        (options->facets != CSGM_FACETS_ROUND && options->facets != CSGM_FACETS_EXACT) ||
        (uint32_t)options->leniency > CSGM_LENIENT || (uint32_t)options->flat > CSGM_FLAT_KEPT)
        return false;
    for (size_t i = 0; i < options->define_count; i++)
        if (!options->defines[i].name || !options->defines[i].expression)
            return false;
    for (size_t i = 0; i < options->include_dir_count; i++)
        if (!options->include_dirs[i])
            return false;
    return true;
}

csgm_status csgm_scene_parse(csgm_context *context, const char *text, size_t text_length,
                             const char *name, const csgm_scene_options *options, csgm_scene **out)
{
    csgm_scene_options own;
    if (!out)
        return CSGM_ERR_ARGUMENT;
    *out = NULL;
    if (!context || (!text && text_length) || !csg_scene_options_adopt(&own, options))
        return CSGM_ERR_ARGUMENT;
    csg_lang_input input = {.path = name ? name : "text",
                            .text = text ? text : "",
                            .text_length = text_length,
                            .options = &own,
                            .services = csg_api_services()};
    return csg_lang_compile(context, &input, out);
}

csgm_status csgm_scene_load(csgm_context *context, const char *path,
                            const csgm_scene_options *options, csgm_scene **out)
{
    csgm_scene_options own;
    if (!out)
        return CSGM_ERR_ARGUMENT;
    *out = NULL;
    if (!context || !path || !csg_scene_options_adopt(&own, options))
        return CSGM_ERR_ARGUMENT;
    csg_lang_input input = {.path = path, .options = &own, .services = csg_api_services()};
    return csg_lang_compile(context, &input, out);
}

void csgm_scene_destroy(csgm_scene *scene)
{
    csg_scene_destroy(scene);
}

csgm_scene_info csgm_scene_get_info(const csgm_scene *scene)
{
    csgm_scene_info info = {.bounds = csg_bounds_of_solid(scene),
                            .lipschitz = csg_scene_lipschitz(scene),
                            .has_colors = csg_scene_has_colors(scene),
                            .parse_s = scene->parse_s,
                            .evaluate_s = scene->evaluate_s};
    csg_numbers_count(scene, &info.primitive_count, &info.operator_count);
    return info;
}

size_t csgm_scene_folder(const csgm_scene_options *options, size_t index, char *buffer, size_t size)
{
    csgm_scene_options own;
    return csg_folder_name(csg_scene_options_adopt(&own, options) ? &own : NULL, index, buffer,
                           size);
}

const char *csgm_scene_dependency(const csgm_scene *scene, size_t index)
{
    return index < scene->dependency_count ? scene->dependencies[index] : NULL;
}

const csgm_scene *csgm_scene_get_marked(const csgm_scene *scene, csgm_mark mark)
{
    return (unsigned)mark < CSGM_MARK_COUNT ? scene->marked[mark] : NULL;
}

double csgm_scene_eval(const csgm_scene *scene, csgm_vec3 at, csgm_vec3 *gradient)
{
    csgm_status status = CSGM_OK;
    csg_sample sample =
        gradient ? csg_reference_look(scene, at, &status) : csg_reference_eval(scene, at, &status);
    if (status != CSGM_OK)
        sample = (csg_sample){.value = NAN, .gradient = {NAN, NAN, NAN}};
    if (gradient)
        *gradient = sample.gradient;
    return sample.value;
}

/* ---- many points ------------------------------------------------------------------------- */

enum { POINTS_AT_ONCE = 64 };

typedef struct point_job {
    csgm_context *context;
    const csgm_scene *scene;
    const double *points;
    size_t count;
    double *values, *gradients;
    atomic_bool no_memory;
} point_job;

static bool evaluate_points(void *user, uint32_t worker, size_t index)
{
    point_job *job = user;
    csgm_status status = CSGM_OK;
    size_t end =
        (index + 1) * POINTS_AT_ONCE < job->count ? (index + 1) * POINTS_AT_ONCE : job->count;
    if (csg_context_is_cancelled(job->context))
        return false;
    for (size_t i = index * POINTS_AT_ONCE; i < end; i++) {
        const double *p = job->points + 3 * i;
        csg_vec3 at = {p[0], p[1], p[2]};
        csg_sample sample = job->gradients ? csg_reference_look(job->scene, at, &status)
                                           : csg_reference_eval(job->scene, at, &status);
        job->values[i] = sample.value;
        if (job->gradients)
            memcpy(job->gradients + 3 * i, &sample.gradient, sizeof sample.gradient);
    }
    if (status != CSGM_OK)
        atomic_store(&job->no_memory, true);
    return status == CSGM_OK;
}

csgm_status csgm_scene_eval_points(csgm_context *context, const csgm_scene *scene,
                                   const double *points, size_t count, double *values,
                                   double *gradients)
{
    if (!context || !scene || (count && (!points || !values)))
        return CSGM_ERR_ARGUMENT;
    point_job job = {context, scene, points, count, values, gradients, false};
    size_t items = count / POINTS_AT_ONCE + (count % POINTS_AT_ONCE != 0);
    if (csg_pool_run(context->pool, items, evaluate_points, NULL, &job))
        return CSGM_OK;
    return atomic_load(&job.no_memory) ? csg_context_no_memory(context) : CSGM_CANCELLED;
}

uint32_t csgm_scene_active_primitives(const csgm_scene *scene, csgm_vec3 at)
{
    csgm_status status = CSGM_OK;
    uint32_t count = csg_reference_active_primitives(scene, at, &status);
    return status == CSGM_OK ? count : 0;
}
