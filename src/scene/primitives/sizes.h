/* SPDX-License-Identifier: MIT
 * What a scene's numbers may be. Each check is false after it has refused, with one sentence; the
 * first sentence stays.
 */
#ifndef CSG_SCENE_SIZES_H
#define CSG_SCENE_SIZES_H

#include <stdbool.h>

/* Smaller sizes are refused, smaller blends are sharp. */
#define CSG_SMALLEST_LENGTH 1e-15
/* Larger lengths leave no room for the squares and ratios that the formulas need. */
#define CSG_LARGEST_LENGTH 1e15

typedef struct csg_refusal {
    bool is_set;
    char text[160];
} csg_refusal;

/* Always false. */
bool csg_refuse(csg_refusal *refusal, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* Finite, and not too large. what: "the radius" */
bool csg_check_range(csg_refusal *refusal, double value, const char *what);
bool csg_check_positive(csg_refusal *refusal, double value, const char *what);
bool csg_check_not_negative(csg_refusal *refusal, double value, const char *what);
/* Both >= 0, not both 0. */
bool csg_check_radii(csg_refusal *refusal, double r1, double r2);
/* The rounding of a box: no more than its smallest half size. */
bool csg_check_rounding(csg_refusal *refusal, double round, double smallest);

#endif
