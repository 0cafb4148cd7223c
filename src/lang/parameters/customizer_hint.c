/* SPDX-License-Identifier: MIT
 * The comment behind a parameter, as OpenSCAD's customizer reads it:
 *
 *   hint = number | '[' item {',' item} ']'          and nothing behind it
 *   item = atom [':' atom [':' atom]]
 *   atom = number | "string" | words without , : [ ]
 *
 * One item of two or three numbers is a range, a lone number in brackets a maximum, a lone number
 * without a step; of a string both are its greatest length. Else the items are choices, each a
 * value and its label.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lang/parameters/customizer.h"

typedef struct atom {
    const char *text; /* terminated, unescaped, trimmed */
    bool is_number;
    double number;
} atom;

typedef struct hint {
    csg_arena *arena;
    const char *at, *end;
    bool no_memory;
    atom *atoms;
    uint32_t atom_count;
    uint32_t *item_ends; /* index behind the last atom of each item */
    uint32_t item_count;
} hint;

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

static void skip_blanks(hint *h)
{
    while (h->at < h->end && is_blank(*h->at))
        h->at++;
}

static bool accept(hint *h, char c)
{
    skip_blanks(h);
    bool there = h->at < h->end && *h->at == c;
    h->at += there;
    return there;
}

static bool add_atom(hint *h, atom made)
{
    atom *place = made.text
                      ? csg_arena_push(h->arena, (void **)&h->atoms, &h->atom_count, sizeof made)
                      : NULL;
    h->no_memory = h->no_memory || !place;
    if (place)
        *place = made;
    return place != NULL;
}

static bool take_quoted(hint *h)
{
    char *text = csg_arena_alloc(h->arena, (size_t)(h->end - h->at) + 1);
    size_t length = 0;
    h->no_memory = h->no_memory || !text;
    while (text && h->at < h->end && *h->at != '"') {
        if (*h->at == '\\' && h->at + 1 < h->end)
            h->at++;
        text[length++] = *h->at++;
    }
    if (!text || h->at == h->end)
        return false;
    h->at++;
    text[length] = '\0';
    return add_atom(h, (atom){.text = text});
}

/* No hexadecimal, infinite or not-a-number text, which strtod would take. */
static bool is_number(const char *text, double *out)
{
    char *after;
    if (!*text || text[strspn(text, "+-.0123456789eE")] != '\0' || *text == 'e' || *text == 'E')
        return false;
    *out = strtod(text, &after);
    return *after == '\0' && after != text && isfinite(*out);
}

static bool take_atom(hint *h)
{
    if (accept(h, '"'))
        return take_quoted(h);
    const char *begin = h->at;
    while (h->at < h->end && !strchr(",:[]", *h->at))
        h->at++;
    const char *end = h->at;
    while (end > begin && is_blank(end[-1]))
        end--;
    if (end == begin)
        return false;
    atom made = {.text = csg_arena_strndup(h->arena, begin, (size_t)(end - begin))};
    made.is_number = made.text && is_number(made.text, &made.number);
    return add_atom(h, made);
}

static bool take_item(hint *h)
{
    bool good = take_atom(h);
    while (good && accept(h, ':'))
        good = take_atom(h);
    uint32_t *place =
        good ? csg_arena_push(h->arena, (void **)&h->item_ends, &h->item_count, sizeof *place)
             : NULL;
    h->no_memory = h->no_memory || (good && !place);
    if (place)
        *place = h->atom_count;
    return place != NULL;
}

static bool take_list(hint *h)
{
    bool good = take_item(h);
    while (good && accept(h, ','))
        good = take_item(h);
    good = good && accept(h, ']');
    skip_blanks(h);
    return good && h->at == h->end;
}

/* ---- what it means ------------------------------------------------------------------------ */

static bool all_numbers(const hint *h)
{
    for (uint32_t i = 0; i < h->atom_count; i++)
        if (!h->atoms[i].is_number)
            return false;
    return true;
}

static uint32_t length_from(double number)
{
    return number >= 1 && number <= UINT32_MAX ? (uint32_t)number : 0;
}

static void take_range(const hint *h, csgm_param *param)
{
    uint32_t last = h->atom_count - 1;
    if (param->initial.kind == CSGM_PARAM_STRING)
        return;
    param->minimum = h->atoms[0].number;
    param->maximum = h->atoms[last].number;
    if (last == 2)
        param->step = h->atoms[1].number;
}

static void take_maximum(double number, csgm_param *param)
{
    if (param->initial.kind == CSGM_PARAM_STRING)
        param->length_most = length_from(number);
    else
        param->maximum = number;
}

static bool take_choices(hint *h, csgm_param *param)
{
    bool text_only = param->initial.kind == CSGM_PARAM_STRING;
    uint32_t first = 0;
    if (param->initial.kind == CSGM_PARAM_VECTOR)
        return true;
    for (uint32_t i = 0; i < h->item_count; first = h->item_ends[i++])
        if (h->item_ends[i] - first > 2)
            return true; /* a:b:c is neither a choice nor a range */
    csgm_param_choice *choices = csg_arena_calloc(h->arena, h->item_count, sizeof *choices);
    first = 0;
    for (uint32_t i = 0; choices && i < h->item_count; first = h->item_ends[i++]) {
        const atom *value = &h->atoms[first], *label = &h->atoms[h->item_ends[i] - 1];
        choices[i].label = label->text;
        choices[i].value = (csgm_param_value){.kind = CSGM_PARAM_STRING, .text = value->text};
        if (value->is_number && !text_only)
            choices[i].value = (csgm_param_value){
                .kind = CSGM_PARAM_NUMBER, .numbers = &value->number, .number_count = 1};
    }
    param->choices = choices;
    param->choice_count = choices ? h->item_count : 0;
    return choices != NULL;
}

static bool take_lone_number(hint *h, csgm_param *param)
{
    if (!take_atom(h))
        return !h->no_memory;
    skip_blanks(h);
    if (h->at < h->end || !h->atoms[0].is_number)
        return true;
    if (param->initial.kind == CSGM_PARAM_STRING)
        param->length_most = length_from(h->atoms[0].number);
    else
        param->step = h->atoms[0].number;
    return true;
}

bool csg_customizer_take_hint(csg_arena *arena, const char *text, size_t length, csgm_param *param)
{
    hint h = {.arena = arena, .at = text, .end = text + length};
    if (param->initial.kind == CSGM_PARAM_BOOLEAN)
        return true;
    if (!accept(&h, '['))
        return take_lone_number(&h, param);
    if (!take_list(&h))
        return !h.no_memory;
    bool numbers = h.item_count == 1 && all_numbers(&h);
    if (numbers && h.atom_count == 1)
        take_maximum(h.atoms[0].number, param);
    else if (numbers && h.atom_count <= 3)
        take_range(&h, param);
    else
        return take_choices(&h, param);
    return true;
}
