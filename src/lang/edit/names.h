/* SPDX-License-Identifier: MIT
 * The names of one text: what it defines, where, and what it uses. Made from tokens, not from the
 * tree, so that a text in which somebody is typing has nearly all of them too.
 */
#ifndef CSG_LANG_NAMES_H
#define CSG_LANG_NAMES_H

#include "csgmesh/editing.h"
#include "lang/edit/pieces.h"

/* What is defined. */
typedef struct csg_edit_name {
    uint8_t kind;            /* csgm_name_kind */
    uint32_t offset, length; /* of the name */
    uint32_t begin, end;     /* of the statement, or of the parameter with its default */
    uint32_t scope;          /* where it is known */
    uint32_t owner;          /* PARAMETER: the name of its module or function, or NONE */
    uint32_t value;          /* where its value or default begins; 0 = none */
    uint32_t doc, doc_end;   /* comments that belong to it; both 0 = none */
} csg_edit_name;

typedef enum csg_edit_use_kind {
    CSG_EDIT_USE_MODULE,
    CSG_EDIT_USE_FUNCTION,
    CSG_EDIT_USE_VARIABLE,
    CSG_EDIT_USE_ARGUMENT /* the name before '=' in a call */
} csg_edit_use_kind;

typedef struct csg_edit_use {
    uint8_t kind; /* csg_edit_use_kind */
    uint32_t offset, length;
    uint32_t scope;
    uint32_t callee; /* ARGUMENT: the use that is called, or NONE */
} csg_edit_use;

/* Scope 0 is the file; each other one lies in its parent. */
typedef struct csg_edit_scope {
    uint32_t parent;
    uint32_t begin, end;
} csg_edit_scope;

/* The arguments of a call. */
typedef struct csg_edit_call {
    uint32_t use;        /* what is called, or NONE */
    uint32_t begin, end; /* between the brackets */
} csg_edit_call;

/* include and use. */
typedef struct csg_edit_link {
    uint32_t offset, length; /* of the path, without < and > */
    bool is_use;
} csg_edit_link;

typedef struct csg_edit_names {
    csg_edit_name *names;
    csg_edit_use *uses;
    csg_edit_scope *scopes;
    csg_edit_call *calls;
    csg_edit_link *links;
    uint32_t name_count, use_count, scope_count, call_count, link_count;
} csg_edit_names;

/* Everything goes into the arena. False: no memory. */
bool csg_edit_names_find(csg_arena *arena, const char *text, const csg_edit_pieces *pieces,
                         csg_edit_names *out);

/* The innermost scope that holds the byte. */
uint32_t csg_edit_scope_at(const csg_edit_names *names, uint32_t offset);

#endif
