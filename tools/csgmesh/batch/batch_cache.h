/* SPDX-License-Identifier: MIT
 * --cache: results that other folders, checkouts and machines share. Nothing is taken whose bytes
 * do not have the digest that they should have, and nothing that goes wrong here is a failure of
 * the batch.
 */
#ifndef CLI_BATCH_CACHE_H
#define CLI_BATCH_CACHE_H

#include "batch/batch_run.h"

/* The outputs of the job are copied from the cache, and the record is theirs. false: it has none
 * that holds; some of the outputs may be there then. */
bool batch_cache_take(batch_run *run, cli_arena *arena, const batch_job *job,
                      const batch_digest *key, batch_record *record);
void batch_cache_store(batch_run *run, cli_arena *arena, const batch_job *job,
                       const batch_record *record);

#endif
