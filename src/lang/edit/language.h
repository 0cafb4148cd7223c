/* SPDX-License-Identifier: MIT
 * What the language itself defines, in the words of the manual: modules.def and functions.def.
 */
#ifndef CSG_LANG_LANGUAGE_H
#define CSG_LANG_LANGUAGE_H

#include "base/memory.h"
#include "csgmesh/editing.h"

/* Name and kind of the row; NULL: there are no more. */
const char *csg_language_row(uint32_t row, csgm_name_kind *kind);
/* One more parameter of a name's signature, between these bytes of it. False: no memory. */
bool csg_signature_add(csg_arena *arena, csgm_name *name, size_t begin, size_t end);
/* Fills in signature and documentation (Markdown), in the arena. False: no memory. */
bool csg_language_describe(csg_arena *arena, uint32_t row, csgm_name *out);
/* The parameter of a row by its position, with its words; NULL: it has none there. */
const char *csg_language_parameter(csg_arena *arena, uint32_t row, uint32_t index,
                                   const char **documentation);

#endif
