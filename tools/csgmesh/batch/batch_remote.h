/* SPDX-License-Identifier: MIT
 * A cache behind HTTP, by the protocol of Bazel's remote caches, so that their servers do: GET and
 * PUT of /cas/SHA256, bytes by their digest, and of /ac/SHA256, messages that name such bytes.
 *
 * A job's files are known once its scene is read. So there are two steps: by program, options and
 * text of the scene a list of the names of files that such scenes read; by these and the digests
 * that they have here, the record of the job and its outputs.
 *
 * A server that cannot be reached, is too slow or answers what makes no sense is told of once; then
 * the batch goes on without it. All that is taken has the size and digest that it should have.
 */
#ifndef CLI_BATCH_REMOTE_H
#define CLI_BATCH_REMOTE_H

#include "batch/batch_run.h"

/* The address of --cache. NULL after a warning. */
batch_remote *batch_remote_open(batch_run *run);
void batch_remote_close(batch_remote *remote);

/* As batch_cache_take and batch_cache_store. */
bool batch_remote_take(batch_run *run, cli_arena *arena, const batch_job *job,
                       const batch_digest *key, batch_record *record);
void batch_remote_store(batch_run *run, cli_arena *arena, const batch_job *job,
                        const batch_record *record);

#endif
