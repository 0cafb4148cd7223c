/* SPDX-License-Identifier: MIT
 * A formula as a function of the scene language.
 */
#ifndef CSG_SCENE_FORMULA_PRINT_H
#define CSG_SCENE_FORMULA_PRINT_H

#include "scene/formula.h"

/* "function (p) ..."; steps that are used again become variables. False: out of memory. */
bool csg_formula_print(csg_memory *memory, const csg_formula_step *steps, uint32_t count,
                       csgm_text_fn *sink, void *user);

/* A number as short as it reads back exactly. */
void csg_print_number(csgm_text_fn *sink, void *user, double value);

#endif
