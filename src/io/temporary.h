/* SPDX-License-Identifier: MIT
 * Files that have no name yet. Where the file system can do it they have none at all, so that
 * nothing is left of them when their process is killed, at any moment. Elsewhere, and for the
 * moment in which such a file takes the place of an old one, they have a hidden name beside it:
 *
 *     .csgmesh-HOST-PROCESS-START-NUMBER.tmp
 *
 * and hold a lock, which ends with their process, however that ends. A file of such a name that
 * nobody holds is swept by the next run that writes in the folder. Where locks do not work nothing
 * is swept, nor what another machine has left.
 */
#ifndef CSG_IO_TEMPORARY_H
#define CSG_IO_TEMPORARY_H

#include <stdbool.h>

#include "base/memory.h"

typedef struct csg_temporary {
    int fd;           /* for reading and writing */
    int slot;         /* in the table of names that csg_io_cleanup_pending removes; -1: none */
    bool is_named;    /* the name is that of the file */
    bool is_kept;     /* it stays there under that name until it gets another */
    const char *name; /* hidden, in the target's folder */
} csg_temporary;

/* Beside the target; the name's memory is of the arena. 0, or errno and nothing is open. */
int csg_temporary_open(csg_temporary *file, csg_arena *names, const char *target);
/* The same with a hidden name from the start. */
int csg_temporary_open_named(csg_temporary *file, csg_arena *names, const char *target);
/* One that another process has opened with that hidden name, which must last as long: this one
 * writes to it, too, and an interrupt here removes it. It is never given another name from here. */
int csg_temporary_attach(csg_temporary *file, const char *name);
/* One with a name of the caller's, which must last as long, that stays when it is closed: a later
 * process goes on with it. It is made where it is not there; *was_there tells. */
int csg_temporary_open_kept(csg_temporary *file, const char *name, bool *was_there);
/* Of a file system that writes when a descriptor is closed: such an error must not come after the
 * name. 0 or errno. */
int csg_temporary_flush(const csg_temporary *file);
/* Gives it the target's name, in the place of what had it; is_new: nothing had it. 0 or errno. */
int csg_temporary_rename(csg_temporary *file, const char *target, bool is_new);
/* Closes it; with its hidden name, if it still has that, it is removed. errno of close, or 0. */
int csg_temporary_close(csg_temporary *file);

/* Removes what killed processes have left in the folder; "" is the current one. */
void csg_temporary_sweep(const char *folder);
/* The same, but once in this process. */
void csg_temporary_sweep_once(const char *folder);

#endif
