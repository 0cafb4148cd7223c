/* SPDX-License-Identifier: MIT
 * What editors ask of a workspace; see csgmesh/editing.h.
 */
#include <string.h>
#include <strings.h>

#include "lang/edit/resolve.h"
#include "lang/modules/modules.h"

#define NONE CSG_EDIT_NONE

/* A question about a file. */
typedef struct query {
    csgm_workspace *workspace;
    csg_edit_file *file; /* NULL: there is none that can be read */
    csg_arena arena;
    csgm_name_fn *each;
    void *user;
} query;

static csgm_status begin_query(query *q, csgm_workspace *workspace, const char *path,
                               csgm_name_fn *each, void *user)
{
    if (!workspace || !path || !each)
        return CSGM_ERR_ARGUMENT;
    if (workspace->is_answering)
        return CSGM_ERR_ARGUMENT;
    csg_workspace_begin(workspace);
    workspace->is_answering = true;
    *q = (query){.workspace = workspace, .each = each, .user = user};
    csg_arena_init(&q->arena, &workspace->context->memory);
    q->file = csg_workspace_file(workspace, path);
    if (q->file && !q->file->text)
        q->file = NULL;
    return CSGM_OK;
}

/* The same, with what the name at the byte means. */
static csgm_status begin_query_at(query *q, csgm_workspace *workspace, const char *path,
                                  uint32_t offset, csgm_name_fn *each, void *user,
                                  csg_edit_target *target)
{
    uint32_t from, to;
    csgm_status status = begin_query(q, workspace, path, each, user);
    *target = (csg_edit_target){NULL, NONE, NONE};
    if (status == CSGM_OK && q->file)
        *target = csg_edit_resolve_at(workspace, q->file, offset, &from, &to);
    return status;
}

static csgm_status end_query(query *q)
{
    csg_arena_reset(&q->arena);
    q->workspace->is_answering = false;
    return q->workspace->no_memory ? csg_context_no_memory(q->workspace->context) : CSGM_OK;
}

/* One answer; its words are forgotten again. */
static bool answer(query *q, csg_edit_target target, csgm_name *name)
{
    if (!csg_edit_describe(&q->arena, target, name)) {
        q->workspace->no_memory = true;
        return false;
    }
    bool goes_on = q->each(q->user, name);
    csg_arena_reset(&q->arena);
    return goes_on;
}

csgm_status csgm_workspace_list(csgm_workspace *workspace, const char *path, csgm_name_fn *each,
                                void *user)
{
    query q;
    csgm_status status = begin_query(&q, workspace, path, each, user);
    if (status != CSGM_OK)
        return status;
    enum { DEEPEST = 64 };
    uint32_t ends[DEEPEST], depth = 0;
    for (uint32_t i = 0; q.file && i < q.file->names.name_count; i++) {
        const csg_edit_name *n = &q.file->names.names[i];
        csgm_name name;
        while (depth > 0 && ends[depth - 1] <= n->begin)
            depth--;
        if (n->kind == CSGM_NAME_PARAMETER)
            continue;
        if (!csg_edit_describe(&q.arena, (csg_edit_target){q.file, i, NONE}, &name)) {
            workspace->no_memory = true;
            break;
        }
        name.depth = depth;
        if (!each(user, &name))
            break;
        csg_arena_reset(&q.arena);
        if (depth < DEEPEST)
            ends[depth++] = n->end;
    }
    return end_query(&q);
}

csgm_status csgm_workspace_find(csgm_workspace *workspace, const char *path, uint32_t offset,
                                csgm_name_fn *each, void *user)
{
    query q;
    csgm_name name;
    csg_edit_target target;
    csgm_status status = begin_query_at(&q, workspace, path, offset, each, user, &target);
    if (status != CSGM_OK)
        return status;
    if (csg_edit_target_exists(target))
        answer(&q, target, &name);
    return end_query(&q);
}

/* ---- uses ----------------------------------------------------------------------------------- */

static bool tell_place(query *q, const csgm_name *what, const csg_edit_file *file, uint32_t offset,
                       uint32_t length)
{
    csgm_name place = *what;
    place.path = file->path;
    place.begin = place.whole_begin = offset;
    place.end = place.whole_end = offset + length;
    return q->each(q->user, &place);
}

/* Another assignment or definition of the same name in the same scope. */
static bool is_double(csg_edit_target target, const csg_edit_file *file, uint32_t index)
{
    if (target.file != file || target.name == index)
        return false;
    const csg_edit_name *a = &file->names.names[target.name], *b = &file->names.names[index];
    return a->scope == b->scope && a->kind == b->kind && a->owner == b->owner &&
           a->length == b->length &&
           memcmp(file->text + a->offset, file->text + b->offset, a->length) == 0;
}

static bool tell_uses_in(query *q, csg_edit_file *file, csg_edit_target target,
                         const csgm_name *what)
{
    size_t length = strlen(what->name);
    bool goes_on = true;
    for (uint32_t i = 0; goes_on && i < file->names.name_count; i++)
        if (is_double(target, file, i))
            goes_on =
                tell_place(q, what, file, file->names.names[i].offset, file->names.names[i].length);
    for (uint32_t i = 0; goes_on && i < file->names.use_count; i++) {
        const csg_edit_use *use = &file->names.uses[i];
        if (use->length == length && memcmp(file->text + use->offset, what->name, length) == 0 &&
            csg_edit_target_is(csg_edit_resolve_use(q->workspace, file, i), target))
            goes_on = tell_place(q, what, file, use->offset, use->length);
    }
    return goes_on;
}

csgm_status csgm_workspace_uses(csgm_workspace *workspace, const char *path, uint32_t offset,
                                csgm_name_fn *each, void *user)
{
    query q;
    csgm_name what;
    csg_edit_target target;
    csgm_status status = begin_query_at(&q, workspace, path, offset, each, user, &target);
    if (status != CSGM_OK)
        return status;
    if (csg_edit_target_exists(target) && !csg_edit_describe(&q.arena, target, &what))
        workspace->no_memory = true;
    if (csg_edit_target_exists(target) && !workspace->no_memory) {
        bool goes_on = !target.file || each(user, &what);
        for (size_t i = 0; goes_on && i < workspace->count; i++)
            if (csg_workspace_refresh(workspace, workspace->files[i]) && workspace->files[i]->text)
                goes_on = tell_uses_in(&q, workspace->files[i], target, &what);
    }
    return end_query(&q);
}

/* ---- completion ------------------------------------------------------------------------------ */

/* Where something is to be written. */
typedef struct site {
    uint32_t begin, length; /* of the name as far as it is there */
    uint32_t call;          /* whose argument begins here, or NONE */
    bool is_statement;      /* modules are called here */
    bool is_nowhere;        /* in a comment, a string or a number */
} site;

/* Brackets that are open at the piece, since the last statement. */
static uint32_t brackets_before(const csg_edit_file *file, uint32_t piece)
{
    uint32_t depth = 0;
    for (uint32_t i = 0; i < piece; i++) {
        csg_token_kind kind = file->pieces.items[i].token;
        if (kind == CSG_TOKEN_OPEN_ROUND || kind == CSG_TOKEN_OPEN_SQUARE)
            depth++;
        else if ((kind == CSG_TOKEN_CLOSE_ROUND || kind == CSG_TOKEN_CLOSE_SQUARE) && depth > 0)
            depth--;
        else if (kind == CSG_TOKEN_SEMICOLON || kind == CSG_TOKEN_OPEN_CURLY ||
                 kind == CSG_TOKEN_CLOSE_CURLY)
            depth = 0;
    }
    return depth;
}

static uint32_t call_at(const csg_edit_file *file, uint32_t offset)
{
    uint32_t found = NONE;
    for (uint32_t i = 0; i < file->names.call_count; i++)
        if (file->names.calls[i].begin <= offset && offset <= file->names.calls[i].end)
            found = i; /* inner ones come later */
    return found;
}

static bool opens_statement(csg_token_kind last)
{
    return last == CSG_TOKEN_SEMICOLON || last == CSG_TOKEN_OPEN_CURLY ||
           last == CSG_TOKEN_CLOSE_CURLY || last == CSG_TOKEN_CLOSE_ROUND ||
           last == CSG_TOKEN_ELSE || last == CSG_TOKEN_HASH || last == CSG_TOKEN_PATH ||
           last == CSG_TOKEN_STAR || last == CSG_TOKEN_PERCENT || last == CSG_TOKEN_NOT;
}

static bool is_word(const csg_edit_file *file, const csg_edit_piece *piece)
{
    char c = file->text[piece->offset];
    return piece->kind == CSG_EDIT_TOKEN && piece->length > 0 &&
           ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '$');
}

static site find_site(const csg_edit_file *file, uint32_t offset)
{
    site s = {.begin = offset, .call = NONE};
    uint32_t i = 0, last = NONE;
    for (; i + 1 < file->pieces.count && file->pieces.items[i].offset < offset; i++) {
        const csg_edit_piece *piece = &file->pieces.items[i];
        bool ends_here = offset <= piece->offset + piece->length;
        bool is_comment = piece->kind != CSG_EDIT_TOKEN;
        if (ends_here && is_word(file, piece)) {
            s.begin = piece->offset;
            s.length = offset - piece->offset;
            break;
        }
        if ((is_comment && (ends_here && (piece->kind == CSG_EDIT_LINE_COMMENT ||
                                          offset < piece->offset + piece->length))) ||
            (ends_here && (piece->token == CSG_TOKEN_NUMBER || piece->token == CSG_TOKEN_BAD ||
                           piece->token == CSG_TOKEN_DOT)) ||
            (offset < piece->offset + piece->length && piece->token == CSG_TOKEN_STRING))
            s.is_nowhere = true;
        if (!is_comment)
            last = i;
    }
    csg_token_kind kind = last == NONE ? CSG_TOKEN_SEMICOLON : file->pieces.items[last].token;
    s.is_statement = opens_statement(kind) && brackets_before(file, i) == 0;
    s.is_nowhere = s.is_nowhere || kind == CSG_TOKEN_DOT || kind == CSG_TOKEN_MODULE ||
                   (kind == CSG_TOKEN_FUNCTION && s.length > 0);
    if (kind == CSG_TOKEN_OPEN_ROUND || kind == CSG_TOKEN_COMMA)
        s.call = call_at(file, s.begin);
    return s;
}

typedef struct completion {
    query *q;
    site at;
    uint32_t count, most;
    const char **told; /* names that were told, with their kind before them */
    bool is_cut;
} completion;

static bool fits_site(const completion *c, csgm_name_kind kind, const char *name)
{
    static const char *const of_values[] = {"true", "false", "undef", "each",   "function",
                                            "if",   "for",   "let",   "assert", "echo"};
    bool is_value_word = false;
    for (size_t i = 0; i < sizeof of_values / sizeof *of_values; i++)
        is_value_word = is_value_word || strcmp(name, of_values[i]) == 0;
    if (kind == CSGM_NAME_KEYWORD)
        return c->at.is_statement || is_value_word;
    return c->at.is_statement ? kind == CSGM_NAME_MODULE || kind == CSGM_NAME_VARIABLE
                              : kind != CSGM_NAME_MODULE || is_value_word;
}

/* Once each. */
static bool is_told(completion *c, csgm_name_kind kind, const char *text, size_t length)
{
    for (uint32_t i = 0; i < c->count; i++)
        if (c->told[i][0] == (char)('0' + kind) && strncmp(c->told[i] + 1, text, length) == 0 &&
            !c->told[i][1 + length])
            return true;
    return false;
}

static bool begins_alike(const completion *c, const char *text, size_t length)
{
    const char *prefix = c->q->file->text + c->at.begin;
    bool is_private = length > 0 && text[0] == '_' && (c->at.length == 0 || prefix[0] != '_');
    return !is_private && length >= c->at.length && strncasecmp(text, prefix, c->at.length) == 0;
}

static bool take_known(void *user, csg_edit_target target)
{
    completion *c = user;
    csgm_name name;
    const csg_edit_file *file = target.file;
    const csg_edit_name *n = file ? &file->names.names[target.name] : NULL;
    csgm_name_kind kind = n ? (csgm_name_kind)n->kind : CSGM_NAME_MODULE;
    const char *text = n ? file->text + n->offset : csg_language_row(target.row, &kind);
    size_t length = n ? n->length : strlen(text);
    bool is_here = n && file == c->q->file && n->offset == c->at.begin; /* being written */
    bool fits = n ? fits_site(c, kind, "") : fits_site(c, kind, text);
    if (is_here || !fits || !begins_alike(c, text, length) || is_told(c, kind, text, length))
        return true;
    c->is_cut = c->count == c->most;
    const char *told =
        csg_arena_printf(&c->q->arena, "%c%.*s", (char)('0' + kind), (int)length, text);
    if (c->is_cut || !told || !csg_edit_describe(&c->q->arena, target, &name)) {
        c->q->workspace->no_memory = c->q->workspace->no_memory || !c->is_cut;
        return false;
    }
    c->told[c->count++] = told;
    name.is_value = !c->at.is_statement;
    return c->q->each(c->q->user, &name);
}

/* "r = " of a call. */
static bool take_parameter(completion *c, const char *text, size_t length, const char *signature,
                           const char *words)
{
    if (!begins_alike(c, text, length))
        return true;
    const char *name = csg_arena_strndup(&c->q->arena, text, length);
    if (!name || c->count >= c->most) {
        c->q->workspace->no_memory = c->q->workspace->no_memory || !name;
        return false;
    }
    csgm_name out = {.kind = CSGM_NAME_PARAMETER,
                     .name = name,
                     .signature = signature,
                     .documentation = words,
                     .whole_end = 1}; /* of a call: NAME = VALUE is written */
    return c->q->each(c->q->user, &out);
}

static void take_parameters(completion *c)
{
    csg_edit_file *file = c->q->file;
    uint32_t use = file->names.calls[c->at.call].use;
    if (use == NONE)
        return;
    csg_edit_target called = csg_edit_resolve_use(c->q->workspace, file, use);
    csgm_name name;
    const char *words, *parameter;
    bool goes_on = csg_edit_target_exists(called);
    for (uint32_t i = 0; goes_on && !called.file &&
                         (parameter = csg_language_parameter(&c->q->arena, called.row, i, &words));
         i++)
        goes_on = take_parameter(c, parameter, strcspn(parameter, " ="), parameter, words);
    for (uint32_t i = called.name + 1; goes_on && called.file && i < called.file->names.name_count;
         i++)
        if (called.file->names.names[i].owner == called.name) {
            goes_on =
                csg_edit_describe(&c->q->arena, (csg_edit_target){called.file, i, NONE}, &name) &&
                take_parameter(c, name.name, strlen(name.name), name.signature, name.documentation);
        }
}

csgm_status csgm_workspace_complete(csgm_workspace *workspace, const char *path, uint32_t offset,
                                    uint32_t most, csgm_name_fn *each, void *user,
                                    bool *is_complete)
{
    query q;
    csgm_status status = begin_query(&q, workspace, path, each, user);
    if (status != CSGM_OK)
        return status;
    completion c = {.q = &q, .most = most};
    c.told = csg_arena_alloc(&q.arena, ((size_t)most + 1) * sizeof *c.told);
    workspace->no_memory = workspace->no_memory || !c.told;
    if (q.file && c.told)
        c.at = find_site(q.file, offset);
    if (q.file && c.told && !c.at.is_nowhere) {
        if (c.at.call != NONE)
            take_parameters(&c);
        csg_edit_each_known(workspace, q.file, csg_edit_scope_at(&q.file->names, offset),
                            take_known, &c);
    }
    *is_complete = !c.is_cut;
    return end_query(&q);
}

/* ---- calls ----------------------------------------------------------------------------------- */

/* Which of its parameters has this name? */
static uint32_t index_of_parameter(query *q, csg_edit_target called, const char *text,
                                   uint32_t length)
{
    uint32_t index = 0;
    const char *words, *parameter;
    if (!called.file) {
        for (; (parameter = csg_language_parameter(&q->arena, called.row, index, &words)); index++)
            if (strncmp(parameter, text, length) == 0 && strcspn(parameter, " =") == length)
                return index;
        return NONE;
    }
    for (uint32_t i = called.name + 1; i < called.file->names.name_count; i++) {
        const csg_edit_name *p = &called.file->names.names[i];
        if (p->owner != called.name)
            continue;
        if (p->length == length && memcmp(called.file->text + p->offset, text, length) == 0)
            return index;
        index++;
    }
    return NONE;
}

/* The argument in which the byte is: its position, or that of the parameter it names. */
static uint32_t argument_at(query *q, csg_edit_target called, uint32_t from, uint32_t offset)
{
    const csg_edit_file *file = q->file;
    uint32_t index = 0, depth = 0, first = NONE;
    for (uint32_t i = 0; i + 1 < file->pieces.count && file->pieces.items[i].offset < offset; i++) {
        const csg_edit_piece *piece = &file->pieces.items[i];
        if (piece->offset < from || piece->kind != CSG_EDIT_TOKEN)
            continue;
        if (first == NONE)
            first = i;
        depth += csg_token_opens(piece->token);
        depth -= csg_token_closes(piece->token) && depth > 0;
        if (piece->token == CSG_TOKEN_COMMA && depth == 0) {
            index++;
            first = NONE;
        }
    }
    if (first != NONE && file->pieces.items[first].token == CSG_TOKEN_NAME &&
        file->pieces.items[first + 1].token == CSG_TOKEN_ASSIGN)
        return index_of_parameter(q, called, file->text + file->pieces.items[first].offset,
                                  file->pieces.items[first].length);
    return index;
}

csgm_status csgm_workspace_call(csgm_workspace *workspace, const char *path, uint32_t offset,
                                csgm_name_fn *each, void *user, uint32_t *parameter)
{
    query q;
    csgm_status status = begin_query(&q, workspace, path, each, user);
    if (status != CSGM_OK)
        return status;
    uint32_t call = q.file ? call_at(q.file, offset) : NONE;
    if (call != NONE && q.file->names.calls[call].use != NONE) {
        csg_edit_target called =
            csg_edit_resolve_use(workspace, q.file, q.file->names.calls[call].use);
        csgm_name name;
        if (csg_edit_target_exists(called)) {
            *parameter = argument_at(&q, called, q.file->names.calls[call].begin, offset);
            answer(&q, called, &name);
        }
    }
    return end_query(&q);
}
