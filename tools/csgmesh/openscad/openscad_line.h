/* SPDX-License-Identifier: MIT
 * OpenSCAD's command line as a struct.
 */
#ifndef CLI_OPENSCAD_LINE_H
#define CLI_OPENSCAD_LINE_H

#include <string.h>

#include "core/cli.h"

/* The ways in which an output is made. */
typedef enum openscad_way {
    OPENSCAD_MESH, /* or a drawing */
    OPENSCAD_PICTURE,
    OPENSCAD_TREE,
    OPENSCAD_ECHO
} openscad_way;

typedef struct openscad_output {
    const char *path;
    const char *format; /* of -f; NULL: as the name says */
    bool ascii, is_drawing;
    openscad_way way;
} openscad_output;

/* What --summary can look at. */
static inline bool openscad_is_mesh_file(const openscad_output *output)
{
    return output->way == OPENSCAD_MESH && !output->is_drawing && strcmp(output->path, "-") != 0;
}

enum {
    OPENSCAD_SUMMARY_TIME = 1,
    OPENSCAD_SUMMARY_GEOMETRY = 2,
    OPENSCAD_SUMMARY_BOX = 4,
    OPENSCAD_SUMMARY_AREA = 8,
    OPENSCAD_SUMMARY_ALL = 15
};

typedef struct openscad_line {
    const char *scene;
    openscad_output *outputs; /* room for as many as there are arguments */
    size_t output_count;
    cli_list defines;
    const char *parameter_file, *parameter_set, *depfile, *summary_file;
    const char *facets;     /* "exact" */
    const char *background; /* "#ffffe5" */
    bool quiet, hard_warnings, is_rendered, orthographic;
    bool view_all, auto_center;
    double camera[7];
    size_t camera_numbers; /* 0, 6 or 7 */
    uint32_t width, height;
    uint64_t frames; /* of an animation; 0: none */
    uint64_t first_frame, end_frame;
    unsigned summary; /* OPENSCAD_SUMMARY_ */
    bool help, version, info;
} openscad_line;

/* Reads the command line behind `csgmesh openscad`. CLI_DONE, or CLI_TROUBLE after one message. */
int openscad_line_read(cli_app *app, openscad_line *line);
void openscad_line_release(openscad_line *line);

#endif
