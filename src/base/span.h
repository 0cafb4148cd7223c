/* SPDX-License-Identifier: MIT
 * A place in a source text, as numbers: scenes carry it without knowing of texts.
 */
#ifndef CSG_BASE_SPAN_H
#define CSG_BASE_SPAN_H

#include <stdint.h>

/* source: index into the sources of a compilation (text/source.h), UINT32_MAX = nowhere. */
typedef struct csg_span {
    uint32_t source, offset, length;
} csg_span;

static inline csg_span csg_span_nowhere(void)
{
    return (csg_span){UINT32_MAX, 0, 0};
}

#endif
