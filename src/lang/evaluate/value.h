/* SPDX-License-Identifier: MIT
 * Values of the language. Numbers, booleans and blends stand in the value itself; strings, vectors,
 * ranges, functions and frames are counted objects of a heap. Values never change once made.
 *
 * Ownership: a function that returns a csg_value gives it to the caller, who releases it once;
 * arguments are borrowed unless a comment says "consumed". Every object lies in one of the heap's
 * blocks or is on its list, so that the end of an evaluation frees all, also cycles and what an
 * error left behind.
 */
#ifndef CSG_LANG_VALUE_H
#define CSG_LANG_VALUE_H

#include <math.h>

#include "lang/parse/ast.h"
#include "scene/scene.h"

typedef enum csg_value_kind {
    CSG_VALUE_UNDEF,
    CSG_VALUE_NUMBER,
    CSG_VALUE_BOOLEAN,
    CSG_VALUE_BLEND,
    CSG_VALUE_TERM,   /* a number that depends on field()'s point */
    CSG_VALUE_STEP,   /* a smooth unit step; number is its parameter, blend its csg_step_kind */
    CSG_VALUE_UNSET,  /* a variable of a scope before its assignment */
    CSG_VALUE_STRING, /* from here on: objects */
    CSG_VALUE_VECTOR,
    CSG_VALUE_RECORD, /* a vector of keys (strings) and values in turn: what scenes call an object
                       */
    CSG_VALUE_RANGE,
    CSG_VALUE_FUNCTION,
    CSG_VALUE_RULE, /* a blend of more than one parameter */
    CSG_VALUE_FRAME /* never seen by a scene */
} csg_value_kind;

typedef struct csg_heap_block csg_heap_block;

typedef struct csg_object {
    union {
        struct csg_object *previous; /* of large ones */
        csg_heap_block *block;       /* of small ones */
    };
    struct csg_object *next; /* of large ones, and of the dead */
    size_t size_bytes;
    uint32_t references;
    uint8_t kind;
} csg_object;

typedef struct csg_string csg_string;
typedef struct csg_vector csg_vector;
typedef struct csg_range csg_range;
typedef struct csg_function csg_function;
typedef struct csg_rule_value csg_rule_value;
typedef struct csg_frame csg_frame;

typedef struct csg_value {
    uint8_t kind;
    uint8_t blend; /* BLEND: csg_blend_kind; number is its parameter n */
    union {
        double number;
        bool boolean;
        csg_formula_id term; /* of the evaluator's formula */
        csg_object *object;
        csg_string *string;
        csg_vector *vector; /* of a RECORD too */
        csg_range *range;
        csg_function *function;
        csg_rule_value *rule;
        csg_frame *frame;
    } as;
} csg_value;

struct csg_string {
    csg_object object;
    size_t length; /* bytes */
    size_t characters;
    char text[]; /* terminated */
};

struct csg_vector {
    csg_object object;
    uint32_t count;
    uint32_t depth; /* 1 + that of its deepest element */
    csg_value items[];
};

struct csg_range {
    csg_object object;
    double begin, step, end;
};

struct csg_function {
    csg_object object;
    const csg_expression *literal;
    csg_frame *frame; /* where it was made */
};

/* Variables of one scope, call or let; names are searched outwards along `parent`. */
struct csg_frame {
    csg_object object;
    csg_frame *parent;
    const csg_scope *scope;       /* of a scope's frame: its variables, functions, modules */
    const csg_program_file *file; /* of a file's outermost frame */
    const csg_scope *children;    /* of a module's call: what stands under it */
    csg_frame *children_frame;    /* and where */
    csg_value child_count;        /* $children, UNSET outside of a module's call */
    const csg_argument *names;    /* of a call's or let's frame */
    bool has_dynamics;            /* of a used file's frame: it assigns $variables */
    uint32_t count;
    csg_value values[];
};

enum {
    CSG_SMALL_STEP = 16, /* small objects are cut from blocks, in sizes of so many bytes more */
    CSG_SMALL_SIZES = 32
};

typedef struct csg_heap {
    csg_memory *memory;
    csg_object *objects;                       /* the large ones */
    csg_heap_block *blocks;                    /* newest first; those of small ones */
    csg_heap_block *open[CSG_SMALL_SIZES + 1]; /* with room, by the size of their objects */
    size_t block_bytes[CSG_SMALL_SIZES + 1];   /* of the last one made for that size; 0: none */
    uint32_t deepest;                          /* most levels of nested vectors */
} csg_heap;

enum {
    CSG_LONGEST_LIST = 1 << 24,  /* elements: 256 MiB */
    CSG_LONGEST_STRING = 1 << 26 /* bytes */
};

void csg_heap_init(csg_heap *heap, csg_memory *memory, uint32_t deepest);
void csg_heap_reset(csg_heap *heap);

static inline csg_value csg_value_undef(void)
{
    return (csg_value){.kind = CSG_VALUE_UNDEF};
}
/* Machines differ in the sign of 0 / 0, which would show in messages: all NaNs are one. */
static inline csg_value csg_value_number(double number)
{
    return (csg_value){.kind = CSG_VALUE_NUMBER, .as.number = number == number ? number : NAN};
}
static inline csg_value csg_value_boolean(bool boolean)
{
    return (csg_value){.kind = CSG_VALUE_BOOLEAN, .as.boolean = boolean};
}
static inline csg_value csg_value_object(void *object, csg_value_kind kind)
{
    return (csg_value){.kind = (uint8_t)kind, .as.object = object};
}
static inline bool csg_value_is_object(csg_value value)
{
    return value.kind >= CSG_VALUE_STRING;
}
static inline csg_value csg_value_retain(csg_value value)
{
    if (csg_value_is_object(value))
        value.as.object->references++;
    return value;
}
void csg_object_release(csg_heap *heap, csg_object *object);
static inline void csg_value_release(csg_heap *heap, csg_value value)
{
    if (csg_value_is_object(value) && --value.as.object->references == 0)
        csg_object_release(heap, value.as.object);
}

/* All of these: NULL or UNDEF when memory ran out. */
csg_string *csg_string_create(csg_heap *heap, const char *text, size_t length);
csg_vector *csg_vector_create(csg_heap *heap, size_t count); /* elements UNDEF */
csg_value csg_range_create(csg_heap *heap, double begin, double step, double end);
/* Retains the function. UNDEF: no memory. */
csg_value csg_rule_value_create(csg_heap *heap, const csg_rule *rule, csg_function *function);
csg_value csg_function_create(csg_heap *heap, const csg_expression *literal, csg_frame *frame);
csg_frame *csg_frame_create(csg_heap *heap, csg_frame *parent, uint32_t count); /* values UNSET */
static inline csg_frame *csg_frame_retain(csg_frame *frame)
{
    if (frame)
        frame->object.references++;
    return frame;
}
static inline void csg_frame_release(csg_heap *heap, csg_frame *frame)
{
    if (frame && --frame->object.references == 0)
        csg_object_release(heap, &frame->object);
}

/* Puts an element (consumed) in its place and keeps the vector's depth right. */
static inline void csg_vector_set(csg_vector *vector, size_t index, csg_value element)
{
    vector->items[index] = element;
    bool nests = element.kind == CSG_VALUE_VECTOR || element.kind == CSG_VALUE_RECORD;
    if (nests && element.as.vector->depth >= vector->depth)
        vector->depth = element.as.vector->depth + 1;
}

/* Of a RECORD: the place of a key among its entries; their number where it is not there. */
uint32_t csg_record_find(csg_value record, const char *key, size_t length);
static inline uint32_t csg_record_count(csg_value record)
{
    return record.as.vector->count / 2;
}

bool csg_value_is_true(csg_value value);
const char *csg_value_kind_name(csg_value value); /* "number": for messages */
/* A list of exactly `count` finite-or-not numbers. */
bool csg_value_numbers(csg_value value, size_t count, double *out);
/* Elements of a range, 0 when it has none; INFINITY when its step is 0 or it never ends. */
double csg_range_count(const csg_range *range);

/* ---- as text ----------------------------------------------------------------------------- */

typedef struct csg_text {
    csg_memory *memory;
    char *data; /* not terminated */
    size_t length, capacity;
    size_t most; /* bytes; 0 = CSG_LONGEST_STRING */
    bool failed; /* memory ran out, or the text grew beyond `most`: too_long */
    bool too_long;
} csg_text;

void csg_text_put(csg_text *text, const char *data, size_t length);
void csg_text_put_string(csg_text *text, const char *data);
void csg_text_reset(csg_text *text);
/* As OpenSCAD prints: six significant digits, strings in quotes when `quoted`. */
void csg_text_put_value(csg_text *text, csg_value value, bool quoted, const csg_symbols *symbols);
void csg_text_put_number(csg_text *text, double number);
/* The expression with every operator in parentheses. */
void csg_text_put_expression(csg_text *text, const csg_expression *expression,
                             const csg_symbols *symbols);

#endif
