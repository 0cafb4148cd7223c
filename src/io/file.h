/* SPDX-License-Identifier: MIT
 * Files that appear complete or not at all: the bytes go to a temporary file (temporary.h), are
 * synced, and take the target's name. Devices, pipes and descriptors are written directly.
 */
#ifndef CSG_IO_FILE_H
#define CSG_IO_FILE_H

#include "base/context.h"
#include "io/temporary.h"

typedef struct csg_atomic_file {
    csgm_context *context;
    csg_arena names;
    const char *path;   /* as given, for diagnostics; borrowed */
    const char *target; /* links followed; NULL = written directly */
    csg_temporary temporary;
    int fd;
    bool sync; /* on the disk before it gets its name; true unless changed before the commit */
    bool only_if_changed; /* a target with these bytes stays as it is; set before the commit */
    bool is_new;          /* nothing has had the target's name */
    bool is_shared;       /* other processes write to it, too: it has a hidden name at once */
} csg_atomic_file;

/* Each reports its own failure (CSGM_ERR_IO or CSGM_ERR_MEMORY) and then holds nothing. */
csgm_status csg_file_create(csg_atomic_file *file, csgm_context *context, const char *path);
/* The same for one that other processes attach to by file->temporary.name. Devices are none. */
csgm_status csg_file_create_shared(csg_atomic_file *file, csgm_context *context, const char *path);
/* The same with the name `kept`, where the file stays when it is abandoned: *was_there, it was
 * there already, and goes on with what it has. */
csgm_status csg_file_create_kept(csg_atomic_file *file, csgm_context *context, const char *path,
                                 const char *kept, bool *was_there);
/* In those processes: to be flushed, then abandoned; the one that has created it commits it. `path`
 * is for diagnostics. */
csgm_status csg_file_attach(csg_atomic_file *file, csgm_context *context, const char *path,
                            const char *name, bool is_kept);
/* What this process has written is where others find it. Reports what fails. */
csgm_status csg_file_flush(csg_atomic_file *file);
/* Syncs, closes and renames; on failure the temporary is removed and an old target untouched. Where
 * the context holds files the name waits. */
csgm_status csg_file_commit(csg_atomic_file *file);
/* Closes and removes the temporary. */
void csg_file_abandon(csg_atomic_file *file);

/* A file that is named by another one, stands beside it and gets its name together with it. */
typedef struct csg_companion {
    csg_atomic_file file;
    csg_arena names;     /* has the path */
    bool is_there;       /* file holds something */
    const int *nameless; /* instead: a file that is open and has no name */
} csg_companion;

/* From now on files of this context that are complete wait for their names; pipes and devices do
 * not. */
void csg_files_hold(csgm_context *context);
/* keep: they get their names, in the order in which they were written, or from the first on that
 * cannot have its name (reported) they are removed. Else all are removed. */
csgm_status csg_files_release(csgm_context *context, bool keep);

#endif
