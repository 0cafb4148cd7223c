/* SPDX-License-Identifier: MIT
 * The message ActionResult of Bazel's Remote Execution API (build.bazel.remote.execution.v2), as
 * far as it names files by their digests: what servers expect, and may look into, below /ac/.
 */
#ifndef CLI_BATCH_ACTION_H
#define CLI_BATCH_ACTION_H

#include "batch/batch_sha256.h"
#include "core/arena.h"

typedef struct batch_blob {
    char sha256[BATCH_SHA256_TEXT];
    uint64_t bytes;
} batch_blob;

typedef struct batch_action {
    batch_blob *files; /* output_files, in their order */
    size_t count;
} batch_action;

bool batch_action_add(cli_arena *arena, batch_action *action, const batch_blob *blob);
/* The message; NULL: no memory. */
const char *batch_action_print(cli_arena *arena, const batch_action *action, size_t *length);
/* false: it is none, or not of a success. Unknown fields are skipped. */
bool batch_action_parse(cli_arena *arena, const char *bytes, size_t length, batch_action *out);

#endif
