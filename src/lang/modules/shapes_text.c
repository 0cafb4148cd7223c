/* SPDX-License-Identifier: MIT
 * text(): a figure of the letters' outlines (outline/letters/text.h). What font stands for one that
 * is missing, and what characters no font has, is told.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/scene_codes.h"
#include "lang/modules/imports.h"
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
    csg_eval_report(call->e, CSG_DIAG_UNKNOWN_ARGUMENT, call->spans[index], hint,
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
            csg_import_depend(e, copy);
        else
            csg_eval_no_memory(e);
    }
}

csg_node_id csg_module_text(csg_module_call *call)
{
    csg_eval *e = call->e;
    csg_text_report report = {0};
    csg_outline outline;
    csg_text_request request = read_request(call);
    if (call->failed)
        return csg_shape_empty(call);
    csg_fonts *fonts = open_fonts(call);
    if (!fonts || !csg_eval_charge(e, 10 + 10 * request.length, call->statement->where))
        return CSG_NODE_NONE;
    csgm_status status = csg_text_outline(fonts, &request, &outline, &report);
    if (status == CSGM_ERR_MEMORY) {
        csg_eval_no_memory(e);
        return CSG_NODE_NONE;
    }
    if (status != CSGM_OK) {
        csg_argument_error(
            call, csg_has_argument(call, FONT) ? FONT : TEXT, CSG_DIAG_BAD_IMPORT, "%s",
            report.problem.text[0] ? report.problem.text : "this build has no library for fonts");
        return csg_shape_empty(call);
    }
    tell(call, &report);
    depend_on_fonts(call, fonts);
    if (outline.loop_count)
        return csg_shape_area(call, &outline, false);
    csg_outline_release(&outline);
    return csg_shape_empty(call); /* no text, or blanks: OpenSCAD says nothing either */
}
