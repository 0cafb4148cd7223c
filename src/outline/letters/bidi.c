/* SPDX-License-Identifier: MIT
 * Directions by FriBidi; the only file that knows it. Its own memory is not of the budget: some
 * bytes per run.
 */
#include "outline/letters/bidi.h"

#include <fribidi.h>

_Static_assert(FRIBIDI_BIDI_MAX_RESOLVED_LEVELS - 1 <= CSG_BIDI_MOST_LEVEL, "levels fit");

csgm_status csg_bidi_levels(csg_arena *scratch, const uint32_t *characters, size_t count,
                            csg_bidi_base base, int *levels, csg_problem *problem)
{
    static const FriBidiParType types[] = {FRIBIDI_PAR_ON, FRIBIDI_PAR_LTR, FRIBIDI_PAR_RTL};
    FriBidiParType type = types[base];
    FriBidiStrIndex length = (FriBidiStrIndex)count;
    if (!count)
        return CSGM_OK;
    FriBidiCharType *kinds = csg_arena_alloc(scratch, count * sizeof *kinds);
    FriBidiBracketType *brackets = csg_arena_alloc(scratch, count * sizeof *brackets);
    FriBidiLevel *found = csg_arena_alloc(scratch, count * sizeof *found);
    if (!kinds || !brackets || !found)
        return CSGM_ERR_MEMORY;
    fribidi_get_bidi_types(characters, length, kinds);
    fribidi_get_bracket_types(characters, length, kinds, brackets);
    /* the second call sets blanks at the end to the level of the whole (rule L1) */
    if (!fribidi_get_par_embedding_levels_ex(kinds, brackets, length, &type, found) ||
        !fribidi_reorder_line(FRIBIDI_FLAGS_DEFAULT, kinds, length, 0, type, found, NULL, NULL))
        return CSGM_ERR_MEMORY;
    for (size_t i = 0; i < count; i++)
        levels[i] = found[i];
    return CSGM_OK;
}
