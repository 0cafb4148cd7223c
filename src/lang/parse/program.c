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

bool csg_program_depend(csg_program *program, const char *path)
{
    for (uint32_t i = 0; i < program->dependency_count; i++)
        if (strcmp(program->dependencies[i], path) == 0)
            return true;
    const char **place = csg_arena_push(&program->arena, (void **)&program->dependencies,
                                        &program->dependency_count, sizeof path);
    if (place)
        *place = path;
    return place != NULL;
}

const char *csg_program_find(csg_program *program, uint32_t asking, const char *name,
                             bool *in_library, bool *no_memory)
{
    const char *from = program->sources.items[asking].name, *slash = strrchr(from, '/');
    size_t folder = slash && name[0] != '/' ? (size_t)(slash - from) + 1 : 0;
    csg_folder_search search = {.context = program->context, .arena = &program->arena};
    const char *found = csg_folder_try(&search, from, folder, name);
    *in_library = !found && !search.no_memory && name[0] != '/';
    if (*in_library)
        found = csg_folders_search(&search, program->options, name);
    *no_memory = search.no_memory;
    return found;
}
