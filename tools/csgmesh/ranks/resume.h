/* SPDX-License-Identifier: MIT
 * csgmesh-mpi --resume: a folder beside the output, OUTPUT.resume, in which a job keeps what it has
 * finished, and what the next one, with the same command line, goes on with. Its file `head` says
 * which job it is of; the rest is the library's (csgm_context_keep). A job that is done removes it.
 */
#ifndef CLI_RANKS_RESUME_H
#define CLI_RANKS_RESUME_H

#include "core/cli.h"

typedef struct cli_resume {
    bool is_asked;
    char folder[4096];
    bool is_own; /* rank 0: the folder is this job's */
    int head;    /* rank 0: open and locked while the job lasts; -1: not open */
} cli_resume;

cli_resume cli_resume_make(void);
/* Takes --resume out of the arguments. */
void cli_resume_take(cli_resume *resume, int *argc, char **argv);
/* All ranks: rank 0 makes the folder, or finds one that is of this job; scene: a hash of what was
 * read. CLI_DONE, or CLI_TROUBLE on all: it was said why. */
int cli_resume_begin(cli_resume *resume, cli_app *app, uint64_t scene);
/* Rank 0: is_done: removes the folder. */
void cli_resume_end(cli_resume *resume, bool is_done);

#endif
