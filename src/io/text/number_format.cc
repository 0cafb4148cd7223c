/* SPDX-License-Identifier: MIT
 * Numbers to shortest round-trip text and back: std::to_chars and std::from_chars, which no locale
 * touches. printf is much slower and does not give the shortest text.
 */
#include "io/adapter.h"

#include <charconv>
#include <cmath>
#include <system_error>

char *csg_number_put_float(char *text, float value)
{
    return std::to_chars(text, text + CSG_NUMBER_MOST, value).ptr;
}

char *csg_number_put_double(char *text, double value)
{
    return std::to_chars(text, text + CSG_NUMBER_MOST, value).ptr;
}

char *csg_number_put_u64(char *text, uint64_t value)
{
    return std::to_chars(text, text + CSG_NUMBER_MOST, value).ptr;
}

char *csg_number_put_fixed(char *text, double value, int decimals)
{
    char *end =
        std::to_chars(text, text + CSG_FIXED_MOST, value, std::chars_format::fixed, decimals).ptr;
    if (decimals > 0) {
        while (end[-1] == '0')
            end--;
        end -= end[-1] == '.';
    }
    if (end == text + 2 && text[0] == '-' && text[1] == '0')
        *--end = '\0', text[0] = '0'; /* -0 */
    return end;
}

/* from_chars leaves the value alone when out of range: 1e999 and 1e-999 differ in the sign of the
 * exponent after the first 'e', or in the place of the point. */
static double out_of_range(const char *text, const char *end)
{
    bool negative = *text == '-';
    bool small = false;
    for (const char *c = text; c < end; c++)
        if (*c == 'e' || *c == 'E')
            small = c + 1 < end && c[1] == '-';
    double magnitude = small ? 0 : HUGE_VAL;
    return negative ? -magnitude : magnitude;
}

const char *csg_number_parse(const char *text, const char *end, double *value)
{
    if (text < end && *text == '+' && text + 1 < end && text[1] != '-')
        text++;
    std::from_chars_result result = std::from_chars(text, end, *value);
    if (result.ec == std::errc::result_out_of_range)
        *value = out_of_range(text, result.ptr);
    else if (result.ec != std::errc())
        return nullptr;
    return result.ptr;
}
