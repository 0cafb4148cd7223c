/* SPDX-License-Identifier: MIT
 * Files of a scene; see files.h.
 */
#include "lang/evaluate/files.h"

#include <string.h>

#include "text/folders.h"
#include "text/source.h"

static const char *search(csg_eval *e, const char *name, csg_span asking)
{
    const csg_program *program = e->program;
    const char *from = program->sources.items[asking.source].name;
    const char *slash = strrchr(from, '/');
    size_t folder = slash && name[0] != '/' ? (size_t)(slash - from) + 1 : 0;
    bool no_memory = false;
    const char *found = csg_folder_try(&e->program->arena, from, folder, name, &no_memory);
    if (!found && !no_memory && name[0] != '/')
        found = csg_folders_search(&e->program->arena, program->options, name, &no_memory);
    if (no_memory)
        csg_eval_no_memory(e);
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
