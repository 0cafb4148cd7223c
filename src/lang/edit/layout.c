/* SPDX-License-Identifier: MIT
 * Statements and brackets while a text is laid out; see layout.h.
 */
#include "lang/edit/layout.h"

void csg_layout_init(csg_layout *layout, csg_memory *memory, const char *text,
                     const csg_edit_pieces *pieces)
{
    *layout = (csg_layout){.memory = memory, .text = text, .pieces = pieces};
}

void csg_layout_release(csg_layout *layout)
{
    csg_memory_release(layout->memory, layout->frames,
                       layout->frame_capacity * sizeof *layout->frames);
    csg_memory_release(layout->memory, layout->ifs, layout->if_capacity * sizeof *layout->ifs);
}

/* ---- looking ------------------------------------------------------------------------------ */

static const csg_layout_frame *top(const csg_layout *l)
{
    return l->frame_count ? &l->frames[l->frame_count - 1] : NULL;
}

/* Are we in round or square brackets? There are no statements then. */
static bool in_brackets(const csg_layout *l)
{
    const csg_layout_frame *frame = top(l);
    return frame && frame->token != CSG_TOKEN_OPEN_CURLY;
}

bool csg_layout_in_multi(const csg_layout *layout)
{
    const csg_layout_frame *frame = top(layout);
    return frame && frame->token == CSG_TOKEN_OPEN_CURLY && frame->is_multi;
}

/* The first token behind a piece. */
static csg_token_kind token_behind(const csg_layout *l, uint32_t piece)
{
    while (++piece < l->pieces->count)
        if (l->pieces->items[piece].kind == CSG_EDIT_TOKEN)
            return l->pieces->items[piece].token;
    return CSG_TOKEN_END;
}

static bool is_modifier(const csg_layout *l, csg_token_kind kind)
{
    bool before_call =
        l->statement.state == CSG_LAYOUT_START || l->statement.state == CSG_LAYOUT_CHILD;
    return kind == CSG_TOKEN_HASH ||
           (!in_brackets(l) && before_call &&
            (kind == CSG_TOKEN_NOT || kind == CSG_TOKEN_PERCENT || kind == CSG_TOKEN_STAR));
}

static bool is_sign(const csg_layout *l, csg_token_kind kind)
{
    bool may_be = kind == CSG_TOKEN_MINUS || kind == CSG_TOKEN_PLUS || kind == CSG_TOKEN_NOT ||
                  kind == CSG_TOKEN_BIT_NOT;
    return is_modifier(l, kind) || (may_be && !l->last_is_operand);
}

/* Does an expression or a child follow its parentheses? */
static bool is_prefix_word(csg_token_kind kind)
{
    return kind == CSG_TOKEN_FOR || kind == CSG_TOKEN_IF || kind == CSG_TOKEN_LET ||
           kind == CSG_TOKEN_ASSERT || kind == CSG_TOKEN_ECHO || kind == CSG_TOKEN_FUNCTION ||
           kind == CSG_TOKEN_EACH || kind == CSG_TOKEN_ELSE;
}

/* ---- blanks ------------------------------------------------------------------------------- */

static uint32_t gap_before_bracket(const csg_layout *l, csg_token_kind kind)
{
    if (l->last_ends_prefix)
        return 1;
    bool joins = l->last == CSG_TOKEN_NAME || l->last == CSG_TOKEN_CLOSE_SQUARE ||
                 l->last == CSG_TOKEN_CLOSE_ROUND;
    if (kind == CSG_TOKEN_OPEN_SQUARE)
        return joins || l->last == CSG_TOKEN_STRING ? 0 : 1;
    return joins || l->last == CSG_TOKEN_ASSERT || l->last == CSG_TOKEN_ECHO ? 0 : 1;
}

uint32_t csg_layout_gap(const csg_layout *layout, uint32_t piece)
{
    const csg_edit_piece *now = &layout->pieces->items[piece];
    bool after_comment = piece > 0 && layout->pieces->items[piece - 1].kind != CSG_EDIT_TOKEN;
    csg_token_kind last = layout->last;
    if (now->kind == CSG_EDIT_LINE_COMMENT)
        return 1;
    if (!after_comment) {
        if (layout->last_is_sign || last == CSG_TOKEN_OPEN_ROUND || last == CSG_TOKEN_OPEN_SQUARE)
            return 0;
        if (last == CSG_TOKEN_DOT)
            return 0;
    }
    if (now->kind != CSG_EDIT_TOKEN)
        return 1;
    switch (now->token) {
    case CSG_TOKEN_COMMA:
    case CSG_TOKEN_SEMICOLON:
    case CSG_TOKEN_CLOSE_ROUND:
    case CSG_TOKEN_CLOSE_SQUARE:
        return 0;
    case CSG_TOKEN_DOT:
        return last == CSG_TOKEN_NUMBER; /* 2.x is no member of 2 */
    case CSG_TOKEN_CLOSE_CURLY:
        return after_comment || last != CSG_TOKEN_OPEN_CURLY;
    case CSG_TOKEN_OPEN_ROUND:
    case CSG_TOKEN_OPEN_SQUARE:
        return after_comment ? 1 : gap_before_bracket(layout, now->token);
    default:
        return 1;
    }
}

/* ---- indentation -------------------------------------------------------------------------- */

static uint32_t in_statement(const csg_layout_statement *s)
{
    return s->base + CSG_LAYOUT_STEP * s->level;
}

/* Is the line of this piece indented by tabs? */
static bool has_tabs(const csg_layout *l, const csg_edit_piece *piece)
{
    uint32_t i = piece->offset;
    while (i > 0 && (l->text[i - 1] == ' ' || l->text[i - 1] == '\t'))
        if (l->text[--i] == '\t')
            return true;
    return false;
}

/* A line that goes on with what began in a line at `column` that is at `indent` now: as far to the
 * right of it as it was, or one step. */
static uint32_t continued(const csg_layout *l, const csg_edit_piece *piece, uint32_t column,
                          uint32_t indent)
{
    bool keeps = piece->column > column && piece->breaks > 0 && !has_tabs(l, piece);
    return indent + (keeps ? piece->column - column : CSG_LAYOUT_STEP);
}

/* A child on a line of its own stands one step farther right than its parent, or right below it
 * where it did: color(...) difference() { ... } in two lines. */
static uint32_t indent_of_child(csg_layout *l, const csg_edit_piece *piece)
{
    csg_layout_statement *s = &l->statement;
    s->level += s->column == CSG_EDIT_NONE || piece->column > s->column || piece->breaks == 0;
    s->column = piece->column;
    return in_statement(s);
}

static uint32_t indent_of_statement(csg_layout *l, const csg_edit_piece *piece)
{
    csg_layout_statement *s = &l->statement;
    bool is_token = piece->kind == CSG_EDIT_TOKEN;
    switch ((csg_layout_state)s->state) {
    case CSG_LAYOUT_START:
        return s->base;
    case CSG_LAYOUT_ELSE:
        return s->base + CSG_LAYOUT_STEP * (l->if_count > s->ifs ? l->ifs[l->if_count - 1] : 0);
    case CSG_LAYOUT_CHILD:
        if (is_token && (piece->token == CSG_TOKEN_OPEN_CURLY || l->last_is_sign))
            return in_statement(s);
        if (is_token && piece->token != CSG_TOKEN_SEMICOLON && piece->token != CSG_TOKEN_ASSIGN)
            return indent_of_child(l, piece);
        if (!is_token && s->column != CSG_EDIT_NONE && piece->column <= s->column)
            return in_statement(s);
        return in_statement(s) + CSG_LAYOUT_STEP;
    default:
        return continued(l, piece, s->column, in_statement(s));
    }
}

static uint32_t indent_in_brackets(const csg_layout *l, const csg_edit_piece *piece)
{
    const csg_layout_frame *frame = top(l);
    if (piece->column == frame->was && !has_tabs(l, piece))
        return frame->now;
    return continued(l, piece, frame->column, frame->indent);
}

uint32_t csg_layout_begin_line(csg_layout *layout, uint32_t piece)
{
    const csg_edit_piece *now = &layout->pieces->items[piece];
    const csg_layout_frame *frame = top(layout);
    bool closes = now->kind == CSG_EDIT_TOKEN && csg_token_closes(now->token) && frame;
    uint32_t indent;
    if (closes && now->token == CSG_TOKEN_CLOSE_CURLY)
        indent = in_statement(&frame->around);
    else if (closes)
        indent = frame->indent;
    else if (in_brackets(layout))
        indent = indent_in_brackets(layout, now);
    else
        indent = indent_of_statement(layout, now);
    layout->line_indent = indent < CSG_LAYOUT_INDENT_MOST ? indent : CSG_LAYOUT_INDENT_MOST;
    return layout->line_indent;
}

/* ---- going on ----------------------------------------------------------------------------- */

static void end_statement(csg_layout *l)
{
    l->if_count = l->statement.ifs;
    l->statement.state = CSG_LAYOUT_START;
    l->statement.level = 0;
}

/* Behind a child: the statement is at its end, unless an else goes on with it. */
static void end_child(csg_layout *l, uint32_t piece)
{
    if (l->if_count > l->statement.ifs && token_behind(l, piece) == CSG_TOKEN_ELSE)
        l->statement.state = CSG_LAYOUT_ELSE;
    else
        end_statement(l);
}

static bool open_if(csg_layout *l)
{
    if (!csg_memory_reserve(l->memory, (void **)&l->ifs, &l->if_capacity, l->if_count + 1,
                            sizeof *l->ifs))
        return false;
    l->ifs[l->if_count++] = l->statement.level;
    return true;
}

static bool open_frame(csg_layout *l, uint32_t piece)
{
    const csg_edit_piece *now = &l->pieces->items[piece];
    if (!csg_memory_reserve(l->memory, (void **)&l->frames, &l->frame_capacity, l->frame_count + 1,
                            sizeof *l->frames))
        return false;
    csg_layout_frame frame = {.token = now->token,
                              .indent = l->line_indent,
                              .column = l->line_column,
                              .piece = piece,
                              .was = UINT32_MAX,
                              .is_prefix = is_prefix_word(l->last),
                              .around = l->statement};
    if (now->token == CSG_TOKEN_OPEN_CURLY) {
        frame.is_multi = now->mate != CSG_EDIT_NONE && l->pieces->items[now->mate].line > now->line;
        l->statement = (csg_layout_statement){.base = in_statement(&l->statement) + CSG_LAYOUT_STEP,
                                              .ifs = (uint32_t)l->if_count};
    }
    l->frames[l->frame_count++] = frame;
    return true;
}

static void close_frame(csg_layout *l, uint32_t piece)
{
    csg_token_kind kind = l->pieces->items[piece].token;
    if (l->frame_count == 0)
        return;
    csg_layout_frame frame = l->frames[--l->frame_count];
    l->last_ends_prefix = kind == CSG_TOKEN_CLOSE_ROUND && frame.is_prefix;
    if (kind == CSG_TOKEN_CLOSE_CURLY) {
        l->if_count = l->statement.ifs;
        l->statement = frame.around;
        end_child(l, piece);
    } else if (!in_brackets(l) && kind == CSG_TOKEN_CLOSE_ROUND &&
               l->statement.state == CSG_LAYOUT_HEAD) {
        l->statement.state = CSG_LAYOUT_CHILD;
    }
}

/* A token between brackets of blocks that is no bracket itself. */
static bool pass_in_statement(csg_layout *l, uint32_t piece, csg_token_kind kind)
{
    csg_layout_statement *s = &l->statement;
    bool begins = piece == 0 || l->pieces->items[piece].breaks > 0;
    if (kind == CSG_TOKEN_SEMICOLON) {
        end_child(l, piece);
        return true;
    }
    switch ((csg_layout_state)s->state) {
    case CSG_LAYOUT_ELSE:
        if (kind == CSG_TOKEN_ELSE && l->if_count > s->ifs)
            s->level = l->ifs[--l->if_count];
        if (begins || s->column != CSG_EDIT_NONE)
            s->column = l->line_column;
        s->state = CSG_LAYOUT_CHILD;
        return true;
    case CSG_LAYOUT_PATH:
        if (token_behind(l, piece) != CSG_TOKEN_SEMICOLON)
            end_statement(l);
        return true;
    case CSG_LAYOUT_START:
    case CSG_LAYOUT_CHILD:
        if (is_modifier(l, kind))
            return true;
        if (s->state == CSG_LAYOUT_START)
            s->column = begins ? l->line_column : CSG_EDIT_NONE;
        s->state = kind == CSG_TOKEN_ASSIGN                             ? CSG_LAYOUT_VALUE
                   : kind == CSG_TOKEN_INCLUDE || kind == CSG_TOKEN_USE ? CSG_LAYOUT_PATH
                                                                        : CSG_LAYOUT_HEAD;
        return kind == CSG_TOKEN_IF ? open_if(l) : true;
    case CSG_LAYOUT_HEAD:
        if (kind == CSG_TOKEN_ASSIGN)
            s->state = CSG_LAYOUT_VALUE;
        return true;
    case CSG_LAYOUT_VALUE:
        return true;
    }
    return true;
}

bool csg_layout_else_joins(const csg_layout *layout)
{
    const csg_layout_statement *s = &layout->statement;
    return s->state == CSG_LAYOUT_ELSE && layout->if_count > s->ifs &&
           layout->ifs[layout->if_count - 1] == s->level;
}

static bool is_operand(const csg_layout *l, csg_token_kind kind)
{
    return kind == CSG_TOKEN_NAME || kind == CSG_TOKEN_NUMBER || kind == CSG_TOKEN_STRING ||
           kind == CSG_TOKEN_TRUE || kind == CSG_TOKEN_FALSE || kind == CSG_TOKEN_UNDEF ||
           kind == CSG_TOKEN_CLOSE_SQUARE ||
           (kind == CSG_TOKEN_CLOSE_ROUND && !l->last_ends_prefix);
}

bool csg_layout_pass(csg_layout *layout, uint32_t piece, uint32_t column)
{
    const csg_edit_piece *now = &layout->pieces->items[piece];
    if (now->breaks > 0 || piece == 0)
        layout->line_column = now->column;
    if (layout->frame_count && piece == layout->frames[layout->frame_count - 1].piece + 1 &&
        now->breaks == 0 && column != CSG_EDIT_NONE) {
        layout->frames[layout->frame_count - 1].was = now->column;
        layout->frames[layout->frame_count - 1].now = column;
    }
    if (now->kind != CSG_EDIT_TOKEN)
        return true;
    csg_token_kind kind = now->token;
    bool ok = true, sign = is_sign(layout, kind);
    layout->last_ends_prefix = false;
    if (csg_token_opens(kind))
        ok = open_frame(layout, piece);
    else if (csg_token_closes(kind))
        close_frame(layout, piece);
    else if (!in_brackets(layout))
        ok = pass_in_statement(layout, piece, kind);
    layout->last_is_sign = sign;
    layout->last_is_operand = is_operand(layout, kind);
    layout->last = kind;
    return ok;
}
