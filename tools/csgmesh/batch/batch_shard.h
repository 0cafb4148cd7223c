/* SPDX-License-Identifier: MIT
 * A batch on many machines: which of its jobs are made here. Each machine finds the same answer by
 * itself, from the list of jobs and the times of an earlier report, so that every job is made by
 * one machine exactly and none needs to ask another.
 *
 * A job goes to the shard for which its name's hash is highest (rendezvous hashing: Thaler and
 * Ravishankar 1998), among those that have room for it: no shard gets more than a sixteenth above
 * the average (consistent hashing with bounded loads: Mirrokni, Thorup and Zadimoghaddam 2018), as
 * far as single long jobs allow. So a scene more or less moves few others.
 */
#ifndef CLI_BATCH_SHARD_H
#define CLI_BATCH_SHARD_H

#include "batch/batch_plan.h"

enum { BATCH_SHARDS_MOST = 100000, BATCH_JOB_NAME = 17 /* sixteen digits */ };

/* The name of a job in reports: of the files that it makes, below the directory. */
void batch_job_name(const batch_job *job, char name[BATCH_JOB_NAME]);
/* The name of the whole batch. */
void batch_shard_name(const batch_shard *shard, char name[BATCH_JOB_NAME]);

/* --shard: "3/8", or "slurm" or "mpi" for what the environment says. CLI_DONE, or CLI_TROUBLE after
 * a report. Without it the batch is the only shard. */
int batch_shard_read(cli_app *app, batch_shard *out);
/* Leaves the plan the jobs of its shard alone, and says of which batch they are. CLI_DONE, or an
 * exit status after a report. */
int batch_shard_choose(batch_plan *plan);

#endif
