/* SPDX-License-Identifier: MIT
 * BLAKE2b hashes, by libb2; the only file that knows it is batch_hash.c. Without the library
 * nothing is known to be up to date.
 */
#ifndef CLI_BATCH_HASH_H
#define CLI_BATCH_HASH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { BATCH_DIGEST_BYTES = 20, BATCH_DIGEST_TEXT = 2 * BATCH_DIGEST_BYTES + 1 };

typedef struct batch_digest {
    uint8_t bytes[BATCH_DIGEST_BYTES];
} batch_digest;

typedef struct batch_hasher {
    uint64_t state[64]; /* of the library's own type */
} batch_hasher;

/* "with libb2 0.98.1 (...)" or "without ...", a line of --version. */
const char *batch_hash_feature(void);
bool batch_hash_available(void);
void batch_hash_begin(batch_hasher *hasher);
void batch_hash_add(batch_hasher *hasher, const void *bytes, size_t count);
/* The text and its length, so that neighbours do not run together. */
void batch_hash_text(batch_hasher *hasher, const char *text);
batch_digest batch_hash_end(batch_hasher *hasher);

/* false with errno set. */
bool batch_hash_path(const char *path, batch_digest *out);
bool batch_digest_equal(const batch_digest *a, const batch_digest *b);
void batch_digest_print(const batch_digest *digest, char text[BATCH_DIGEST_TEXT]);
bool batch_digest_read(const char *text, batch_digest *out);

#endif
