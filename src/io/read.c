/* SPDX-License-Identifier: MIT
 * Reading a mesh: the whole file into memory, the format's reader over it, the builder's mesh out.
 */
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/mesh_codes.h"
#include "base/trace.h"
#include "io/format_table.h"
#include "io/formats.h"

bool csg_read_room(const csg_input *input, void *array, size_t *capacity, size_t needed,
                   size_t bytes)
{
    void *data;
    memcpy(&data, array, sizeof data);
    if (!csg_memory_reserve(&input->context->memory, &data, capacity, needed, bytes))
        return false;
    memcpy(array, &data, sizeof data);
    return true;
}

csgm_status csg_read_broken(const csg_input *input, uint32_t line, const char *format, ...)
{
    char text[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    csg_diag_make_line(text); /* names are those of the file */
    csg_diag_report(
        &input->context->diags, CSG_DIAG_BROKEN_FILE,
        (csgm_diag){
            .source_name = input->path, .line = line, .column = line ? 1 : 0, .message = text});
    return CSGM_ERR_FORMAT;
}

csgm_status csg_read_unsupported(const csg_input *input, const char *format, ...)
{
    char text[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    csg_diag_plain(&input->context->diags, CSG_DIAG_UNSUPPORTED_FEATURE, input->path, NULL, "%s",
                   text);
    return CSGM_ERR_UNSUPPORTED;
}

/* ---- bytes -------------------------------------------------------------------------------------
 */

typedef struct bytes {
    csg_read_clock clock;
    void *data;
    size_t count, room;
} bytes;

csgm_status csg_read_failed(csgm_context *context, const char *path, int error)
{
    csg_diag_plain(&context->diags, CSG_DIAG_MESH_UNREADABLE, path, NULL, "cannot read: %s",
                   strerror(error));
    return CSGM_ERR_IO;
}

/* Up to `most` bytes to `at`, at least one unless the file ends. */
static int read_some(int fd, void *at, size_t most, size_t *got)
{
    ssize_t count;
    do
        count = read(fd, at, most);
    while (count < 0 && errno == EINTR);
    *got = count > 0 ? (size_t)count : 0;
    return count < 0 ? errno : 0;
}

static bool append(bytes *b, const void *more, size_t count)
{
    if (!csg_memory_reserve(&b->clock.context->memory, &b->data, &b->room, b->count + count, 1))
        return false;
    memcpy((uint8_t *)b->data + b->count, more, count);
    b->count += count;
    return true;
}

/* First room for just the size that the system tells, then as much as comes: pipes tell nothing. In
 * steps, between which the clock is looked at: ETIME where it is late. */
static int read_all(int fd, bytes *b)
{
    enum { STEP = 16 << 20, BEYOND = 1 << 14 };
    struct stat state;
    uint8_t beyond[BEYOND]; /* the told size, so that room for it is all that most files take */
    int error = 0;
    size_t got = 1;
    if (fstat(fd, &state) == 0 && S_ISREG(state.st_mode) && state.st_size > 0 &&
        !csg_memory_reserve(&b->clock.context->memory, &b->data, &b->room, (size_t)state.st_size,
                            1))
        return ENOMEM;
    while (!error && got) {
        size_t left = b->room - b->count;
        if (!csg_read_has_time(&b->clock))
            return ETIME;
        if (left) {
            error = read_some(fd, (uint8_t *)b->data + b->count, left < STEP ? left : STEP, &got);
            b->count += got;
        } else {
            error = read_some(fd, beyond, sizeof beyond, &got);
            if (got && !append(b, beyond, got))
                return ENOMEM;
        }
    }
    return error;
}

/* The array keeps its exact size, so that its owner can release it. */
static csgm_status trim(bytes *b, uint8_t **out, size_t *size_bytes)
{
    csgm_context *context = b->clock.context;
    *size_bytes = b->count;
    *out = b->data;
    if (b->room == b->count)
        return CSGM_OK;
    *out = NULL;
    if (b->count) {
        *out = csg_memory_alloc(&context->memory, b->count);
        if (*out)
            memcpy(*out, b->data, b->count);
    }
    csg_memory_release(&context->memory, b->data, b->room);
    return *out || !b->count ? CSGM_OK : csg_context_no_memory(context);
}

csgm_status csg_input_load(csgm_context *context, const char *path, int fd, uint8_t **out,
                           size_t *size_bytes)
{
    bytes b = {.data = NULL};
    csg_read_clock_start(&b.clock, context, 0);
    int own = fd < 0 ? open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY) : fd;
    if (fd < 0)
        csg_context_tell_file(context, path, own >= 0);
    if (own < 0)
        return csg_read_failed(context, path, errno);
    int error = read_all(own, &b);
    if (fd < 0)
        close(own);
    if (!error)
        return trim(&b, out, size_bytes);
    csg_memory_release(&context->memory, b.data, b.room);
    if (b.clock.is_late)
        return csg_read_why_late(&b.clock);
    return error == ENOMEM ? csg_context_no_memory(context) : csg_read_failed(context, path, error);
}

/* ---- the door --------------------------------------------------------------------- */

static csgm_status read_input(csg_input *input, csgm_format format, csgm_mesh **out)
{
    csgm_context *context = input->context;
    if (format == CSGM_FORMAT_AUTO)
        format = csg_format_from_path(input->path);
    const csg_format_row *row = format == CSGM_FORMAT_AUTO
                                    ? csg_format_recognise(input->bytes, input->size_bytes)
                                    : csg_format_find(format);
    if (!row)
        return csg_format_unknown(context, input->path);
    csgm_status status = csg_format_check(context, input->path, row, true);
    if (status)
        return status;
    csg_mesh_builder builder;
    csg_builder_init(&builder, context, input->started_s);
    status = row->read(input, &builder);
    if (!status && builder.too_far)
        status = csg_read_broken(input, 0, CSG_READ_TOO_FAR);
    if (!status)
        status = csg_builder_finish(&builder, out);
    csg_builder_release(&builder);
    return status;
}

csgm_status csg_io_read_memory(csgm_context *context, const uint8_t *data, size_t size_bytes,
                               const char *path, csgm_format format, csgm_mesh **out)
{
    csg_input input = {.context = context, .path = path, .bytes = data, .size_bytes = size_bytes};
    return read_input(&input, format, out);
}

csgm_status csg_io_read_fd(csgm_context *context, int fd, const char *name, csgm_format format,
                           csgm_mesh **out)
{
    return csg_io_read_both(context, fd, NULL, name, format, out);
}

csgm_status csg_io_read_both(csgm_context *context, int fd, const int *companion, const char *name,
                             csgm_format format, csgm_mesh **out)
{
    uint8_t *data = NULL;
    size_t size = 0;
    double started_s = csg_clock_now_s();
    csgm_status status = csg_input_load(context, name, fd, &data, &size);
    if (status)
        return status;
    csg_input input = {context, name, data, size, companion, started_s};
    status = read_input(&input, format, out);
    csg_memory_release(&context->memory, data, size);
    return status;
}

csgm_status csg_io_read(csgm_context *context, const char *path, csgm_format format,
                        csgm_mesh **out)
{
    CSG_ZONE(context, "read mesh");
    return csg_io_read_fd(context, -1, path, format, out);
}
