/* SPDX-License-Identifier: MIT
 * Meshes as the page's script reads them: the length of a header as four bytes, the header as JSON
 * padded with spaces to a multiple of four, then the arrays that it gives the places of. Everything
 * is little-endian, whatever this machine is.
 */
#ifndef CLI_VIEW_MODEL_H
#define CLI_VIEW_MODEL_H

#include <stddef.h>

#include "csgmesh/csgmesh.h"

typedef struct view_layer {
    const char *kind; /* "solid", "highlight", "background" */
    csgm_mesh_view mesh;
} view_layer;

/* From malloc; NULL: out of memory. */
char *view_model_make(const view_layer *layers, size_t count, size_t *length);

#endif
