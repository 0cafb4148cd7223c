/* SPDX-License-Identifier: MIT
 * The directions that a surface faces in some place: where faces meet, all that lie between theirs.
 * Whether two places can face each other, or away from each other, along a line between them.
 */
#ifndef CSG_WALLS_NORMALS_H
#define CSG_WALLS_NORMALS_H

#include "base/geometry.h"

/* Every direction within asin(sine) of `at`, which has unit length. */
typedef struct csg_wall_cap {
    double at[3], sine;
} csg_wall_cap;

/* All nonnegative combinations of what is in the caps. */
typedef struct csg_wall_normals {
    uint32_t count; /* 0: any direction */
    const csg_wall_cap *caps;
} csg_wall_normals;

/* An angle below 90 degrees. */
typedef struct csg_wall_angle {
    double sine, cosine;
} csg_wall_angle;

/* How far normals may be from the line between two points that face each other: one of them by no
 * more than the first, the other by no more than the second. */
typedef struct csg_wall_angles {
    csg_wall_angle one, other, half; /* half: of the sum of both */
} csg_wall_angles;

csg_wall_angles csg_wall_angles_make(double one_deg, double other_deg);

/* The line from a point in one place to a point in another one. */
typedef struct csg_wall_line {
    bool is_known;             /* some direction is not among those that it may have */
    double d[3];               /* of unit length; it is near this */
    csg_wall_angle one, other; /* so much wider than the angles as it may be off */
} csg_wall_line;

/* offset, reach: of two points p and q, q - p is within `reach` of `offset`. */
csg_wall_line csg_wall_line_make(csg_vec3 offset, double reach, const csg_wall_angles *angles);

/* Whether points in the two places may look at each other as far as their normals alone say: false
 * where these all go one way. */
bool csg_wall_may_oppose(const csg_wall_normals *a, const csg_wall_normals *b,
                         const csg_wall_angles *angles);

/* No combination is within the angle of the unit vector d, for certain. */
bool csg_wall_is_apart(const csg_wall_normals *normals, const double d[3], csg_wall_angle angle);

/* Whether some combination is within the angle of the unit vector d, for certain but for rounding;
 * caps count as their middles. */
bool csg_wall_has_near(const csg_wall_normals *normals, csg_vec3 d, csg_wall_angle angle);

#endif
