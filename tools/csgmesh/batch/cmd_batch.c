/* SPDX-License-Identifier: MIT
 * csgmesh batch [MANIFEST | SCENE...] -d DIR: many scenes, in parallel, those up to date left
 * alone; or the rules with which a build system does the same.
 */
#include <stdlib.h>
#include <sys/resource.h>

#include "batch/batch_http.h"
#include "batch/batch_merge.h"
#include "batch/batch_report.h"
#include "batch/batch_shard.h"
#include "core/commands.h"
#include "core/options.h"
#include "core/work.h"
#include "emit/emit.h"
#include "mesh/outputs.h"

static int check_usage(cli_app *app)
{
    const cli_options *options = app->options;
    if (!options->operands.count)
        return cli_usage_error(app, "as csgmesh batch parts/*.txt -d out",
                               "no manifest and no scenes given");
    if (options->keep_going && options->fail_fast)
        return cli_usage_error(app, NULL, "--keep-going and --fail-fast exclude each other");
    if (options->merged)
        return cli_usage_error(app, "-d names the folder of the outputs, --name the outputs",
                               "-o is for --merge-reports");
    if (options->times && !options->shard)
        return cli_usage_error(app, NULL, "--times is for --shard");
    if (cli_outputs_check_contents(app) != CLI_DONE)
        return CLI_TROUBLE;
    int status = cli_work_check(app);
    if (status != CLI_DONE)
        return status;
    if (options->cache && !batch_hash_available())
        return cli_usage_error(app, "install libb2 and build csgmesh again",
                               "--cache: this csgmesh was built without libb2");
    if (batch_http_is_address(options->cache) && !batch_http_available())
        return cli_usage_error(app, "install libcurl and build csgmesh again, or name a folder",
                               "--cache: this csgmesh was built without libcurl");
    return CLI_DONE;
}

/* A job's files are open until all of them are complete, and it may have many parts. */
static void raise_limit_of_files(void)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_NOFILE, &limit) == 0) {
        limit.rlim_cur = limit.rlim_max;
        setrlimit(RLIMIT_NOFILE, &limit); /* else there are fewer */
    }
}

static int run_plan(cli_app *app, batch_plan *plan)
{
    raise_limit_of_files();
    batch_run state = {.app = app, .plan = plan};
    int status = batch_run_all(&state);
    if (status == CLI_DONE)
        status = batch_report_end(&state);
    for (size_t i = 0; state.results && i < plan->count; i++) {
        free(state.results[i].messages);
        cli_arena_reset(&state.results[i].arena);
    }
    return status;
}

int cli_cmd_batch(cli_app *app)
{
    batch_plan plan = {0};
    batch_shard shard;
    if (app->options->merge_reports)
        return batch_merge_reports(app);
    const char *cache = getenv("CSGMESH_CACHE");
    if (!app->options->cache && cache && *cache)
        app->options->cache = cache;
    int status = check_usage(app);
    if (status == CLI_DONE)
        status = batch_shard_read(app, &shard);
    if (status == CLI_DONE)
        status = cli_app_open(app);
    if (status == CLI_DONE)
        status = batch_plan_make(app, &plan);
    plan.shard = shard;
    if (status == CLI_DONE)
        status = batch_shard_choose(&plan);
    if (status == CLI_DONE)
        status = app->options->emit ? emit_plan(&plan) : run_plan(app, &plan);
    batch_plan_release(&plan);
    return status;
}
