/* SPDX-License-Identifier: MIT
 * The abstract syntax tree: what the parser makes and the evaluator walks. All of it lives in one
 * arena and never changes once parsed. A scope's assignments, functions and modules hold in all of
 * it wherever they stand, so they are lists of the scope, apart from its statements.
 */
#ifndef CSG_LANG_AST_H
#define CSG_LANG_AST_H

#include "lang/parse/symbols.h"
#include "text/source.h"

typedef struct csg_expression csg_expression;

/* An argument of a call, a parameter with its default, an assignment of let and for. */
typedef struct csg_argument {
    csg_symbol name;       /* 0 = positional */
    csg_expression *value; /* NULL = a parameter without default */
    csg_span where;        /* of the name, or of the value */
} csg_argument;

typedef struct csg_arguments {
    csg_argument *items;
    uint32_t count;
} csg_arguments;

struct csg_expression {
    uint8_t kind;      /* csg_expression_kind (ast_kinds.h) */
    uint8_t operation; /* UNARY, BINARY: csg_token_kind (text/lexer.h) */
    csg_span where;    /* operators: of the operator sign; else of the first token or name */
    csg_span whole;    /* from its first to its last byte */
    uint32_t slot;     /* NAME: its own among the program's, where the evaluator keeps what it is */
    union {
        double number;
        bool boolean;
        struct {
            const char *text;
            size_t length;
        } string;
        csg_symbol name;
        struct {
            csg_expression *left, *right; /* UNARY: left only; INDEX: right is the index */
        } pair;
        struct {
            csg_expression *object;
            csg_symbol name;
        } member;
        struct {
            csg_expression *condition, *then, *other; /* IF: other may be NULL */
        } branch;
        struct {
            csg_expression *begin, *step, *end; /* step may be NULL */
        } range;
        struct {
            csg_expression **items;
            uint32_t count;
            bool is_plain; /* each item is one element, none a part of a list comprehension */
        } list;
        struct {
            csg_expression
                *callee; /* NAME or any expression; LET, ASSERT, ECHO, FUNCTION, FOR: NULL */
            csg_arguments arguments;
            csg_expression *body; /* ASSERT and ECHO: NULL = undef */
        } call;
        struct {
            csg_arguments first, next;
            csg_expression *condition, *body;
        } loop;
        csg_expression *inner; /* EACH */
    } as;
};

typedef struct csg_scope csg_scope;
typedef struct csg_program_file csg_program_file;

typedef struct csg_assignment {
    csg_symbol name;
    csg_expression *value; /* of the last assignment */
    csg_span where;        /* of the last assignment's name */
} csg_assignment;

/* A module or a function. */
typedef struct csg_definition {
    csg_symbol name;
    csg_arguments parameters;
    csg_expression *value; /* functions */
    csg_scope *body;       /* modules */
    csg_span where;
} csg_definition;

typedef enum csg_statement_kind { CSG_STATEMENT_CALL, CSG_STATEMENT_IF } csg_statement_kind;

typedef struct csg_statement {
    uint8_t kind;
    bool root, highlight, background; /* the modifiers ! # % */
    bool childless;                   /* CALL: a ';' stands where children may */
    csg_span where;                   /* of the name */
    csg_symbol name;
    uint32_t slot; /* CALL: as of a NAME */
    csg_arguments arguments;
    csg_expression *condition;   /* IF */
    csg_scope *children, *other; /* IF: then and else, may be NULL; CALL: children, never NULL */
} csg_statement;

struct csg_scope {
    uint32_t id;
    uint32_t variable_count, function_count, module_count, statement_count;
    csg_assignment *variables; /* in order of first assignment */
    csg_definition **functions, **modules;
    csg_statement **statements;
};

struct csg_program_file {
    uint32_t source;
    csg_scope *scope;
    csg_program_file **uses;
    uint32_t use_count;
    uint32_t index; /* in csg_program.files */
};

/* Everything parsed for one scene. */
typedef struct csg_program {
    csgm_context *context;
    csg_arena arena; /* the tree and the texts */
    csg_sources sources;
    csg_symbols symbols;
    csg_members members;
    csg_program_file **files; /* files[0] is the scene; the others are used */
    uint32_t file_count;
    uint32_t scope_count;
    uint32_t slot_count; /* names that are used: csg_expression, csg_statement */
    const char **dependencies;
    uint32_t dependency_count;
    double deadline_s;  /* of the monotonic clock; 0 = none */
    bool failed_io;     /* a file could not be read */
    bool is_alone;      /* only the scene's own text is read */
    bool exact_facets;  /* $fn, $fa and $fs everywhere, as in OpenSCAD */
    const char **fonts; /* files behind use <font.ttf> */
    uint32_t font_count;
    const csgm_scene_options *options;   /* NULL = defaults */
    const struct csg_services *services; /* NULL: no meshes, read or made */
    const struct csg_builtins *builtins; /* evaluate/builtins.h */
    uintptr_t stack_end; /* lowest address of the stack that parser and evaluator may use */
} csg_program;

void csg_program_init(csg_program *program, csgm_context *context);
void csg_program_reset(csg_program *program);
/* Counts a file among the scene's dependencies, once; `path` stays valid as long as the program.
 * False without memory. */
bool csg_program_depend(csg_program *program, const char *path);
/* The path of a file that can be read, beside the source that asks or, then *in_library, in the
 * folders of text/folders.h; in the arena. NULL: there is none (not reported), or *no_memory. */
const char *csg_program_find(csg_program *program, uint32_t asking, const char *name,
                             bool *in_library, bool *no_memory);
/* Is there room on the stack between `here` (the address of a local) and its end? */
static inline bool csg_program_has_stack(const csg_program *program, const void *here)
{
    enum { MARGIN = 64 << 10 }; /* for the deepest calls below a check */
    return (uintptr_t)here > program->stack_end + MARGIN;
}

/* Appends to an array in the arena that doubles when its count reaches a power of two. NULL: no
 * memory; else the place of the new element. */
void *csg_arena_push(csg_arena *arena, void **items, uint32_t *count, size_t element_bytes);

#endif
