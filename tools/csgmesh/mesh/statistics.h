/* SPDX-License-Identifier: MIT
 * What --stats says of a run of `mesh`. What needs the whole mesh in memory (area, volume,
 * topology, angles) is left out, with a warning, where memory has no room for it: a limit ends no
 * run whose files are written.
 */
#ifndef CLI_STATISTICS_H
#define CLI_STATISTICS_H

#include "core/work.h"

typedef struct cli_report {
    csgm_mesh_check check; /* where it is_checked */
    bool is_checked;
    uint64_t vertices, triangles;
    double max_abs_field;
    uint64_t vertices_measured; /* for max_abs_field */
    double write_s, total_s;
    uint64_t peak_rss_bytes; /* of the work, before the mesh was inspected */
} cli_report;

uint64_t cli_peak_rss_bytes(void);

/* To standard output or the file of --stats. Of a mesh that is not in memory (work->mesh is NULL)
 * the report has the counts. An exit status; failures are reported. */
int cli_statistics_write(cli_app *app, const cli_work *work, cli_report *report);

#endif
