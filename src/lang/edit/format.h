/* SPDX-License-Identifier: MIT
 * The layout of a scene's text: spaces, indentation and blank lines as the scenes of this project
 * have them. Where lines break is the author's affair, but for the braces of blocks. Tokens and
 * comments stay as they are and in their order, which is looked at before anything is handed out.
 */
#ifndef CSG_LANG_FORMAT_H
#define CSG_LANG_FORMAT_H

#include "base/context.h"

/* `sink` gets the whole text in one piece. CSGM_ERR_SYNTAX: no sense in laying it out, what is
 * wrong is reported. name: for findings. */
csgm_status csg_edit_format(csgm_context *context, const char *text, size_t length,
                            const char *name, csgm_text_fn *sink, void *user);

#endif
