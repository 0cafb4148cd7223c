/* SPDX-License-Identifier: MIT
 * A blend as scenes hold it. Which kinds there are: blend_kinds.h, which only those include who ask
 * for one by name, so that a row of operators.def does not rebuild everything.
 */
#ifndef CSG_SCENE_BLEND_H
#define CSG_SCENE_BLEND_H

#include <stdbool.h>
#include <stdint.h>

/* A blend with its parameter n of operators.md section 2 (w of section 12 for ROUND). Of a rule n
 * is its index among the rules of the scene or of the builder. */
typedef struct csg_blend {
    uint32_t kind; /* csg_blend_kind */
    double n; /* > 0; 0 for SHARP and ORTHOGONAL. HYPERBOLA and RECIPROCAL: area, else length */
} csg_blend;

/* max and min, the first kind. */
#define CSG_SHARP ((csg_blend){0, 0})

static inline bool csg_blend_is_sharp(uint32_t kind)
{
    return kind == 0;
}

#endif
