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
#include "core/format_lists.h"
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
    const char *slash = strrchr(operand, '/');
    const char *name = slash ? slash + 1 : operand;
    const char *dot = strrchr(name, '.');
    int stem = dot && dot != name ? (int)(dot - name) : (int)strlen(name);
    size_t size = strlen(o->directory) + (size_t)stem + strlen(o->format) + 3;
    char *path = malloc(size);
    if (path)
        snprintf(path, size, "%s/%.*s.%s", o->directory, stem, name, o->format);
    return path;
}

static bool is_same_file(const char *a, const char *b)
{
    struct stat left, right;
    return stat(a, &left) == 0 && stat(b, &right) == 0 && S_ISREG(left.st_mode) &&
           left.st_dev == right.st_dev && left.st_ino == right.st_ino;
}

/* No two files to one place, and nothing over what is read. */
static int check_targets(cli_app *app, const targets *t)
{
    const cli_list *operands = &app->options.operands;
    for (size_t i = 0; i < t->count; i++)
        for (size_t j = 0; j < t->count; j++) {
            if (j < i && strcmp(t->paths[i], t->paths[j]) == 0)
                return cli_usage_error(app, "convert one of them by itself, with -o",
                                       "%s and %s would both become %s", operands->items[j],
                                       operands->items[i], t->paths[i]);
            if (is_same_file(t->paths[i], operands->items[j]))
                return cli_usage_error(app, "give another folder",
                                       "%s would overwrite %s, which this run reads", t->paths[i],
                                       operands->items[j]);
        }
    return CLI_DONE;
}

static int make_targets(cli_app *app, targets *t)
{
    const cli_options *o = &app->options;
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
    const cli_options *o = &app->options;
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
    const cli_list *operands = &app->options.operands;
    int worst = CLI_DONE;
    for (size_t i = 0; i < operands->count; i++) {
        const char *path = t->paths[i];
        app->options.outputs = (cli_list){&path, 1};
        int status = cli_outputs_check(app, operands->items[i]);
        if (status == CLI_DONE)
            status = cli_convert_file(app, operands->items[i], json);
        worst = status > worst ? status : worst;
    }
    app->options.outputs = (cli_list){NULL, 0};
    return worst;
}

static int make_folder(cli_app *app)
{
    const char *folder = app->options.directory;
    if (mkdir(folder, 0777) == 0 || errno == EEXIST)
        return CLI_DONE;
    cli_console_say(&app->console, CSGM_ERROR, NULL, "cannot make %s: %s", folder, strerror(errno));
    return CLI_TROUBLE;
}

static int convert_all(cli_app *app, const targets *t, cli_json *json)
{
    return t->paths ? convert_to_folder(app, t, json)
                    : cli_convert_file(app, app->options.operands.items[0], json);
}

static int convert(cli_app *app, const targets *t)
{
    cli_text text;
    if (!app->options.stats)
        return convert_all(app, t, NULL);
    if (!cli_text_open(&text))
        return cli_text_write(app, &text, app->options.stats);
    cli_json json = cli_json_make(text.out, true);
    cli_json_begin(&json, '{');
    cli_json_string(&json, "csgmesh", csgm_version());
    cli_json_open(&json, "conversions", '[');
    int status = convert_all(app, t, &json);
    cli_json_end(&json, ']');
    cli_json_number(&json, "total_s", cli_now_s() - app->start_s);
    cli_json_end(&json, '}');
    int written = cli_text_write(app, &text, app->options.stats);
    return status > written ? status : written;
}

int cli_convert_run(cli_app *app)
{
    targets t = {NULL, 0};
    int status = cli_app_open(app);
    if (status == CLI_DONE && app->options.directory)
        status = make_targets(app, &t);
    if (status == CLI_DONE && app->options.directory)
        status = make_folder(app);
    if (status == CLI_DONE)
        status = convert(app, &t);
    release(&t);
    return status;
}

int cli_cmd_convert(cli_app *app)
{
    int status = check_usage(app);
    if (status == CLI_DONE && !app->options.directory)
        status = cli_outputs_check(app, app->options.operands.items[0]);
    return status == CLI_DONE ? cli_convert_run(app) : status;
}
