/* SPDX-License-Identifier: MIT
 * A list with an open hash table of its paths beside it; see looked.h.
 */
#include "core/looked.h"

#include <stdlib.h>
#include <string.h>

uint64_t cli_looked_hash(uint64_t hash, const char *text)
{
    hash = hash ? hash : 0xcbf29ce484222325u;
    for (; *text; text++)
        hash = (hash ^ (unsigned char)*text) * 0x100000001b3u;
    return hash;
}

static size_t slot_of(const cli_looked *list, const char *path)
{
    size_t at = (size_t)cli_looked_hash(0, path) & (list->slot_count - 1);
    while (list->slots[at] && strcmp(list->items[list->slots[at] - 1].path, path) != 0)
        at = (at + 1) & (list->slot_count - 1);
    return at;
}

/* At most half of the slots are taken. */
static bool make_slots(cli_looked *list)
{
    enum { LEAST = 64 };
    if (2 * list->count < list->slot_count)
        return true;
    size_t count = list->slot_count ? 2 * list->slot_count : LEAST;
    uint32_t *slots = calloc(count, sizeof *slots);
    if (!slots)
        return false;
    free(list->slots);
    list->slots = slots;
    list->slot_count = count;
    for (size_t i = 0; i < list->count; i++)
        slots[slot_of(list, list->items[i].path)] = (uint32_t)i + 1;
    return true;
}

static bool make_room(cli_looked *list)
{
    if (list->count < list->capacity)
        return true;
    size_t capacity = 2 * list->capacity + 16;
    cli_looked_item *items = realloc(list->items, capacity * sizeof *items);
    if (!items)
        return false;
    list->items = items;
    list->capacity = capacity;
    return true;
}

bool cli_looked_add(cli_looked *list, const char *path, cli_looked_kind kind, bool *is_new)
{
    *is_new = false;
    if (!make_slots(list))
        return false;
    size_t slot = slot_of(list, path);
    if (list->slots[slot])
        return true;
    char *copy = make_room(list) ? strdup(path) : NULL;
    if (!copy)
        return false;
    list->items[list->count++] = (cli_looked_item){copy, kind};
    list->slots[slot] = (uint32_t)list->count;
    *is_new = true;
    return true;
}

size_t cli_looked_find(const cli_looked *list, const char *path)
{
    uint32_t number = list->slot_count ? list->slots[slot_of(list, path)] : 0;
    return number ? number - 1 : list->count;
}

void cli_looked_release(cli_looked *list)
{
    for (size_t i = 0; i < list->count; i++)
        free(list->items[i].path);
    free(list->items);
    free(list->slots);
    *list = (cli_looked){0};
}
