/* SPDX-License-Identifier: MIT
 * Parameter sets in the JSON of OpenSCAD's customizer:
 *
 *   {"parameterSets": {"small": {"radius": "5", "label": "top"}}, "fileFormatVersion": "1"}
 */
#ifndef CSG_LANG_PARAMETER_SET_H
#define CSG_LANG_PARAMETER_SET_H

#include "lang/parse/ast.h"

/* Replaces the scene's literal assignments by the values of set `name` in the file, which becomes a
 * dependency. */
csgm_status csg_parameter_set_apply(csg_program *program, const char *file, const char *name);

#endif
