/* SPDX-License-Identifier: MIT
 * Layers of a solid, straight from its field: contours within a tolerance, closed, oriented and
 * uncrossed.
 */
#ifndef CSG_SLICE_SLICE_H
#define CSG_SLICE_SLICE_H

#include "io/layers/layers.h"

/* Who takes layers. */
typedef struct csg_layers_receiver {
    void *user;
    /* Before all of them. False: it takes none. */
    bool (*begin)(void *user, const csg_layers_head *head);
    /* Any worker: onto the page, of layers that follow each other. */
    void (*layer)(void *user, csg_page *page, const csg_layers_head *head,
                  const csg_sliced_layer *layer);
    /* On the calling thread, page after page. False: no more. */
    bool (*page)(void *user, const csg_page *page);
} csg_layers_receiver;

/* Options are complete and in range. CSGM_OK, or why not (reported); CSGM_ERR_IO, not reported: the
 * receiver took no more. The same pages for any number of threads, but for where they end. */
csgm_status csg_slice_field(csgm_context *context, const csgm_field *field,
                            const csgm_slice_options *options, const csg_layers_receiver *receiver,
                            csgm_slice_stats *stats);

/* Layers as a file that appears complete or not at all; as csg_io_write and csg_io_write_fd
 * (io/formats.h). */
csgm_status csg_slice_file(csgm_context *context, const csgm_field *field, const char *path,
                           csgm_layers_format format, const csgm_slice_options *options,
                           csgm_slice_stats *stats);
csgm_status csg_slice_fd(csgm_context *context, const csgm_field *field, int fd, const char *name,
                         csgm_layers_format format, const csgm_slice_options *options,
                         csgm_slice_stats *stats);

#endif
