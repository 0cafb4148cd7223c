/* SPDX-License-Identifier: MIT
 * Files without a name; see temporary.h. Hidden names in use stand in a fixed table of the process,
 * so that a signal handler can unlink them without a lock or an allocation. A seventeenth at the
 * same time is not in the table: an interrupt would leave it to the next run's sweep.
 */
#include "io/temporary.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

#include "io/formats.h"

/* ---- names in use ----------------------------------------------------------------- */

enum { SLOTS = 16, SLOT_FREE = 0, SLOT_TAKEN, SLOT_LIVE };

static struct {
    atomic_int state;
    char name[PATH_MAX];
} pending[SLOTS];

static int pending_add(const char *name)
{
    size_t length = strlen(name) + 1;
    for (int i = 0; i < SLOTS && length <= PATH_MAX; i++) {
        int expected = SLOT_FREE;
        if (!atomic_compare_exchange_strong(&pending[i].state, &expected, SLOT_TAKEN))
            continue;
        memcpy(pending[i].name, name, length);
        atomic_store(&pending[i].state, SLOT_LIVE);
        return i;
    }
    return -1;
}

static void pending_remove(csg_temporary *file)
{
    if (file->slot >= 0)
        atomic_store(&pending[file->slot].state, SLOT_FREE);
    file->slot = -1;
}

void csg_io_cleanup_pending(void)
{
    int kept = errno;
    for (int i = 0; i < SLOTS; i++)
        if (atomic_load(&pending[i].state) == SLOT_LIVE)
            unlink(pending[i].name);
    errno = kept;
}

/* ---- hidden names ----------------------------------------------------------------- */

static const char prefix[] = ".csgmesh-", suffix[] = ".tmp";

/* Of this machine: where a file system is shared, locks may not be seen by others. */
static uint32_t host_number(void)
{
    struct utsname system = {.nodename = ""};
    uint32_t number = 2166136261u; /* FNV-1a */
    uname(&system);
    for (const char *c = system.nodename; *c; c++)
        number = (number ^ (unsigned char)*c) * 16777619u;
    return number;
}

static int folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (int)(slash - path) + 1 : 0;
}

static bool choose_name(csg_temporary *file, csg_arena *names, const char *target)
{
    static atomic_uint counter;
    static atomic_ullong start; /* no name is used twice, also where processes' numbers are */
    struct timespec now;
    unsigned long long none = 0;
    clock_gettime(CLOCK_REALTIME, &now);
    atomic_compare_exchange_strong(&start, &none,
                                   (unsigned long long)now.tv_sec * 1000000000 +
                                       (unsigned long long)now.tv_nsec);
    file->name = csg_arena_printf(names, "%.*s%s%08x-%ld-%llx-%u%s", folder_length(target), target,
                                  prefix, host_number(), (long)getpid(), atomic_load(&start),
                                  atomic_fetch_add(&counter, 1), suffix);
    return file->name != NULL;
}

/* ".csgmesh-HOST-PROCESS-START-NUMBER.tmp" of this machine */
static bool is_hidden_name(const char *name)
{
    unsigned host, number;
    long process;
    unsigned long long start;
    int end = 0;
    /* NOLINTNEXTLINE(cert-err34-c): a number that does not fit is that of no process */
    return sscanf(name, ".csgmesh-%8x-%ld-%llx-%u.tmp%n", &host, &process, &start, &number, &end) ==
               4 &&
           end > 0 && !name[end] && host == host_number();
}

/* ---- opening ---------------------------------------------------------------------- */

static const csg_temporary closed = {.fd = -1, .slot = -1};

/* false: it belongs to somebody else, or has been swept. Without locks there are no sweeps. */
static bool lock(int fd)
{
    struct stat status;
    if (flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        return false;
    return fstat(fd, &status) == 0 && status.st_nlink > 0;
}

/* Created by our own open, not mkstemp, so that the kernel applies the umask. */
int csg_temporary_open_named(csg_temporary *file, csg_arena *names, const char *target)
{
    for (int attempt = 0; attempt < 1000; attempt++) {
        *file = closed;
        if (!choose_name(file, names, target))
            return ENOMEM;
        file->slot = pending_add(file->name);
        file->fd = open(file->name, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        file->is_named = file->fd >= 0;
        if (file->is_named && lock(file->fd))
            return 0;
        int error = file->is_named ? EEXIST : errno;
        csg_temporary_close(file);
        if (error != EEXIST)
            return error;
    }
    return EEXIST;
}

/* A name for linkat: false where /proc is not to be seen. */
static bool descriptor_path(int fd, char path[64])
{
    snprintf(path, 64, "/proc/self/fd/%d", fd);
    return access(path, F_OK) == 0;
}

static bool open_unnamed(csg_temporary *file, csg_arena *names, const char *target)
{
#ifdef O_TMPFILE
    char path[64];
    int length = folder_length(target);
    const char *folder = length ? csg_arena_printf(names, "%.*s", length, target) : ".";
    *file = closed;
    if (!folder || !choose_name(file, names, target))
        return false;
    file->fd = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
    if (file->fd >= 0 && descriptor_path(file->fd, path)) {
        flock(file->fd, LOCK_EX | LOCK_NB); /* nobody else can have it open */
        return true;
    }
    csg_temporary_close(file);
#else
    (void)file, (void)names, (void)target;
#endif
    return false;
}

int csg_temporary_open(csg_temporary *file, csg_arena *names, const char *target)
{
    return open_unnamed(file, names, target) ? 0 : csg_temporary_open_named(file, names, target);
}

int csg_temporary_attach(csg_temporary *file, const char *name)
{
    *file = closed;
    file->slot = pending_add(name);
    file->fd = open(name, O_RDWR | O_CLOEXEC);
    int error = file->fd >= 0 ? 0 : errno;
    if (error)
        csg_temporary_close(file);
    return error;
}

int csg_temporary_open_kept(csg_temporary *file, const char *name, bool *was_there)
{
    *file = closed;
    file->name = name;
    file->is_kept = true;
    *was_there = true;
    file->fd = open(name, O_RDWR | O_CLOEXEC | O_NOFOLLOW);
    if (file->fd < 0 && errno == ENOENT) {
        *was_there = false;
        file->fd = open(name, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    }
    file->is_named = file->fd >= 0;
    return file->fd >= 0 ? 0 : errno;
}

/* ---- the end ---------------------------------------------------------------------- */

static int link_as(csg_temporary *file, const char *name)
{
    char path[64];
    if (!descriptor_path(file->fd, path))
        return ENOENT;
    return linkat(AT_FDCWD, path, AT_FDCWD, name, AT_SYMLINK_FOLLOW) == 0 ? 0 : errno;
}

int csg_temporary_flush(const csg_temporary *file)
{
    int copy = fcntl(file->fd, F_DUPFD_CLOEXEC, 0);
    return copy >= 0 && close(copy) != 0 ? errno : 0;
}

int csg_temporary_rename(csg_temporary *file, const char *target, bool is_new)
{
    int flushed = csg_temporary_flush(file);
    if (flushed)
        return flushed;
    if (!file->is_named && is_new) {
        int error = link_as(file, target);
        if (error != EEXIST)
            return error;
    }
    if (!file->is_named) {
        file->slot = pending_add(file->name);
        int error = link_as(file, file->name);
        if (error)
            return error;
        file->is_named = true;
    }
    if (rename(file->name, target) != 0)
        return errno;
    file->is_named = false;
    return 0;
}

int csg_temporary_close(csg_temporary *file)
{
    if (file->is_named && !file->is_kept)
        unlink(file->name);
    int error = file->fd >= 0 && close(file->fd) != 0 ? errno : 0;
    pending_remove(file);
    *file = closed;
    return error;
}

/* ---- leftovers -------------------------------------------------------------------- */

/* Ours, and nobody holds it: then it goes. */
static void sweep_file(int folder, const char *name)
{
    struct stat held, there;
    int fd = openat(folder, name, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (fd < 0)
        return;
    if (fstat(fd, &held) == 0 && S_ISREG(held.st_mode) && held.st_uid == geteuid() &&
        flock(fd, LOCK_EX | LOCK_NB) == 0 &&
        fstatat(folder, name, &there, AT_SYMLINK_NOFOLLOW) == 0 && there.st_dev == held.st_dev &&
        there.st_ino == held.st_ino)
        unlinkat(folder, name, 0);
    close(fd);
}

void csg_temporary_sweep(const char *folder)
{
    const struct dirent *entry;
    DIR *directory = opendir(*folder ? folder : ".");
    while (directory && (entry = readdir(directory)))
        if (is_hidden_name(entry->d_name))
            sweep_file(dirfd(directory), entry->d_name);
    if (directory)
        closedir(directory);
}

void csg_temporary_sweep_once(const char *folder)
{
    enum { FOLDERS = 64 }; /* those after them are not swept */
    static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
    static struct {
        dev_t device;
        ino_t inode;
    } swept[FOLDERS];
    static int count;
    struct stat status;
    if (stat(*folder ? folder : ".", &status) != 0)
        return;
    pthread_mutex_lock(&mutex);
    int i = 0;
    while (i < count && (swept[i].device != status.st_dev || swept[i].inode != status.st_ino))
        i++;
    bool is_due = i == count && count < FOLDERS;
    if (is_due) {
        swept[count].device = status.st_dev;
        swept[count++].inode = status.st_ino;
    }
    pthread_mutex_unlock(&mutex);
    if (is_due)
        csg_temporary_sweep(folder);
}
