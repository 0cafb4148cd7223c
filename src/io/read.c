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
    csgm_context *context;
    void *data;
    size_t count, room;
} bytes;

static csgm_status unreadable(csgm_context *context, const char *path, int error)
{
    csg_diag_plain(&context->diags, CSG_DIAG_MESH_UNREADABLE, path, NULL, "cannot read: %s",
                   strerror(error));
    return CSGM_ERR_IO;
}

/* First room for the size that the system tells, then as much as comes: pipes tell nothing. */
static int read_all(int fd, bytes *b)
{
    struct stat state;
    size_t step = 1 << 16;
    if (fstat(fd, &state) == 0 && S_ISREG(state.st_mode) && state.st_size > 0)
        step = (size_t)state.st_size + 1;
    for (;;) {
        if (b->room - b->count < 1 &&
            !csg_memory_reserve(&b->context->memory, &b->data, &b->room, b->count + step, 1))
            return ENOMEM;
        step = 1 << 16;
        ssize_t got = read(fd, (uint8_t *)b->data + b->count, b->room - b->count);
        if (got == 0)
            return 0;
        if (got < 0 && errno != EINTR)
            return errno;
        b->count += got > 0 ? (size_t)got : 0;
    }
}

/* The array keeps its exact size, so that its owner can release it. */
static csgm_status trim(bytes *b, uint8_t **out, size_t *size_bytes)
{
    *size_bytes = b->count;
    *out = NULL;
    if (b->count) {
        *out = csg_memory_alloc(&b->context->memory, b->count);
        if (*out)
            memcpy(*out, b->data, b->count);
    }
    csg_memory_release(&b->context->memory, b->data, b->room);
    return *out || !b->count ? CSGM_OK : csg_context_no_memory(b->context);
}

csgm_status csg_input_load(csgm_context *context, const char *path, int fd, uint8_t **out,
                           size_t *size_bytes)
{
    bytes b = {.context = context};
    int own = fd < 0 ? open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY) : fd;
    if (fd < 0)
        csg_context_tell_file(context, path, own >= 0);
    if (own < 0)
        return unreadable(context, path, errno);
    int error = read_all(own, &b);
    if (fd < 0)
        close(own);
    if (!error)
        return trim(&b, out, size_bytes);
    csg_memory_release(&context->memory, b.data, b.room);
    return error == ENOMEM ? csg_context_no_memory(context) : unreadable(context, path, error);
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
    csg_builder_init(&builder, context);
    status = row->read(input, &builder);
    if (!status && builder.too_far)
        status = csg_read_broken(input, 0, "a coordinate is beyond the range of floats");
    if (!status)
        status = csg_builder_finish(&builder, out);
    csg_builder_release(&builder);
    return status;
}

csgm_status csg_io_read_memory(csgm_context *context, const uint8_t *data, size_t size_bytes,
                               const char *path, csgm_format format, csgm_mesh **out)
{
    csg_input input = {context, path, data, size_bytes, NULL};
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
    uint8_t *data;
    size_t size;
    csgm_status status = csg_input_load(context, name, fd, &data, &size);
    if (status)
        return status;
    csg_input input = {context, name, data, size, companion};
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
