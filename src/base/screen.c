/* SPDX-License-Identifier: MIT
 * Columns of characters; see screen.h. The ranges are those of Unicode 15's East_Asian_Width W and
 * F, and of its general categories Mn, Me and Cf where source texts meet them.
 */
#include "base/screen.h"

#include "base/utf8.h"

typedef struct range {
    uint32_t first, last;
} range;

static const range wide[] = {
    {0x1100, 0x115F},   {0x2E80, 0x303E},   {0x3041, 0x33FF},   {0x3400, 0x4DBF},
    {0x4E00, 0xA4CF},   {0xA960, 0xA97F},   {0xAC00, 0xD7A3},   {0xF900, 0xFAFF},
    {0xFE10, 0xFE19},   {0xFE30, 0xFE6F},   {0xFF01, 0xFF60},   {0xFFE0, 0xFFE6},
    {0x1F300, 0x1F64F}, {0x1F680, 0x1F6FF}, {0x1F900, 0x1F9FF}, {0x1FA70, 0x1FAFF},
    {0x20000, 0x3FFFD},
};

static const range combining[] = {
    {0x0300, 0x036F}, {0x0483, 0x0489}, {0x0591, 0x05BD}, {0x0610, 0x061A}, {0x064B, 0x065F},
    {0x1AB0, 0x1AFF}, {0x1DC0, 0x1DFF}, {0x200B, 0x200D}, {0x2060, 0x2064}, {0x20D0, 0x20FF},
    {0x3099, 0x309A}, {0xFE00, 0xFE0F}, {0xFE20, 0xFE2F}, {0xFEFF, 0xFEFF}, {0xE0100, 0xE01EF},
};

/* Signs that turn the direction of what follows: a line could be made to look like another. */
static const range turning[] = {{0x200E, 0x200F}, {0x202A, 0x202E}, {0x2066, 0x2069}};

static bool is_in(const range *ranges, size_t count, uint32_t c)
{
    for (size_t i = 0; i < count; i++)
        if (c >= ranges[i].first && c <= ranges[i].last)
            return true;
    return false;
}

#define IS_IN(ranges, c) is_in(ranges, sizeof(ranges) / sizeof *(ranges), c)

csg_screen_cell csg_screen_cell_at(const char *text, size_t length)
{
    uint32_t c, bytes = (uint32_t)csg_utf8_decode(text, length, &c);
    if (bytes == 0)
        return (csg_screen_cell){1, 1, false};
    if ((c < 0x20 && c != '\t') || (c >= 0x7F && c < 0xA0) || IS_IN(turning, c))
        return (csg_screen_cell){bytes, 1, false};
    uint32_t columns = c < 0x300 ? 1 : IS_IN(combining, c) ? 0 : IS_IN(wide, c) ? 2 : 1;
    return (csg_screen_cell){bytes, columns, true};
}

size_t csg_screen_step_back(const char *text, size_t at)
{
    size_t begin = at - 1;
    while (begin > 0 && at - begin < 4 && ((unsigned char)text[begin] & 0xC0) == 0x80)
        begin--;
    return csg_screen_cell_at(text + begin, at - begin).bytes == at - begin ? begin : at - 1;
}
