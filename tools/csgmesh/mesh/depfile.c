/* SPDX-License-Identifier: MIT
 * Dependency rules; see depfile.h. Escapes as GNU Make reads them: space and '#' with a backslash
 * (backslashes before them doubled), '$' doubled.
 */
#include "mesh/depfile.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/options.h"
#include "core/textfile.h"

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

/* The files among the outputs and the statistics. NULL: no memory. */
static const char **list_targets(const cli_options *options, size_t *count)
{
    const char **targets = malloc((options->outputs.count + 1) * sizeof *targets);
    *count = 0;
    for (size_t i = 0; targets && i <= options->outputs.count; i++) {
        bool last = i == options->outputs.count;
        const char *path = last ? options->stats : options->outputs.items[i];
        if (path && is_file(path))
            targets[(*count)++] = path;
    }
    return targets;
}

int cli_depfile_check(cli_app *app)
{
    size_t count = 1;
    if (app->options->depfile)
        free(list_targets(app->options, &count));
    if (!count)
        return cli_usage_error(app, "add -o FILE", "-M needs an output file to name in its rule");
    return CLI_DONE;
}

static void put_rules(FILE *out, const cli_list *targets, const cli_list *dependencies)
{
    for (size_t i = 0; i < targets->count; i++) {
        if (i)
            fputc(' ', out);
        put_name(out, targets->items[i]);
    }
    fputc(':', out);
    for (size_t i = 0; i < dependencies->count; i++) {
        if (!is_file(dependencies->items[i]))
            continue;
        fputs(" \\\n  ", out);
        put_name(out, dependencies->items[i]);
    }
    fputc('\n', out);
    for (size_t i = 1; i < dependencies->count; i++) {
        fputc('\n', out);
        put_name(out, dependencies->items[i]);
        fputs(":\n", out);
    }
}

int cli_depfile_put(cli_app *app, const char *path, const cli_list *targets,
                    const cli_list *dependencies)
{
    cli_text text;
    if (cli_text_open(&text))
        put_rules(text.out, targets, dependencies);
    return cli_text_write(app, &text, path);
}

int cli_depfile_write(cli_app *app, const csgm_scene *scene)
{
    cli_list targets = {0}, dependencies = {0};
    while (csgm_scene_dependency(scene, dependencies.count))
        dependencies.count++;
    targets.items = list_targets(app->options, &targets.count);
    dependencies.items = malloc((dependencies.count + 1) * sizeof *dependencies.items);
    int status = CLI_TROUBLE;
    if (targets.items && dependencies.items) {
        for (size_t i = 0; i < dependencies.count; i++)
            dependencies.items[i] = csgm_scene_dependency(scene, i);
        status = cli_depfile_put(app, app->options->depfile, &targets, &dependencies);
    } else {
        cli_console_say(&app->console, CSGM_ERROR, NULL, "out of memory");
    }
    free(targets.items);
    free(dependencies.items);
    return status;
}
