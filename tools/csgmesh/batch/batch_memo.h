/* SPDX-License-Identifier: MIT
 * Digests of the files that scenes read: a library that a thousand scenes include is hashed once a
 * run. For all threads.
 */
#ifndef CLI_BATCH_MEMO_H
#define CLI_BATCH_MEMO_H

#include <pthread.h>

#include "batch/batch_hash.h"
#include "core/arena.h"

typedef struct batch_memo {
    pthread_mutex_t mutex;
    cli_arena arena;
    struct batch_memo_entry **slots;
} batch_memo;

void batch_memo_init(batch_memo *memo);
void batch_memo_release(batch_memo *memo);
/* false: it cannot be read now. */
bool batch_memo_digest(batch_memo *memo, const char *path, batch_digest *out);

#endif
