/* SPDX-License-Identifier: MIT
 * The folders in which include, use and import look for a file that does not stand beside the file
 * that asks: one owner of their order.
 */
#ifndef CSG_TEXT_FOLDERS_H
#define CSG_TEXT_FOLDERS_H

#include "csgmesh/csgmesh.h"

/* Where to look, for messages. */
#define CSG_FOLDERS_IN_WORDS                                                                       \
    "looked for beside this file, in each -I folder, in CSGMESH_PATH and OPENSCADPATH, and in "    \
    "OpenSCAD's library folders"

/* The name of folder `index` (0 is the first to look in) without its terminator is at most size - 1
 * bytes in buffer, as snprintf has it; 0: there are not so many. options may be NULL. Folders need
 * not exist. */
size_t csg_folder_name(const csgm_scene_options *options, size_t index, char *buffer, size_t size);

#endif
