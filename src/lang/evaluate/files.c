/* SPDX-License-Identifier: MIT
 * Files of a scene; see files.h.
 */
#include "lang/evaluate/files.h"

#include <string.h>

#include "text/source.h"

static const char *search(csg_eval *e, const char *name, csg_span asking)
{
    bool in_library, no_memory;
    const char *found = csg_program_find(e->program, asking.source, name, &in_library, &no_memory);
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
