/* SPDX-License-Identifier: MIT
 * Cubes of the search for missed parts; see missed_cube.h.
 */
#include "mesh/distance/missed_cube.h"

#include <math.h>
#include <string.h>

#include "mesh/distance/slopes.h"
#include "mesh/plane.h"

typedef csg_missed_cube cube;
typedef csg_missed_field field;
typedef csg_missed_place place;
typedef csg_missed_content content;

/* How near a sheet's gradients must be to their middle, of the field's slope. A sheet that leans
 * farther is looked at in eight places; of one that leans less no place is farther from the mesh
 * than others by more than a twentieth. */
static const double SMOOTH = 0.5, CREASED = 0.45, LEANING = 0.2, LEVEL = 0.95;

/* ---- the field in a cube --------------------------------------------------------------------- */

/* Values this small are zero. */
static double noise_of(const field *w)
{
    return 4 * (double)w->remesh->probe.noise;
}

enum { SEEDS = CSG_LANES };

/* Places that go to the surface, and the field where they are. */
typedef struct seeds {
    csg_vec3 at[SEEDS], slope[SEEDS];
    double value[SEEDS];
    uint32_t count, moving[SEEDS], moving_count; /* those that are still on their way */
} seeds;

static void add_seed(seeds *to, csg_vec3 at)
{
    to->moving[to->moving_count++] = to->count;
    to->at[to->count++] = at;
}

/* What is asked in a cube and those around it: the field, or what stands for it where solids touch,
 * which is zero at the surface alone. */
static csg_touching field_in(const field *w, const cube *q)
{
    double radius = sqrt(3.0) * (q->half + q->around);
    return csg_touching_find(w->remesh->probe.marching->kernel, &q->tape, q->c, radius);
}

/* The field where those are that move. */
static void ask(const field *w, const csg_touching *in, seeds *of)
{
    float at[3][SEEDS] = {{0}}, f[SEEDS], g[3][SEEDS];
    for (uint32_t k = 0; k < of->moving_count; k++) {
        csg_vec3 p = of->at[of->moving[k]];
        at[0][k] = (float)p.x, at[1][k] = (float)p.y, at[2][k] = (float)p.z;
    }
    csg_touching_values_and_gradients(in, w->remesh->probe.marching->kernel, at[0], at[1], at[2],
                                      of->moving_count, f, g[0], g[1], g[2], w->scratch,
                                      w->scratch_floats);
    for (uint32_t k = 0; k < of->moving_count; k++) {
        of->value[of->moving[k]] = (double)f[k];
        of->slope[of->moving[k]] = csg_vec3_make((double)g[0][k], (double)g[1][k], (double)g[2][k]);
    }
}

/* Seeds that were asked for go to places of the surface that are no farther off along any axis than
 * `reach`, by Newton's steps; is_found: which do. All go at once: a walk over the tape for sixteen
 * places costs what it does for one. */
static void find_surfaces(const field *w, const csg_touching *in, double reach, seeds *of,
                          bool is_found[SEEDS])
{
    enum { STEPS = 6 };
    double noise = noise_of(w);
    csg_vec3 begin[SEEDS];
    memcpy(begin, of->at, of->count * sizeof *begin);
    for (int step = 0;; step++) {
        uint32_t left = 0;
        for (uint32_t k = 0; k < of->moving_count; k++) {
            uint32_t i = of->moving[k];
            double square = csg_vec3_dot(of->slope[i], of->slope[i]);
            is_found[i] = fabs(of->value[i]) <= noise;
            if (is_found[i] || step == STEPS || !(square > 1e-6))
                continue;
            of->at[i] =
                csg_vec3_sub(of->at[i], csg_vec3_scale(of->slope[i], of->value[i] / square));
            csg_vec3 off = csg_vec3_sub(of->at[i], begin[i]);
            if (fabs(off.x) <= reach && fabs(off.y) <= reach && fabs(off.z) <= reach)
                of->moving[left++] = i;
        }
        of->moving_count = left;
        if (!left)
            return;
        ask(w, in, of);
    }
}

/* How far around its middle a cube's places of the surface may lie. */
static double reach_of(const cube *q)
{
    return q->half + 0.9 * q->around;
}

enum { RINGS = 4 }; /* around a place of the surface, each a quarter of that before it */

/* What is not as deep has no room for a gap, or a wall. */
static double least_depth(const field *w)
{
    double last = 0.25 * w->error / (1 << 2 * (RINGS - 1));
    return fmax(noise_of(w), last);
}

bool csg_missed_is_border(const field *w, const cube *q, const place *at_zero)
{
    enum { WAYS = 6, PLACES = 2 + RINGS * WAYS, PADDED = PLACES + CSG_LANES };
    float at[3][PADDED] = {{0}}, f[PADDED] = {0};
    csg_vec3 p = at_zero->at, uphill = csg_vec3_normalize(at_zero->slope);
    double noise = noise_of(w), reach = 0.25 * w->error;
    for (int i = 0; i < PLACES; i++) {
        int ring = (i - 2) / WAYS, way = (i - 2) % WAYS / 2;
        double step = (i % 2 ? reach : -reach) / (i < 2 ? 1 : 1 << 2 * ring);
        csg_vec3 off = {way == 0 ? step : 0, way == 1 ? step : 0, way == 2 ? step : 0};
        csg_vec3 to = csg_vec3_add(p, i < 2 ? csg_vec3_scale(uphill, step) : off);
        at[0][i] = (float)to.x, at[1][i] = (float)to.y, at[2][i] = (float)to.z;
    }
    w->remesh->probe.marching->kernel->values(&q->tape, at[0], at[1], at[2], PLACES, f, w->scratch,
                                              w->scratch_floats);
    bool inside = false, outside = false;
    for (int i = 0; i < PLACES; i++) {
        inside |= (double)f[i] > noise;
        outside |= (double)f[i] < -noise;
    }
    return inside && outside;
}

/* Whether the field is too far from zero in the middle to be it anywhere in the cube. */
static bool is_far_from_zero(const field *w, const cube *q)
{
    return fabs(q->value) > q->steepest * q->half + q->doubt + noise_of(w);
}

/* How near all gradients are at least to one direction where the field is zero, of the steepest
 * there. */
static double leaning_of(const csg_gradients *gradients)
{
    double steepest = 0;
    csg_cone cone;
    bool has_level = gradients->has_level;
    const csg_cone_balls *balls = has_level ? &gradients->level : &gradients->balls;
    for (uint32_t i = 0; i < balls->count; i++) {
        const double *g = balls->items[i].at;
        steepest = fmax(steepest, csg_vec3_norm(csg_vec3_make(g[0], g[1], g[2])));
    }
    bool has_axis =
        has_level ? csg_cone_find_axis(balls, &cone) : csg_gradients_find_axis(gradients, &cone);
    return has_axis ? cone.least / steepest : 0;
}

/* ---- where a sheet turns -----------------------------------------------------------------------
 * A mesh that cuts off a crease can be within the error of both faces, so near to every place of
 * these that is looked at, and still be farther from the crease.
 */

/* Of a unit gradient, so that planes of different steepness compare. */
static bool find_plane(csg_vec3 at, double value, csg_vec3 gradient, csg_plane *out)
{
    double norm = csg_vec3_norm(gradient);
    if (!(norm > 1e-3))
        return false;
    *out = csg_plane_of(at, value / norm, csg_vec3_scale(gradient, 1 / norm));
    return true;
}

/* Planes of the two faces that turn most from each other, as the cube's corners and its middle
 * show them. */
static bool find_faces(const field *w, const csg_touching *in, const cube *q, csg_plane faces[2])
{
    float at[3][CSG_LANES] = {{0}}, g[3][CSG_LANES], f[CSG_LANES];
    csg_plane planes[CSG_OCTANTS + 1] = {{{0, 0, 0}, 0}};
    uint32_t count = 0;
    double least = 1, step = q->half;
    for (int i = 0; i < CSG_OCTANTS; i++) {
        at[0][i] = (float)(q->c.x + (i & 1 ? step : -step));
        at[1][i] = (float)(q->c.y + (i & 2 ? step : -step));
        at[2][i] = (float)(q->c.z + (i & 4 ? step : -step));
    }
    csg_touching_values_and_gradients(in, w->remesh->probe.marching->kernel, at[0], at[1], at[2],
                                      CSG_OCTANTS, f, g[0], g[1], g[2], w->scratch,
                                      w->scratch_floats);
    count += find_plane(q->c, q->value, q->slope, &planes[count]);
    for (int i = 0; i < CSG_OCTANTS; i++) {
        csg_vec3 p = {(double)at[0][i], (double)at[1][i], (double)at[2][i]};
        csg_vec3 slope = {(double)g[0][i], (double)g[1][i], (double)g[2][i]};
        count += find_plane(p, (double)f[i], slope, &planes[count]);
    }
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < i; k++) {
            double cosine = csg_vec3_dot(planes[i].g, planes[k].g);
            if (cosine >= least)
                continue;
            least = cosine;
            faces[0] = planes[i];
            faces[1] = planes[k];
        }
    return least < LEVEL;
}

/* The plane in which solids touch, and that of the surface where it meets the seam. */
static bool find_seam(const field *w, const csg_touching *in, const cube *q, csg_plane faces[2])
{
    double norm = csg_vec3_norm(in->slope), side = csg_touching_side(in, q->c) / norm;
    seeds at = {.count = 0};
    if (fabs(side) > sqrt(3.0) * reach_of(q))
        return false;
    csg_vec3 normal = csg_vec3_scale(in->slope, 1 / norm);
    csg_vec3 foot = csg_vec3_sub(q->c, csg_vec3_scale(normal, side));
    faces[0] = csg_plane_of(foot, 0, normal);
    add_seed(&at, foot);
    ask(w, in, &at);
    return find_plane(foot, at.value[0], at.slope[0], &faces[1]);
}

/* Along the line in which two planes meet, in the cube; beside it places are another cube's. */
static void add_seeds_along(const cube *q, const csg_plane faces[2], seeds *to)
{
    static const double LEAST_SQUARE = 0.05; /* of the sine */
    csg_vec3 middle = q->c;
    if (!csg_planes_meet_in_line(faces, LEAST_SQUARE, &middle))
        return;
    csg_vec3 along = csg_vec3_normalize(csg_vec3_cross(faces[0].g, faces[1].g));
    for (int i = 0; i < CSG_MISSED_TURNS; i++) {
        double step = (2.0 * i / (CSG_MISSED_TURNS - 1) - 1) * q->half;
        csg_vec3 at = csg_vec3_add(middle, csg_vec3_scale(along, step));
        csg_vec3 off = csg_vec3_sub(at, q->c);
        if (fmax(fabs(off.x), fmax(fabs(off.y), fabs(off.z))) <= reach_of(q))
            add_seed(to, at);
    }
}

uint32_t csg_missed_find_turns(const field *w, const cube *q, place out[CSG_MISSED_MOST_TURNS])
{
    csg_plane faces[2] = {{{0, 0, 0}, 0}};
    seeds from = {.count = 0};
    bool is_found[SEEDS];
    uint32_t count = 0;
    const csg_touching in = field_in(w, q);
    if (find_faces(w, &in, q, faces))
        add_seeds_along(q, faces, &from);
    if (in.is_there && find_seam(w, &in, q, faces))
        add_seeds_along(q, faces, &from);
    if (!from.count)
        return 0;
    ask(w, &in, &from);
    find_surfaces(w, &in, reach_of(q), &from, is_found);
    for (uint32_t i = 0; i < from.count; i++)
        if (is_found[i])
            out[count++] = (place){from.at[i], from.slope[i]};
    return count;
}

static bool has_several_balls(const csg_gradients *gradients)
{
    return (gradients->has_level ? gradients->level.count : gradients->balls.count) > 1;
}

/* What these gradients say that there is in the cube. */
static content content_of(const field *w, cube *q, const csg_gradients *gradients)
{
    q->steepest = fmin(q->steepest, csg_gradients_steepest(gradients));
    q->doubt = fmax(q->doubt, gradients->doubt);
    if (is_far_from_zero(w, q) || gradients->least > -least_depth(w) ||
        gradients->most < least_depth(w))
        return CSG_MISSED_NOTHING; /* or a face that solids share */
    double leaning = leaning_of(gradients);
    q->is_sheet = leaning >= LEANING;
    q->is_bent = leaning < LEVEL;
    return leaning >= (has_several_balls(gradients) ? CREASED : SMOOTH) ? CSG_MISSED_SHEET
                                                                        : CSG_MISSED_ANYTHING;
}

/* Of cubes with one tape. */
static csg_touching field_in_all(const field *w, cube *const *cubes, size_t count)
{
    double radius = 0;
    for (size_t i = 0; i < count; i++) {
        double off = csg_vec3_norm(csg_vec3_sub(cubes[i]->c, cubes[0]->c));
        radius = fmax(radius, off + sqrt(3.0) * cubes[i]->half);
    }
    return csg_touching_find(w->remesh->probe.marching->kernel, &cubes[0]->tape, cubes[0]->c,
                             radius);
}

void csg_missed_find_contents(const field *w, cube *const *cubes, size_t count)
{
    csg_gradients_region all[CSG_OCTANTS] = {0};
    csg_gradients gradients[CSG_OCTANTS], *found[CSG_OCTANTS] = {NULL}; /* not filled: large */
    bool is_known[CSG_OCTANTS];
    for (size_t i = 0; i < count; i++) {
        csg_vec3 c = cubes[i]->c;
        all[i] = (csg_gradients_region){{c, c, c}, c, 0, cubes[i]->half};
        found[i] = &gradients[i];
    }
    const csg_touching in = field_in_all(w, cubes, count);
    csg_gradients_find_each(w->remesh->probe.marching->kernel, &in, all, count, w->scratch,
                            w->scratch_floats, found, is_known);
    for (size_t i = 0; i < count; i++)
        cubes[i]->what = is_known[i] ? content_of(w, cubes[i], &gradients[i]) : CSG_MISSED_ANYTHING;
}

bool csg_missed_is_empty(const field *w, const cube *q)
{
    return fabs(q->value) > w->lipschitz * sqrt(3.0) * q->half + noise_of(w) ||
           is_far_from_zero(w, q);
}

void csg_missed_place_children(const cube *parent, float c[3][CSG_OCTANTS])
{
    const double at[3] = {parent->c.x, parent->c.y, parent->c.z};
    for (int axis = 0; axis < 3; axis++)
        for (int o = 0; o < CSG_OCTANTS; o++)
            c[axis][o] = (float)(at[axis] + (o >> axis & 1 ? 0.5 : -0.5) * parent->half);
}

void csg_missed_find_surfaces(const field *w, const cube *parent, cube *children, uint32_t count)
{
    seeds from = {.count = 0};
    bool is_found[SEEDS] = {false};
    for (uint32_t i = 0; i < count; i++)
        add_seed(&from, children[i].c);
    const csg_touching in = field_in(w, parent);
    ask(w, &in, &from);
    from.moving_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        children[i].value = from.value[i];
        children[i].slope = from.slope[i];
        if (!csg_missed_is_empty(w, &children[i]))
            from.moving[from.moving_count++] = i;
    }
    find_surfaces(w, &in, reach_of(&children[0]), &from, is_found);
    for (uint32_t i = 0; i < count; i++) {
        children[i].has_surface = is_found[i];
        children[i].is_asked = false;
        children[i].surface = (place){from.at[i], from.slope[i]};
    }
}

bool csg_missed_leads_out(const cube *q)
{
    csg_vec3 off = csg_vec3_sub(q->surface.at, q->c);
    return fmax(fabs(off.x), fmax(fabs(off.y), fabs(off.z))) > reach_of(q);
}
