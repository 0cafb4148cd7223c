/* SPDX-License-Identifier: MIT
 * Shadows of triangles; see mesh_light.h.
 */
#include "render/mesh_light.h"

enum {
    KEY_SIDE = 1024,
    BELOW_SIDE = 256,
    FEWER = 3 /* of the looks one is made where a mean of distances is wanted */
};

static const float SOFTNESS = 0.11f;   /* half the light's width over its distance */
static const double WIDEST = 1.0 / 16; /* of the box's diagonal */
static const double STEEPEST = 30;     /* a surface's rise towards the light; more is not known */
static const float LEAST_BLUR = 1.5f;  /* places, so that these are not to be seen */
static const double BEFORE = 2;        /* places by which something must be before a surface */

/* Rings of points, each the same share of the disc. */
static void make_looks(float look[CSG_LOOKS][2])
{
    int count = 0;
    for (int ring = 0; ring <= CSG_LOOK_RINGS; ring++)
        for (int i = 0; i < (ring ? 6 * ring : 1); i++, count++) {
            double s = 0, c = 1, radius = (double)ring / CSG_LOOK_RINGS;
            if (ring)
                csg_view_sine_cosine(60.0 * i / ring + 23.0 * ring, &s, &c);
            look[count][0] = (float)(radius * c);
            look[count][1] = (float)(radius * s);
        }
}

bool csg_mesh_light_is_cast(csg_box box)
{
    return csg_box_is_finite(box) && !csg_box_is_empty(box) && csg_vec3_norm(csg_box_size(box)) > 0;
}

csgm_status csg_mesh_light_make(csg_mesh_light *out, csg_picture *picture,
                                const csgm_mesh_view *mesh, csg_box box, bool ground)
{
    csgm_status status = CSGM_OK;
    csg_depth_map maps[CSG_DEPTH_MAPS];
    size_t count = 0;
    *out = (csg_mesh_light){.widest = 0};
    if (!csg_mesh_light_is_cast(box))
        return CSGM_OK;
    out->widest = WIDEST * csg_vec3_norm(csg_box_size(box));
    make_looks(out->look);
    if (picture->options->shadows) {
        csg_vec3 forward = csg_vec3_scale(csg_vec3_from_floats(picture->lights.key), -1);
        maps[count++] = csg_depth_map_along(forward, picture->view.up, box, KEY_SIDE);
    }
    if (ground && picture->options->occlusion) {
        csg_depth_map *map = &maps[count++];
        *map = csg_depth_map_along(csg_vec3_make(0, 0, 1), csg_vec3_make(0, 1, 0), box, BELOW_SIDE);
        map->farthest = csg_depth_map_project(map, box.min).z + out->widest; /* hides no more sky */
    }
    if (count)
        status = csg_depth_maps_draw(maps, count, picture, mesh);
    for (size_t i = 0; i < count; i++)
        *(maps[i].side == KEY_SIDE ? &out->key : &out->below) = maps[i];
    return status;
}

void csg_mesh_light_release(csg_mesh_light *light, csgm_context *context)
{
    csg_depth_map_release(&light->key, context);
    csg_depth_map_release(&light->below, context);
}

/* ---- the key light --------------------------------------------------------------------------- */

/* A surface in the map: places, distance, and how the distance grows from place to place. */
typedef struct receiver {
    float x, y, distance, along_x, along_y;
    float before; /* scene units by which something must be before it */
} receiver;

/* Where a surface turns away its distance grows fast, and is told less well. */
static receiver receiver_at(const csg_depth_map *map, csg_vec3 at, csg_vec3 normal)
{
    csg_vec3 place = csg_depth_map_project(map, at);
    double x = csg_vec3_dot(map->x, normal) * map->place;
    double y = csg_vec3_dot(map->y, normal) * map->place;
    double facing = fmax(-csg_vec3_dot(map->away, normal), 1e-6), across = sqrt(x * x + y * y);
    double steep = fmin(across / facing, STEEPEST);
    double share = across > 0 ? map->place * steep / across : 0;
    return (receiver){.x = (float)place.x,
                      .y = (float)place.y,
                      .distance = (float)place.z,
                      .along_x = (float)(share * x),
                      .along_y = (float)(share * y),
                      .before = (float)(map->place * (BEFORE + steep))};
}

/* How far before the surface something stands in the light, some places beside; 0: nothing does. */
static float distance_before(const csg_depth_map *map, const receiver *r, float dx, float dy)
{
    float own = r->distance + dx * r->along_x + dy * r->along_y;
    float distance = own - csg_depth_map_at(map, r->x + dx, r->y + dy);
    return distance > r->before ? distance : 0;
}

/* What is before a place nearby tells how far the shadow's edge is blurred, and that how much of it
 * is dark. */
float csg_mesh_light_key(const csg_mesh_light *light, csg_vec3 at, csg_vec3 normal)
{
    const csg_depth_map *map = &light->key;
    if (!map->nearest)
        return 1;
    receiver r = receiver_at(map, at, normal);
    float widest = (float)(light->widest / map->place), sum = 0;
    int blockers = 0, looks = 0, dark = 0;
    for (int i = 0; i < CSG_LOOKS; i += FEWER, looks++) {
        float distance =
            distance_before(map, &r, widest * light->look[i][0], widest * light->look[i][1]);
        sum += distance;
        blockers += distance > 0;
    }
    if (!blockers)
        return 1;
    if (blockers == looks)
        return 0;
    float radius = SOFTNESS * sum / ((float)blockers * (float)map->place);
    radius = radius < widest ? radius : widest;
    radius = radius > LEAST_BLUR ? radius : LEAST_BLUR;
    for (int i = 0; i < CSG_LOOKS; i++)
        dark +=
            distance_before(map, &r, radius * light->look[i][0], radius * light->look[i][1]) > 0;
    return 1 - (float)dark / CSG_LOOKS;
}

/* ---- the sky --------------------------------------------------------------------------------- */

/* The lower something is above the ground nearby, the more of the sky is hidden. */
float csg_mesh_light_sky(const csg_mesh_light *light, csg_vec3 at)
{
    const csg_depth_map *map = &light->below;
    if (!map->nearest)
        return 1;
    csg_vec3 from = csg_depth_map_project(map, at);
    float widest = (float)(light->widest / map->place), hidden = 0;
    for (int i = 0; i < CSG_LOOKS; i += FEWER) {
        float distance = csg_depth_map_at(map, (float)from.x + widest * light->look[i][0],
                                          (float)from.y + widest * light->look[i][1]);
        float share = 1 - (distance - (float)from.z) / (float)light->widest;
        hidden += share > 0 ? share : 0;
    }
    hidden *= (float)FEWER / CSG_LOOKS;
    return hidden < 1 ? 1 - hidden : 0;
}
