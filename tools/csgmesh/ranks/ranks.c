/* SPDX-License-Identifier: MIT
 * Exchanges by MPI; see ranks.h. All are on the main thread.
 */
#include "ranks/ranks.h"

#include <limits.h>
#include <mpi.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static int rank, count;

bool cli_ranks_begin(int *argc, char ***argv)
{
    int given;
    if (MPI_Init_thread(argc, argv, MPI_THREAD_FUNNELED, &given) != MPI_SUCCESS ||
        given < MPI_THREAD_FUNNELED)
        return false;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &count);
    return true;
}

uint32_t cli_ranks_rank(void)
{
    return (uint32_t)rank;
}

uint32_t cli_ranks_count(void)
{
    return (uint32_t)count;
}

const char *cli_ranks_library(void)
{
    static char text[MPI_MAX_LIBRARY_VERSION_STRING];
    int length;
    MPI_Get_library_version(text, &length);
    text[strcspn(text, ",\n")] = '\0';
    return text;
}

/* Until it is done, with ever longer pauses: MPI's own waiting takes a whole core, which ranks that
 * still work may need, and hides in processor times who had nothing to do. */
static bool wait_for(int started, MPI_Request *request)
{
    enum { FIRST_NS = 1000, MOST_NS = 1000000 };
    struct timespec pause = {.tv_nsec = FIRST_NS};
    int done = 0;
    if (started != MPI_SUCCESS)
        return false;
    while (MPI_Test(request, &done, MPI_STATUS_IGNORE) == MPI_SUCCESS && !done) {
        nanosleep(&pause, NULL);
        pause.tv_nsec = pause.tv_nsec < MOST_NS / 2 ? 2 * pause.tv_nsec : MOST_NS;
    }
    return done;
}

/* ---- bytes of all ranks ------------------------------------------------------------------------
 */

/* MPI counts in int. */
static bool gather_few(int to, const void *own, const uint64_t *bytes, void *all)
{
    int *counts = malloc(2 * (size_t)count * sizeof *counts), *places = counts + count, at = 0;
    for (int i = 0; counts && i < count; i++) {
        places[i] = at;
        at += counts[i] = (int)bytes[i];
    }
    int own_bytes = (int)bytes[rank];
    MPI_Request request;
    bool done = counts != NULL;
    if (done && to == CSGM_ALL_RANKS)
        done = wait_for(MPI_Iallgatherv(own, own_bytes, MPI_BYTE, all, counts, places, MPI_BYTE,
                                        MPI_COMM_WORLD, &request),
                        &request);
    else if (done)
        done = wait_for(MPI_Igatherv(own, own_bytes, MPI_BYTE, all, counts, places, MPI_BYTE, to,
                                     MPI_COMM_WORLD, &request),
                        &request);
    free(counts);
    return done;
}

/* One portion of what rank `from` has, to `to` or to all. */
static bool send_portion(int from, int to, const uint8_t *own, int bytes, uint8_t *place)
{
    MPI_Request request;
    if (to == CSGM_ALL_RANKS)
        return wait_for(MPI_Ibcast(place, bytes, MPI_BYTE, from, MPI_COMM_WORLD, &request),
                        &request);
    if (from == to || (rank != from && rank != to))
        return true;
    if (rank == from)
        return wait_for(MPI_Isend(own, bytes, MPI_BYTE, to, 0, MPI_COMM_WORLD, &request), &request);
    return wait_for(MPI_Irecv(place, bytes, MPI_BYTE, from, 0, MPI_COMM_WORLD, &request), &request);
}

/* The same for any number of bytes. */
static bool gather_many(int to, const void *own, const uint64_t *bytes, void *all)
{
    const uint64_t PORTION = 1 << 30;
    uint8_t *place = all;
    bool done = true;
    for (int from = 0; from < count && done; from++) {
        if (from == rank && place && bytes[from])
            memcpy(place, own, bytes[from]);
        for (uint64_t at = 0; at < bytes[from] && done; at += PORTION) {
            uint64_t left = bytes[from] - at;
            done = send_portion(from, to, (const uint8_t *)own + (from == rank ? at : 0),
                                (int)(left < PORTION ? left : PORTION), place ? place + at : NULL);
        }
        if (place)
            place += bytes[from];
    }
    return done;
}

static bool gather(void *user, uint32_t to, const void *own, const uint64_t *bytes, void *all)
{
    (void)user;
    uint64_t total = 0;
    for (int i = 0; i < count; i++)
        total += bytes[i];
    return (total <= INT_MAX ? gather_few : gather_many)((int)to, own, bytes, all);
}

csgm_communicator cli_ranks_communicator(void)
{
    csgm_communicator by = csgm_communicator_default();
    by.rank = (uint32_t)rank;
    by.count = (uint32_t)count;
    by.gather = gather;
    return by;
}

/* ---- short words -------------------------------------------------------------------------------
 */

static int reduce(int own, MPI_Op by)
{
    int all = own;
    MPI_Request request;
    wait_for(MPI_Iallreduce(&own, &all, 1, MPI_INT, by, MPI_COMM_WORLD, &request), &request);
    return all;
}

uint32_t cli_ranks_first_of(bool yes)
{
    return (uint32_t)reduce(yes ? rank : count, MPI_MIN);
}

int cli_ranks_most(int value)
{
    return reduce(value, MPI_MAX);
}

uint32_t cli_ranks_first_other(const void *text, size_t bytes)
{
    MPI_Request request;
    uint8_t first[CLI_RANKS_TEXT_MOST] = {0};
    memcpy(first, text, bytes);
    wait_for(MPI_Ibcast(first, (int)bytes, MPI_BYTE, 0, MPI_COMM_WORLD, &request), &request);
    return cli_ranks_first_of(memcmp(first, text, bytes) != 0);
}

void cli_ranks_collect(const void *own, size_t bytes, void *all)
{
    MPI_Request request;
    wait_for(MPI_Igather(own, (int)bytes, MPI_BYTE, all, (int)bytes, MPI_BYTE, 0, MPI_COMM_WORLD,
                         &request),
             &request);
}

void cli_ranks_end(void)
{
    MPI_Finalize();
}
