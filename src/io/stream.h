/* SPDX-License-Identifier: MIT
 * A file that is filled from all sides: the place of every vertex and triangle is known from the
 * counts, so workers write runs where they belong, in any order, and memory does not grow with the
 * mesh. The bytes are those that csg_io_write writes for the whole mesh.
 */
#ifndef CSG_IO_STREAM_H
#define CSG_IO_STREAM_H

#include "io/formats.h"
#include "mesh/run.h"

typedef struct csg_stream csg_stream;

/* Binary PLY and STL, and GLB without Draco, to a regular file or one that does not exist yet.
 * distance: csg_mesh_distance; what rounding could join is looked at as a whole mesh. */
bool csg_stream_is_possible(const char *path, csgm_format format, double distance,
                            const csgm_write_options *options);

/* workers: run.worker stays below. Failures are reported, as everywhere below. */
csgm_status csg_stream_create(csgm_context *context, const char *path, csgm_format format,
                              const csgm_write_options *options, uint32_t workers,
                              csg_stream **out);
/* What fills the stream. */
csg_mesh_receiver csg_stream_receiver(csg_stream *stream);
/* Completes the file and gives it its name. The stream is gone afterwards. */
csgm_status csg_stream_commit(csg_stream *stream);
/* Leaves no file; reports the error that ended the stream, and is it, or CSGM_OK. */
csgm_status csg_stream_abandon(csg_stream *stream);

#endif
