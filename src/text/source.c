/* SPDX-License-Identifier: MIT
 * Reading texts and placing findings in them; see source.h. Lines are found by scanning: a run
 * shows at most a few dozen findings, so a table of lines would cost more than it saves.
 */
#include "text/source.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/mesh_codes.h"
#include "base/scene_codes.h"
#include "base/trace.h"
#include "base/utf8.h"

enum {
    LARGEST_TEXT = 64 << 20, /* bytes of one file */
    MOST_SOURCES = 10000,    /* an include that includes twice is a tree of 2^depth files */
    SNIFFED = 8192           /* bytes looked at to tell text from binary */
};

void csg_sources_init(csg_sources *sources, csgm_context *context, csg_arena *arena)
{
    *sources = (csg_sources){.context = context, .arena = arena};
}

void csg_sources_reset(csg_sources *sources)
{
    csg_memory_release(&sources->context->memory, sources->items,
                       sources->capacity * sizeof *sources->items);
    *sources = (csg_sources){.context = sources->context, .arena = sources->arena};
}

void csg_source_place(const csg_source *source, uint32_t offset, uint32_t *line, uint32_t *column)
{
    uint32_t begin = 0;
    *line = 1;
    if (offset > source->length)
        offset = source->length;
    for (uint32_t i = 0; i < offset; i++)
        if (source->text[i] == '\n') {
            begin = i + 1;
            *line += 1;
        }
    *column = offset - begin + 1;
}

/* ---- findings ------------------------------------------------------------------------- */

/* From the place where the finding begins, which is filled in. */
static void place_end(const csg_source *source, uint32_t offset, csgm_diag *diag)
{
    diag->end_line = diag->line;
    diag->end_column = diag->column;
    for (uint32_t i = 0; i < diag->length; i++) {
        bool breaks = offset < source->length && i < source->length - offset &&
                      source->text[offset + i] == '\n';
        diag->end_line += breaks;
        diag->end_column = breaks ? 1 : diag->end_column + 1;
    }
}

bool csg_source_is_lenient(const csg_sources *sources, csg_diag_code code, csg_span where)
{
    return where.source < sources->count && sources->items[where.source].lenient &&
           csg_diag_may_be_lenient(code);
}

/* A finding in the file of `where`, so far without its place and words. */
static csgm_diag finding_in(const csg_sources *sources, csg_diag_code code, csg_span where)
{
    const csg_source *source = where.source < sources->count ? &sources->items[where.source] : NULL;
    return (csgm_diag){.source_name = source ? source->name : NULL,
                       .library = source ? source->library : NULL,
                       .lenient = csg_source_is_lenient(sources, code, where)};
}

bool csg_source_is_shown(const csg_sources *sources, csg_diag_code code, csg_span where)
{
    csgm_diag diag = finding_in(sources, code, where);
    return csg_diag_is_shown(&sources->context->diags, code, &diag);
}

static void report_at(const csg_sources *sources, csg_diag_code code, csg_span where,
                      const char *hint, const char *message)
{
    csgm_diag diag = finding_in(sources, code, where);
    diag.message = message;
    diag.hint = hint;
    /* What is not shown is only counted: finding its line could be slow. */
    if (where.source < sources->count && csg_diag_is_shown(&sources->context->diags, code, &diag)) {
        const csg_source *source = &sources->items[where.source];
        csg_source_place(source, where.offset, &diag.line, &diag.column);
        diag.length = where.length ? where.length : 1;
        uint32_t begin = (where.offset < source->length ? where.offset : source->length);
        begin -= diag.column - 1;
        uint32_t end = begin;
        while (end < source->length && source->text[end] != '\n' && source->text[end] != '\r')
            end++;
        diag.source_line = source->text + begin;
        diag.source_line_length = end - begin;
        place_end(source, where.offset, &diag);
    }
    csg_diag_report(&sources->context->diags, code, diag);
}

void csg_source_note(const csg_sources *sources, csg_span where, const char *format, ...)
{
    char message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    csg_diag_make_line(message);
    report_at(sources, CSG_DIAG_NOTE, where, NULL, message);
}

static void note_includes(const csg_sources *sources, csg_span where)
{
    enum { MOST = 8 };
    for (int shown = 0; where.source < sources->count; shown++) {
        const csg_source *source = &sources->items[where.source];
        if (source->from.source >= sources->count)
            return;
        if (shown == MOST) {
            csg_source_note(sources, source->from, "and so on");
            return;
        }
        csg_source_note(sources, source->from,
                        source->textual ? "included from here" : "used from here");
        where = source->from;
    }
}

void csg_source_report(const csg_sources *sources, csg_diag_code code, csg_span where,
                       const char *hint, const char *format, ...)
{
    char message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    csg_diag_make_line(message);
    report_at(sources, code, where, hint, message);
    note_includes(sources, where);
}

/* ---- reading --------------------------------------------------------------------------- */

/* Text has hardly any control characters, other files have plenty; broken UTF-8 counts a little, as
 * there is text in other codes. */
static bool is_binary(const char *text, size_t length)
{
    enum { CONTROL = 16, BROKEN = 1 };
    size_t sniffed = length < SNIFFED ? length : SNIFFED, strange = 0;
    for (size_t i = 0; i < sniffed;) {
        unsigned char c = (unsigned char)text[i];
        size_t step = csg_utf8_length(text + i, length - i);
        if ((c < 0x20 && (c < '\t' || c > '\r')) || c == 0x7F)
            strange += CONTROL;
        else if (step == 0)
            strange += BROKEN;
        i += step ? step : 1;
    }
    return strange >= 4 * CONTROL && strange * 12 > sniffed * CONTROL;
}

/* By its name: an OpenSCAD file has one of these endings. */
static bool is_openscad(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot && (strcasecmp(dot, ".scad") == 0 || strcasecmp(dot, ".csg") == 0);
}

static csgm_status add_source(csg_sources *sources, csg_source source, uint32_t *out)
{
    csg_memory *memory = &sources->context->memory;
    if (sources->count >= MOST_SOURCES) {
        csg_source_report(sources, CSG_DIAG_TOO_MANY_FILES, source.from, NULL,
                          "more than %d files are included", (int)MOST_SOURCES);
        return CSGM_ERR_LIMIT;
    }
    if (!csg_memory_reserve(memory, (void **)&sources->items, &sources->capacity,
                            sources->count + 1, sizeof *sources->items))
        return csg_context_no_memory(sources->context);
    source.lenient = sources->leniency == CSGM_LENIENT ||
                     (sources->leniency == CSGM_LENIENT_BY_FILE && is_openscad(source.name));
    sources->items[sources->count] = source;
    *out = (uint32_t)sources->count++;
    return CSGM_OK;
}

/* A plain finding about a file, or one at the include that asked for it. */
static void report_file(const csg_sources *sources, csg_diag_code code, csg_span from,
                        const char *path, const char *hint, const char *problem)
{
    if (from.source < sources->count)
        csg_source_report(sources, code, from, hint, "%.300s: %s", path, problem);
    else
        csg_diag_plain(&sources->context->diags, code, path, hint, "%s", problem);
}

static csgm_status check_content(const csg_sources *sources, csg_span from, const char *name,
                                 const char *text, size_t length)
{
    if (length > LARGEST_TEXT) {
        report_file(sources, CSG_DIAG_FILE_TOO_LARGE, from, name, NULL,
                    "the text is larger than 64 MiB");
        return CSGM_ERR_LIMIT;
    }
    if (is_binary(text, length)) {
        bool utf16 =
            length >= 2 && (memcmp(text, "\xFF\xFE", 2) == 0 || memcmp(text, "\xFE\xFF", 2) == 0);
        report_file(sources, CSG_DIAG_BINARY_FILE, from, name,
                    utf16 ? "it looks like UTF-16: save it as UTF-8"
                          : "a scene is a text file in UTF-8; meshes are read by import()",
                    "this is not a text file");
        return CSGM_ERR_SYNTAX;
    }
    return CSGM_OK;
}

static void identify(csg_source *source, const struct stat *status)
{
    source->device = (uint64_t)status->st_dev;
    source->inode = (uint64_t)status->st_ino;
}

csgm_status csg_source_add(csg_sources *sources, const char *name, const char *text, size_t length,
                           uint32_t *out)
{
    csg_source source = {.from = csg_span_nowhere(), .textual = true, .text = text ? text : ""};
    source.name = csg_arena_strndup(sources->arena, name, strlen(name));
    if (!source.name)
        return csg_context_no_memory(sources->context);
    csgm_status status = check_content(sources, source.from, name, source.text, length);
    if (status != CSGM_OK)
        return status;
    struct stat info;
    if (stat(name, &info) == 0 && S_ISREG(info.st_mode))
        identify(&source, &info);
    source.length = (uint32_t)length;
    return add_source(sources, source, out);
}

bool csg_source_exists(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && !S_ISDIR(info.st_mode) && access(path, R_OK) == 0;
}

bool csg_source_is_file(const csg_source *source, const char *path)
{
    struct stat info;
    return source->inode != 0 && stat(path, &info) == 0 &&
           source->device == (uint64_t)info.st_dev && source->inode == (uint64_t)info.st_ino;
}

typedef struct buffer {
    char *data;
    size_t length, capacity;
} buffer;

/* Reads until the end or one byte past the limit. 0, or an errno value. */
static int read_all(csg_memory *memory, int file, buffer *into)
{
    while (into->length <= LARGEST_TEXT) {
        if (!csg_memory_reserve(memory, (void **)&into->data, &into->capacity, into->length + 65536,
                                1))
            return ENOMEM;
        ssize_t got = read(file, into->data + into->length, into->capacity - into->length);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return errno;
        if (got == 0)
            break;
        into->length += (size_t)got;
    }
    return 0;
}

static csgm_status take_text(csg_sources *sources, const csg_source_request *request,
                             const buffer *data, const struct stat *info, uint32_t *out)
{
    csg_source source = {
        .from = request->from, .textual = request->textual, .library = request->library};
    csgm_status status =
        check_content(sources, request->from, request->path, data->data, data->length);
    if (status != CSGM_OK)
        return status;
    source.name = csg_arena_strndup(sources->arena, request->path, strlen(request->path));
    source.text = csg_arena_strndup(sources->arena, data->data, data->length);
    if (!source.name || !source.text)
        return csg_context_no_memory(sources->context);
    source.length = (uint32_t)data->length;
    identify(&source, info);
    return add_source(sources, source, out);
}

static csgm_status read_file(csg_sources *sources, const csg_source_request *request, int file,
                             uint32_t *out)
{
    struct stat info;
    if (fstat(file, &info) == 0 && S_ISDIR(info.st_mode)) {
        report_file(sources, CSG_DIAG_UNREADABLE_SOURCE, request->from, request->path,
                    "give the path of a scene file in it", "this is a directory");
        return CSGM_ERR_IO;
    }
    if (request->from.source < sources->count && !S_ISREG(info.st_mode)) {
        report_file(sources, CSG_DIAG_UNREADABLE_SOURCE, request->from, request->path,
                    "only the scene itself may come from a pipe or device",
                    "this is not a regular file");
        return CSGM_ERR_IO;
    }
    csg_memory *memory = &sources->context->memory;
    buffer data = {0};
    int problem = read_all(memory, file, &data);
    csgm_status status = CSGM_ERR_IO;
    if (problem == ENOMEM)
        status = csg_context_no_memory(sources->context);
    else if (problem)
        report_file(sources, CSG_DIAG_UNREADABLE_SOURCE, request->from, request->path, NULL,
                    strerror(problem));
    else
        status = take_text(sources, request, &data, &info, out);
    csg_memory_release(memory, data.data, data.capacity);
    return status;
}

static const csg_source *find_read(const csg_sources *sources, const char *path)
{
    for (size_t i = 0; i < sources->count; i++)
        if (strcmp(sources->items[i].name, path) == 0 && sources->items[i].inode)
            return &sources->items[i];
    return NULL;
}

csgm_status csg_source_read(csg_sources *sources, const csg_source_request *request, uint32_t *out)
{
    CSG_ZONE(sources->context, "read text");
    const csg_source *known = find_read(sources, request->path);
    if (known) {
        csg_source again = *known;
        again.from = request->from;
        again.textual = request->textual;
        again.library = request->library;
        return add_source(sources, again, out);
    }
    /* A scene must not make the program wait for a pipe that nobody writes to. */
    int wait = request->from.source < sources->count ? O_NONBLOCK : 0;
    int file = open(request->path, O_RDONLY | O_CLOEXEC | wait);
    csg_context_tell_file(sources->context, request->path, file >= 0);
    if (file < 0) {
        report_file(sources, CSG_DIAG_UNREADABLE_SOURCE, request->from, request->path, NULL,
                    strerror(errno));
        return CSGM_ERR_IO;
    }
    csgm_status status = read_file(sources, request, file, out);
    close(file);
    return status;
}
