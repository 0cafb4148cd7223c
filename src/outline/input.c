/* SPDX-License-Identifier: MIT
 * Files, numbers and sentences for the readers; see input.h.
 */
#include "outline/input.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

csgm_status csg_problem_set(csg_problem *problem, csgm_status status, const char *format, ...)
{
    if (problem->text[0])
        return status;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(problem->text, sizeof problem->text, format, arguments);
    va_end(arguments);
    return status;
}

static csgm_status read_all(int file, csg_bytes *out, csg_problem *problem)
{
    size_t capacity = 0;
    csgm_status status = CSGM_OK;
    for (;;) {
        if (out->size > CSG_INPUT_MOST_BYTES) {
            status = csg_problem_set(problem, CSGM_ERR_LIMIT, "the file is larger than %zu MiB",
                                     CSG_INPUT_MOST_BYTES >> 20);
            break;
        }
        size_t wanted = out->size + 65536;
        if (!csg_memory_reserve(out->memory, (void **)&out->data, &capacity, wanted, 1)) {
            status = CSGM_ERR_MEMORY;
            break;
        }
        ssize_t got = read(file, out->data + out->size, capacity - out->size - 1);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            status =
                csg_problem_set(problem, CSGM_ERR_IO, "it cannot be read: %s", strerror(errno));
        if (got <= 0)
            break;
        out->size += (size_t)got;
    }
    if (status != CSGM_OK) {
        csg_memory_release(out->memory, out->data, capacity);
        return status;
    }
    char *exact = csg_memory_alloc(out->memory, out->size + 1);
    if (exact) {
        memcpy(exact, out->data, out->size);
        exact[out->size] = 0;
    }
    csg_memory_release(out->memory, out->data, capacity);
    out->data = exact;
    return exact ? CSGM_OK : CSGM_ERR_MEMORY;
}

csgm_status csg_bytes_read(csg_memory *memory, const char *path, csg_bytes *out,
                           csg_problem *problem)
{
    struct stat kind;
    *out = (csg_bytes){.memory = memory};
    if (stat(path, &kind) == 0 && S_ISFIFO(kind.st_mode)) /* opening it may wait for ever */
        return csg_problem_set(problem, CSGM_ERR_IO, "it is a pipe, not a file");
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY);
    if (file < 0)
        return csg_problem_set(problem, CSGM_ERR_IO, "it cannot be opened: %s", strerror(errno));
    csgm_status status = CSGM_OK;
    if (fstat(file, &kind) == 0 && S_ISDIR(kind.st_mode))
        status = csg_problem_set(problem, CSGM_ERR_IO, "it is a folder");
    else if (fstat(file, &kind) == 0 && S_ISCHR(kind.st_mode))
        status = csg_problem_set(problem, CSGM_ERR_IO, "it is a device, not a file");
    else
        status = read_all(file, out, problem);
    close(file);
    if (status != CSGM_OK)
        *out = (csg_bytes){.memory = memory};
    return status;
}

void csg_bytes_release(csg_bytes *bytes)
{
    if (bytes->data)
        csg_memory_release(bytes->memory, bytes->data, bytes->size + 1);
    *bytes = (csg_bytes){.memory = bytes->memory};
}

static const char *skip_digits(const char *at, const char *end)
{
    while (at < end && *at >= '0' && *at <= '9')
        at++;
    return at;
}

/* Where the number that begins at `at` ends; `at` itself where none does. */
static const char *number_end(const char *at, const char *end)
{
    const char *digits = at < end && (*at == '+' || *at == '-') ? at + 1 : at;
    const char *stop = skip_digits(digits, end);
    size_t count = (size_t)(stop - digits);
    if (stop < end && *stop == '.') {
        const char *more = skip_digits(stop + 1, end);
        count += (size_t)(more - stop - 1);
        stop = more;
    }
    if (count == 0)
        return at;
    if (stop < end && (*stop == 'e' || *stop == 'E')) {
        const char *power = stop + 1;
        power += power < end && (*power == '+' || *power == '-');
        const char *after = skip_digits(power, end);
        stop = after > power ? after : stop;
    }
    return stop;
}

bool csg_number_scan(const char **at, const char *end, double *out)
{
    char copy[512]; /* no sane number is longer */
    const char *stop = number_end(*at, end);
    size_t length = (size_t)(stop - *at);
    if (length == 0 || length >= sizeof copy)
        return false;
    memcpy(copy, *at, length);
    copy[length] = 0;
    double value = strtod(copy, NULL);
    if (!isfinite(value))
        return false;
    *at = stop;
    *out = value;
    return true;
}
