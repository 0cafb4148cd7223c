/* SPDX-License-Identifier: MIT
 * The formats of the library in messages and help: lists of those that can do something.
 */
#ifndef CLI_FORMAT_LISTS_H
#define CLI_FORMAT_LISTS_H

#include <stddef.h>

#include "csgmesh/csgmesh.h"

/* The names of all formats with all of these csgm_format_trait bits, `before` each: " .obj .ply".
 */
void cli_formats_list(char *buffer, size_t size, const char *before, uint32_t traits);
/* "flat scenes: svg dxf pdf; formats: obj ply": those that this build writes. */
void cli_formats_of_this_build(char *buffer, size_t size);
/* The titles of all formats with all of these traits: "OBJ, glTF or GLB". Returns the buffer. */
const char *cli_formats_in_words(char *buffer, size_t size, uint32_t traits);

#endif
