/* SPDX-License-Identifier: MIT
 * What the targets of the readers of drawings, heights and fonts share.
 */
#ifndef TESTS_FUZZ_READER_H
#define TESTS_FUZZ_READER_H

#include <math.h>

#include "fuzz/fuzz.h"
#include "outline/input.h"

/* A refusal says why; memory is enough, and its lack needs no sentence. */
static inline void fuzz_expect_sentence(csgm_status status, const csg_problem *problem)
{
    if (status != CSGM_OK && status != CSGM_ERR_MEMORY && !problem->text[0])
        fuzz_fail("refused without a word", "", 0);
}

/* Loops end in order, have three points or more, all finite. */
static inline void fuzz_expect_outline(csgm_status status, const csg_outline *outline)
{
    size_t first = 0;
    if (status != CSGM_OK && outline->point_count)
        fuzz_fail("an outline in spite of an error", "", 0);
    for (size_t loop = 0; loop < outline->loop_count; loop++) {
        if (outline->ends[loop] < first + 3 || outline->ends[loop] > outline->point_count)
            fuzz_fail("a loop of fewer than 3 points", "", 0);
        first = outline->ends[loop];
    }
    for (size_t i = 0; i < outline->point_count; i++)
        if (!isfinite(outline->points[i].x) || !isfinite(outline->points[i].y))
            fuzz_fail("a point that is not finite", "", 0);
}

#endif
