/* SPDX-License-Identifier: MIT
 * The files of an editor's session, each with its names, and the ways between them.
 */
#ifndef CSG_LANG_WORKSPACE_H
#define CSG_LANG_WORKSPACE_H

#include "base/context.h"
#include "lang/edit/names.h"

typedef struct csg_edit_file {
    const char *path; /* as it was asked for */
    char *text;       /* NULL: it cannot be read */
    size_t length;
    bool is_open;                       /* the text is the editor's */
    uint32_t looked;                    /* in which query it was last looked at on the disk */
    uint32_t seen;                      /* by which walk over the files */
    int64_t seconds, nanoseconds, size; /* of the file that was read */
    csg_arena arena;                    /* of names and links */
    csg_edit_pieces pieces;
    csg_edit_names names;
    struct csg_edit_file **links; /* behind each of names.links; NULL: not found */
} csg_edit_file;

struct csgm_workspace {
    csgm_context *context;
    const csgm_scene_options *options;
    csg_arena arena; /* of the paths */
    csg_edit_file **files;
    size_t count, capacity;
    uint32_t query, walk; /* counted */
    bool no_memory;       /* in this query */
    bool is_answering;    /* a callback runs: files stay what they are */
};

/* Files are looked at again from here on. */
void csg_workspace_begin(csgm_workspace *workspace);
/* The file with its text and names as they are now; NULL: no memory. */
csg_edit_file *csg_workspace_file(csgm_workspace *workspace, const char *path);
/* The same of a file that is known already. False: no memory. */
bool csg_workspace_refresh(csgm_workspace *workspace, csg_edit_file *file);
/* What a file includes or uses. */
csg_edit_file *csg_workspace_follow(csgm_workspace *workspace, csg_edit_file *from, uint32_t link);

#endif
