/* SPDX-License-Identifier: MIT
 * The ranks of csgmesh-mpi. MPI is named in ranks.c alone.
 */
#ifndef CLI_RANKS_H
#define CLI_RANKS_H

#include "csgmesh/ranks.h"

/* Joins the job that mpirun has started; false: there is none (MPI has said why). */
bool cli_ranks_begin(int *argc, char ***argv);
uint32_t cli_ranks_rank(void);
uint32_t cli_ranks_count(void);
csgm_communicator cli_ranks_communicator(void);
/* "Open MPI v4.1.4", in the library's own words. */
const char *cli_ranks_library(void);

enum { CLI_RANKS_TEXT_MOST = 64 };
/* The first rank whose text of so many bytes (CLI_RANKS_TEXT_MOST at most) is not that of rank 0;
 * the count of ranks: all are the same. */
uint32_t cli_ranks_first_other(const void *text, size_t bytes);
/* The lowest rank of those that say yes; the count of ranks: none does. */
uint32_t cli_ranks_first_of(bool yes);
/* The largest of all. */
int cli_ranks_most(int value);
/* Everybody's to rank 0, where `all` has room for them. */
void cli_ranks_collect(const void *own, size_t bytes, void *all);
void cli_ranks_end(void);

#endif
