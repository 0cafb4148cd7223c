/* SPDX-License-Identifier: MIT
 * csgmesh-mpi: `csgmesh mesh` of one file, by all ranks of a job that mpirun has started. Rank 0
 * speaks. What ends the work is told once, by the first rank where it happened: the others hold
 * back what they have to say.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "core/cli.h"
#include "core/interrupt.h"
#include "core/options.h"
#include "core/textfile.h"
#include "core/work.h"
#include "mesh/certify.h"
#include "mesh/drawings.h"
#include "mesh/outputs.h"
#include "mesh/statistics.h"
#include "ranks/hash.h"
#include "ranks/manual.h"
#include "ranks/ranks.h"
#include "ranks/resume.h"

/* What a rank holds back until it is known whether it has to say it. */
typedef struct held {
    char *text;
    size_t length;
} held;

/* ---- what can be asked for ----------------------------------------------------------------------
 */

static int refuse_options(cli_app *app)
{
    const cli_options *o = app->options;
    int status = cli_ranks_refuse_options(app);
    if (status != CLI_DONE)
        return status;
    if (o->outputs.count != 1 || strcmp(o->outputs.items[0], "-") == 0)
        return cli_usage_error(app, "as -o lattice.ply",
                               "csgmesh-mpi writes one file: give one -o");
    if (cli_drawings_count(o))
        return cli_usage_error(app, NULL, "csgmesh-mpi makes meshes and no drawings");
    return CLI_DONE;
}

static int check_options(cli_app *app)
{
    const cli_list *operands = &app->options->operands;
    if (operands->count != 1)
        return cli_usage_error(app, "as mpirun -n 8 csgmesh-mpi lattice.txt -r 2048 -o lattice.ply",
                               operands->count ? "one scene at a time" : "no scene given");
    int status = refuse_options(app);
    if (status == CLI_DONE)
        status = cli_outputs_check(app, operands->items[0]);
    return status == CLI_DONE ? cli_work_check(app) : status;
}

/* ---- what must be the same everywhere -----------------------------------------------------------
 */

/* The build, as far as bytes depend on it. Rank 0 says who differs. CLI_DONE, or all end. */
static int compare_builds(cli_app *app)
{
    char build[CLI_RANKS_TEXT_MOST];
    memset(build, 0, sizeof build);
    snprintf(build, sizeof build, "%s %zu", csgm_version(), sizeof(csgm_mesh_options));
    uint32_t other = cli_ranks_first_other(build, sizeof build);
    if (other == cli_ranks_count())
        return CLI_DONE;
    if (cli_ranks_rank() == 0)
        cli_console_say(&app->console, CSGM_ERROR, "all ranks need one build",
                        "rank %u runs another version than rank 0, which is %s", (unsigned)other,
                        csgm_version());
    return CLI_TROUBLE;
}

static void add_text(void *user, const char *text, size_t length)
{
    uint64_t *hash = user;
    *hash = cli_hash_add(*hash, text, length);
}

/* The scene as it was read, and the options that meshes depend on: files can differ where ranks run
 * on several machines. */
static int compare_scenes(cli_app *app, const cli_work *work, const cli_resume *resume, int argc,
                          char **argv, uint64_t *scene)
{
    uint64_t hash = CLI_HASH_BEGIN;
    csgm_status status =
        csgm_scene_dump(app->context, work->scene, CSGM_DUMP_SCENE, add_text, &hash);
    *scene = hash;
    add_text(&hash, resume->is_asked ? "resume" : "", resume->is_asked ? 6 : 0);
    for (int i = 1; i < argc; i++)
        add_text(&hash, argv[i], strlen(argv[i]) + 1);
    if (cli_ranks_most(cli_exit_status(status)) != CLI_DONE)
        return CLI_TROUBLE;
    uint32_t other = cli_ranks_first_other(&hash, sizeof hash);
    if (other == cli_ranks_count())
        return CLI_DONE;
    if (cli_ranks_rank() == 0)
        cli_console_say(&app->console, CSGM_ERROR, "all ranks need the same files and options",
                        "rank %u has another scene or other options than rank 0", (unsigned)other);
    return CLI_TROUBLE;
}

/* ---- --stats ------------------------------------------------------------------------------------
 */

typedef struct share {
    csgm_rank_work work;
    double processor_s;
    uint64_t peak_rss_bytes;
    uint32_t threads;
} share;

static share own_share(const cli_app *app)
{
    struct rusage used;
    share own = {.work = csgm_rank_work_default(),
                 .peak_rss_bytes = cli_peak_rss_bytes(),
                 .threads = csgm_context_threads(app->context)};
    csgm_context_rank_work(app->context, &own.work);
    getrusage(RUSAGE_SELF, &used);
    own.processor_s = (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                      1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
    return own;
}

static void put_share(cli_json *json, const share *of)
{
    cli_json_open(json, NULL, '{');
    cli_json_count(json, "cubes", of->work.cubes);
    cli_json_count(json, "halo_cubes", of->work.halo_cubes);
    cli_json_count(json, "tasks", of->work.tasks);
    cli_json_count(json, "vertices", of->work.vertices);
    cli_json_count(json, "triangles", of->work.triangles);
    cli_json_count(json, "received_bytes", of->work.received_bytes);
    cli_json_count(json, "resumed_cubes", of->work.resumed_cubes);
    cli_json_number(json, "processor_s", of->processor_s);
    cli_json_count(json, "peak_rss_bytes", of->peak_rss_bytes);
    cli_json_count(json, "threads", of->threads);
    cli_json_end(json, '}');
}

static int write_statistics(cli_app *app, const share *shares, const cli_report *report)
{
    cli_text text;
    if (cli_text_open(&text)) {
        cli_json json = cli_json_make(text.out, true);
        cli_json_begin(&json, '{');
        cli_json_string(&json, "csgmesh", csgm_version());
        cli_json_string(&json, "mpi", cli_ranks_library());
        cli_json_open(&json, "mesh", '{');
        cli_json_count(&json, "vertices", report->vertices);
        cli_json_count(&json, "triangles", report->triangles);
        cli_json_end(&json, '}');
        cli_json_open(&json, "time_s", '{');
        cli_json_number(&json, "total", report->total_s);
        cli_json_end(&json, '}');
        cli_json_bool(&json, "shared_again", shares[0].work.shared_again);
        cli_json_open(&json, "ranks", '[');
        for (uint32_t i = 0; i < cli_ranks_count(); i++)
            put_share(&json, &shares[i]);
        cli_json_end(&json, ']');
        cli_json_string(&json, "simd", csgm_context_isa(app->context));
        cli_json_end(&json, '}');
    }
    return cli_text_write(app, &text, app->options->stats);
}

static int tell_shares(cli_app *app, const cli_report *report)
{
    share own = own_share(app);
    if (cli_ranks_count() == 1) { /* it has joined nobody */
        own.work.vertices = report->vertices;
        own.work.triangles = report->triangles;
    }
    bool first = cli_ranks_rank() == 0;
    share *all = first ? calloc(cli_ranks_count(), sizeof *all) : NULL;
    if (cli_ranks_most(first && !all))
        return CLI_TROUBLE;
    cli_ranks_collect(&own, sizeof own, all);
    int status = first ? write_statistics(app, all, report) : CLI_DONE;
    free(all);
    return status;
}

/* ---- the run ------------------------------------------------------------------------------------
 */

/* The file is named by rank 0 when all have agreed that it may be. */
static int make_file(cli_app *app, cli_work *work, cli_report *report)
{
    uint64_t counts[2];
    csgm_write_options options = cli_outputs_options(app, app->options->operands.items[0]);
    int status = cli_exit_status(csgm_files_hold(app->context));
    if (cli_ranks_most(status) != CLI_DONE)
        return CLI_TROUBLE;
    status = cli_work_mesh_file(app, work, app->options->outputs.items[0],
                                cli_outputs_format(app->options, 0), &options, counts, NULL);
    if (status == CLI_DONE && cli_app_is_refused(app))
        status = CLI_INPUT_AT_FAULT;
    int agreed = cli_ranks_most(status);
    csgm_status named = csgm_files_release(app->context, agreed == CLI_DONE);
    status = cli_ranks_most(agreed != CLI_DONE ? agreed : cli_exit_status(named));
    report->vertices = counts[0];
    report->triangles = counts[1];
    report->total_s = cli_now_s() - app->start_s;
    return status;
}

static int mesh_scene(cli_app *app, held *kept, cli_resume *resume, int argc, char **argv)
{
    cli_work work = {0};
    uint64_t scene = 0;
    cli_report report = {0};
    csgm_communicator by = cli_ranks_communicator();
    app->flat = cli_drawings_flat(app->options);
    int status = cli_work_load(app, &work, app->options->operands.items[0]);
    status = cli_ranks_most(status);
    if (status == CLI_DONE && kept->text) /* warnings of reading are rank 0's to say */
        rewind(app->console.out);
    if (status == CLI_DONE)
        status = compare_scenes(app, &work, resume, argc, argv, &scene);
    if (status == CLI_DONE)
        status = cli_ranks_most(cli_exit_status(csgm_context_join(app->context, &by)));
    if (status == CLI_DONE)
        status = cli_resume_begin(resume, app, scene);
    if (status == CLI_DONE)
        status = make_file(app, &work, &report);
    cli_resume_end(resume, status == CLI_DONE);
    if (status == CLI_DONE)
        cli_certify_tell(app, &work.stats.certify);
    if (status == CLI_DONE && app->options->stats)
        status = cli_ranks_most(tell_shares(app, &report));
    cli_work_release(&work);
    return status;
}

static int mesh_as_asked(cli_app *app, held *kept, int argc, char **argv)
{
    cli_problem problem;
    cli_resume resume = cli_resume_make();
    cli_resume_take(&resume, &argc, argv);
    bool parsed = cli_options_parse(app->options, CLI_MESH, argc - 1, argv + 1, &problem);
    FILE *out = app->console.out;
    cli_console_configure(&app->console, app->options);
    app->console.out = out;
    if (cli_ranks_rank() != 0)
        app->console.is_terminal = false;
    int status = compare_builds(app);
    if (status != CLI_DONE)
        return status;
    if (!parsed)
        status = cli_usage_error(app, problem.hint[0] ? problem.hint : NULL, "%s", problem.message);
    else
        status = check_options(app);
    if (!app->options->threads)
        app->options->threads = 1;
    if (status == CLI_DONE)
        status = cli_app_open(app);
    status = cli_ranks_most(status);
    return status == CLI_DONE ? mesh_scene(app, kept, &resume, argc, argv) : status;
}

/* --version and --help need no other rank. */
static bool is_asked_for(int argc, char **argv, const char *name, const char *letter)
{
    bool asked = false;
    for (int i = 1; i < argc; i++)
        asked |= strcmp(argv[i], name) == 0 || strcmp(argv[i], letter) == 0;
    return asked;
}

static void tell_about(int argc, char **argv)
{
    if (is_asked_for(argc, argv, "--version", "-V"))
        cli_ranks_tell_version(cli_ranks_library());
    else
        cli_ranks_tell_help();
}

int main(int argc, char **argv)
{
    cli_options options = {.command = CLI_MESH};
    cli_app app = {.options = &options, .start_s = cli_now_s(), .console = cli_console_make()};
    held kept = {0};
    if (argc == 2 && strcmp(argv[1], "--man") == 0) { /* also where MPI cannot be started */
        cli_ranks_tell_page();
        return fflush(stdout) == 0 ? CLI_DONE : CLI_TROUBLE;
    }
    if (!cli_ranks_begin(&argc, &argv))
        return CLI_TROUBLE;
    cli_interrupt_install();
    cli_interrupt_be_silent(); /* mpirun says what ended the job */
    int status = CLI_DONE;
    if (argc < 2 || is_asked_for(argc, argv, "--version", "-V") ||
        is_asked_for(argc, argv, "--help", "-h")) {
        if (cli_ranks_rank() == 0)
            tell_about(argc, argv);
        status = argc < 2 ? CLI_TROUBLE : CLI_DONE;
    } else {
        FILE *out = cli_ranks_rank() ? open_memstream(&kept.text, &kept.length) : NULL;
        if (out)
            app.console.out = out;
        status = mesh_as_asked(&app, &kept, argc, argv);
        cli_console_flush(&app.console);
        if (out)
            fclose(out);
        if (cli_ranks_first_of(app.console.errors > 0) == cli_ranks_rank() && kept.text)
            fwrite(kept.text, 1, kept.length, stderr);
        free(kept.text);
    }
    csgm_context_destroy(app.context);
    cli_options_release(&options);
    cli_ranks_end();
    return status;
}
