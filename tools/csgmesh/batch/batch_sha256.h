/* SPDX-License-Identifier: MIT
 * SHA-256 (FIPS 180-4): the names of what is in Bazel's caches.
 */
#ifndef CLI_BATCH_SHA256_H
#define CLI_BATCH_SHA256_H

#include <stddef.h>
#include <stdint.h>

enum { BATCH_SHA256_TEXT = 65 };

typedef struct batch_sha256 {
    uint32_t state[8];
    uint64_t count; /* bytes so far */
    uint8_t block[64];
} batch_sha256;

void batch_sha256_begin(batch_sha256 *hasher);
void batch_sha256_add(batch_sha256 *hasher, const void *bytes, size_t count);
/* 64 digits and the end. */
void batch_sha256_end(batch_sha256 *hasher, char text[BATCH_SHA256_TEXT]);

/* Of a text in memory. */
void batch_sha256_of(const void *bytes, size_t count, char text[BATCH_SHA256_TEXT]);

#endif
