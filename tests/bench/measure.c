/* SPDX-License-Identifier: MIT
 * Runs a command and says on standard output, as JSON, what it cost: wall, user and system time and
 * the most memory it had. A program of its own, because a child's memory counts from before its
 * exec: started by a script's interpreter it would never be less than the interpreter's.
 *
 *   measure COMMAND ARGUMENT...
 */
#include <spawn.h>
#include <stdio.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>

extern char **environ;

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double seconds(struct timeval t)
{
    return (double)t.tv_sec + 1e-6 * (double)t.tv_usec;
}

int main(int argc, char **argv)
{
    pid_t child;
    int status;
    struct rusage usage;
    double begin_s = now_s();
    if (argc < 2 || posix_spawnp(&child, argv[1], NULL, NULL, argv + 1, environ) != 0 ||
        wait4(child, &status, 0, &usage) != child) {
        fprintf(stderr, "measure: cannot run %s\n", argc < 2 ? "nothing" : argv[1]);
        return 2;
    }
    double wall_s = now_s() - begin_s;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        return 1;
    /* Linux counts KiB */
    printf("{\"wall_s\": %.6f, \"user_s\": %.6f, \"sys_s\": %.6f, \"peak_rss_bytes\": %lld}\n",
           wall_s, seconds(usage.ru_utime), seconds(usage.ru_stime),
           (long long)usage.ru_maxrss * 1024);
    return 0;
}
