/* SPDX-License-Identifier: MIT
 * The light that a mesh leaves: a map from the key light tells what is before a place, and how far
 * before it, which is how soft the shadow is there (Fernando 2005); one from below how near things
 * are to the ground, which hide the sky from it.
 */
#ifndef CSG_RENDER_MESH_LIGHT_H
#define CSG_RENDER_MESH_LIGHT_H

#include "render/depth_map.h"

enum {
    CSG_LOOK_RINGS = 6, /* of places around one that are looked at: 1 + 6 + 12 + ... */
    CSG_LOOKS = 1 + 3 * CSG_LOOK_RINGS * (CSG_LOOK_RINGS + 1)
};

typedef struct csg_mesh_light {
    csg_depth_map key, below; /* each without a map where it is not wanted */
    double widest;            /* what is blurred at most, in scene units */
    float look[CSG_LOOKS][2]; /* places in the unit disc, from its middle outwards */
} csg_mesh_light;

/* Whether a mesh in a box hides any light. */
bool csg_mesh_light_is_cast(csg_box box);
/* box: of the mesh. ground: whether it will be asked for. */
csgm_status csg_mesh_light_make(csg_mesh_light *out, csg_picture *picture,
                                const csgm_mesh_view *mesh, csg_box box, bool ground);
void csg_mesh_light_release(csg_mesh_light *light, csgm_context *context);

/* The share of the key light that arrives at a place whose unit normal turns to it. */
float csg_mesh_light_key(const csg_mesh_light *light, csg_vec3 at, csg_vec3 normal);
/* The share of the sky that a place of the ground sees. */
float csg_mesh_light_sky(const csg_mesh_light *light, csg_vec3 at);

#endif
