/* SPDX-License-Identifier: MIT
 * From a surface's normal and colour to light that reaches the eye, and from light to bytes. Light
 * is linear; one key light from the upper left of the camera, a little light from behind, and
 * around all of it a studio: a sky, a floor, and soft boxes, which is what metals show.
 */
#ifndef CSG_RENDER_SHADE_H
#define CSG_RENDER_SHADE_H

#include "render/camera.h"

enum { CSG_SOFT_BOXES = 3 };

/* Lights of a view, in the frame of the scene; unit vectors towards them. */
typedef struct csg_lights {
    float key[3], back[3], sky[3], box[CSG_SOFT_BOXES][3];
} csg_lights;

csg_lights csg_lights_make(const csg_view *view);

typedef struct csg_surface {
    float normal[3]; /* unit, towards the eye's side */
    float to_eye[3]; /* unit */
    float color[3];  /* sRGB 0..1 */
    float metallic, roughness;
    float open, lit; /* 1 - occlusion; share of the key light that arrives */
} csg_surface;

/* Tables of the sRGB curve; pow would cost more than the tracing. */
enum { CSG_LIGHT_STEPS = 1 << 14 };
typedef struct csg_light_curve {
    float linear[256];
    uint8_t srgb[CSG_LIGHT_STEPS];
} csg_light_curve;

void csg_light_curve_make(csg_light_curve *out);
float csg_light_to_linear(const csg_light_curve *curve, float srgb);
uint8_t csg_light_to_byte(const csg_light_curve *curve, float linear);

/* What is seen through: surfaces one behind the other at most, and the share of a place that is too
 * small to look for what is behind. */
enum { CSG_MOST_SURFACES = 13 };
static const float CSG_HARDLY_SEEN = 1.0f / 512;

/* Linear light from the surface to the eye. */
void csg_shade(const csg_lights *lights, const csg_light_curve *curve, const csg_surface *surface,
               float light[3]);

/* A pixel: `light` is the sum over all samples, of which `covered` hid the background; over the
 * background. */
void csg_shade_pixel(const csg_light_curve *curve, const float light[3], float covered,
                     uint32_t samples, const uint8_t background[4], uint8_t pixel[4]);

#endif
