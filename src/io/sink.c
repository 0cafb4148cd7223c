/* SPDX-License-Identifier: MIT
 * The buffered stream of sink.h.
 */
#include "io/sink.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

#include "base/mesh_codes.h"

csgm_status csg_sink_open(csg_sink *sink, csgm_context *context, int fd, const char *name)
{
    *sink = (csg_sink){.context = context, .fd = fd, .name = name};
    sink->buffer = csg_memory_alloc(&context->memory, CSG_SINK_BYTES);
    return sink->buffer ? CSGM_OK : csg_context_no_memory(context);
}

void csg_sink_discard(csg_sink *sink)
{
    csg_memory_release(&sink->context->memory, sink->buffer, CSG_SINK_BYTES);
    sink->buffer = NULL;
}

csgm_status csg_sink_close(csg_sink *sink)
{
    csg_sink_flush(sink);
    csg_sink_discard(sink);
    if (!sink->error)
        return CSGM_OK;
    csg_diag_plain(&sink->context->diags, CSG_DIAG_CANNOT_WRITE, sink->name, NULL,
                   "cannot write: %s", strerror(sink->error));
    return CSGM_ERR_IO;
}

static void write_all(csg_sink *sink, const uint8_t *bytes, size_t count)
{
    while (count && !sink->error) {
        ssize_t written = write(sink->fd, bytes, count);
        if (written < 0) {
            sink->error = errno == EINTR ? 0 : errno;
            continue;
        }
        bytes += written;
        count -= (size_t)written;
    }
}

void csg_sink_flush(csg_sink *sink)
{
    write_all(sink, sink->buffer, sink->length);
    sink->length = 0;
}

void csg_sink_put(csg_sink *sink, const void *bytes, size_t count)
{
    if (sink->length + count > CSG_SINK_BYTES)
        csg_sink_flush(sink);
    if (count > CSG_SINK_BYTES) {
        write_all(sink, bytes, count);
        return;
    }
    if (count)
        memcpy(sink->buffer + sink->length, bytes, count);
    sink->length += count;
}

void csg_sink_text(csg_sink *sink, const char *text)
{
    csg_sink_put(sink, text, strlen(text));
}

void csg_sink_format(csg_sink *sink, const char *format, ...)
{
    char *room = (char *)csg_sink_room(sink, CSG_SINK_ROOM);
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(room, CSG_SINK_ROOM, format, arguments);
    va_end(arguments);
    if (length > 0)
        csg_sink_took(sink, room + (length < CSG_SINK_ROOM ? length : CSG_SINK_ROOM - 1));
}
