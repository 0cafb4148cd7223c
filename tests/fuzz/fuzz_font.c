/* SPDX-License-Identifier: MIT
 * Any bytes as a font file -> glyphs of a few scripts and directions, and their outlines.
 */
#include <string.h>

#include "fuzz/fuzz_reader.h"
#include "outline/letters/font.h"

static void set(csg_font *font, csg_memory *memory, csg_text_direction direction)
{
    static const uint32_t characters[] = {'A', 'V',   'f',   'i',   0x301, ' ',
                                          '1', 0x3b1, 0x645, 0x631, 0x915, 0x94d};
    csg_glyph *glyphs = NULL;
    size_t count = 0, capacity = 0;
    csg_font_run run = {.characters = characters,
                        .count = sizeof characters / sizeof *characters,
                        .direction = direction};
    csg_outline outline;
    csg_outline_init(&outline, memory);
    csgm_status status = csg_font_shape(font, &run, memory, &glyphs, &count, &capacity);
    for (size_t i = 0; i < count && status == CSGM_OK; i++) {
        csg_box box = csg_font_box(font, glyphs[i].id);
        if (!isfinite(box.min.x) || glyphs[i].character >= run.count)
            fuzz_fail("a glyph out of range", "", 0);
        csg_font_pen pen = {.scale = 1e-4, .shift = {1, 2}, .tolerance = 0.01};
        status = csg_font_outline(font, glyphs[i].id, &pen, &outline);
    }
    if (status == CSGM_OK)
        fuzz_expect_outline(status, &outline);
    csg_outline_release(&outline);
    if (glyphs)
        csg_memory_release(memory, glyphs, capacity * sizeof *glyphs);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    csgm_context context;
    csg_font *font;
    csg_problem problem = {""};
    fuzz_context_init(&context);
    csg_bytes bytes = {&context.memory, csg_memory_alloc(&context.memory, size + 1), size};
    if (bytes.data) {
        memcpy(bytes.data, data, size);
        csgm_status status = csg_font_open(&bytes, 0, &font, &problem);
        fuzz_expect_sentence(status, &problem);
        if (status == CSGM_OK) {
            for (uint32_t c = 0; c < 0x300; c += 7)
                (void)csg_font_has(font, c);
            set(font, &context.memory, CSG_TEXT_LTR);
            set(font, &context.memory, CSG_TEXT_RTL);
            set(font, &context.memory, CSG_TEXT_TTB);
        }
        csg_font_close(font);
    }
    fuzz_context_close(&context);
    return 0;
}
