/* SPDX-License-Identifier: MIT
 * Outputs and what they must not be; see sources.h.
 */
#include "core/sources.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "core/options.h"

/* What tells a file from others. Not regular (a device, a pipe): it may be read and written. */
typedef struct identity {
    bool is_file;
    dev_t device;
    ino_t inode;
    const char
        *name; /* in the folder of device and inode, for a file that does not exist; else NULL */
} identity;

static identity identify(const char *path)
{
    struct stat info;
    identity none = {.is_file = false};
    if (!path || strcmp(path, "-") == 0)
        return none;
    if (stat(path, &info) == 0)
        return S_ISREG(info.st_mode)
                   ? (identity){.is_file = true, .device = info.st_dev, .inode = info.st_ino}
                   : none;
    char folder[4096];
    const char *slash = strrchr(path, '/');
    int length = slash ? (int)(slash - path) + 1 : 0;
    if ((size_t)length >= sizeof folder)
        return none;
    snprintf(folder, sizeof folder, "%.*s", length, path);
    if (stat(slash ? folder : ".", &info) != 0)
        return none;
    return (identity){.is_file = true,
                      .device = info.st_dev,
                      .inode = info.st_ino,
                      .name = slash ? slash + 1 : path};
}

static bool are_same(const identity *a, const identity *b)
{
    return a->is_file && b->is_file && a->device == b->device && a->inode == b->inode &&
           (!a->name) == (!b->name) && (!a->name || strcmp(a->name, b->name) == 0);
}

/* Output `index` of a run, and the option that names it; NULL where that is not given. *is_last:
 * there are no more. */
static const char *output_at(const cli_options *o, size_t index, const char **option, bool *is_last)
{
    const struct {
        const char *option, *path;
    } others[] = {{"-M", o->depfile},
                  {"--stats", o->stats},
                  {"--trace", o->trace},
                  {"--cells", o->cells},
                  {"--junit", o->junit},
                  {"--json", o->diff_json},
                  {"--junit", o->diff_junit},
                  {"--heatmap", o->diff_heatmap},
                  {"--png", o->diff_png},
                  {"--html", o->diff_html},
                  {"--json", o->json ? "-" : NULL},
                  {"--junit", o->measure_junit},
                  {"--junit", o->clear_junit},
                  {"--picture", o->clear_picture},
                  {"-o", o->merged}};
    enum { OTHERS = sizeof others / sizeof *others };
    bool is_other = index >= o->outputs.count;
    *is_last = index + 1 >= o->outputs.count + OTHERS;
    *option = is_other ? others[index - o->outputs.count].option : "-o";
    return is_other ? others[index - o->outputs.count].path : o->outputs.items[index];
}

/* The output that is this file, and its option; NULL: none is. */
static const char *find_writer(const cli_options *options, const char *path, const char **option)
{
    identity file = identify(path);
    bool is_last = !file.is_file || file.name; /* what does not exist is not overwritten */
    for (size_t i = 0; !is_last; i++) {
        const char *output = output_at(options, i, option, &is_last);
        identity written = identify(output);
        if (are_same(&file, &written))
            return output;
    }
    return NULL;
}

bool cli_sources_is_output(const cli_options *options, const char *path)
{
    const char *option;
    return find_writer(options, path, &option) != NULL;
}

static int guard(cli_app *app, const char *path, const char *verb)
{
    const char *option, *writer = find_writer(app->options, path, &option);
    if (!writer)
        return CLI_DONE;
    app->overwriter = option;
    return cli_usage_error(app, "give the output another name",
                           "%s %s would overwrite %s, which this run %s", option, writer, path,
                           verb);
}

int cli_sources_guard_file(cli_app *app, const char *input)
{
    return guard(app, input, "reads");
}

int cli_sources_guard_written(cli_app *app, const char *output)
{
    return guard(app, output, "writes");
}

int cli_sources_guard_scene(cli_app *app, const csgm_scene *scene)
{
    const char *path;
    int status = CLI_DONE;
    for (size_t i = 0; status == CLI_DONE && (path = csgm_scene_dependency(scene, i)); i++)
        status = cli_sources_guard_file(app, path);
    return status;
}

static int guard_outputs(cli_app *app)
{
    bool is_last = false, is_last_other;
    for (size_t i = 0; !is_last; i++) {
        const char *option, *other_option;
        const char *path = output_at(app->options, i, &option, &is_last);
        identity one = identify(path);
        is_last_other = is_last || !path;
        for (size_t j = i + 1; !is_last_other; j++) {
            const char *other = output_at(app->options, j, &other_option, &is_last_other);
            if (other && strcmp(path, "-") == 0 && strcmp(other, "-") == 0) {
                app->overwriter = other_option;
                return cli_usage_error(app, "write one of them to a file",
                                       "%s and %s both write to standard output", option,
                                       other_option);
            }
            identity two = identify(other);
            if (!are_same(&one, &two))
                continue;
            app->overwriter = other_option;
            return cli_usage_error(app, "give one of them another name",
                                   "%s and %s both write to %s", option, other_option, path);
        }
    }
    return CLI_DONE;
}

int cli_sources_guard(cli_app *app)
{
    int status = guard_outputs(app);
    for (size_t i = 0; status == CLI_DONE && i < app->options->operands.count; i++)
        status = cli_sources_guard_file(app, app->options->operands.items[i]);
    return status;
}
