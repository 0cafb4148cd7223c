/* SPDX-License-Identifier: MIT
 * Files of a scene; see files.h.
 */
#include "lang/evaluate/files.h"

#include <string.h>

#include "text/folders.h"
#include "text/source.h"

/* folder (up to length) + "/" + name, when it can be read. */
static const char *try_path(csg_eval *e, const char *folder, size_t length, const char *name)
{
    const char *slash = length && folder[length - 1] != '/' ? "/" : "";
    const char *path =
        csg_arena_printf(&e->program->arena, "%.*s%s%s", (int)length, folder, slash, name);
    if (!path)
        csg_eval_no_memory(e);
    return path && csg_source_exists(path) ? path : NULL;
}

static const char *search(csg_eval *e, const char *name, csg_span asking)
{
    const csg_program *program = e->program;
    const char *from = program->sources.items[asking.source].name;
    const char *slash = strrchr(from, '/');
    size_t folder = slash && name[0] != '/' ? (size_t)(slash - from) + 1 : 0;
    const char *found = try_path(e, from, folder, name);
    if (name[0] == '/')
        return found;
    char where[4096];
    size_t length = 0;
    for (size_t i = 0;
         !found && (length = csg_folder_name(program->options, i, where, sizeof where)) > 0; i++)
        if (length < sizeof where)
            found = try_path(e, where, length, name);
    return found;
}

void csg_file_depend(csg_eval *e, const char *path)
{
    if (!csg_program_depend(e->program, path))
        csg_eval_no_memory(e);
}

const char *csg_file_find(csg_eval *e, const char *name, csg_span asking)
{
    const char *found = search(e, name, asking);
    if (found)
        csg_file_depend(e, found);
    return e->stop ? NULL : found;
}

void csg_file_extension(const char *path, char out[8])
{
    const char *dot = strrchr(path, '.'), *slash = strrchr(path, '/');
    size_t i = 0;
    if (dot && (!slash || dot > slash))
        for (dot++; dot[i] && i < 7; i++)
            out[i] = (char)(dot[i] >= 'A' && dot[i] <= 'Z' ? dot[i] - 'A' + 'a' : dot[i]);
    out[i] = '\0';
}
