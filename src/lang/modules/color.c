/* SPDX-License-Identifier: MIT
 * Colours by name or as hexadecimal digits.
 */
#include <ctype.h>
#include <string.h>
#include <strings.h>

#include "lang/modules/modules.h"

static const struct {
    const char *name;
    uint32_t rgb;
} colors[] = {
#define CSG_COLOR(name, rgb) {#name, rgb},
#include "lang/modules/colors.def"
#undef CSG_COLOR
};

static csg_color from_bytes(uint32_t r, uint32_t g, uint32_t b, uint32_t a)
{
    return (csg_color){(float)r / 255, (float)g / 255, (float)b / 255, (float)a / 255};
}

static bool parse_digits(const char *text, size_t length, csg_color *out)
{
    uint32_t digits[8];
    if (length != 3 && length != 4 && length != 6 && length != 8)
        return false;
    for (size_t i = 0; i < length; i++) {
        if (!isxdigit((unsigned char)text[i]))
            return false;
        digits[i] =
            text[i] <= '9' ? (uint32_t)(text[i] - '0') : (uint32_t)((text[i] | 32) - 'a' + 10);
    }
    uint32_t bytes[4] = {0, 0, 0, 255};
    size_t each = length <= 4 ? 1 : 2;
    for (size_t i = 0; i < length / each; i++)
        bytes[i] = each == 1 ? digits[i] * 17 : digits[2 * i] * 16 + digits[2 * i + 1];
    *out = from_bytes(bytes[0], bytes[1], bytes[2], bytes[3]);
    return true;
}

bool csg_color_parse(const char *text, size_t length, csg_color *out)
{
    if (length && text[0] == '#')
        return parse_digits(text + 1, length - 1, out);
    if (strcasecmp(text, "transparent") == 0) {
        *out = from_bytes(0, 0, 0, 0);
        return true;
    }
    for (size_t low = 0, high = sizeof colors / sizeof *colors; low < high;) {
        size_t middle = (low + high) / 2;
        uint32_t rgb = colors[middle].rgb;
        int order = strcasecmp(text, colors[middle].name);
        if (order == 0) {
            *out = from_bytes(rgb >> 16, rgb >> 8 & 255, rgb & 255, 255);
            return true;
        }
        low = order > 0 ? middle + 1 : low;
        high = order < 0 ? middle : high;
    }
    return false;
}
