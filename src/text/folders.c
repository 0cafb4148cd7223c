/* SPDX-License-Identifier: MIT
 * The order of folders; see folders.h: those of the options, those of the environment, then the
 * ones where people who use OpenSCAD keep their libraries.
 */
#include "text/folders.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text/source.h"

/* Folder `*index` of a list with colons between; counts *index down by what it has. */
static const char *folder_of_list(const char *list, size_t *index, size_t *length)
{
    while (list && *list) {
        *length = strcspn(list, ":");
        if (*length && (*index)-- == 0)
            return list;
        list += *length + (list[*length] == ':');
    }
    return NULL;
}

size_t csg_folder_name(const csgm_scene_options *options, size_t index, char *buffer, size_t size)
{
    static const char *const lists[] = {"CSGMESH_PATH", "OPENSCADPATH"};
#ifdef __APPLE__
    static const char at_home[] = "Documents/OpenSCAD/libraries";
    static const char for_all[] = "/Applications/OpenSCAD.app/Contents/Resources/libraries";
#else
    static const char at_home[] = ".local/share/OpenSCAD/libraries";
    static const char for_all[] = "/usr/share/openscad/libraries";
#endif
    size_t given = options ? options->include_dir_count : 0, length = 0;
    if (index < given) {
        const char *name = options->include_dirs[index];
        return (size_t)snprintf(buffer, size, "%s", *name ? name : "."); /* 0 means no folder */
    }
    index -= given;
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        const char *folder = folder_of_list(getenv(lists[i]), &index, &length);
        if (folder)
            return (size_t)snprintf(buffer, size, "%.*s", (int)length, folder);
    }
    const char *home = getenv("HOME");
    if (home && *home && index-- == 0)
        return (size_t)snprintf(buffer, size, "%s/%s", home, at_home);
    return index == 0 ? (size_t)snprintf(buffer, size, "%s", for_all) : 0;
}

const char *csg_folder_try(csg_folder_search *search, const char *folder, size_t length,
                           const char *name)
{
    const char *slash = length && folder[length - 1] != '/' ? "/" : "";
    const char *path =
        csg_arena_printf(search->arena, "%.*s%s%s", (int)length, folder, slash, name);
    if (!path)
        search->no_memory = true;
    bool is_there = path && csg_source_exists(path);
    if (path)
        csg_context_tell_file(search->context, path, is_there);
    return is_there ? path : NULL;
}

const char *csg_folders_search(csg_folder_search *search, const csgm_scene_options *options,
                               const char *name)
{
    char folder[4096];
    const char *found = NULL;
    size_t length = 0;
    for (size_t i = 0; !found && !search->no_memory &&
                       (length = csg_folder_name(options, i, folder, sizeof folder)) > 0;
         i++)
        if (length < sizeof folder)
            found = csg_folder_try(search, folder, length, name);
    return found;
}
