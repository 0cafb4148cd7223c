/* SPDX-License-Identifier: MIT
 * UTF-8, one character at a time (RFC 3629: no overlong forms, no surrogates, at most U+10FFFF).
 */
#ifndef CSG_BASE_UTF8_H
#define CSG_BASE_UTF8_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Decodes the character that begins at text; returns its bytes, 0 when it is broken or room is 0.
 */
size_t csg_utf8_decode(const char *text, size_t room, uint32_t *character);
/* Writes 1 to 4 bytes; 0 for what is no character. */
size_t csg_utf8_encode(uint32_t character, char out[4]);

static inline size_t csg_utf8_length(const char *text, size_t room)
{
    uint32_t character;
    return csg_utf8_decode(text, room, &character);
}

/* Characters in well-formed text; broken bytes count one each. */
size_t csg_utf8_count(const char *text, size_t length);

#endif
