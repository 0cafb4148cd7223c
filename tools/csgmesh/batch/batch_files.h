/* SPDX-License-Identifier: MIT
 * Small files, copies, folders and locks. Nothing here reports: false means errno.
 */
#ifndef CLI_BATCH_FILES_H
#define CLI_BATCH_FILES_H

#include "batch/batch_hash.h"
#include "core/arena.h"

/* All folders of the path but the last piece; with the last one too if `whole`. */
bool batch_make_folders(const char *path, bool whole);
/* Appears complete or not at all. */
bool batch_write_small(const char *path, const char *text, size_t length);
/* The whole of a file of at most 16 MiB, terminated, in the arena; NULL with errno. */
char *batch_read_small(cli_arena *arena, const char *path, size_t *length);
/* Copies, and takes the target's name only if the bytes have this digest (else EBADMSG). With
 * `if_changed` a target with these bytes is left alone. */
bool batch_copy(const char *from, const char *to, const batch_digest *digest, bool if_changed,
                bool sync);

/* The lock file of a directory of outputs. One byte says who is there, others stand for jobs; locks
 * end with their process. A file system without locks gives none, and no error. */
typedef struct batch_locks {
    int fd;
    bool alone; /* no other batch is at work in the directory */
} batch_locks;

bool batch_locks_open(batch_locks *locks, const char *path);
void batch_locks_share(batch_locks *locks); /* others may come in */
void batch_locks_close(batch_locks *locks);
/* false: another process is at it (never, when waiting). */
bool batch_lock_job(const batch_locks *locks, const batch_digest *id, bool wait);
void batch_unlock_job(const batch_locks *locks, const batch_digest *id);

#endif
