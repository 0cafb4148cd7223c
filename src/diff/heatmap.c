/* SPDX-License-Identifier: MIT
 * Distances as colours: grey where nothing changed, then yellow, orange, red and dark red in equal
 * steps, so that lightness falls all the way and what is far off stands out.
 */
#include <math.h>
#include <stdio.h>

#include "diff/diff.h"
#include "io/formats.h"

void csg_diff_color(double distance, double most, uint8_t rgb[3])
{
    static const double stops[5][3] = {
        {214, 220, 226}, {255, 221, 89}, {250, 138, 36}, {217, 30, 24}, {92, 0, 20}};
    double place = most > 0 && distance > 0 ? 4 * fmin(distance / most, 1) : 0;
    int below = place < 3 ? (int)place : 3;
    for (int k = 0; k < 3; k++) {
        double low = stops[below][k], high = stops[below + 1][k];
        rgb[k] = (uint8_t)(low + (high - low) * (place - below) + 0.5);
    }
}

csgm_status csg_diff_write_heatmap(csgm_context *context, const csgm_diff *diff, int side,
                                   const char *path, csgm_format format,
                                   const csgm_write_options *options)
{
    csgm_mesh_view view = diff->views[side];
    size_t size = (size_t)view.vertex_count * 4;
    uint8_t *colors = csg_memory_alloc(&context->memory, size);
    if (!colors)
        return csg_context_no_memory(context);
    double most = fmax(0, diff->report.distance[side].lower);
    for (uint64_t v = 0; v < view.vertex_count; v++) {
        csg_diff_color((double)diff->distances[side][v], most, colors + 4 * v);
        colors[4 * v + 3] = 255;
    }
    view.colors = colors;
    view.materials = NULL;
    char comment[128];
    snprintf(comment, sizeof comment,
             "distance from the other mesh: 0 is grey (214 220 226), %.9g is dark red (92 0 20)",
             most);
    csgm_write_options with_scale = *options;
    with_scale.comment = comment;
    csgm_status status = csg_io_write(context, &view, path, format, &with_scale);
    csg_memory_release(&context->memory, colors, size);
    return status;
}
