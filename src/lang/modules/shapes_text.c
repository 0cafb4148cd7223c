/* SPDX-License-Identifier: MIT
 * text(): a figure of the letters' outlines (outline/letters/text.h); textmetrics() and
 * fontmetrics(), its measures. What font stands for one that is missing, and what characters no
 * font has, is told.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/scene_codes.h"
#include "lang/evaluate/files.h"
#include "lang/modules/shapes.h"
#include "outline/letters/text.h"

enum { TEXT, SIZE, FONT, DIRECTION, LANGUAGE, SCRIPT, HALIGN, VALIGN, SPACING };

/* The place of a string among names; `otherwise` and a warning when it is none of them. */
static int choose(csg_module_call *call, uint32_t index, const char *const *names, int count,
                  int otherwise)
{
    char hint[120] = "";
    csg_value value = call->values[index];
    if (!csg_has_argument(call, index))
        return otherwise;
    for (int i = 0; value.kind == CSG_VALUE_STRING && i < count; i++)
        if (strcmp(value.as.string->text, names[i]) == 0)
            return i;
    for (int i = 0; i < count; i++)
        snprintf(hint + strlen(hint), sizeof hint - strlen(hint), "%s\"%s\"", i ? ", " : "it is ",
                 names[i]);
    csg_eval_report(call->e, CSG_DIAG_BAD_ARGUMENT, call->spans[index], hint,
                    "text() knows no such %s, \"%s\" is taken", call->parameters[index].name,
                    names[otherwise]);
    return otherwise;
}

static const char *string_of(const csg_module_call *call, uint32_t index)
{
    return call->values[index].kind == CSG_VALUE_STRING ? call->values[index].as.string->text
                                                        : NULL;
}

/* The fonts of this evaluation, with the files that the scene uses; NULL when memory ran out. */
static csg_fonts *open_fonts(csg_module_call *call)
{
    csg_eval *e = call->e;
    if (e->fonts)
        return e->fonts;
    if (csg_fonts_create(e->heap.memory, &e->fonts) != CSGM_OK) {
        csg_eval_no_memory(e);
        return NULL;
    }
    for (uint32_t i = 0; i < e->program->font_count; i++) {
        csg_problem problem = {""};
        csgm_status status = csg_fonts_add_file(e->fonts, e->program->fonts[i], &problem);
        if (status != CSGM_OK)
            csg_eval_report(e, CSG_DIAG_FONT_REPLACED, call->statement->where, problem.text,
                            "the font file '%.120s' cannot be used", e->program->fonts[i]);
    }
    return e->fonts;
}

static csg_text_request read_request(csg_module_call *call)
{
    static const char *const directions[] = {"ltr", "rtl", "ttb", "btt"};
    static const char *const across[] = {"left", "center", "right"};
    static const char *const along[] = {"baseline", "bottom", "center", "top"};
    csg_value text = call->values[TEXT];
    csg_text_request request = {.font = string_of(call, FONT),
                                .language = string_of(call, LANGUAGE),
                                .script = string_of(call, SCRIPT)};
    if (text.kind == CSG_VALUE_STRING) {
        request.text = text.as.string->text;
        request.length = text.as.string->length;
    } else {
        csg_argument_error(call, TEXT, CSG_DIAG_BAD_TYPE, "text must be a string, not %s%s",
                           text.kind == CSG_VALUE_UNDEF ? "" : "a ", csg_value_kind_name(text));
    }
    request.size = csg_argument_number(call, SIZE, 10, CSG_POSITIVE);
    request.spacing = csg_argument_number(call, SPACING, 1, CSG_ANY);
    request.halign = (csg_halign)choose(call, HALIGN, across, 3, 0);
    request.valign = (csg_valign)choose(call, VALIGN, along, 4, 0);
    if (csg_has_argument(call, DIRECTION))
        request.direction =
            (csg_text_direction)(CSG_TEXT_LTR + choose(call, DIRECTION, directions, 4, 0));
    const csg_facet_rule rule = csg_facet_rule_now(call->e);
    if (rule.exact) /* OpenSCAD's number for a curve of a letter */
        request.pieces = (int)fmax(csg_fragments(&rule, request.size) / 8 + 1, 2);
    request.tolerance = request.size * 1e-4;
    return request;
}

static void tell(csg_module_call *call, const csg_text_report *report)
{
    csg_eval *e = call->e;
    csg_span where = call->spans[csg_has_argument(call, FONT) ? FONT : TEXT];
    if (report->missing_count)
        csg_eval_report(e, CSG_DIAG_GLYPH_MISSING, call->spans[TEXT], NULL,
                        "no font has %zu of these characters, the first is U+%04X",
                        report->missing_count, (unsigned)report->missing[0]);
    if (report->font_missing)
        csg_eval_report(e, CSG_DIAG_FONT_REPLACED, where, NULL,
                        "this font is not installed, \"%s\" is taken", report->font);
    else if (report->style_missing)
        csg_eval_report(e, CSG_DIAG_FONT_REPLACED, where, NULL,
                        "this font has no such style, \"%s\" is taken", report->font);
    else if (report->other[0])
        csg_eval_report(e, CSG_DIAG_FONT_REPLACED, where, NULL,
                        "\"%s\" lacks %zu characters, they come from \"%s\"", report->font,
                        report->lent, report->other);
}

/* Fonts are files that the scene reads, found by name or not. */
static void depend_on_fonts(csg_module_call *call, const csg_fonts *fonts)
{
    csg_eval *e = call->e;
    const char *path;
    for (size_t i = 0; (path = csg_fonts_file(fonts, i)) && !e->stop; i++) {
        const char *copy = csg_arena_strndup(&e->program->arena, path, strlen(path));
        if (copy)
            csg_file_depend(e, copy);
        else
            csg_eval_no_memory(e);
    }
}

/* False: told, or stopped. */
static bool set_text(csg_module_call *call, csg_outline *out, csg_text_report *report)
{
    csg_eval *e = call->e;
    csg_text_request request = read_request(call);
    if (call->failed)
        return false;
    csg_fonts *fonts = open_fonts(call);
    if (!fonts || !csg_eval_charge(e, 10 + 10 * request.length, call->statement->where))
        return false;
    csgm_status status = csg_text_outline(fonts, &request, out, report);
    if (status == CSGM_ERR_MEMORY) {
        csg_eval_no_memory(e);
        return false;
    }
    if (status != CSGM_OK) {
        csg_argument_error(
            call, csg_has_argument(call, FONT) ? FONT : TEXT, CSG_DIAG_BAD_IMPORT, "%s",
            report->problem.text[0] ? report->problem.text : "this build has no library for fonts");
        return false;
    }
    tell(call, report);
    depend_on_fonts(call, fonts);
    return true;
}

csg_node_id csg_module_text(csg_module_call *call)
{
    csg_text_report report = {0};
    csg_outline outline;
    if (!set_text(call, &outline, &report))
        return csg_shape_empty(call);
    if (outline.loop_count)
        return csg_shape_area(call, &outline, false);
    csg_outline_release(&outline);
    return csg_shape_empty(call); /* no text, or blanks: OpenSCAD says nothing either */
}

/* ---- measures -------------------------------------------------------------------------------- */

static void put_number(const csg_function_call *call, csg_list *list, const char *key, double value)
{
    csg_record_put(call->e, list, key, csg_value_number(value), call->where);
}

static void put_pair(const csg_function_call *call, csg_list *list, const char *key, csg_vec2 value)
{
    csg_list pair = {0};
    csg_list_push(call->e, &pair, csg_value_number(value.x), call->where);
    csg_list_push(call->e, &pair, csg_value_number(value.y), call->where);
    csg_record_put(call->e, list, key, csg_list_finish(call->e, &pair), call->where);
}

static void put_text(const csg_function_call *call, csg_list *list, const char *key,
                     const char *text, size_t length)
{
    csg_record_put(call->e, list, key, csg_eval_string(call->e, text, length), call->where);
}

csg_value csg_function_textmetrics(const csg_function_call *call)
{
    const csg_statement place = {.where = call->where};
    csg_module_call text = {.e = call->e, .name = call->name, .statement = &place};
    csg_text_report report = {0};
    csg_outline outline;
    csg_list list = {0};
    csg_module_call_of_function(&text, call, "text", 0);
    if (!set_text(&text, &outline, &report))
        return csg_value_undef();
    csg_outline_release(&outline);
    put_pair(call, &list, "position", report.position);
    put_pair(call, &list, "size", report.extent);
    put_number(call, &list, "ascent", report.ascent);
    put_number(call, &list, "descent", report.descent);
    put_pair(call, &list, "offset", report.offset);
    put_pair(call, &list, "advance", report.advance);
    return csg_record_finish(call->e, &list);
}

static void put_heights(const csg_function_call *call, csg_list *list, const char *key, double up,
                        double down)
{
    csg_list inner = {0};
    put_number(call, &inner, "ascent", up);
    put_number(call, &inner, "descent", down);
    csg_record_put(call->e, list, key, csg_record_finish(call->e, &inner), call->where);
}

/* "Family:style=Bold" is both names. */
static void put_names(const csg_function_call *call, csg_list *list, const char *font)
{
    csg_list names = {0};
    const char *colon = strchr(font, ':'), *style = strstr(font, "style=");
    style = style ? style + strlen("style=") : "Regular";
    put_text(call, &names, "family", font, colon ? (size_t)(colon - font) : strlen(font));
    put_text(call, &names, "style", style, strcspn(style, ":"));
    csg_record_put(call->e, list, "font", csg_record_finish(call->e, &names), call->where);
}

csg_value csg_function_fontmetrics(const csg_function_call *call)
{
    enum { ITS_SIZE, ITS_FONT };
    const csg_statement place = {.where = call->where};
    csg_module_call text = {.e = call->e, .name = call->name, .statement = &place};
    csg_text_report report = {0};
    csg_font_metrics metrics;
    csg_list list = {0};
    csg_module_call_of_function(&text, call, "text", 1);
    double size = csg_argument_number(&text, ITS_SIZE, 10, CSG_POSITIVE);
    csg_fonts *fonts = text.failed ? NULL : open_fonts(&text);
    if (!fonts)
        return csg_value_undef();
    csgm_status status =
        csg_text_font_metrics(fonts, string_of(&text, ITS_FONT), size, &metrics, &report);
    if (status == CSGM_ERR_MEMORY)
        csg_eval_no_memory(call->e);
    else if (status != CSGM_OK)
        csg_argument_error(&text, ITS_FONT, CSG_DIAG_BAD_IMPORT, "%s",
                           report.problem.text[0] ? report.problem.text
                                                  : "this build has no library for fonts");
    if (status != CSGM_OK)
        return csg_value_undef();
    depend_on_fonts(&text, fonts);
    put_heights(call, &list, "nominal", metrics.ascent, metrics.descent);
    put_heights(call, &list, "max", metrics.top, metrics.bottom);
    put_number(call, &list, "interline", metrics.interline);
    put_names(call, &list, report.font);
    return csg_record_finish(call->e, &list);
}
