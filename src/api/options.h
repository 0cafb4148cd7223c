/* SPDX-License-Identifier: MIT
 * Options as callers give them: of this version or of an older one, whose structs end earlier.
 */
#ifndef CSG_API_OPTIONS_H
#define CSG_API_OPTIONS_H

#include "csgmesh/csgmesh.h"

/* `own` holds the defaults; what the caller's struct has takes their place, what it ends before
 * keeps them. NULL keeps all. false: struct_size is no size that a version of the struct had. */
bool csg_options_adopt(void *own, size_t own_bytes, const void *given);

/* The same for scenes, whose options are checked here, too. */
bool csg_scene_options_adopt(csgm_scene_options *own, const csgm_scene_options *given);

/* The same for meshes: at most one goal of thinning out. */
bool csg_mesh_options_adopt(csgm_mesh_options *own, const csgm_mesh_options *given);

/* Is the struct's size one that a version has had? NULL is. */
bool csg_struct_is_known(const void *given, size_t own_bytes);
/* Fills the caller's struct from ours as far as it goes; its size stays. NULL: nothing. */
void csg_struct_deliver(void *given, const void *own);

/* Is a part of this name, which may be NULL, the one that an option wants? */
bool csg_option_is_name(const char *name, const char *wanted);
/* What is meant by the name of a part: the whole field where it is NULL. NULL: there is no such
 * part. */
const csgm_field *csg_option_part(const csgm_field *field, const char *part);

#endif
