/* SPDX-License-Identifier: MIT
 * The scanner of scan.h.
 */
#include "io/text/scan.h"

csg_text_scan csg_scan_start(const csg_input *input)
{
    const char *text = (const char *)input->bytes;
    return (csg_text_scan){text, text + input->size_bytes, 1};
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

static bool continues(const csg_text_scan *s)
{
    return *s->at == '\\' && s->end - s->at >= 2 &&
           (s->at[1] == '\n' || (s->end - s->at >= 3 && s->at[1] == '\r' && s->at[2] == '\n'));
}

void csg_scan_blanks(csg_text_scan *s)
{
    while (s->at < s->end) {
        if (is_blank(*s->at)) {
            s->at++;
        } else if (continues(s)) {
            s->at += s->at[1] == '\n' ? 2 : 3;
            s->line++;
        } else {
            return;
        }
    }
}

void csg_scan_skip_line(csg_text_scan *s)
{
    while (s->at < s->end && *s->at != '\n')
        s->at++;
    if (s->at < s->end) {
        s->at++;
        s->line++;
    }
}

void csg_scan_space(csg_text_scan *s)
{
    while (s->at < s->end) {
        if (*s->at == '\n' || *s->at == '#')
            csg_scan_skip_line(s);
        else if (is_blank(*s->at))
            s->at++;
        else
            return;
    }
}

bool csg_scan_at_line_end(csg_text_scan *s)
{
    csg_scan_blanks(s);
    return s->at == s->end || *s->at == '\n' || *s->at == '#';
}

static bool ends_word(const csg_text_scan *s, const char *at)
{
    return at == s->end || is_blank(*at) || *at == '\n' || *at == '#';
}

size_t csg_scan_word(csg_text_scan *s, const char **word)
{
    csg_scan_blanks(s);
    *word = s->at;
    while (!ends_word(s, s->at))
        s->at++;
    return (size_t)(s->at - *word);
}

const char *csg_scan_rest(csg_text_scan *s, size_t *length)
{
    csg_scan_blanks(s);
    const char *begin = s->at, *end;
    while (s->at < s->end && *s->at != '\n')
        s->at++;
    for (end = s->at; end > begin && is_blank(end[-1]);)
        end--;
    *length = (size_t)(end - begin);
    return begin;
}

static char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c + 'a' - 'A') : c;
}

bool csg_scan_is(const char *word, size_t length, const char *expected)
{
    for (size_t i = 0; i < length; i++)
        if (!expected[i] || lower(word[i]) != lower(expected[i]))
            return false;
    return expected[length] == '\0';
}

bool csg_scan_number(csg_text_scan *s, double *value)
{
    csg_scan_blanks(s);
    const char *after = csg_number_parse(s->at, s->end, value);
    if (!after || !ends_word(s, after))
        return false;
    s->at = after;
    return true;
}

bool csg_scan_integer(csg_text_scan *s, int64_t *value)
{
    csg_scan_blanks(s);
    const char *at = s->at;
    bool negative = at < s->end && *at == '-';
    at += at < s->end && (*at == '-' || *at == '+');
    const char *first = at;
    int64_t magnitude = 0;
    for (; at < s->end && *at >= '0' && *at <= '9' && magnitude < INT64_MAX / 100; at++)
        magnitude = 10 * magnitude + (*at - '0');
    if (at == first || !ends_word(s, at))
        return false;
    *value = negative ? -magnitude : magnitude;
    s->at = at;
    return true;
}
