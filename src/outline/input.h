/* SPDX-License-Identifier: MIT
 * What the readers of this folder share: bytes of a file, decimal numbers in text, and one sentence
 * about what is wrong. Sentences name no place; the caller knows file, line and column of the
 * statement that asked.
 */
#ifndef CSG_OUTLINE_INPUT_H
#define CSG_OUTLINE_INPUT_H

#include "shape/plane/outline.h"

/* Largest input, and most points that a reader makes of one: beyond is CSGM_ERR_LIMIT. */
#define CSG_INPUT_MOST_BYTES ((size_t)64 << 20)
#define CSG_INPUT_MOST_POINTS ((size_t)16 << 20)
/* Coordinates beyond are refused: their squares must stay far from overflow. */
#define CSG_INPUT_MOST_COORDINATE 1e15

/* Empty = nothing to say. */
typedef struct csg_problem {
    char text[240];
} csg_problem;

/* The first sentence stays. Returns status, for `return csg_problem_set(...)`. */
csgm_status csg_problem_set(csg_problem *problem, csgm_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

typedef struct csg_bytes {
    csg_memory *memory;
    char *data; /* a zero byte follows the last one */
    size_t size;
} csg_bytes;

/* A whole file. CSGM_ERR_IO (with errno's text), CSGM_ERR_LIMIT, CSGM_ERR_MEMORY. */
csgm_status csg_bytes_read(csg_memory *memory, const char *path, csg_bytes *out,
                           csg_problem *problem);
void csg_bytes_release(csg_bytes *bytes);

/* A decimal number at *at, as SVG, DXF and OpenSCAD's tables write them: sign, digits with or
 * without a point, exponent; no hexadecimal, no words. False, and *at stays: there is none, or it
 * is beyond a double. Text ends at `end` and need not be terminated. */
bool csg_number_scan(const char **at, const char *end, double *out);

static inline bool csg_is_blank(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

#endif
