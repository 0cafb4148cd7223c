/* SPDX-License-Identifier: MIT
 * Seven solids whose surface, creases and corners are known in closed form: the text of each, and
 * distances that ask nothing of the program. Frame: the solid's own, before it is turned.
 */
#ifndef TEST_TRUE_SOLIDS_H
#define TEST_TRUE_SOLIDS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/geometry.h"

/* A cylinder or cone: radius r0 + slope * (height over `at` along `axis`). */
typedef struct true_round {
    csg_vec3 at, axis;
    double r0, slope;
} true_round;

typedef struct true_profile true_profile;

typedef struct true_solid true_solid;

typedef struct true_kind {
    double (*surface)(const true_solid *, csg_vec3); /* distance to the surface */
    double (*crease)(const true_solid *, csg_vec3);  /* to the creases, corners and tips */
    /* Points along the creases, at most `most`; corners and tips come first, *corners of them. */
    size_t (*points)(const true_solid *, csg_vec3 *out, size_t most, size_t *corners);
} true_kind;

struct true_solid {
    const char *name;
    const char *text;
    true_kind kind;
    true_round round[4]; /* its curved parts */
    size_t round_count;
    double chord;  /* that of a crease between two of them is so many times as far off as theirs */
    double volume; /* of a polyhedron; 0: chords cut it */
    int genus;
    const true_profile *profile; /* of an extrusion */
    double half_height;
};

extern const true_solid true_solids[];
extern const size_t true_solid_count;

#endif
