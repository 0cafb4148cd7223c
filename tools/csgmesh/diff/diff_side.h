/* SPDX-License-Identifier: MIT
 * One operand of `diff`: a mesh file, a scene that is meshed, or nothing (/dev/null).
 */
#ifndef CLI_DIFF_SIDE_H
#define CLI_DIFF_SIDE_H

#include "core/work.h"

typedef enum diff_compression {
    DIFF_PLAIN,
    DIFF_DRACO,
    DIFF_MESHOPT,
    DIFF_MESHOPT_KHR
} diff_compression;

typedef struct diff_side {
    const char *path;
    csgm_format format; /* AUTO: a scene, or nothing */
    cli_work work;      /* of a scene */
    csgm_mesh *mesh;    /* of a file, or a scene's as a file of the other's format has it */
    csgm_mesh_view view;
    csgm_format as;               /* of a scene: the other's format, AUTO: none */
    csgm_normals normals;         /* of a scene: as the other is thought to have them */
    diff_compression compression; /* of the other, which is glTF */
} diff_side;

bool diff_path_is_nothing(const char *path); /* as git names a file that is not there */
bool diff_path_is_scene(const char *path);
/* Reads a mesh, or loads a scene. An exit status; failures are reported. Release it either way. */
int diff_side_open(cli_app *app, diff_side *side, const char *path, const char *other);
/* A scene is meshed as the other file may have been made: in its format, with the normals that are
 * usual there. Nothing else is changed. */
int diff_side_mesh(cli_app *app, diff_side *side);
/* Meshes a scene again, as a file with one normal for each place. false: there is nothing else that
 * the file could have been. *status: an exit status. */
bool diff_side_mesh_otherwise(cli_app *app, diff_side *side, int *status);
/* The same with colours, for a file of a format without them: they keep triangles from being
 * thinned out across their borders, so a file that was made beside one with colours has others. */
bool diff_side_mesh_with_looks(cli_app *app, diff_side *side, int *status);
void diff_side_release(diff_side *side);
/* Mesh files of one format that say the same wherever they lie. */
bool diff_same_bytes(const char *a, const char *b);
/* Puts B in the place of A, complete or not at all: the file itself where both are of one kind,
 * else its mesh in A's format; `b` may not be loaded yet. An exit status; failures are reported. */
int diff_update(cli_app *app, const char *path_a, diff_side *b, const char *path_b);

#endif
