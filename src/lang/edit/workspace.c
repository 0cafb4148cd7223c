/* SPDX-License-Identifier: MIT
 * Files: read when they are asked for, again when their time or size has changed; see workspace.h.
 */
#include "lang/edit/workspace.h"

#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "text/folders.h"

enum { LARGEST = 64 << 20, MOST_FILES = 10000 };

csgm_status csgm_workspace_create(csgm_context *context, const csgm_scene_options *options,
                                  csgm_workspace **out)
{
    if (!out)
        return CSGM_ERR_ARGUMENT;
    *out = NULL;
    if (!context)
        return CSGM_ERR_ARGUMENT;
    csgm_workspace *made = csg_memory_alloc(&context->memory, sizeof *made);
    if (!made)
        return csg_context_no_memory(context);
    *made = (csgm_workspace){.context = context, .options = options};
    csg_arena_init(&made->arena, &context->memory);
    *out = made;
    return CSGM_OK;
}

static void forget_text(csgm_workspace *workspace, csg_edit_file *file)
{
    csg_memory *memory = &workspace->context->memory;
    csg_edit_pieces_release(memory, &file->pieces);
    csg_arena_reset(&file->arena);
    if (file->text)
        csg_memory_release(memory, file->text, file->length + 1);
    file->names = (csg_edit_names){0};
    file->links = NULL;
    file->text = NULL;
    file->length = 0;
}

void csgm_workspace_destroy(csgm_workspace *workspace)
{
    if (!workspace)
        return;
    csg_memory *memory = &workspace->context->memory;
    for (size_t i = 0; i < workspace->count; i++)
        forget_text(workspace, workspace->files[i]);
    csg_memory_release(memory, workspace->files, workspace->capacity * sizeof *workspace->files);
    csg_arena_reset(&workspace->arena);
    csg_memory_release(memory, workspace, sizeof *workspace);
}

void csg_workspace_begin(csgm_workspace *workspace)
{
    if (workspace->is_answering)
        return;
    workspace->query++;
    workspace->no_memory = false;
}

/* ---- texts -------------------------------------------------------------------------------- */

/* Names and links. What the lexer finds wrong is for others to tell. */
static bool read_names(csgm_workspace *workspace, csg_edit_file *file)
{
    csgm_context *context = workspace->context;
    csg_diag_sink diags = context->diags;
    csg_sources sources;
    uint32_t source;
    context->diags.on_diag = NULL;
    csg_sources_init(&sources, context, &file->arena);
    csgm_status status = csg_source_add(&sources, file->path, file->text, file->length, &source);
    bool ok = status != CSGM_ERR_MEMORY;
    if (status == CSGM_OK) {
        bool no_memory = false;
        ok = csg_edit_pieces_read(&sources, source, &file->pieces);
        if (ok)
            csg_edit_pieces_match(&context->memory, &file->pieces, NULL, source, &no_memory);
        ok = ok && !no_memory &&
             csg_edit_names_find(&file->arena, file->text, &file->pieces, &file->names);
    }
    csg_sources_reset(&sources);
    context->diags = diags;
    if (ok && file->names.link_count)
        file->links =
            csg_arena_calloc(&file->arena, file->names.link_count, sizeof(csg_edit_file *));
    return ok && (file->links || !file->names.link_count);
}

/* Without memory the file has no text, so that it is read again when it is asked for next. */
static bool set_text(csgm_workspace *workspace, csg_edit_file *file, const char *text,
                     size_t length)
{
    forget_text(workspace, file);
    file->text = csg_memory_alloc(&workspace->context->memory, length + 1);
    if (!file->text)
        return false;
    memcpy(file->text, text, length);
    file->text[length] = '\0';
    file->length = length;
    bool ok = read_names(workspace, file);
    if (!ok)
        forget_text(workspace, file);
    return ok;
}

static bool read_disk(csgm_workspace *workspace, csg_edit_file *file, int handle, size_t size)
{
    csg_memory *memory = &workspace->context->memory;
    char *text = csg_memory_alloc(memory, size + 1);
    size_t length = 0;
    ssize_t got = 1;
    while (text && length < size && got > 0) {
        got = read(handle, text + length, size - length);
        length += got > 0 ? (size_t)got : 0;
    }
    bool ok = text && set_text(workspace, file, text, length);
    csg_memory_release(memory, text, size + 1);
    return ok;
}

/* False: no memory. A file that cannot be read has no text. */
static bool look_at_disk(csgm_workspace *workspace, csg_edit_file *file)
{
    struct stat info;
    int handle = open(file->path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    bool is_good = handle >= 0 && fstat(handle, &info) == 0 && S_ISREG(info.st_mode) &&
                   info.st_size <= LARGEST;
    bool ok = true;
    if (!is_good)
        forget_text(workspace, file);
    else if (!file->text || file->seconds != info.st_mtim.tv_sec ||
             file->nanoseconds != info.st_mtim.tv_nsec || file->size != info.st_size)
        ok = read_disk(workspace, file, handle, (size_t)info.st_size);
    if (is_good) {
        file->seconds = info.st_mtim.tv_sec;
        file->nanoseconds = info.st_mtim.tv_nsec;
        file->size = info.st_size;
    }
    if (handle >= 0)
        close(handle);
    return ok;
}

/* ---- files -------------------------------------------------------------------------------- */

static csg_edit_file *find_file(csgm_workspace *workspace, const char *path)
{
    for (size_t i = 0; i < workspace->count; i++)
        if (strcmp(workspace->files[i]->path, path) == 0)
            return workspace->files[i];
    if (workspace->count >= MOST_FILES ||
        !csg_memory_reserve(&workspace->context->memory, (void **)&workspace->files,
                            &workspace->capacity, workspace->count + 1, sizeof(csg_edit_file *)))
        return NULL;
    csg_edit_file *file = csg_arena_calloc(&workspace->arena, 1, sizeof *file);
    const char *copy = csg_arena_strndup(&workspace->arena, path, strlen(path));
    if (!file || !copy)
        return NULL;
    file->path = copy;
    csg_arena_init(&file->arena, &workspace->context->memory);
    workspace->files[workspace->count++] = file;
    return file;
}

bool csg_workspace_refresh(csgm_workspace *workspace, csg_edit_file *file)
{
    bool ok = true;
    if (!file->is_open && file->looked != workspace->query) {
        file->looked = workspace->query;
        ok = look_at_disk(workspace, file);
    }
    workspace->no_memory = workspace->no_memory || !ok;
    return ok;
}

csg_edit_file *csg_workspace_file(csgm_workspace *workspace, const char *path)
{
    csg_edit_file *file = find_file(workspace, path);
    workspace->no_memory = workspace->no_memory || !file;
    return file && csg_workspace_refresh(workspace, file) ? file : NULL;
}

csg_edit_file *csg_workspace_follow(csgm_workspace *workspace, csg_edit_file *from, uint32_t link)
{
    if (from->links[link])
        return csg_workspace_file(workspace, from->links[link]->path);
    const csg_edit_link *asked = &from->names.links[link];
    csg_arena arena;
    csg_edit_file *file = NULL;
    csg_folder_search search = {.context = workspace->context, .arena = &arena};
    csg_arena_init(&arena, &workspace->context->memory);
    const char *name = csg_arena_strndup(&arena, from->text + asked->offset, asked->length);
    const char *slash = strrchr(from->path, '/'), *found = NULL;
    size_t folder = slash && name && name[0] != '/' ? (size_t)(slash - from->path) + 1 : 0;
    if (name)
        found = csg_folder_try(&search, from->path, folder, name);
    if (name && !found && name[0] != '/')
        found = csg_folders_search(&search, workspace->options, name);
    if (found)
        file = csg_workspace_file(workspace, found);
    from->links[link] = file;
    workspace->no_memory = workspace->no_memory || search.no_memory || !name;
    csg_arena_reset(&arena);
    return file;
}

/* ---- for customers ------------------------------------------------------------------------ */

csgm_status csgm_workspace_open(csgm_workspace *workspace, const char *path, const char *text,
                                size_t text_length)
{
    if (!workspace || !path || (!text && text_length) || text_length > LARGEST ||
        workspace->is_answering)
        return CSGM_ERR_ARGUMENT;
    csg_workspace_begin(workspace);
    csg_edit_file *file = find_file(workspace, path);
    if (!file || !set_text(workspace, file, text ? text : "", text_length))
        return csg_context_no_memory(workspace->context);
    file->is_open = true;
    return CSGM_OK;
}

void csgm_workspace_close(csgm_workspace *workspace, const char *path)
{
    csg_edit_file *file = workspace && path ? find_file(workspace, path) : NULL;
    if (!file || workspace->is_answering)
        return;
    file->is_open = false;
    forget_text(workspace, file);
}

const char *csgm_workspace_text(csgm_workspace *workspace, const char *path, size_t *text_length)
{
    if (!workspace || !path)
        return NULL;
    csg_workspace_begin(workspace);
    const csg_edit_file *file = csg_workspace_file(workspace, path);
    *text_length = file ? file->length : 0;
    return file ? file->text : NULL;
}
