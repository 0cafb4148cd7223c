/* SPDX-License-Identifier: MIT
 * The folders in which include, use and import look for a file that does not stand beside the file
 * that asks: one owner of their order.
 */
#ifndef CSG_TEXT_FOLDERS_H
#define CSG_TEXT_FOLDERS_H

#include "base/memory.h"

/* Where to look, for messages. */
#define CSG_FOLDERS_IN_WORDS                                                                       \
    "looked for beside this file, in each -I folder, in CSGMESH_PATH and OPENSCADPATH, and in "    \
    "OpenSCAD's library folders"

/* The name of folder `index` (0 is the first to look in) without its terminator is at most size - 1
 * bytes in buffer, as snprintf has it; 0: there are not so many. options may be NULL. Folders need
 * not exist. */
size_t csg_folder_name(const csgm_scene_options *options, size_t index, char *buffer, size_t size);

/* The path of `name` in a folder (up to length; 0: as it stands) if it can be read, in the arena.
 * NULL: it cannot, or *no_memory is set. */
const char *csg_folder_try(csg_arena *arena, const char *folder, size_t length, const char *name,
                           bool *no_memory);
/* The first that can be read in the folders above. */
const char *csg_folders_search(csg_arena *arena, const csgm_scene_options *options,
                               const char *name, bool *no_memory);

#endif
