/* SPDX-License-Identifier: MIT
 * Operands; see diff_side.h.
 */
#include "diff/diff_side.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "core/textfile.h"

bool diff_path_is_nothing(const char *path)
{
    return strcmp(path, "/dev/null") == 0;
}

bool diff_path_is_scene(const char *path)
{
    return csgm_format_from_path(path) == CSGM_FORMAT_AUTO && !diff_path_is_nothing(path);
}

int diff_side_load(cli_app *app, diff_side *side, const char *path)
{
    *side = (diff_side){.path = path, .format = csgm_format_from_path(path)};
    if (diff_path_is_nothing(path))
        return CLI_DONE;
    if (side->format != CSGM_FORMAT_AUTO) {
        csgm_status status = csgm_mesh_read(app->context, path, side->format, &side->mesh);
        if (status == CSGM_OK)
            side->view = csgm_mesh_get_view(side->mesh);
        return cli_exit_status(status);
    }
    int status = cli_work_load(app, &side->work, path);
    if (status == CLI_DONE)
        status = cli_work_mesh(app, &side->work);
    if (status == CLI_DONE)
        side->view = csgm_mesh_get_view(side->work.mesh);
    return status;
}

void diff_side_release(diff_side *side)
{
    csgm_mesh_destroy(side->mesh);
    cli_work_release(&side->work);
    *side = (diff_side){.path = NULL};
}

/* ---- bytes ----------------------------------------------------------------------------- */

static bool same_content(FILE *a, FILE *b)
{
    enum { CHUNK = 1 << 16 };
    static char left[CHUNK], right[CHUNK];
    size_t m, n;
    do {
        m = fread(left, 1, CHUNK, a);
        n = fread(right, 1, CHUNK, b);
    } while (m == n && m > 0 && memcmp(left, right, m) == 0);
    return m == 0 && n == 0 && !ferror(a) && !ferror(b);
}

bool diff_same_bytes(const char *a, const char *b)
{
    struct stat left, right;
    csgm_format format = csgm_format_from_path(a);
    /* files that name others beside them may differ there */
    if (format == CSGM_FORMAT_AUTO || csgm_format_traits(format) & CSGM_NAMES_FILES ||
        format != csgm_format_from_path(b) || stat(a, &left) != 0 || stat(b, &right) != 0 ||
        !S_ISREG(left.st_mode) || !S_ISREG(right.st_mode) || left.st_size != right.st_size)
        return false;
    FILE *file_a = fopen(a, "rb"), *file_b = fopen(b, "rb");
    bool same = file_a && file_b && same_content(file_a, file_b);
    if (file_a)
        fclose(file_a);
    if (file_b)
        fclose(file_b);
    return same;
}

static int refuse_read(cli_app *app, const char *path)
{
    cli_console_say(&app->console, CSGM_ERROR, NULL, "cannot read %s: %s", path,
                    errno ? strerror(errno) : "out of memory");
    return CLI_TROUBLE;
}

static int copy_file(cli_app *app, const char *from, const char *to)
{
    struct stat status;
    errno = 0;
    FILE *file = fopen(from, "rb");
    if (!file || fstat(fileno(file), &status) != 0) {
        int refused = refuse_read(app, from);
        if (file)
            fclose(file);
        return refused;
    }
    size_t length = (size_t)status.st_size;
    char *bytes = malloc(length + 1);
    bool good = bytes && fread(bytes, 1, length, file) == length;
    fclose(file);
    int result = good ? cli_write_text(app, to, bytes, length) : refuse_read(app, from);
    free(bytes);
    return result;
}

/* ---- accepting ------------------------------------------------------------------------- */

static void make_folders(const char *path)
{
    char folder[8192];
    for (const char *slash = strchr(path + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        snprintf(folder, sizeof folder, "%.*s", (int)(slash - path), path);
        mkdir(folder, 0777); /* what fails here fails when the file is written */
    }
}

int diff_update(cli_app *app, const char *path_a, diff_side *b, const char *path_b)
{
    csgm_format format = csgm_format_from_path(path_a);
    int status = CLI_DONE;
    if (diff_path_is_nothing(path_a) || diff_path_is_nothing(path_b))
        return cli_usage_error(app, NULL, "--update wants two files");
    make_folders(path_a);
    if (format == csgm_format_from_path(path_b) && !(csgm_format_traits(format) & CSGM_NAMES_FILES))
        return copy_file(app, path_b, path_a);
    if (format == CSGM_FORMAT_AUTO)
        return cli_usage_error(app, NULL, "%s is a scene, which no mesh can be written to", path_a);
    if (!b->path)
        status = diff_side_load(app, b, path_b);
    return status == CLI_DONE ? cli_exit_status(csgm_mesh_write(app->context, &b->view, path_a,
                                                                CSGM_FORMAT_AUTO, NULL))
                              : status;
}
