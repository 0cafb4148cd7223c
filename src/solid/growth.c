/* SPDX-License-Identifier: MIT
 * How far a surface moves when a length is added to its field: by that length where the field is a
 * distance, else by more, since no field changes faster than one. Places are sampled, so a farther
 * one may be missed.
 */
#include <math.h>

#include "base/random.h"
#include "scene/reference.h"
#include "solid/measure.h"

enum { MOST_PLACES = 192, LEAST_PLACES = 12, NODES_SEEN = 100000, MOST_STEPS = 40 };

/* A field with its gradient, and room to look at it. */
typedef struct growth_walk {
    const csgm_scene *scene;
    csgm_status status;
    double longest; /* step */
} growth_walk;

/* Along the gradient to where the field is `level`, within `near`. False: it is not found. */
static bool walk_to(growth_walk *w, double level, double near, csg_vec3 *p)
{
    for (int i = 0; i < MOST_STEPS && w->status == CSGM_OK; i++) {
        csg_sample s = csg_reference_eval(w->scene, *p, &w->status);
        double left = level - s.value, square = csg_vec3_dot(s.gradient, s.gradient);
        if (fabs(left) <= near)
            return true;
        if (!isfinite(s.value) || !(square > 1e-8))
            return false;
        double step = left / sqrt(square), longest = w->longest;
        step = fmin(fmax(step, -longest), longest);
        *p = csg_vec3_add(*p, csg_vec3_scale(s.gradient, step / sqrt(square)));
    }
    return false;
}

static void sample_growth(growth_walk *w, csg_box box, double by, csg_growth *out)
{
    csg_random random = {1};
    size_t places = NODES_SEEN / (w->scene->node_count + 1);
    places = places > MOST_PLACES ? MOST_PLACES : places < LEAST_PLACES ? LEAST_PLACES : places;
    csg_vec3 size = csg_box_size(box);
    double whole = csg_vec3_norm(size);
    for (size_t i = 0; i < places && w->status == CSGM_OK; i++) {
        csg_vec3 p = {csg_random_uniform(&random, box.min.x, box.max.x),
                      csg_random_uniform(&random, box.min.y, box.max.y),
                      csg_random_uniform(&random, box.min.z, box.max.z)};
        w->longest = whole / 4;
        if (!walk_to(w, 0, 1e-9 * whole, &p))
            continue;
        csg_vec3 from = p;
        w->longest = fabs(by); /* follow the gradient closely */
        if (!walk_to(w, -by, 1e-6 * fabs(by), &p))
            continue;
        double moved = csg_vec3_norm(csg_vec3_sub(p, from));
        if (moved > out->most)
            *out = (csg_growth){moved, from};
    }
}

csgm_status csg_sample_growth(csg_solid_job *job, csg_node_id node, double by, csg_growth *out)
{
    csgm_scene *scene = NULL;
    *out = (csg_growth){0, {0, 0, 0}};
    csg_box box = csg_build_box(job->builder, node);
    if (csg_solid_is_flat(job, node))
        box.min.z = box.max.z = 0;
    if (by == 0 || csg_box_is_empty(box) || !csg_box_is_finite(box))
        return job->builder->status;
    csgm_status status = csg_build_snapshot(job->builder, node, &scene);
    if (status != CSGM_OK)
        return status;
    growth_walk w = {.scene = scene, .status = CSGM_OK};
    sample_growth(&w, box, by, out);
    csg_scene_destroy(scene);
    return w.status;
}
