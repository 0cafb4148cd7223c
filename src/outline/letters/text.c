/* SPDX-License-Identifier: MIT
 * Glyphs set one after the other, aligned, and drawn; see text.h.
 */
#include "outline/letters/text.h"

#include <stdio.h>
#include <string.h>

#include "outline/letters/text_runs.h"

/* OpenSCAD 2021.01 takes the points of glyphs as 100000ths of the size, their distances as
 * 102400ths. */
static const double distance_factor = 1000.0 / 1024;

typedef struct setter {
    csg_fonts *fonts;
    const csg_text_request *request;
    csg_text_report *report;
    csg_text_runs runs;
    csg_glyph *glyphs;
    size_t *glyph_ends; /* per run */
    size_t glyph_count, glyph_capacity;
    double width, ascent, descent; /* as OpenSCAD aligns by them */
    csg_vec2 advance;
} setter;

static csgm_status shape_runs(setter *s)
{
    csgm_status status = CSGM_OK;
    s->glyph_ends = csg_arena_calloc(&s->runs.arena, s->runs.run_count + 1, sizeof *s->glyph_ends);
    if (!s->glyph_ends)
        return CSGM_ERR_MEMORY;
    for (size_t i = 0; i < s->runs.run_count && status == CSGM_OK; i++) {
        const csg_text_run *run = &s->runs.runs[i];
        csg_font_run font_run = {.characters = s->runs.characters + run->first,
                                 .count = run->count,
                                 .direction = run->direction,
                                 .script = run->script,
                                 .language = s->request->language};
        size_t first = s->glyph_count;
        status = csg_font_shape(run->font, &font_run, csg_fonts_memory(s->fonts), &s->glyphs,
                                &s->glyph_count, &s->glyph_capacity);
        for (size_t g = first; g < s->glyph_count && status == CSGM_OK; g++)
            s->glyphs[g].character += (uint32_t)run->first;
        s->glyph_ends[i] = s->glyph_count;
    }
    return status;
}

/* From a font's numbers to the plane. */
static double scale_of(const setter *s)
{
    return s->request->size / CSG_FONT_SIZE;
}

/* Line ends and the like take no room. */
static bool is_shown(const setter *s, const csg_glyph *glyph)
{
    return csg_character_kind_of(s->runs.characters[glyph->character]) != CSG_CHARACTER_CONTROL;
}

static void measure_glyph(setter *s, const csg_glyph *glyph, csg_font *font)
{
    double scale = scale_of(s) * distance_factor;
    csg_box box = csg_font_box(font, glyph->id);
    s->advance.x += glyph->advance_x * scale * s->request->spacing;
    s->advance.y += glyph->advance_y * scale * s->request->spacing;
    if (s->runs.vertical) {
        s->width = fmax(s->width, (box.max.x - box.min.x) * scale);
    } else {
        s->ascent = fmax(s->ascent, box.max.y * scale);
        s->descent = fmax(s->descent, -box.min.y * scale);
    }
}

static void measure(setter *s)
{
    for (size_t i = 0, g = 0; i < s->runs.run_count; i++)
        for (; g < s->glyph_ends[i]; g++)
            if (is_shown(s, &s->glyphs[g]))
                measure_glyph(s, &s->glyphs[g], s->runs.runs[i].font);
    if (s->runs.vertical)
        s->ascent = s->advance.y;
    else
        s->width = s->advance.x;
}

static csg_vec2 alignment(const setter *s)
{
    csg_vec2 shift = {0, 0};
    if (s->request->halign != CSG_HALIGN_LEFT)
        shift.x = s->request->halign == CSG_HALIGN_RIGHT ? -s->width : -s->width / 2;
    if (s->request->valign == CSG_VALIGN_TOP)
        shift.y = -s->ascent;
    else if (s->request->valign == CSG_VALIGN_CENTER)
        shift.y = (s->descent - s->ascent) / 2;
    else if (s->request->valign == CSG_VALIGN_BOTTOM)
        shift.y = s->descent;
    return shift;
}

static csgm_status draw(setter *s, csg_vec2 origin, csg_outline *out)
{
    csgm_status status = CSGM_OK;
    for (size_t i = 0, g = 0; i < s->runs.run_count; i++)
        for (; g < s->glyph_ends[i] && status == CSGM_OK; g++) {
            const csg_glyph *glyph = &s->glyphs[g];
            csg_font *font = s->runs.runs[i].font;
            double scale = scale_of(s), distance = scale * distance_factor;
            if (!is_shown(s, glyph))
                continue;
            csg_font_pen pen = {.scale = scale,
                                .shift = {origin.x + glyph->offset_x * distance,
                                          origin.y + glyph->offset_y * distance},
                                .pieces = s->request->pieces,
                                .tolerance = s->request->tolerance};
            status = csg_font_outline(font, glyph->id, &pen, out);
            origin.x += glyph->advance_x * distance * s->request->spacing;
            origin.y += glyph->advance_y * distance * s->request->spacing;
        }
    if (status == CSGM_ERR_LIMIT)
        csg_problem_set(&s->report->problem, status, "the text has too many points");
    return status;
}

static void describe(const setter *s, csg_vec2 offset, const csg_outline *out)
{
    csg_text_report *report = s->report;
    csg_box box = csg_outline_box(out);
    report->offset = offset;
    report->advance = s->advance;
    if (out->point_count == 0)
        return;
    report->position = (csg_vec2){box.min.x, box.min.y};
    report->extent = (csg_vec2){box.max.x - box.min.x, box.max.y - box.min.y};
    report->ascent = box.max.y - offset.y;
    report->descent = box.min.y - offset.y;
}

static csgm_status set_text(setter *s, csg_outline *out)
{
    csgm_status status = shape_runs(s);
    if (status == CSGM_OK) {
        measure(s);
        status = draw(s, alignment(s), out);
    }
    if (s->glyphs)
        csg_memory_release(csg_fonts_memory(s->fonts), s->glyphs,
                           s->glyph_capacity * sizeof *s->glyphs);
    if (status == CSGM_OK)
        describe(s, alignment(s), out);
    return status;
}

/* Sizes and spacings that keep coordinates far from overflow. */
static bool is_sane(const csg_text_request *request)
{
    return fabs(request->size) <= 1e9 && fabs(request->spacing) <= 1e6;
}

csgm_status csg_text_outline(csg_fonts *fonts, const csg_text_request *request, csg_outline *out,
                             csg_text_report *report)
{
    setter s = {.fonts = fonts, .request = request, .report = report};
    *report = (csg_text_report){.font = ""};
    csg_outline_init(out, csg_fonts_memory(fonts));
    if (!is_sane(request))
        return csg_problem_set(&report->problem, CSGM_ERR_SCENE,
                               "the size or spacing of the text is not finite or too large");
    csgm_status status = csg_text_runs_make(fonts, request, &s.runs, report);
    if (status != CSGM_OK)
        return status;
    if (request->size != 0)
        status = set_text(&s, out);
    csg_text_runs_release(&s.runs);
    if (status != CSGM_OK)
        csg_outline_release(out);
    return status;
}

csgm_status csg_text_font_metrics(csg_fonts *fonts, const char *font, double size,
                                  csg_font_metrics *out, csg_text_report *report)
{
    csg_font_choice choice;
    *report = (csg_text_report){.font = ""};
    *out = (csg_font_metrics){0};
    csgm_status status = csg_fonts_choose(fonts, font, &choice, &report->problem);
    if (status != CSGM_OK)
        return status;
    memcpy(report->font, choice.name, sizeof report->font);
    report->font_missing = choice.font_missing;
    report->style_missing = choice.style_missing;
    double scale = size / CSG_FONT_SIZE;
    csg_font_metrics m = csg_font_get_metrics(choice.font);
    *out = (csg_font_metrics){m.ascent * scale, m.descent * scale, m.interline * scale,
                              m.top * scale, m.bottom * scale};
    return CSGM_OK;
}
