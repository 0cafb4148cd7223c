/* SPDX-License-Identifier: MIT
 *
 * What can be done with meshes that others made. The conventions are those of csgmesh.h.
 */
#ifndef CSGMESH_RESHAPING_H
#define CSGMESH_RESHAPING_H

#include "csgmesh/csgmesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- meshes that others made --------------------------------------------------------- */

/* What the file of a mesh that csgm_mesh_read made said of the length of one of its units. False:
 * it said nothing. Of 3MF, AMF and glTF of other programs it is the millimetre, which they were
 * brought to. */
CSGM_API bool csgm_mesh_unit(const csgm_mesh *mesh, csgm_unit *unit);
/* What the file had and the mesh has not, such as "2 textures, 1 animation"; NULL: nothing. The
 * mesh's storage. */
CSGM_API const char *csgm_mesh_left_out(const csgm_mesh *mesh);

/* What to do with a mesh that no field stands behind. Lengths are in scene units. */
typedef struct csgm_reshape_options {
    uint32_t struct_size; /* set by csgm_reshape_options_default; do not touch */
    /* At most one of the next three. They thin the mesh out; creases, where colours and materials
     * change, and parts stay. */
    double simplify_error; /* > 0: as far as this distance allows, both ways, which is proven */
    double simplify_share; /* > 0, < 1: so many of each part's triangles may stay */
    uint64_t triangles;    /* > 0: at most so many, the parts' shares alike */
    bool improve;          /* vertices move along the surface, edges flip and needles go, for better
                              triangles;          within simplify_error, or csgm_quality_tolerance of
                              CSGM_QUALITY_NORMAL */
    uint32_t smooth; /* rounds of smoothing (bi-Laplacian), before the rest; nothing bounds how far
                        the surface moves but what csgm_reshape_stats says of it */
    csgm_monitor monitor; /* stages CSGM_STAGE_RESHAPE and CSGM_STAGE_COMPARE */
} csgm_reshape_options;

CSGM_API csgm_reshape_options csgm_reshape_options_default(void);

/* What csgm_mesh_reshape did. Start from csgm_reshape_stats_default(). */
typedef struct csgm_reshape_stats {
    uint32_t struct_size;                  /* set by csgm_reshape_stats_default; do not touch */
    uint64_t mended_triangles;             /* of the mesh as mended, before the rest */
    double distance_lower, distance_upper; /* proven: the largest distance of a point of the result
                                              or of the mended mesh from the other lies between */
} csgm_reshape_stats;

CSGM_API csgm_reshape_stats csgm_reshape_stats_default(void);

/* Is OpenMesh there? Without it a mesh can only be mended. */
CSGM_API bool csgm_reshape_available(void);
/* Mends each part as import() does, so that it encloses a volume (warnings say what was wrong; a
 * part that encloses nothing is left as it is), then does what the options ask for; options NULL:
 * no more than that. Names of parts, colours and materials stay; normals are made anew where there
 * are any. Indices must be in range and positions finite: CSGM_ERR_ARGUMENT. CSGM_ERR_UNSUPPORTED:
 * a build without OpenMesh. stats may be NULL. */
CSGM_API csgm_status csgm_mesh_reshape(csgm_context *context, const csgm_mesh_view *mesh,
                                       const csgm_reshape_options *options, csgm_mesh **out,
                                       csgm_reshape_stats *stats);

#ifdef __cplusplus
}
#endif
#endif
