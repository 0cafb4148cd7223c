/* SPDX-License-Identifier: MIT
 * The camera and the summary of csgmesh openscad.
 */
#ifndef CLI_OPENSCAD_PARTS_H
#define CLI_OPENSCAD_PARTS_H

#include "openscad/openscad_line.h"

typedef struct openscad_view {
    csgm_vec3 eye, target, up;
    double height; /* of an orthographic picture, in scene units */
} openscad_view;

/* Degrees, from the top of a picture to its bottom. */
#define OPENSCAD_FOV 22.5

/* Where --camera, --viewall and --autocenter put the camera; box: the solid's. There are camera
 * numbers. */
openscad_view openscad_view_of(const openscad_line *line, csgm_box box);

/* Reads the mesh back and says what --summary and --summary-file ask for. */
int openscad_summarize(cli_app *app, const openscad_line *line, const char *path,
                       const char *format, double seconds);

#endif
