/* SPDX-License-Identifier: MIT
 * Layers to files; see slice.h.
 */
#include <math.h>

#include "base/mesh_codes.h"
#include "io/file.h"
#include "io/sink.h"
#include "io/threemf/threemf_package.h"
#include "slice/slice.h"

enum { MOST_SIDE = 16384 /* pixels */ };

typedef struct layers_file {
    const csg_layers_writer *writer;
    csg_sink sink;
    csg_zip *zip; /* NULL: none */
    csg_layers_head head;
    double pixel;
    uint64_t written;
    bool is_refused; /* reported */
} layers_file;

static bool refuse(layers_file *file, const char *format, double value)
{
    csg_diag_plain(&file->sink.context->diags, CSG_DIAG_FORMAT_LIMIT, file->sink.name, NULL, format,
                   value);
    file->is_refused = true;
    return false;
}

static bool refuse_size(layers_file *file)
{
    return refuse(file, "the archive would be larger than %g bytes",
                  (double)file->writer->most_bytes);
}

static bool pass_page(void *user, const csg_page *page)
{
    layers_file *file = user;
    file->written += page->length;
    if (file->writer->most_bytes && file->written > file->writer->most_bytes)
        return refuse_size(file);
    if (file->zip)
        csg_zip_text(file->zip, page->data, page->length);
    else
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

/* Pixels around the solid, as many on all sides. False: too many (reported), or out of memory. */
static bool plan_masks(layers_file *file)
{
    csg_layers_head *h = &file->head;
    csg_vec3 low = csg_vec3_scale(h->box.min, h->scale),
             size = csg_vec3_scale(csg_box_size(h->box), h->scale);
    double width = fmax(ceil(size.x / file->pixel - 1e-6), 1),
           height = fmax(ceil(size.y / file->pixel - 1e-6), 1);
    if (width > MOST_SIDE || height > MOST_SIDE)
        return refuse(file, "a mask would have %g pixels in a row", fmax(width, height));
    h->pixel = file->pixel;
    h->width = (uint32_t)width;
    h->height = (uint32_t)height;
    h->corner = (csg_vec2){low.x + 0.5 * (size.x - width * h->pixel),
                           low.y + 0.5 * (size.y + height * h->pixel)};
    h->masks = csg_memory_alloc(&file->sink.context->memory, h->count * sizeof *h->masks);
    return h->masks;
}

static bool begin_file(void *user, const csg_layers_head *head)
{
    layers_file *file = user;
    file->head = *head;
    if (file->writer->most_layers && head->count > file->writer->most_layers)
        return refuse(file, "%g layers are too many for an archive", (double)head->count);
    if (file->writer->has_masks && !plan_masks(file))
        return false;
    return put_frame(file, file->writer->begin);
}

static void put_on_page(void *user, csg_page *page, const csg_layers_head *head,
                        const csg_sliced_layer *layer)
{
    const layers_file *file = user;
    (void)head; /* of which the file has its own */
    file->writer->layer(page, &file->head, layer);
}

static csgm_status begin_package(layers_file *file)
{
    csgm_status status = csg_zip_create(&file->sink, &file->zip);
    if (status == CSGM_OK)
        csg_3mf_begin(file->zip);
    return status;
}

/* status: of what was put. The text's length was looked at, so that the archive fits. */
static csgm_status end_package(layers_file *file, csgm_status status)
{
    if (status == CSGM_OK && csg_zip_finish(file->zip) != CSGM_OK) {
        refuse_size(file);
        status = CSGM_ERR_IO;
    }
    csg_zip_destroy(file->zip);
    return status;
}

csgm_status csg_slice_fd(csgm_context *context, const csgm_field *field, int fd, const char *name,
                         csgm_layers_format format, const csgm_slice_options *options,
                         csgm_slice_stats *stats)
{
    layers_file file = {.writer = csg_layers_writer_of(format), .pixel = options->pixel};
    const csg_layers_receiver receiver = {&file, begin_file, put_on_page, pass_page};
    csgm_status status = csg_sink_open(&file.sink, context, fd, name);
    if (status != CSGM_OK)
        return status;
    if (file.writer->is_package)
        status = begin_package(&file);
    if (status == CSGM_OK)
        status = csg_slice_field(context, field, options, &receiver, stats);
    if (status == CSGM_OK && !put_frame(&file, file.writer->end))
        status = CSGM_ERR_IO;
    if (file.zip)
        status = end_package(&file, status);
    csg_memory_release(&context->memory, file.head.masks,
                       file.head.count * sizeof *file.head.masks);
    if (status == CSGM_OK || (status == CSGM_ERR_IO && file.sink.error))
        return csg_sink_close(&file.sink);
    csg_sink_discard(&file.sink);
    if (file.is_refused)
        return CSGM_ERR_LIMIT;
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
