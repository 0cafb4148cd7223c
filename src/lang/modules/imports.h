/* SPDX-License-Identifier: MIT
 * Files that shapes come from: found beside the file that asks, then in
 * the folders of text/folders.h, and counted among the scene's dependencies.
 */
#ifndef CSG_LANG_IMPORTS_H
#define CSG_LANG_IMPORTS_H

#include "lang/modules/shapes.h"

/* The path of the file that an argument names, in the program's arena; NULL after a report. */
const char *csg_import_find(csg_module_call *call, uint32_t index);
/* Counts a file among the scene's dependencies, once; `path` stays valid as long as the program. */
void csg_import_depend(csg_eval *e, const char *path);
/* Letters behind the last dot of a path, in small letters; "" when there is none. */
void csg_import_extension(const char *path, char out[8]);
/* The solid of a .vm tape; arguments as of field(). */
csg_node_id csg_import_tape(csg_module_call *call, const char *path, uint32_t file, uint32_t bounds,
                            uint32_t lipschitz);
/* A flat figure from an SVG or DXF file; layer and origin are arguments. */
csg_node_id csg_import_figure(csg_module_call *call, uint32_t file, uint32_t layer,
                              uint32_t origin);

#endif
