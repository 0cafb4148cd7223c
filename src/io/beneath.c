/* SPDX-License-Identifier: MIT
 * Opening beneath a folder; see beneath.h. The kernel does it where it has openat2 (Linux 5.6);
 * else the path is walked one name at a time, and no link is followed at all.
 */
#include "io/beneath.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#ifdef __linux__
#include <stdint.h>
#include <sys/syscall.h>

/* As the kernel's interface has them for good; older headers do not. The number is the same on all
 * architectures but Alpha, whose headers name it. */
#if !defined SYS_openat2 && !defined __alpha__
#define SYS_openat2 437
#endif
#endif

static int open_by_kernel(int folder, const char *name)
{
#ifdef SYS_openat2
    enum { NO_MAGIC_LINKS = 0x02, BENEATH = 0x08 };
    const struct {
        uint64_t flags, mode, resolve;
    } how = {.flags = O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK,
             .resolve = BENEATH | NO_MAGIC_LINKS};
    return (int)syscall(SYS_openat2, folder, name, &how, sizeof how);
#else
    (void)folder, (void)name;
    errno = ENOSYS;
    return -1;
#endif
}

/* One name after the other, without `..` and without links. Takes the folder. */
static int open_by_names(int folder, const char *path)
{
    char name[NAME_MAX + 1];
    if (*path == '/') {
        errno = EXDEV;
        return -1;
    }
    int at = fcntl(folder, F_DUPFD_CLOEXEC, 0);
    while (at >= 0) {
        path += strspn(path, "/");
        size_t length = strcspn(path, "/");
        int below = -1, flags = path[length] ? O_DIRECTORY : 0;
        if (length > NAME_MAX || !length)
            errno = length ? ENAMETOOLONG : EISDIR;
        else if (length == 2 && memcmp(path, "..", 2) == 0)
            errno = EXDEV;
        else {
            memcpy(name, path, length);
            name[length] = '\0';
            below =
                openat(at, name, O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK | O_NOFOLLOW | flags);
        }
        int error = errno;
        close(at);
        errno = error;
        path += length;
        if (below < 0 || !*path)
            return below;
        at = below;
    }
    return -1;
}

/* Pipes and devices are closed: reading one may never end (so none is waited for when opened). */
static int keep_file(int file)
{
    struct stat about;
    if (fstat(file, &about) == 0 && (S_ISREG(about.st_mode) || S_ISDIR(about.st_mode)))
        return file;
    close(file);
    errno = EINVAL;
    return -1;
}

int csg_open_beneath(const char *folder, const char *name)
{
    int at = open(*folder ? folder : ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (at < 0)
        return -1;
    int file = open_by_kernel(at, name);
    if (file < 0 && (errno == ENOSYS || errno == EPERM))
        file = open_by_names(at, name);
    int error = errno;
    close(at);
    errno = error;
    return file < 0 ? file : keep_file(file);
}

int csg_open_beside(const csgm_context *context, const char *path, const char *name)
{
    char folder[PATH_MAX], whole[2 * PATH_MAX];
    const char *slash = strrchr(path, '/');
    size_t length = slash ? (size_t)(slash - path) + 1 : 0;
    if (length >= sizeof folder) {
        errno = ENAMETOOLONG;
        return -1;
    }
    memcpy(folder, path, length);
    folder[length] = '\0';
    int file = csg_open_beneath(folder, name), error = errno;
    if (snprintf(whole, sizeof whole, "%s%s", folder, name) < (int)sizeof whole)
        csg_context_tell_file(context, whole, file >= 0);
    errno = error;
    return file;
}
