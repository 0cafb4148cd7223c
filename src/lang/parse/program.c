/* SPDX-License-Identifier: MIT
 * Everything parsed for one scene: its beginning and end, and the files it depends on; see ast.h.
 */
#include <string.h>

#include "lang/parse/ast.h"
#include "text/folders.h"

void csg_program_init(csg_program *program, csgm_context *context)
{
    *program = (csg_program){.context = context};
    csg_arena_init(&program->arena, &context->memory);
    csg_sources_init(&program->sources, context, &program->arena);
    csg_symbols_init(&program->symbols, &context->memory, &program->arena);
    csg_members_init(&program->members, &context->memory);
}

void csg_program_reset(csg_program *program)
{
    csg_sources_reset(&program->sources);
    csg_symbols_reset(&program->symbols);
    csg_members_reset(&program->members);
    csg_arena_reset(&program->arena);
}

/* Once. False without memory. */
static bool add_path(csg_arena *arena, const char ***paths, uint32_t *count, const char *path)
{
    for (uint32_t i = 0; i < *count; i++)
        if (strcmp((*paths)[i], path) == 0)
            return true;
    const char **place = csg_arena_push(arena, (void **)paths, count, sizeof path);
    if (place)
        *place = path;
    return place != NULL;
}

bool csg_program_depend(csg_program *program, const char *path)
{
    return add_path(&program->arena, &program->dependencies, &program->dependency_count, path);
}

const char *csg_program_find(csg_program *program, uint32_t asking, const char *name,
                             bool *in_library, bool *no_memory)
{
    csg_arena *arena = &program->arena;
    const char *from = program->sources.items[asking].name, *slash = strrchr(from, '/');
    size_t folder = slash && name[0] != '/' ? (size_t)(slash - from) + 1 : 0;
    *no_memory = false;
    const char *found = csg_folder_try(arena, from, folder, name, no_memory);
    *in_library = !found && !*no_memory && name[0] != '/';
    if (*in_library)
        found = csg_folders_search(arena, program->options, name, no_memory);
    if (found || *no_memory)
        return found;
    const char *beside = csg_arena_printf(arena, "%.*s%s", (int)folder, from, name);
    *no_memory = !beside || !add_path(arena, &program->missing, &program->missing_count, beside);
    return NULL;
}
