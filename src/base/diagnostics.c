/* SPDX-License-Identifier: MIT
 * Counting, summing up and formatting of findings; see diagnostics.h.
 */
#include "base/diagnostics.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/mesh_codes.h"
#include "base/scene_codes.h"
#include "base/screen.h"

static const struct {
    csg_diag_code code;
    int severity; /* csgm_severity or CSG_STRICT_ERROR */
    const char *summary;
} rows[] = {
#define CSG_DIAG(name, number, severity, summary) {CSG_DIAG_##name, severity, summary},
#include "base/mesh_codes.def"
#include "base/scene_codes.def"
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
    if (row == sizeof rows / sizeof *rows || rows[row].severity == CSG_STRICT_ERROR)
        return CSGM_ERROR;
    return (csgm_severity)rows[row].severity;
}

bool csg_diag_may_be_lenient(csg_diag_code code)
{
    size_t row = row_of(code);
    return row < sizeof rows / sizeof *rows && rows[row].severity == CSG_STRICT_ERROR;
}

const char *csg_diag_summary(csg_diag_code code)
{
    size_t row = row_of(code);
    return row < sizeof rows / sizeof *rows ? rows[row].summary : NULL;
}

/* ---- what is shown ---------------------------------------------------------------------- */

static csgm_severity severity_here(const csg_diag_sink *sink, csg_diag_code code,
                                   const csgm_diag *diag)
{
    csgm_severity severity = diag->lenient ? CSGM_WARNING : csg_diag_severity(code);
    return severity == CSGM_WARNING && sink->warnings_as_errors ? CSGM_ERROR : severity;
}

/* Is it about what a mesh or a file has not got, which nobody may miss? */
static bool is_about_the_result(csg_diag_code code, const csgm_diag *diag)
{
    return diag->lenient || (code >= 400 && code < 600) || code == CSG_DIAG_LEFT_OUT ||
           code == CSG_DIAG_PART_LOST;
}

/* Is it the library's own business? What was mended in a surface, or left out since it encloses
 * nothing, is not: the points are mostly those of the caller, and the result is another solid. */
static bool is_of_library(const csg_diag_sink *sink, csg_diag_code code, const csgm_diag *diag)
{
    return diag->library && !sink->library_warnings && code != CSG_DIAG_MENDED &&
           code != CSG_DIAG_NOTHING_ENCLOSED;
}

/* The name of a finding's group, as far as a group keeps it. */
static const char *group_name(const csg_diag_sink *sink, csg_diag_code code, const csgm_diag *diag)
{
    enum { MOST = sizeof(csg_diag_group){0}.name - 1 };
    const char *name = is_of_library(sink, code, diag) ? diag->library : diag->source_name;
    size_t length = name ? strlen(name) : 0;
    return length > MOST ? name + length - MOST : name ? name : "";
}

static csg_diag_code group_code(const csg_diag_sink *sink, csg_diag_code code,
                                const csgm_diag *diag)
{
    return is_of_library(sink, code, diag) ? (csg_diag_code)0 : code;
}

/* The group's index, or group_count where there is none yet. */
static uint32_t find_group(const csg_diag_sink *sink, csg_diag_code code, const csgm_diag *diag)
{
    const char *name = group_name(sink, code, diag);
    csg_diag_code key = group_code(sink, code, diag);
    uint32_t i = 0;
    while (i < sink->group_count &&
           !(sink->groups[i].code == key && strcmp(sink->groups[i].name, name) == 0))
        i++;
    return i;
}

bool csg_diag_is_shown(const csg_diag_sink *sink, csg_diag_code code, const csgm_diag *diag)
{
    csgm_severity severity = severity_here(sink, code, diag);
    if (severity == CSGM_NOTE)
        return !sink->mute_notes;
    if (severity == CSGM_ERROR)
        return sink->errors < CSG_DIAG_ERRORS_MOST;
    if (is_about_the_result(code, diag))
        return true;
    if (is_of_library(sink, code, diag) || sink->warnings_shown >= CSG_DIAG_WARNINGS_MOST)
        return false;
    uint32_t group = find_group(sink, code, diag);
    return group < sink->group_count ? sink->groups[group].shown < CSG_DIAG_WARNINGS_ALIKE
                                     : group < CSG_DIAG_GROUPS_MOST;
}

static void count_warning(csg_diag_sink *sink, csg_diag_code code, const csgm_diag *diag,
                          bool is_shown)
{
    sink->warnings++;
    if (is_about_the_result(code, diag))
        return;
    sink->warnings_shown += is_shown;
    uint32_t i = find_group(sink, code, diag);
    if (i == CSG_DIAG_GROUPS_MOST) {
        sink->warnings_more++;
        return;
    }
    if (i == sink->group_count) {
        csg_diag_group *group = &sink->groups[sink->group_count++];
        *group = (csg_diag_group){.code = group_code(sink, code, diag)};
        snprintf(group->name, sizeof group->name, "%s", group_name(sink, code, diag));
    }
    *(is_shown ? &sink->groups[i].shown : &sink->groups[i].more) += 1;
}

void csg_diag_report(csg_diag_sink *sink, csg_diag_code code, csgm_diag diag)
{
    diag.code = (uint16_t)code;
    diag.severity = severity_here(sink, code, &diag);
    if (sink->errors_only && (diag.lenient || csg_diag_severity(code) == CSGM_WARNING)) {
        sink->mute_notes = true;
        return;
    }
    bool is_shown = csg_diag_is_shown(sink, code, &diag);
    if (diag.severity == CSGM_ERROR) {
        sink->errors++;
        sink->errors_more += !is_shown;
        sink->mute_notes = sink->errors > CSG_DIAG_ERRORS_IN_FULL;
        if (sink->mute_notes) {
            diag.hint = diag.source_line = NULL;
            diag.source_line_length = 0;
        }
    } else if (diag.severity == CSGM_WARNING) {
        count_warning(sink, code, &diag, is_shown);
        sink->mute_notes = !is_shown;
    }
    if (is_shown && sink->on_diag)
        sink->on_diag(sink->user, &diag);
}

static void note(csg_diag_sink *sink, const char *message)
{
    csgm_diag diag = {.severity = CSGM_NOTE, .code = CSG_DIAG_NOTE, .message = message};
    if (sink->on_diag)
        sink->on_diag(sink->user, &diag);
}

/* "23 warnings inside libraries are not shown (BOSL2 21, MCAD 2); -Wlibraries shows them" */
static void sum_up_libraries(csg_diag_sink *sink)
{
    char message[400];
    uint32_t count = 0;
    size_t length = 0;
    for (uint32_t i = 0; i < sink->group_count; i++)
        count += sink->groups[i].code == 0 ? sink->groups[i].more : 0;
    if (count == 0)
        return;
    length +=
        (size_t)snprintf(message, sizeof message, "%u %s inside libraries %s not shown (", count,
                         count == 1 ? "warning" : "warnings", count == 1 ? "is" : "are");
    const char *comma = "";
    for (uint32_t i = 0; i < sink->group_count && length < 300; i++) {
        const csg_diag_group *group = &sink->groups[i];
        if (group->code != 0)
            continue;
        length += (size_t)snprintf(message + length, sizeof message - length, "%s%.40s %u", comma,
                                   group->name, group->more);
        comma = ", ";
    }
    snprintf(message + length, sizeof message - length, "); -Wlibraries shows %s",
             count == 1 ? "it" : "them");
    csg_diag_make_line(message);
    note(sink, message);
}

void csg_diag_sum_up(csg_diag_sink *sink)
{
    char message[400];
    for (uint32_t i = 0; i < sink->group_count; i++) {
        const csg_diag_group *group = &sink->groups[i];
        if (group->code == 0 || group->more == 0)
            continue;
        snprintf(message, sizeof message, "and %u more like W%04u%s%s: %s", group->more,
                 (unsigned)group->code, group->name[0] ? " in " : "", group->name,
                 csg_diag_summary(group->code));
        csg_diag_make_line(message);
        note(sink, message);
    }
    sum_up_libraries(sink);
    if (sink->warnings_more) {
        snprintf(message, sizeof message, "and %u more warnings of other kinds",
                 sink->warnings_more);
        note(sink, message);
    }
    if (sink->errors_more) {
        snprintf(message, sizeof message, "and %u more errors", sink->errors_more);
        note(sink, message);
    }
    sink->group_count = sink->errors_more = sink->warnings_more = sink->warnings_shown = 0;
}

void csg_diag_make_line(char *message)
{
    size_t length = strlen(message), tail = 0;
    for (size_t i = 0; i < length; i++)
        if ((unsigned char)message[i] < 0x20 || message[i] == 0x7F)
            message[i] = ' ';
    while (tail < length && tail < 3 && ((unsigned char)message[length - 1 - tail] & 0xC0) == 0x80)
        tail++;
    unsigned char lead = tail < length ? (unsigned char)message[length - 1 - tail] : 0;
    size_t wanted = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC0 ? 1 : 0;
    if (wanted > tail) /* cut within a character */
        message[length - 1 - tail] = '\0';
}

void csg_diag_plain(csg_diag_sink *sink, csg_diag_code code, const char *name, const char *hint,
                    const char *format, ...)
{
    char message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    csg_diag_make_line(message);
    csg_diag_report(sink, code, (csgm_diag){.source_name = name, .message = message, .hint = hint});
}

/* ---- formatting --------------------------------------------------------------------- */

typedef struct writer {
    char *buffer;
    size_t size, length;
} writer;

static void put_bytes(writer *w, const char *text, size_t length)
{
    for (size_t i = 0; i < length; i++, w->length++)
        if (w->length + 1 < w->size)
            w->buffer[w->length] = text[i];
}

static void put_string(writer *w, const char *text)
{
    put_bytes(w, text, strlen(text));
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

/* The part of the source line that is shown: all of it, or some columns around the caret. */
typedef struct window {
    const char *text;
    size_t from, to;      /* bytes */
    size_t caret, behind; /* bytes that the caret and its tail stand under */
    bool cut_left, cut_right;
} window;

static const char CUT[] = "...";

/* The end of the character that makes the columns from `at` on too many, or the end of the line. */
static size_t advance(const char *text, size_t at, size_t length, uint32_t columns)
{
    while (at < length) {
        csg_screen_cell cell = csg_screen_cell_at(text + at, length - at);
        if (cell.columns > columns)
            break;
        columns -= cell.columns;
        at += cell.bytes;
    }
    return at;
}

static window make_window(const csgm_diag *diag)
{
    enum { WIDEST = 160, BEFORE = 70, AROUND = 140 };
    size_t length = diag->source_line_length, caret = diag->column ? diag->column - 1 : 0;
    caret = caret < length ? caret : length;
    window w = {.text = diag->source_line, .to = length, .caret = caret};
    w.behind = length - caret < diag->length ? length : caret + diag->length;
    if (advance(w.text, 0, length, WIDEST) == length)
        return w;
    w.from = caret;
    for (uint32_t columns = 0; w.from > 0 && columns < BEFORE;) {
        size_t before = csg_screen_step_back(w.text, w.from);
        columns += csg_screen_cell_at(w.text + before, w.from - before).columns;
        w.from = before;
    }
    w.to = advance(w.text, w.from, length, AROUND);
    w.cut_left = w.from > 0;
    w.cut_right = w.to < length;
    return w;
}

static void put_caret(writer *w, const csgm_diag *diag)
{
    window shown = make_window(diag);
    csg_screen_cell cell;
    put_string(w, shown.cut_left ? CUT : "");
    for (size_t at = shown.from; at < shown.to; at += cell.bytes) {
        cell = csg_screen_cell_at(shown.text + at, shown.to - at);
        if (cell.is_shown)
            put_bytes(w, shown.text + at, cell.bytes);
        else
            put_string(w, "\xEF\xBF\xBD"); /* U+FFFD */
    }
    put_string(w, shown.cut_right ? CUT : "");
    put_string(w, shown.cut_left ? "\n   " : "\n");
    for (size_t at = shown.from; at < shown.caret; at += cell.bytes) {
        cell = csg_screen_cell_at(shown.text + at, shown.caret - at);
        put_string(w, shown.text[at] == '\t' ? "\t" : "  " + (2 - cell.columns));
    }
    put_string(w, "^");
    uint32_t tail = 0;
    for (size_t at = shown.caret; at < shown.behind && at < shown.to; at += cell.bytes) {
        cell = csg_screen_cell_at(shown.text + at, shown.to - at);
        tail += cell.columns;
    }
    for (; tail > 1; tail--)
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
