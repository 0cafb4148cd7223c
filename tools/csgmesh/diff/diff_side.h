/* SPDX-License-Identifier: MIT
 * One operand of `diff`: a mesh file, a scene that is meshed, or nothing (/dev/null).
 */
#ifndef CLI_DIFF_SIDE_H
#define CLI_DIFF_SIDE_H

#include "core/work.h"

typedef struct diff_side {
    const char *path;
    csgm_format format; /* AUTO: a scene, or nothing */
    cli_work work;      /* of a scene */
    csgm_mesh *mesh;    /* of a file */
    csgm_mesh_view view;
} diff_side;

bool diff_path_is_nothing(const char *path); /* as git names a file that is not there */
bool diff_path_is_scene(const char *path);
/* An exit status; failures are reported. Release it either way. */
int diff_side_load(cli_app *app, diff_side *side, const char *path);
void diff_side_release(diff_side *side);
/* Mesh files of one format that say the same wherever they lie. */
bool diff_same_bytes(const char *a, const char *b);
/* Puts B in the place of A, complete or not at all: the file itself where both are of one kind,
 * else its mesh in A's format; `b` may not be loaded yet. An exit status; failures are reported. */
int diff_update(cli_app *app, const char *path_a, diff_side *b, const char *path_b);

#endif
