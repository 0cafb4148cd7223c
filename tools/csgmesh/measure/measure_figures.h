/* SPDX-License-Identifier: MIT
 * All that is measured of one subject, by groups that are asked for.
 */
#ifndef CLI_MEASURE_FIGURES_H
#define CLI_MEASURE_FIGURES_H

#include "csgmesh/fabrication.h"

/* Groups besides the measures themselves, which are always there. */
enum { CLI_FIGURES_BOX = 1, CLI_FIGURES_FACES = 2, CLI_FIGURES_WALLS = 4 };

typedef struct cli_figures {
    unsigned groups; /* what is there */
    csgm_measures measures;
    csgm_oriented_box box;
    csgm_faces faces;
    csgm_walls walls;
} cli_figures;

/* A scene or a mesh, one of the two. */
typedef struct cli_measured_solid {
    const csgm_field *field; /* NULL: it is a mesh */
    csgm_mesh_view mesh;
} cli_measured_solid;

/* Of what was not measured nothing is known. */
cli_figures cli_figures_unknown(void);
/* How; the part of the first one counts for all. */
typedef struct cli_figure_options {
    csgm_measure_options measures;
    csgm_face_options faces;
    csgm_wall_options walls;
} cli_figure_options;

/* These groups; walls are of scenes alone. Not CSGM_OK: stopped, and what is
 * proven by then is there; or reported. */
csgm_status cli_figures_measure(csgm_context *context, const cli_measured_solid *solid,
                                const cli_figure_options *options, unsigned groups,
                                cli_figures *out);
/* All of them are as close as asked. */
bool cli_figures_are_reached(const cli_figures *figures);

#endif
