/* SPDX-License-Identifier: MIT
 * The scene as a file, for the page: what csgmesh mesh writes with the same options and the values
 * of the page, byte for byte.
 */
#ifndef CLI_VIEW_FILE_H
#define CLI_VIEW_FILE_H

#include "view/view_build.h"

typedef struct view_file {
    char *bytes; /* from malloc; NULL: there is none */
    size_t length;
    char *problem; /* then, in words; from malloc, NULL: out of memory */
} view_file;

/* The name of a format of meshes or drawings, as it is spelt; NULL: this build writes none such. */
const char *view_file_format(const char *name);
/* Takes as long as csgmesh mesh does; ends early once the store does. */
view_file view_file_make(view_builder *builder, const char *format);

#endif
