/* SPDX-License-Identifier: MIT
 * A mesh while it is thinned out: what decimate.c (order and loop), decimate_samples.c (points of
 * the surface) and collapse.c (one edge) share.
 */
#ifndef CSG_MESH_RESHAPE_DECIMATION_H
#define CSG_MESH_RESHAPE_DECIMATION_H

#include "mesh/distance/missed.h"
#include "mesh/reshape/quadric.h"

/* A collapse waiting for its turn. */
typedef struct csg_waiting {
    float cost;
    uint32_t from, to;
    uint32_t version; /* of both ends, added: anything else now, and it is out of date */
} csg_waiting;

typedef struct csg_collapse_queue {
    csg_waiting *heap;
    size_t count, capacity;
} csg_collapse_queue;

enum { CSG_RING_MOST = 2 * CSG_CORNERS_MOST_VALENCE };

/* The triangles around an edge, as they would be after its collapse. */
typedef struct csg_collapse_room {
    uint32_t triangle[CSG_RING_MOST + 2]; /* those that stay, then the two that go */
    csg_vec3 before[CSG_RING_MOST][3], after[CSG_RING_MOST][3];
    uint32_t vertex[CSG_RING_MOST][3];
    uint32_t count; /* that stay */
    csg_look_at_vertex look;
    uint32_t *owner; /* of the samples of these triangles, in the order of their lists: who takes
                        them, as an index into triangle */
    size_t owner_count, owner_capacity;
} csg_collapse_room;

typedef struct csg_decimation {
    csg_remesh *remesh;
    csg_quadric *quadrics; /* per vertex */
    uint32_t *version;     /* per vertex: grows with each change */
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
    csg_collapse_queue *queue;
    csg_collapse_room *room;
    uint64_t tried, made;
} csg_decimation;

bool csg_decimation_make_samples(csg_decimation *d);
/* Whether the samples of room->triangle are near enough to room->after, and who takes which. */
bool csg_decimation_can_hand_over(csg_decimation *d, uint32_t kept);
void csg_decimation_hand_over(csg_decimation *d);

/* The cost of collapsing an edge, before it is checked; negative: never. */
double csg_collapse_cost(const csg_decimation *d, uint32_t from, uint32_t to);
/* Collapses it if all checks allow. On true `to` stands for both. */
bool csg_collapse_try(csg_decimation *d, uint32_t from, uint32_t to);

static inline csg_vec3 csg_sample_at(const csg_decimation *d, uint32_t sample)
{
    return csg_vec3_from_floats(d->samples[sample]);
}

#endif
