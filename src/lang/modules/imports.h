/* SPDX-License-Identifier: MIT
 * Files that shapes come from (evaluate/files.h).
 */
#ifndef CSG_LANG_IMPORTS_H
#define CSG_LANG_IMPORTS_H

#include "lang/modules/shapes.h"

/* The path of the file that an argument names, in the program's arena; NULL after a report. */
const char *csg_import_find(csg_module_call *call, uint32_t index);
/* The solid of a .vm tape; arguments as of field(). */
csg_node_id csg_import_tape(csg_module_call *call, const char *path, uint32_t file, uint32_t bounds,
                            uint32_t lipschitz);
/* A flat figure from an SVG or DXF file; layer and origin are arguments. */
csg_node_id csg_import_figure(csg_module_call *call, uint32_t file, uint32_t layer,
                              uint32_t origin);

#endif
