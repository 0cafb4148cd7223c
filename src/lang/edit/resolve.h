/* SPDX-License-Identifier: MIT
 * What a name means: the definition that holds where it stands.
 */
#ifndef CSG_LANG_RESOLVE_H
#define CSG_LANG_RESOLVE_H

#include "lang/edit/language.h"
#include "lang/edit/workspace.h"

/* A definition in a file, a row of the language (file NULL), or nothing (row NONE too). */
typedef struct csg_edit_target {
    csg_edit_file *file;
    uint32_t name, row;
} csg_edit_target;

static inline bool csg_edit_target_is(csg_edit_target a, csg_edit_target b)
{
    return a.file == b.file && (a.file ? a.name == b.name : a.row == b.row);
}
static inline bool csg_edit_target_exists(csg_edit_target target)
{
    return target.file || target.row != CSG_EDIT_NONE;
}

csg_edit_target csg_edit_resolve_use(csgm_workspace *workspace, csg_edit_file *file, uint32_t use);
/* Of the name or use at the byte; *begin and *end are its place. */
csg_edit_target csg_edit_resolve_at(csgm_workspace *workspace, csg_edit_file *file, uint32_t offset,
                                    uint32_t *begin, uint32_t *end);
/* Fills in what there is to say, in the arena. False: no memory. */
bool csg_edit_describe(csg_arena *arena, csg_edit_target target, csgm_name *out);

/* Each definition that is known in a scope of a file, inner ones first; false ends it. */
typedef bool csg_edit_known_fn(void *user, csg_edit_target target);
void csg_edit_each_known(csgm_workspace *workspace, csg_edit_file *file, uint32_t scope,
                         csg_edit_known_fn *each, void *user);

#endif
