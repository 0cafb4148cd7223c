/* SPDX-License-Identifier: MIT
 * Parameters of the public interface: text in, the list of what may be set out.
 */
#include "api/options.h"
#include "lang/lang.h"
#include "lang/parameters/customizer.h"

csgm_status csgm_params_parse(csgm_context *context, const char *text, size_t text_length,
                              const char *name, const csgm_scene_options *options,
                              csgm_params **out)
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
                            .options = &own};
    return csg_lang_parameters(context, &input, out);
}

csgm_status csgm_params_load(csgm_context *context, const char *path,
                             const csgm_scene_options *options, csgm_params **out)
{
    csgm_scene_options own;
    if (!out)
        return CSGM_ERR_ARGUMENT;
    *out = NULL;
    if (!context || !path || !csg_scene_options_adopt(&own, options))
        return CSGM_ERR_ARGUMENT;
    csg_lang_input input = {.path = path, .options = &own};
    return csg_lang_parameters(context, &input, out);
}

void csgm_params_destroy(csgm_params *params)
{
    csg_params_destroy(params);
}

const csgm_param *csgm_params_get(const csgm_params *params, size_t index)
{
    return index < params->count ? &params->items[index] : NULL;
}
