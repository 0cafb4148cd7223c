/* SPDX-License-Identifier: MIT
 * The gradients that a primitive's field can have in a ball of radius rho around q, in its own
 * frame; see cone.h. Two ways to bound them:
 *
 * Turning. Where the field is the distance to a convex core K (a point, an axis, a segment, a box
 * without its rounding), the vector u from the nearest point of K to the point is a 1-Lipschitz
 * function of the point, so within rho its direction turns by an angle of at most asin(rho / |u|).
 * For a torus and a tapered capsule the Hessian's largest eigenvalue is used instead (one over the
 * distance to the skeleton or to the axis), for an ellipsoid its largest curvature e_max / e_min^2,
 * which inside at depth d becomes k / (1 - k d).
 *
 * Faces. Where faces meet, every gradient is a face's (minus its outward normal) or, outside,
 * minus a unit vector of the form w_1 n_1 + w_2 n_2 + ... with all w >= 0, whose sum is at least 1
 * since |sum w n| <= sum w. So what climbs with all faces' gradients climbs there too. A face
 * takes part when its plane is near enough to be the nearest one anywhere in the ball.
 */
#include <math.h>

#include "field/cones/cone.h"
#include "field/cones/cone_curve.h"
#include "field/cones/cone_formula.h"
#include "field/cones/cone_warp.h"
#include "field/kernels/formulas.h"

/* A leaf in its own frame. */
typedef struct local {
    csg_cone_balls *balls;
    const float *own;
    double q[3], rho;
    double turn[3][3]; /* own gradient -> tape's: sigma times the frame's transpose */
    double norm;       /* of turn, at least */
} local;

static double square_of(const double v[3])
{
    return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

static bool add(local *l, double x, double y, double z, double spread)
{
    if (l->balls->count >= CSG_CONE_MOST)
        return false;
    csg_cone_ball *ball = &l->balls->items[l->balls->count++];
    const double g[3] = {x, y, z};
    for (int k = 0; k < 3; k++)
        ball->at[k] = l->turn[k][0] * g[0] + l->turn[k][1] * g[1] + l->turn[k][2] * g[2];
    ball->spread = l->norm * spread;
    return true;
}

/* Chord of the largest turn of a vector of length d that moves by rho; 2 = any direction. */
static double turn_within(double d, double rho)
{
    double s = d > 0 ? rho / d : 2;
    return s < 1 ? sqrt(2 - 2 * sqrt(1 - s * s)) : 2;
}

/* Gradient away from a convex core: u from the core's nearest point to q. */
static bool add_away(local *l, double x, double y, double z)
{
    double d = sqrt(x * x + y * y + z * z), spread = turn_within(d, l->rho);
    return spread < 1.4 && add(l, -x / d, -y / d, -z / d, spread);
}

static bool add_sphere(local *l)
{
    return add_away(l, l->q[0], l->q[1], l->q[2]);
}

static bool add_circle(local *l)
{
    return add_away(l, l->q[0], l->q[1], 0);
}

static bool add_plane(local *l)
{
    const float *n = l->own;
    return add(l, -(double)n[0], -(double)n[1], -(double)n[2], 0);
}

/* Faces of a box over the first `axes` axes, half sizes and rounding in own. */
static bool add_box(local *l, int axes)
{
    double over[3] = {0, 0, 0}, a[3], most = -INFINITY;
    for (int k = 0; k < axes; k++) {
        a[k] = fabs(l->q[k]) - (double)l->own[k];
        most = fmax(most, a[k]);
        over[k] = copysign(fmax(a[k], 0), l->q[k]);
    }
    for (int k = 0; k < axes; k++) { /* all over the ball one face is the nearest place */
        bool alone = a[k] > l->rho;
        for (int j = 0; j < axes; j++)
            alone = alone && (j == k || a[j] < -l->rho);
        if (alone)
            return add(l, k == 0 ? copysign(1, -l->q[0]) : 0, k == 1 ? copysign(1, -l->q[1]) : 0,
                       k == 2 ? copysign(1, -l->q[2]) : 0, 0);
    }
    if (sqrt(square_of(over)) > 1.2 * l->rho)
        return add_away(l, over[0], over[1], over[2]);
    uint32_t faces = 0;
    for (int k = 0; k < axes; k++) {
        if (a[k] + l->rho < fmin(0, most - l->rho))
            continue;
        for (int side = -1; side <= 1; side += 2) {
            double g[3] = {0, 0, 0};
            g[k] = -side;
            if (side * l->q[k] < -l->rho)
                continue; /* the other side is the nearer one all over the ball */
            faces++;
            if (!add(l, g[0], g[1], g[2], 0))
                return false;
        }
    }
    l->balls->has_edges |= faces > 1 && l->own[axes] == 0;
    return true;
}

static bool add_slab(local *l)
{
    if (fabs(l->q[2]) <= l->rho)
        return false;
    return add(l, 0, 0, l->q[2] < 0 ? 1 : -1, 0);
}

/* own: see frustum_at. The side's normal turns with the azimuth. */
static bool add_frustum(local *l)
{
    const float *own = l->own;
    double radius = hypot(l->q[0], l->q[1]), nx = (double)own[3], nz = (double)own[4];
    double side = (radius - (double)own[0]) * nx + (l->q[2] + (double)own[2]) * nz;
    double top = l->q[2] - (double)own[2], bottom = -l->q[2] - (double)own[2];
    double most = fmax(side, fmax(top, bottom));
    point g, q = {(float)l->q[0], (float)l->q[1], (float)l->q[2]};
    double value = (double)own[6] - (double)frustum_at(own, q, &g);
    /* All over the ball the nearest place is on the side, or on a cap. */
    double along = (l->q[2] + (double)own[2]) * nx - (radius - (double)own[0]) * nz;
    double wide = l->rho * (1 + 1e-4), bend = turn_within(radius, l->rho);
    if (side > wide && along > wide && along + wide < (double)own[5] && bend < 1.4)
        return add(l, -nx * l->q[0] / radius, -nx * l->q[1] / radius, -nz, nx * bend);
    double rim = (double)own[1] + (l->q[2] < 0 ? -(double)own[7] : (double)own[7]);
    if (fabs(l->q[2]) - (double)own[2] > wide && radius + wide < rim)
        return add(l, 0, 0, copysign(1, -l->q[2]), 0);
    if (most > 0 && value > 1.2 * l->rho)
        return add(l, (double)g.x, (double)g.y, (double)g.z, turn_within(value, l->rho) + 1e-5);
    /* Outside by up to 2.2 rho; at an acute rim a face takes part from further below its plane. */
    double from = fmin(0, most - l->rho), reach = l->rho * (1 + 2.2 / nx);
    uint32_t faces = 0;
    bool done = true;
    if (side + reach >= from) {
        double turn = turn_within(radius, l->rho);
        double ex = radius > 0 ? l->q[0] / radius : 0, ey = radius > 0 ? l->q[1] / radius : 0;
        done = turn < 1.4 ? add(l, -nx * ex, -nx * ey, -nz, nx * turn) : add(l, 0, 0, -nz, nx);
        faces++;
    }
    if (top + reach >= from && (own[1] + own[7] > 0 || own[6] > 0)) {
        done = done && add(l, 0, 0, -1, 0);
        faces++;
    }
    if (bottom + reach >= from && (own[0] > 0 || own[6] > 0)) {
        done = done && add(l, 0, 0, 1, 0);
        faces++;
    }
    l->balls->has_edges |= faces > 1 && own[6] == 0;
    return done;
}

/* own: see capsule_at. d changes by at most rho (1 + taper) within the ball. */
static bool add_capsule(local *l)
{
    const float *own = l->own;
    point g, q = {(float)l->q[0], (float)l->q[1], (float)l->q[2]};
    double t = (l->q[2] - hypot(l->q[0], l->q[1]) * (double)own[4]) * (double)own[1];
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    double z = l->q[2] - t * (double)own[0];
    double d = sqrt(l->q[0] * l->q[0] + l->q[1] * l->q[1] + z * z);
    if (own[3] == 0)
        return add_away(l, l->q[0], l->q[1], z);
    double taper = fabs((double)own[3]) * (double)own[1], least = d - l->rho * (1 + taper);
    if (!(least > 0.7 * l->rho))
        return false;
    capsule_at(own, q, &g);
    return add(l, (double)g.x, (double)g.y, (double)g.z, l->rho / least + 1e-5);
}

static bool add_torus(local *l)
{
    const float *own = l->own;
    point g, q = {(float)l->q[0], (float)l->q[1], (float)l->q[2]};
    double radius = hypot(l->q[0], l->q[1]) - l->rho;
    double d = (double)own[1] - (double)torus_at(own, q, &g) - l->rho;
    bool is_arc = own[2] > -1;
    /* In the gap the nearer end changes from one side of y = 0 to the other. */
    if (is_arc && fabs(l->q[1]) <= l->rho && l->q[0] <= l->rho)
        return false;
    if (!(d > 0.7 * l->rho && radius > 0.7 * l->rho))
        return false;
    return add(l, (double)g.x, (double)g.y, (double)g.z, l->rho / fmin(d, radius) + 1e-5);
}

static bool add_ellipsoid(local *l)
{
    const float *own = l->own;
    point g, q = {(float)l->q[0], (float)l->q[1], (float)l->q[2]};
    double depth = fmax((double)ellipsoid_at(own, q, &g) + l->rho, 0);
    double least = (double)own[2], curvature = fmax((double)own[0], (double)own[1]);
    curvature /= least * least;
    double spread = l->rho * curvature / (1 - curvature * depth);
    if (!(curvature * depth < 1 && spread < 1.4))
        return false;
    return add(l, (double)g.x, (double)g.y, (double)g.z, spread + 1e-4);
}

/* ---- shapes ----------------------------------------------------------------------------------
 */

enum { SHAPE_MOST = 12 }; /* balls; further normals widen the nearest of them */

typedef struct shape_normals {
    local *leaf;
    uint32_t first; /* of the balls */
    csg_vec3 one;
    bool is_set, is_bent;
} shape_normals;

/* 1 degree, as where the mesh looks for creases. */
static const double STRAIGHT = 0.01745;

static double distance_between(const double a[3], const double b[3])
{
    const double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return sqrt(square_of(d));
}

static bool take_normal(void *user, csg_vec3 n)
{
    shape_normals *s = user;
    csg_cone_balls *balls = s->leaf->balls;
    if (!s->is_set)
        s->one = n;
    s->is_set = true;
    s->is_bent |= csg_vec3_norm(csg_vec3_sub(n, s->one)) > STRAIGHT;
    if (csg_vec3_dot(n, s->one) < -0.999 || !add(s->leaf, n.x, n.y, n.z, 0))
        return false;
    const csg_cone_ball *last = &balls->items[balls->count - 1];
    csg_cone_ball *nearest = NULL;
    double least = INFINITY;
    for (uint32_t i = s->first; i + 1 < balls->count; i++) {
        double d = distance_between(balls->items[i].at, last->at);
        if (d < least) {
            least = d;
            nearest = &balls->items[i];
        }
    }
    bool is_full = balls->count - s->first > SHAPE_MOST || balls->count == CSG_CONE_MOST;
    if (nearest && (least <= nearest->spread + 1e-6 || is_full)) {
        nearest->spread = fmax(nearest->spread, least);
        balls->count--;
    }
    return true;
}

/* shape.h: gradients are the normals of what can be nearest, or combinations of them with weights
 * >= 0, whose sum is at least 1 as that of faces. */
static bool add_shape(local *l, const csg_tape *tape)
{
    shape_normals s = {.leaf = l, .first = l->balls->count};
    const csg_shape *shape = tape->shapes[(uint32_t)l->own[0]];
    bool done =
        csg_shape_normals(shape, csg_vec3_make(l->q[0], l->q[1], l->q[2]), l->rho, take_normal, &s);
    l->balls->has_edges |= s.is_bent;
    return done && s.is_set;
}

/* ---- formulas --------------------------------------------------------------------------------
 */

/* Where the domain ends a coordinate is held: its derivative is 0, on the way there 0 or 1. */
static void place_box(const local *l, const csg_tape_formula *formula, csg_cone_box *at,
                      csg_cone_box seeds[3])
{
    for (int k = 0; k < 3; k++) {
        const float from = formula->low[k], to = formula->high[k];
        float low = (float)(l->q[k] - l->rho * (1 + 1e-6)) - 1e-6f * (float)fabs(l->q[k]);
        float high = (float)(l->q[k] + l->rho * (1 + 1e-6)) + 1e-6f * (float)fabs(l->q[k]);
        seeds[k] = (csg_cone_box){{0, 0, 0}, {0, 0, 0}};
        seeds[k].low[k] = low > from && high < to ? 1 : 0;
        seeds[k].high[k] = high >= from && low <= to ? 1 : 0;
        at->low[k] = low < from ? from : low > to ? to : low;
        at->high[k] = high < from ? from : high > to ? to : high;
    }
}

/* The gradients' box: its corners, or a ball around it. */
static bool add_formula(local *l, const csg_tape *tape)
{
    enum { CORNERS = 8 };
    const csg_tape_formula *formula = &tape->formulas[(uint32_t)l->own[0]];
    csg_cone_box at, seeds[3], gradient;
    place_box(l, formula, &at, seeds);
    if (!csg_cone_formula(tape, formula, &at, seeds, &gradient, &l->balls->has_edges))
        return false;
    double middle[3], half[3];
    for (int k = 0; k < 3; k++) {
        middle[k] = ((double)gradient.high[k] + (double)gradient.low[k]) / 2;
        half[k] = ((double)gradient.high[k] - (double)gradient.low[k]) / 2;
    }
    if (l->balls->count + CORNERS > CSG_CONE_MOST)
        return add(l, middle[0], middle[1], middle[2], sqrt(square_of(half)));
    for (int i = 0; i < CORNERS; i++)
        if (!add(l, middle[0] + (i & 1 ? half[0] : -half[0]),
                 middle[1] + (i & 2 ? half[1] : -half[1]), middle[2] + (i & 4 ? half[2] : -half[2]),
                 1e-6))
            return false;
    return true;
}

static bool add_own(local *l, uint8_t op)
{
    double g[3], spread;
    switch (op) {
    case CSG_OP_SPHERE:
        return add_sphere(l);
    case CSG_OP_BOX:
        return add_box(l, 3);
    case CSG_OP_FRUSTUM:
        return add_frustum(l);
    case CSG_OP_CAPSULE:
        return add_capsule(l);
    case CSG_OP_TORUS:
        return add_torus(l);
    case CSG_OP_ELLIPSOID:
        return add_ellipsoid(l);
    case CSG_OP_PLANE:
        return add_plane(l);
    case CSG_OP_CIRCLE:
        return add_circle(l);
    case CSG_OP_RECTANGLE:
        return add_box(l, 2);
    case CSG_OP_SLAB:
        return add_slab(l);
    case CSG_OP_QUADRATIC_TUBE:
    case CSG_OP_CUBIC_TUBE:
        return csg_cone_curve(l->own, l->q, l->rho, g, &spread) && add(l, g[0], g[1], g[2], spread);
    default:
        return false;
    }
}

/* The square root of the largest row sum of |M^T M|. */
double csg_cone_norm(const float *m)
{
    double most = 0;
    for (int i = 0; i < 3; i++) {
        double sum = 0;
        for (int j = 0; j < 3; j++) {
            double d = 0;
            for (int k = 0; k < 3; k++)
                d += (double)m[3 * k + i] * (double)m[3 * k + j];
            sum += fabs(d);
        }
        most = fmax(most, sum);
    }
    return sqrt(most);
}

static void place_affine(local *l, const float *frame, const double c[3], double sigma)
{
    double norm = csg_cone_norm(frame);
    for (int i = 0; i < 3; i++) {
        l->q[i] = (double)frame[9 + i];
        for (int k = 0; k < 3; k++) {
            l->q[i] += (double)frame[3 * i + k] * c[k];
            l->turn[k][i] = sigma * (double)frame[3 * i + k];
        }
    }
    l->rho *= norm;
    l->norm = fabs(sigma) * norm;
}

static bool add_placed(local *l, const csg_tape *tape, const csg_tape_node *leaf, const double c[3])
{
    const float *parameters = tape->parameters + leaf->parameters;
    const float *frame = parameters + CSG_LEAF_FRAME;
    double sigma = (double)parameters[CSG_LEAF_SIGMA];
    if (leaf->frame == CSG_FRAME_OFFSET) {
        l->own = parameters + CSG_LEAF_OWN_OFFSET;
        l->norm = fabs(sigma);
        for (int k = 0; k < 3; k++) {
            l->q[k] = c[k] - (double)frame[k];
            l->turn[k][k] = sigma;
        }
    } else {
        l->own = parameters + CSG_LEAF_OWN_AFFINE;
        place_affine(l, frame, c, sigma);
    }
    if (leaf->op == CSG_OP_SHAPE)
        return add_shape(l, tape);
    return leaf->op == CSG_OP_FIELD ? add_formula(l, tape) : add_own(l, leaf->op);
}

static bool has_faces(uint8_t op)
{
    return op == CSG_OP_BOX || op == CSG_OP_RECTANGLE || op == CSG_OP_FRUSTUM || op == CSG_OP_SHAPE;
}

bool csg_cone_add_leaf(csg_cone_balls *balls, const csg_tape *tape, const csg_tape_node *leaf,
                       const float c[3], double radius)
{
    /* the slack: the frame's own rounding */
    double at[3] = {(double)c[0], (double)c[1], (double)c[2]};
    local l = {.balls = balls,
               .rho = radius + (double)tape->parameters[leaf->parameters + CSG_LEAF_SLACK]};
    csg_cone_way way;
    uint32_t first = balls->count;
    balls->corner = 0;
    if ((leaf->warp && !csg_cone_warp(tape, leaf->warp, at, &l.rho, &way)) ||
        !add_placed(&l, tape, leaf, at))
        return false;
    if (has_faces(leaf->op) && balls->count - first > 1)
        balls->corner = l.norm; /* in its own frame they are unit vectors */
    return !leaf->warp || csg_cone_unwarp(&way, balls, first);
}
