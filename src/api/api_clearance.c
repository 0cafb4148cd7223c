/* SPDX-License-Identifier: MIT
 * Clearances of the public interface.
 */
#include <math.h>

#include "api/options.h"
#include "clearance/clearance.h"
#include "clearance/exhibit.h"
#include "scene/scene.h"

csgm_clear_options csgm_clear_options_default(void)
{
    return (csgm_clear_options){.struct_size = sizeof(csgm_clear_options), .most_pairs = 1 << 20};
}

csgm_status csgm_clearances_create(csgm_context *context, const csgm_clear_options *options,
                                   csgm_clearances **out)
{
    csgm_clear_options own = csgm_clear_options_default();
    if (!out)
        return CSGM_ERR_ARGUMENT;
    *out = NULL;
    if (!context || !csg_options_adopt(&own, sizeof own, options) ||
        !(own.tolerance >= 0 && isfinite(own.tolerance)) ||
        !(own.min_gap >= 0 && isfinite(own.min_gap)) || !own.most_pairs ||
        (own.part_count && !own.parts))
        return CSGM_ERR_ARGUMENT;
    if (!own.parts)
        own.part_count = 0;
    for (size_t i = 0; i < own.part_count; i++)
        if (!own.parts[i])
            return CSGM_ERR_ARGUMENT;
    *out = csg_clearances_create(context, &own);
    return *out ? CSGM_OK : CSGM_ERR_MEMORY;
}

void csgm_clearances_destroy(csgm_clearances *clearances)
{
    csg_clearances_destroy(clearances);
}

csgm_status csgm_clearances_add(csgm_clearances *clearances, const csgm_scene *scene)
{
    if (!clearances || !scene || scene->context != csg_clearances_context(clearances))
        return CSGM_ERR_ARGUMENT;
    return csg_clearances_add(clearances, scene);
}

const csgm_clear_pair *csgm_clearances_get(const csgm_clearances *clearances, size_t index)
{
    return csg_clearances_get(clearances, index);
}

bool csgm_clearances_part(const csgm_clearances *clearances, size_t index, const char **name)
{
    return csg_clearances_part(clearances, index, name);
}

double csgm_clearances_tolerance(const csgm_clearances *clearances)
{
    return csg_clearances_tolerance(clearances);
}

csgm_status csgm_clear_exhibit(csgm_context *context, const csgm_scene *scene,
                               const csgm_clear_pair *pair, int solid, double mark,
                               csgm_scene **out)
{
    if (!out)
        return CSGM_ERR_ARGUMENT;
    *out = NULL;
    if (!context || !scene || scene->context != context || !pair || (solid != 0 && solid != 1) ||
        !(mark >= 0 && isfinite(mark)))
        return CSGM_ERR_ARGUMENT;
    return csg_clear_exhibit(scene, pair, solid, mark, out);
}
