/* SPDX-License-Identifier: MIT
 * See true_solids.h. Cube, cylinder, plate and gear are extrusions of outlines of segments and
 * arcs: the signed distance to the outline and the one to the slab make the exact one. The others
 * are a tetrahedron's faces, a cone's profile, and two crossed cylinders, whose surface is what of
 * each lies outside the other.
 */
#include "mesh/true_solids.h"

#include <math.h>

#define PI 3.14159265358979323846

enum { MOST_PIECES = 72, SPACING = 48 };

typedef struct flat {
    double x, y;
} flat;

/* From `a` to `b`, straight, or counter-clockwise around `middle` where radius > 0; a circle has
 * a = b. */
typedef struct piece {
    flat a, b, middle;
    double radius;
} piece;

struct true_profile {
    size_t (*pieces)(piece out[MOST_PIECES]);
    bool (*inside)(double x, double y);
};

/* ---- in the plane ----------------------------------------------------------------------------
 */

static double to_segment(flat p, flat a, flat b)
{
    double ux = b.x - a.x, uy = b.y - a.y;
    double t = ((p.x - a.x) * ux + (p.y - a.y) * uy) / (ux * ux + uy * uy);
    t = fmin(fmax(t, 0), 1);
    return hypot(p.x - a.x - t * ux, p.y - a.y - t * uy);
}

static double angle_from(flat middle, flat p, double start)
{
    double angle = atan2(p.y - middle.y, p.x - middle.x) - start;
    return angle < 0 ? angle + 2 * PI : angle;
}

static double arc_angle(const piece *s)
{
    double start = atan2(s->a.y - s->middle.y, s->a.x - s->middle.x);
    double angle = angle_from(s->middle, s->b, start);
    return angle < 1e-9 ? 2 * PI : angle;
}

static double to_piece(flat p, const piece *s)
{
    if (s->radius <= 0)
        return to_segment(p, s->a, s->b);
    double start = atan2(s->a.y - s->middle.y, s->a.x - s->middle.x);
    if (angle_from(s->middle, p, start) <= arc_angle(s))
        return fabs(hypot(p.x - s->middle.x, p.y - s->middle.y) - s->radius);
    return fmin(hypot(p.x - s->a.x, p.y - s->a.y), hypot(p.x - s->b.x, p.y - s->b.y));
}

static flat along(const piece *s, double t)
{
    if (s->radius <= 0)
        return (flat){s->a.x + t * (s->b.x - s->a.x), s->a.y + t * (s->b.y - s->a.y)};
    double angle = atan2(s->a.y - s->middle.y, s->a.x - s->middle.x) + t * arc_angle(s);
    return (flat){s->middle.x + s->radius * cos(angle), s->middle.y + s->radius * sin(angle)};
}

/* Made once for each profile in turn. */
static const piece *pieces_of(const true_profile *profile, size_t *count)
{
    static piece made[MOST_PIECES];
    static size_t made_count;
    static const true_profile *of;
    if (of != profile)
        made_count = profile->pieces(made);
    of = profile;
    *count = made_count;
    return made;
}

static bool is_open(const piece *s)
{
    return s->a.x != s->b.x || s->a.y != s->b.y;
}

/* Signed, inside positive. */
static double outline(const true_profile *profile, double x, double y)
{
    size_t count;
    const piece *s = pieces_of(profile, &count);
    double nearest = INFINITY;
    for (size_t i = 0; i < count; i++)
        nearest = fmin(nearest, to_piece((flat){x, y}, &s[i]));
    return profile->inside(x, y) ? nearest : -nearest;
}

static piece straight(double ax, double ay, double bx, double by)
{
    return (piece){{ax, ay}, {bx, by}, {0, 0}, 0};
}

static piece circle(double x, double y, double radius)
{
    return (piece){{x + radius, y}, {x + radius, y}, {x, y}, radius};
}

static size_t square_pieces(piece out[], double h)
{
    out[0] = straight(-h, -h, h, -h);
    out[1] = straight(h, -h, h, h);
    out[2] = straight(h, h, -h, h);
    out[3] = straight(-h, h, -h, -h);
    return 4;
}

/* ---- the outlines ----------------------------------------------------------------------------
 */

static size_t cube_pieces(piece out[MOST_PIECES])
{
    return square_pieces(out, 5);
}
static bool in_cube(double x, double y)
{
    return fabs(x) <= 5 && fabs(y) <= 5;
}

static size_t disc_pieces(piece out[MOST_PIECES])
{
    out[0] = circle(0, 0, 5);
    return 1;
}
static bool in_disc(double x, double y)
{
    return x * x + y * y <= 25;
}

static size_t plate_pieces(piece out[MOST_PIECES])
{
    size_t n = square_pieces(out, 10);
    for (int i = 0; i < 4; i++)
        out[n++] = circle(i & 1 ? 5 : -5, i & 2 ? 5 : -5, 2);
    return n;
}
static bool in_plate(double x, double y)
{
    return fabs(x) <= 10 && fabs(y) <= 10 && hypot(fabs(x) - 5, fabs(y) - 5) >= 2;
}

static flat spun(double x, double y, int tooth)
{
    double c = cos(tooth * PI / 6), s = sin(tooth * PI / 6);
    return (flat){c * x - s * y, s * x + c * y};
}

/* The circle of radius 8 with teeth (7, +-1.6) .. (10.5, +-0.9), less the one of radius 3. */
static size_t gear_pieces(piece out[MOST_PIECES])
{
    /* where a flank leaves the circle: x = 7 + 3.5 t, y = 1.6 - 0.7 t */
    double a = 3.5 * 3.5 + 0.7 * 0.7, b = 7 * 3.5 - 1.6 * 0.7, c = 49 + 1.6 * 1.6 - 64;
    double t = (-b + sqrt(b * b - a * c)) / a, x = 7 + 3.5 * t, y = 1.6 - 0.7 * t;
    size_t n = 0;
    out[n++] = circle(0, 0, 3);
    for (int i = 0; i < 12; i++) {
        flat low = spun(x, -y, i), foot = spun(10.5, -0.9, i), head = spun(10.5, 0.9, i);
        flat high = spun(x, y, i), next = spun(x, -y, i + 1);
        out[n++] = straight(low.x, low.y, foot.x, foot.y);
        out[n++] = straight(foot.x, foot.y, head.x, head.y);
        out[n++] = straight(head.x, head.y, high.x, high.y);
        out[n++] = (piece){high, next, {0, 0}, 8};
    }
    return n;
}
static bool in_gear(double x, double y)
{
    double r = hypot(x, y);
    for (int i = 0; i < 12 && r > 8; i++) {
        flat p = spun(x, y, -i);
        if (p.x >= 7 && p.x <= 10.5 && fabs(p.y) <= 1.6 - 0.2 * (p.x - 7))
            r = 8;
    }
    return r >= 3 && r <= 8;
}

static const true_profile square_profile = {cube_pieces, in_cube};
static const true_profile disc_profile = {disc_pieces, in_disc};
static const true_profile plate_profile = {plate_pieces, in_plate};
static const true_profile gear_profile = {gear_pieces, in_gear};

/* ---- extrusions ------------------------------------------------------------------------------
 */

static double extruded_surface(const true_solid *s, csg_vec3 p)
{
    double side = outline(s->profile, p.x, p.y), end = s->half_height - fabs(p.z);
    if (side >= 0 && end >= 0)
        return fmin(side, end);
    return hypot(fmin(side, 0), fmin(end, 0));
}

static double extruded_crease(const true_solid *s, csg_vec3 p)
{
    double end = fabs(p.z) - s->half_height;
    double nearest = hypot(outline(s->profile, p.x, p.y), end);
    size_t count;
    const piece *pieces = pieces_of(s->profile, &count);
    for (size_t i = 0; i < count; i++)
        if (is_open(&pieces[i]))
            nearest =
                fmin(nearest, hypot(hypot(p.x - pieces[i].a.x, p.y - pieces[i].a.y), fmax(end, 0)));
    return nearest;
}

static size_t extruded_points(const true_solid *s, csg_vec3 *out, size_t most, size_t *corners)
{
    size_t count, n = 0;
    const piece *pieces = pieces_of(s->profile, &count);
    for (size_t i = 0; i < count; i++)
        for (int end = -1; end <= 1 && n < most; end += 2)
            if (is_open(&pieces[i]))
                out[n++] = (csg_vec3){pieces[i].a.x, pieces[i].a.y, end * s->half_height};
    *corners = n;
    for (size_t i = 0; i < count; i++)
        for (int k = 1; k < SPACING && n + 3 <= most; k++) {
            flat p = along(&pieces[i], (double)k / SPACING);
            out[n++] = (csg_vec3){p.x, p.y, s->half_height};
            out[n++] = (csg_vec3){p.x, p.y, -s->half_height};
            if (is_open(&pieces[i]))
                out[n++] = (csg_vec3){pieces[i].a.x, pieces[i].a.y,
                                      (2.0 * k / SPACING - 1) * s->half_height};
        }
    return n;
}

/* ---- the tetrahedron -------------------------------------------------------------------------
 */

/* Three times as far as the faces: 5. */
static csg_vec3 tetrahedron_corner(int i)
{
    static const double sign[4][3] = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
    double k = -15 / sqrt(3);
    return (csg_vec3){k * sign[i][0], k * sign[i][1], k * sign[i][2]};
}

static double to_segment3(csg_vec3 p, csg_vec3 a, csg_vec3 b)
{
    csg_vec3 u = csg_vec3_sub(b, a), v = csg_vec3_sub(p, a);
    double t = fmin(fmax(csg_vec3_dot(u, v) / csg_vec3_dot(u, u), 0), 1);
    return csg_vec3_norm(csg_vec3_sub(v, csg_vec3_scale(u, t)));
}

static double tetrahedron_crease(const true_solid *s, csg_vec3 p)
{
    (void)s;
    double nearest = INFINITY;
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < i; k++)
            nearest = fmin(nearest, to_segment3(p, tetrahedron_corner(i), tetrahedron_corner(k)));
    return nearest;
}

static double tetrahedron_surface(const true_solid *s, csg_vec3 p)
{
    double least = INFINITY; /* distance inside the planes */
    for (int i = 0; i < 4; i++) {
        csg_vec3 out = csg_vec3_scale(tetrahedron_corner(i), -1.0 / 15);
        least = fmin(least, 5 - csg_vec3_dot(out, p));
    }
    if (least >= 0)
        return least;
    double nearest = tetrahedron_crease(s, p);
    for (int i = 0; i < 4; i++) { /* or the foot on a face, where it lies in the face */
        csg_vec3 out = csg_vec3_scale(tetrahedron_corner(i), -1.0 / 15);
        double height = csg_vec3_dot(out, p) - 5;
        csg_vec3 foot = csg_vec3_sub(p, csg_vec3_scale(out, height));
        bool in = true;
        for (int k = 0; k < 4; k++)
            in = in && (k == i || csg_vec3_dot(tetrahedron_corner(k), foot) / -15 <= 5);
        if (in)
            nearest = fmin(nearest, fabs(height));
    }
    return nearest;
}

static size_t tetrahedron_points(const true_solid *s, csg_vec3 *out, size_t most, size_t *corners)
{
    (void)s;
    size_t n = 0;
    for (int i = 0; i < 4 && n < most; i++)
        out[n++] = tetrahedron_corner(i);
    *corners = n;
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < i; k++)
            for (int t = 1; t < SPACING && n < most; t++) {
                double share = (double)t / SPACING;
                out[n++] = csg_vec3_add(csg_vec3_scale(tetrahedron_corner(i), share),
                                        csg_vec3_scale(tetrahedron_corner(k), 1 - share));
            }
    return n;
}

/* ---- the cone: profile (radius, height) from the axis to (5, -5) to the tip (0, 5) -------------
 */

static double cone_surface(const true_solid *s, csg_vec3 p)
{
    (void)s;
    flat q = {hypot(p.x, p.y), p.z};
    return fmin(to_segment(q, (flat){0, -5}, (flat){5, -5}),
                to_segment(q, (flat){5, -5}, (flat){0, 5}));
}

static double cone_crease(const true_solid *s, csg_vec3 p)
{
    (void)s;
    double r = hypot(p.x, p.y);
    return fmin(hypot(r - 5, p.z + 5), hypot(r, p.z - 5));
}

static size_t cone_points(const true_solid *s, csg_vec3 *out, size_t most, size_t *corners)
{
    (void)s;
    size_t n = 0;
    if (most > 0)
        out[n++] = (csg_vec3){0, 0, 5};
    *corners = n;
    for (int k = 0; k < SPACING && n < most; k++)
        out[n++] = (csg_vec3){5 * cos(2 * PI * k / SPACING), 5 * sin(2 * PI * k / SPACING), -5};
    return n;
}

/* ---- crossed cylinders: along z and along y, radius 3, 20 long ---------------------------------
 */

static csg_vec3 swapped(csg_vec3 p)
{
    return (csg_vec3){p.x, p.z, p.y};
}

/* Inside the one along z: how deep. */
static double depth_in(csg_vec3 p)
{
    return fmin(3 - hypot(p.x, p.y), 10 - fabs(p.z));
}

/* To the side and the ends of the one along z, as far as they are outside the other. */
static double to_outer(csg_vec3 p)
{
    double r = hypot(p.x, p.y), k = r > 0 ? 3 / r : 0, nearest = INFINITY;
    csg_vec3 side = {k * p.x, k * p.y, fmin(fmax(p.z, -10), 10)};
    csg_vec3 end = {p.x, p.y, p.z > 0 ? 10 : -10};
    if (r > 3) {
        end.x = side.x;
        end.y = side.y;
    }
    if (r > 0 && depth_in(swapped(side)) <= 0)
        nearest = csg_vec3_norm(csg_vec3_sub(p, side));
    return fmin(nearest, csg_vec3_norm(csg_vec3_sub(p, end)));
}

static csg_vec3 ellipse(double t, double sign)
{
    return (csg_vec3){3 * cos(t), 3 * sin(t), sign * 3 * sin(t)};
}

/* Where they meet: two ellipses, in the planes y = z and y = -z. By Newton's method. */
static double to_ellipse(csg_vec3 p, double sign)
{
    double t = atan2(p.y + sign * p.z, 2 * p.x);
    for (int i = 0; i < 20; i++) {
        csg_vec3 u = {-3 * sin(t), 3 * cos(t), sign * 3 * cos(t)};
        csg_vec3 w = {-3 * cos(t), -3 * sin(t), sign * -3 * sin(t)};
        csg_vec3 d = csg_vec3_sub(ellipse(t, sign), p);
        double slope = csg_vec3_dot(u, u) + csg_vec3_dot(d, w);
        t -= slope > 1 ? csg_vec3_dot(d, u) / slope : 0;
    }
    return csg_vec3_norm(csg_vec3_sub(ellipse(t, sign), p));
}

static double crossed_crease(const true_solid *s, csg_vec3 p)
{
    (void)s;
    csg_vec3 q = swapped(p);
    double rim = fmin(hypot(hypot(p.x, p.y) - 3, fabs(p.z) - 10),
                      hypot(hypot(q.x, q.y) - 3, fabs(q.z) - 10));
    return fmin(rim, fmin(to_ellipse(p, 1), to_ellipse(p, -1)));
}

static double crossed_surface(const true_solid *s, csg_vec3 p)
{
    double nearest = fmin(to_outer(p), to_outer(swapped(p)));
    return nearest < 1e-7 ? nearest : fmin(nearest, crossed_crease(s, p));
}

static size_t crossed_points(const true_solid *s, csg_vec3 *out, size_t most, size_t *corners)
{
    (void)s;
    size_t n = 0;
    *corners = 0; /* the ellipses cross where both surfaces touch: no corner in a mesh of it */
    for (int k = 0; k < SPACING && n + 6 <= most; k++) {
        double t = 2 * PI * k / SPACING;
        out[n++] = ellipse(t, 1);
        out[n++] = ellipse(t, -1);
        for (int end = -1; end <= 1; end += 2) {
            out[n] = (csg_vec3){3 * cos(t), 3 * sin(t), end * 10};
            out[n + 1] = swapped(out[n]);
            n += 2;
        }
    }
    return n;
}

/* ---- the list --------------------------------------------------------------------------------
 */

#define EXTRUDED                                                                                   \
    {                                                                                              \
        extruded_surface, extruded_crease, extruded_points                                         \
    }
#define UPRIGHT(x, y, r)                                                                           \
    {                                                                                              \
        {x, y, 0}, {0, 0, 1}, r, 0                                                                 \
    }
#define SQRT2 1.4142135623730951
#define SQRT3 1.7320508075688772

const true_solid true_solids[] = {
    {.name = "cube",
     .text = "cube(10, center = true);",
     .kind = EXTRUDED,
     .profile = &square_profile,
     .half_height = 5,
     .volume = 1000},
    {.name = "tetrahedron",
     .text = "intersection() { plane([1, 1, 1], 5); plane([-1, -1, 1], 5);"
             " plane([-1, 1, -1], 5); plane([1, -1, -1], 5); }",
     .kind = {tetrahedron_surface, tetrahedron_crease, tetrahedron_points},
     .volume = 1000 * SQRT3},
    {.name = "cylinder",
     .text = "cylinder(h = 10, r = 5, center = true);",
     .kind = EXTRUDED,
     .profile = &disc_profile,
     .half_height = 5,
     .round = {UPRIGHT(0, 0, 5)},
     .round_count = 1,
     .chord = 1},
    {.name = "cone",
     .text = "cylinder(h = 10, r1 = 5, r2 = 0, center = true);",
     .kind = {cone_surface, cone_crease, cone_points},
     .round = {{{0, 0, 0}, {0, 0, 1}, 2.5, -0.5}},
     .round_count = 1,
     .chord = 1},
    {.name = "crossed cylinders",
     .text = "union() { cylinder(h = 20, r = 3, center = true);"
             " rotate([90, 0, 0]) cylinder(h = 20, r = 3, center = true); }",
     .kind = {crossed_surface, crossed_crease, crossed_points},
     .round = {UPRIGHT(0, 0, 3), {{0, 0, 0}, {0, 1, 0}, 3, 0}},
     .round_count = 2,
     .chord = SQRT2},
    {.name = "drilled plate",
     .text = "difference() { cube([20, 20, 4], center = true); for (x = [-5, 5], y = [-5, 5])"
             " translate([x, y, 0]) cylinder(h = 10, r = 2, center = true); }",
     .kind = EXTRUDED,
     .profile = &plate_profile,
     .half_height = 2,
     .round = {UPRIGHT(5, 5, 2), UPRIGHT(-5, 5, 2), UPRIGHT(5, -5, 2), UPRIGHT(-5, -5, 2)},
     .round_count = 4,
     .chord = 1,
     .genus = 4},
    {.name = "gear",
     .text = "linear_extrude(4, center = true) difference() { union() { circle(8);"
             " for (i = [0 : 11]) rotate(i * 30)"
             " polygon([[7, -1.6], [10.5, -0.9], [10.5, 0.9], [7, 1.6]]); } circle(3); }",
     .kind = EXTRUDED,
     .profile = &gear_profile,
     .half_height = 2,
     .round = {UPRIGHT(0, 0, 8), UPRIGHT(0, 0, 3)},
     .round_count = 2,
     .chord = 1,
     .genus = 1},
};

const size_t true_solid_count = sizeof true_solids / sizeof *true_solids;
