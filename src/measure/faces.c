/* SPDX-License-Identifier: MIT
 * Faces by direction; see faces.h. Sums of triangles' areas; where rounding leaves it open on which
 * side of an angle a triangle is, its area is in the upper end alone.
 */
#include "measure/faces.h"

#include <math.h>

#include "base/trace.h"
#include "measure/measure.h"
#include "measure/mesh_points.h"

/* Of a normal, as a share of the product of the two edges it comes from: six products and three
 * differences of what was rounded once. */
static const double ROUNDING = 0x1p-49;

typedef struct sum {
    double low, high;
} sum;

typedef struct tally {
    csg_vec3 up;          /* of unit length */
    double lowest, level; /* the least height, and how far above it is still the same */
    double cosine, sine;  /* of the overhang's angle, of the draft's */
    double sizes;         /* of products of edges */
    sum area, overhang, resting, steep;
} tally;

static void add(sum *s, double area, bool is_sure, bool may_be)
{
    s->low += is_sure ? area : 0;
    s->high += is_sure || may_be ? area : 0;
}

static void add_triangle(tally *t, const csg_vec3 at[3], csgm_faces *out)
{
    csg_vec3 a = csg_vec3_sub(at[1], at[0]), b = csg_vec3_sub(at[2], at[0]);
    csg_vec3 normal = csg_vec3_cross(a, b);
    double size = csg_vec3_norm(a) * csg_vec3_norm(b), length = csg_vec3_norm(normal);
    double slack = 4 * ROUNDING * size, along = csg_vec3_dot(normal, t->up), highest = -INFINITY;
    double down = -along - t->cosine * length, flat = t->sine * length - fabs(along);
    for (int i = 0; i < 3; i++)
        highest = fmax(highest, csg_vec3_dot(at[i], t->up));
    bool rests = highest <= t->lowest + t->level;
    t->sizes += size;
    add(&t->area, length / 2, true, true);
    add(&t->overhang, length / 2, down > slack, down >= -slack);
    add(&t->resting, length / 2, rests && down > slack, rests && down >= -slack);
    add(&t->steep, length / 2, flat > slack, flat >= -slack);
    out->overhang_triangles += down > slack;
    out->steep_triangles += flat > slack;
}

static csgm_interval interval_of(const sum *s, const tally *t, uint64_t count)
{
    double slack = ROUNDING * t->sizes + (double)count * 0x1p-52 * t->area.high;
    return (csgm_interval){fmax(s->low - slack, 0), s->high > 0 ? s->high + slack : 0};
}

csgm_status csg_faces_of_mesh(csgm_context *context, const csgm_mesh_view *mesh,
                              const csgm_face_options *options, csgm_faces *out)
{
    CSG_ZONE(context, "faces");
    static const double LEVEL = 1e-6; /* of the size: floats of a plane that is turned */
    tally t = {.up = csg_vec3_normalize(options->up), .lowest = INFINITY};
    csg_mesh_points points;
    double ignored;
    csg_sin_cos_deg(options->overhang_deg, &ignored, &t.cosine);
    csg_sin_cos_deg(options->draft_deg, &t.sine, &ignored);
    if (!mesh->triangle_count)
        return csg_measure_refuse_empty(context);
    csgm_status status = csg_mesh_points_gather(&points, context, mesh);
    for (size_t i = 0; i < points.count && status == CSGM_OK; i++)
        t.lowest = fmin(t.lowest, csg_vec3_dot(points.items[i], t.up));
    t.level = LEVEL * points.size;
    for (uint64_t i = 0; i < mesh->triangle_count && status == CSGM_OK; i++) {
        csg_vec3 at[3];
        for (int k = 0; k < 3; k++)
            at[k] =
                csg_vec3_sub(csg_vec3_from_floats(mesh->positions +
                                                  3 * (size_t)mesh->indices[3 * i + (uint64_t)k]),
                             points.origin);
        add_triangle(&t, at, out);
    }
    csg_mesh_points_release(&points, context);
    if (status != CSGM_OK)
        return status;
    out->area = interval_of(&t.area, &t, mesh->triangle_count);
    out->overhang = interval_of(&t.overhang, &t, mesh->triangle_count);
    out->resting = interval_of(&t.resting, &t, mesh->triangle_count);
    out->steep = interval_of(&t.steep, &t, mesh->triangle_count);
    return CSGM_OK;
}
