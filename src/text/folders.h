/* SPDX-License-Identifier: MIT
 * The folders in which include, use and import look for a file that does not stand beside the file
 * that asks: one owner of their order.
 */
#ifndef CSG_TEXT_FOLDERS_H
#define CSG_TEXT_FOLDERS_H

#include "base/context.h"

/* Where to look, for messages. */
#define CSG_FOLDERS_IN_WORDS                                                                       \
    "looked for beside this file, in each -I folder, in CSGMESH_PATH and OPENSCADPATH, and in "    \
    "OpenSCAD's library folders"

/* The name of folder `index` (0 is the first to look in) without its terminator is at most size - 1
 * bytes in buffer, as snprintf has it; 0: there are not so many. options may be NULL. Folders need
 * not exist. */
size_t csg_folder_name(const csgm_scene_options *options, size_t index, char *buffer, size_t size);

/* Where a file is looked for. */
typedef struct csg_folder_search {
    const csgm_context *context; /* is told of each file */
    csg_arena *arena;            /* of the paths */
    bool no_memory;
} csg_folder_search;

/* The path of `name` in a folder (up to length; 0: as it stands) if it can be read. NULL: it
 * cannot, or no_memory is set. */
const char *csg_folder_try(csg_folder_search *search, const char *folder, size_t length,
                           const char *name);
/* The first that can be read in the folders above. */
const char *csg_folders_search(csg_folder_search *search, const csgm_scene_options *options,
                               const char *name);

#endif
