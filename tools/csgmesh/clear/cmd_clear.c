/* SPDX-License-Identifier: MIT
 * csgmesh clear SCENE: which parts stay clear of each other, at one pose or at many. What is proven
 * when a limit or Ctrl-C ends the work is printed too.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "clear/clear_picture.h"
#include "clear/clear_print.h"
#include "core/interrupt.h"
#include "core/mesh_files.h"
#include "core/options.h"
#include "core/part_names.h"
#include "core/sources.h"
#include "render/picture_options.h"

enum { SAID_MOST = 20 /* pairs that are told one by one as errors */, REFINE_MOST = 16 };

/* --parts as a list of names, and the text that these are in. */
typedef struct wanted_parts {
    char *text;
    const char **names;
    size_t count;
} wanted_parts;

/* user: the time when --timeout is over, for what is begun anew; 0: it counts itself. */
static bool should_stop(void *user)
{
    const double *until_s = user;
    return cli_interrupt_is_asked() || (*until_s > 0 && cli_now_s() > *until_s);
}

static int no_memory(cli_app *app)
{
    return cli_usage_error(app, NULL, "out of memory");
}

static int read_parts(cli_app *app, wanted_parts *out)
{
    const char *text = app->options->clear_parts;
    *out = (wanted_parts){.text = NULL};
    if (!text)
        return CLI_DONE;
    out->text = strdup(text);
    out->names = calloc(strlen(text) + 1, sizeof *out->names);
    if (!out->text || !out->names)
        return no_memory(app);
    for (char *at = out->text, *comma = at; comma; at = comma + 1) {
        comma = strchr(at, ',');
        if (comma)
            *comma = 0;
        if (!*at)
            return cli_usage_error(app, "as --parts lid,box",
                                   "--parts has a name that is empty: '%.80s'", text);
        out->names[out->count++] = at;
    }
    return CLI_DONE;
}

/* A part that was asked for is not there: which, and what is meant perhaps. */
static void say_missing(cli_app *app, const csgm_clearances *pairs, const wanted_parts *wanted)
{
    size_t count = 0;
    const char *name;
    while (csgm_clearances_part(pairs, count, &name))
        count++;
    const char **names = calloc(count + 1, sizeof *names);
    for (size_t k = 0; names && k < wanted->count; k++) {
        for (size_t i = 0; i < count; i++)
            csgm_clearances_part(pairs, i, &names[i]);
        if (cli_part_find(app, app->options->operands.items[0], wanted->names[k], names, count) !=
            CLI_DONE)
            break;
    }
    free(names);
}

/* The scene with its parameter at this pose: as if -D had said so. */
static csgm_status load_pose(cli_app *app, const cli_over *over, size_t pose, csgm_scene **scene)
{
    cli_options *o = app->options;
    const char *path = o->operands.items[0];
    if (!over->name)
        return cli_app_load(app, path, scene);
    cli_list before = o->defines;
    char value[CLI_OVER_TEXT];
    size_t size = strlen(over->name) + sizeof value + 2;
    char *define = malloc(size);
    const char **items = calloc(before.count + 1, sizeof *items);
    csgm_status status = CSGM_ERR_MEMORY;
    if (define && items) {
        snprintf(define, size, "%s=%s", over->name, cli_over_value(over, pose, value));
        for (size_t i = 0; i < before.count; i++)
            items[i] = before.items[i];
        items[before.count] = define;
        o->defines = (cli_list){items, before.count + 1};
        status = cli_app_load(app, path, scene);
        o->defines = before;
    } else {
        no_memory(app);
    }
    free(items);
    free(define);
    return status;
}

/* What is proven by then is worth telling. */
static bool is_stopped(csgm_status status)
{
    return status == CSGM_ERR_LIMIT || status == CSGM_ERR_MEMORY || status == CSGM_CANCELLED;
}

/* Steps that are not covered of pairs that are clear so far: those that smaller steps may cover. */
static size_t count_open(const csgm_clearances *pairs)
{
    size_t count = 0;
    const csgm_clear_pair *p;
    for (size_t i = 0; (p = csgm_clearances_get(pairs, i)) != NULL; i++)
        count += p->poses_bad + p->poses_open ? 0 : p->steps_open;
    return count;
}

/* All poses, as far as they go. open: over->count of them, those whose step is not covered. */
static csgm_status look_at_poses(cli_app *app, const cli_over *over, csgm_clearances *pairs,
                                 const wanted_parts *wanted, size_t *poses, bool *open)
{
    csgm_status status = CSGM_OK;
    size_t open_count = 0;
    for (size_t i = 0; i < over->count && status == CSGM_OK; i++) {
        csgm_scene *scene = NULL;
        status = load_pose(app, over, i, &scene);
        if (status == CSGM_OK && app->varies_nothing) {
            cli_usage_error(app, NULL,
                            "--over has nothing to change: the scene has no parameter '%.80s'",
                            over->name);
            status = CSGM_ERR_ARGUMENT;
        } else if (status == CSGM_OK && i == 0 && cli_sources_guard_scene(app, scene) != CLI_DONE)
            status = CSGM_ERR_ARGUMENT;
        if (status == CSGM_OK) {
            cli_interrupt_ask_first();
            status = csgm_clearances_add(pairs, scene);
            *poses += status == CSGM_OK || (is_stopped(status) && i == 0);
            if (status == CSGM_ERR_ARGUMENT)
                say_missing(app, pairs, wanted);
            size_t now = count_open(pairs);
            open[i] = now > open_count;
            open_count = now;
        }
        csgm_scene_destroy(scene);
        if (over->count > 1)
            cli_console_progress(&app->console, CSGM_STAGE_MEASURE,
                                 (double)(i + 1) / (double)over->count);
    }
    return status;
}

static cli_verdict worst_verdict(const cli_cleared *c)
{
    cli_verdict worst = CLI_PAIR_CLEAR;
    const csgm_clear_pair *p;
    for (size_t i = 0; (p = csgm_clearances_get(c->pairs, i)) != NULL; i++)
        if (cli_verdict_of(c, p) > worst)
            worst = cli_verdict_of(c, p);
    return worst;
}

/* Pairs that are not clear, as errors. */
static void say_faults(cli_app *app, const cli_cleared *cleared)
{
    const csgm_clear_pair *p;
    size_t said = 0;
    char text[600];
    for (size_t i = 0; (p = csgm_clearances_get(cleared->pairs, i)) != NULL; i++) {
        if (cli_verdict_of(cleared, p) == CLI_PAIR_CLEAR || ++said > SAID_MOST)
            continue;
        cli_clear_say(cleared, p, text, sizeof text);
        cli_console_say(&app->console, CSGM_ERROR, NULL, "%s: %s", cleared->path, text);
    }
    if (said > SAID_MOST)
        cli_console_say(&app->console, CSGM_ERROR, NULL, "%s: %zu more pairs are not clear",
                        cleared->path, said - SAID_MOST);
}

static int print(cli_app *app, const cli_cleared *cleared, csgm_status status)
{
    const cli_options *o = app->options;
    cli_console_end_progress(&app->console);
    if ((status != CSGM_OK && !is_stopped(status)) || !cleared->poses)
        return CLI_TROUBLE;
    if (status == CSGM_CANCELLED)
        cli_console_say(&app->console, CSGM_ERROR, NULL, "interrupted: this is proven so far");
    if (!o->clear_junit || strcmp(o->clear_junit, "-") != 0)
        (o->json ? cli_clear_json : cli_clear_text)(cleared);
    say_faults(app, cleared);
    cli_verdict worst = worst_verdict(cleared);
    int result = worst == CLI_PAIR_BAD                          ? CLI_INPUT_AT_FAULT
                 : worst == CLI_PAIR_OPEN || is_stopped(status) ? CLI_TROUBLE
                                                                : CLI_DONE;
    if (o->clear_junit && cli_clear_junit(app, cleared) != CLI_DONE)
        result = CLI_TROUBLE;
    return result;
}

/* The picture of the worst pair, whose pose's scene is made again. */
static int draw(cli_app *app, const cli_cleared *cleared, csgm_status status)
{
    const char *path = app->options->clear_picture;
    const csgm_clear_pair *worst = cli_clear_worst(cleared);
    csgm_scene *scene = NULL;
    if (!path || status != CSGM_OK)
        return CLI_DONE;
    if (!worst) {
        cli_console_say(&app->console, CSGM_ERROR, NULL,
                        "%s is not drawn: of each pair of parts one is empty", path);
        return CLI_TROUBLE;
    }
    int result = CLI_TROUBLE;
    if (load_pose(app, cleared->over, worst->pose, &scene) == CSGM_OK)
        result = cli_clear_picture(app, cleared, worst, scene, path);
    csgm_scene_destroy(scene);
    return result;
}

static int check_picture(cli_app *app)
{
    csgm_camera camera = {.azimuth_deg = 0};
    const cli_options *o = app->options;
    if (o->view && !o->clear_picture)
        return cli_usage_error(app, NULL, "--view needs --picture");
    if (cli_picture_view(app, &camera) != CLI_DONE)
        return CLI_TROUBLE;
    return o->clear_picture ? cli_picture_check(app, o->clear_picture) : CLI_DONE;
}

/* With --refine: whether there is a step to be halved; then it is. */
static bool refine(cli_app *app, cli_over *over, const bool *open, uint64_t round)
{
    bool is_any = false;
    for (size_t i = 1; i < over->count; i++)
        is_any |= open[i];
    return is_any && round < app->options->clear_refine &&
           cli_over_halve(app, over, open) == CLI_DONE;
}

/* Again and again, while steps are halved: what is halved is begun anew. */
static csgm_status look_at_all(cli_app *app, csgm_clear_options *options, cli_over *over,
                               const wanted_parts *wanted, size_t *poses, csgm_clearances **pairs)
{
    csgm_status status;
    bool is_again = false;
    double began_s = cli_now_s(), limit = app->options->timeout, until_s = 0;
    options->monitor = (csgm_monitor){.cancelled = should_stop, .user = &until_s};
    for (uint64_t round = 0;; round++) {
        bool *open = calloc(over->count, sizeof *open);
        csgm_clearances_destroy(*pairs);
        *pairs = NULL;
        *poses = 0;
        status = open ? csgm_clearances_create(app->context, options, pairs) : CSGM_ERR_MEMORY;
        if (status == CSGM_OK)
            status = look_at_poses(app, over, *pairs, wanted, poses, open);
        is_again = status == CSGM_OK && refine(app, over, open, round);
        free(open);
        if (!is_again)
            break;
        until_s = limit > 0 ? began_s + limit : 0;
    }
    if (status != CSGM_CANCELLED || cli_interrupt_is_asked())
        return status;
    cli_console_say(&app->console, CSGM_ERROR, NULL,
                    "halving steps took longer than the limit of %g s: this is proven so far",
                    limit);
    return CSGM_ERR_LIMIT;
}

static int clear(cli_app *app, cli_over *over, const wanted_parts *wanted)
{
    const cli_options *o = app->options;
    csgm_clear_options options = csgm_clear_options_default();
    cli_cleared cleared = {.path = o->operands.items[0], .over = over, .between = o->clear_between};
    csgm_clearances *pairs = NULL;
    options.tolerance = o->clear_to;
    options.min_gap = cleared.min_gap = o->clear_min_gap;
    options.parts = wanted->names;
    options.part_count = wanted->count;
    app->varied = over->name;
    csgm_status status = look_at_all(app, &options, over, wanted, &cleared.poses, &pairs);
    cleared.pairs = pairs;
    int result = pairs ? print(app, &cleared, status) : CLI_TROUBLE;
    if (pairs && draw(app, &cleared, status) != CLI_DONE)
        result = CLI_TROUBLE;
    csgm_clearances_destroy(pairs);
    return result;
}

int cli_cmd_clear(cli_app *app)
{
    const cli_list *operands = &app->options->operands;
    cli_over over = {.count = 1};
    wanted_parts wanted = {.text = NULL};
    if (operands->count != 1)
        return cli_usage_error(app, "as csgmesh clear hinge.txt",
                               operands->count ? "one scene is looked at at a time"
                                               : "no scene given");
    if (app->options->clear_over && strcmp(operands->items[0], "-") == 0)
        return cli_usage_error(app, NULL,
                               "--over reads the scene many times, and standard input comes once");
    if (app->options->clear_between && !app->options->clear_over)
        return cli_usage_error(app, "as --over t=0:0.01:1", "--between needs --over");
    if (app->options->clear_refine && !app->options->clear_over)
        return cli_usage_error(app, "as --over t=0:0.01:1", "--refine needs --over");
    if (app->options->clear_refine > REFINE_MOST)
        return cli_usage_error(app, NULL, "--refine halves a step %d times at most", REFINE_MOST);
    int status = cli_over_read(app, app->options->clear_over, &over);
    if (status == CLI_DONE)
        status = check_picture(app);
    if (status == CLI_DONE)
        status = read_parts(app, &wanted);
    if (status == CLI_DONE)
        status = cli_app_open(app);
    if (status == CLI_DONE)
        status = cli_finish_stdout(app, clear(app, &over, &wanted));
    free(wanted.names);
    free(wanted.text);
    cli_over_release(&over);
    return status;
}
