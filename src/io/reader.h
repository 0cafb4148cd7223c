/* SPDX-License-Identifier: MIT
 * What every reader is: bytes of a whole file in, vertices and triangles into a builder out. Bytes
 * are hostile: a count is compared with what the file can hold before anything is allocated for it,
 * and an empty file or one that ends early is refused, unless each line of the format stands alone.
 */
#ifndef CSG_IO_READER_H
#define CSG_IO_READER_H

#include <string.h>

#include "io/builder.h"

typedef struct csg_input {
    csgm_context *context;
    const char *path; /* for diagnostics, and for the folder of files named inside */
    const uint8_t *bytes;
    size_t size_bytes;
    const int *companion; /* NULL: files that it names are looked for beside it; else the one, open,
                             that csg_companion.nameless was when it was written */
    double started_s;     /* when its reading began, for --timeout, by csg_clock_now_s; 0 = now */
} csg_input;

/* CSGM_OK, or an error already reported; out of memory may be left to the builder. */
typedef csgm_status csg_read_fn(csg_input *input, csg_mesh_builder *builder);

/* One for each row of formats.def; those exist that the row says. */
#define CSG_FORMAT(ID, name, ...) csg_read_fn csg_##name##_read;
#include "io/formats.def"

/* Makes room for so many elements in an array of any type; array: where its pointer stands. False:
 * out of memory, not reported. */
bool csg_read_room(const csg_input *input, void *array, size_t *capacity, size_t needed,
                   size_t bytes);
/* Report why the file is refused. line 0 = not a text file: name the byte in the message. */
csgm_status csg_read_broken(const csg_input *input, uint32_t line, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
csgm_status csg_read_unsupported(const csg_input *input, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Of a file that is read several times. */
#define CSG_READ_SHORTER "the file has become shorter while it was read"

#define CSG_READ_TOO_FAR "a coordinate is beyond the range of floats"

/* Reports what the system said. CSGM_ERR_IO. */
csgm_status csg_read_failed(csgm_context *context, const char *path, int error);

/* All of a file's bytes from context->memory. fd < 0 = open the path. Reports failures. */
csgm_status csg_input_load(csgm_context *context, const char *path, int fd, uint8_t **bytes,
                           size_t *size_bytes);

/* Bytes that may still be taken, for libraries that take their own; 0 = no limit. */
static inline uint64_t csg_memory_left(const csg_memory *memory)
{
    uint64_t used = memory->used_bytes;
    return !memory->limit_bytes ? 0 : memory->limit_bytes > used ? memory->limit_bytes - used : 1;
}

/* ---- little-endian loads ---------------------------------------------------------- */

static inline uint32_t csg_load_u32(const uint8_t *at)
{
    return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

#endif
