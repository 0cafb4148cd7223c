/* SPDX-License-Identifier: MIT
 * What was mended, in words.
 */
#include "shape/polyhedra/repairs.h"

#include <stdio.h>

void csg_repairs_describe(const csg_repairs *repairs, char *text, size_t size)
{
    const struct {
        size_t count;
        const char *one, *many;
    } rows[] = {
        {repairs->holes, "hole filled", "holes filled"},
        {repairs->flipped, "triangle turned over", "triangles turned over"},
        {repairs->nonmanifold, "edge of more than two triangles",
         "edges of more than two triangles"},
        {repairs->duplicate, "triangle twice", "triangles twice"},
        {repairs->degenerate, "triangle without area left out", "triangles without area left out"},
    };
    size_t at = 0;
    text[0] = '\0';
    for (size_t i = 0; i < sizeof rows / sizeof *rows && at < size; i++)
        if (rows[i].count)
            at += (size_t)snprintf(text + at, size - at, "%s%zu %s", at ? ", " : "", rows[i].count,
                                   rows[i].count == 1 ? rows[i].one : rows[i].many);
    if (repairs->overlapping && at < size)
        snprintf(text + at, size - at, "%s",
                 at ? ", and it overlaps itself" : "it overlaps itself");
}

bool csg_repairs_are_any(const csg_repairs *repairs)
{
    return repairs->holes || repairs->flipped || repairs->nonmanifold || repairs->duplicate ||
           repairs->overlapping;
}
