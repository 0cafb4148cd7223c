/* SPDX-License-Identifier: MIT
 * Fewer triangles within an error: edges are collapsed, cheapest first by quadrics of the true
 * tangent planes, and every collapse is checked both ways before it is made: the triangles against
 * the field (remesh/remesh.h), and against samples of the surface that each triangle answers for.
 */
#ifndef CSG_MESH_RESHAPE_DECIMATE_H
#define CSG_MESH_RESHAPE_DECIMATE_H

#include "mesh/distance/missed.h"

typedef struct csg_decimation {
    csg_remesh *remesh;
    struct csg_quadric *quadrics; /* per vertex */
    uint32_t *version;            /* per vertex: grows with each change */
    /* Points of the true surface: the vertices the mesh began with, then one per triangle, then
     * those that it may have missed. Each belongs to the triangle that is nearest to it among those
     * that took its first one's place. */
    float (*samples)[3];
    uint32_t *next_sample;               /* NONE ends a triangle's list */
    uint32_t *first_sample;              /* per triangle */
    const csg_look_at_vertex *originals; /* of the vertices' samples; NULL as remesh->looks */
    const csg_missed *missed;            /* may be NULL */
    uint32_t sample_count, vertex_samples;
    size_t sample_capacity;
    struct csg_collapse_queue *queue;
    struct csg_collapse_room *room;
    uint64_t tried, made;
} csg_decimation;

/* CSGM_OK or CSGM_ERR_MEMORY (reported). The error may grow from one csg_decimate to the next. */
csgm_status csg_decimation_begin(csg_decimation *decimation, csg_remesh *remesh,
                                 const csg_missed *missed);
void csg_decimation_end(csg_decimation *decimation);

/* Collapses what remesh->error allows until `least` triangles are left. CSGM_OK, or why it was
 * stopped (reported). */
csgm_status csg_decimate(csg_decimation *decimation, uint32_t least);

/* Largest distance of a sample to its triangle, as the mesh is now. */
double csg_decimation_largest_distance(const csg_decimation *decimation);

#endif
