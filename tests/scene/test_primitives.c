/* SPDX-License-Identifier: MIT
 * Every primitive of primitives.def, with the random parameters that are its example: distance and
 * support function say the same solid, |f(p) - f(q)| <= |p - q|, gradients against central
 * differences. Some of them also against a membership test that shares nothing with the distance
 * formula: sign, distance to points of the surface found by bisection along rays, and the foot
 * point p - f grad f on the surface.
 */
#include "scene_support.h"

#include "random_scene.h"
#include "scene/primitives/kinds.h"
#include "scene/primitives/primitive.h"
#include "scene/primitives/superellipsoid.h"

enum { SETS = 5, SURFACE_POINTS = 2000, QUERIES = 60 };

/* ---- membership ------------------------------------------------------------------------- */

typedef struct section {
    const double *v;
    csg_vec3 p;
} section;

/* Largest value of a concave function on [low, high]. */
static double maximize(double f(const section *, double), const section *s, double low, double high)
{
    for (int i = 0; i < 70; i++) {
        double a = low + (high - low) * 0.382, b = low + (high - low) * 0.618;
        if (f(s, a) < f(s, b))
            low = a;
        else
            high = b;
    }
    return f(s, (low + high) / 2);
}

static double slice_of_frustum(const section *s, double z)
{
    const double *v = s->v;
    double radius = v[0] + (v[1] - v[0]) * (z + v[2]) / (2 * v[2]);
    double over = fmax(hypot(s->p.x, s->p.y) - radius, 0);
    return -hypot(over, s->p.z - z);
}

static double ball_of_capsule(const section *s, double z)
{
    const double *v = s->v;
    csg_vec3 center = {0, 0, z};
    return v[1] + (v[2] - v[1]) * z / v[0] - csg_vec3_norm(csg_vec3_sub(s->p, center));
}

static bool is_in_box(const double *v, csg_vec3 p)
{
    double square = 0;
    const double at[3] = {p.x, p.y, p.z};
    for (int i = 0; i < 3; i++) {
        double over = fmax(fabs(at[i]) - (v[i] - v[3]), 0);
        square += over * over;
    }
    return square <= v[3] * v[3];
}

static bool is_in_torus(const double *v, csg_vec3 p)
{
    double half = v[2] * (3.14159265358979323846 / 180);
    double angle = fmin(fmax(atan2(p.y, p.x), -half), half);
    csg_vec3 nearest = {v[0] * cos(angle), v[0] * sin(angle), 0};
    return csg_vec3_norm(csg_vec3_sub(p, nearest)) <= v[1];
}

static bool is_inside(csg_primitive_kind kind, const double *v, csg_vec3 p)
{
    section s = {v, p};
    switch (kind) {
    case CSG_NODE_SPHERE:
        return csg_vec3_dot(p, p) <= v[0] * v[0];
    case CSG_NODE_BOX:
        return is_in_box(v, p);
    case CSG_NODE_FRUSTUM:
        return fmax(slice_of_frustum(&s, fmin(fmax(p.z, -v[2]), v[2])),
                    maximize(slice_of_frustum, &s, -v[2], v[2])) >= -v[3];
    case CSG_NODE_CAPSULE:
        return fmax(fmax(ball_of_capsule(&s, 0), ball_of_capsule(&s, v[0])),
                    maximize(ball_of_capsule, &s, 0, v[0])) >= 0;
    case CSG_NODE_TORUS:
        return is_in_torus(v, p);
    case CSG_NODE_ELLIPSOID:
        return csg_vec3_norm(csg_vec3_make(p.x / v[0], p.y / v[1], p.z / v[2])) <= 1;
    default:
        return v[0] * p.x + v[1] * p.y + v[2] * p.z <= v[3];
    }
}

/* ---- against the surface ------------------------------------------------------------------ */

static csg_vec3 inner_point(csg_primitive_kind kind, const double *v, csg_random *random)
{
    if (kind == CSG_NODE_TORUS) {
        double half = v[2] * (3.14159265358979323846 / 180);
        double angle = csg_random_uniform(random, -half, half);
        return csg_vec3_make(v[0] * cos(angle), v[0] * sin(angle), 0);
    }
    if (kind == CSG_NODE_CAPSULE)
        return csg_vec3_make(0, 0, v[1] > v[2] ? 0 : v[0]);
    return csg_vec3_make(0, 0, 0);
}

static csg_vec3 surface_point(csg_primitive_kind kind, const double *v, csg_random *random)
{
    csg_vec3 from = inner_point(kind, v, random), along = test_direction(random);
    double low = 0, high = 8;
    for (int i = 0; i < 50; i++) {
        double middle = (low + high) / 2;
        csg_vec3 p = csg_vec3_add(from, csg_vec3_scale(along, middle));
        if (is_inside(kind, v, p))
            low = middle;
        else
            high = middle;
    }
    return csg_vec3_add(from, csg_vec3_scale(along, low));
}

static double distance_to(const csg_vec3 *surface, csg_vec3 p)
{
    double nearest = INFINITY;
    for (int i = 0; i < SURFACE_POINTS; i++)
        nearest = fmin(nearest, csg_vec3_norm(csg_vec3_sub(surface[i], p)));
    return nearest;
}

/* p - f grad f is on the surface: one side of it is inside, the other is not. */
static void check_foot(csg_primitive_kind kind, const double *v, csg_vec3 p, csg_sample s)
{
    const double step = 1e-6;
    if (fabs(csg_vec3_norm(s.gradient) - 1) > 1e-9)
        return; /* on the medial axis */
    csg_vec3 in = csg_vec3_add(p, csg_vec3_scale(s.gradient, step - s.value));
    csg_vec3 out = csg_vec3_add(p, csg_vec3_scale(s.gradient, -step - s.value));
    assert_false(is_inside(kind, v, out));
    if (is_inside(kind, v, in))
        return;
    /* across a sharp edge "in" leaves the solid unless the step is the gradient's own: the foot
     * itself must then touch the solid */
    csg_vec3 foot = csg_vec3_sub(p, csg_vec3_scale(s.gradient, s.value));
    double touch = csg_reference_primitive(kind, v, foot).value;
    test_near(touch, 0, 1e-12);
}

static void check_query(csg_primitive_kind kind, const double *v, const csg_vec3 *surface,
                        csg_vec3 p)
{
    csg_sample s = csg_reference_primitive(kind, v, p);
    if (fabs(s.value) > 1e-9)
        assert_int_equal(s.value > 0, is_inside(kind, v, p));
    double nearest = distance_to(surface, p);
    assert_true(nearest >= fabs(s.value) - 1e-9);
    bool lower_bound_only = kind == CSG_NODE_TORUS && s.value > 0;
    if (lower_bound_only)
        return;
    assert_true(nearest <= fabs(s.value) + 0.15);
    check_foot(kind, v, p, s);
}

static void check_distance(csg_primitive_kind kind)
{
    static csg_vec3 surface[SURFACE_POINTS];
    csg_random random = {100 + (uint64_t)kind};
    for (int set = 0; set < SETS; set++) {
        double v[4];
        test_random_parameters(&random, kind, v);
        for (int i = 0; i < SURFACE_POINTS; i++) {
            surface[i] = surface_point(kind, v, &random);
            test_near(csg_reference_primitive(kind, v, surface[i]).value, 0, 1e-9);
        }
        for (int i = 0; i < QUERIES; i++)
            check_query(kind, v, surface, test_point(&random, 1.2));
    }
}

static void test_distance(void **state)
{
    const csg_primitive_kind known[] = {CSG_NODE_SPHERE,  CSG_NODE_BOX,   CSG_NODE_FRUSTUM,
                                        CSG_NODE_CAPSULE, CSG_NODE_TORUS, CSG_NODE_ELLIPSOID};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        check_distance(known[i]);
}

/* ---- against the support function --------------------------------------------------------------
 * With h(n) the largest n . x over a convex solid, its signed distance is the least h(n) - n . p
 * over all unit vectors n, inside and outside, and minus the gradient is the n that decides. Of any
 * solid no point that is inside is beyond h(n).
 */

static void check_support(csg_primitive_kind kind, const double *v, csg_vec3 p, csg_vec3 n)
{
    const csg_primitive *primitive = csg_primitive_of(kind);
    bool is_convex = primitive->traits & CSG_TRAIT_CONVEX && primitive->traits & CSG_TRAIT_OUTSIDE;
    csg_sample s = csg_reference_primitive(kind, v, p);
    double least = primitive->support(v, n) - csg_vec3_dot(n, p);
    assert_true(!(s.value >= 0) || least >= -1e-12);
    if (!is_convex)
        return;
    assert_true(s.value <= least + 1e-12);
    if (fabs(csg_vec3_norm(s.gradient) - 1) > 1e-9)
        return; /* several places are as near */
    csg_vec3 out = csg_vec3_scale(s.gradient, -1);
    test_near(s.value, primitive->support(v, out) - csg_vec3_dot(out, p), 1e-9);
}

static void test_support(void **state)
{
    csg_random random = {150};
    for (csg_primitive_kind kind = CSG_NODE_FIRST_PRIMITIVE; kind < CSG_NODE_PRIMITIVES_END; kind++)
        for (int set = 0; set < 200; set++) {
            double v[CSG_PRIMITIVE_MOST_PARAMETERS];
            csg_refusal refusal = {0};
            test_random_parameters(&random, kind, v);
            assert_true(csg_primitive_of(kind)->check(&refusal, v));
            for (int i = 0; i < 100; i++)
                check_support(kind, v, test_point(&random, 1.5), test_direction(&random));
        }
}

static void test_plane(void **state)
{
    const double v[4] = {0.6, 0, 0.8, 0.25};
    csg_sample s = csg_reference_primitive(CSG_NODE_PLANE, v, csg_vec3_make(1, 5, -2));
    test_near(s.value, 1.25, 1e-15);
    test_near_vec3(s.gradient, csg_vec3_make(-0.6, 0, -0.8), 0);
}

/* ---- Lipschitz constant and gradient ----------------------------------------------------- */

static void check_pair(csg_primitive_kind kind, const double *v, csg_vec3 p, csg_vec3 q)
{
    double a = csg_reference_primitive(kind, v, p).value;
    double b = csg_reference_primitive(kind, v, q).value;
    double distance = csg_vec3_norm(csg_vec3_sub(p, q));
    assert_true(fabs(a - b) <= distance * (1 + 1e-9) + 1e-14);
}

static void test_lipschitz(void **state)
{
    for (csg_primitive_kind kind = CSG_NODE_FIRST_PRIMITIVE; kind < CSG_NODE_PRIMITIVES_END;
         kind++) {
        bool is_curve = csg_primitive_has(kind, CSG_TRAIT_CURVE); /* costly */
        csg_random random = {200 + (uint64_t)kind};
        for (int set = 0; set < (is_curve ? 20 : 200); set++) {
            double v[CSG_PRIMITIVE_MOST_PARAMETERS];
            csg_refusal refusal = {0};
            test_random_parameters(&random, kind, v);
            assert_true(csg_primitive_of(kind)->check(&refusal, v));
            for (int i = 0; i < 200; i++) {
                csg_vec3 p = test_point(&random, 1.5), q = test_point(&random, 1.5);
                check_pair(kind, v, p, q);
                double near = pow(10, csg_random_uniform(&random, -9, -1));
                check_pair(kind, v, p, csg_vec3_add(p, csg_vec3_scale(q, near)));
                csg_vec3 below = {p.x, p.y, -p.z * near}, flat = {p.x, p.y * near, p.z * near};
                check_pair(kind, v, csg_vec3_make(p.x, p.y, 0), below);
                check_pair(kind, v, flat, csg_vec3_make(flat.x, -flat.y, 0));
            }
        }
    }
}

static csg_vec3 shifted(csg_vec3 p, int axis, double by)
{
    return csg_vec3_make(p.x + (axis == 0 ? by : 0), p.y + (axis == 1 ? by : 0),
                         p.z + (axis == 2 ? by : 0));
}

/* False where the field has a crease within a step. */
static bool check_gradient(csg_primitive_kind kind, const double *v, csg_vec3 p)
{
    const double step = 1e-5;
    csg_sample s = csg_reference_primitive(kind, v, p);
    const double gradient[3] = {s.gradient.x, s.gradient.y, s.gradient.z};
    double difference[3];
    for (int axis = 0; axis < 3; axis++) {
        double up = csg_reference_primitive(kind, v, shifted(p, axis, step)).value;
        double down = csg_reference_primitive(kind, v, shifted(p, axis, -step)).value;
        if (fabs((up - s.value) - (s.value - down)) > 2e-3 * step)
            return false;
        difference[axis] = (up - down) / (2 * step);
    }
    for (int axis = 0; axis < 3; axis++)
        test_near(gradient[axis], difference[axis], 1e-3);
    return true;
}

static void test_gradient(void **state)
{
    for (csg_primitive_kind kind = CSG_NODE_FIRST_PRIMITIVE; kind < CSG_NODE_PRIMITIVES_END;
         kind++) {
        csg_random random = {300 + (uint64_t)kind};
        int checked = 0;
        if (csg_primitive_has(kind, CSG_TRAIT_CURVE))
            continue; /* test_curves.c */
        for (int i = 0; i < 4000; i++) {
            double v[CSG_PRIMITIVE_MOST_PARAMETERS];
            csg_refusal refusal = {0};
            test_random_parameters(&random, kind, v);
            assert_true(csg_primitive_of(kind)->check(&refusal, v));
            checked += check_gradient(kind, v, test_point(&random, 1.5));
        }
        assert_true(checked > 3900);
    }
}

/* ---- places where formulas break ---------------------------------------------------------- */

static void test_critical_points(void **state)
{
    const csg_vec3 origin = {0, 0, 0}, zero = {0, 0, 0};
    const struct {
        csg_primitive_kind kind;
        double v[4];
        csg_vec3 at;
        double value;
    } rows[] = {
        {CSG_NODE_SPHERE, {0.7}, origin, 0.7},
        {CSG_NODE_BOX, {0.3, 0.4, 0.5, 0.1}, origin, 0.3},
        {CSG_NODE_FRUSTUM, {0.4, 0.4, 0.5, 0}, origin, 0.4},
        {CSG_NODE_CAPSULE, {1, 0.3, 0.3}, {0, 0, 0.5}, 0.3},
        {CSG_NODE_TORUS, {1, 0.25, 180}, {1, 0, 0}, 0.25},
        {CSG_NODE_TORUS, {1, 0.25, 30}, {1, 0, 0}, 0.25},
        {CSG_NODE_ELLIPSOID, {2, 1, 0.5}, origin, 0.5},
        {CSG_NODE_ELLIPSOID, {1, 1, 1}, origin, 1},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        csg_sample s = csg_reference_primitive(rows[i].kind, rows[i].v, rows[i].at);
        test_near(s.value, rows[i].value, 1e-15);
        test_near_vec3(s.gradient, zero, 0);
    }
}

static void test_pointed_cone(void **state)
{
    const double v[4] = {0, 1, 0.5, 0}; /* apex down at (0, 0, -0.5), 45 degrees */
    csg_sample below = csg_reference_primitive(CSG_NODE_FRUSTUM, v, csg_vec3_make(0, 0, -1.5));
    test_near(below.value, -1, 1e-15);
    test_near_vec3(below.gradient, csg_vec3_make(0, 0, 1), 1e-15);
    csg_sample inside = csg_reference_primitive(CSG_NODE_FRUSTUM, v, csg_vec3_make(0, 0, 0));
    test_near(inside.value, 0.5 * sqrt(0.5), 1e-15);
    csg_sample side = csg_reference_primitive(CSG_NODE_FRUSTUM, v, csg_vec3_make(1, 0, -0.5));
    test_near(side.value, -sqrt(0.5), 1e-15);
}

static void test_torus_arc(void **state)
{
    const double v[3] = {1, 0.25, 90}; /* from -y over +x to +y */
    csg_sample opposite = csg_reference_primitive(CSG_NODE_TORUS, v, csg_vec3_make(-1, 0.001, 0));
    test_near(opposite.value, 0.25 - hypot(1, 0.999), 1e-15);
    csg_sample end = csg_reference_primitive(CSG_NODE_TORUS, v, csg_vec3_make(-0.25, 1, 0));
    test_near(end.value, 0, 1e-15);
    csg_sample middle = csg_reference_primitive(CSG_NODE_TORUS, v, csg_vec3_make(0, 0, 0));
    test_near(middle.value, -0.75, 1e-15);
}

/* The distance must not jump across the plane of the longest axes, nor lose its digits for thin
 * and long ellipsoids. */
static void test_ellipsoid_medial(void **state)
{
    const double v[3] = {2, 1, 0.5};
    csg_random random = {7};
    for (int i = 0; i < 2000; i++) {
        csg_vec3 p = {csg_random_uniform(&random, -1.8, 1.8),
                      csg_random_uniform(&random, -0.9, 0.9), 0};
        double on = csg_reference_primitive(CSG_NODE_ELLIPSOID, v, p).value;
        for (double z = 1e-3; z > 1e-320; z *= 1e-9) {
            double off =
                csg_reference_primitive(CSG_NODE_ELLIPSOID, v, csg_vec3_make(p.x, p.y, z)).value;
            test_near(off, on, z + 1e-15);
        }
    }
}

static void test_ellipsoid_extreme(void **state)
{
    const double shapes[][3] = {{1e6, 1, 1e-6}, {1, 1, 1e-6}, {1e5, 1e5, 1}, {1, 1 + 1e-15, 1}};
    csg_random random = {8};
    for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++) {
        const double *v = shapes[k];
        double largest = fmax(v[0], fmax(v[1], v[2]));
        for (int i = 0; i < 2000; i++) {
            csg_vec3 n = test_direction(&random);
            csg_vec3 p = {v[0] * n.x, v[1] * n.y, v[2] * n.z};
            test_near(csg_reference_primitive(CSG_NODE_ELLIPSOID, v, p).value, 0, 1e-15 * largest);
            csg_vec3 normal = csg_vec3_normalize(csg_vec3_make(n.x / v[0], n.y / v[1], n.z / v[2]));
            csg_vec3 out = csg_vec3_add(p, csg_vec3_scale(normal, 3));
            csg_sample s = csg_reference_primitive(CSG_NODE_ELLIPSOID, v, out);
            test_near(s.value, -3, 1e-14 * largest);
        }
    }
}

/* Axes with the shortest last, as they are packed; often two of them are the same, or nearly. */
static void random_axes(csg_random *random, float own[6])
{
    own[2] = (float)csg_random_uniform(random, 0.2, 1);
    for (int i = 0; i < 2; i++) {
        double more = csg_random_uniform(random, 0, 1);
        more = more < 0.3 ? 0 : more < 0.4 ? 1e-4 : 4 * more;
        own[i] = own[2] * (float)(1 + more);
        own[3 + i] = (own[i] / own[2]) * (own[i] / own[2]);
    }
    own[5] = 0;
}

/* Gradients in a ball, mostly inside, where it comes near to where they jump, too. shares: how
 * much of what is claimed they reach at most, of the spread and of the bend. */
static void check_turns(csg_random *random, const float own[6], double shares[2])
{
    const double v[3] = {(double)own[0], (double)own[1], (double)own[2]};
    csg_cone_balls balls = {.count = 0};
    csg_cone_leaf l = {.balls = &balls, .own = own, .norm = 1, .bend = INFINITY};
    csg_vec3 n = test_direction(random);
    double size = 1.1 * cbrt(csg_random_uniform(random, 0, 1)),
           flat = csg_random_uniform(random, 0, 1) < 0.5 ? 0.1 : 1;
    csg_vec3 q = {size * v[0] * n.x, size * v[1] * n.y, flat * size * v[2] * n.z};
    l.q[0] = q.x, l.q[1] = q.y, l.q[2] = q.z;
    l.rho = v[2] * pow(10, csg_random_uniform(random, -3, -0.3));
    for (int k = 0; k < 3; k++)
        l.turn[k][k] = 1;
    if (!csg_primitive_of(CSG_NODE_ELLIPSOID)->gradients(&l))
        return;
    const csg_cone_ball *ball = &balls.items[0];
    csg_vec3 middle = {ball->at[0], ball->at[1], ball->at[2]}, last = q, at_last = middle;
    for (int i = 0; i < 12; i++) {
        csg_vec3 way = i % 3 ? test_direction(random) : csg_vec3_make(0, 0, q.z > 0 ? -1 : 1);
        double far = l.rho * cbrt(csg_random_uniform(random, 0, 1));
        csg_vec3 x = csg_vec3_add(q, csg_vec3_scale(way, far));
        csg_vec3 g = csg_reference_primitive(CSG_NODE_ELLIPSOID, v, x).gradient;
        shares[0] = fmax(shares[0], (csg_vec3_norm(csg_vec3_sub(g, middle)) - 1e-4) / ball->spread);
        double apart = csg_vec3_norm(csg_vec3_sub(x, last));
        if (i && isfinite(l.bend) && apart > 1e-3 * l.rho)
            shares[1] = fmax(shares[1],
                             (csg_vec3_norm(csg_vec3_sub(g, at_last)) - 1e-9) / (l.bend * apart));
        last = x;
        at_last = g;
    }
}

static void test_ellipsoid_turns(void **state)
{
    csg_random random = {9};
    double shares[2] = {0, 0};
    for (int i = 0; i < 20000; i++) {
        float own[6];
        random_axes(&random, own);
        check_turns(&random, own, shares);
    }
    assert_true(shares[0] <= 1 && shares[0] > 0.8);
    assert_true(shares[1] <= 1 && shares[1] > 0.8);
}

/* ---- a stated factor ------------------------------------------------------------------------- */

/* The largest hypot(a u, b w) where |u|^p + |w|^p <= 1 (Hoelder). */
static double farthest_of_two(double a, double b, double p)
{
    return p > 2 ? sqrt(csg_dual_norm(a * a, b * b, p / 2)) : fmax(a, b);
}

/* |f| <= distance <= K |f| as the manual says it: K is the farthest point's distance from the centre over the
 * shortest semi-axis for exponents of 2 and more, times the gauge's constant in general. */
static void test_superellipsoid_factor(void **state)
{
    enum { SOLIDS = 40, SAMPLES = 20, POINTS = 200 };
    csg_random random = {11};
    (void)state;
    for (int i = 0; i < SOLIDS; i++) {
        double v[6] = {csg_random_uniform(&random, 1, 9), csg_random_uniform(&random, 1, 9),
                       csg_random_uniform(&random, 1, 9), csg_random_uniform(&random, 1, 9),
                       csg_random_uniform(&random, 1, 9), 0};
        csg_refusal refusal;
        assert_true(csg_superellipsoid_check(&refusal, v));
        double far = farthest_of_two(farthest_of_two(v[0], v[1], v[3]), v[2], v[4]), reached = 0;
        double least = fmin(v[0], fmin(v[1], v[2]));
        if (v[3] >= 2 && v[4] >= 2)
            assert_true(fabs(v[5] * least - 1) < 1e-12);
        for (int n = 0; n < SAMPLES; n++) {
            csg_vec3 p = {csg_random_uniform(&random, -12, 12),
                          csg_random_uniform(&random, -12, 12),
                          csg_random_uniform(&random, -12, 12)};
            double f = csg_superellipsoid_distance(v, p).value, nearest = INFINITY;
            for (int k = 0; k < POINTS;
                 k++) { /* of the surface; the first along the ray through p */
                csg_vec3 q = k ? csg_vec3_make(csg_random_uniform(&random, -1, 1),
                                               csg_random_uniform(&random, -1, 1),
                                               csg_random_uniform(&random, -1, 1))
                               : p;
                q = csg_vec3_scale(q, 1 / (1 - v[5] * csg_superellipsoid_distance(v, q).value));
                reached = fmax(reached, csg_vec3_norm(q) / far);
                nearest = fmin(nearest, csg_vec3_norm(csg_vec3_sub(p, q)));
            }
            assert_true(fabs(f) <= nearest * (1 + 1e-12));
            assert_true(nearest <= far * v[5] * fabs(f) * (1 + 1e-12));
        }
        assert_true(reached <= 1 + 1e-12 && reached > 0.8);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_distance),
        cmocka_unit_test(test_plane),
        cmocka_unit_test(test_superellipsoid_factor),
        cmocka_unit_test(test_support),
        cmocka_unit_test(test_lipschitz),
        cmocka_unit_test(test_gradient),
        cmocka_unit_test(test_critical_points),
        cmocka_unit_test(test_pointed_cone),
        cmocka_unit_test(test_torus_arc),
        cmocka_unit_test(test_ellipsoid_medial),
        cmocka_unit_test(test_ellipsoid_extreme),
        cmocka_unit_test(test_ellipsoid_turns),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
