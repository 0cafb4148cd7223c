/* SPDX-License-Identifier: MIT
 * The one table of formats, for formats.c, write.c and read.c.
 */
#ifndef CSG_IO_FORMAT_TABLE_H
#define CSG_IO_FORMAT_TABLE_H

#include "io/formats.h"
#include "io/reader.h"
#include "io/writers.h"

typedef struct csg_format_row {
    csgm_format id;
    const char *name; /* also its extension */
    csg_write_fn *write;
    csg_read_fn *read;
    const char *write_library, *read_library;   /* NULL = needs none */
    bool (*can_write)(void), (*can_read)(void); /* NULL = always */
} csg_format_row;

/* NULL for AUTO and for what is no format. */
const csg_format_row *csg_format_find(csgm_format format);

/* Whether a crease may have a vertex for each of its sheets there (csgm_mesh_view.split). */
static inline bool csg_format_keeps_creases(csgm_format format)
{
    return format == CSGM_FORMAT_OBJ || format == CSGM_FORMAT_GLB || format == CSGM_FORMAT_GLTF;
}

/* Reports that the build lacks `library`; returns CSGM_ERR_UNSUPPORTED. */
csgm_status csg_format_no_library(csgm_context *context, const char *file, const char *library,
                                  const char *what);
/* Reports that the file's name says no format; returns CSGM_ERR_UNSUPPORTED. */
csgm_status csg_format_unknown(csgm_context *context, const char *file);

#endif
