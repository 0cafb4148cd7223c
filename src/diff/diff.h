/* SPDX-License-Identifier: MIT
 * Two meshes in, the report of csgm_diff_report and the distances of vertices out.
 */
#ifndef CSG_DIFF_DIFF_H
#define CSG_DIFF_DIFF_H

#include "base/context.h"

struct csgm_diff {
    csgm_context *context;
    csgm_mesh_view views[2];
    csgm_diff_report report;
    float *distances[2]; /* per vertex of the view, or NULL */
};

/* The options are sound. Failures are reported. */
csgm_status csg_diff_run(csgm_context *context, const csgm_mesh_view *a, const csgm_mesh_view *b,
                         const csgm_diff_options *options, csgm_diff **out);
void csg_diff_destroy(csgm_diff *diff);

void csg_diff_color(double distance, double most, uint8_t rgb[3]);
csgm_status csg_diff_write_heatmap(csgm_context *context, const csgm_diff *diff, int side,
                                   const char *path, csgm_format format,
                                   const csgm_write_options *options);

#endif
