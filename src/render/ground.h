/* SPDX-License-Identifier: MIT
 * The plane that a solid stands on. Nothing of it is seen but the shadow: it darkens what is behind
 * it, so that pictures keep their background. It is there where the eye is above it.
 */
#ifndef CSG_RENDER_GROUND_H
#define CSG_RENDER_GROUND_H

#include "render/job.h"
#include "render/tracer.h"

/* How dark the ground is where this share of the key light and of the sky arrives: 0 .. 1. */
float csg_ground_darkness(const csgm_render_options *options, float lit, float open);

/* Whether the options want one, and the view is from above a plane at height z. */
bool csg_ground_is_seen(const csgm_render_options *options, const csg_view *view, double z);

/* Of a field; floats are relative to its centre. */
typedef struct csg_ground {
    const csgm_render_options *options;
    bool is_shown;
    float z;
    float min[3], max[3]; /* around what may cast a shadow */
} csg_ground;

/* A lattice over a tile of the picture. Where the ground is nearly the same at the corners of one
 * of its squares, it is mixed from these within, and need not be traced. */
enum { CSG_GROUND_STEP = 4, CSG_GROUND_NODES = 11 }; /* pixels; along each side */

typedef struct csg_ground_nodes {
    float x, y;                                          /* the first one's pixel coordinates */
    float darkness[CSG_GROUND_NODES * CSG_GROUND_NODES]; /* below 0: not known */
} csg_ground_nodes;

/* Forgets all; the tile begins at pixel x, y, and the lattice a step before it. */
void csg_ground_begin(csg_ground_nodes *nodes, uint32_t x, uint32_t y);

/* box: around the solid, in the scene's frame. Looks for its lowest place by rays from below. */
csgm_status csg_ground_find(csg_ground *out, const csg_picture *picture, const csg_tracer *tracer,
                            csg_box box, csg_trace_room *room);

/* After csg_tracer_trace: fills `ground` of all rays of the room; 0 where something was hit. Of the
 * rays through a tile's pixels (is_tile, with room for as many nodes) the nodes around those that
 * meet the ground are traced first. */
void csg_ground_trace(const csg_ground *ground, const csg_tracer *tracer, csg_trace_room *room,
                      csg_ground_nodes *nodes, bool is_tile);

#endif
