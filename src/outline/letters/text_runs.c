/* SPDX-License-Identifier: MIT
 * Runs of text; see text_runs.h. Levels are those of the Unicode bidirectional algorithm (bidi.h);
 * fonts and scripts divide its runs, and its rule L2 puts them in order.
 */
#include "outline/letters/text_runs.h"

#include <string.h>

#include "base/utf8.h"
#include "outline/letters/bidi.h"

typedef struct character {
    csg_font *font;
    uint32_t script;
    int level;
} character;

typedef struct maker {
    csg_fonts *fonts;
    const csg_text_request *request;
    csg_text_runs *out;
    csg_text_report *report;
    csg_font *primary;
    character *traits;
} maker;

static bool decode(maker *m)
{
    const char *text = m->request->text;
    size_t length = m->request->length;
    csg_text_runs *out = m->out;
    out->characters = csg_arena_calloc(&out->arena, length + 1, sizeof *out->characters);
    m->traits = csg_arena_calloc(&out->arena, length + 1, sizeof *m->traits);
    if (!out->characters || !m->traits)
        return false;
    for (size_t at = 0; at < length;) {
        uint32_t c;
        size_t bytes = csg_utf8_decode(text + at, length - at, &c);
        out->characters[out->character_count++] = bytes ? c : 0xfffd;
        at += bytes ? bytes : 1;
    }
    return true;
}

/* ---- scripts and levels ------------------------------------------------------------------- */

static void set_scripts(maker *m)
{
    size_t count = m->out->character_count;
    uint32_t asked = csg_script_of_name(m->request->script), script = asked;
    for (size_t i = 0; i < count; i++) {
        uint32_t own = asked ? asked : csg_character_script(m->out->characters[i]);
        script = own ? own : script;
        m->traits[i].script = script;
    }
    for (size_t i = count; i-- > 0;) { /* what stands before the first of a script is of it too */
        if (!m->traits[i].script)
            m->traits[i].script = script;
        script = m->traits[i].script;
    }
}

/* A direction that was asked for is that of all characters, as in OpenSCAD. */
static csgm_status set_levels(maker *m)
{
    size_t count = m->out->character_count;
    csg_text_direction asked = m->request->direction;
    uint32_t script = csg_script_of_name(m->request->script);
    csg_bidi_base base = csg_script_is_rtl(script) ? CSG_BIDI_RTL : CSG_BIDI_BY_TEXT;
    int *levels = csg_arena_calloc(&m->out->arena, count + 1, sizeof *levels);
    if (!levels)
        return CSGM_ERR_MEMORY;
    csgm_status status = CSGM_OK;
    if (asked == CSG_TEXT_AUTO)
        status = csg_bidi_levels(&m->out->arena, m->out->characters, count, base, levels,
                                 &m->report->problem);
    for (size_t i = 0; i < count; i++)
        m->traits[i].level = asked == CSG_TEXT_AUTO ? levels[i] : asked == CSG_TEXT_RTL;
    return status;
}

/* ---- fonts ---------------------------------------------------------------------------------- */

static void note_missing(csg_text_report *report, uint32_t c)
{
    size_t known = report->missing_count < CSG_TEXT_MOST_MISSING ? report->missing_count
                                                                 : CSG_TEXT_MOST_MISSING;
    for (size_t i = 0; i < known; i++)
        if (report->missing[i] == c)
            return;
    if (known < CSG_TEXT_MOST_MISSING)
        report->missing[known] = c;
    report->missing_count++;
}

static csgm_status borrow(maker *m, size_t i)
{
    csg_font_choice choice;
    uint32_t c = m->out->characters[i];
    csgm_status status =
        csg_fonts_choose_for(m->fonts, m->request->font, c, &choice, &m->report->problem);
    if (status != CSGM_OK)
        return status;
    m->traits[i].font = choice.font ? choice.font : m->primary;
    if (!choice.font) {
        note_missing(m->report, c);
        return CSGM_OK;
    }
    if (m->report->lent++ == 0)
        memcpy(m->report->other, choice.name, sizeof m->report->other);
    return CSGM_OK;
}

static csgm_status set_fonts(maker *m)
{
    csgm_status status = CSGM_OK;
    csg_font *before = m->primary;
    for (size_t i = 0; i < m->out->character_count && status == CSGM_OK; i++) {
        uint32_t c = m->out->characters[i];
        csg_character_kind kind = csg_character_kind_of(c);
        m->traits[i].font = m->primary;
        if (kind == CSG_CHARACTER_CONTROL)
            note_missing(m->report, c);
        else if (kind == CSG_CHARACTER_INVISIBLE ||
                 ((kind == CSG_CHARACTER_MARK || kind == CSG_CHARACTER_BLANK) &&
                  csg_font_has(before, c)))
            m->traits[i].font = before;
        else if (!csg_font_has(m->primary, c))
            status = borrow(m, i);
        before = m->traits[i].font;
    }
    return status;
}

/* ---- runs ------------------------------------------------------------------------------------ */

static bool belong_together(const character *a, const character *b)
{
    return a->font == b->font && a->script == b->script && a->level == b->level;
}

static bool make_runs(maker *m)
{
    csg_text_runs *out = m->out;
    size_t count = out->character_count;
    out->runs = csg_arena_calloc(&out->arena, count + 1, sizeof *out->runs);
    if (!out->runs)
        return false;
    for (size_t i = 0; i < count; i++) {
        const character *c = &m->traits[i];
        if (i == 0 || !belong_together(c - 1, c)) {
            csg_text_direction direction = m->request->direction;
            if (direction == CSG_TEXT_AUTO)
                direction = c->level & 1 ? CSG_TEXT_RTL : CSG_TEXT_LTR;
            out->runs[out->run_count++] = (csg_text_run){.first = i,
                                                         .font = c->font,
                                                         .script = c->script,
                                                         .direction = direction,
                                                         .level = c->level};
        }
        out->runs[out->run_count - 1].count++;
    }
    return true;
}

static void reverse(csg_text_run *runs, size_t count)
{
    for (size_t i = 0; i < count / 2; i++) {
        csg_text_run other = runs[i];
        runs[i] = runs[count - 1 - i];
        runs[count - 1 - i] = other;
    }
}

/* Rule L2 of UAX #9. */
static void order_runs(csg_text_runs *out, csg_text_direction direction)
{
    if (direction == CSG_TEXT_BTT)
        reverse(out->runs, out->run_count);
    if (out->vertical)
        return;
    int highest = 0;
    for (size_t i = 0; i < out->run_count; i++)
        highest = out->runs[i].level > highest ? out->runs[i].level : highest;
    for (int level = highest; level >= 1; level--)
        for (size_t i = 0; i < out->run_count;) {
            size_t end = i;
            while (end < out->run_count && out->runs[end].level >= level)
                end++;
            reverse(out->runs + i, end - i);
            i = end + 1;
        }
}

static csgm_status choose_primary(maker *m)
{
    csg_font_choice choice;
    csgm_status status = csg_fonts_choose(m->fonts, m->request->font, &choice, &m->report->problem);
    if (status != CSGM_OK)
        return status;
    m->primary = choice.font;
    memcpy(m->report->font, choice.name, sizeof m->report->font);
    m->report->font_missing = choice.font_missing;
    m->report->style_missing = choice.style_missing;
    return CSGM_OK;
}

csgm_status csg_text_runs_make(csg_fonts *fonts, const csg_text_request *request,
                               csg_text_runs *out, csg_text_report *report)
{
    maker m = {.fonts = fonts, .request = request, .out = out, .report = report};
    *out = (csg_text_runs){.vertical = request->direction == CSG_TEXT_TTB ||
                                       request->direction == CSG_TEXT_BTT};
    csg_arena_init(&out->arena, csg_fonts_memory(fonts));
    if (request->length > 4 * (size_t)CSG_TEXT_MOST_CHARACTERS)
        return csg_problem_set(&report->problem, CSGM_ERR_LIMIT,
                               "the text has more than %d characters", CSG_TEXT_MOST_CHARACTERS);
    csgm_status status = choose_primary(&m);
    if (status == CSGM_OK && !decode(&m))
        status = CSGM_ERR_MEMORY;
    if (status == CSGM_OK) {
        set_scripts(&m);
        status = set_levels(&m);
    }
    if (status == CSGM_OK)
        status = set_fonts(&m);
    if (status == CSGM_OK && !make_runs(&m))
        status = CSGM_ERR_MEMORY;
    if (status == CSGM_OK)
        order_runs(out, request->direction);
    else
        csg_text_runs_release(out);
    return status;
}

void csg_text_runs_release(csg_text_runs *runs)
{
    csg_arena_reset(&runs->arena);
}
