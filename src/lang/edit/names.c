/* SPDX-License-Identifier: MIT
 * One walk over the tokens with a stack of brackets and one of scopes; see names.h. A bracket that
 * is never closed ends where a statement must have ended.
 */
#include "lang/edit/names.h"

#include <string.h>

#include "lang/parse/ast.h"

#define NONE CSG_EDIT_NONE

typedef enum frame_role { BLOCK, GROUP, ARGUMENTS, PARAMETERS, BINDINGS } frame_role;
typedef enum statement_state { START, HEAD, CHILD, VALUE } statement_state;

typedef struct frame {
    uint8_t role;    /* frame_role */
    uint8_t state;   /* statement_state, of a BLOCK */
    uint32_t call;   /* ARGUMENTS: its row */
    uint32_t owner;  /* PARAMETERS: whose; NONE: a function without a name */
    uint32_t scopes; /* how many are open inside it, at least */
    uint32_t name;   /* BLOCK: what the statement defines; PARAMETERS: the one being read */
} frame;

typedef struct walker {
    csg_arena *arena;
    const char *text;
    const csg_edit_pieces *pieces;
    csg_edit_names *out;
    frame *frames;
    uint32_t frame_count, frame_room;
    uint32_t *open; /* scopes, the innermost last */
    uint32_t open_count, open_room;
    uint32_t last;       /* the token before, or NONE */
    uint32_t first;      /* of the statement */
    uint32_t definition; /* the name that was just defined: parameters follow */
    bool ok;
} walker;

/* ---- arrays -------------------------------------------------------------------------------- */

static void *push_row(walker *w, void *items, uint32_t *count, size_t bytes)
{
    void *place = csg_arena_push(w->arena, items, count, bytes);
    if (!place)
        w->ok = false;
    return place;
}

/* An array that shrinks too: *room is what it holds at most. */
static bool make_room(walker *w, void **items, uint32_t count, uint32_t *room, size_t bytes)
{
    if (count < *room)
        return true;
    uint32_t more = *room ? *room * 2 : 32;
    void *fresh = csg_arena_alloc(w->arena, more * bytes);
    if (!fresh) {
        w->ok = false;
        return false;
    }
    if (count)
        memcpy(fresh, *items, count * bytes);
    *items = fresh;
    *room = more;
    return true;
}

static const csg_edit_piece *at(const walker *w, uint32_t piece)
{
    return &w->pieces->items[piece];
}

static uint32_t end_of(const walker *w, uint32_t piece)
{
    return at(w, piece)->offset + at(w, piece)->length;
}

static frame *top(walker *w)
{
    return &w->frames[w->frame_count - 1];
}

static csg_token_kind kind_of_last(const walker *w)
{
    return w->last == NONE ? CSG_TOKEN_SEMICOLON : at(w, w->last)->token;
}

static csg_token_kind kind_of_next(const walker *w, uint32_t piece)
{
    while (++piece < w->pieces->count)
        if (at(w, piece)->kind == CSG_EDIT_TOKEN)
            return at(w, piece)->token;
    return CSG_TOKEN_END;
}

/* ---- scopes and brackets -------------------------------------------------------------------- */

static void open_scope(walker *w, uint32_t begin)
{
    uint32_t parent = w->open_count ? w->open[w->open_count - 1] : NONE;
    csg_edit_scope *scope = push_row(w, &w->out->scopes, &w->out->scope_count, sizeof *scope);
    if (!scope || !make_room(w, (void **)&w->open, w->open_count, &w->open_room, sizeof *w->open))
        return;
    *scope = (csg_edit_scope){parent, begin, UINT32_MAX};
    w->open[w->open_count++] = w->out->scope_count - 1;
}

static void close_scopes(walker *w, uint32_t down_to, uint32_t end)
{
    while (w->open_count > down_to && w->open_count > 1)
        w->out->scopes[w->open[--w->open_count]].end = end;
}

static void open_frame(walker *w, frame f)
{
    if (!make_room(w, (void **)&w->frames, w->frame_count, &w->frame_room, sizeof *w->frames))
        return;
    f.scopes = w->open_count;
    w->frames[w->frame_count++] = f;
}

/* The parameter or argument that ends here. */
static void end_argument(walker *w, uint32_t end)
{
    frame *f = top(w);
    if (f->role == PARAMETERS && f->name != NONE) {
        w->out->names[f->name].end = end;
        f->name = NONE;
    }
    close_scopes(w, f->scopes, end);
}

static void close_frame(walker *w, uint32_t end)
{
    end_argument(w, end);
    const frame *f = top(w);
    if (f->role == ARGUMENTS && f->call != NONE)
        w->out->calls[f->call].end = end;
    w->frame_count--;
}

/* Round and square brackets that were forgotten. */
static void close_brackets(walker *w, uint32_t end)
{
    while (top(w)->role != BLOCK)
        close_frame(w, end);
}

/* ---- statements ----------------------------------------------------------------------------- */

static bool is_line_comment_behind(const walker *w, uint32_t piece)
{
    return piece + 1 < w->pieces->count && at(w, piece + 1)->kind == CSG_EDIT_LINE_COMMENT &&
           at(w, piece + 1)->breaks == 0;
}

static void end_statement(walker *w, uint32_t piece)
{
    frame *f = top(w);
    close_scopes(w, f->scopes, end_of(w, piece));
    if (f->name != NONE) {
        csg_edit_name *name = &w->out->names[f->name];
        name->end = end_of(w, piece);
        if (!name->doc_end && name->kind == CSGM_NAME_VARIABLE &&
            is_line_comment_behind(w, piece)) {
            name->doc = at(w, piece + 1)->offset;
            name->doc_end = end_of(w, piece + 1);
        }
    }
    f->name = NONE;
    f->state = START;
    w->first = NONE;
}

/* Behind a ';' or '}': an else may go on with the statement. */
static void end_child(walker *w, uint32_t piece)
{
    if (kind_of_next(w, piece) == CSG_TOKEN_ELSE)
        top(w)->state = CHILD;
    else
        end_statement(w, piece);
}

/* The comments right above a statement, without an empty line between. */
static void find_doc(const walker *w, uint32_t first, csg_edit_name *name)
{
    uint32_t i = first;
    while (i > 0 && at(w, i - 1)->kind != CSG_EDIT_TOKEN && at(w, i)->breaks == 1 &&
           (i == 1 || at(w, i - 1)->breaks > 0))
        i--;
    if (i == first)
        return;
    name->doc = at(w, i)->offset;
    name->doc_end = end_of(w, first - 1);
}

static uint32_t add_name(walker *w, uint32_t piece, csgm_name_kind kind, uint32_t first)
{
    csg_edit_name *name = push_row(w, &w->out->names, &w->out->name_count, sizeof *name);
    if (!name)
        return NONE;
    *name = (csg_edit_name){.kind = (uint8_t)kind,
                            .offset = at(w, piece)->offset,
                            .length = at(w, piece)->length,
                            .begin = at(w, first)->offset,
                            .end = end_of(w, piece),
                            .scope = w->open[w->open_count - 1],
                            .owner = NONE};
    if (kind_of_next(w, piece) == CSG_TOKEN_ASSIGN) {
        uint32_t i = piece + 1;
        while (at(w, i)->token != CSG_TOKEN_ASSIGN)
            i++;
        name->value = at(w, i + 1)->offset;
    }
    if (first != piece || kind == CSGM_NAME_VARIABLE)
        find_doc(w, first, name);
    return w->out->name_count - 1;
}

static void add_use(walker *w, uint32_t piece, csg_edit_use_kind kind, uint32_t callee)
{
    csg_edit_use *use = push_row(w, &w->out->uses, &w->out->use_count, sizeof *use);
    if (use)
        *use = (csg_edit_use){(uint8_t)kind, at(w, piece)->offset, at(w, piece)->length,
                              w->open[w->open_count - 1], callee};
}

/* ---- tokens ---------------------------------------------------------------------------------- */

static bool begins_argument(const walker *w)
{
    csg_token_kind last = kind_of_last(w);
    return last == CSG_TOKEN_OPEN_ROUND || last == CSG_TOKEN_COMMA || last == CSG_TOKEN_SEMICOLON;
}

/* A name in a call, in parameters or in a let. False: it is none of these. */
static bool take_argument(walker *w, uint32_t piece, bool assigned)
{
    frame *f = top(w);
    if (!begins_argument(w))
        return false;
    if (f->role == PARAMETERS) {
        uint32_t owner = f->owner, name = add_name(w, piece, CSGM_NAME_PARAMETER, piece);
        if (name != NONE)
            w->out->names[name].owner = owner;
        top(w)->name = name;
        return true;
    }
    if (f->role == BINDINGS && assigned) {
        add_name(w, piece, CSGM_NAME_VARIABLE, piece);
        return true;
    }
    if (f->role == ARGUMENTS && assigned) {
        add_use(w, piece, CSG_EDIT_USE_ARGUMENT, w->out->calls[f->call].use);
        return true;
    }
    return false;
}

static void take_name(walker *w, uint32_t piece)
{
    frame *f = top(w);
    csg_token_kind last = kind_of_last(w), next = kind_of_next(w, piece);
    bool in_block = f->role == BLOCK, begins = in_block && (f->state == START || f->state == CHILD);
    bool is_named = last == CSG_TOKEN_MODULE || (last == CSG_TOKEN_FUNCTION && in_block &&
                                                 f->state == HEAD && w->first == w->last);
    if (last == CSG_TOKEN_DOT)
        return;
    if (is_named) {
        w->definition = add_name(
            w, piece, last == CSG_TOKEN_MODULE ? CSGM_NAME_MODULE : CSGM_NAME_FUNCTION, w->last);
        top(w)->name = w->definition;
        return;
    }
    if (take_argument(w, piece, next == CSG_TOKEN_ASSIGN))
        return;
    if (begins && next == CSG_TOKEN_ASSIGN) {
        uint32_t name = add_name(w, piece, CSGM_NAME_VARIABLE, piece);
        top(w)->name = name;
        top(w)->state = VALUE;
    } else if (begins) {
        add_use(w, piece, CSG_EDIT_USE_MODULE, NONE);
        top(w)->state = HEAD;
    } else {
        add_use(w, piece,
                next == CSG_TOKEN_OPEN_ROUND ? CSG_EDIT_USE_FUNCTION : CSG_EDIT_USE_VARIABLE, NONE);
    }
}

static void take_round(walker *w, uint32_t piece)
{
    csg_token_kind last = kind_of_last(w);
    frame f = {.role = GROUP, .call = NONE, .owner = NONE, .name = NONE};
    if (last == CSG_TOKEN_FOR || last == CSG_TOKEN_LET) {
        f.role = BINDINGS;
        open_scope(w, at(w, piece)->offset);
    } else if (last == CSG_TOKEN_FUNCTION || w->definition != NONE) {
        f.role = PARAMETERS;
        f.owner = w->definition;
        open_scope(w, at(w, piece)->offset);
    } else if (last == CSG_TOKEN_NAME || last == CSG_TOKEN_ECHO || last == CSG_TOKEN_ASSERT ||
               last == CSG_TOKEN_CLOSE_ROUND || last == CSG_TOKEN_CLOSE_SQUARE) {
        csg_edit_call *call = push_row(w, &w->out->calls, &w->out->call_count, sizeof *call);
        bool is_named = last == CSG_TOKEN_NAME && w->out->use_count > 0 &&
                        w->out->uses[w->out->use_count - 1].offset == at(w, w->last)->offset;
        if (!call)
            return;
        *call =
            (csg_edit_call){is_named ? w->out->use_count - 1 : NONE, end_of(w, piece), UINT32_MAX};
        f.role = ARGUMENTS;
        f.call = w->out->call_count - 1;
    }
    w->definition = NONE;
    open_frame(w, f);
}

static void take_close(walker *w, uint32_t piece, csg_token_kind kind)
{
    if (top(w)->role == BLOCK)
        return;
    close_frame(w, at(w, piece)->offset);
    if (top(w)->role == BLOCK && top(w)->state == HEAD && kind == CSG_TOKEN_CLOSE_ROUND)
        top(w)->state = CHILD;
}

static void take_curly(walker *w, uint32_t piece, csg_token_kind kind)
{
    if (kind == CSG_TOKEN_OPEN_CURLY) {
        bool is_bare = top(w)->state == START; /* no scope of its own */
        uint32_t outer = w->open_count;
        if (!is_bare)
            open_scope(w, at(w, piece)->offset);
        open_frame(
            w, (frame){.role = BLOCK, .state = START, .call = NONE, .owner = NONE, .name = NONE});
        if (w->ok && w->frame_count > 1)
            w->frames[w->frame_count - 2].call =
                outer; /* unused by blocks: where to fall back to */
        w->first = NONE;
        return;
    }
    if (w->frame_count <= 1)
        return;
    close_scopes(w, top(w)->scopes, end_of(w, piece));
    w->frame_count--;
    close_scopes(w, top(w)->call, end_of(w, piece));
    end_child(w, piece);
}

/* Does it stand in no brackets? Then those that are open were forgotten. */
static bool must_be_statement(csg_token_kind kind, frame_role role)
{
    return kind == CSG_TOKEN_OPEN_CURLY || kind == CSG_TOKEN_CLOSE_CURLY ||
           kind == CSG_TOKEN_MODULE || kind == CSG_TOKEN_INCLUDE || kind == CSG_TOKEN_USE ||
           (kind == CSG_TOKEN_SEMICOLON && role != BINDINGS);
}

/* Tokens that are neither names nor brackets, between statements' brackets. */
static void take_word(walker *w, uint32_t piece, csg_token_kind kind)
{
    frame *f = top(w);
    bool begins = f->state == START || f->state == CHILD;
    bool is_modifier = kind == CSG_TOKEN_NOT || kind == CSG_TOKEN_HASH ||
                       kind == CSG_TOKEN_PERCENT || kind == CSG_TOKEN_STAR;
    if (kind == CSG_TOKEN_SEMICOLON)
        end_child(w, piece);
    else if (kind == CSG_TOKEN_INCLUDE || kind == CSG_TOKEN_USE || kind == CSG_TOKEN_PATH)
        f->state = START;
    else if (kind == CSG_TOKEN_ELSE)
        f->state = CHILD;
    else if (kind == CSG_TOKEN_ASSIGN)
        f->state = VALUE;
    else if (begins && !is_modifier)
        f->state = HEAD;
}

static void take_link(walker *w, uint32_t piece)
{
    csg_edit_link *link = push_row(w, &w->out->links, &w->out->link_count, sizeof *link);
    if (link)
        *link = (csg_edit_link){at(w, piece)->offset + 1, at(w, piece)->length - 2,
                                kind_of_last(w) == CSG_TOKEN_USE};
    w->first = NONE;
}

static void take_token(walker *w, uint32_t piece)
{
    csg_token_kind kind = at(w, piece)->token;
    if (top(w)->role != BLOCK && must_be_statement(kind, top(w)->role))
        close_brackets(w, at(w, piece)->offset);
    if (top(w)->role == BLOCK && top(w)->state == START && w->first == NONE)
        w->first = piece;
    if (kind == CSG_TOKEN_NAME)
        take_name(w, piece);
    else if (kind == CSG_TOKEN_OPEN_ROUND)
        take_round(w, piece);
    else if (kind == CSG_TOKEN_OPEN_SQUARE)
        open_frame(w, (frame){.role = GROUP, .call = NONE, .owner = NONE, .name = NONE});
    else if (kind == CSG_TOKEN_CLOSE_ROUND || kind == CSG_TOKEN_CLOSE_SQUARE)
        take_close(w, piece, kind);
    else if (kind == CSG_TOKEN_OPEN_CURLY || kind == CSG_TOKEN_CLOSE_CURLY)
        take_curly(w, piece, kind);
    else if (top(w)->role == BLOCK)
        take_word(w, piece, kind);
    else if (kind == CSG_TOKEN_COMMA)
        end_argument(w, at(w, piece)->offset);
    if (kind == CSG_TOKEN_PATH && at(w, piece)->length > 2)
        take_link(w, piece);
    if (kind != CSG_TOKEN_NAME)
        w->definition = NONE;
    w->last = piece;
}

bool csg_edit_names_find(csg_arena *arena, const char *text, const csg_edit_pieces *pieces,
                         csg_edit_names *out)
{
    walker w = {.arena = arena,
                .text = text,
                .pieces = pieces,
                .out = out,
                .last = NONE,
                .first = NONE,
                .definition = NONE,
                .ok = true};
    *out = (csg_edit_names){0};
    open_scope(&w, 0);
    if (w.ok)
        open_frame(
            &w, (frame){.role = BLOCK, .state = START, .call = NONE, .owner = NONE, .name = NONE});
    for (uint32_t i = 0; w.ok && i + 1 < pieces->count; i++)
        if (pieces->items[i].kind == CSG_EDIT_TOKEN)
            take_token(&w, i);
    return w.ok;
}

uint32_t csg_edit_scope_at(const csg_edit_names *names, uint32_t offset)
{
    uint32_t found = 0;
    for (uint32_t i = 1; i < names->scope_count; i++) /* inner ones come later */
        if (names->scopes[i].begin < offset && offset <= names->scopes[i].end)
            found = i;
    return found;
}
