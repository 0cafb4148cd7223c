/* SPDX-License-Identifier: MIT
 * A hash table from paths to digests; see batch_memo.h. Two threads that miss at once both read the
 * file: cheaper than making them wait.
 */
#include "batch/batch_memo.h"

#include <string.h>

typedef struct batch_memo_entry {
    struct batch_memo_entry *next;
    const char *path;
    batch_digest digest;
} batch_memo_entry;

enum { SLOTS = 4096 };

void batch_memo_init(batch_memo *memo)
{
    *memo = (batch_memo){.slots = NULL};
    pthread_mutex_init(&memo->mutex, NULL);
    memo->slots = cli_arena_alloc(&memo->arena, SLOTS * sizeof(batch_memo_entry *));
}

void batch_memo_release(batch_memo *memo)
{
    pthread_mutex_destroy(&memo->mutex);
    cli_arena_reset(&memo->arena);
}

static size_t slot_of(const char *path)
{
    uint32_t hash = 2166136261u; /* FNV-1a */
    for (; *path; path++)
        hash = (hash ^ (uint8_t)*path) * 16777619u;
    return hash % SLOTS;
}

static bool find(batch_memo *memo, const char *path, batch_digest *out)
{
    for (const batch_memo_entry *e = memo->slots[slot_of(path)]; e; e = e->next)
        if (strcmp(e->path, path) == 0) {
            *out = e->digest;
            return true;
        }
    return false;
}

bool batch_memo_digest(batch_memo *memo, const char *path, batch_digest *out)
{
    if (!memo->slots)
        return batch_hash_path(path, out);
    pthread_mutex_lock(&memo->mutex);
    bool known = find(memo, path, out);
    pthread_mutex_unlock(&memo->mutex);
    if (known)
        return true;
    if (!batch_hash_path(path, out))
        return false;
    pthread_mutex_lock(&memo->mutex);
    batch_memo_entry *entry = cli_arena_alloc(&memo->arena, sizeof *entry);
    if (entry) {
        batch_memo_entry **slot = &memo->slots[slot_of(path)];
        *entry = (batch_memo_entry){*slot, cli_arena_strdup(&memo->arena, path), *out};
        if (*entry->path) /* else there was no memory */
            *slot = entry;
    }
    pthread_mutex_unlock(&memo->mutex);
    return true;
}
