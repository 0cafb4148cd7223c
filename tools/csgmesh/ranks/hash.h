/* SPDX-License-Identifier: MIT
 * What ranks, and jobs one after the other, compare instead of long texts: FNV-1a (Fowler, Noll and
 * Vo 1991), 64 bits. It tells what differs by mistake, not what somebody has forged.
 */
#ifndef CLI_RANKS_HASH_H
#define CLI_RANKS_HASH_H

#include <stddef.h>
#include <stdint.h>

#define CLI_HASH_BEGIN 14695981039346656037u

static inline uint64_t cli_hash_add(uint64_t hash, const char *text, size_t length)
{
    for (size_t i = 0; i < length; i++)
        hash = (hash ^ (unsigned char)text[i]) * 1099511628211u;
    return hash;
}

#endif
