/* SPDX-License-Identifier: MIT
 * The texts of one compilation: what was read from where, and the way from a byte offset back to
 * file, line and column. Every finding about text is reported through here, followed by the trace
 * of includes that led to it.
 */
#ifndef CSG_TEXT_SOURCE_H
#define CSG_TEXT_SOURCE_H

#include "base/context.h"
#include "base/span.h"

typedef struct csg_source {
    const char *name; /* path as found, or the caller's name of the text */
    const char *text;
    uint32_t length;
    uint64_t device, inode; /* identity of the file; both 0 for a text without one */
    csg_span from;          /* the include that asked for it; source UINT32_MAX = the main text */
    bool textual;           /* by include (its statements stand in the asking file), not by use */
    const char *library;    /* the library that the file belongs to; NULL = the scene's own */
    bool lenient;           /* what OpenSCAD only warns of is a warning here too */
} csg_source;

typedef struct csg_sources {
    csgm_context *context;
    csg_arena *arena; /* names and texts */
    csgm_leniency leniency;
    csg_source *items;
    size_t count, capacity;
} csg_sources;

/* What to read, and on whose account. */
typedef struct csg_source_request {
    const char *path;
    csg_span from; /* source UINT32_MAX: nobody's */
    bool textual;
    const char *library; /* see csg_source; kept */
} csg_source_request;

void csg_sources_init(csg_sources *sources, csgm_context *context, csg_arena *arena);
void csg_sources_reset(csg_sources *sources);

/* text is borrowed. Refuses binary content and more than 64 MiB. */
csgm_status csg_source_add(csg_sources *sources, const char *name, const char *text, size_t length,
                           uint32_t *out);
/* Reads a file (or shares the text when it was read before); reports what goes wrong. */
csgm_status csg_source_read(csg_sources *sources, const csg_source_request *request, uint32_t *out);
/* True when the path names a regular file or pipe that can be opened for reading. */
bool csg_source_exists(const char *path);
/* Is the file behind `path` this source? */
bool csg_source_is_file(const csg_source *source, const char *path);

/* 1-based; the column counts bytes. */
void csg_source_place(const csg_source *source, uint32_t offset, uint32_t *line, uint32_t *column);

/* Reports a finding at a place, then notes for the includes that led there. */
void csg_source_report(const csg_sources *sources, csg_diag_code code, csg_span where,
                       const char *hint, const char *format, ...)
    __attribute__((format(printf, 5, 6)));
/* Is a finding of this code, which is an error in a strict text, only a warning there? */
bool csg_source_is_lenient(const csg_sources *sources, csg_diag_code code, csg_span where);
/* Would a finding there be shown? For callers to whom its text is work. */
bool csg_source_is_shown(const csg_sources *sources, csg_diag_code code, csg_span where);
/* One note at a place, without a trace. */
void csg_source_note(const csg_sources *sources, csg_span where, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
