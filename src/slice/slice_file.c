/* SPDX-License-Identifier: MIT
 * Layers to files; see slice.h.
 */
#include "io/file.h"
#include "io/sink.h"
#include "slice/slice.h"

typedef struct layers_file {
    const csg_layers_writer *writer;
    csg_sink sink;
    csg_layers_head head;
} layers_file;

static bool pass_page(void *user, const csg_page *page)
{
    layers_file *file = user;
    csg_sink_put(&file->sink, page->data, page->length);
    return !page->failed && !file->sink.error;
}

typedef void frame_fn(csg_page *page, const csg_layers_head *head);

static bool put_frame(layers_file *file, frame_fn *put)
{
    csg_page page = csg_layers_page(&file->sink.context->memory, &file->head);
    put(&page, &file->head);
    bool done = pass_page(file, &page);
    csg_layers_release_page(&page);
    return done;
}

static bool begin_file(void *user, const csg_layers_head *head)
{
    layers_file *file = user;
    file->head = *head;
    return put_frame(file, file->writer->begin);
}

static void put_on_page(void *user, csg_page *page, const csg_layers_head *head,
                        const csg_sliced_layer *layer)
{
    const layers_file *file = user;
    file->writer->layer(page, head, layer);
}

csgm_status csg_slice_fd(csgm_context *context, const csgm_field *field, int fd, const char *name,
                         csgm_layers_format format, const csgm_slice_options *options,
                         csgm_slice_stats *stats)
{
    layers_file file = {.writer = csg_layers_writer_of(format)};
    const csg_layers_receiver receiver = {&file, begin_file, put_on_page, pass_page};
    csgm_status status = csg_sink_open(&file.sink, context, fd, name);
    if (status != CSGM_OK)
        return status;
    status = csg_slice_field(context, field, options, &receiver, stats);
    if (status == CSGM_OK && !put_frame(&file, file.writer->end))
        status = CSGM_ERR_IO;
    if (status == CSGM_OK || (status == CSGM_ERR_IO && file.sink.error))
        return csg_sink_close(&file.sink);
    csg_sink_discard(&file.sink);
    return status == CSGM_ERR_IO ? csg_context_no_memory(context) : status;
}

csgm_status csg_slice_file(csgm_context *context, const csgm_field *field, const char *path,
                           csgm_layers_format format, const csgm_slice_options *options,
                           csgm_slice_stats *stats)
{
    csg_atomic_file file;
    csgm_status status = csg_file_create(&file, context, path);
    if (status != CSGM_OK)
        return status;
    file.sync = options->sync;
    status = csg_slice_fd(context, field, file.fd, path, format, options, stats);
    if (status == CSGM_OK)
        return csg_file_commit(&file);
    csg_file_abandon(&file);
    return status;
}
