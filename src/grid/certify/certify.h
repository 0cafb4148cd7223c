/* SPDX-License-Identifier: MIT
 * What the lattice may have missed: thin sheets, drops, needles and cracks between its points.
 *
 * Going in: a field, its lattice. Coming out: how many cells of the surface are proven to hold one
 * sheet, and every place where a part of the solid, or of what is around it, has no lattice point
 * in it and none within reach. docs/certify.md has the promise and why it holds.
 */
#ifndef CSG_GRID_CERTIFY_H
#define CSG_GRID_CERTIFY_H

#include "grid/certify/cell_kind.h"
#include "grid/octree/octree.h"

enum { CSG_CERTIFY_PLACES = 16 };

/* Neighbouring cells of one kind, UNRESOLVED or MISSED. */
typedef struct csg_certify_place {
    csg_cell_kind kind;
    bool is_gap;      /* of what is outside: a crack or a bubble */
    double thickness; /* of the ball that fits in at `at`, the largest found; 0: not known */
    csg_vec3 at;      /* scene units */
    csg_box box;      /* of the cells */
    uint64_t cells;
} csg_certify_place;

typedef struct csg_certify_report {
    uint64_t cells[CSG_CELL_KINDS]; /* that the surface touches, of each kind; EMPTY stays 0 */
    uint64_t cubes;                 /* looked at within cells */
    double promise; /* parts thicker than this are in the mesh, but for the places */
    uint32_t place_count, place_more; /* listed, and beyond the list */
    csg_certify_place places[CSG_CERTIFY_PLACES];
} csg_certify_report;

typedef struct csg_certify_options {
    double size; /* at which cubes are not divided any more; scene units, > 0 */
    void (*progress)(void *user, double fraction);
    bool (*cancelled)(void *user);
    void *user;
} csg_certify_options;

/* CSGM_OK, CSGM_CANCELLED or CSGM_ERR_MEMORY (reported). The report is the same for any number of
 * threads and instruction set. */
csgm_status csg_certify_run(csgm_context *context, const csgm_field *field,
                            const csg_lattice *lattice, const csg_certify_options *options,
                            csg_certify_report *report);

/* Whether a place (field's frame) within a part of the solid, or within a gap, that the lattice
 * misses is lost: another lattice may have it. */
typedef bool csg_certify_is_lost(const void *user, csg_vec3 at, double thickness, bool is_gap);

/* Without certifying: follows some of the octree's doubts (octree.h) to the lattice. False: none of
 * them is a part missed; else *place is the thickest of those found, cells is the number of blocks
 * with doubts. is_lost: NULL: all that the lattice misses are. *status: CSGM_OK or CSGM_ERR_MEMORY
 * (reported). */
bool csg_certify_doubts(csgm_context *context, const csgm_field *field, const csg_lattice *lattice,
                        csg_octree *octree, csg_certify_is_lost *is_lost, const void *user,
                        csg_certify_place *place, uint64_t *edges, csgm_status *status);

#endif
