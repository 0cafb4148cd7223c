/* SPDX-License-Identifier: MIT
 * Instead of bidi.c where FriBidi is missing: a text that runs one way needs no algorithm, and one
 * that runs both ways is refused rather than set wrongly.
 */
#include "outline/letters/bidi.h"
#include "outline/letters/font.h"

csgm_status csg_bidi_levels(csg_arena *scratch, const uint32_t *characters, size_t count,
                            csg_bidi_base base, int *levels, csg_problem *problem)
{
    bool leftwards = false, rightwards = false;
    (void)scratch;
    for (size_t i = 0; i < count; i++) {
        uint32_t script = csg_character_script(characters[i]);
        bool is_rtl = csg_script_is_rtl(script);
        leftwards |= is_rtl;
        rightwards |=
            (script && !is_rtl) || csg_character_kind_of(characters[i]) == CSG_CHARACTER_DIGIT;
    }
    if ((leftwards && (rightwards || base == CSG_BIDI_LTR)) || (rightwards && base == CSG_BIDI_RTL))
        return csg_problem_set(problem, CSGM_ERR_UNSUPPORTED,
                               "this build sets no text that runs in both directions (made without "
                               "FriBidi)");
    for (size_t i = 0; i < count; i++)
        levels[i] = leftwards || base == CSG_BIDI_RTL;
    return CSGM_OK;
}
