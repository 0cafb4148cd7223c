/* SPDX-License-Identifier: MIT
 * include, use and the scene itself; see loader.h.
 * An included file is parsed in place, into the scope where the include stands; a used one is a
 * file of its own, parsed once however often it is used.
 */
#include "lang/parse/loader.h"

#include <string.h>
#include <strings.h>

#include "base/scene_codes.h"
#include "text/folders.h"
#include "text/lexer.h"

/* ---- finding -------------------------------------------------------------------------------- */

/* "BOSL2" of "BOSL2/std.scad", "std.scad" of itself. */
static const char *library_of(csg_parser *parser, const char *name)
{
    const char *library = csg_arena_strndup(&parser->program->arena, name, strcspn(name, "/"));
    if (!library)
        csg_parser_no_memory(parser);
    return library;
}

/* `code` says that it was not found: a font is not missed as a source is. *library: that of the
 * file that asks, unless it was found in a folder of libraries. */
static const char *find_file(csg_parser *parser, csg_span path, csg_diag_code code,
                             const char **library)
{
    const char *name =
        csg_arena_strndup(&parser->program->arena, parser->text + path.offset + 1, path.length - 2);
    if (!name) {
        csg_parser_no_memory(parser);
        return NULL;
    }
    bool in_library, no_memory;
    const char *found =
        csg_program_find(parser->program, parser->source, name, &in_library, &no_memory);
    *library = found && in_library ? library_of(parser, name)
                                   : parser->program->sources.items[parser->source].library;
    if (no_memory)
        csg_parser_no_memory(parser);
    if (!found && !parser->stop) {
        bool is_lenient = csg_source_is_lenient(&parser->program->sources, code, path);
        csg_source_report(
            &parser->program->sources, code, path,
            strchr(name, '\\') ? "folders are separated by '/'" : CSG_FOLDERS_IN_WORDS,
            "there is no file '%.200s'%s", name, is_lenient ? "; what it defines is missing" : "");
        parser->program->failed_io |= code == CSG_DIAG_INCLUDE_NOT_FOUND && !is_lenient;
    }
    return found;
}

/* Does the text that is being read stand in this file, by way of includes? Only that has no end: a
 * file that is used is parsed once, so files may use each other in circles. */
static bool includes_itself(const csg_parser *parser, const char *path)
{
    const csg_sources *sources = &parser->program->sources;
    for (uint32_t i = parser->source; i < sources->count; i = sources->items[i].from.source) {
        if (csg_source_is_file(&sources->items[i], path))
            return true;
        if (!sources->items[i].textual)
            return false;
    }
    return false;
}

static void report_cycle(csg_parser *parser, csg_span where, const char *path)
{
    csg_source_report(&parser->program->sources, CSG_DIAG_INCLUDE_CYCLE, where, NULL,
                      "'%.200s' would read itself without end", path);
}

static void add_dependency(csg_parser *parser, const char *path)
{
    if (!csg_program_depend(parser->program, path))
        csg_parser_no_memory(parser);
}

/* Reads the file that was found for a PATH token. */
static bool read_found(csg_parser *parser, const csg_source_request *request, uint32_t *out)
{
    if (request->textual && includes_itself(parser, request->path)) {
        report_cycle(parser, request->from, request->path);
        return false;
    }
    csgm_status status = csg_source_read(&parser->program->sources, request, out);
    if (status == CSGM_ERR_IO)
        parser->program->failed_io = true;
    if (status == CSGM_ERR_MEMORY || status == CSGM_ERR_LIMIT) {
        parser->stop = true;
        parser->status = status;
    }
    if (status == CSGM_OK)
        add_dependency(parser, request->path);
    return status == CSGM_OK;
}

/* ---- parsing a source ----------------------------------------------------------------------- */

/* The parser for another text, on behalf of this one. */
static csg_parser derive(const csg_parser *parser, uint32_t source)
{
    csg_parser inner = *parser;
    inner.source = source;
    inner.text = parser->program->sources.items[source].text;
    inner.tokens = (csg_token_array){0};
    inner.at = 0;
    return inner;
}

static void parse_source(csg_parser *inner, csg_scope *scope)
{
    csg_memory *memory = &inner->program->context->memory;
    if (csg_lex(&inner->program->sources, inner->source, &inner->tokens)) {
        csg_parser_statements(inner, scope);
    } else {
        inner->status = csg_context_no_memory(inner->program->context);
        inner->stop = true;
    }
    csg_tokens_release(memory, &inner->tokens);
}

static void take_outcome(csg_parser *parser, const csg_parser *inner)
{
    if (!inner->stop)
        return;
    parser->stop = true;
    parser->status = inner->status;
    parser->at = parser->tokens.count - 1;
}

void csg_load_include(csg_parser *parser, csg_scope *scope, csg_span path)
{
    uint32_t source;
    if (!csg_parser_enter(parser))
        return;
    csg_source_request request = {.from = path, .textual = true};
    request.path = find_file(parser, path, CSG_DIAG_INCLUDE_NOT_FOUND, &request.library);
    if (request.path && read_found(parser, &request, &source)) {
        csg_parser inner = derive(parser, source);
        parse_source(&inner, scope);
        take_outcome(parser, &inner);
    }
    csg_parser_leave(parser);
}

static csg_program_file *add_file(csg_parser *parser, uint32_t source)
{
    csg_program *program = parser->program;
    csg_program_file *file = csg_parser_alloc(parser, sizeof *file);
    csg_scope *scope = file ? csg_parser_scope(parser) : NULL;
    if (!scope)
        return NULL;
    *file = (csg_program_file){.source = source, .scope = scope, .index = program->file_count};
    csg_program_file **place = csg_arena_push(&program->arena, (void **)&program->files,
                                              &program->file_count, sizeof file);
    if (!place) {
        csg_parser_no_memory(parser);
        return NULL;
    }
    *place = file;
    return file;
}

static csg_program_file *find_used(const csg_parser *parser, const char *path)
{
    const csg_program *program = parser->program;
    for (uint32_t i = 0; i < program->file_count; i++)
        if (csg_source_is_file(&program->sources.items[program->files[i]->source], path))
            return program->files[i];
    return NULL;
}

static csg_program_file *load_used(csg_parser *parser, csg_span path)
{
    uint32_t source;
    csg_source_request request = {.from = path};
    request.path = find_file(parser, path, CSG_DIAG_INCLUDE_NOT_FOUND, &request.library);
    if (!request.path)
        return NULL;
    csg_program_file *file = find_used(parser, request.path);
    if (file || !read_found(parser, &request, &source))
        return file;
    file = add_file(parser, source);
    if (!file)
        return NULL;
    csg_parser inner = derive(parser, source);
    inner.file = file;
    parse_source(&inner, file->scope);
    take_outcome(parser, &inner);
    return file;
}

static bool is_font(const csg_parser *parser, csg_span path)
{
    enum { SUFFIX = 5 }; /* ".ttf>" */
    const char *end = parser->text + path.offset + path.length;
    return path.length > SUFFIX && (strncasecmp(end - SUFFIX, ".ttf>", SUFFIX) == 0 ||
                                    strncasecmp(end - SUFFIX, ".otf>", SUFFIX) == 0);
}

/* text() opens it. */
static void load_font(csg_parser *parser, csg_span where)
{
    csg_program *program = parser->program;
    const char *library;
    const char *path = find_file(parser, where, CSG_DIAG_FONT_NOT_FOUND, &library);
    if (!path)
        return;
    add_dependency(parser, path);
    const char **place = csg_arena_push(&program->arena, (void **)&program->fonts,
                                        &program->font_count, sizeof path);
    if (place)
        *place = path;
    else
        csg_parser_no_memory(parser);
}

void csg_load_use(csg_parser *parser, csg_span path)
{
    if (is_font(parser, path)) {
        load_font(parser, path);
        return;
    }
    if (!csg_parser_enter(parser))
        return;
    csg_program_file *used = load_used(parser, path);
    csg_parser_leave(parser);
    csg_program_file *self = parser->file;
    for (uint32_t i = 0; used && i < self->use_count; i++)
        if (self->uses[i] == used) { /* the last use of a file counts */
            memmove(self->uses + i, self->uses + i + 1,
                    (self->use_count - i - 1) * sizeof *self->uses);
            self->uses[self->use_count - 1] = used;
            return;
        }
    if (!used || parser->stop)
        return;
    csg_program_file **place = csg_arena_push(&parser->program->arena, (void **)&parser->file->uses,
                                              &parser->file->use_count, sizeof used);
    if (place)
        *place = used;
    else
        csg_parser_no_memory(parser);
}

void csg_load_scene(csg_parser *parser)
{
    csg_program_file *file = add_file(parser, parser->source);
    if (!file)
        return;
    csg_parser inner = derive(parser, parser->source);
    inner.file = file;
    parse_source(&inner, file->scope);
    parser->stop = inner.stop;
    parser->status = inner.status;
}
