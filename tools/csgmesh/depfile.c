/* SPDX-License-Identifier: MIT
 * Dependency rules; see depfile.h. Escapes as GNU Make reads them: space and '#' with a backslash
 * (backslashes before them doubled), '$' doubled.
 */
#include "depfile.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "textfile.h"

static void put_name(FILE *out, const char *name)
{
    size_t backslashes = 0;
    for (; *name; name++) {
        bool escaped = *name == ' ' || *name == '\t' || *name == '#';
        for (size_t i = 0; escaped && i < backslashes; i++)
            fputc('\\', out);
        if (escaped)
            fputc('\\', out);
        if (*name == '$')
            fputc('$', out);
        fputc(*name, out);
        backslashes = *name == '\\' ? backslashes + 1 : 0;
    }
}

static bool is_file(const char *path)
{
    return strcmp(path, "-") != 0;
}

/* Returns how many targets there are; writes them unless out is NULL. */
static size_t put_targets(FILE *out, const cli_options *options)
{
    size_t count = 0;
    for (size_t i = 0; i <= options->outputs.count; i++) {
        bool last = i == options->outputs.count;
        const char *path = last ? options->stats : options->outputs.items[i];
        if (!path || !is_file(path))
            continue;
        if (out && count)
            fputc(' ', out);
        if (out)
            put_name(out, path);
        count++;
    }
    return count;
}

int cli_depfile_check(cli_app *app)
{
    if (app->options.depfile && !put_targets(NULL, &app->options))
        return cli_usage_error(app, "add -o FILE", "-M needs an output file to name in its rule");
    return CLI_DONE;
}

static void put_rules(FILE *out, const cli_options *options, const csgm_scene *scene)
{
    const char *path;
    put_targets(out, options);
    fputc(':', out);
    for (size_t i = 0; (path = csgm_scene_dependency(scene, i)); i++) {
        if (!is_file(path))
            continue;
        fputs(" \\\n  ", out);
        put_name(out, path);
    }
    fputc('\n', out);
    for (size_t i = 1; (path = csgm_scene_dependency(scene, i)); i++) {
        fputc('\n', out);
        put_name(out, path);
        fputs(":\n", out);
    }
}

int cli_depfile_write(cli_app *app, const csgm_scene *scene)
{
    char *text = NULL;
    size_t length = 0;
    FILE *out = open_memstream(&text, &length);
    if (out)
        put_rules(out, &app->options, scene);
    if (!out || fclose(out) != 0) {
        free(text);
        cli_console_say(&app->console, CSGM_ERROR, NULL, "out of memory");
        return CLI_TROUBLE;
    }
    int status = cli_write_text(app, app->options.depfile, text, length);
    free(text);
    return status;
}
