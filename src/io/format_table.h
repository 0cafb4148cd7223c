/* SPDX-License-Identifier: MIT
 * The rows of formats.def as C sees them, for formats.c, write.c, read.c and stream.c.
 */
#ifndef CSG_IO_FORMAT_TABLE_H
#define CSG_IO_FORMAT_TABLE_H

#include "io/reader.h"
#include "io/runs.h"
#include "io/stream_kind.h"
#include "io/writers.h"

typedef struct csg_format_library {
    const char *name;
    bool (*is_there)(void);
} csg_format_library;

typedef struct csg_format_row {
    csgm_format id;
    const char *name, *title;      /* the name is its extension, too */
    csg_write_fn *write;           /* NULL: it is only read */
    csg_read_fn *read;             /* NULL: it is only written */
    const csg_stream_kind *stream; /* NULL: it is written from a whole mesh */
    const csg_runs_kind *runs;     /* NULL: it is read as a whole */
    const csg_format_library *write_library, *read_library; /* NULL = needs none */
    uint32_t traits;         /* without those of the pointers above */
    const char *first_bytes; /* several, each terminated; an empty one ends them */
    const char *remarks;
} csg_format_row;

/* NULL for AUTO and for what is no format. */
const csg_format_row *csg_format_find(csgm_format format);
/* The row whose files begin as these bytes do, or NULL. */
const csg_format_row *csg_format_recognise(const uint8_t *bytes, size_t size_bytes);

/* May the format put vertices together of a mesh with an origin so many times its size from zero?
 * (0: it has none. Its floats are kept by all formats but Draco's, which rounds by itself.) */
bool csg_format_rounds(const csg_format_row *row, double distance);

/* Reports why this build cannot write (or read) files of the format: it is never done, or a library
 * is missing. CSGM_OK, or CSGM_ERR_UNSUPPORTED. */
csgm_status csg_format_check(csgm_context *context, const char *file, const csg_format_row *row,
                             bool for_reading);
/* Reports that the build lacks `library`; returns CSGM_ERR_UNSUPPORTED. */
csgm_status csg_format_no_library(csgm_context *context, const char *file, const char *library,
                                  const char *what);
/* Reports that the file's name says no format; returns CSGM_ERR_UNSUPPORTED. */
csgm_status csg_format_unknown(csgm_context *context, const char *file);

#endif
