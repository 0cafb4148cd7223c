/* SPDX-License-Identifier: MIT
 * From scene text to a sealed scene: lex, parse, evaluate. The one door of this layer.
 */
#ifndef CSG_LANG_LANG_H
#define CSG_LANG_LANG_H

#include "scene/scene.h"

typedef struct csg_lang_input {
    const char
        *path; /* file to read, or the name of `text` in diagnostics ("-" for standard input) */
    const char *text; /* NULL = read path */
    size_t text_length;
    const csgm_scene_options *options;   /* NULL = defaults */
    const struct csg_services *services; /* lang/services.h; NULL: no meshes, read or made */
} csg_lang_input;

/* Reports what is wrong through context->diags. *out is set only on CSGM_OK. Status: SYNTAX or
 * SCENE for faults of the input, LIMIT for context->limits, IO for files that cannot be read,
 * MEMORY, ARGUMENT. */
csgm_status csg_lang_compile(csgm_context *context, const csg_lang_input *input, csgm_scene **out);

/* Only parses, applies what is set from outside and lists the parameters (customizer.h). */
csgm_status csg_lang_parameters(csgm_context *context, const csg_lang_input *input,
                                csgm_params **out);
/* Only parses, and only this one text: what it includes and uses is not looked for. */
csgm_status csg_lang_check_syntax(csgm_context *context, const csg_lang_input *input);
void csg_params_destroy(csgm_params *params);

#endif
