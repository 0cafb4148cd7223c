/* SPDX-License-Identifier: MIT
 * Hashes of bytes and files; see batch_hash.h.
 */
#include "batch/batch_hash.h"

#ifdef CLI_HAS_BLAKE2
#include <blake2.h>
#endif
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

#ifdef CLI_HAS_BLAKE2

_Static_assert(sizeof(blake2b_state) <= sizeof(batch_hasher), "room for the library's state");

const char *batch_hash_feature(void)
{
    return "with libb2 " CLI_HAS_BLAKE2 " (what is up to date in batches)";
}

bool batch_hash_available(void)
{
    return true;
}

void batch_hash_begin(batch_hasher *hasher)
{
    blake2b_init((blake2b_state *)hasher->state, BATCH_DIGEST_BYTES);
}

void batch_hash_add(batch_hasher *hasher, const void *bytes, size_t count)
{
    blake2b_update((blake2b_state *)hasher->state, bytes, count);
}

batch_digest batch_hash_end(batch_hasher *hasher)
{
    batch_digest digest = {{0}};
    blake2b_final((blake2b_state *)hasher->state, digest.bytes, BATCH_DIGEST_BYTES);
    return digest;
}

#else

const char *batch_hash_feature(void)
{
    return "without libb2 (missing: what is up to date in batches)";
}

bool batch_hash_available(void)
{
    return false;
}

void batch_hash_begin(batch_hasher *hasher)
{
    memset(hasher, 0, sizeof *hasher);
}

void batch_hash_add(batch_hasher *hasher, const void *bytes, size_t count)
{
    (void)hasher, (void)bytes, (void)count;
}

batch_digest batch_hash_end(batch_hasher *hasher)
{
    (void)hasher;
    return (batch_digest){{0}};
}

#endif

void batch_hash_text(batch_hasher *hasher, const char *text)
{
    uint64_t length = strlen(text);
    uint8_t bytes[8];
    for (int i = 0; i < 8; i++)
        bytes[i] = (uint8_t)(length >> 8 * i);
    batch_hash_add(hasher, bytes, sizeof bytes);
    batch_hash_add(hasher, text, length);
}

bool batch_hash_path(const char *path, batch_digest *out)
{
    char buffer[1 << 16];
    batch_hasher hasher;
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0)
        return false;
    batch_hash_begin(&hasher);
    for (;;) {
        ssize_t count = read(fd, buffer, sizeof buffer);
        if (count < 0 && errno == EINTR)
            continue;
        if (count > 0)
            batch_hash_add(&hasher, buffer, (size_t)count);
        if (count == 0)
            *out = batch_hash_end(&hasher);
        if (count <= 0) {
            int reason = errno;
            close(fd);
            errno = reason;
            return count == 0;
        }
    }
}

bool batch_digest_equal(const batch_digest *a, const batch_digest *b)
{
    return memcmp(a->bytes, b->bytes, BATCH_DIGEST_BYTES) == 0;
}

void batch_digest_print(const batch_digest *digest, char text[BATCH_DIGEST_TEXT])
{
    static const char digits[] = "0123456789abcdef";
    for (int i = 0; i < BATCH_DIGEST_BYTES; i++) {
        text[2 * i] = digits[digest->bytes[i] >> 4];
        text[2 * i + 1] = digits[digest->bytes[i] & 15];
    }
    text[BATCH_DIGEST_TEXT - 1] = '\0';
}

static int digit(char c)
{
    return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

bool batch_digest_read(const char *text, batch_digest *out)
{
    for (int i = 0; i < BATCH_DIGEST_BYTES; i++) {
        int high = digit(text[2 * i]), low = high < 0 ? -1 : digit(text[2 * i + 1]);
        if (low < 0)
            return false;
        out->bytes[i] = (uint8_t)(high << 4 | low);
    }
    return true;
}
