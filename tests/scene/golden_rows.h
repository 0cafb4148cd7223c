/* SPDX-License-Identifier: MIT
 * Rows of golden.csv: a table's name, then its columns.
 */
#ifndef TEST_GOLDEN_ROWS_H
#define TEST_GOLDEN_ROWS_H

#include "scene_support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_FIELDS = 12 };

typedef struct row {
    char text[512];
    char *fields[MOST_FIELDS];
    int count;
} row;

/* Splits at commas outside of quotes, in place. */
static inline void golden_split(row *r)
{
    char *out = r->text;
    bool quoted = false;
    r->count = 0;
    r->fields[r->count++] = out;
    for (const char *in = r->text; *in && *in != '\n'; in++) {
        if (*in == '"') {
            quoted = !quoted;
        } else if (*in == ',' && !quoted) {
            *out++ = '\0';
            assert_true(r->count < MOST_FIELDS);
            r->fields[r->count++] = out;
        } else {
            *out++ = *in;
        }
    }
    *out = '\0';
}

static inline double number(const char *text)
{
    char *end;
    double value = strtod(text, &end);
    assert_true(end != text);
    return value;
}

/* Numbers with one character between; how many. */
static inline int split_numbers(const char *text, double *values)
{
    int count = 0;
    for (char *end; *text; text = *end ? end + 1 : end) {
        values[count++] = strtod(text, &end);
        assert_true(end != text);
    }
    return count;
}

static inline csg_vec3 point(const char *text)
{
    csg_vec3 p;
    assert_int_equal(sscanf(text, " ( %lf , %lf , %lf )", &p.x, &p.y, &p.z), 3);
    return p;
}

/* Calls check for each row of the table; the number of rows must be as expected, so that no row
 * is skipped in silence. */
static inline void for_each(const char *table, int expected, void check(const row *r))
{
    FILE *file = fopen(GOLDEN, "r");
    assert_non_null(file);
    row r;
    int found = 0;
    while (fgets(r.text, sizeof r.text, file)) {
        golden_split(&r);
        if (strcmp(r.fields[0], table) != 0)
            continue;
        check(&r);
        found++;
    }
    fclose(file);
    assert_int_equal(found, expected);
}

#endif
