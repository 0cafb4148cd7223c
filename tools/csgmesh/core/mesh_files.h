/* SPDX-License-Identifier: MIT
 * Meshes where scenes are asked for, and the reverse.
 */
#ifndef CLI_MESH_FILES_H
#define CLI_MESH_FILES_H

#include "core/cli.h"

/* A mesh by its extension, or by how it begins where the extension says nothing. */
bool cli_path_is_mesh(const char *path);
/* The same of a text that may be a scene's, or a mesh on standard input. */
bool cli_text_is_mesh(const char *text, size_t length);
/* Says what can be done with a mesh that stands for a scene; CLI_INPUT_AT_FAULT. */
int cli_refuse_mesh(cli_app *app, const char *path);

#endif
