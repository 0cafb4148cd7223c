/* SPDX-License-Identifier: MIT
 * Codes of findings about texts and scenes. Only who reports one includes this, so that a row of
 * the table does not rebuild everything.
 */
#ifndef CSG_BASE_SCENE_CODES_H
#define CSG_BASE_SCENE_CODES_H

enum {
#define CSG_DIAG(name, number, severity, summary) CSG_DIAG_##name = (number),
#include "base/scene_codes.def"
#undef CSG_DIAG
};

#endif
