/* SPDX-License-Identifier: MIT
 * Pieces -> lines -> text; see format.h. First each piece gets its line and the blanks before it;
 * then comments behind code get their columns: what stood below each other still does.
 */
#include "lang/edit/format.h"

#include <string.h>

#include "base/scene_codes.h"
#include "lang/edit/layout.h"
#include "lang/lang.h"

typedef struct buffer {
    csg_memory *memory;
    char *text;
    size_t length, capacity;
    bool no_memory;
} buffer;

typedef struct line {
    uint32_t first, end; /* its pieces, without the comment behind them */
    uint32_t comment;    /* the piece behind the code, or CSG_EDIT_NONE */
    bool is_blank_before;
    bool is_plain;  /* no piece has a line break inside, as strings may have */
    uint32_t width; /* columns of the code */
} line;

enum { ALIGNED_MOST = 256 }; /* comments farther to the right stand for themselves */

/* What comments that began in one column have in common. */
typedef struct aligned {
    uint32_t width; /* of the longest code before one */
    uint32_t gap;   /* the smallest between code and comment; 0: there is none */
} aligned;

/* Blanks before a piece. */
typedef struct spot {
    uint32_t blanks, least; /* as they are now, and at least */
    uint32_t begin, end;    /* its columns, of the lines that are compared */
} spot;

typedef struct formatter {
    csg_memory *memory;
    const char *text;
    csg_edit_pieces pieces;
    csg_layout layout;
    spot *spots; /* one for each piece */
    buffer out;
    uint32_t column; /* behind the last piece */
    bool is_loose;   /* the line has blanks that may go later: its columns are not known yet */
    line *lines;
    size_t line_count, line_capacity;
    const char *line_end; /* "\n" or "\r\n", as the text has it */
} formatter;

static void put_text(buffer *to, const char *text, size_t length)
{
    if (to->no_memory || !csg_memory_reserve(to->memory, (void **)&to->text, &to->capacity,
                                             to->length + length + 1, 1)) {
        to->no_memory = true;
        return;
    }
    memcpy(to->text + to->length, text, length);
    to->length += length;
}

static void put_blanks(buffer *to, uint32_t count)
{
    static const char blanks[] = "                                ";
    for (; count > 0 && !to->no_memory;) {
        uint32_t now = count < sizeof blanks - 1 ? count : (uint32_t)sizeof blanks - 1;
        put_text(to, blanks, now);
        count -= now;
    }
}

static bool is_blank(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/* ---- lines --------------------------------------------------------------------------------- */

static const csg_edit_piece *at(const formatter *f, uint32_t piece)
{
    return &f->pieces.items[piece];
}

static bool is_comment(const csg_edit_piece *piece)
{
    return piece->kind != CSG_EDIT_TOKEN;
}

/* Line breaks that this piece has before it from now on: 2 leave a line empty. */
static uint32_t breaks_before(const formatter *f, uint32_t piece)
{
    const csg_edit_piece *now = at(f, piece), *last = at(f, piece - 1);
    uint32_t breaks = now->breaks < 2 ? now->breaks : 2;
    csg_token_kind before = f->layout.last;
    bool in_multi = csg_layout_in_multi(&f->layout);
    if (before == CSG_TOKEN_OPEN_CURLY && now->token == CSG_TOKEN_CLOSE_CURLY && !is_comment(last))
        return 0;
    if (now->token == CSG_TOKEN_CLOSE_CURLY)
        return in_multi ? 1 : breaks < 1 ? breaks : 1;
    if (before == CSG_TOKEN_OPEN_CURLY && !is_comment(last)) {
        bool is_trailing = is_comment(now) && now->breaks == 0;
        return in_multi && !is_trailing ? 1 : 0;
    }
    if (before == CSG_TOKEN_OPEN_CURLY && in_multi && breaks == 0)
        return 1; /* the comment behind the brace ends its line */
    if (is_comment(last))
        return breaks == 0 && last->kind == CSG_EDIT_LINE_COMMENT ? 1 : breaks;
    if (now->token == CSG_TOKEN_OPEN_CURLY &&
        (before == CSG_TOKEN_CLOSE_ROUND || before == CSG_TOKEN_ELSE))
        return 0;
    if (now->token == CSG_TOKEN_ELSE && before == CSG_TOKEN_CLOSE_CURLY &&
        csg_layout_else_joins(&f->layout))
        return 0;
    return breaks;
}

/* Is nothing behind this comment on its line? */
static bool is_trailing(const formatter *f, uint32_t piece)
{
    const csg_edit_piece *now = at(f, piece);
    return is_comment(now) && now->breaks == 0 && f->line_count > 0 &&
           !memchr(f->text + now->offset, '\n', now->length) &&
           (at(f, piece + 1)->breaks > 0 || at(f, piece + 1)->token == CSG_TOKEN_END);
}

static bool begin_line(formatter *f, uint32_t piece, bool is_blank_before)
{
    if (!csg_memory_reserve(f->memory, (void **)&f->lines, &f->line_capacity, f->line_count + 1,
                            sizeof *f->lines))
        return false;
    f->lines[f->line_count++] = (line){.first = piece,
                                       .end = piece,
                                       .comment = CSG_EDIT_NONE,
                                       .is_blank_before = is_blank_before,
                                       .is_plain = true};
    f->column = 0;
    f->is_loose = false;
    return true;
}

/* Blanks that stand between this piece and the last and may stay, as in a column of numbers; 0 also
 * where there is anything else. */
static uint32_t blanks_in_text(const formatter *f, uint32_t piece)
{
    const csg_edit_piece *last = at(f, piece - 1), *now = at(f, piece);
    bool is_number = now->token == CSG_TOKEN_NUMBER || now->token == CSG_TOKEN_MINUS;
    if (f->spots[piece].least == 0 && !(is_number && csg_token_opens(last->token)))
        return 0;
    uint32_t from = last->offset + last->length;
    for (uint32_t i = from; i < now->offset; i++)
        if (f->text[i] != ' ')
            return 0;
    return now->offset - from;
}

static bool add_piece(formatter *f, uint32_t piece)
{
    const csg_edit_piece *now = at(f, piece);
    spot *s = &f->spots[piece];
    line *last = f->line_count ? &f->lines[f->line_count - 1] : NULL;
    uint32_t breaks = last ? breaks_before(f, piece) : 1;
    if (breaks == 0 && last->comment == CSG_EDIT_NONE && is_trailing(f, piece)) {
        last->comment = piece;
        return true;
    }
    bool begins = breaks > 0 || last->comment != CSG_EDIT_NONE;
    if (begins && !begin_line(f, piece, last && breaks > 1))
        return false;
    last = &f->lines[f->line_count - 1];
    s->least = s->blanks =
        begins ? csg_layout_begin_line(&f->layout, piece) : csg_layout_gap(&f->layout, piece);
    if (!begins && blanks_in_text(f, piece) > s->blanks)
        s->blanks = blanks_in_text(f, piece);
    f->is_loose = f->is_loose || s->blanks > s->least;
    uint32_t column = f->column + s->blanks;
    f->column = csg_column_behind(column, f->text + now->offset, now->length);
    last->end = piece + 1;
    last->is_plain = last->is_plain && !memchr(f->text + now->offset, '\n', now->length);
    return csg_layout_pass(&f->layout, piece, f->is_loose ? CSG_EDIT_NONE : column);
}

/* ---- columns that line up ------------------------------------------------------------------- */

/* Blanks more than there need be are kept where what is behind them lines up with something in one
 * of the two lines above or below: tables stay tables. */
enum { NEAR = 2, NEIGHBOURS = 2 * NEAR };

static void measure(formatter *f, line *l)
{
    uint32_t column = 0;
    for (uint32_t i = l->first; i < l->end; i++) {
        f->spots[i].begin = column + f->spots[i].blanks;
        column = csg_column_behind(f->spots[i].begin, f->text + at(f, i)->offset, at(f, i)->length);
        f->spots[i].end = column;
    }
    l->width = column;
}

/* A line that is compared, and how far. */
typedef struct neighbour {
    const line *line;
    uint32_t from;
} neighbour;

static size_t find_neighbours(const formatter *f, size_t index, neighbour out[NEIGHBOURS])
{
    size_t count = 0;
    if (!f->lines[index].is_plain)
        return 0;
    for (size_t i = index, k = 0; k < NEAR && i > 0 && !f->lines[i].is_blank_before; k++) {
        i--;
        if (f->lines[i].is_plain)
            out[count++] = (neighbour){&f->lines[i], f->lines[i].first};
    }
    for (size_t i = index + 1, k = 0; k < NEAR && i < f->line_count && !f->lines[i].is_blank_before;
         k++, i++)
        if (f->lines[i].is_plain)
            out[count++] = (neighbour){&f->lines[i], f->lines[i].first};
    return count;
}

/* Commas and closing brackets line up with nothing. */
static bool is_column(const formatter *f, uint32_t piece)
{
    csg_token_kind kind = at(f, piece)->token;
    return !csg_token_closes(kind) && kind != CSG_TOKEN_COMMA && kind != CSG_TOKEN_SEMICOLON;
}

/* Does a piece of the neighbour begin or end where this one does? Asked from left to right. */
static bool lines_up(const formatter *f, neighbour *n, uint32_t begin, uint32_t end)
{
    const spot *spots = f->spots;
    while (n->from < n->line->end && spots[n->from].end < begin)
        n->from++;
    for (uint32_t i = n->from; i < n->line->end && spots[i].begin <= end; i++)
        if (i > n->line->first && is_column(f, i) &&
            (spots[i].begin == begin || spots[i].end == end))
            return true;
    return false;
}

/* Takes the blanks away that are for nothing. False: there were none. */
static bool tighten(formatter *f, size_t index)
{
    line *l = &f->lines[index];
    neighbour near[NEIGHBOURS];
    size_t count = find_neighbours(f, index, near);
    uint32_t shift = 0; /* how far the line has become shorter */
    for (uint32_t i = l->first + 1; i < l->end; i++) {
        spot *s = &f->spots[i];
        bool keeps = s->blanks == s->least;
        for (size_t k = 0; k < count && !keeps && is_column(f, i); k++)
            keeps = lines_up(f, &near[k], s->begin - shift, s->end - shift);
        if (!keeps) {
            shift += s->blanks - s->least;
            s->blanks = s->least;
        }
    }
    if (shift > 0)
        measure(f, l);
    return shift > 0;
}

/* Until nothing changes: a line that has moved may have been what others lined up with. A text that
 * takes too long to settle has no tables. */
static void tighten_all(formatter *f)
{
    uint64_t patience = 16 * (uint64_t)f->pieces.count + 4096;
    for (size_t i = 0; i < f->line_count; i++)
        measure(f, &f->lines[i]);
    for (size_t i = 0; i < f->line_count && patience > 0;) {
        uint64_t work = f->lines[i].end - f->lines[i].first;
        patience = patience > work ? patience - work : 0;
        if (tighten(f, i))
            i = i > NEAR ? i - NEAR : 0;
        else
            i++;
    }
    for (size_t i = 0; i < f->line_count && patience == 0; i++) {
        for (uint32_t k = f->lines[i].first; k < f->lines[i].end; k++)
            f->spots[k].blanks = f->spots[k].least;
        measure(f, &f->lines[i]);
    }
}

/* ---- comments behind code ---------------------------------------------------------------- */

/* Is its comment one of those that stand below each other? */
static bool is_aligned(const formatter *f, const line *l)
{
    return l->comment != CSG_EDIT_NONE && l->is_plain && at(f, l->comment)->column < ALIGNED_MOST;
}

static uint32_t gap_of(const formatter *f, const line *l)
{
    const csg_edit_piece *last = at(f, l->end - 1), *comment = at(f, l->comment);
    uint32_t was = csg_column_behind(last->column, f->text + last->offset, last->length);
    return comment->column > was ? comment->column - was : 1;
}

/* The lines up to an empty one: comments that began in one column go behind the longest of their
 * lines, as far as the nearest of them was. */
static size_t measure_paragraph(const formatter *f, size_t first, aligned *columns)
{
    size_t i = first;
    memset(columns, 0, ALIGNED_MOST * sizeof *columns);
    for (; i < f->line_count && (i == first || !f->lines[i].is_blank_before); i++) {
        const line *l = &f->lines[i];
        if (!is_aligned(f, l))
            continue;
        aligned *column = &columns[at(f, l->comment)->column];
        uint32_t gap = gap_of(f, l);
        column->width = l->width > column->width ? l->width : column->width;
        column->gap = !column->gap || gap < column->gap ? gap : column->gap;
    }
    return i;
}

/* A block comment's further lines move as far as its first one has. */
static void put_block_comment(formatter *f, const csg_edit_piece *comment, uint32_t column)
{
    const char *text = f->text + comment->offset, *end = text + comment->length;
    while (text < end) {
        const char *next = memchr(text, '\n', (size_t)(end - text));
        const char *stop = next ? next : end;
        while (next && stop > text && is_blank(stop[-1]))
            stop--;
        put_text(&f->out, text, (size_t)(stop - text));
        if (!next)
            return;
        put_text(&f->out, f->line_end, strlen(f->line_end));
        text = next + 1;
        if (column == comment->column)
            continue;
        uint32_t blanks = 0;
        for (; text < end && (*text == ' ' || *text == '\t'); text++)
            blanks = csg_column_behind(blanks, text, 1);
        int64_t moved = (int64_t)blanks + column - comment->column;
        if (text < end && *text != '\n' && *text != '\r' && moved > 0)
            put_blanks(&f->out, (uint32_t)moved);
    }
}

static void put_piece(formatter *f, uint32_t piece)
{
    const csg_edit_piece *now = at(f, piece);
    put_blanks(&f->out, f->spots[piece].blanks);
    if (now->kind == CSG_EDIT_BLOCK_COMMENT)
        put_block_comment(f, now, f->spots[piece].begin);
    else
        put_text(&f->out, f->text + now->offset, now->length);
}

static void put_line(formatter *f, const line *l, const aligned *columns)
{
    if (l->is_blank_before)
        put_text(&f->out, f->line_end, strlen(f->line_end));
    for (uint32_t i = l->first; i < l->end; i++)
        put_piece(f, i);
    if (l->comment != CSG_EDIT_NONE) {
        const csg_edit_piece *comment = at(f, l->comment);
        const aligned *column = is_aligned(f, l) ? &columns[comment->column] : NULL;
        put_blanks(&f->out, column ? column->width + column->gap - l->width : gap_of(f, l));
        put_text(&f->out, f->text + comment->offset, comment->length);
    }
    put_text(&f->out, f->line_end, strlen(f->line_end));
}

static void put_lines(formatter *f)
{
    aligned columns[ALIGNED_MOST];
    for (size_t i = 0; i < f->line_count;) {
        size_t end = measure_paragraph(f, i, columns);
        for (; i < end; i++)
            put_line(f, &f->lines[i], columns);
    }
}

/* ---- the whole --------------------------------------------------------------------------- */

static bool same_bytes(const char *a, const csg_edit_piece *x, const char *b,
                       const csg_edit_piece *y)
{
    if (x->kind != CSG_EDIT_BLOCK_COMMENT)
        return x->length == y->length && memcmp(a + x->offset, b + y->offset, x->length) == 0;
    const char *p = a + x->offset, *p_end = p + x->length;
    const char *q = b + y->offset, *q_end = q + y->length;
    for (;;) { /* but for blanks, which move */
        while (p < p_end && is_blank(*p))
            p++;
        while (q < q_end && is_blank(*q))
            q++;
        if (p == p_end || q == q_end)
            return p == p_end && q == q_end;
        if (*p++ != *q++)
            return false;
    }
}

static bool same_pieces(const char *a, const csg_edit_pieces *x, const char *b,
                        const csg_edit_pieces *y)
{
    bool same = x->count == y->count;
    for (size_t i = 0; same && i < x->count; i++)
        same = x->items[i].kind == y->items[i].kind && x->items[i].token == y->items[i].token &&
               same_bytes(a, &x->items[i], b, &y->items[i]);
    return same;
}

/* Are the pieces of what was made those of the text? */
static csgm_status compare(const formatter *f, csg_sources *sources, const char *name)
{
    csg_edit_pieces made = {0};
    uint32_t source;
    csg_diag_sink *diags = &sources->context->diags;
    csgm_diag_fn *on_diag = diags->on_diag;
    diags->on_diag = NULL; /* all has been said of the text itself */
    csgm_status status = csg_source_add(sources, name, f->out.text, f->out.length, &source);
    if (status == CSGM_OK && !csg_edit_pieces_read(sources, source, &made))
        status = CSGM_ERR_MEMORY;
    diags->on_diag = on_diag;
    if (status == CSGM_ERR_MEMORY)
        status = csg_context_no_memory(sources->context);
    if (status == CSGM_OK && !same_pieces(f->text, &f->pieces, f->out.text, &made)) {
        csg_diag_plain(diags, CSG_DIAG_UNFORMATTED, name, NULL,
                       "the text is left as it is: laid out, it would be another one");
        status = CSGM_ERR_SYNTAX;
    }
    csg_edit_pieces_release(f->memory, &made);
    return status;
}

static bool lay_out(formatter *f)
{
    size_t bytes = f->pieces.count * sizeof *f->spots;
    f->spots = csg_memory_alloc(f->memory, bytes);
    if (!f->spots)
        return false;
    csg_layout_init(&f->layout, f->memory, f->text, &f->pieces);
    bool ok = true;
    for (uint32_t i = 0; ok && i + 1 < f->pieces.count; i++)
        ok = add_piece(f, i);
    csg_layout_release(&f->layout);
    if (ok) {
        tighten_all(f);
        put_lines(f);
        put_text(&f->out, "", 0);
    }
    csg_memory_release(f->memory, f->spots, bytes);
    return ok && !f->out.no_memory;
}

static const char *line_end_of(const char *text, size_t length)
{
    const char *first = memchr(text, '\n', length);
    return first && first > text && first[-1] == '\r' ? "\r\n" : "\n";
}

static csgm_status format_text(formatter *f, csg_sources *sources, const char *name, size_t length)
{
    uint32_t source;
    bool no_memory = false;
    csgm_status status = csg_source_add(sources, name, f->text, length, &source);
    if (status != CSGM_OK)
        return status;
    if (!csg_edit_pieces_read(sources, source, &f->pieces))
        return csg_context_no_memory(sources->context);
    if (!csg_edit_pieces_match(f->memory, &f->pieces, sources, source, &no_memory))
        return no_memory ? csg_context_no_memory(sources->context) : CSGM_ERR_SYNTAX;
    return lay_out(f) ? compare(f, sources, name) : csg_context_no_memory(sources->context);
}

/* Errors are told, and their notes; warnings are no business of a layout. */
typedef struct errors_only {
    csgm_diag_fn *on_diag;
    void *user;
    bool is_told; /* the last finding */
} errors_only;

static void tell_errors(void *user, const csgm_diag *diag)
{
    errors_only *to = user;
    if (diag->severity != CSGM_NOTE)
        to->is_told = diag->severity == CSGM_ERROR;
    if (to->is_told && to->on_diag)
        to->on_diag(to->user, diag);
}

/* One round: `out` takes the text in its new layout. */
static csgm_status format_once(csgm_context *context, const char *name, const char *text,
                               size_t length, buffer *out)
{
    csg_arena arena;
    csg_sources sources;
    csg_memory *memory = &context->memory;
    formatter f = {.memory = memory, .text = text, .line_end = line_end_of(text, length)};
    f.out.memory = memory;
    csg_arena_init(&arena, memory);
    csg_sources_init(&sources, context, &arena);
    csgm_status status = format_text(&f, &sources, name, length);
    csg_memory_release(memory, f.lines, f.line_capacity * sizeof *f.lines);
    csg_edit_pieces_release(memory, &f.pieces);
    csg_sources_reset(&sources);
    csg_arena_reset(&arena);
    *out = f.out;
    return status;
}

/* A layout depends on the one before, as lines keep their places to each other: it is done when
 * nothing moves any more, which is after one round but for texts that mislead. */
static csgm_status format_until_settled(csgm_context *context, const char *name, const char *text,
                                        size_t length, buffer *out)
{
    enum { ROUNDS = 8 };
    csg_memory *memory = &context->memory;
    csgm_status status = format_once(context, name, text, length, out);
    bool is_settled =
        status != CSGM_OK || (out->length == length && memcmp(out->text, text, length) == 0);
    for (int i = 0; i < ROUNDS && !is_settled; i++) {
        buffer next;
        status = format_once(context, name, out->text, out->length, &next);
        is_settled = status != CSGM_OK ||
                     (next.length == out->length && memcmp(next.text, out->text, out->length) == 0);
        csg_memory_release(memory, out->text, out->capacity);
        *out = next;
    }
    return status;
}

csgm_status csg_edit_format(csgm_context *context, const char *text, size_t length,
                            const char *name, csgm_text_fn *sink, void *user)
{
    buffer out = {.memory = &context->memory};
    errors_only errors = {context->diags.on_diag, context->diags.user, false};
    context->diags.on_diag = tell_errors;
    context->diags.user = &errors;
    csgm_status status = csg_lang_check_syntax(
        context, &(csg_lang_input){.path = name, .text = text, .text_length = length});
    if (status == CSGM_OK)
        status = format_until_settled(context, name, text, length, &out);
    context->diags.on_diag = errors.on_diag;
    context->diags.user = errors.user;
    if (status == CSGM_OK)
        sink(user, out.text, out.length);
    csg_memory_release(&context->memory, out.text, out.capacity);
    return status;
}
