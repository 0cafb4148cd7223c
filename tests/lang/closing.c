/* SPDX-License-Identifier: MIT
 * See closing.h. Distances to convex solids are convex: a step to where the distances' tangent
 * planes promise more is never worse than promised, so that the centre only climbs. To tori they
 * are not, and a step that loses is halved.
 */
#include "lang/closing.h"

#include <math.h>

/* A tangent plane's distance at the point's offset s: a + n . s. */
typedef struct plane {
    double a;
    csg_vec3 n;
} plane;

bool closing_begin(closing *c, const csgm_scene *scene, double r)
{
    const csg_node *root = &scene->nodes[scene->root];
    *c = (closing){.scene = scene, .r = r, .count = root->child_count};
    csg_node_id next = 0;
    for (uint32_t k = 0; k < c->count; k++) { /* nodes below each stand right before it */
        c->operands[k] = csg_scene_children(scene, root)[k];
        c->first[k] = next;
        next = c->operands[k] + 1;
    }
    return csg_reference_room_begin(&c->room, scene);
}

void closing_end(closing *c)
{
    csg_reference_room_end(&c->room, c->scene);
}

void closing_operands(closing *c, csg_vec3 p, csg_sample *out)
{
    for (uint32_t k = 0; k < c->count; k++)
        out[k] = csg_reference_below(&c->room, c->scene, c->first[k], c->operands[k], p);
}

/* ---- the best offset for tangent planes ------------------------------------------------------- */

static double least(const plane *planes, uint32_t count, csg_vec3 s)
{
    double value = INFINITY;
    for (uint32_t i = 0; i < count; i++)
        value = fmin(value, planes[i].a + csg_vec3_dot(planes[i].n, s));
    return value;
}

typedef struct best {
    csg_vec3 s;
    double value;
} best;

static void offer(best *b, const plane *planes, uint32_t count, csg_vec3 s)
{
    double value = least(planes, count, s);
    if (value > b->value)
        *b = (best){s, value};
}

/* The longest way along `n` from `s` on, across `to_s`, within r. */
static csg_vec3 to_sphere(csg_vec3 s, csg_vec3 n, double r)
{
    double rest = r * r - csg_vec3_dot(s, s), length = csg_vec3_norm(n);
    if (!(rest > 0) || !(length > 1e-12))
        return s;
    return csg_vec3_add(s, csg_vec3_scale(n, sqrt(rest) / length));
}

static void offer_pair(best *b, const plane *planes, uint32_t count, const plane *p, const plane *q,
                       double r)
{
    csg_vec3 e = csg_vec3_sub(q->n, p->n);
    double square = csg_vec3_dot(e, e);
    if (!(square > 1e-16))
        return;
    csg_vec3 s = csg_vec3_scale(e, (p->a - q->a) / square);
    if (csg_vec3_norm(s) > r)
        return;
    csg_vec3 along = csg_vec3_sub(p->n, csg_vec3_scale(e, csg_vec3_dot(p->n, e) / square));
    offer(b, planes, count, to_sphere(s, along, r));
}

static void offer_triple(best *b, const plane *planes, uint32_t count, double r)
{
    csg_vec3 e = csg_vec3_sub(planes[1].n, planes[0].n);
    csg_vec3 f = csg_vec3_sub(planes[2].n, planes[0].n), u = csg_vec3_cross(e, f);
    double square = csg_vec3_dot(u, u);
    if (!(square > 1e-20))
        return;
    double be = planes[0].a - planes[1].a, bf = planes[0].a - planes[2].a;
    csg_vec3 s = csg_vec3_scale(csg_vec3_add(csg_vec3_scale(csg_vec3_cross(f, u), be),
                                             csg_vec3_scale(csg_vec3_cross(u, e), bf)),
                                1 / square);
    if (csg_vec3_norm(s) > r)
        return;
    offer(b, planes, count, to_sphere(s, u, r));
    offer(b, planes, count, to_sphere(s, csg_vec3_scale(u, -1), r));
}

/* Where in the ball of radius r the nearest of the planes is farthest. At the optimum one, two or
 * three of them are equally near: all such places are tried. */
static best best_offset(const plane *planes, uint32_t count, double r)
{
    best b = {{0, 0, 0}, -INFINITY};
    for (uint32_t i = 0; i < count; i++) {
        offer(&b, planes, count, csg_vec3_scale(planes[i].n, r));
        for (uint32_t k = i + 1; k < count; k++)
            offer_pair(&b, planes, count, &planes[i], &planes[k], r);
    }
    if (count == 3)
        offer_triple(&b, planes, count, r);
    return b;
}

/* ---- the centre ------------------------------------------------------------------------------- */

static double nearest(closing *c, csg_vec3 at, csg_vec3 p, plane *planes)
{
    csg_sample samples[CLOSING_MOST];
    double distance = INFINITY;
    closing_operands(c, at, samples);
    for (uint32_t k = 0; k < c->count; k++) {
        double d = -samples[k].value;
        csg_vec3 n = csg_vec3_scale(samples[k].gradient, -1);
        planes[k] = (plane){d - csg_vec3_dot(n, csg_vec3_sub(at, p)), n};
        distance = fmin(distance, d);
    }
    return distance;
}

/* Whether a ball reaches p whose centre is found from `at` on. */
static bool reaches(closing *c, csg_vec3 p, csg_vec3 at)
{
    plane planes[CLOSING_MOST], next_planes[CLOSING_MOST];
    double distance = nearest(c, at, p, planes), r = c->r;
    for (int i = 0; i < 40; i++) {
        if (distance >= r)
            return true;
        best b = best_offset(planes, c->count, r);
        csg_vec3 next = csg_vec3_add(p, b.s);
        double got = nearest(c, next, p, next_planes);
        for (int k = 0; k < 4 && got < distance; k++) {
            next = csg_vec3_scale(csg_vec3_add(next, at), 0.5);
            got = nearest(c, next, p, next_planes);
        }
        if (!(got > distance + 1e-9 * r))
            return got >= r;
        at = next;
        distance = got;
        for (uint32_t k = 0; k < c->count; k++)
            planes[k] = next_planes[k];
    }
    return distance >= r;
}

bool closing_holds(closing *c, csg_vec3 p)
{
    if (reaches(c, p, p))
        return false;
    for (int k = 0; k < 27; k++) { /* six sides and eight corners */
        csg_vec3 way = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
        double square = csg_vec3_dot(way, way);
        bool is_start = square == 1 || square == 3;
        if (is_start && reaches(c, p, csg_vec3_add(p, csg_vec3_scale(way, c->r / sqrt(square)))))
            return false;
    }
    return true;
}
