/* SPDX-License-Identifier: MIT
 * A mesh while it is thinned out: what regions.c (which part of it, on which thread), decimate.c
 * (order and loop), decimate_samples.c (points of the surface) and collapse.c (one edge) share.
 */
#ifndef CSG_MESH_RESHAPE_DECIMATION_H
#define CSG_MESH_RESHAPE_DECIMATION_H

#include <string.h>

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

enum {
    CSG_FACET_LANES = 4, /* facets are asked by so many */
    CSG_RING_MOST =
        (2 * CSG_CORNERS_MOST_VALENCE + CSG_FACET_LANES - 1) / CSG_FACET_LANES * CSG_FACET_LANES
};

/* A fan of triangles as it is asked for places, all at once: an offset from where they meet, times
 * second and third, is the weight at a triangle's second and third corner. Then what was found. */
typedef struct csg_facets {
    float second[3][CSG_RING_MOST], third[3][CSG_RING_MOST], normal[3][CSG_RING_MOST];
    float square[CSG_RING_MOST], over[CSG_RING_MOST], weight[2][CSG_RING_MOST];
} csg_facets;

/* There are more of them than of anything else: so places and links are kept as bytes, since the
 * alignment of their types would add two of these to each. */
typedef struct csg_surface_sample {
    uint8_t at[3 * sizeof(float)];
    uint8_t next[sizeof(uint32_t)]; /* in its triangle's list */
    int16_t normal[3]; /* outward, in INT16_MAXths; zero at creases, and where it is not known */
} csg_surface_sample;

static inline uint32_t csg_surface_sample_next(const csg_surface_sample *sample)
{
    uint32_t next;
    memcpy(&next, sample->next, sizeof next);
    return next;
}

static inline void csg_surface_sample_set_next(csg_surface_sample *sample, uint32_t next)
{
    memcpy(sample->next, &next, sizeof next);
}

enum { CSG_SAMPLES_OF_BLOCK = 8192 };

/* All blocks but the last one are full. */
typedef struct csg_sample_block {
    struct csg_sample_block *next;
    csg_surface_sample items[CSG_SAMPLES_OF_BLOCK];
} csg_sample_block;

/* Samples of a mesh that was thinned out in parts before it was joined: `next` is the triangle that
 * answers for one. looks: of those that were vertices; NULL as remesh->looks. The others are in
 * blocks, which are given back one by one while they are put behind those of vertices: there may be
 * no room for all of them twice. */
typedef struct csg_begun_samples {
    csg_surface_sample *of_vertices;
    csg_sample_block *others, *last;
    csg_look_at_vertex *looks;
    size_t vertex_count, vertex_capacity, other_count, block_count, look_capacity;
} csg_begun_samples;

/* One more of the others. False: out of memory. */
bool csg_begun_samples_add_other(csg_begun_samples *samples, csg_memory *memory,
                                 const csg_surface_sample *sample);
/* All but the looks. */
void csg_begun_samples_release(csg_begun_samples *samples, csg_memory *memory);

/* The triangles around an edge, as they would be after its collapse, or flip: a fan around
 * after[0][0]. */
typedef struct csg_collapse_room {
    uint32_t triangle[CSG_RING_MOST + 2]; /* those that stay, then those that go */
    csg_vec3 before[CSG_RING_MOST][3], after[CSG_RING_MOST][3];
    csg_facets facets;              /* of after */
    csg_vec3 normal[CSG_RING_MOST]; /* of after, twice the area long */
    double longest[CSG_RING_MOST];  /* side of after, squared */
    uint32_t vertex[CSG_RING_MOST][3];
    uint32_t count;               /* that stay */
    uint32_t gone;                /* that go: two, where an edge is flipped none */
    bool makes_slivers;           /* the last try failed by them */
    double most;                  /* that samples may be away, squared */
    double farthest;              /* of the samples handed over, squared */
    uint16_t seen[CSG_RING_MOST]; /* points of after near which there are samples that face its way:
                                     of these csg_remesh_brackets need not ask */
    csg_look_at_vertex look;
    bool one_look;      /* all vertices have it */
    bool is_first_look; /* nothing is said of looks */
    uint32_t *owner;    /* of the samples of these triangles, in the order of their lists: who takes
                           them, as an index into triangle */
    size_t owner_count, owner_capacity;
} csg_collapse_room;

typedef struct csg_decimation {
    csg_remesh *remesh;
    csg_quadric *quadrics; /* per vertex */
    uint32_t *version;     /* per vertex: grows with each change */
    /* Points of the true surface: the vertices the mesh began with, then one for each triangle that
     * the surface may bulge out of, then those that it may have missed. Each belongs to a triangle
     * that is near it, among those that took its first one's place. */
    csg_surface_sample *samples;
    uint32_t *first_sample;              /* per triangle; NONE ends its list */
    const csg_look_at_vertex *originals; /* of the vertices' samples; NULL as remesh->looks */
    const csg_missed *missed;            /* may be NULL */
    csg_begun_samples *begun; /* in place of those of the mesh; NULL: there are none. They are taken
                                 over, their looks are read */
    uint32_t sample_count, vertex_samples;
    size_t sample_capacity;
    csg_collapse_queue *queue;
    csg_collapse_room *room;
    /* What is worked on at a time (regions.h): vertices of which all triangles lie in the cube. */
    const uint32_t *region_of; /* per vertex; NONE: of several, it stays */
    uint8_t *state;            /* per vertex: csg_vertex_state */
    uint32_t region;
    csg_vec3 low, high;     /* the cube */
    double least_quality;   /* of triangles: no worse ones are made of better ones */
    double farthest_vertex; /* that a new vertex may be from the surface */
    uint64_t tried, made;
} csg_decimation;

/* Edges between two vertices that are settled were tried, and nothing around has changed since. */
typedef enum csg_vertex_state {
    CSG_VERTEX_SETTLED,
    CSG_VERTEX_FRESH,
    CSG_VERTEX_SLIVERED, /* settled; collapses of it failed by slivers, which may be made at last */
    CSG_VERTEX_HELD_UP   /* by what lies in other regions: fresh for those that come later */
} csg_vertex_state;

static inline bool csg_decimation_owns(const csg_decimation *d, uint32_t vertex)
{
    return d->region_of[vertex] == d->region;
}

/* Room for so many samples; those of vertices that the mesh has begun with come first, and stay
 * where they are. False: out of memory. */
bool csg_decimation_hold_samples(csg_decimation *d, size_t needed);
/* normals: the mean of the triangles at each vertex. False: stopped, or without memory; the watch
 * knows. */
bool csg_decimation_make_samples(csg_decimation *d, const csg_vec3 *normals);
/* Those that the mesh has begun with. False: out of memory. */
bool csg_decimation_take_samples(csg_decimation *d);
/* Collapses edges of a region that are not settled, cheapest first, until `least` triangles are
 * left. items: its triangles, of which some may be of others; NULL: all there are. CSGM_OK,
 * CSGM_ERR_MEMORY or CSGM_CANCELLED; neither is reported. Any thread. */
csgm_status csg_decimate_region(csg_decimation *d, const uint32_t *items, uint32_t count,
                                uint32_t least);
/* Whether one sample of each of room->triangle, that at which the last try failed if one did, is at
 * most so far from room->after; looks do not matter. Most of what can not be handed over is found
 * by them. */
bool csg_decimation_may_hand_over(csg_decimation *d, uint32_t kept, double reach);
/* Whether all of them are, and who takes which. */
bool csg_decimation_can_hand_over(csg_decimation *d, uint32_t kept, double reach);
void csg_decimation_hand_over(csg_decimation *d);
/* What collapses left gets another chance: edges in flat parts are flipped where that makes better
 * triangles, and vertices that are no corners of the mesh as it is now are none. *any: something
 * changed, and is fresh. False: stopped, or without memory; the watch knows. */
bool csg_decimation_loosen(csg_decimation *d, bool *any);
/* room->seen, from who takes which. */
void csg_decimation_find_seen(csg_decimation *d);

/* The cost of collapsing an edge, before it is checked; negative: never. */
double csg_collapse_cost(const csg_decimation *d, uint32_t from, uint32_t to);
/* Collapses it if all checks allow. The vertex that stands for both then; NONE: it stays. */
uint32_t csg_collapse_try(csg_decimation *d, uint32_t from, uint32_t to);

static inline csg_vec3 csg_sample_at(const csg_decimation *d, uint32_t sample)
{
    float at[3];
    memcpy(at, d->samples[sample].at, sizeof at);
    return csg_vec3_from_floats(at);
}

/* The next one of its triangle's; NONE ends the list. */
static inline uint32_t csg_sample_next(const csg_decimation *d, uint32_t sample)
{
    return csg_surface_sample_next(&d->samples[sample]);
}

/* Puts it before those that the triangle answers for. */
static inline void csg_sample_put(csg_decimation *d, uint32_t sample, uint32_t triangle)
{
    csg_surface_sample_set_next(&d->samples[sample], d->first_sample[triangle]);
    d->first_sample[triangle] = sample;
}

static inline csg_vec3 csg_sample_normal(const csg_decimation *d, uint32_t sample)
{
    const int16_t *n = d->samples[sample].normal;
    return csg_vec3_make(n[0], n[1], n[2]);
}

#endif
