/* SPDX-License-Identifier: MIT
 * Files in memory instead of on the disk. The linker's --wrap puts these functions in the place of
 * those of text/source.h and of the C library's open and fopen, so that no input reads a file of
 * this machine; and evaluation gets a small stack, since every input starts a thread.
 */
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fuzz/fuzz.h"
#include "text/source.h"

enum { MOST_FILES = 4, SEPARATOR = 0x1C };

static fuzz_text files[MOST_FILES]; /* named "a", "b", ... */
static size_t file_count;
static bool guarded;

bool __wrap_csg_source_exists(const char *path);
bool __wrap_csg_source_is_file(const csg_source *source, const char *path);
csgm_status __wrap_csg_source_read(csg_sources *sources, const csg_source_request *request,
                                   uint32_t *out);
int __wrap_open(const char *path, int flags, ...);
int __real_open(const char *path, int flags, ...);
FILE *__wrap_fopen(const char *path, const char *mode);
FILE *__real_fopen(const char *path, const char *mode);
int __wrap_pthread_attr_setstacksize(pthread_attr_t *attributes, size_t size);
int __real_pthread_attr_setstacksize(pthread_attr_t *attributes, size_t size);

/* Up to the next separator, which is passed over. */
static fuzz_text next_part(const char **at, const char *end)
{
    const char *begin = *at, *cut = memchr(begin, SEPARATOR, (size_t)(end - begin));
    *at = cut ? cut + 1 : NULL;
    return (fuzz_text){begin, (size_t)((cut ? cut : end) - begin)};
}

fuzz_text fuzz_files_open(const uint8_t *data, size_t size)
{
    const char *at = size ? (const char *)data : "", *end = at + size;
    fuzz_text scene = next_part(&at, end);
    for (file_count = 0; at && file_count < MOST_FILES; file_count++)
        files[file_count] = next_part(&at, end);
    guarded = true;
    return scene;
}

void fuzz_files_close(void)
{
    guarded = false;
}

/* 1 + index of the file with this name, 0 = none. */
static size_t find(const char *path)
{
    size_t index = path[0] && !path[1] ? (size_t)(path[0] - 'a') : MOST_FILES;
    return index < file_count ? index + 1 : 0;
}

bool __wrap_csg_source_exists(const char *path)
{
    return find(path) != 0;
}

bool __wrap_csg_source_is_file(const csg_source *source, const char *path)
{
    return source->inode != 0 && source->inode == find(path);
}

csgm_status __wrap_csg_source_read(csg_sources *sources, const csg_source_request *request,
                                   uint32_t *out)
{
    size_t number = find(request->path);
    if (!number)
        return CSGM_ERR_IO;
    fuzz_text file = files[number - 1];
    csgm_status status = csg_source_add(sources, request->path, file.text, file.length, out);
    if (status != CSGM_OK)
        return status;
    csg_source *source = &sources->items[*out];
    source->from = request->from;
    source->textual = request->textual;
    source->device = 1;
    source->inode = number;
    return CSGM_OK;
}

/* Writing is let through: libFuzzer keeps its findings so. */
int __wrap_open(const char *path, int flags, ...)
{
    va_list arguments;
    if (guarded && (flags & O_ACCMODE) == O_RDONLY) {
        errno = EACCES;
        return -1;
    }
    va_start(arguments, flags);
    int mode = flags & O_CREAT ? va_arg(arguments, int) : 0;
    va_end(arguments);
    return __real_open(path, flags, mode);
}

FILE *__wrap_fopen(const char *path, const char *mode)
{
    if (guarded && mode[0] == 'r') {
        errno = EACCES;
        return NULL;
    }
    return __real_fopen(path, mode);
}

int __wrap_pthread_attr_setstacksize(pthread_attr_t *attributes, size_t size)
{
    enum { LARGEST = 8 << 20 };
    return size > LARGEST ? EINVAL : __real_pthread_attr_setstacksize(attributes, size);
}
