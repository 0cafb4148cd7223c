/* SPDX-License-Identifier: MIT
 * What wasi-libc lacks of POSIX and the library asks for, put before every file of the build for
 * WebAssembly. There are no users, processes or locks in a page: each call says so as a system
 * would that lacks it, and the library goes its way for such systems.
 */
#ifndef CSGMESH_WEB_MISSING_H
#define CSGMESH_WEB_MISSING_H
#ifndef __ASSEMBLER__

#include <errno.h>
#include <fcntl.h>
#include <stddef.h>
#include <sys/resource.h>
#include <sys/types.h>
#include <time.h>

#ifdef __cplusplus
extern "C" {
#endif

#define CLOCK_THREAD_CPUTIME_ID CLOCK_MONOTONIC /* the only thread's */

static inline int csgmesh_web_lacks(void)
{
    errno = ENOSYS;
    return -1;
}

/* limits */
#define RLIMIT_DATA 2
#define RLIM_INFINITY (~0ULL)
struct rlimit {
    unsigned long long rlim_cur, rlim_max;
};
#define getrlimit(resource, limit) ((void)(limit), csgmesh_web_lacks())

struct csgmesh_web_usage {
    long ru_maxrss;
};
#define rusage csgmesh_web_usage
#define getrusage(who, usage) (*(usage) = (struct csgmesh_web_usage){0}, csgmesh_web_lacks())

/* processors */
typedef struct cpu_set_t {
    unsigned long bits;
} cpu_set_t;
#define sched_getaffinity(process, size, set) ((void)(set), csgmesh_web_lacks())
#define CPU_COUNT(set) ((set)->bits != 0)

/* users */
static inline unsigned geteuid(void)
{
    return 0;
}
static inline unsigned getegid(void)
{
    return 0;
}
#define fchown(descriptor, user, group) csgmesh_web_lacks()
#define fchmod(descriptor, mode) csgmesh_web_lacks()

/* files: descriptors cannot be copied, and nobody else has any open */
#define F_DUPFD_CLOEXEC 1030
#define dup(descriptor) csgmesh_web_lacks()
#define LOCK_EX 2
#define LOCK_NB 4
#define flock(descriptor, how) csgmesh_web_lacks()

#ifdef __cplusplus
}
#endif
#endif
#endif
