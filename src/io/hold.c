/* SPDX-License-Identifier: MIT
 * Held files; see hold.h.
 */
#include "io/hold.h"

struct csg_held_file {
    csg_held_file *next;
    csg_atomic_file file;
};

csgm_status csg_hold_add(csg_atomic_file *file)
{
    csgm_context *context = file->context;
    csg_held_file *held = csg_memory_alloc(&context->memory, sizeof *held);
    const char *path = held ? csg_arena_printf(&file->names, "%s", file->path) : NULL;
    if (!path) {
        csg_memory_release(&context->memory, held, held ? sizeof *held : 0);
        csg_file_abandon(file);
        return csg_context_no_memory(context);
    }
    *held = (csg_held_file){.next = context->held, .file = *file};
    held->file.path = path; /* the caller's may be gone by then */
    context->held = held;
    return CSGM_OK;
}

void csg_hold_begin(csgm_context *context)
{
    context->holds_files = true;
}

static csg_held_file *in_their_order(csg_held_file *list)
{
    csg_held_file *first = NULL;
    while (list) {
        csg_held_file *next = list->next;
        list->next = first;
        first = list;
        list = next;
    }
    return first;
}

csgm_status csg_hold_end(csgm_context *context, bool keep)
{
    csgm_status status = CSGM_OK;
    csg_held_file *list = in_their_order(context->held);
    context->held = NULL;
    context->holds_files = false;
    while (list) {
        csg_held_file *next = list->next;
        if (keep && status == CSGM_OK)
            status = csg_file_name(&list->file);
        else
            csg_file_abandon(&list->file);
        csg_memory_release(&context->memory, list, sizeof *list);
        list = next;
    }
    return status;
}
