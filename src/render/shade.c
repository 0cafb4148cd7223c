/* SPDX-License-Identifier: MIT
 * Light; see shade.h. Lambert's law, a highlight, and the studio in the mirror with the Fresnel
 * factor of Schlick (1994), made of products, quotients and square roots only, so that every
 * machine gives the same bytes.
 */
#include "render/shade.h"

#include "io/color.h"

static const float KEY = 0.92f, BACK = 0.12f, SKY = 0.46f, GROUND = 0.20f;

/* What is mirrored: the studio's floor and heaven, and of what is no metal the share of it that is
 * sent straight back. */
static const float FLOOR = 0.2f, HEAVEN = 0.95f, PLAIN = 0.03f;

/* The soft boxes: above the key light, a strip at the right, a weak one low at the left. Directions
 * are of the camera: right, up, and towards it. */
static const struct soft_box {
    double right, up, back;
    float sharpness, strength;
} boxes[CSG_SOFT_BOXES] = {
    {-0.55, 0.85, 0.75, 10, 1.5f}, {0.95, 0.2, 0.1, 24, 1.0f}, {-0.9, -0.25, 0.3, 12, 0.4f}};

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
    for (int i = 0; i < CSG_SOFT_BOXES; i++)
        set_direction(lights.box[i], view, boxes[i].right, boxes[i].up, boxes[i].back);
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

/* 1 / (1 + s (1 - c))^2 of the cosine c to the middle of a soft light: as round as a Gaussian, and
 * its integral over the sphere is 4 pi / (1 + 2 s). So a light seen in a rough surface, which
 * widens it (1 / s grows by the surface's own), keeps what it sends. */
static float soft_light(float cosine, float sharpness, float mirror_sharpness)
{
    float s = sharpness * mirror_sharpness / (sharpness + mirror_sharpness);
    float fall = 1 / (1 + s * (1 - cosine));
    return (1 + 2 * s) / (1 + 2 * sharpness) * fall * fall;
}

/* What a surface sees in the direction of its mirror; spread: the square of its roughness. */
static float studio(const csg_lights *lights, const float mirror[3], float spread)
{
    float up = dot(mirror, lights->sky), width = 0.1f + 1.2f * spread;
    float above = 0.5f + 0.5f * up / sqrtf(up * up + width * width);
    float light = FLOOR + (HEAVEN - FLOOR) * above;
    float sharpness = 2 / (spread * spread + 1e-3f);
    for (int i = 0; i < CSG_SOFT_BOXES; i++)
        light += boxes[i].strength *
                 soft_light(dot(mirror, lights->box[i]), boxes[i].sharpness, sharpness);
    return light;
}

/* The key light's highlight: the distribution of Trowbridge and Reitz ("GGX") with the shadowing of
 * Hammon (2017), without Fresnel's factor. The light has a width, so that a mirror shows it too. */
static float highlight(const csg_surface *s, const float light[3], float cosine, float spread,
                       float to_eye)
{
    const float light_width = 0.05f;
    float half[3], length = 0, a = spread + light_width, a2 = a * a;
    for (int i = 0; i < 3; i++) {
        half[i] = light[i] + s->to_eye[i];
        length += half[i] * half[i];
    }
    float c = length > 0 ? dot(s->normal, half) / sqrtf(length) : 0;
    if (!(c > 0))
        return 0;
    float wide = c * c * (a2 - 1) + 1;
    float masking = 2 * cosine * to_eye * (1 - a) + (cosine + to_eye) * a;
    return a2 / (wide * wide) * cosine * 0.5f / (masking + 1e-3f);
}

static float fifth_power(float x)
{
    float square = x * x;
    return square * square * x;
}

void csg_shade(const csg_lights *lights, const csg_light_curve *curve, const csg_surface *s,
               float light[3])
{
    float key = dot(s->normal, lights->key), back = dot(s->normal, lights->back);
    float up = 0.5f + 0.5f * dot(s->normal, lights->sky);
    float to_eye = dot(s->normal, s->to_eye), spread = s->roughness * s->roughness, mirror[3];
    to_eye = to_eye > 0 ? to_eye < 1 ? to_eye : 1 : 0;
    for (int i = 0; i < 3; i++)
        mirror[i] = 2 * to_eye * s->normal[i] - s->to_eye[i];
    key = key > 0 ? key * s->lit : 0;
    back = back > 0 ? back : 0;
    float shine = key > 0 ? KEY * highlight(s, lights->key, key, spread, to_eye) : 0;
    /* light that others reflect into corners: none of it is white, so occlusion is not black */
    float sky = (GROUND + (SKY - GROUND) * up) * s->open;
    float diffuse = (KEY * key + BACK * back * s->open + sky) * (1 - s->metallic);
    float around = studio(lights, mirror, spread) * (0.15f + 0.85f * s->open);
    float grazing = 0.6f * fifth_power(1 - to_eye), smooth = 1 - s->roughness;
    for (int i = 0; i < 3; i++) {
        float base = csg_light_to_linear(curve, s->color[i]);
        float facing = PLAIN + (base - PLAIN) * s->metallic; /* what a mirror of it sends back */
        float mirrored = facing + (smooth > facing ? smooth - facing : 0) * grazing;
        light[i] = base * diffuse + facing * shine + mirrored * around;
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
