/* SPDX-License-Identifier: MIT
 * The point of float formulas. These are written for one point and without branches: the compiler
 * turns the loops around them into vectors. Only + - * / sqrt, comparisons and choices
 * (base/select.h): each exactly rounded, so every instruction set gives the same bits.
 */
#ifndef CSG_SCENE_POINT_H
#define CSG_SCENE_POINT_H

#include <math.h>

#include "base/select.h"

typedef struct point {
    float x, y, z;
} point;

#endif
