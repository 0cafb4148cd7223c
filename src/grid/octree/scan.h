/* SPDX-License-Identifier: MIT
 * A cheap look at a block's samples for what may lie between them: a lattice edge towards which |f|
 * falls from both ends of its line, to less than the edge could span, without a change of sign. A
 * sheet, drop or crack makes such edges; so do narrow bulges, which is why certify.h's ways to the
 * lattice decide afterwards.
 */
#ifndef CSG_GRID_SCAN_H
#define CSG_GRID_SCAN_H

#include "field/tape.h"
#include "grid/octree/lattice.h"

/* The doubtful edge of a block that is most so, and how many there are. */
typedef struct csg_scan {
    float span; /* by how much f can change along a lattice edge */
    uint32_t count;
    float doubt;       /* of the edge below: 0 none .. 1 */
    uint32_t point[3]; /* its lower lattice point */
    uint8_t axis;
    bool is_inside; /* the sign of its ends */
} csg_scan;

/* Values of the n^3 points from lattice point `first` on, x fastest. */
void csg_scan_values(csg_scan *scan, const float *f, size_t n, const uint32_t first[3]);

/* Whether the field may hide anything in block `at`: where it climbs in one direction all over the
 * block it cannot. */
bool csg_scan_is_due(const csg_lattice *lattice, double margin, const uint32_t at[3],
                     const csg_tape *tape);
/* Whether a look at the samples costs less than that question: of polyhedra the normals of all that
 * is near answer it, each with a proof, and most blocks show nothing doubtful. */
bool csg_scan_comes_first(const csg_tape *tape);

#endif
