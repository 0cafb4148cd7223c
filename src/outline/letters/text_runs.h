/* SPDX-License-Identifier: MIT
 * Characters -> runs of one font, script and direction, in the order of sight.
 */
#ifndef CSG_OUTLINE_TEXT_RUNS_H
#define CSG_OUTLINE_TEXT_RUNS_H

#include "outline/letters/fonts.h"
#include "outline/letters/text_request.h"

typedef struct csg_text_run {
    size_t first, count; /* of the characters */
    csg_font *font;
    uint32_t script;
    csg_text_direction direction;
    int level; /* odd = from right to left */
} csg_text_run;

typedef struct csg_text_runs {
    csg_arena arena;
    uint32_t *characters;
    csg_text_run *runs;
    size_t character_count, run_count;
    bool vertical;
} csg_text_runs;

/* Fills in what the report says of fonts and characters. Released by the caller on CSGM_OK only. */
csgm_status csg_text_runs_make(csg_fonts *fonts, const csg_text_request *request,
                               csg_text_runs *out, csg_text_report *report);
void csg_text_runs_release(csg_text_runs *runs);

#endif
