/* SPDX-License-Identifier: MIT
 * The table of formats, made of formats.def, and what can be asked of it.
 */
#include "io/formats.h"

#include <stdio.h>
#include <strings.h>

#include "base/mesh_codes.h"
#include "io/format_table.h"

/* ---- the table -------------------------------------------------------------------- */

static bool is_always_there(void)
{
    return true;
}

static const csg_format_library library_NONE = {"nothing", is_always_there};
#define CSG_LIBRARY(ID, is_there, name)                                                            \
    static const csg_format_library library_##ID = {name, is_there};
#include "io/formats.def"

#define WRITER_READ_WRITE(name) csg_##name##_write
#define WRITER_WRITE_ONLY(name) csg_##name##_write
#define WRITER_READ_ONLY(name) NULL
#define READER_READ_WRITE(name) csg_##name##_read
#define READER_WRITE_ONLY(name) NULL
#define READER_READ_ONLY(name) csg_##name##_read
#define STREAM_STREAMED(name) &csg_##name##_stream
#define STREAM_WHOLE(name) NULL
#define RUNS_IN_RUNS(name) &csg_##name##_runs
#define RUNS_AT_ONCE(name) NULL

#define CSG_FORMAT(ID, name_, title_, way, fill, scan, writes_by, reads_by, traits_, bytes,        \
                   remarks_)                                                                       \
    static const csg_format_row row_##ID = {.id = CSGM_FORMAT_##ID,                                \
                                            .name = #name_,                                        \
                                            .title = title_,                                       \
                                            .write = WRITER_##way(name_),                          \
                                            .read = READER_##way(name_),                           \
                                            .stream = STREAM_##fill(name_),                        \
                                            .runs = RUNS_##scan(name_),                            \
                                            .write_library = &library_##writes_by,                 \
                                            .read_library = &library_##reads_by,                   \
                                            .traits = traits_,                                     \
                                            .first_bytes = bytes,                                  \
                                            .remarks = remarks_};
#include "io/formats.def"

/* The compiler refuses a format of the public enum without a row, and a row without a format. */
const csg_format_row *csg_format_find(csgm_format format)
{
    switch (format) {
#define CSG_FORMAT(ID, ...)                                                                        \
    case CSGM_FORMAT_##ID:                                                                         \
        return &row_##ID;
#include "io/formats.def"
    case CSGM_FORMAT_AUTO:
    case CSGM_FORMAT_COUNT:
        break;
    }
    return NULL;
}

/* The rows one after the other: the one behind `row`, the first for NULL, NULL behind the last. */
static const csg_format_row *next_row(const csg_format_row *row)
{
    return csg_format_find((csgm_format)((row ? row->id : CSGM_FORMAT_AUTO) + 1));
}

/* ---- questions -------------------------------------------------------------------- */

csgm_format csg_format_from_name(const char *name)
{
    for (const csg_format_row *row = next_row(NULL); name && row; row = next_row(row))
        if (strcasecmp(row->name, name) == 0)
            return row->id;
    return CSGM_FORMAT_AUTO;
}

csgm_format csg_format_from_path(const char *path)
{
    const char *dot = path ? strrchr(path, '.') : NULL;
    return dot && !strchr(dot, '/') ? csg_format_from_name(dot + 1) : CSGM_FORMAT_AUTO;
}

const char *csg_format_name(csgm_format format)
{
    const csg_format_row *row = csg_format_find(format);
    return row ? row->name : "auto";
}

const char *csg_format_title(csgm_format format)
{
    const csg_format_row *row = csg_format_find(format);
    return row ? row->title : "";
}

uint32_t csg_format_traits(csgm_format format)
{
    const csg_format_row *row = csg_format_find(format);
    if (!row)
        return 0;
    return row->traits | (row->write ? CSGM_IS_WRITTEN : 0) | (row->read ? CSGM_IS_READ : 0) |
           (row->stream ? CSGM_IS_STREAMED : 0);
}

bool csg_format_available(csgm_format format, bool for_reading)
{
    const csg_format_row *row = csg_format_find(format);
    if (!row)
        return false;
    return for_reading ? row->read && row->read_library->is_there()
                       : row->write && row->write_library->is_there();
}

const csg_format_row *csg_format_recognise(const uint8_t *bytes, size_t size_bytes)
{
    /* binary STL has no first bytes of its own, but its size follows from its count */
    if (size_bytes >= 84 && size_bytes == 84 + 50 * (uint64_t)csg_load_u32(bytes + 80))
        return &row_STL;
    for (const csg_format_row *row = next_row(NULL); row; row = next_row(row))
        for (const char *begin = row->first_bytes; *begin; begin += strlen(begin) + 1)
            if (size_bytes >= strlen(begin) && memcmp(bytes, begin, strlen(begin)) == 0)
                return row;
    return NULL;
}

/* ---- refusals --------------------------------------------------------------------- */

csgm_status csg_format_no_library(csgm_context *context, const char *file, const char *library,
                                  const char *what)
{
    csg_diag_plain(&context->diags, CSG_DIAG_NO_LIBRARY, file,
                   "install the library's development package and build csgmesh again",
                   "this csgmesh was built without %s, which %s needs", library, what);
    return CSGM_ERR_UNSUPPORTED;
}

/* glTF has the origin as a matrix. Doubles are 2^29 times as fine as the mesh's own floats: they
 * may join what lies much nearer to each other than a float's step, as sharp features do. */
bool csg_format_rounds(const csg_format_row *row, double distance)
{
    const double far = 0x1p18;
    if (row->traits & CSGM_HEEDS_UP)
        return false;
    return distance > (row->traits & CSGM_KEEPS_DOUBLES ? far : 0);
}

csgm_status csg_format_check(csgm_context *context, const char *file, const csg_format_row *row,
                             bool for_reading)
{
    if (for_reading ? !row->read : !row->write) {
        csg_diag_plain(&context->diags, CSG_DIAG_ONE_WAY_FORMAT, file, NULL,
                       for_reading ? "csgmesh writes %s files and cannot read them"
                                   : "csgmesh reads %s files and cannot write them",
                       row->title);
        return CSGM_ERR_UNSUPPORTED;
    }
    const csg_format_library *library = for_reading ? row->read_library : row->write_library;
    if (library->is_there())
        return CSGM_OK;
    return csg_format_no_library(context, file, library->name,
                                 for_reading ? "reading this format" : "this format");
}

csgm_status csg_format_unknown(csgm_context *context, const char *file)
{
    char known[256] = "formats are";
    for (const csg_format_row *row = next_row(NULL); row; row = next_row(row)) {
        size_t length = strlen(known);
        snprintf(known + length, sizeof known - length, "%s %s", row->id > 1 ? "," : "", row->name);
    }
    csg_diag_plain(&context->diags, CSG_DIAG_UNKNOWN_FORMAT, file, known,
                   "the file name's extension names no mesh format");
    return CSGM_ERR_UNSUPPORTED;
}
