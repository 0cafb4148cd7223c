/* SPDX-License-Identifier: MIT
 * SHA-256 by its definition; see batch_sha256.h.
 */
#include "batch/batch_sha256.h"

#include <string.h>

/* The first 32 bits of the fractions of the cube roots of the first 64 primes. */
static const uint32_t rounds[64] = {
    0x428A2F98, 0x71374491, 0xB5C0FBCF, 0xE9B5DBA5, 0x3956C25B, 0x59F111F1, 0x923F82A4, 0xAB1C5ED5,
    0xD807AA98, 0x12835B01, 0x243185BE, 0x550C7DC3, 0x72BE5D74, 0x80DEB1FE, 0x9BDC06A7, 0xC19BF174,
    0xE49B69C1, 0xEFBE4786, 0x0FC19DC6, 0x240CA1CC, 0x2DE92C6F, 0x4A7484AA, 0x5CB0A9DC, 0x76F988DA,
    0x983E5152, 0xA831C66D, 0xB00327C8, 0xBF597FC7, 0xC6E00BF3, 0xD5A79147, 0x06CA6351, 0x14292967,
    0x27B70A85, 0x2E1B2138, 0x4D2C6DFC, 0x53380D13, 0x650A7354, 0x766A0ABB, 0x81C2C92E, 0x92722C85,
    0xA2BFE8A1, 0xA81A664B, 0xC24B8B70, 0xC76C51A3, 0xD192E819, 0xD6990624, 0xF40E3585, 0x106AA070,
    0x19A4C116, 0x1E376C08, 0x2748774C, 0x34B0BCB5, 0x391C0CB3, 0x4ED8AA4A, 0x5B9CCA4F, 0x682E6FF3,
    0x748F82EE, 0x78A5636F, 0x84C87814, 0x8CC70208, 0x90BEFFFA, 0xA4506CEB, 0xBEF9A3F7, 0xC67178F2};

/* The same of the square roots of the first eight. */
static const uint32_t start[8] = {0x6A09E667, 0xBB67AE85, 0x3C6EF372, 0xA54FF53A,
                                  0x510E527F, 0x9B05688C, 0x1F83D9AB, 0x5BE0CD19};

enum { BLOCK = 64, LENGTH_AT = 56 };

static uint32_t turned(uint32_t x, int by)
{
    return x >> by | x << (32 - by);
}

static uint32_t read_word(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

/* d and h become the e and a of the next round. */
static inline void do_round(const uint32_t *a, uint32_t b, uint32_t c, uint32_t *d, uint32_t e,
                            uint32_t f, uint32_t g, uint32_t *h, uint32_t added)
{
    uint32_t one =
        *h + (turned(e, 6) ^ turned(e, 11) ^ turned(e, 25)) + ((e & f) ^ (~e & g)) + added;
    uint32_t two =
        (turned(*a, 2) ^ turned(*a, 13) ^ turned(*a, 22)) + ((*a & b) ^ (*a & c) ^ (b & c));
    *d += one;
    *h = one + two;
}

static void take_block(batch_sha256 *hasher, const uint8_t *block)
{
    uint32_t w[64], s[8];
    for (int i = 0; i < 16; i++)
        w[i] = read_word(block + 4 * i);
    for (int i = 16; i < 64; i++) {
        uint32_t a = w[i - 15], b = w[i - 2];
        w[i] = w[i - 16] + w[i - 7] + (turned(a, 7) ^ turned(a, 18) ^ a >> 3) +
               (turned(b, 17) ^ turned(b, 19) ^ b >> 10);
    }
    memcpy(s, hasher->state, sizeof s);
    /* The eight words go round by their names, not in memory. */
    for (int i = 0; i < 64; i += 8) {
        do_round(&s[0], s[1], s[2], &s[3], s[4], s[5], s[6], &s[7], rounds[i] + w[i]);
        do_round(&s[7], s[0], s[1], &s[2], s[3], s[4], s[5], &s[6], rounds[i + 1] + w[i + 1]);
        do_round(&s[6], s[7], s[0], &s[1], s[2], s[3], s[4], &s[5], rounds[i + 2] + w[i + 2]);
        do_round(&s[5], s[6], s[7], &s[0], s[1], s[2], s[3], &s[4], rounds[i + 3] + w[i + 3]);
        do_round(&s[4], s[5], s[6], &s[7], s[0], s[1], s[2], &s[3], rounds[i + 4] + w[i + 4]);
        do_round(&s[3], s[4], s[5], &s[6], s[7], s[0], s[1], &s[2], rounds[i + 5] + w[i + 5]);
        do_round(&s[2], s[3], s[4], &s[5], s[6], s[7], s[0], &s[1], rounds[i + 6] + w[i + 6]);
        do_round(&s[1], s[2], s[3], &s[4], s[5], s[6], s[7], &s[0], rounds[i + 7] + w[i + 7]);
    }
    for (int i = 0; i < 8; i++)
        hasher->state[i] += s[i];
}

void batch_sha256_begin(batch_sha256 *hasher)
{
    hasher->count = 0;
    memcpy(hasher->state, start, sizeof start);
}

void batch_sha256_add(batch_sha256 *hasher, const void *bytes, size_t count)
{
    const uint8_t *at = bytes;
    while (count) {
        size_t used = hasher->count % BLOCK, room = BLOCK - used;
        size_t taken = count < room ? count : room;
        if (taken == BLOCK) {
            take_block(hasher, at);
        } else {
            memcpy(hasher->block + used, at, taken);
            if (taken == room)
                take_block(hasher, hasher->block);
        }
        hasher->count += taken;
        at += taken;
        count -= taken;
    }
}

void batch_sha256_end(batch_sha256 *hasher, char text[BATCH_SHA256_TEXT])
{
    static const char digits[] = "0123456789abcdef";
    static const uint8_t padding[BLOCK] = {0x80};
    uint64_t bits = hasher->count * 8;
    uint8_t length[8];
    for (int i = 0; i < 8; i++)
        length[i] = (uint8_t)(bits >> (56 - 8 * i));
    size_t used = hasher->count % BLOCK;
    batch_sha256_add(hasher, padding, (used < LENGTH_AT ? LENGTH_AT : LENGTH_AT + BLOCK) - used);
    batch_sha256_add(hasher, length, sizeof length);
    for (int i = 0; i < 64; i++)
        text[i] = digits[hasher->state[i / 8] >> (28 - 4 * (i % 8)) & 15];
    text[64] = '\0';
}

void batch_sha256_of(const void *bytes, size_t count, char text[BATCH_SHA256_TEXT])
{
    batch_sha256 hasher;
    batch_sha256_begin(&hasher);
    batch_sha256_add(&hasher, bytes, count);
    batch_sha256_end(&hasher, text);
}
