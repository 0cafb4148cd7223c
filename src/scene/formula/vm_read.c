/* SPDX-License-Identifier: MIT
 * Lines of a .vm tape -> steps of a formula; see vm.h. Names are looked up in a hash table of where
 * they stand in the text.
 */
#include "scene/formula/terms.h"
#include "scene/formula/vm.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_WORDS = 4, LONGEST_NUMBER = 63 };

#define DEGREE 0.017453292519943295

typedef struct word {
    const char *text;
    size_t length;
} word;

typedef struct entry {
    word name;
    csg_term term;
} entry;

typedef struct reader {
    csg_terms *t;
    csg_vm_problem *problem;
    entry *names;
    size_t name_count, name_room;
    csg_table table; /* of the names */
    csgm_status status;
} reader;

static void fail(reader *r, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void fail(reader *r, const char *format, ...)
{
    va_list arguments;
    if (r->status != CSGM_OK)
        return;
    r->status = CSGM_ERR_FORMAT;
    va_start(arguments, format);
    vsnprintf(r->problem->text, sizeof r->problem->text, format, arguments);
    va_end(arguments);
}

/* As much of a word as a message has room for. */
static int shown(word w)
{
    return w.length < 40 ? (int)w.length : 40;
}

/* ---- names ------------------------------------------------------------------------------------
 */

static uint64_t hash_name(const void *names, uint32_t number)
{
    const word *name = &((const entry *)names)[number].name;
    return csg_hash_bytes(CSG_HASH_START, name->text, name->length);
}

/* The number of this name, or CSG_TABLE_NONE and the slot to put one at. */
static uint32_t find_name(const reader *r, word name, size_t *slot)
{
    uint64_t hash = csg_hash_bytes(CSG_HASH_START, name.text, name.length);
    for (uint32_t i = csg_table_first(&r->table, hash, slot); i != CSG_TABLE_NONE;
         i = csg_table_next(&r->table, slot)) {
        word other = r->names[i].name;
        if (other.length == name.length && memcmp(other.text, name.text, name.length) == 0)
            return i;
    }
    return CSG_TABLE_NONE;
}

static void add_name(reader *r, word name, csg_term term)
{
    size_t slot;
    if (!csg_table_reserve(&r->table, r->name_count + 1, hash_name, r->names) ||
        !csg_memory_reserve(r->t->memory, (void **)&r->names, &r->name_room, r->name_count + 1,
                            sizeof *r->names)) {
        r->status = CSGM_ERR_MEMORY;
        return;
    }
    if (find_name(r, name, &slot) != CSG_TABLE_NONE) {
        fail(r, "a line above is named '%.*s' too", shown(name), name.text);
        return;
    }
    r->names[r->name_count] = (entry){name, term};
    csg_table_put(&r->table, slot, (uint32_t)r->name_count++);
}

static csg_term operand(reader *r, word name)
{
    size_t slot;
    uint32_t found = r->name_count ? find_name(r, name, &slot) : CSG_TABLE_NONE;
    if (found != CSG_TABLE_NONE)
        return r->names[found].term;
    fail(r, "no line above is named '%.*s'", shown(name), name.text);
    return CSG_FORMULA_NONE;
}

/* ---- operations --------------------------------------------------------------------------------
 */

static csg_term compare(csg_terms *t, csg_term a, csg_term b)
{
    csg_term steep = csg_term_mul_number(t, csg_term_sub(t, a, b), CSG_STEP_SLOPE);
    return csg_term_clamp(t, steep, -1, 1);
}

/* 1 unless a is 0. */
static csg_term is_set(csg_terms *t, csg_term a, csg_term b)
{
    (void)b;
    return csg_term_step(t, csg_term_abs(t, a));
}

static csg_term not(csg_terms * t, csg_term a, csg_term b)
{
    return csg_term_number_sub(t, 1, is_set(t, a, b));
}

static csg_term both(csg_terms *t, csg_term a, csg_term b)
{
    return csg_term_mul(t, b, is_set(t, a, a));
}

static csg_term either(csg_terms *t, csg_term a, csg_term b)
{
    return csg_term_add(t, a, csg_term_mul(t, b, not(t, a, a)));
}

static csg_term square(csg_terms *t, csg_term a, csg_term b)
{
    (void)b;
    return csg_term_square(t, a);
}

static csg_term recip(csg_terms *t, csg_term a, csg_term b)
{
    (void)b;
    return csg_term_div(t, csg_term_number(t, 1), a);
}

static csg_term ceiling(csg_terms *t, csg_term a, csg_term b)
{
    (void)b;
    return csg_term_neg(t, csg_term_floor(t, csg_term_neg(t, a)));
}

static csg_term nearest(csg_terms *t, csg_term a, csg_term b)
{
    (void)b;
    return csg_term_floor(t, csg_term_add_number(t, a, 0.5));
}

/* Never negative. */
static csg_term mod(csg_terms *t, csg_term a, csg_term b)
{
    csg_term size = csg_term_abs(t, b);
    csg_term whole = csg_term_floor(t, csg_term_div(t, a, size));
    return csg_term_sub(t, a, csg_term_mul(t, size, whole));
}

static csg_term power(csg_terms *t, csg_term a, csg_term b)
{
    return csg_term_of(t, CSG_FORMULA_POW, a, b);
}

/* Odd roots of negative numbers are negative. */
static csg_term root(csg_terms *t, csg_term a, csg_term b)
{
    if (a == CSG_FORMULA_NONE || b == CSG_FORMULA_NONE)
        return CSG_FORMULA_NONE;
    const csg_formula_step *degree = &t->steps[b];
    bool odd = degree->op == CSG_FORMULA_CONSTANT && fabs(fmod(degree->constant, 2)) == 1;
    csg_term exponent = csg_term_div(t, csg_term_number(t, 1), b);
    if (!odd)
        return power(t, a, exponent);
    csg_term size = power(t, csg_term_abs(t, a), exponent);
    return csg_term_mul(t, compare(t, a, csg_term_number(t, 0)), size);
}

typedef csg_term compose(csg_terms *t, csg_term a, csg_term b);

static const struct {
    const char *name;
    int arity, unit;
    csg_formula_op op;
    compose *composed; /* or NULL: op */
} ops[] = {
#define CSG_VM_OP(name, arity, OP, unit) {name, arity, unit, CSG_FORMULA_##OP, NULL},
#include "scene/formula/vm.def"
#undef CSG_VM_OP
    {"square", 1, 0, CSG_FORMULA_MUL, square},  {"recip", 1, 0, CSG_FORMULA_DIV, recip},
    {"ceil", 1, 0, CSG_FORMULA_FLOOR, ceiling}, {"round", 1, 0, CSG_FORMULA_FLOOR, nearest},
    {"not", 1, 0, CSG_FORMULA_MIN, not },       {"compare", 2, 0, CSG_FORMULA_SUB, compare},
    {"mod", 2, 0, CSG_FORMULA_SUB, mod},        {"and", 2, 0, CSG_FORMULA_MUL, both},
    {"or", 2, 0, CSG_FORMULA_ADD, either},      {"pow", 2, 0, CSG_FORMULA_POW, power},
    {"nth-root", 2, 0, CSG_FORMULA_POW, root},
};

static csg_term apply(reader *r, size_t row, csg_term a, csg_term b)
{
    csg_terms *t = r->t;
    if (ops[row].arity == 0)
        return csg_formula_apply(t, ops[row].op, 0, 0);
    if (ops[row].composed)
        return ops[row].composed(t, a, b);
    if (ops[row].unit == 1)
        a = csg_term_mul_number(t, a, 1 / DEGREE);
    csg_term made = csg_term_of(t, ops[row].op, a, ops[row].arity > 1 ? b : a);
    return ops[row].unit == 2 ? csg_term_mul_number(t, made, DEGREE) : made;
}

/* ---- lines -------------------------------------------------------------------------------------
 */

static csg_term constant(reader *r, word number)
{
    char text[LONGEST_NUMBER + 1] = "", *end = text;
    if (number.length <= LONGEST_NUMBER) {
        memcpy(text, number.text, number.length);
        text[number.length] = '\0';
    }
    double value = strtod(text, &end);
    if (end == text || *end)
        fail(r, "'%.*s' is no number", shown(number), number.text);
    else if (!isfinite(value))
        fail(r, "the number '%.*s' is not finite", shown(number), number.text);
    return r->status == CSGM_OK ? csg_term_number(r->t, value) : CSG_FORMULA_NONE;
}

static bool is_word(word w, const char *text)
{
    return strlen(text) == w.length && memcmp(text, w.text, w.length) == 0;
}

/* words: name, operation, operands. */
static csg_term step(reader *r, const word *words, size_t count)
{
    csg_term operands[2] = {0, 0};
    size_t row = 0, rows = sizeof ops / sizeof *ops, wanted = 1;
    bool number = is_word(words[1], "const");
    while (!number && row < rows && !is_word(words[1], ops[row].name))
        row++;
    if (!number && row == rows) {
        fail(r, "there is no operation '%.*s'", shown(words[1]), words[1].text);
        return CSG_FORMULA_NONE;
    }
    wanted = number ? 1 : (size_t)ops[row].arity;
    if (count != wanted + 2) {
        fail(r, "%.*s takes %zu operand%s, not %zu", shown(words[1]), words[1].text, wanted,
             wanted == 1 ? "" : "s", count - 2);
        return CSG_FORMULA_NONE;
    }
    if (number)
        return constant(r, words[2]);
    for (size_t i = 0; i < wanted; i++)
        operands[i] = operand(r, words[2 + i]);
    return r->status == CSGM_OK ? apply(r, row, operands[0], operands[1]) : CSG_FORMULA_NONE;
}

static void take_line(reader *r, const word *words, size_t count, csg_term *last)
{
    if (count < 2) {
        fail(r, "a line needs a name and an operation");
        return;
    }
    csg_term made = step(r, words, count);
    if (r->status != CSGM_OK)
        return;
    if (made == CSG_FORMULA_NONE) {
        if (r->t->too_long)
            fail(r, "it has more than %zu operations", r->t->most);
        else
            r->status = CSGM_ERR_MEMORY;
        return;
    }
    add_name(r, words[0], made);
    *last = made;
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

/* Words of the line; one more than MOST_WORDS where there are more. */
static size_t split(const char *text, size_t length, word *words)
{
    size_t count = 0, i = 0;
    while (i < length) {
        while (i < length && is_blank(text[i]))
            i++;
        size_t first = i;
        while (i < length && !is_blank(text[i]))
            i++;
        if (i > first && count < MOST_WORDS)
            words[count] = (word){text + first, i - first};
        count += i > first;
        if (count > MOST_WORDS || (count == 1 && words[0].text[0] == '#'))
            break;
    }
    return count;
}

csgm_status csg_vm_read(csg_terms *terms, const char *text, size_t length, csg_term *result,
                        csg_vm_problem *problem)
{
    reader r = {
        .t = terms, .problem = problem, .table = {.memory = terms->memory}, .status = CSGM_OK};
    *problem = (csg_vm_problem){0, ""};
    *result = CSG_FORMULA_NONE;
    for (size_t at = 0; at < length && r.status == CSGM_OK;) {
        word words[MOST_WORDS];
        const char *end = memchr(text + at, '\n', length - at);
        size_t line = end ? (size_t)(end - text) - at : length - at;
        size_t count = split(text + at, line, words);
        problem->line++;
        if (count && words[0].text[0] != '#')
            take_line(&r, words, count, result);
        at += line + 1;
    }
    csg_table_release(&r.table);
    csg_memory_release(terms->memory, r.names, r.name_room * sizeof *r.names);
    if (r.status != CSGM_OK)
        return r.status;
    problem->line = 0;
    if (*result == CSG_FORMULA_NONE)
        fail(&r, "it has no steps");
    else if ((*result = csg_term_neg(terms, *result)) == CSG_FORMULA_NONE)
        r.status = CSGM_ERR_MEMORY;
    return r.status;
}
