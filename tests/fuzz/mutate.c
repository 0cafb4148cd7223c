/* SPDX-License-Identifier: MIT
 * A document is scanned into atoms (numbers, and what stands in quotes) and items (elements of XML;
 * values of arrays and members of objects in JSON), and a change exchanges, doubles or drops one of
 * them.
 */
#include "fuzz/mutate.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_SPANS = 1024, MOST_DEPTH = 64 };

typedef struct span {
    size_t begin, end;
} span;

typedef struct document {
    uint8_t *data;
    size_t size, most;
    uint32_t random;
    span atoms[MOST_SPANS], items[MOST_SPANS];
    size_t atom_count, item_count;
    const char *separator; /* of items */
} document;

static uint32_t next(uint32_t *random)
{
    *random ^= *random << 13;
    *random ^= *random >> 17;
    *random ^= *random << 5;
    return *random;
}

static size_t below(document *d, size_t count)
{
    return next(&d->random) % count;
}

static void add(span *spans, size_t *count, size_t begin, size_t end)
{
    if (*count < MOST_SPANS && begin < end)
        spans[(*count)++] = (span){begin, end};
}

static bool is_of_number(uint8_t c)
{
    return isdigit(c) || c == '-' || c == '+' || c == '.' || c == 'e' || c == 'E';
}

/* Beyond a number that begins at `at`, or beyond the quote that closes one: an atom. */
static size_t scan_atom(document *d, size_t at)
{
    size_t end = at;
    if (d->data[at] == '"' || d->data[at] == '\'') {
        for (end = at + 1; end < d->size && d->data[end] != d->data[at]; end++)
            end += d->data[end] == '\\' && end + 1 < d->size;
        end = end < d->size ? end : d->size;
        add(d->atoms, &d->atom_count, at + 1, end);
        return end < d->size ? end + 1 : end;
    }
    while (end < d->size && is_of_number(d->data[end]))
        end++;
    add(d->atoms, &d->atom_count, at, end);
    return end > at ? end : at + 1;
}

static void scan_json(document *d)
{
    size_t begins[MOST_DEPTH], depth = 0;
    for (size_t at = 0; at < d->size;) {
        uint8_t c = d->data[at];
        bool closes = c == ']' || c == '}';
        if (depth && (closes || c == ','))
            add(d->items, &d->item_count, begins[depth - 1], at);
        if ((c == '[' || c == '{') && depth < MOST_DEPTH)
            begins[depth++] = at + 1;
        else if (depth && c == ',')
            begins[depth - 1] = at + 1;
        else if (depth && closes)
            depth--;
        at = c == '"' || isdigit(c) || c == '-' ? scan_atom(d, at) : at + 1;
    }
}

static void scan_xml(document *d)
{
    size_t begins[MOST_DEPTH], depth = 0, at = 0;
    while (at < d->size) {
        if (d->data[at] != '<') {
            at = isdigit(d->data[at]) || d->data[at] == '-' ? scan_atom(d, at) : at + 1;
            continue;
        }
        size_t begin = at++;
        bool ends = at < d->size && d->data[at] == '/';
        while (at < d->size && d->data[at] != '>')
            at = d->data[at] == '"' || d->data[at] == '\'' ? scan_atom(d, at) : at + 1;
        bool alone =
            !ends && at - 1 > begin && (d->data[at - 1] == '/' || d->data[begin + 1] == '?');
        at += at < d->size;
        if (alone)
            add(d->items, &d->item_count, begin, at);
        else if (!ends && depth < MOST_DEPTH)
            begins[depth++] = begin;
        else if (ends && depth)
            add(d->items, &d->item_count, begins[--depth], at);
    }
}

/* Puts other bytes in the place of a span; without the room it stays. */
static void replace(document *d, span old, const void *bytes, size_t size)
{
    if (d->size - (old.end - old.begin) + size > d->most)
        return;
    uint8_t *copy = malloc(size + 1); /* they may be the document's own */
    if (!copy)
        abort();
    memcpy(copy, bytes, size);
    memmove(d->data + old.begin + size, d->data + old.end, d->size - old.end);
    memcpy(d->data + old.begin, copy, size);
    free(copy);
    d->size += size - (old.end - old.begin);
}

static void change_number(document *d, span atom)
{
    static const char *const odd[] = {"0",
                                      "1",
                                      "-1",
                                      "2",
                                      "3",
                                      "0.5",
                                      "255",
                                      "65536",
                                      "5120",
                                      "5126",
                                      "2147483648",
                                      "4294967295",
                                      "4294967296",
                                      "-2147483649",
                                      "9007199254740993",
                                      "18446744073709551616",
                                      "1e308",
                                      "1e-320",
                                      "-0",
                                      "1e999"};
    const char *text = odd[below(d, sizeof odd / sizeof *odd)];
    replace(d, atom, text, strlen(text));
}

/* As bytes, with a little room, and without what would end it. */
static void change_bytes(document *d, span atom)
{
    uint8_t bytes[64];
    size_t size = atom.end - atom.begin;
    if (size > sizeof bytes)
        return;
    memcpy(bytes, d->data + atom.begin, size);
    size = LLVMFuzzerMutate(bytes, size, sizeof bytes);
    for (size_t i = 0; i < size; i++)
        if (strchr("\"'<>&\\{}[],", bytes[i]) || bytes[i] < ' ' || bytes[i] >= 0x7F)
            bytes[i] = 'x';
    replace(d, atom, bytes, size);
}

static void change_atom(document *d)
{
    span atom = d->atoms[below(d, d->atom_count)], other = d->atoms[below(d, d->atom_count)];
    bool quoted = atom.begin && (d->data[atom.begin - 1] == '"' || d->data[atom.begin - 1] == '\'');
    bool like = is_of_number(d->data[atom.begin]) == is_of_number(d->data[other.begin]);
    switch (below(d, 4)) {
    case 0:
    case 1:
        if (!quoted || is_of_number(d->data[atom.begin])) {
            change_number(d, atom);
            return;
        }
        break;
    case 2:
        if (quoted) {
            change_bytes(d, atom);
            return;
        }
        break;
    default:
        break;
    }
    if (quoted || like)
        replace(d, atom, d->data + other.begin, other.end - other.begin);
}

static bool is_separator(const document *d, size_t at)
{
    return *d->separator && at < d->size && d->data[at] == (uint8_t)*d->separator;
}

static void change_item(document *d)
{
    span item = d->items[below(d, d->item_count)], other = d->items[below(d, d->item_count)];
    size_t gap = strlen(d->separator), size = other.end - other.begin;
    uint8_t *bytes;
    switch (below(d, 3)) {
    case 0: /* left out */
        if (is_separator(d, item.end))
            item.end++;
        else if (item.begin && is_separator(d, item.begin - 1))
            item.begin--;
        replace(d, item, "", 0);
        return;
    case 1: /* another one before it */
        bytes = malloc(size + gap + 1);
        if (!bytes)
            abort();
        memcpy(bytes, d->data + other.begin, size);
        memcpy(bytes + size, d->separator, gap);
        replace(d, (span){item.begin, item.begin}, bytes, size + gap);
        free(bytes);
        return;
    default:
        replace(d, item, d->data + other.begin, size);
    }
}

static size_t mutate(void (*scan)(document *), const char *separator, uint8_t *data, size_t size,
                     size_t most, unsigned seed)
{
    document *d = calloc(1, sizeof *d);
    if (!d)
        abort();
    *d = (document){
        .data = data, .size = size, .most = most, .random = 2 * seed + 1, .separator = separator};
    next(&d->random);
    scan(d);
    if (d->item_count && below(d, 3) == 0)
        change_item(d);
    else if (d->atom_count)
        change_atom(d);
    else
        d->size = LLVMFuzzerMutate(data, size, most);
    size = d->size;
    free(d);
    return size;
}

size_t fuzz_mutate_json(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    return mutate(scan_json, ",", data, size, most, seed);
}

size_t fuzz_mutate_xml(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    return mutate(scan_xml, "", data, size, most, seed);
}

/* ---- containers -------------------------------------------------------------------------------- */

enum { GLB_HEADER = 12, CHUNK_HEADER = 8 };

static uint32_t get_u32(const uint8_t *at)
{
    return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static void put_u32(uint8_t *at, size_t value)
{
    for (int i = 0; i < 4; i++)
        at[i] = (uint8_t)(value >> 8 * i);
}

/* The JSON between the headers, padded; what follows it moves along, and lengths are set. */
static size_t mutate_glb_json(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    const size_t begin = GLB_HEADER + CHUNK_HEADER, length = get_u32(data + GLB_HEADER);
    size_t rest = size - begin - length, room = most - begin - rest - 3;
    uint8_t *text = malloc(room > length ? room : length);
    if (!text)
        abort();
    memcpy(text, data + begin, length);
    size_t made = fuzz_mutate_json(text, length, room, seed);
    while (made % 4 && made < room)
        text[made++] = ' ';
    memmove(data + begin + made, data + begin + length, rest);
    memcpy(data + begin, text, made);
    free(text);
    put_u32(data + GLB_HEADER, made);
    put_u32(data + 8, begin + made + rest);
    return begin + made + rest;
}

size_t fuzz_mutate_gltf(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    const size_t begin = GLB_HEADER + CHUNK_HEADER;
    if (size && data[0] == '{' && seed % 16)
        return fuzz_mutate_json(data, size, most, seed / 16);
    if (size <= begin || memcmp(data, "glTF", 4) != 0 || seed % 16 == 0)
        return LLVMFuzzerMutate(data, size, most);
    size_t length = get_u32(data + GLB_HEADER);
    if (length > size - begin || most < size + 8)
        return LLVMFuzzerMutate(data, size, most);
    if (seed % 16 > 5 || size - begin - length <= CHUNK_HEADER)
        return mutate_glb_json(data, size, most, seed / 16);
    uint8_t *binary = data + begin + length + CHUNK_HEADER;
    size_t binary_bytes = size - begin - length - CHUNK_HEADER;
    size_t left = LLVMFuzzerMutate(binary, binary_bytes, binary_bytes);
    memset(binary + left, 0, binary_bytes - left);
    return size;
}

size_t fuzz_mutate_package(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    return size && data[0] == '<' && seed % 16 ? fuzz_mutate_xml(data, size, most, seed / 16)
                                               : LLVMFuzzerMutate(data, size, most);
}

/* Name, version, kind and method of coding; the flags after them are changed like the rest. */
size_t fuzz_mutate_draco(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    enum { KEPT = 9 };
    if (size <= KEPT || seed % 16 == 0)
        return LLVMFuzzerMutate(data, size, most);
    return KEPT + LLVMFuzzerMutate(data + KEPT, size - KEPT, most - KEPT);
}
