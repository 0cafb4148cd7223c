/* SPDX-License-Identifier: MIT
 * What a printer hands over piece by piece, as one terminated text.
 */
#ifndef TEST_COLLECTED_TEXT_H
#define TEST_COLLECTED_TEXT_H

#include <stdlib.h>
#include <string.h>

typedef struct text {
    char *data; /* the test's to free */
    size_t length, capacity;
} text;

static inline void collect(void *user, const char *piece, size_t length)
{
    text *t = user;
    if (t->length + length + 1 > t->capacity) {
        t->capacity = 2 * (t->length + length + 1);
        t->data = realloc(t->data, t->capacity);
        if (!t->data)
            abort();
    }
    memcpy(t->data + t->length, piece, length);
    t->length += length;
    t->data[t->length] = '\0';
}

#endif
