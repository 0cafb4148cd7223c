/* SPDX-License-Identifier: MIT
 * csgmesh convert MESH -o FILE... and csgmesh convert MESH... -d DIR -f FORMAT: meshes of one
 * format to another.
 */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "convert/convert.h"
#include "core/commands.h"
#include "core/format_lists.h"
#include "core/options.h"
#include "core/textfile.h"
#include "mesh/outputs.h"

/* DIR/name.ext of each operand. */
typedef struct targets {
    char **paths;
    size_t count;
} targets;

static void release(targets *t)
{
    for (size_t i = 0; i < t->count; i++)
        free(t->paths[i]);
    free(t->paths);
}

static char *target_of(const cli_options *o, const char *operand)
{
    const char *name = cli_file_name(operand);
    const char *dot = strrchr(name, '.');
    int stem = dot && dot != name ? (int)(dot - name) : (int)strlen(name);
    size_t size = strlen(o->directory) + (size_t)stem + strlen(o->format) + 3;
    char *path = malloc(size);
    if (path)
        snprintf(path, size, "%s/%.*s.%s", o->directory, stem, name, o->format);
    return path;
}

/* A file that is read or written, and which operand it belongs to. */
typedef struct place {
    const char *path;
    dev_t device;
    ino_t inode;
    size_t operand;
} place;

static int by_path(const void *a, const void *b)
{
    const place *x = a, *y = b;
    int order = strcmp(x->path, y->path);
    return order ? order : (x->operand > y->operand) - (x->operand < y->operand);
}

static int by_file(const void *a, const void *b)
{
    const place *x = a, *y = b;
    if (x->device != y->device)
        return x->device < y->device ? -1 : 1;
    return (x->inode > y->inode) - (x->inode < y->inode);
}

/* False: it is no file, or not there. */
static bool identify(const char *path, size_t operand, place *out)
{
    struct stat info;
    if (stat(path, &info) != 0 || !S_ISREG(info.st_mode))
        return false;
    *out = (place){path, info.st_dev, info.st_ino, operand};
    return true;
}

/* No two files to one place. */
static int check_clashes(cli_app *app, const targets *t, place *places)
{
    const char **operands = app->options->operands.items;
    for (size_t i = 0; i < t->count; i++)
        places[i] = (place){.path = t->paths[i], .operand = i};
    qsort(places, t->count, sizeof *places, by_path);
    for (size_t i = 1; i < t->count; i++)
        if (strcmp(places[i - 1].path, places[i].path) == 0)
            return cli_usage_error(
                app, "convert one of them by itself, with -o", "%s and %s would both become %s",
                operands[places[i - 1].operand], operands[places[i].operand], places[i].path);
    return CLI_DONE;
}

/* Nothing over what is read. */
static int check_inputs(cli_app *app, const targets *t, place *places)
{
    const cli_list *operands = &app->options->operands;
    size_t count = 0;
    for (size_t i = 0; i < operands->count; i++)
        count += identify(operands->items[i], i, &places[count]);
    qsort(places, count, sizeof *places, by_file);
    for (size_t i = 0; i < t->count; i++) {
        place target;
        const place *read = identify(t->paths[i], i, &target)
                                ? bsearch(&target, places, count, sizeof target, by_file)
                                : NULL;
        if (read)
            return cli_usage_error(app, "give another folder",
                                   "%s would overwrite %s, which this run reads", t->paths[i],
                                   read->path);
    }
    return CLI_DONE;
}

static int check_targets(cli_app *app, const targets *t)
{
    place *places = calloc(t->count, sizeof *places);
    if (!places)
        return cli_usage_error(app, NULL, "out of memory");
    int status = check_clashes(app, t, places);
    if (status == CLI_DONE)
        status = check_inputs(app, t, places);
    free(places);
    return status;
}

static int make_targets(cli_app *app, targets *t)
{
    const cli_options *o = app->options;
    t->paths = calloc(o->operands.count, sizeof *t->paths);
    for (size_t i = 0; t->paths && i < o->operands.count; i++) {
        t->paths[i] = target_of(o, o->operands.items[i]);
        t->count += t->paths[i] != NULL;
        if (!t->paths[i])
            break;
    }
    if (t->count < o->operands.count)
        return cli_usage_error(app, NULL, "out of memory");
    return check_targets(app, t);
}

static int check_usage(cli_app *app)
{
    const cli_options *o = app->options;
    char known[160];
    if (!o->operands.count)
        return cli_usage_error(app, "as csgmesh convert a.glb -o a.stl", "no mesh given");
    if (o->directory && o->outputs.count)
        return cli_usage_error(app, NULL, "-o names a file and -d a folder: give one");
    if (!o->directory && o->operands.count > 1)
        return cli_usage_error(app, "as csgmesh convert *.glb -d out -f stl",
                               "several meshes need -d, a folder for what they become");
    if (o->directory && !o->format) {
        cli_formats_list(known, sizeof known, " ", CSGM_IS_WRITTEN);
        char hint[200];
        snprintf(hint, sizeof hint, "add -f stl (formats:%s)", known);
        return cli_usage_error(app, hint, "-d needs -f, the format");
    }
    return cli_convert_check(app);
}

/* One after the other, those behind one that fails, too; the worst exit status. */
static int convert_to_folder(cli_app *app, const targets *t, cli_json *json)
{
    const cli_list *operands = &app->options->operands;
    int worst = CLI_DONE;
    for (size_t i = 0; i < operands->count; i++) {
        const char *path = t->paths[i];
        app->options->outputs = (cli_list){&path, 1};
        int status = cli_outputs_check(app, operands->items[i]);
        if (status == CLI_DONE)
            status = cli_convert_file(app, operands->items[i], json);
        worst = status > worst ? status : worst;
    }
    app->options->outputs = (cli_list){NULL, 0};
    return worst;
}

static int make_folder(cli_app *app)
{
    const char *folder = app->options->directory;
    if (mkdir(folder, 0777) == 0 || errno == EEXIST)
        return CLI_DONE;
    cli_console_say(&app->console, CSGM_ERROR, NULL, "cannot make %s: %s", folder, strerror(errno));
    return CLI_TROUBLE;
}

static int convert_all(cli_app *app, const targets *t, cli_json *json)
{
    return t->paths ? convert_to_folder(app, t, json)
                    : cli_convert_file(app, app->options->operands.items[0], json);
}

static int convert(cli_app *app, const targets *t)
{
    cli_text text;
    if (!app->options->stats)
        return convert_all(app, t, NULL);
    if (!cli_text_open(&text))
        return cli_text_write(app, &text, app->options->stats);
    cli_json json = cli_json_make(text.out, true);
    cli_json_begin(&json, '{');
    cli_json_string(&json, "csgmesh", csgm_version());
    cli_json_open(&json, "conversions", '[');
    int status = convert_all(app, t, &json);
    cli_json_end(&json, ']');
    cli_json_number(&json, "total_s", cli_now_s() - app->start_s);
    cli_json_end(&json, '}');
    int written = cli_text_write(app, &text, app->options->stats);
    return status > written ? status : written;
}

int cli_convert_run(cli_app *app)
{
    targets t = {NULL, 0};
    int status = cli_app_open(app);
    if (status == CLI_DONE && app->options->directory)
        status = make_targets(app, &t);
    if (status == CLI_DONE && app->options->directory)
        status = make_folder(app);
    if (status == CLI_DONE)
        status = convert(app, &t);
    release(&t);
    return status;
}

int cli_cmd_convert(cli_app *app)
{
    int status = check_usage(app);
    if (status == CLI_DONE && !app->options->directory)
        status = cli_outputs_check(app, app->options->operands.items[0]);
    return status == CLI_DONE ? cli_convert_run(app) : status;
}
