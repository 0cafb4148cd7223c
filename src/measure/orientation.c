/* SPDX-License-Identifier: MIT
 * The orientation of a small box; see orientation.h. A smallest box of a polyhedron has two faces
 * next to each other that are flush with edges of its hull (O'Rourke, Finding minimal enclosing
 * boxes, International Journal of Computer and Information Sciences 14, 1985); mostly one face is
 * flush with one of the hull. So the solid is known by points that reach farthest in many
 * directions; from boxes flush with faces of these points' hull, turned in steps, and from some
 * that are turned anyhow, small rotations go downhill. What the solid has beyond the box that is
 * found is added to the points, until it has nothing there. That no smaller box is in another
 * valley is not shown.
 */
#include "measure/orientation.h"

#include <math.h>
#include <string.h>

#include "base/random.h"
#include "shape/polyhedra/hull.h"

enum {
    PAIRS = 80 /* of directions that are asked first, there and back */,
    ROUNDS = 12,
    MOST_POINTS = 2 * PAIRS + CSG_BOX_FACES * (ROUNDS + 1),
    TURNS = 12 /* by 7.5 degrees: a quarter of a turn */,
    ANYHOW = 40 /* random starts */,
    STARTS = 12 /* of which so many are made better */,
    TRIES = 12,
    MOST_TRIES = 20000
};

/* tan of half the angle of a step. */
static const double STEP = 0.065543462815238228;

typedef struct frame {
    csg_vec3 axes[3];
    double volume; /* of the cloud's box */
} frame;

typedef struct cloud {
    csg_memory *memory;
    csg_vec3 points[MOST_POINTS];
    size_t count;
    double finest;      /* step that still matters */
    frame best[STARTS]; /* the smallest first */
    int best_count;
} cloud;

static const frame UPRIGHT = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, INFINITY};

/* ---- boxes of points ---------------------------------------------------------------------------
 */

static double volume_of(const cloud *c, const csg_vec3 axes[3])
{
    double volume = 1;
    for (int k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < c->count; i++) {
            double at = csg_vec3_dot(axes[k], c->points[i]);
            low = fmin(low, at);
            high = fmax(high, at);
        }
        volume *= high - low;
    }
    return volume;
}

/* By 2 atan |half| around this direction: the quaternion (1, half). */
static csg_vec3 turned(csg_vec3 v, csg_vec3 half)
{
    double square = csg_vec3_dot(half, half);
    csg_vec3 across = csg_vec3_cross(half, v);
    csg_vec3 by = csg_vec3_add(across, csg_vec3_cross(half, across));
    return csg_vec3_add(v, csg_vec3_scale(by, 2 / (1 + square)));
}

/* At right angles to rounding, whatever turned them. */
static frame tidy(frame f)
{
    f.axes[0] = csg_vec3_normalize(f.axes[0]);
    f.axes[2] = csg_vec3_normalize(csg_vec3_cross(f.axes[0], f.axes[1]));
    f.axes[1] = csg_vec3_cross(f.axes[2], f.axes[0]);
    return f;
}

static frame turn_frame(const cloud *c, const frame *f, csg_vec3 half)
{
    frame out;
    for (int k = 0; k < 3; k++)
        out.axes[k] = turned(f->axes[k], half);
    out = tidy(out);
    out.volume = volume_of(c, out.axes);
    return out;
}

/* ---- starts ------------------------------------------------------------------------------------
 */

static void keep(cloud *c, frame f)
{
    int at = c->best_count < STARTS ? c->best_count++ : STARTS;
    if (at == STARTS) {
        if (!(f.volume < c->best[STARTS - 1].volume))
            return;
        at = STARTS - 1;
    }
    for (; at > 0 && c->best[at - 1].volume > f.volume; at--)
        c->best[at] = c->best[at - 1];
    c->best[at] = f;
}

/* The best of the boxes that stand on this face. */
static void keep_flush(cloud *c, csg_vec3 normal, csg_vec3 edge)
{
    frame f = tidy((frame){.axes = {normal, edge, {0, 0, 0}}}), best = f;
    best.volume = INFINITY;
    for (int i = 0; i < TURNS; i++) {
        f = turn_frame(c, &f, csg_vec3_scale(f.axes[0], STEP));
        if (f.volume < best.volume)
            best = f;
    }
    keep(c, best);
}

/* False: out of memory. Points in one plane have no hull, and need none. */
static bool keep_flush_ones(cloud *c)
{
    csg_triangles hull;
    csg_triangles_init(&hull, c->memory);
    csgm_status status =
        csg_hull_is_available() ? csg_hull(c->memory, c->points, c->count, &hull) : CSGM_OK;
    for (size_t i = 0; status == CSGM_OK && i < hull.count; i++) {
        const uint32_t *t = hull.corners[i];
        csg_vec3 edge = csg_vec3_sub(hull.points[t[1]], hull.points[t[0]]);
        csg_vec3 normal = csg_vec3_cross(edge, csg_vec3_sub(hull.points[t[2]], hull.points[t[0]]));
        if (csg_vec3_norm(normal) > 0)
            keep_flush(c, csg_vec3_normalize(normal), csg_vec3_normalize(edge));
    }
    csg_triangles_release(&hull);
    return status != CSGM_ERR_MEMORY;
}

static csg_vec3 random_vector(csg_random *dice, double size)
{
    double x = csg_random_uniform(dice, -size, size), y = csg_random_uniform(dice, -size, size);
    return csg_vec3_make(x, y, csg_random_uniform(dice, -size, size));
}

static frame improved(const cloud *c, frame f, csg_random *dice)
{
    int tries = 0;
    for (double step = STEP; step > c->finest && tries < MOST_TRIES;) {
        bool better = false;
        for (int i = 0; i < TRIES; i++, tries++) {
            csg_vec3 half = i < 6 ? csg_vec3_scale(f.axes[i / 2], i % 2 ? step : -step)
                                  : random_vector(dice, step);
            frame next = turn_frame(c, &f, half);
            if (next.volume < f.volume) {
                f = next;
                better = true;
            }
        }
        step *= better ? 1 : 0.5;
    }
    return f;
}

/* False: out of memory. */
static bool begin(cloud *c)
{
    csg_random dice = {1985};
    if (!keep_flush_ones(c))
        return false;
    for (int i = 0; i < ANYHOW; i++)
        keep(c, turn_frame(c, &UPRIGHT, random_vector(&dice, 1)));
    return true;
}

/* Makes the starts better, for the points that there are now. The box along the coordinate axes is
 * as good as one that is hardly smaller. */
static frame find_smallest(cloud *c)
{
    static const double HARDLY = 1e-7;
    csg_random dice = {1985};
    frame upright = UPRIGHT;
    upright.volume = volume_of(c, upright.axes);
    frame out = improved(c, upright, &dice);
    for (int i = 0; i < c->best_count; i++) {
        frame *f = &c->best[i];
        f->volume = volume_of(c, f->axes);
        *f = improved(c, *f, &dice);
        if (f->volume < out.volume)
            out = *f;
    }
    return upright.volume <= out.volume * (1 + HARDLY) ? upright : out;
}

/* ---- the solid ---------------------------------------------------------------------------------
 */

static void add_points(cloud *c, const csg_support_point *reaches, size_t count)
{
    for (size_t i = 0; i < count && c->count < MOST_POINTS; i++)
        if (reaches[i].is_found)
            c->points[c->count++] = reaches[i].at;
}

/* Spread evenly over the sphere, each with the one across: a spiral by the golden ratio. */
static void spread(csg_vec3 directions[2 * PAIRS])
{
    static const double COS = -0.73736887807831986, SIN = 0.67549029426152362; /* golden angle */
    double x = 1, y = 0;
    for (int i = 0; i < PAIRS; i++) {
        double z = (i + 0.5) / PAIRS, r = sqrt(1 - z * z), turned_x = x * COS - y * SIN;
        directions[2 * i] = csg_vec3_normalize(csg_vec3_make(r * x, r * y, z));
        directions[2 * i + 1] = csg_vec3_scale(directions[2 * i], -1);
        y = x * SIN + y * COS;
        x = turned_x;
    }
}

static double volume_of_box(const csg_orientation *o)
{
    double volume = 1;
    for (int k = 0; k < 3; k++)
        volume *= o->reaches[k].high + o->reaches[3 + k].high;
    return volume;
}

static csgm_status ask(csg_reacher *reach, void *user, const frame *f, double tolerance,
                       csg_orientation *out)
{
    csg_vec3 directions[CSG_BOX_FACES];
    for (int k = 0; k < 3; k++) {
        out->axes[k] = f->axes[k];
        directions[k] = csg_vec3_scale(f->axes[k], -1);
        directions[3 + k] = f->axes[k];
    }
    return reach(user, directions, CSG_BOX_FACES, tolerance, out->reaches);
}

csgm_status csg_orientation_find(csg_memory *memory, csg_reacher *reach, void *user, double size,
                                 double tolerance, csg_orientation *out)
{
    static const double COARSE = 1e-3, FINE = 0.01, FINEST = 1e-11;
    cloud c = {.memory = memory, .finest = fmax(FINEST, FINE * tolerance / size)};
    csg_vec3 directions[2 * PAIRS];
    csg_support_point reaches[2 * PAIRS];
    csgm_status status = ask(reach, user, &UPRIGHT, tolerance, out);
    if (status != CSGM_OK)
        return status;
    add_points(&c, out->reaches, CSG_BOX_FACES);
    spread(directions);
    status = reach(user, directions, 2 * PAIRS, fmax(tolerance, COARSE * size), reaches);
    if (status == CSGM_OK)
        add_points(&c, reaches, 2 * PAIRS);
    if (status == CSGM_OK && c.count && !begin(&c))
        return CSGM_ERR_MEMORY;
    for (int round = 1; round < ROUNDS && status == CSGM_OK && c.count; round++) {
        csg_orientation next;
        frame f = find_smallest(&c);
        /* all boxes of the points are as large, so those of the solid are */
        if (f.volume >= volume_of_box(out) * (1 - tolerance / size))
            break;
        status = ask(reach, user, &f, tolerance, &next);
        if (status == CSGM_OK && volume_of_box(&next) < volume_of_box(out))
            *out = next;
        if (status == CSGM_OK)
            add_points(&c, next.reaches, CSG_BOX_FACES);
    }
    return status;
}
