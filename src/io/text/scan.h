/* SPDX-License-Identifier: MIT
 * Words and numbers of a text file, line by line. No call reads past the end.
 */
#ifndef CSG_IO_SCAN_H
#define CSG_IO_SCAN_H

#include "io/adapter.h"
#include "io/reader.h"

typedef struct csg_text_scan {
    const char *at, *end;
    uint32_t line; /* 1-based */
} csg_text_scan;

csg_text_scan csg_scan_start(const csg_input *input);

/* Blanks but no line ends; a backslash before a line end is a blank. */
void csg_scan_blanks(csg_text_scan *scan);
/* Blanks, line ends, and comments from '#' to the end of their line. */
void csg_scan_space(csg_text_scan *scan);
void csg_scan_skip_line(csg_text_scan *scan); /* through the line's end */
/* After blanks: at a line end, a comment or the end of the file. */
bool csg_scan_at_line_end(csg_text_scan *scan);

/* The next word on this line: its length, 0 at the line's end. */
size_t csg_scan_word(csg_text_scan *scan, const char **word);
/* The rest of the line without the blanks at its ends, '#' and all; the scan stands behind it. */
const char *csg_scan_rest(csg_text_scan *scan, size_t *length);
/* Same letters, in any case on either side. */
bool csg_scan_is(const char *word, size_t length, const char *expected);

/* The next word on this line as a number: false and not moved when it is none. Infinite and NaN are
 * numbers here. */
bool csg_scan_number(csg_text_scan *scan, double *value);
/* As above, whole numbers only. */
bool csg_scan_integer(csg_text_scan *scan, int64_t *value);

#endif
