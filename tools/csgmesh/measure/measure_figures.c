/* SPDX-License-Identifier: MIT
 * Groups of figures; see measure_figures.h.
 */
#include "measure/measure_figures.h"

#include <math.h>

static const csgm_interval UNKNOWN = {-INFINITY, INFINITY};

cli_figures cli_figures_unknown(void)
{
    cli_figures f = {.measures = csgm_measures_default(),
                     .box = csgm_oriented_box_default(),
                     .faces = csgm_faces_default(),
                     .walls = csgm_walls_default()};
    f.walls.wall.length = f.walls.gap.length = UNKNOWN;
    f.box.volume = UNKNOWN;
    for (int k = 0; k < 3; k++)
        f.box.edges[k] = UNKNOWN;
    f.faces.area = f.faces.overhang = f.faces.resting = f.faces.steep = UNKNOWN;
    return f;
}

csgm_status cli_figures_measure(csgm_context *context, const cli_measured_solid *solid,
                                const cli_figure_options *options, unsigned groups,
                                cli_figures *out)
{
    const csgm_measure_options *how = &options->measures;
    csgm_face_options faces = options->faces;
    csgm_wall_options walls = options->walls;
    faces.part = walls.part = how->part;
    *out = cli_figures_unknown();
    csgm_status status = solid->field
                             ? csgm_measure_field(context, solid->field, how, &out->measures)
                             : csgm_measure_mesh(context, &solid->mesh, how, &out->measures);
    if (status == CSGM_OK && (groups & CLI_FIGURES_BOX)) {
        out->groups |= CLI_FIGURES_BOX;
        status = solid->field ? csgm_oriented_box_of_field(context, solid->field, how, &out->box)
                              : csgm_oriented_box_of_mesh(context, &solid->mesh, how, &out->box);
    }
    if (status == CSGM_OK && (groups & CLI_FIGURES_FACES)) {
        out->groups |= CLI_FIGURES_FACES;
        status = solid->field ? csgm_faces_of_field(context, solid->field, &faces, how, &out->faces)
                              : csgm_faces_of_mesh(context, &solid->mesh, &faces, &out->faces);
    }
    if (status == CSGM_OK && (groups & CLI_FIGURES_WALLS) && solid->field) {
        out->groups |= CLI_FIGURES_WALLS;
        status = csgm_walls_of_field(context, solid->field, &walls, &out->walls);
    }
    return status;
}

bool cli_figures_are_reached(const cli_figures *f)
{
    return f->measures.is_reached && (!(f->groups & CLI_FIGURES_BOX) || f->box.is_reached) &&
           (!(f->groups & CLI_FIGURES_WALLS) || f->walls.is_reached);
}
