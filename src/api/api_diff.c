/* SPDX-License-Identifier: MIT
 * Comparisons of the public interface: checks the arguments and calls diff.
 */
#include <math.h>

#include "api/options.h"
#include "api/view.h"
#include "diff/diff.h"

csgm_diff_options csgm_diff_options_default(void)
{
    return (csgm_diff_options){
        .struct_size = sizeof(csgm_diff_options), .tolerance_volume = INFINITY, .samples = 1 << 18};
}

static bool is_sound(const csgm_diff_options *options)
{
    return options->tolerance >= 0 && options->tolerance_relative >= 0 &&
           options->tolerance_volume >= 0 && options->material <= CSGM_DIFF_REMOVED &&
           options->samples > 0 && options->samples <= UINT32_MAX;
}

csgm_status csgm_diff_meshes(csgm_context *context, const csgm_mesh_view *a,
                             const csgm_mesh_view *b, const csgm_diff_options *options,
                             csgm_diff **out)
{
    csgm_diff_options own = csgm_diff_options_default();
    if (!out)
        return CSGM_ERR_ARGUMENT;
    *out = NULL;
    if (!context || !csg_view_is_sound(a) || !csg_view_is_sound(b) ||
        !csg_options_adopt(&own, sizeof own, options) || !is_sound(&own))
        return CSGM_ERR_ARGUMENT;
    return csg_diff_run(context, a, b, &own, out);
}

void csgm_diff_destroy(csgm_diff *diff)
{
    csg_diff_destroy(diff);
}

const csgm_diff_report *csgm_diff_get_report(const csgm_diff *diff)
{
    return &diff->report;
}

const float *csgm_diff_vertex_distances(const csgm_diff *diff, int side)
{
    return diff->distances[side != 0];
}

void csgm_diff_color(double distance, double most, uint8_t rgb[3])
{
    csg_diff_color(distance, most, rgb);
}

csgm_status csgm_diff_write_heatmap(csgm_context *context, const csgm_diff *diff, int side,
                                    const char *path, csgm_format format,
                                    const csgm_write_options *options)
{
    csgm_write_options own = csgm_write_options_default();
    if (!context || !diff || (side != 0 && side != 1) || !diff->distances[side] || !path ||
        format >= CSGM_FORMAT_COUNT || !csg_options_adopt(&own, sizeof own, options))
        return CSGM_ERR_ARGUMENT;
    return csg_diff_write_heatmap(context, diff, side, path, format, &own);
}
