/* SPDX-License-Identifier: MIT
 * A proof that no point of a mesh is farther than E from the surface, of the field and not of
 * samples of it. Triangles are bisected until each piece, of centroid c and radius r, is settled by
 * one of these, with the tape pruned to the piece's neighbourhood:
 *
 *   minorant an affine function below f is positive at the corners of the piece moved by -E n, n
 *            being its normal, and one below -f at those of the piece moved by E n (minorant.h):
 *            whatever its size, and what creases there are. Asked first where leaves have faces
 *   cone     gradients in the ball of radius r + E around c have a direction v in common in which f
 *            climbs by at least m, and |f| <= m E all over the piece (slopes.h): so c + E v is
 *            inside and c - E v outside, for all of its points
 *   steps    f > 0 at the corners of small triangles that the piece, moved by E v, is cut into, by
 *            more than values between them can be off by (slopes.h); and f < 0 for the piece moved
 *            by -E v (steps.h). v is a cone's axis, or the piece's normal if there is no cone; if
 *            no bound is known gradients stray from 0 by lambda. Values cost little beside
 *            gradients' bounds, so pieces of the order of sqrt(E / curvature) are settled at once
 *   nearby   f changes its sign within E - r of c
 *
 * Where parts of a solid touch and are flush, all but the last ask what stands for f (touching.h).
 *
 * Meshes that began with triangles of polyhedra are held against those (begun.h).
 *
 * Every piece that is settled has the surface within E on the line through each of its points; and
 * where a cone settled it, just once: the surface near it is one sheet, so it is within E of the
 * mesh too.
 */
#ifndef CSG_MESH_DISTANCE_CHECK_H
#define CSG_MESH_DISTANCE_CHECK_H

#include "mesh/distance/begun.h"

typedef struct csg_distance_proof {
    uint64_t pieces; /* looked at */
    uint64_t effort; /* in and out: of all checks so far, by effort.h */
    uint64_t open;   /* could not be settled; of begun.h's proof, triangles */
    csg_vec3 place;  /* of the first of these, field frame */
    bool stopped;    /* it would have taken too long: nothing is known */
} csg_distance_proof;

/* begun: where it has triangles, they are the surface that the mesh began with; else the field
 * alone tells.
 * pending, a byte per triangle: in, whether it is to be looked at; out, whether a piece of it
 * stayed open. patient: what is as good as too far away is looked at, too: it costs the most, and
 * where a triangle can be mended that is cheaper. CSGM_OK or why it was stopped. */
csgm_status csg_check_distance(const csg_remesh *remesh, const csg_begun *begun, double error,
                               bool patient, uint8_t *pending, csg_distance_proof *out);

#endif
