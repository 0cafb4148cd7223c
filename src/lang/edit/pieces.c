/* SPDX-License-Identifier: MIT
 * Tokens and the comments between them; see pieces.h.
 */
#include "lang/edit/pieces.h"

#include <string.h>

#include "base/scene_codes.h"

uint32_t csg_column_behind(uint32_t column, const char *text, size_t length)
{
    enum { TAB = 8 };
    for (size_t i = 0; i < length; i++) {
        if (text[i] == '\n')
            column = 0;
        else if (text[i] == '\t')
            column += TAB - column % TAB;
        else if (((unsigned char)text[i] & 0xC0) != 0x80 && text[i] != '\r')
            column++; /* not inside a character of several bytes */
    }
    return column;
}

bool csg_token_opens(csg_token_kind kind)
{
    return kind == CSG_TOKEN_OPEN_ROUND || kind == CSG_TOKEN_OPEN_SQUARE ||
           kind == CSG_TOKEN_OPEN_CURLY;
}

bool csg_token_closes(csg_token_kind kind)
{
    return kind == CSG_TOKEN_CLOSE_ROUND || kind == CSG_TOKEN_CLOSE_SQUARE ||
           kind == CSG_TOKEN_CLOSE_CURLY;
}

/* ---- reading ----------------------------------------------------------------------------- */

typedef struct reader {
    const char *text;
    csg_memory *memory;
    csg_edit_pieces *out;
    uint32_t at, line, breaks, column;
} reader;

/* Over white space up to `end`. */
static void skip_space(reader *r, uint32_t end)
{
    uint32_t from = r->at, before = r->breaks;
    while (r->at < end && !(r->text[r->at] == '/' && r->at + 1 < end &&
                            (r->text[r->at + 1] == '/' || r->text[r->at + 1] == '*'))) {
        r->breaks += r->text[r->at] == '\n';
        r->at++;
    }
    r->line += r->breaks - before;
    r->column = csg_column_behind(r->column, r->text + from, r->at - from);
}

static bool push_piece(reader *r, csg_edit_piece piece)
{
    csg_edit_pieces *out = r->out;
    if (!csg_memory_reserve(r->memory, (void **)&out->items, &out->capacity, out->count + 1,
                            sizeof *out->items))
        return false;
    piece.line = r->line;
    piece.breaks = r->breaks;
    piece.column = r->column;
    piece.mate = CSG_EDIT_NONE;
    out->items[out->count++] = piece;
    r->breaks = 0;
    for (uint32_t i = 0; i < piece.length; i++) /* strings may have some, and block comments */
        r->line += r->text[piece.offset + i] == '\n';
    r->column = csg_column_behind(r->column, r->text + piece.offset, piece.length);
    return true;
}

static bool is_blank(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

static bool push_comment(reader *r, uint32_t end)
{
    uint32_t from = r->at;
    if (r->text[from + 1] == '*') {
        for (r->at += 2; r->at < end; r->at++)
            if (r->text[r->at - 1] == '*' && r->text[r->at] == '/' && r->at > from + 2) {
                r->at++;
                break;
            }
        return push_piece(r, (csg_edit_piece){.kind = CSG_EDIT_BLOCK_COMMENT,
                                              .offset = from,
                                              .length = r->at - from});
    }
    while (r->at < end && r->text[r->at] != '\n')
        r->at++;
    uint32_t last = r->at;
    while (last > from + 2 && is_blank(r->text[last - 1]))
        last--;
    return push_piece(
        r, (csg_edit_piece){.kind = CSG_EDIT_LINE_COMMENT, .offset = from, .length = last - from});
}

/* The comments before a token. */
static bool push_trivia(reader *r, uint32_t end)
{
    for (skip_space(r, end); r->at < end; skip_space(r, end))
        if (!push_comment(r, end))
            return false;
    return true;
}

bool csg_edit_pieces_read(const csg_sources *sources, uint32_t source, csg_edit_pieces *out)
{
    csg_memory *memory = &sources->context->memory;
    csg_token_array tokens = {0};
    reader r = {.text = sources->items[source].text, .memory = memory, .out = out};
    bool ok = csg_lex(sources, source, &tokens);
    for (size_t i = 0; ok && i < tokens.count; i++) {
        const csg_token *token = &tokens.items[i];
        ok = push_trivia(&r, token->offset) &&
             push_piece(&r, (csg_edit_piece){.token = token->kind,
                                             .offset = token->offset,
                                             .length = token->length});
        r.at = token->offset + token->length;
    }
    csg_tokens_release(memory, &tokens);
    return ok;
}

void csg_edit_pieces_release(csg_memory *memory, csg_edit_pieces *pieces)
{
    csg_memory_release(memory, pieces->items, pieces->capacity * sizeof *pieces->items);
    *pieces = (csg_edit_pieces){0};
}

/* ---- brackets ----------------------------------------------------------------------------- */

static csg_token_kind closing_of(csg_token_kind kind)
{
    return kind == CSG_TOKEN_OPEN_ROUND    ? CSG_TOKEN_CLOSE_ROUND
           : kind == CSG_TOKEN_OPEN_SQUARE ? CSG_TOKEN_CLOSE_SQUARE
                                           : CSG_TOKEN_CLOSE_CURLY;
}

static csg_span span_of(uint32_t source, const csg_edit_piece *piece)
{
    return (csg_span){source, piece->offset, piece->length};
}

static void report_unclosed(const csg_sources *sources, uint32_t source, const csg_edit_piece *open)
{
    csg_source_report(sources, CSG_DIAG_UNCLOSED, span_of(source, open), NULL,
                      "this '%c' is never closed", sources->items[source].text[open->offset]);
}

/* `closing` fits nothing: what of the brackets that are open could it have closed? */
static size_t open_before(const csg_edit_pieces *pieces, const uint32_t *open, size_t depth,
                          csg_token_kind closing)
{
    while (depth > 0 && closing_of(pieces->items[open[depth - 1]].token) != closing)
        depth--;
    return depth;
}

/* One closing bracket; false: it has no mate of its kind on top. */
static bool close_one(csg_edit_pieces *pieces, const uint32_t *open, size_t *depth, uint32_t at)
{
    size_t fits = open_before(pieces, open, *depth, pieces->items[at].token);
    bool is_top = fits == *depth && fits > 0;
    if (fits > 0) {
        pieces->items[at].mate = open[fits - 1];
        pieces->items[open[fits - 1]].mate = at;
        *depth = fits - 1;
    }
    return is_top;
}

static void report_stray(const csg_sources *sources, uint32_t source, const csg_edit_piece *closing,
                         const csg_edit_piece *open)
{
    char sign = sources->items[source].text[closing->offset];
    csg_source_report(sources, CSG_DIAG_STRAY_CLOSE, span_of(source, closing), NULL,
                      open ? "this '%c' closes another kind of bracket"
                           : "nothing is open that this '%c' closes",
                      sign);
    if (open)
        csg_source_note(sources, span_of(source, open), "the bracket that is open there");
}

bool csg_edit_pieces_match(csg_memory *memory, csg_edit_pieces *pieces, const csg_sources *sources,
                           uint32_t source, bool *no_memory)
{
    size_t room = pieces->count * sizeof(uint32_t), depth = 0;
    uint32_t *open = csg_memory_alloc(memory, room ? room : 1);
    bool ok = open != NULL;
    *no_memory = !open;
    for (uint32_t i = 0; open && i < pieces->count && (ok || !sources); i++) {
        csg_token_kind kind = pieces->items[i].token;
        if (csg_token_opens(kind))
            open[depth++] = i;
        if (!csg_token_closes(kind))
            continue;
        const csg_edit_piece *top = depth ? &pieces->items[open[depth - 1]] : NULL;
        if (!close_one(pieces, open, &depth, i)) {
            if (sources)
                report_stray(sources, source, &pieces->items[i], top);
            ok = false;
        }
    }
    if (ok && depth > 0 && sources)
        report_unclosed(sources, source, &pieces->items[open[depth - 1]]);
    ok = ok && depth == 0;
    csg_memory_release(memory, open, room ? room : 1);
    return ok;
}
