/* SPDX-License-Identifier: MIT
 * Light; see shade.h. Lambert's law with a Blinn highlight, made of products and square roots only,
 * so that every machine gives the same bytes.
 */
#include "render/shade.h"

#include "io/color.h"

static const float KEY = 0.92f, BACK = 0.12f, SKY = 0.46f, GROUND = 0.20f;

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void set_direction(float out[3], const csg_view *view, double right, double up, double back)
{
    csg_vec3 v = csg_vec3_add(
        csg_vec3_scale(view->right, right),
        csg_vec3_add(csg_vec3_scale(view->up, up), csg_vec3_scale(view->forward, -back)));
    v = csg_vec3_normalize(v);
    out[0] = (float)v.x;
    out[1] = (float)v.y;
    out[2] = (float)v.z;
}

csg_lights csg_lights_make(const csg_view *view)
{
    csg_lights lights;
    set_direction(lights.key, view, -0.55, 0.85, 0.75);
    set_direction(lights.back, view, 0.8, 0.25, -0.35);
    set_direction(lights.sky, view, 0.1, 1, 0.15);
    return lights;
}

/* ---- the curve ------------------------------------------------------------------------------- */

void csg_light_curve_make(csg_light_curve *out)
{
    csg_color_table table = csg_color_table_make(16, true);
    for (int i = 0; i < 256; i++)
        out->linear[i] = (float)table.linear[i] / 65535.0f;
    for (int i = 0; i < CSG_LIGHT_STEPS; i++)
        out->srgb[i] = csg_color_to_srgb((float)i / (CSG_LIGHT_STEPS - 1));
}

float csg_light_to_linear(const csg_light_curve *curve, float srgb)
{
    float at = srgb > 0 ? srgb < 1 ? srgb * 255 : 255 : 0;
    int below = at < 254 ? (int)at : 254;
    float share = at - (float)below;
    return curve->linear[below] * (1 - share) + curve->linear[below + 1] * share;
}

uint8_t csg_light_to_byte(const csg_light_curve *curve, float linear)
{
    float at = linear > 0 ? linear < 1 ? linear : 1 : 0;
    return curve->srgb[(int)(at * (CSG_LIGHT_STEPS - 1) + 0.5f)];
}

/* ---- surfaces -------------------------------------------------------------------------------- */

/* The highlight's strength: the power of the cosine to the half vector falls with roughness. */
static float highlight(const csg_surface *s, const float light[3])
{
    float half[3], length = 0;
    for (int i = 0; i < 3; i++) {
        half[i] = light[i] + s->to_eye[i];
        length += half[i] * half[i];
    }
    float cosine = length > 0 ? dot(s->normal, half) / sqrtf(length) : 0;
    if (!(cosine > 0))
        return 0;
    int doublings = 8 - (int)(s->roughness * 5.99f); /* powers 256 .. 8 */
    float power = cosine;
    for (int i = 0; i < doublings; i++)
        power *= power;
    return power * (1 - 0.75f * s->roughness);
}

void csg_shade(const csg_lights *lights, const csg_light_curve *curve, const csg_surface *s,
               float light[3])
{
    float key = dot(s->normal, lights->key), back = dot(s->normal, lights->back);
    float up = 0.5f + 0.5f * dot(s->normal, lights->sky);
    key = key > 0 ? key * s->lit : 0;
    back = back > 0 ? back : 0;
    float shine = key > 0 ? highlight(s, lights->key) * s->lit : 0;
    /* light that others reflect into corners: none of it is white, so occlusion is not black */
    float sky = (GROUND + (SKY - GROUND) * up) * s->open;
    float diffuse = KEY * key + BACK * back * s->open + sky;
    for (int i = 0; i < 3; i++) {
        float base = csg_light_to_linear(curve, s->color[i]);
        float mirror = 0.35f + 0.65f * s->metallic * base;
        light[i] = base * diffuse * (1 - 0.55f * s->metallic) +
                   shine * mirror * (0.28f + 0.9f * s->metallic) + s->metallic * base * sky * 0.8f;
    }
}

void csg_shade_pixel(const csg_light_curve *curve, const float light[3], float covered,
                     uint32_t samples, const uint8_t background[4], uint8_t pixel[4])
{
    float cover = covered / (float)samples;
    float behind = (1 - cover) * (float)background[3] / 255.0f, alpha = cover + behind;
    for (int i = 0; i < 3; i++) {
        float sum = light[i] / (float)samples + behind * curve->linear[background[i]];
        pixel[i] = alpha > 0 ? csg_light_to_byte(curve, sum / alpha) : 0;
    }
    pixel[3] = csg_color_to_byte(alpha);
}
