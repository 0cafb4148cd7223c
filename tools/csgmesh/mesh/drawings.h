/* SPDX-License-Identifier: MIT
 * Those of the -o files that are drawings of a flat scene: SVG, DXF, PDF.
 */
#ifndef CLI_DRAWINGS_H
#define CLI_DRAWINGS_H

#include "core/cli.h"

/* The format of output `index`; NONE when it is a mesh, or neither its name nor -f says. */
csgm_drawing_format cli_drawings_format(const cli_options *options, size_t index);
/* How many outputs are drawings. */
size_t cli_drawings_count(const cli_options *options);
/* What the scene is asked for: outlines where a drawing is among the outputs, a solid where a mesh
 * or its statistics are. */
csgm_flat cli_drawings_flat(const cli_options *options);
/* The name of a format, of meshes or drawings, as it is spelt; NULL: there is none. */
const char *cli_drawings_or_mesh_name(const char *name);
/* Writes one to a file; an exit status. A scene that has nothing to draw is an error. */
int cli_drawings_write_one(cli_app *app, const csgm_scene *scene, const char *path,
                           csgm_drawing_format format);
/* Writes them; an exit status. */
int cli_drawings_write(cli_app *app, const csgm_scene *scene);

#endif
