/* SPDX-License-Identifier: MIT
 * A formula as a function of the scene language.
 */
#ifndef CSG_SCENE_FORMULA_PRINT_H
#define CSG_SCENE_FORMULA_PRINT_H

#include "base/context.h"
#include "scene/formula/step.h"

/* The words for x, y and z, and for the parameters that they come from; or the list that all
 * variables are items of. */
typedef struct csg_formula_words {
    const char *parameters, *coordinates[3], *list;
} csg_formula_words;

/* "function (p) ..."; steps that are used again become variables. False: out of memory. */
bool csg_formula_print(csg_memory *memory, const csg_formula_step *steps, uint32_t count,
                       const csg_formula_words *words, csgm_text_fn *sink, void *user);

/* A number as short as it reads back exactly. */
void csg_print_number(csgm_text_fn *sink, void *user, double value);

#endif
