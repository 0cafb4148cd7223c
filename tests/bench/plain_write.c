/* SPDX-License-Identifier: MIT
 * The limit that csgmesh is held against: how long it takes to write so many bytes to a new file
 * from a buffer that is there already. Prints the seconds of the writes alone and with the fsync
 * and the rename that make a file appear complete or not at all. The file is removed.
 *
 *   plain_write BYTES FILE
 */
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { CHUNK = 1 << 20 };

static uint8_t chunk[CHUNK];

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int write_all(int fd, uint64_t count)
{
    while (count) {
        ssize_t written = write(fd, chunk, count < CHUNK ? (size_t)count : CHUNK);
        if (written <= 0)
            return -1;
        count -= (uint64_t)written;
    }
    return 0;
}

int main(int argc, char **argv)
{
    if (argc != 3)
        return 2;
    uint64_t count = strtoull(argv[1], NULL, 10);
    char temporary[4096];
    snprintf(temporary, sizeof temporary, "%s.tmp", argv[2]);
    memset(chunk, 0x5a, sizeof chunk); /* no page of it is touched for the first time below */

    double begin_s = now_s();
    int fd = open(temporary, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (fd < 0 || write_all(fd, count) != 0) {
        perror(temporary);
        return 1;
    }
    double written_s = now_s() - begin_s;
    if (fsync(fd) != 0 || close(fd) != 0 || rename(temporary, argv[2]) != 0) {
        perror(temporary);
        return 1;
    }
    double durable_s = now_s() - begin_s;
    unlink(argv[2]);
    printf("{\"write_s\": %.6f, \"write_sync_s\": %.6f}\n", written_s, durable_s);
    return 0;
}
