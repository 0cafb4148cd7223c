/* SPDX-License-Identifier: MIT
 * Fonts by FreeType (outlines) and HarfBuzz (which glyph goes where); the only file that knows
 * them. FreeType scales and hints glyphs for the one size that OpenSCAD asks it for: fonts round
 * their em to whole pixels there, a 15000th, and some put their bars on pixels; so letters are
 * OpenSCAD's to the last bit. FreeType's memory comes from the budget.
 */
#include "outline/letters/font.h"

#include <ft2build.h>
#include <hb-ot.h>
#include <hb.h>
#include <math.h>
#include <string.h>
#include FT_FREETYPE_H
#include FT_MODULE_H
#include FT_OUTLINE_H

#include "base/sized_block.h"

enum { dots_per_inch = 100 };

struct csg_font {
    csg_memory *memory;
    csg_bytes bytes;
    struct FT_MemoryRec_ allocator;
    FT_Library library;
    FT_Face face;
    hb_font_t *shaper;
    bool starved; /* FreeType lacked memory for a glyph */
};

/* ---- FreeType's memory --------------------------------------------------------------------- */

static void *ft_allocate(FT_Memory memory, long size)
{
    csg_font *font = memory->user;
    return size > 0 ? csg_sized_block_alloc(font->memory, (size_t)size) : NULL;
}

static void ft_release(FT_Memory memory, void *pointer)
{
    csg_font *font = memory->user;
    csg_sized_block_release(font->memory, pointer);
}

static void *ft_reallocate(FT_Memory memory, long before, long after, void *pointer)
{
    void *fresh = ft_allocate(memory, after);
    if (fresh && pointer) {
        memcpy(fresh, pointer, (size_t)(before < after ? before : after));
        ft_release(memory, pointer);
    }
    return fresh;
}

/* ---- opening ------------------------------------------------------------------------------ */

static csgm_status open_face(csg_font *font, unsigned index, csg_problem *problem)
{
    FT_Error error = FT_New_Library(&font->allocator, &font->library);
    if (error)
        return CSGM_ERR_MEMORY;
    FT_Add_Default_Modules(font->library);
    error = FT_New_Memory_Face(font->library, (const FT_Byte *)font->bytes.data,
                               (FT_Long)font->bytes.size, (FT_Long)index, &font->face);
    if (error == FT_Err_Out_Of_Memory)
        return CSGM_ERR_MEMORY;
    if (error || !FT_IS_SFNT(font->face) || !FT_IS_SCALABLE(font->face))
        return csg_problem_set(problem, CSGM_ERR_FORMAT,
                               "it is no TrueType or OpenType font, or a broken one");
    if (font->face->units_per_EM < 16 || font->face->units_per_EM > 16384)
        return csg_problem_set(problem, CSGM_ERR_FORMAT, "the font is broken: %d units to the em",
                               font->face->units_per_EM);
    error = FT_Set_Char_Size(font->face, 0, CSG_FONT_SIZE, dots_per_inch, dots_per_inch);
    if (error == FT_Err_Out_Of_Memory)
        return CSGM_ERR_MEMORY;
    if (error)
        return csg_problem_set(problem, CSGM_ERR_FORMAT, "the font is broken: it has no size");
    return CSGM_OK;
}

/* An em as FreeType scales it, before rounding to pixels; distances of letters go by it. */
static int em_of(const csg_font *font, FT_Fixed scale)
{
    return (int)FT_MulFix(font->face->units_per_EM, scale);
}

static csgm_status open_shaper(csg_font *font, unsigned index)
{
    hb_blob_t *blob = hb_blob_create(font->bytes.data, (unsigned)font->bytes.size,
                                     HB_MEMORY_MODE_READONLY, NULL, NULL);
    hb_face_t *face = hb_face_create(blob, index & 0xffff);
    font->shaper = hb_font_create(face);
    const FT_Size_Metrics *size = &font->face->size->metrics;
    hb_font_set_scale(font->shaper, em_of(font, size->x_scale), em_of(font, size->y_scale));
    if (index >> 16)
        hb_font_set_var_named_instance(font->shaper, (index >> 16) - 1);
    hb_face_destroy(face);
    hb_blob_destroy(blob);
    return font->shaper == hb_font_get_empty() ? CSGM_ERR_MEMORY : CSGM_OK;
}

csgm_status csg_font_open(csg_bytes *bytes, unsigned index, csg_font **out, csg_problem *problem)
{
    csg_font *font = csg_memory_alloc(bytes->memory, sizeof *font);
    *out = NULL;
    if (!font) {
        csg_bytes_release(bytes);
        return CSGM_ERR_MEMORY;
    }
    *font = (csg_font){.memory = bytes->memory, .bytes = *bytes};
    font->allocator = (struct FT_MemoryRec_){font, ft_allocate, ft_release, ft_reallocate};
    *bytes = (csg_bytes){.memory = font->memory};
    csgm_status status = open_face(font, index, problem);
    if (status == CSGM_OK)
        status = open_shaper(font, index);
    if (status == CSGM_OK)
        *out = font;
    else
        csg_font_close(font);
    return status;
}

void csg_font_close(csg_font *font)
{
    if (!font)
        return;
    hb_font_destroy(font->shaper);
    if (font->face)
        FT_Done_Face(font->face);
    if (font->library)
        FT_Done_Library(font->library);
    csg_bytes_release(&font->bytes);
    csg_memory_release(font->memory, font, sizeof *font);
}

bool csg_font_has(const csg_font *font, uint32_t character)
{
    hb_codepoint_t glyph;
    return hb_font_get_nominal_glyph(font->shaper, character, &glyph) && glyph != 0;
}

csg_font_metrics csg_font_get_metrics(const csg_font *font)
{
    const FT_FaceRec *face = font->face;
    double scale = CSG_FONT_SIZE * (dots_per_inch / 72.0) / face->units_per_EM;
    return (csg_font_metrics){.ascent = face->ascender * scale,
                              .descent = face->descender * scale,
                              .interline = face->height * scale,
                              .top = (double)face->bbox.yMax * scale,
                              .bottom = (double)face->bbox.yMin * scale};
}

/* ---- characters -------------------------------------------------------------------------- */

csg_character_kind csg_character_kind_of(uint32_t character)
{
    if (character < 0x20 || (character >= 0x7f && character < 0xa0))
        return CSG_CHARACTER_CONTROL;
    switch (hb_unicode_general_category(hb_unicode_funcs_get_default(), character)) {
    case HB_UNICODE_GENERAL_CATEGORY_FORMAT:
        return CSG_CHARACTER_INVISIBLE;
    case HB_UNICODE_GENERAL_CATEGORY_DECIMAL_NUMBER:
        return CSG_CHARACTER_DIGIT;
    case HB_UNICODE_GENERAL_CATEGORY_NON_SPACING_MARK:
    case HB_UNICODE_GENERAL_CATEGORY_SPACING_MARK:
    case HB_UNICODE_GENERAL_CATEGORY_ENCLOSING_MARK:
        if ((character >= 0xfe00 && character <= 0xfe0f) || character >= 0xe0100)
            return CSG_CHARACTER_INVISIBLE; /* selectors of variants */
        return CSG_CHARACTER_MARK;
    case HB_UNICODE_GENERAL_CATEGORY_SPACE_SEPARATOR:
        return CSG_CHARACTER_BLANK;
    default:
        return CSG_CHARACTER_PLAIN;
    }
}

uint32_t csg_character_script(uint32_t character)
{
    hb_script_t script = hb_unicode_script(hb_unicode_funcs_get_default(), character);
    bool neutral =
        script == HB_SCRIPT_COMMON || script == HB_SCRIPT_INHERITED || script == HB_SCRIPT_UNKNOWN;
    return neutral ? 0 : (uint32_t)script;
}

bool csg_script_is_rtl(uint32_t script)
{
    return script && hb_script_get_horizontal_direction((hb_script_t)script) == HB_DIRECTION_RTL;
}

uint32_t csg_script_of_name(const char *name)
{
    hb_script_t script = name && *name ? hb_script_from_string(name, -1) : HB_SCRIPT_INVALID;
    return script == HB_SCRIPT_UNKNOWN || script == HB_SCRIPT_COMMON ? 0 : (uint32_t)script;
}

static bool load(csg_font *font, uint32_t glyph, FT_Int32 hinting)
{
    FT_Error error = FT_Load_Glyph(font->face, glyph, hinting | FT_LOAD_NO_BITMAP);
    font->starved |= error == FT_Err_Out_Of_Memory;
    return !error && font->face->glyph->format == FT_GLYPH_FORMAT_OUTLINE;
}

/* As OpenSCAD draws it; a glyph whose program fails is drawn without it. */
static bool load_hinted(csg_font *font, uint32_t glyph)
{
    return load(font, glyph, FT_LOAD_DEFAULT) || load(font, glyph, FT_LOAD_NO_HINTING);
}

/* ---- shaping ------------------------------------------------------------------------------- */

static hb_direction_t direction_of(csg_text_direction direction)
{
    static const hb_direction_t directions[] = {
        HB_DIRECTION_LTR, HB_DIRECTION_LTR, HB_DIRECTION_RTL, HB_DIRECTION_TTB, HB_DIRECTION_BTT};
    return directions[direction];
}

static bool take_glyphs(hb_buffer_t *buffer, csg_memory *memory, csg_glyph **glyphs, size_t *count,
                        size_t *capacity)
{
    unsigned added;
    const hb_glyph_info_t *infos = hb_buffer_get_glyph_infos(buffer, &added);
    const hb_glyph_position_t *positions = hb_buffer_get_glyph_positions(buffer, NULL);
    void *data = *glyphs;
    if (!csg_memory_reserve(memory, &data, capacity, *count + added + 1, sizeof **glyphs))
        return false;
    *glyphs = data;
    for (unsigned i = 0; i < added; i++)
        (*glyphs)[(*count)++] = (csg_glyph){.id = infos[i].codepoint,
                                            .character = infos[i].cluster,
                                            .advance_x = positions[i].x_advance,
                                            .advance_y = positions[i].y_advance,
                                            .offset_x = positions[i].x_offset,
                                            .offset_y = positions[i].y_offset};
    return true;
}

/* Fonts without vertical metrics get FreeType's: glyphs are centred in a height of the typographic
 * ascent and descent. HarfBuzz has other ones. */
static void set_vertical_metrics(csg_font *font, csg_glyph *glyphs, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (load(font, glyphs[i].id, FT_LOAD_NO_HINTING)) {
            const FT_Glyph_Metrics *m = &font->face->glyph->metrics;
            glyphs[i].advance_y = -(double)m->vertAdvance;
            glyphs[i].offset_y = -(double)(m->horiBearingY + m->vertBearingY);
        }
}

csgm_status csg_font_shape(csg_font *font, const csg_font_run *run, csg_memory *memory,
                           csg_glyph **glyphs, size_t *count, size_t *capacity)
{
    hb_buffer_t *buffer = hb_buffer_create();
    const char *language = run->language && *run->language ? run->language : "en";
    bool vertical = run->direction == CSG_TEXT_TTB || run->direction == CSG_TEXT_BTT;
    size_t first = *count;
    hb_buffer_add_codepoints(buffer, run->characters, (int)run->count, 0, (int)run->count);
    hb_buffer_set_direction(buffer, direction_of(run->direction));
    hb_buffer_set_language(buffer, hb_language_from_string(language, -1));
    if (run->script)
        hb_buffer_set_script(buffer, (hb_script_t)run->script);
    hb_buffer_guess_segment_properties(buffer); /* what is not set: the script */
    hb_shape(font->shaper, buffer, NULL, 0);
    bool done = hb_buffer_allocation_successful(buffer) &&
                take_glyphs(buffer, memory, glyphs, count, capacity);
    hb_buffer_destroy(buffer);
    if (done && vertical && !FT_HAS_VERTICAL(font->face))
        set_vertical_metrics(font, *glyphs + first, *count - first);
    return done ? CSGM_OK : CSGM_ERR_MEMORY;
}

/* ---- outlines ------------------------------------------------------------------------------- */

typedef struct tracer {
    csg_outline *out;
    const csg_font_pen *pen;
    csg_vec2 now;
    csgm_status status;
} tracer;

static csg_vec2 to_plane(const tracer *t, const FT_Vector *v)
{
    const csg_font_pen *pen = t->pen;
    return (csg_vec2){(double)v->x * pen->scale + pen->shift.x,
                      (double)v->y * pen->scale + pen->shift.y};
}

static int end_stroke(tracer *t, csg_vec2 to, bool done)
{
    t->now = to;
    if (!done)
        t->status = CSGM_ERR_MEMORY;
    else if (t->out->point_count > CSG_INPUT_MOST_POINTS)
        t->status = CSGM_ERR_LIMIT;
    return t->status != CSGM_OK;
}

static int move_to(const FT_Vector *to, void *user)
{
    tracer *t = user;
    csg_vec2 point = to_plane(t, to);
    return end_stroke(t, point, csg_outline_close(t->out) && csg_outline_add(t->out, point));
}

static int line_to(const FT_Vector *to, void *user)
{
    tracer *t = user;
    csg_vec2 point = to_plane(t, to);
    return end_stroke(t, point, csg_outline_add(t->out, point));
}

static int conic_to(const FT_Vector *control, const FT_Vector *to, void *user)
{
    tracer *t = user;
    csg_vec2 point = to_plane(t, to), by = to_plane(t, control);
    int pieces = t->pen->pieces;
    return end_stroke(t, point,
                      pieces ? csg_outline_quadratic_in_pieces(t->out, t->now, by, point, pieces)
                             : csg_outline_quadratic(t->out, t->now, by, point, t->pen->tolerance));
}

static int cubic_to(const FT_Vector *control1, const FT_Vector *control2, const FT_Vector *to,
                    void *user)
{
    tracer *t = user;
    csg_vec2 point = to_plane(t, to), by1 = to_plane(t, control1), by2 = to_plane(t, control2);
    int pieces = t->pen->pieces;
    return end_stroke(t, point,
                      pieces
                          ? csg_outline_cubic_in_pieces(t->out, t->now, by1, by2, point, pieces)
                          : csg_outline_cubic(t->out, t->now, by1, by2, point, t->pen->tolerance));
}

/* TrueType's outer loops run clockwise. */
static void reverse_loops(csg_outline *out, size_t first_loop)
{
    for (size_t loop = first_loop; loop < out->loop_count; loop++)
        for (size_t i = csg_outline_first(out, loop), j = out->ends[loop]; i + 1 < j; i++) {
            csg_vec2 other = out->points[--j];
            out->points[j] = out->points[i];
            out->points[i] = other;
        }
}

csgm_status csg_font_outline(csg_font *font, uint32_t glyph, const csg_font_pen *pen,
                             csg_outline *out)
{
    static const FT_Outline_Funcs functions = {move_to, line_to, conic_to, cubic_to, 0, 0};
    tracer t = {.out = out, .pen = pen};
    size_t first = out->loop_count;
    bool loaded = load_hinted(font, glyph), starved = font->starved;
    font->starved = false;
    if (starved)
        return CSGM_ERR_MEMORY;
    if (!loaded)
        return CSGM_OK;
    FT_Outline *outline = &font->face->glyph->outline;
    FT_Outline_Decompose(outline, &functions, &t);
    if (t.status != CSGM_OK)
        return t.status;
    if (!csg_outline_close(out))
        return CSGM_ERR_MEMORY;
    if (FT_Outline_Get_Orientation(outline) == FT_ORIENTATION_TRUETYPE)
        reverse_loops(out, first);
    return CSGM_OK;
}

csg_box csg_font_box(csg_font *font, uint32_t glyph)
{
    FT_BBox box = {0, 0, 0, 0};
    if (load_hinted(font, glyph))
        FT_Outline_Get_CBox(&font->face->glyph->outline, &box);
    return (csg_box){{64 * floor((double)box.xMin / 64), 64 * floor((double)box.yMin / 64), 0},
                     {64 * ceil((double)box.xMax / 64), 64 * ceil((double)box.yMax / 64), 0}};
}
