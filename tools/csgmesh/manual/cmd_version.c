/* SPDX-License-Identifier: MIT
 * csgmesh version: what --version and -V say, too.
 */
#include <stdio.h>

#include "batch/batch_hash.h"
#include "batch/batch_http.h"
#include "core/cli.h"
#include "core/commands.h"
#include "core/options.h"
#include "view/view_server.h"

/* csgmesh-mpi stands beside this program, which needs no MPI itself. */
static const char *ranks_feature(void)
{
#ifdef CLI_HAS_MPI
    return "with MPI " CLI_HAS_MPI " (csgmesh-mpi)";
#else
    return "without MPI (missing: csgmesh-mpi, one mesh by many processes)";
#endif
}

int cli_print_version(cli_app *app)
{
    int status = cli_app_open(app);
    if (status == CLI_DONE)
        printf("csgmesh %s (%s)\n%s\n%s\n%s\n%s\n%s\n", csgm_version(),
               csgm_context_isa(app->context), csgm_build_features(), batch_hash_feature(),
               batch_http_feature(), view_server_feature(), ranks_feature());
    return cli_finish_stdout(app, status);
}

int cli_cmd_version(cli_app *app)
{
    if (app->options->operands.count)
        return cli_usage_error(app, NULL, "version takes no '%s'", app->options->operands.items[0]);
    return cli_print_version(app);
}
