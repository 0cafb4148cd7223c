/* SPDX-License-Identifier: MIT
 *
 * Whether the parts of a scene stay clear of each other, at one pose or at many. The conventions
 * are those of csgmesh.h.
 */
#ifndef CSGMESH_CLEARANCE_H
#define CSGMESH_CLEARANCE_H

#include "csgmesh/csgmesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What is proven of two parts. T is csgm_clear_options.tolerance. */
typedef enum csgm_clear_state {
    CSGM_CLEAR_APART,    /* they have no point in common */
    CSGM_CLEAR_TOUCHING, /* two points of them are within T of each other, and what they may have in
                            common is nowhere thicker than T: every bit of it lies between two
                            parallel planes that far apart */
    CSGM_CLEAR_UNDECIDED,  /* none of these could be shown */
    CSGM_CLEAR_INTERFERING /* a point is inside both */
} csgm_clear_state;

/* How closely, and of which parts. Lengths are in scene units. */
typedef struct csgm_clear_options {
    uint32_t struct_size; /* set by csgm_clear_options_default; do not touch */
    double tolerance;     /* T: how closely gaps are to be known; 0 (the default): 1e-4 of the
                             longest side of the largest part at the first pose, but no closer
                             than a 64th of the gap */
    double min_gap; /* > 0: of each pair and pose it is to be known whether the gap is as large;
                       0 (the default): whether they interfere */
    /* Pairs among these parts alone, or, where one is named, of it with all others; NULL (the
     * default): all pairs. */
    const char *const *parts;
    size_t part_count;
    uint64_t most_pairs;  /* > 0, default 2^20: of cubes that are looked at for one pair of parts at
                             one pose, a quarter of it once they are known to be apart, a 16th where
                             the gap is known to a tenth by then, or at later poses; about a million
                             a second */
    csgm_monitor monitor; /* stage CSGM_STAGE_MEASURE */
} csgm_clear_options;

CSGM_API csgm_clear_options csgm_clear_options_default(void);

/* What is proven of two parts over all poses: the worst of them. Of poses where they interfere it
 * is the one with the largest common volume for certain; then one that is undecided; else the one
 * with the smallest gap. */
typedef struct csgm_clear_pair {
    const char *names[2];   /* NULL: the part without a name */
    csgm_clear_state state; /* at the worst pose */
    size_t pose;            /* the worst */
    csgm_interval gap; /* the distance of the two; 0 where they interfere; infinite ends where one
                          is empty. Of all poses its lower end holds: nowhere is it less */
    bool by_boxes;     /* their boxes, which are far apart, told: nearest is not known */
    csgm_vec3 nearest[2]; /* a point of each, gap.high apart; where APART or TOUCHING */
    csgm_vec3 inside;     /* a point inside both, where INTERFERING */
    csgm_interval volume; /* what both have, where INTERFERING */
    double size;          /* UNDECIDED: the edge of the largest cube that is left */
    size_t poses;         /* at which both are there */
    size_t poses_bad;     /* those where they interfere, or where the gap is less than min_gap */
    size_t poses_open;    /* those where that could not be told */
    uint64_t pairs;       /* of cubes, in all */
    /* From each pose to the next, where both are there at both. Such a step is covered where it is
     * proven that on the way the two have no point in common, and are min_gap apart, if each is the
     * same at both poses but for a rigid motion, and the one moves in relation to the other by the
     * screw that leads from the one pose to the next (a turn around an axis by 180 degrees at most,
     * and a shift along it). That is how bodies on a common hinge, slide or thread move; what moves
     * otherwise is covered as long as it strays from there by less than gap_between. Also covered
     * are steps in which neither moves in relation to the other, but for rounding. */
    size_t steps;
    size_t steps_open;  /* those that are not covered: of them nothing is claimed */
    size_t first_open;  /* the pose that the first of these leads to; 0: there is none */
    double gap_between; /* nowhere on the ways that are covered, and at no pose, is the gap less */
} csgm_clear_pair;

typedef struct csgm_clearances csgm_clearances;

/* options NULL = defaults; their names are copied. CSGM_ERR_ARGUMENT: an option out of range. */
CSGM_API csgm_status csgm_clearances_create(csgm_context *context,
                                            const csgm_clear_options *options,
                                            csgm_clearances **out);
CSGM_API void csgm_clearances_destroy(csgm_clearances *clearances); /* NULL is a no-op */

/* One more pose: the same scene with its parts in other places, of the same context; it may go
 * afterwards. Parts are known by their names; those that are what they were are not looked at
 * again. Of what lies between poses csgm_clear_pair.steps tells. The same for any number of
 * threads.
 *
 * CSGM_ERR_ARGUMENT (not reported): a part that was asked for is not there at the first pose.
 * CSGM_ERR_SCENE (reported): there are fewer than two parts, or one that had to be looked at
 * reaches to infinity. With CSGM_ERR_LIMIT, CSGM_ERR_MEMORY and CSGM_CANCELLED what is proven by
 * then is there; the time limit of the context counts from the first pose on. */
CSGM_API csgm_status csgm_clearances_add(csgm_clearances *clearances, const csgm_scene *scene);

/* What is proven so far, in the order of the parts. NULL: there are no more. Until the next call of
 * csgm_clearances_add. */
CSGM_API const csgm_clear_pair *csgm_clearances_get(const csgm_clearances *clearances,
                                                    size_t index);
/* The names of the parts seen so far, also where one that was asked for is not there. False: there
 * are no more. *name: NULL for the part without a name. */
CSGM_API bool csgm_clearances_part(const csgm_clearances *clearances, size_t index,
                                   const char **name);
/* T as it came out. */
CSGM_API double csgm_clearances_tolerance(const csgm_clearances *clearances);

/* The pair at its worst as a scene to be drawn (csgm_render_scene): `scene` is that of the pair's
 * pose. The part names[solid], 0 or 1, is solid and blue, and red where the other one has it in
 * common; the other one is marked as a # would (CSGM_MARK_HIGHLIGHT) and seen through, all other
 * parts as a % would. Where nearest points are known, balls of radius `mark` around them and a rod
 * from one to the other are red; scene units, 0: none. The new scene does not need the old one.
 * CSGM_ERR_ARGUMENT (not reported): the scene lacks a part of the pair. */
CSGM_API csgm_status csgm_clear_exhibit(csgm_context *context, const csgm_scene *scene,
                                        const csgm_clear_pair *pair, int solid, double mark,
                                        csgm_scene **out);

#ifdef __cplusplus
}
#endif
#endif
