/* SPDX-License-Identifier: MIT
 * What --stats says of a run of `mesh`. Area, volume, topology and angles come with a mesh that
 * goes by into its file, else from the mesh in memory; where memory has no room for that, and none
 * for going through the file, they are left out, with a warning: a limit ends no run whose files
 * are written.
 */
#ifndef CLI_STATISTICS_H
#define CLI_STATISTICS_H

#include "core/work.h"

typedef struct cli_report {
    csgm_mesh_figures figures;
    uint64_t vertices, triangles;
    double write_s, total_s;
    uint64_t peak_rss_bytes; /* of the work, before the mesh was inspected */
} cli_report;

uint64_t cli_peak_rss_bytes(void);

/* To standard output or the file of --stats. Of a mesh that is not in memory (work->mesh is NULL)
 * the report has the counts. An exit status; failures are reported. */
int cli_statistics_write(cli_app *app, const cli_work *work, cli_report *report);

#endif
