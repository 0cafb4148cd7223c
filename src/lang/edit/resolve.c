/* SPDX-License-Identifier: MIT
 * From a use to its definition, and the words about that; see resolve.h. Scopes from inside out,
 * then what the file includes, what it uses, and the language.
 */
#include "lang/edit/resolve.h"

#include <string.h>

#define NONE CSG_EDIT_NONE

static const csg_edit_target nothing = {NULL, NONE, NONE};

/* ---- what is known -------------------------------------------------------------------------- */

typedef struct visit {
    csgm_workspace *workspace;
    csg_edit_known_fn *each;
    void *user;
    bool goes_on;
} visit;

static void visit_scope(visit *v, csg_edit_file *file, uint32_t scope, bool only_called)
{
    const csg_edit_names *names = &file->names;
    for (uint32_t i = names->name_count; v->goes_on && i-- > 0;) { /* the last one holds */
        const csg_edit_name *name = &names->names[i];
        if (name->scope == scope && !(only_called && name->kind == CSGM_NAME_VARIABLE))
            v->goes_on = v->each(v->user, (csg_edit_target){file, i, NONE});
    }
}

/* The top of a file and of all that it includes; used: only what a use makes known. */
static void visit_top(visit *v, csg_edit_file *file, bool is_used)
{
    if (!file || file->seen == v->workspace->walk || !v->goes_on)
        return;
    file->seen = v->workspace->walk;
    visit_scope(v, file, 0, is_used);
    for (uint32_t i = file->names.link_count; v->goes_on && i-- > 0;)
        if (!file->names.links[i].is_use)
            visit_top(v, csg_workspace_follow(v->workspace, file, i), is_used);
}

/* What the file and the files that it includes use; `walked` files are behind us already. */
static void visit_used(visit *v, csg_edit_file *file, uint32_t walk, int depth)
{
    enum { DEEPEST = 64 };
    for (uint32_t i = file->names.link_count; v->goes_on && i-- > 0;) {
        csg_edit_file *other = csg_workspace_follow(v->workspace, file, i);
        if (!other || other == file)
            continue;
        if (file->names.links[i].is_use)
            visit_top(v, other, true);
        else if (other->seen == walk && depth < DEEPEST)
            visit_used(v, other, walk, depth + 1);
    }
}

void csg_edit_each_known(csgm_workspace *workspace, csg_edit_file *file, uint32_t scope,
                         csg_edit_known_fn *each, void *user)
{
    visit v = {workspace, each, user, true};
    while (scope != 0 && scope < file->names.scope_count && v.goes_on) {
        visit_scope(&v, file, scope, false);
        scope = file->names.scopes[scope].parent;
    }
    uint32_t walk = ++workspace->walk;
    visit_top(&v, file, false);
    if (v.goes_on)
        visit_used(&v, file, walk, 0);
    csgm_name_kind kind;
    for (uint32_t row = 0; v.goes_on && csg_language_row(row, &kind); row++)
        v.goes_on = each(user, (csg_edit_target){NULL, NONE, row});
}

/* ---- one use ------------------------------------------------------------------------------- */

typedef struct search {
    const char *text;
    uint32_t length;
    csg_edit_use_kind kind;
    csg_edit_target found;
} search;

static bool fits_kind(csg_edit_use_kind use, csgm_name_kind kind)
{
    bool is_value = kind == CSGM_NAME_VARIABLE || kind == CSGM_NAME_PARAMETER;
    return use == CSG_EDIT_USE_MODULE     ? kind == CSGM_NAME_MODULE
           : use == CSG_EDIT_USE_FUNCTION ? kind == CSGM_NAME_FUNCTION || is_value
                                          : is_value;
}

static bool compare_known(void *user, csg_edit_target target)
{
    search *s = user;
    csgm_name_kind kind;
    const char *text;
    uint32_t length;
    if (target.file) {
        const csg_edit_name *name = &target.file->names.names[target.name];
        kind = (csgm_name_kind)name->kind;
        text = target.file->text + name->offset;
        length = name->length;
    } else {
        text = csg_language_row(target.row, &kind);
        length = (uint32_t)strlen(text);
    }
    bool same =
        length == s->length && memcmp(text, s->text, length) == 0 && fits_kind(s->kind, kind);
    if (same)
        s->found = target;
    return !same;
}

/* The parameter of what is called. */
static csg_edit_target resolve_argument(csgm_workspace *workspace, csg_edit_file *file,
                                        const csg_edit_use *use)
{
    if (use->callee == NONE)
        return nothing;
    csg_edit_target called = csg_edit_resolve_use(workspace, file, use->callee);
    if (!called.file)
        return called; /* its words say what the parameters are */
    const csg_edit_names *names = &called.file->names;
    for (uint32_t i = called.name + 1; i < names->name_count; i++)
        if (names->names[i].owner == called.name && names->names[i].length == use->length &&
            memcmp(called.file->text + names->names[i].offset, file->text + use->offset,
                   use->length) == 0)
            return (csg_edit_target){called.file, i, NONE};
    return nothing;
}

csg_edit_target csg_edit_resolve_use(csgm_workspace *workspace, csg_edit_file *file, uint32_t use)
{
    const csg_edit_use *u = &file->names.uses[use];
    if (u->kind == CSG_EDIT_USE_ARGUMENT)
        return resolve_argument(workspace, file, u);
    search s = {file->text + u->offset, u->length, (csg_edit_use_kind)u->kind, nothing};
    csg_edit_each_known(workspace, file, u->scope, compare_known, &s);
    return s.found;
}

csg_edit_target csg_edit_resolve_at(csgm_workspace *workspace, csg_edit_file *file, uint32_t offset,
                                    uint32_t *begin, uint32_t *end)
{
    const csg_edit_names *names = &file->names;
    for (uint32_t i = 0; i < names->name_count; i++) {
        *begin = names->names[i].offset;
        *end = *begin + names->names[i].length;
        if (*begin <= offset && offset <= *end)
            return (csg_edit_target){file, i, NONE};
    }
    for (uint32_t i = 0; i < names->use_count; i++) {
        *begin = names->uses[i].offset;
        *end = *begin + names->uses[i].length;
        if (*begin <= offset && offset <= *end)
            return csg_edit_resolve_use(workspace, file, i);
    }
    return nothing;
}

/* ---- words ---------------------------------------------------------------------------------- */

/* The bytes without those of a last character that may have been cut in two. */
static size_t whole_characters(const char *text, size_t length)
{
    size_t more = 0;
    while (more < 3 && more + 1 < length && ((unsigned char)text[length - 1 - more] & 0xC0) == 0x80)
        more++;
    return length && (unsigned char)text[length - 1 - more] >= 0xC0 ? length - 1 - more : length;
}

/* A piece of the text on one line, not longer than anyone wants to read. */
static const char *excerpt(csg_arena *arena, const csg_edit_file *file, uint32_t begin,
                           uint32_t end)
{
    enum { MOST = 60 };
    char line[MOST + 4];
    size_t length = 0;
    while (end > begin && (file->text[end - 1] == ';' || file->text[end - 1] == ' ' ||
                           file->text[end - 1] == '\n' || file->text[end - 1] == '\r'))
        end--;
    for (uint32_t i = begin; i < end && length < MOST; i++) {
        char c = file->text[i];
        bool is_space = c == ' ' || (c >= '\t' && c <= '\r');
        if (!is_space)
            line[length++] = c;
        else if (length > 0 && line[length - 1] != ' ')
            line[length++] = ' ';
    }
    bool is_cut = length == MOST;
    if (is_cut)
        length = whole_characters(line, length);
    memcpy(line + length, is_cut ? "..." : "", is_cut ? 4 : 1);
    return csg_arena_strndup(arena, line, strlen(line));
}

/* Comments without their signs. */
static const char *clean_comment(csg_arena *arena, const csg_edit_file *file, uint32_t begin,
                                 uint32_t end)
{
    enum { MOST = 8000 };
    if (end - begin > MOST)
        end = begin + (uint32_t)whole_characters(file->text + begin, MOST);
    char *out = csg_arena_alloc(arena, end - begin + 1);
    size_t length = 0;
    for (uint32_t i = begin; out && i < end;) {
        while (i < end && (file->text[i] == ' ' || file->text[i] == '\t'))
            i++;
        while (i < end && (file->text[i] == '/' || file->text[i] == '*'))
            i++;
        if (i < end && file->text[i] == ' ')
            i++;
        while (i < end && file->text[i] != '\n') {
            if (file->text[i] == '*' && i + 1 < end && file->text[i + 1] == '/')
                i += 2;
            else if (file->text[i] == '\r')
                i++;
            else
                out[length++] = file->text[i++];
        }
        if (i++ < end)
            out[length++] = '\n';
    }
    if (out)
        out[length] = '\0';
    return out;
}

/* The signature as far as "module wheel(", with its parameters; NULL: no memory. */
static const char *add_parameters(csg_arena *arena, csg_edit_target target, const char *signature,
                                  csgm_name *out)
{
    const csg_edit_names *names = &target.file->names;
    for (uint32_t i = target.name + 1; signature && i < names->name_count; i++) {
        const csg_edit_name *p = &names->names[i];
        if (p->owner != target.name)
            continue;
        const char *value = p->value ? excerpt(arena, target.file, p->value, p->end) : "";
        const char *comma = out->parameter_count ? ", " : "";
        size_t begin = strlen(signature) + strlen(comma);
        signature =
            value ? csg_arena_printf(arena, "%s%s%.*s%s%s", signature, comma, (int)p->length,
                                     target.file->text + p->offset, *value ? " = " : "", value)
                  : NULL;
        if (signature && !csg_signature_add(arena, out, begin, strlen(signature)))
            return NULL;
    }
    return signature;
}

static const char *sign(csg_arena *arena, csg_edit_target target, csgm_name *out)
{
    const csg_edit_file *file = target.file;
    const csg_edit_name *name = &file->names.names[target.name];
    const char *text = file->text + name->offset;
    if (name->kind == CSGM_NAME_MODULE || name->kind == CSGM_NAME_FUNCTION) {
        const char *word = name->kind == CSGM_NAME_MODULE ? "module" : "function";
        const char *signature = csg_arena_printf(arena, "%s %.*s(", word, (int)name->length, text);
        signature = add_parameters(arena, target, signature, out);
        return signature ? csg_arena_printf(arena, "%s)", signature) : NULL;
    }
    const char *value = name->value ? excerpt(arena, file, name->value, name->end) : "";
    return value ? csg_arena_printf(arena, "%.*s%s%s", (int)name->length, text, *value ? " = " : "",
                                    value)
                 : NULL;
}

/* Does the module ask for its children? */
static bool takes_children(const csg_edit_file *file, const csg_edit_name *module)
{
    size_t low = 0, high = file->pieces.count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (file->pieces.items[middle].offset < module->begin)
            low = middle + 1;
        else
            high = middle;
    }
    for (size_t i = low; i < file->pieces.count && file->pieces.items[i].offset < module->end;
         i++) {
        const csg_edit_piece *piece = &file->pieces.items[i];
        const char *text = file->text + piece->offset;
        size_t dollar = piece->length > 0 && text[0] == '$';
        if (piece->kind == CSG_EDIT_TOKEN && piece->length - dollar == strlen("children") &&
            memcmp(text + dollar, "children", strlen("children")) == 0)
            return true;
    }
    return false;
}

bool csg_edit_describe(csg_arena *arena, csg_edit_target target, csgm_name *out)
{
    *out = (csgm_name){0};
    if (!target.file) {
        out->name = csg_language_row(target.row, &out->kind);
        return csg_language_describe(arena, target.row, out);
    }
    const csg_edit_name *name = &target.file->names.names[target.name];
    out->kind = (csgm_name_kind)name->kind;
    out->name = csg_arena_strndup(arena, target.file->text + name->offset, name->length);
    out->signature = sign(arena, target, out);
    out->path = target.file->path;
    out->begin = name->offset;
    out->end = name->offset + name->length;
    out->whole_begin = name->begin;
    out->whole_end = name->end;
    out->takes_children = name->kind == CSGM_NAME_MODULE && takes_children(target.file, name);
    if (name->doc_end)
        out->documentation = clean_comment(arena, target.file, name->doc, name->doc_end);
    return out->name && out->signature && (!name->doc_end || out->documentation);
}
