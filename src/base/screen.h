/* SPDX-License-Identifier: MIT
 * How text stands on a terminal: characters and the columns that they take. Not the locale's
 * opinion: small tables of Unicode's wide and combining characters.
 */
#ifndef CSG_BASE_SCREEN_H
#define CSG_BASE_SCREEN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct csg_screen_cell {
    uint32_t bytes;   /* >= 1 */
    uint32_t columns; /* 0 for what combines with the character before it, 2 for wide ones */
    bool is_shown;    /* false: a control character or a byte that is no UTF-8; not a tab */
} csg_screen_cell;

/* The character at text; length > 0. A tab is one column here. */
csg_screen_cell csg_screen_cell_at(const char *text, size_t length);
/* The beginning of the character before text[at]; at > 0. */
size_t csg_screen_step_back(const char *text, size_t at);

#endif
