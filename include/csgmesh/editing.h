/* SPDX-License-Identifier: MIT
 *
 * What editors ask of a scene's text. The conventions are those of csgmesh.h.
 */
#ifndef CSGMESH_EDITING_H
#define CSGMESH_EDITING_H

#include "csgmesh/csgmesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- layout ---------------------------------------------------------------------------- */

/* Lays a text out: spaces, indentation and empty lines as the scenes of this project have them;
 * lines break where they did, but at the braces of blocks. Every token and every comment stays as
 * it is, so the scene does too, and laying out twice is laying out once. `sink` gets all of it in
 * one piece. CSGM_ERR_SYNTAX: brackets that do not match, or characters that are none of the
 * language; what stands behind include and use is not read. name: for diagnostics. */
CSGM_API csgm_status csgm_scene_format(csgm_context *context, const char *text, size_t text_length,
                                       const char *name, csgm_text_fn *sink, void *user);

#ifdef __cplusplus
}
#endif
#endif
