/* SPDX-License-Identifier: MIT
 * Memory of one batch; see arena.h. Chunks of growing texts and lists; what a list leaves
 * behind when it grows stays until the end.
 */
#include "core/arena.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK_BYTES = 1 << 12, ALIGNMENT = 16 };

typedef struct cli_chunk {
    struct cli_chunk *next;
    size_t used, size;
    _Alignas(ALIGNMENT) char bytes[];
} cli_chunk;

void *cli_arena_alloc(cli_arena *arena, size_t size)
{
    cli_chunk *chunk = arena->chunks;
    size = (size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    if (!chunk || chunk->size - chunk->used < size) {
        size_t room = size > CHUNK_BYTES ? size : CHUNK_BYTES;
        chunk = calloc(1, sizeof *chunk + room);
        if (!chunk) {
            arena->failed = true;
            return NULL;
        }
        chunk->next = arena->chunks;
        chunk->size = room;
        arena->chunks = chunk;
    }
    void *place = chunk->bytes + chunk->used;
    chunk->used += size;
    return place;
}

const char *cli_arena_strndup(cli_arena *arena, const char *text, size_t length)
{
    char *copy = cli_arena_alloc(arena, length + 1);
    if (!copy)
        return "";
    memcpy(copy, text, length);
    return copy;
}

const char *cli_arena_strdup(cli_arena *arena, const char *text)
{
    return cli_arena_strndup(arena, text, strlen(text));
}

const char *cli_arena_printf(cli_arena *arena, const char *format, ...)
{
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    char *text = length >= 0 ? cli_arena_alloc(arena, (size_t)length + 1) : NULL;
    if (text)
        vsnprintf(text, (size_t)length + 1, format, again);
    va_end(again);
    return text ? text : "";
}

/* Room doubles at powers of two, so the count alone says when. */
void *cli_arena_push(cli_arena *arena, void **items, size_t *count, size_t size)
{
    size_t n = *count;
    if ((n & (n - 1)) == 0) {
        void *larger = cli_arena_alloc(arena, (n ? 2 * n : 1) * size);
        if (!larger)
            return NULL;
        if (n)
            memcpy(larger, *items, n * size);
        *items = larger;
    }
    (*count)++;
    return (char *)*items + n * size;
}

void cli_list_add(cli_arena *arena, cli_list *list, const char *text)
{
    const char **place = cli_arena_push(arena, (void **)&list->items, &list->count, sizeof text);
    if (place)
        *place = text;
}

void cli_arena_reset(cli_arena *arena)
{
    while (arena->chunks) {
        cli_chunk *next = arena->chunks->next;
        free(arena->chunks);
        arena->chunks = next;
    }
}

const char *cli_path_join(cli_arena *arena, const char *folder, const char *name)
{
    size_t length = strlen(folder);
    if (!length || strcmp(folder, ".") == 0 || name[0] == '/')
        return name;
    return cli_arena_printf(arena, "%s%s%s", folder, folder[length - 1] == '/' ? "" : "/", name);
}

const char *cli_path_folder(cli_arena *arena, const char *path)
{
    const char *slash = strrchr(path, '/');
    if (!slash)
        return "";
    return slash == path ? "/" : cli_arena_strndup(arena, path, (size_t)(slash - path));
}
