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

/* ---- names ----------------------------------------------------------------------------- */

/* The texts that an editor has open and those that they include and use, with their names. A text
 * in which somebody is typing need not be right. Files are read when they are asked for, and again
 * when they have changed. Offsets count bytes. A workspace belongs to one thread at a time. */
typedef struct csgm_workspace csgm_workspace;

/* options: where includes are looked for; borrowed until the workspace is destroyed; NULL =
 * defaults. */
CSGM_API csgm_status csgm_workspace_create(csgm_context *context, const csgm_scene_options *options,
                                           csgm_workspace **out);
CSGM_API void csgm_workspace_destroy(csgm_workspace *workspace);

/* From here on the text of this file is this one (copied), whatever is on the disk. */
CSGM_API csgm_status csgm_workspace_open(csgm_workspace *workspace, const char *path,
                                         const char *text, size_t text_length);
/* It is that of the disk again. */
CSGM_API void csgm_workspace_close(csgm_workspace *workspace, const char *path);
/* The text of a file, until the next call; the only call that may be made from a callback of one
 * below. NULL: there is none that can be read. */
CSGM_API const char *csgm_workspace_text(csgm_workspace *workspace, const char *path,
                                         size_t *text_length);

/* What a name stands for. */
typedef enum csgm_name_kind {
    CSGM_NAME_MODULE,
    CSGM_NAME_FUNCTION,
    CSGM_NAME_VARIABLE,
    CSGM_NAME_PARAMETER,
    CSGM_NAME_KEYWORD
} csgm_name_kind;

/* Bytes of a text. */
typedef struct csgm_text_range {
    uint32_t begin, end;
} csgm_text_range;

/* Something that has a name. Strings are valid during the callback. */
typedef struct csgm_name {
    csgm_name_kind kind;
    const char *name;
    const char *signature;             /* "module wheel(r, width = 3)" */
    const csgm_text_range *parameters; /* where they stand in the signature */
    uint32_t parameter_count;
    const char *documentation; /* the comments at its definition, or the manual's words; or NULL */
    const char *path;          /* of the file that defines it; NULL = the language */
    uint32_t begin, end;       /* of the name in that file */
    uint32_t whole_begin, whole_end; /* of the statement */
    uint32_t depth;                  /* definitions that it lies in; of a list only */
    bool takes_children;             /* of a module: something stands behind its call */
    bool is_value;                   /* of a completion: a value stands there, not a statement */
} csgm_name;

/* false = that is enough. */
typedef bool csgm_name_fn(void *user, const csgm_name *name);

/* Everything that a file defines, in its order. */
CSGM_API csgm_status csgm_workspace_list(csgm_workspace *workspace, const char *path,
                                         csgm_name_fn *each, void *user);
/* What the name at the place is: the definition that holds there, by way of includes and uses. */
CSGM_API csgm_status csgm_workspace_find(csgm_workspace *workspace, const char *path,
                                         uint32_t offset, csgm_name_fn *each, void *user);
/* The places where that name stands, in all files that the workspace knows; begin and end are those
 * of the place. The definition comes first. */
CSGM_API csgm_status csgm_workspace_uses(csgm_workspace *workspace, const char *path,
                                         uint32_t offset, csgm_name_fn *each, void *user);
/* What could stand at the place, beginning as the name before it does, whatever the case; at most
 * `most`. *is_complete: there was no more. */
CSGM_API csgm_status csgm_workspace_complete(csgm_workspace *workspace, const char *path,
                                             uint32_t offset, uint32_t most, csgm_name_fn *each,
                                             void *user, bool *is_complete);
/* What is called at the place, and which of its parameters comes there (from 0; beyond them: none
 * does). */
CSGM_API csgm_status csgm_workspace_call(csgm_workspace *workspace, const char *path,
                                         uint32_t offset, csgm_name_fn *each, void *user,
                                         uint32_t *parameter);

/* A colour that the text of a file names. */
typedef struct csgm_text_color {
    uint32_t begin, end;            /* of the string, with its quotes */
    double red, green, blue, alpha; /* 0 .. 1, sRGB */
} csgm_text_color;
typedef bool csgm_text_color_fn(void *user, const csgm_text_color *color);
CSGM_API csgm_status csgm_workspace_colors(csgm_workspace *workspace, const char *path,
                                           csgm_text_color_fn *each, void *user);

/* What may be folded: blocks, brackets and comments over several lines. Lines count from 0. */
typedef struct csgm_fold {
    uint32_t first_line, last_line;
    bool is_comment;
} csgm_fold;
typedef bool csgm_fold_fn(void *user, const csgm_fold *fold);
CSGM_API csgm_status csgm_workspace_folds(csgm_workspace *workspace, const char *path,
                                          csgm_fold_fn *each, void *user);

#ifdef __cplusplus
}
#endif
#endif
