/* SPDX-License-Identifier: MIT
 * Files below two folders, paired by their names; see diff_folders.h. What counts is meshes and
 * scenes by their extensions; hidden files and READMEs do not. A name that one folder has alone
 * goes with one that differs in the extension only, if that one is alone too: goldens/mug.ply and
 * parts/mug.txt.
 */
#include "diff/diff_folders.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "core/options.h"

bool diff_is_folder(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

typedef struct names {
    char **items; /* relative to the folder, sorted */
    size_t count, room;
} names;

static bool no_memory(cli_app *app)
{
    cli_console_say(&app->console, CSGM_ERROR, NULL, "out of memory");
    return false;
}

static bool add_name(cli_app *app, names *list, const char *folder, const char *name)
{
    if (list->count == list->room) {
        size_t room = list->room ? 2 * list->room : 64;
        char **items = realloc(list->items, room * sizeof *items);
        if (!items)
            return no_memory(app);
        list->items = items;
        list->room = room;
    }
    char *path = NULL;
    if (asprintf(&path, "%s%s%s", folder, *folder ? "/" : "", name) < 0)
        return no_memory(app);
    list->items[list->count++] = path;
    return true;
}

static void release(names *list)
{
    for (size_t i = 0; i < list->count; i++)
        free(list->items[i]);
    free(list->items);
}

/* Text files that are seldom scenes. */
static bool is_prose(const char *name)
{
    static const char *const prefixes[] = {"readme",           "license",
                                           "changelog",        "cmakelists.txt",
                                           "requirements.txt", "meson_options.txt"};
    for (size_t i = 0; i < sizeof prefixes / sizeof *prefixes; i++)
        if (strncasecmp(name, prefixes[i], strlen(prefixes[i])) == 0)
            return true;
    return false;
}

static bool is_comparable(const char *name)
{
    const char *dot = strrchr(name, '.');
    if (name[0] == '.' || !dot || is_prose(name))
        return false;
    return csgm_format_from_path(name) != CSGM_FORMAT_AUTO || strcasecmp(dot, ".txt") == 0 ||
           strcasecmp(dot, ".scad") == 0 || strcasecmp(dot, ".csg") == 0;
}

/* One folder: its files to `files`, its folders to `folders`. Links to folders are not followed. */
static bool read_folder(cli_app *app, const char *root, const char *folder, names *files,
                        names *folders)
{
    char path[4096];
    struct stat status;
    bool good = true;
    snprintf(path, sizeof path, "%s%s%s", root, *folder ? "/" : "", folder);
    DIR *dir = opendir(path);
    if (!dir && errno == ENOENT && app->options->diff_update)
        return true; /* what is accepted will make it */
    if (!dir) {
        cli_console_say(&app->console, CSGM_ERROR, NULL, "cannot read the folder %s: %s", path,
                        strerror(errno));
        return false;
    }
    for (struct dirent *entry; good && (entry = readdir(dir));) {
        int length = snprintf(path, sizeof path, "%s%s%s/%s", root, *folder ? "/" : "", folder,
                              entry->d_name);
        if (entry->d_name[0] == '.' || length < 0 || (size_t)length >= sizeof path ||
            lstat(path, &status) != 0)
            continue;
        if (S_ISDIR(status.st_mode))
            good = add_name(app, folders, folder, entry->d_name);
        else if (is_comparable(entry->d_name))
            good = add_name(app, files, folder, entry->d_name);
    }
    closedir(dir);
    return good;
}

static int compare_names(const void *left, const void *right)
{
    return strcmp(*(char *const *)left, *(char *const *)right);
}

static bool list_files(cli_app *app, const char *root, names *files)
{
    names folders = {0};
    bool good = read_folder(app, root, "", files, &folders);
    for (size_t i = 0; good && i < folders.count; i++)
        good = read_folder(app, root, folders.items[i], files, &folders);
    release(&folders);
    if (good && files->count)
        qsort(files->items, files->count, sizeof *files->items, compare_names);
    return good;
}

static size_t stem_length(const char *path)
{
    return (size_t)(strrchr(path, '.') - path);
}

static bool has_name(const names *list, const char *name)
{
    return list->count &&
           bsearch(&name, list->items, list->count, sizeof *list->items, compare_names);
}

/* The only file of `list` with this stem that is not in `others`. */
static const char *find_stem(const names *list, const names *others, const char *name)
{
    const char *found = NULL;
    size_t length = stem_length(name);
    for (size_t i = 0; i < list->count; i++) {
        const char *item = list->items[i];
        if (stem_length(item) != length || strncmp(item, name, length) != 0 ||
            has_name(others, item))
            continue;
        if (found)
            return NULL;
        found = item;
    }
    return found;
}

bool diff_results_add(cli_app *app, diff_results *results, const char *a, const char *b)
{
    if (results->count == results->room) {
        size_t room = results->room ? 2 * results->room : 16;
        diff_result *items = realloc(results->items, room * sizeof *items);
        if (!items)
            return no_memory(app);
        results->items = items;
        results->room = room;
    }
    diff_result *result = &results->items[results->count];
    *result = (diff_result){.a = a ? strdup(a) : NULL,
                            .b = b ? strdup(b) : NULL,
                            .outcome = !b   ? DIFF_ONLY_A
                                       : !a ? DIFF_ONLY_B
                                            : DIFF_SAME};
    results->count++;
    return (a && !result->a) || (b && !result->b) ? no_memory(app) : true;
}

void diff_results_release(diff_results *results)
{
    for (size_t i = 0; i < results->count; i++) {
        free(results->items[i].a);
        free(results->items[i].b);
        free(results->items[i].models);
    }
    free(results->items);
}

static bool add_pair(cli_app *app, diff_results *out, const char *a, const char *b,
                     const char *name_a, const char *name_b)
{
    char path_a[8192], path_b[8192];
    snprintf(path_a, sizeof path_a, "%s/%s", a, name_a ? name_a : "");
    snprintf(path_b, sizeof path_b, "%s/%s", b, name_b ? name_b : "");
    return diff_results_add(app, out, name_a ? path_a : NULL, name_b ? path_b : NULL);
}

/* The other folder's file for this one, by its name or its stem. */
static const char *partner_of(const names *own, const names *other, const char *name)
{
    if (has_name(other, name))
        return name;
    const char *found = find_stem(other, own, name);
    return found && find_stem(own, other, found) ? found : NULL;
}

int diff_pair_folders(cli_app *app, const char *a, const char *b, diff_results *out)
{
    names in_a = {0}, in_b = {0};
    bool good = list_files(app, a, &in_a) && list_files(app, b, &in_b);
    for (size_t i = 0; good && i < in_a.count; i++)
        good = add_pair(app, out, a, b, in_a.items[i], partner_of(&in_a, &in_b, in_a.items[i]));
    for (size_t i = 0; good && i < in_b.count; i++)
        if (!partner_of(&in_b, &in_a, in_b.items[i]))
            good = add_pair(app, out, a, b, NULL, in_b.items[i]);
    if (good && !out->count) {
        cli_console_say(&app->console, CSGM_ERROR, NULL,
                        "no mesh or scene is in %s nor in %s: nothing to compare", a, b);
        good = false;
    }
    release(&in_a);
    release(&in_b);
    return good ? CLI_DONE : CLI_TROUBLE;
}
