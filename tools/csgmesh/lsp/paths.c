/* SPDX-License-Identifier: MIT
 * Completion of file names behind include < and use <: of folders and scenes in the folder of the
 * text and in those of libraries.
 */
#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "lsp/lsp.h"

enum { MOST_PATHS = 400 };

/* Where the path begins that is written at the place, or NULL: it is none. */
static const char *find_path(const lsp_call *call)
{
    const char *end = call->text + call->offset, *open = end;
    while (open > call->text && open[-1] != '<' && open[-1] != '>' && open[-1] != '\n')
        open--;
    if (open == call->text || open[-1] != '<')
        return NULL;
    const char *word = open - 1;
    while (word > call->text && (word[-1] == ' ' || word[-1] == '\t'))
        word--;
    size_t before = (size_t)(word - call->text);
    bool reads = (before >= 7 && memcmp(word - 7, "include", 7) == 0) ||
                 (before >= 3 && memcmp(word - 3, "use", 3) == 0);
    return reads ? open : NULL;
}

static bool is_scene(const char *name)
{
    static const char *const endings[] = {".scad", ".txt", ".csgmesh", ".ttf", ".otf"};
    const char *dot = strrchr(name, '.');
    for (size_t i = 0; dot && i < sizeof endings / sizeof *endings; i++)
        if (strcasecmp(dot, endings[i]) == 0)
            return true;
    return false;
}

static void put_entry(cli_json *json, const char *name, bool is_folder)
{
    enum { FILE_ITEM = 17, FOLDER_ITEM = 19 };
    cli_json_open(json, NULL, '{');
    cli_json_string(json, "label", name);
    cli_json_integer(json, "kind", is_folder ? FOLDER_ITEM : FILE_ITEM);
    cli_json_end(json, '}');
}

/* What begins as `name` in base/inner. Returns how many. */
static uint32_t put_folder(lsp_call *call, const char *base, const char *inner, const char *name,
                           uint32_t most)
{
    uint32_t count = 0;
    const char *path = cli_path_join(call->arena, base, inner);
    DIR *folder = *path ? opendir(path) : opendir(".");
    for (struct dirent *entry; folder && count < most && (entry = readdir(folder));) {
        bool is_folder = entry->d_type == DT_DIR;
        bool fits = entry->d_name[0] != '.' && strncasecmp(entry->d_name, name, strlen(name)) == 0;
        if (!fits || !(is_folder || is_scene(entry->d_name)))
            continue;
        put_entry(call->json, entry->d_name, is_folder);
        count++;
    }
    if (folder)
        closedir(folder);
    return count;
}

bool lsp_complete_path(lsp_call *call)
{
    const char *from = call->text ? find_path(call) : NULL;
    if (!from)
        return false;
    char folder[4096];
    const char *written =
        cli_arena_strndup(call->arena, from, (size_t)(call->text + call->offset - from));
    const char *slash = strrchr(written, '/');
    const char *inner = cli_path_folder(call->arena, written);
    const char *name = slash ? slash + 1 : written;
    uint32_t count =
        put_folder(call, cli_path_folder(call->arena, call->path), inner, name, MOST_PATHS);
    const csgm_scene_options *options = &call->server->settings.options;
    size_t length;
    for (size_t i = 0;
         *written != '/' && (length = csgm_scene_folder(options, i, folder, sizeof folder)) > 0;
         i++)
        if (length < sizeof folder)
            count += put_folder(call, folder, inner, name, MOST_PATHS - count);
    return true;
}
