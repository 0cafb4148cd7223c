/* SPDX-License-Identifier: MIT
 * Warps in double; see warp.h and warps.def.
 */
#include "scene/primitives/warp.h"

#include <assert.h>

#include "base/elementary.h"
#include "scene/warp_kinds.h"

#define PI 3.14159265358979323846

static csg_vec3 vec3(double x, double y, double z)
{
    return (csg_vec3){x, y, z};
}

/* ---- settling -------------------------------------------------------------------------------- */

static double farthest_from_axis(csg_box box)
{
    double x = fmax(fabs(box.min.x), fabs(box.max.x)), y = fmax(fabs(box.min.y), fabs(box.max.y));
    return csg_hypot(x, y);
}

static bool revolve_settle(csg_warp *warp, csg_box child, const char **why)
{
    return true;
}

static bool slice_settle(csg_warp *warp, csg_box child, const char **why)
{
    return true;
}

static bool twist_settle(csg_warp *warp, csg_box child, const char **why)
{
    double reach = csg_box_is_empty(child) ? 0 : 1.25 * farthest_from_axis(child);
    *why = "what is twisted must end somewhere";
    warp->parameters[CSG_TWIST_REACH] = reach;
    return isfinite(reach);
}

static bool taper_settle(csg_warp *warp, csg_box child, const char **why)
{
    double reach = csg_box_is_empty(child) ? 0 : 1.25 * farthest_from_axis(child);
    *why = "what is tapered must end somewhere";
    warp->parameters[CSG_TAPER_REACH] = reach;
    return isfinite(reach);
}

static bool bend_settle(csg_warp *warp, csg_box child, const char **why)
{
    double *v = warp->parameters, radius = v[CSG_BEND_RADIUS];
    const double most = 170 * PI / 180;
    if (csg_box_is_empty(child))
        child = (csg_box){{0, 0, 0}, {0, 0, 0}};
    double angle = fmax(fabs(child.min.x), fabs(child.max.x)) / radius;
    v[CSG_BEND_NEAREST] = (radius - child.max.z) / 2;
    v[CSG_BEND_ANGLE] = fmin((angle + PI) / 2, angle + 0.25);
    *why = "what is bent must end somewhere";
    if (!isfinite(angle) || !isfinite(v[CSG_BEND_NEAREST]))
        return false;
    *why = "it would go round more than 340 degrees";
    if (angle > most)
        return false;
    *why = "it is so thick that it reaches the line about which it is bent";
    return v[CSG_BEND_NEAREST] > 1e-3 * radius;
}

static bool elbow_settle(csg_warp *warp, csg_box child, const char **why)
{
    double *v = warp->parameters;
    csg_sin_cos_deg(v[CSG_ELBOW_HALF], &v[CSG_ELBOW_SINE], &v[CSG_ELBOW_COSINE]);
    return true;
}

static bool revolve_check(const double *v, csg_refusal *refusal)
{
    return true;
}

static bool slice_check(const double *v, csg_refusal *refusal)
{
    return true;
}

static bool twist_check(const double *v, csg_refusal *refusal)
{
    return v[CSG_TWIST_LOW] <= v[CSG_TWIST_HIGH] ||
           csg_refuse(refusal, "the twist ends below its beginning");
}

static bool taper_check(const double *v, csg_refusal *refusal)
{
    if (!(v[CSG_TAPER_LOW] < v[CSG_TAPER_HIGH]))
        return csg_refuse(refusal, "the taper ends at or below its beginning");
    return csg_check_positive(refusal, v[CSG_TAPER_X], "the scale along x") &&
           csg_check_positive(refusal, v[CSG_TAPER_Y], "the scale along y");
}

static bool bend_check(const double *v, csg_refusal *refusal)
{
    return csg_check_positive(refusal, v[CSG_BEND_RADIUS], "the radius");
}

static bool elbow_check(const double *v, csg_refusal *refusal)
{
    return (v[CSG_ELBOW_HALF] > 0 && v[CSG_ELBOW_HALF] < 90) ||
           csg_refuse(refusal, "half the angle must be above 0 and below 90 degrees");
}

/* ---- points ---------------------------------------------------------------------------------- */

static csg_warped revolve_at(const double *v, csg_vec3 p)
{
    double rho = csg_hypot(p.x, p.y);
    double cosine = rho > 0 ? p.x / rho : 0, sine = rho > 0 ? p.y / rho : 0;
    return (csg_warped){vec3(rho, p.z, 0), {vec3(cosine, 0, 0), vec3(sine, 0, 0), vec3(0, 1, 0)}};
}

static csg_warped slice_at(const double *v, csg_vec3 p)
{
    return (csg_warped){vec3(p.x, p.y, 0), {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 0)}};
}

static csg_warped twist_at(const double *v, csg_vec3 p)
{
    double low = v[CSG_TWIST_LOW], high = v[CSG_TWIST_HIGH], reach = v[CSG_TWIST_REACH];
    double rate = v[CSG_TWIST_RATE] * (PI / 180), rho = csg_hypot(p.x, p.y);
    double inward = rho > reach ? reach / rho : 1;
    double angle = -rate * fmin(fmax(p.z, low), high), c = csg_cos(angle), s = csg_sin(angle);
    double x = inward * (c * p.x - s * p.y), y = inward * (s * p.x + c * p.y);
    double turning = p.z > low && p.z < high ? -rate : 0;
    csg_warped out = {vec3(x, y, p.z),
                      {vec3(inward * c, inward * s, 0), vec3(-inward * s, inward * c, 0),
                       vec3(-turning * y, turning * x, 1)}};
    if (rho <= reach || rho == 0)
        return out;
    for (int i = 0; i < 2; i++) { /* beyond the reach only the part around the axis is left */
        csg_vec3 away = vec3(x / reach, y / reach, 0), *column = &out.column[i];
        *column = csg_vec3_sub(*column, csg_vec3_scale(away, csg_vec3_dot(away, *column)));
    }
    return out;
}

/* A twist of what was divided, by the chain rule. */
static csg_warped taper_at(const double *v, csg_vec3 p)
{
    const double twist[CSG_WARP_PARAMETERS] = {[CSG_TWIST_RATE] = v[CSG_TAPER_RATE],
                                               [CSG_TWIST_LOW] = v[CSG_TAPER_LOW],
                                               [CSG_TWIST_HIGH] = v[CSG_TAPER_HIGH],
                                               [CSG_TWIST_REACH] = v[CSG_TAPER_REACH]};
    double low = v[CSG_TAPER_LOW], high = v[CSG_TAPER_HIGH], z = fmin(fmax(p.z, low), high) - low;
    double grow_x = (v[CSG_TAPER_X] - 1) / (high - low), scale_x = 1 + grow_x * z;
    double grow_y = (v[CSG_TAPER_Y] - 1) / (high - low), scale_y = 1 + grow_y * z;
    csg_vec3 divided = vec3(p.x / scale_x, p.y / scale_y, p.z);
    csg_warped out = twist_at(twist, divided);
    csg_vec3 along_x = out.column[0], along_y = out.column[1];
    out.column[0] = csg_vec3_scale(along_x, 1 / scale_x);
    out.column[1] = csg_vec3_scale(along_y, 1 / scale_y);
    if (p.z > low && p.z < high) {
        csg_vec3 inward = csg_vec3_add(csg_vec3_scale(along_x, divided.x * grow_x / scale_x),
                                       csg_vec3_scale(along_y, divided.y * grow_y / scale_y));
        out.column[2] = csg_vec3_sub(out.column[2], inward);
    }
    return out;
}

static csg_warped bend_at(const double *v, csg_vec3 p)
{
    double radius = v[CSG_BEND_RADIUS], nearest = v[CSG_BEND_NEAREST], most = v[CSG_BEND_ANGLE];
    double across = radius - p.z, s = csg_hypot(p.x, across), phi = csg_atan2(p.x, across);
    double sine = s > 0 ? p.x / s : 0, cosine = s > 0 ? across / s : 0;
    /* Behind the ends the angle runs back to 0, near the line it shrinks. */
    bool behind = fabs(phi) > most;
    double back = most / (PI - most),
           turned = behind ? copysign(back * (PI - fabs(phi)), phi) : phi;
    double slope = behind ? -back : 1, shrink = s < nearest ? s / nearest : 1;
    double around = radius * slope * (s > 0 ? shrink / s : 0); /* du along the circle */
    double outward = s < nearest ? radius * turned / nearest : 0;
    /* the unit vectors: outward (sine, -cosine), around (cosine, sine) in (x, z) */
    return (csg_warped){vec3(radius * turned * shrink, p.y, radius - s),
                        {vec3(around * cosine + outward * sine, 0, -sine), vec3(0, 1, 0),
                         vec3(around * sine - outward * cosine, 0, cosine)}};
}

/* D is the largest of p . e over the unit vectors e to the points of the arc: of a point within its
 * angle the distance from the axis, of another one p . e of the nearer end. So D less the arc's
 * radius is the signed distance from the arc with its straight ends in the plane, on both sides: of
 * a convex set it is the largest of those from its tangents, and within it of all of them. a is p .
 * e of that end, b is above 0 within the angle, where a is too. */
static csg_warped elbow_at(const double *v, csg_vec3 p)
{
    double c = v[CSG_ELBOW_COSINE], s = v[CSG_ELBOW_SINE], side = p.y < 0 ? -1 : 1;
    double a = p.x * c + fabs(p.y) * s, b = p.x * s - fabs(p.y) * c;
    double d = b > 0 ? csg_hypot(a, b) : a;
    double by_a = b > 0 ? a / d : 1, by_b = b > 0 ? b / d : 0;
    return (csg_warped){
        vec3(d, p.z, 0),
        {vec3(by_a * c + by_b * s, 0, 0), vec3(side * (by_a * s - by_b * c), 0, 0), vec3(0, 1, 0)}};
}

/* ---- the Lipschitz constant -------------------------------------------------------------------
 * Twist: around the axis, a point's image moves by rho rate for a step along z; the largest
 * singular value of [[1, k], [0, 1]] is (k + sqrt(k^2 + 4)) / 2. Bend: steps around the line grow
 * by radius / s; near the line a step outwards moves the image by radius phi / nearest as well.
 * Taper: a step across moves the image by m = 1 / s at most; one along z by k: rho rate around the
 * axis, and rho |s'| / s, which is towards it where both scales are one. */

static double revolve_scale(const double *v)
{
    return 1;
}

static double slice_scale(const double *v)
{
    return 1;
}

static double elbow_scale(const double *v)
{
    return 1;
}

static double twist_scale(const double *v)
{
    double k = fabs(v[CSG_TWIST_RATE]) * (PI / 180) * v[CSG_TWIST_REACH];
    return 2 / (k + sqrt(k * k + 4));
}

static double taper_scale(const double *v)
{
    double length = v[CSG_TAPER_HIGH] - v[CSG_TAPER_LOW], x = v[CSG_TAPER_X], y = v[CSG_TAPER_Y];
    double around = fabs(v[CSG_TAPER_RATE]) * (PI / 180) * v[CSG_TAPER_REACH];
    double inward =
        v[CSG_TAPER_REACH] * fmax(fabs(x - 1) / fmin(1, x), fabs(y - 1) / fmin(1, y)) / length;
    double k = x == y ? csg_hypot(around, inward) : around + inward, m = 1 / fmin(1, fmin(x, y));
    return 1 / csg_shear_norm(m, k);
}

static double bend_scale(const double *v)
{
    double most = v[CSG_BEND_ANGLE], grow = v[CSG_BEND_RADIUS] / v[CSG_BEND_NEAREST];
    double around = grow * fmax(1, most / (PI - most)), outward = grow * most;
    return 1 / fmax(around, sqrt(around * around + outward * outward + 1));
}

/* ---- boxes ------------------------------------------------------------------------------------
 */

static csg_box ring_box(double radius, double low, double high)
{
    return radius < 0 ? csg_box_empty()
                      : (csg_box){{-radius, -radius, low}, {radius, radius, high}};
}

static csg_box revolve_box(const double *v, csg_box child, bool all_round)
{
    return ring_box(child.max.x, child.min.y, child.max.y);
}

/* D is at least x, since +x is a direction of the arc. */
static csg_box elbow_box(const double *v, csg_box child, bool all_round)
{
    return (csg_box){{-INFINITY, -INFINITY, child.min.y}, {child.max.x, INFINITY, child.max.y}};
}

static csg_box slice_box(const double *v, csg_box child, bool all_round)
{
    if (child.min.z > 0 || child.max.z < 0)
        return csg_box_empty();
    return (csg_box){{child.min.x, child.min.y, -INFINITY}, {child.max.x, child.max.y, INFINITY}};
}

static csg_box twist_box(const double *v, csg_box child, bool all_round)
{
    return ring_box(farthest_from_axis(child), child.min.z, child.max.z);
}

static csg_box taper_box(const double *v, csg_box child, bool all_round)
{
    double r = farthest_from_axis(child);
    /* what lies beyond the reach is held there, wherever it is */
    bool is_held = r >= v[CSG_TAPER_REACH] && r > 0;
    csg_box box = ring_box(is_held ? INFINITY : r, child.min.z, child.max.z);
    if (is_held || csg_box_is_empty(box))
        return box;
    box.max.x = r * fmax(1, v[CSG_TAPER_X]);
    box.max.y = r * fmax(1, v[CSG_TAPER_Y]);
    box.min.x = -box.max.x;
    box.min.y = -box.max.y;
    return box;
}

static csg_box bend_box(const double *v, csg_box child, bool all_round)
{
    double radius = v[CSG_BEND_RADIUS];
    double nearest = fmax(radius - child.max.z, 0), farthest = fmax(radius - child.min.z, 0);
    double low = fmax(child.min.x / radius, -PI), high = fmin(child.max.x / radius, PI);
    low = all_round ? -PI : low;
    high = all_round ? PI : high;
    csg_box box = csg_box_empty();
    double angles[7] = {low, high, -PI, -PI / 2, 0, PI / 2, PI};
    for (int i = 0; i < 7; i++) {
        if (angles[i] < low || angles[i] > high)
            continue;
        for (int k = 0; k < 2; k++) {
            double s = k ? farthest : nearest;
            csg_vec3 p = vec3(s * csg_sin(angles[i]), 0, radius - s * csg_cos(angles[i]));
            box = csg_box_hull(box, (csg_box){p, p});
        }
    }
    box = csg_box_grow(box, 1e-12 * (radius + farthest));
    box.min.y = child.min.y;
    box.max.y = child.max.y;
    return isfinite(farthest) ? box : csg_box_all();
}

/* ---- planes -----------------------------------------------------------------------------------
 */

static bool revolve_plane(csg_vec3 n, csg_vec3 *child)
{
    *child = vec3(0, n.z, 0);
    return n.x == 0 && n.y == 0;
}

static bool elbow_plane(csg_vec3 n, csg_vec3 *child)
{
    return revolve_plane(n, child);
}

static bool slice_plane(csg_vec3 n, csg_vec3 *child)
{
    *child = n;
    return n.z == 0;
}

static bool twist_plane(csg_vec3 n, csg_vec3 *child)
{
    *child = n;
    return n.x == 0 && n.y == 0;
}

static bool taper_plane(csg_vec3 n, csg_vec3 *child)
{
    return twist_plane(n, child);
}

static bool bend_plane(csg_vec3 n, csg_vec3 *child)
{
    *child = n;
    return n.x == 0 && n.z == 0;
}

/* ---- the table --------------------------------------------------------------------------------
 * A function that a warp lacks is an error here that names it.
 */

typedef struct warp_row {
    const char *name;
    uint32_t given;
    unsigned traits;
    bool (*check)(const double *v, csg_refusal *refusal);
    bool (*settle)(csg_warp *warp, csg_box child, const char **why);
    csg_warped (*at)(const double *v, csg_vec3 p);
    double (*scale)(const double *v);
    csg_box (*box)(const double *v, csg_box child, bool all_round);
    bool (*plane)(csg_vec3 n, csg_vec3 *child);
} warp_row;

static const warp_row rows[CSG_WARP_COUNT] = {
#define CSG_WARP(NAME, name, given, traits, doc)                                                   \
    [CSG_WARP_##NAME] = {#name,     given,        traits,     name##_check, name##_settle,         \
                         name##_at, name##_scale, name##_box, name##_plane},
#include "scene/primitives/warps.def"

};

static const warp_row *row_of(csg_warp_kind kind)
{
    assert(kind < CSG_WARP_COUNT);
    return &rows[kind];
}

const char *csg_warp_name(csg_warp_kind kind)
{
    return row_of(kind)->name;
}

uint32_t csg_warp_given(csg_warp_kind kind)
{
    return row_of(kind)->given;
}

unsigned csg_warp_traits(csg_warp_kind kind)
{
    return row_of(kind)->traits;
}

bool csg_warp_check(const csg_warp *warp, csg_refusal *refusal)
{
    return row_of(warp->kind)->check(warp->parameters, refusal);
}

bool csg_warp_settle(csg_warp *warp, csg_box child, const char **why)
{
    return row_of(warp->kind)->settle(warp, child, why);
}

bool csg_warp_plane(const csg_warp *warp, csg_vec3 n, csg_vec3 *child)
{
    return row_of(warp->kind)->plane(n, child);
}

csg_warped csg_warp_at(const csg_warp *warp, csg_vec3 p)
{
    return row_of(warp->kind)->at(warp->parameters, p);
}

double csg_warp_scale(const csg_warp *warp)
{
    return row_of(warp->kind)->scale(warp->parameters);
}

csg_box csg_warp_box(const csg_warp *warp, csg_box child, bool all_round)
{
    return csg_box_is_empty(child) ? child
                                   : row_of(warp->kind)->box(warp->parameters, child, all_round);
}
