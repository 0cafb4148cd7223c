/* SPDX-License-Identifier: MIT
 * A scene's formula as steps of a tape.
 */
#ifndef CSG_FIELD_COMPILE_FORMULA_H
#define CSG_FIELD_COMPILE_FORMULA_H

#include "field/tape.h"

/* Steps appended to *out (from memory; caller's array). False: out of memory. */
bool csg_formula_compile(csg_memory *memory, const csg_formula_step *steps,
                         const csg_formula *formula, csg_tape_step **out, size_t *count,
                         size_t *capacity, csg_tape_formula *compiled);

#endif
