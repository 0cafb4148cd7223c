/* SPDX-License-Identifier: MIT
 * Counting, capping and formatting of findings; see diagnostics.h.
 */
#include "base/diagnostics.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const struct {
    csg_diag_code code;
    csgm_severity severity;
    const char *summary;
} rows[] = {
#define CSG_DIAG(name, number, severity, summary) {CSG_DIAG_##name, severity, summary},
#include "base/diagnostics.def"
#undef CSG_DIAG
};

static size_t row_of(csg_diag_code code)
{
    size_t i = 0;
    while (i < sizeof rows / sizeof *rows && rows[i].code != code)
        i++;
    return i;
}

csgm_severity csg_diag_severity(csg_diag_code code)
{
    size_t row = row_of(code);
    return row < sizeof rows / sizeof *rows ? rows[row].severity : CSGM_ERROR;
}

const char *csg_diag_summary(csg_diag_code code)
{
    size_t row = row_of(code);
    return row < sizeof rows / sizeof *rows ? rows[row].summary : NULL;
}

void csg_diag_report(csg_diag_sink *sink, csg_diag_code code, csgm_diag diag)
{
    diag.code = (uint16_t)code;
    diag.severity = csg_diag_severity(code);
    if (diag.severity == CSGM_WARNING && sink->warnings_as_errors)
        diag.severity = CSGM_ERROR;
    if (diag.severity == CSGM_NOTE) {
        if (sink->mute_notes)
            return;
    } else {
        *(diag.severity == CSGM_ERROR ? &sink->errors : &sink->warnings) += 1;
        sink->mute_notes = sink->errors + sink->warnings > CSG_DIAG_MOST;
        if (sink->mute_notes) {
            sink->dropped++;
            return;
        }
    }
    if (sink->on_diag)
        sink->on_diag(sink->user, &diag);
}

void csg_diag_plain(csg_diag_sink *sink, csg_diag_code code, const char *name, const char *hint,
                    const char *format, ...)
{
    char message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    csg_diag_report(sink, code, (csgm_diag){.source_name = name, .message = message, .hint = hint});
}

/* ---- formatting --------------------------------------------------------------------- */

typedef struct writer {
    char *buffer;
    size_t size, length;
} writer;

static void put(writer *w, const char *text, size_t length)
{
    for (size_t i = 0; i < length; i++, w->length++)
        if (w->length + 1 < w->size)
            w->buffer[w->length] = text[i];
}

static void put_string(writer *w, const char *text)
{
    put(w, text, strlen(text));
}

static void put_place(writer *w, const csgm_diag *diag)
{
    char place[64];
    if (diag->source_name)
        put_string(w, diag->source_name);
    if (diag->line) {
        snprintf(place, sizeof place, ":%u:%u", diag->line, diag->column);
        put_string(w, place);
    }
    put_string(w, diag->source_name ? ": " : "csgmesh: ");
}

static void put_caret(writer *w, const csgm_diag *diag)
{
    put(w, diag->source_line, diag->source_line_length);
    put_string(w, "\n");
    for (uint32_t i = 0; i + 1 < diag->column && i < diag->source_line_length; i++) {
        char c = diag->source_line[i];
        if (((unsigned char)c & 0xC0) == 0x80) /* UTF-8 continuation: no column on the screen */
            continue;
        put_string(w, c == '\t' ? "\t" : " ");
    }
    put_string(w, "^");
    uint32_t room =
        diag->source_line_length >= diag->column ? diag->source_line_length - diag->column : 0;
    for (uint32_t i = 1; i < diag->length && i <= room; i++)
        put_string(w, "~");
    put_string(w, "\n");
}

size_t csgm_diag_format(const csgm_diag *diag, char *buffer, size_t size)
{
    writer w = {buffer, size, 0};
    char head[48];
    put_place(&w, diag);
    if (diag->severity == CSGM_NOTE)
        snprintf(head, sizeof head, "note: ");
    else
        snprintf(head, sizeof head,
                 "%s %c%04u: ", diag->severity == CSGM_ERROR ? "error" : "warning",
                 diag->severity == CSGM_ERROR ? 'E' : 'W', diag->code);
    put_string(&w, head);
    put_string(&w, diag->message);
    put_string(&w, "\n");
    if (diag->source_line && diag->line)
        put_caret(&w, diag);
    if (diag->hint) {
        put_string(&w, "hint: ");
        put_string(&w, diag->hint);
        put_string(&w, "\n");
    }
    if (size)
        buffer[w.length < size ? w.length : size - 1] = '\0';
    return w.length;
}
