/* SPDX-License-Identifier: MIT
 * What csgmesh-mpi says of itself, and which options of csgmesh mesh it does not take.
 */
#ifndef CLI_RANKS_MANUAL_H
#define CLI_RANKS_MANUAL_H

#include "core/cli.h"
#include "core/options.h"

/* Says which of the options given it does not take: CLI_TROUBLE; none: CLI_DONE. */
int cli_ranks_refuse_options(cli_app *app);
/* --version, --help, --man, on standard output. */
void cli_ranks_tell_version(const char *library);
void cli_ranks_tell_help(void);
void cli_ranks_tell_page(void);

#endif
