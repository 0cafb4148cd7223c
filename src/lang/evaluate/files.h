/* SPDX-License-Identifier: MIT
 * Files that values and shapes come from: found beside the file that asks, then in the folders of
 * text/folders.h, and counted among the scene's dependencies.
 */
#ifndef CSG_LANG_FILES_H
#define CSG_LANG_FILES_H

#include "lang/evaluate/evaluator.h"

/* The path of a file that can be read, in the program's arena, counted as read; NULL: there is
 * none (not reported), or memory ran out. `asking`: where it is asked for. */
const char *csg_file_find(csg_eval *e, const char *name, csg_span asking);
/* Counts a file among the scene's dependencies, once; `path` stays valid as long as the program. */
void csg_file_depend(csg_eval *e, const char *path);
/* Letters behind the last dot of a path, in small letters; "" when there is none. */
void csg_file_extension(const char *path, char out[8]);

#endif
