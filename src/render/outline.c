/* SPDX-License-Identifier: MIT
 * See outline.h.
 */
#include "render/outline.h"

#include <math.h>

static const float BEHIND = 2;   /* pixels from the tangent plane of either */
static const float WIDTH = 1.3f; /* pixels */
static const float OPACITY = 0.85f;

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

bool csg_outline_between(const csg_outline_point *a, const csg_outline_point *b, float crease)
{
    if (!a->is_hit || !b->is_hit)
        return a->is_hit != b->is_hit;
    if (dot(a->normal, b->normal) < crease)
        return true;
    const float way[3] = {b->at[0] - a->at[0], b->at[1] - a->at[1], b->at[2] - a->at[2]};
    float from_a = fabsf(dot(way, a->normal)), from_b = fabsf(dot(way, b->normal));
    float pixel = a->pixel < b->pixel ? a->pixel : b->pixel;
    return (from_a < from_b ? from_a : from_b) > BEHIND * pixel;
}

float csg_outline_cover(float across, float down)
{
    float cover = WIDTH * sqrtf(across * across + down * down);
    return OPACITY * (cover < 1 ? cover : 1);
}

void csg_outline_draw(float line, float samples, float light[3], float *cover)
{
    for (int c = 0; c < 3; c++)
        light[c] *= 1 - line;
    *cover += line * (samples - *cover);
}
