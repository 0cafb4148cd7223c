/* SPDX-License-Identifier: MIT
 * Refining; see refine.h. What collapses have taken away gives the numbers of the new vertices and
 * triangles.
 */
#include "mesh/reshape/refine.h"

#include <math.h>
#include <string.h>

#include "mesh/plane.h"

typedef struct refiner {
    csg_remesh *remesh;
    csg_begun begun;           /* the surface, if polyhedra's triangles are it */
    uint8_t *pending;          /* per triangle: to be proven (again) */
    uint32_t triangle, vertex; /* those before it are in use */
} refiner;

/* The next triangle that is gone; NONE: there is none. */
static uint32_t free_triangle(refiner *f)
{
    const csg_corners *m = &f->remesh->corners;
    while (f->triangle < m->triangle_count && csg_corners_is_live(m, f->triangle))
        f->triangle++;
    return f->triangle < m->triangle_count ? f->triangle++ : CSG_CORNER_NONE;
}

static uint32_t free_vertex(refiner *f)
{
    const csg_corners *m = &f->remesh->corners;
    while (f->vertex < m->vertex_count && m->corner[f->vertex] != CSG_CORNER_NONE)
        f->vertex++;
    return f->vertex < m->vertex_count ? f->vertex++ : CSG_CORNER_NONE;
}

/* The field's tangent plane at a place. */
static bool find_plane(csg_remesh *r, csg_vec3 at, csg_plane *out)
{
    float place[1][3], f, g[1][3];
    csg_vec3_to_floats(place[0], at);
    csg_probe_values(&r->probe, (const float(*)[3])place, 1, &f);
    csg_probe_gradients(&r->probe, (const float(*)[3])place, 1, g);
    csg_vec3 slope = {(double)g[0][0], (double)g[0][1], (double)g[0][2]};
    *out = csg_plane_of(at, (double)f, slope);
    return csg_vec3_norm(slope) > 1e-3;
}

/* A crease's place is where the tangent planes of both its sides meet, of all such places the
 * nearest one. They are asked for beside it, where the crease itself is not. */
static bool bring_to_crease(csg_remesh *r, uint32_t corner, csg_vec3 *at)
{
    enum { STEPS = 3 };
    static const double LEAST_SQUARE = 0.05; /* of the sine */
    csg_vec3 a = csg_remesh_corner(r, corner), b = csg_remesh_corner(r, csg_corner_next(corner));
    csg_vec3 along = csg_vec3_normalize(csg_vec3_sub(b, a)), way[2], p = *at;
    uint32_t apex = csg_corner_previous(corner);
    const uint32_t beside[2] = {apex, r->corners.across[apex]};
    for (int i = 0; i < 2; i++) {
        csg_vec3 off = csg_vec3_sub(csg_remesh_corner(r, beside[i]), a);
        off = csg_vec3_sub(off, csg_vec3_scale(along, csg_vec3_dot(off, along)));
        double height = csg_vec3_norm(off);
        if (!(height > 0))
            return false;
        way[i] = csg_vec3_scale(off, fmin(2 * r->error, 0.5 * height) / height);
    }
    for (int step = 0; step < STEPS; step++) {
        csg_plane face[2];
        if (!find_plane(r, csg_vec3_add(p, way[0]), &face[0]) ||
            !find_plane(r, csg_vec3_add(p, way[1]), &face[1]) ||
            !csg_planes_meet_in_line(face, LEAST_SQUARE, &p))
            return false;
        if (!(csg_vec3_norm(csg_vec3_sub(p, *at)) <= 4 * r->error))
            return false;
    }
    *at = p;
    return true;
}

/* A side of a triangle, by the corner it starts at, and where it is to be cut. */
typedef struct side {
    uint32_t corner;
    double length, away; /* away: from the surface, by the field or the crease */
    csg_vec3 at;
} side;

static const double FAR = 0.3; /* of the error */

enum { CUTS = 7, MIDDLE = CUTS / 2 }; /* places of a side that are looked at, evenly spread */

/* What is far from the surface comes first, then what is long. */
static bool is_worse(const side *a, const side *b, double far)
{
    bool a_far = a->away > far, b_far = b->away > far;
    if (a_far != b_far)
        return a_far;
    return a_far ? a->away > b->away : a->length > b->length;
}

static csg_vec3 place_of(const csg_remesh *r, uint32_t corner, int cut)
{
    csg_vec3 a = csg_remesh_corner(r, corner), b = csg_remesh_corner(r, csg_corner_next(corner));
    double share = (cut + 1.0) / (CUTS + 1);
    return csg_vec3_add(csg_vec3_scale(a, 1 - share), csg_vec3_scale(b, share));
}

/* Sides are cut in the middle, unless they are much farther from the surface elsewhere: a long side
 * that ends in a tight curve would be halved many times until it meets that. */
static side look_at_side(csg_remesh *r, uint32_t corner, const float f[CUTS])
{
    static const double MUCH = 1.5;
    int worst = MIDDLE;
    for (int i = 0; i < CUTS; i++)
        if (fabs((double)f[i]) > MUCH * fabs((double)f[MIDDLE]) && fabsf(f[i]) > fabsf(f[worst]))
            worst = i;
    csg_vec3 a = csg_remesh_corner(r, corner), b = csg_remesh_corner(r, csg_corner_next(corner));
    side one = {corner, csg_vec3_norm(csg_vec3_sub(b, a)), fabs((double)f[worst]),
                place_of(r, corner, worst)};
    csg_vec3 middle = place_of(r, corner, MIDDLE), to = middle;
    if (csg_remesh_is_crease(r, corner)) {
        one.at = middle;
        one.away = fabs((double)f[MIDDLE]);
        if (bring_to_crease(r, corner, &to))
            one.away = csg_vec3_norm(csg_vec3_sub(to, middle));
    }
    return one;
}

/* The sides in the order in which they should be cut: long triangles along a curve are as far from
 * it however short they get. */
static void sides_to_cut(csg_remesh *r, uint32_t triangle, side sides[3])
{
    float at[3 * CUTS][3], f[3 * CUTS];
    int count = 0;
    for (uint32_t k = 0; k < 3; k++)
        for (int i = 0; i < CUTS; i++)
            csg_vec3_to_floats(at[k * CUTS + (uint32_t)i], place_of(r, 3 * triangle + k, i));
    csg_probe_values(&r->probe, (const float(*)[3])at, 3 * CUTS, f);
    for (uint32_t k = 0; k < 3; k++) {
        side one = look_at_side(r, 3 * triangle + k, f + k * CUTS);
        int i = count++;
        for (; i && is_worse(&one, &sides[i - 1], FAR * r->error); i--)
            sides[i] = sides[i - 1];
        sides[i] = one;
    }
}

/* Out of the solid; zero where the field says nothing. */
static csg_vec3 outward_at(csg_remesh *r, csg_vec3 at)
{
    float place[1][3], g[1][3];
    csg_vec3_to_floats(place[0], at);
    csg_probe_gradients(&r->probe, (const float(*)[3])place, 1, g);
    return csg_vec3_normalize(csg_vec3_make(-(double)g[0][0], -(double)g[0][1], -(double)g[0][2]));
}

/* The triangles that a vertex at this place makes of both beside a side: two of the corner's own,
 * then two of the other's. */
static void parts_of_cut(const csg_remesh *r, uint32_t corner, csg_vec3 at, csg_vec3 out[4][3])
{
    uint32_t apex = csg_corner_previous(corner);
    csg_vec3 a = csg_remesh_corner(r, corner), b = csg_remesh_corner(r, csg_corner_next(corner));
    csg_vec3 c = csg_remesh_corner(r, apex), d = csg_remesh_corner(r, r->corners.across[apex]);
    const csg_vec3 parts[4][3] = {{c, a, at}, {c, at, b}, {d, b, at}, {d, at, a}};
    memcpy(out, parts, sizeof parts);
}

/* Whether the four triangles keep the way they face, or face as the surface does (slivers turn),
 * and cross nothing. */
static bool is_sound(csg_remesh *r, uint32_t corner, csg_vec3 at)
{
    uint32_t apex = csg_corner_previous(corner);
    csg_vec3 a = csg_remesh_corner(r, corner), b = csg_remesh_corner(r, csg_corner_next(corner));
    csg_vec3 c = csg_remesh_corner(r, apex), d = csg_remesh_corner(r, r->corners.across[apex]);
    csg_vec3 left = csg_vec3_normalize(csg_triangle_cross(c, a, b));
    csg_vec3 right = csg_vec3_normalize(csg_triangle_cross(d, b, a));
    double worst = fmin(csg_triangle_quality(c, a, b), csg_triangle_quality(d, b, a));
    double least = fmin(1e-3, 0.25 * worst);
    csg_vec3 outward = outward_at(r, at);
    csg_vec3 parts[4][3];
    parts_of_cut(r, corner, at, parts);
    for (int i = 0; i < 4; i++) {
        csg_vec3 normal =
            csg_vec3_normalize(csg_triangle_cross(parts[i][0], parts[i][1], parts[i][2]));
        if ((csg_vec3_dot(normal, i < 2 ? left : right) < 0.3 &&
             csg_vec3_dot(normal, outward) < 0.3) ||
            csg_triangle_quality(parts[i][0], parts[i][1], parts[i][2]) < least)
            return false;
    }
    const uint32_t *v = r->corners.vertex;
    uint32_t ends[2] = {v[corner], v[csg_corner_next(corner)]}, new = CSG_CORNER_NONE;
    uint32_t apexes[2] = {v[apex], v[r->corners.across[apex]]};
    const uint32_t ids[4][3] = {{apexes[0], ends[0], new},
                                {apexes[0], new, ends[1]},
                                {apexes[1], ends[1], new},
                                {apexes[1], new, ends[0]}};
    const csg_crossing_change change = {.at = (const csg_vec3(*)[3])parts,
                                        .vertex = ids,
                                        .count = 4,
                                        .vertices = {CSG_CORNER_NONE, CSG_CORNER_NONE},
                                        .triangles = {corner / 3, r->corners.across[apex] / 3}};
    return !csg_crossing_is_made(&r->tree, &change, NULL);
}

/* The mean of the normals at a side. */
static csg_vec3 normal_at(const csg_remesh *r, uint32_t corner)
{
    csg_vec3 sum = {0, 0, 0};
    const uint32_t beside[2] = {corner / 3, r->corners.across[csg_corner_previous(corner)] / 3};
    for (int i = 0; i < 2; i++) {
        uint32_t c = 3 * beside[i];
        sum = csg_vec3_add(sum, csg_vec3_normalize(csg_triangle_cross(
                                    csg_remesh_corner(r, c), csg_remesh_corner(r, c + 1),
                                    csg_remesh_corner(r, c + 2))));
    }
    return csg_vec3_normalize(sum);
}

/* Where the way in from outside, along the normal, first meets the solid. */
static bool find_entry(csg_remesh *r, csg_vec3 *at, csg_vec3 normal)
{
    enum { STEPS = 16, HALVINGS = 4 };
    double high = 2 * r->error, step = 2 * high / STEPS;
    for (int halving = 0; halving < HALVINGS; halving++, step /= STEPS) {
        float place[STEPS + 1][3], f[STEPS + 1];
        for (int i = 0; i <= STEPS; i++)
            csg_vec3_to_floats(place[i],
                               csg_vec3_add(*at, csg_vec3_scale(normal, high - i * step)));
        csg_probe_values(&r->probe, (const float(*)[3])place, STEPS + 1, f);
        int inside = 0;
        while (inside <= STEPS && f[inside] < 0)
            inside++;
        if (!halving && (inside == 0 || inside > STEPS))
            return false;
        high -= (inside - 1) * step;
    }
    *at = csg_vec3_add(*at, csg_vec3_scale(normal, high));
    return true;
}

/* Newton's steps may end where f is zero within the solid: where parts of it touch. */
static bool bring_to_surface(csg_remesh *r, csg_vec3 *at, csg_vec3 normal)
{
    static const double OUT = 0.125; /* of the error */
    csg_vec3 p = *at;
    if (csg_remesh_project(r, &p, 4 * r->error)) {
        float place[1][3], f;
        csg_vec3_to_floats(place[0], csg_vec3_add(p, csg_vec3_scale(normal, OUT * r->error)));
        csg_probe_values(&r->probe, (const float(*)[3])place, 1, &f);
        if (f < 0) {
            *at = p;
            return true;
        }
    }
    return find_entry(r, at, normal);
}

/* A vertex at this place, in a side that is cut there. */
static bool split(refiner *f, uint32_t corner, csg_vec3 at)
{
    csg_remesh *r = f->remesh;
    if (!is_sound(r, corner, at))
        return false;
    uint32_t vertex = free_vertex(f);
    const uint32_t triangles[2] = {free_triangle(f), free_triangle(f)};
    if (vertex == CSG_CORNER_NONE || triangles[0] == CSG_CORNER_NONE ||
        triangles[1] == CSG_CORNER_NONE)
        return false;
    uint32_t other = r->corners.across[csg_corner_previous(corner)] / 3;
    r->at[vertex] = at;
    r->kind[vertex] = csg_remesh_is_crease(r, corner) ? CSG_VERTEX_CREASE : CSG_VERTEX_SMOOTH;
    if (r->looks)
        r->looks[vertex] = csg_remesh_look(r, at);
    csg_corners_split(&r->corners, corner, vertex, triangles);
    csg_triangle_tree_update_around(&r->tree, vertex);
    f->pending[corner / 3] = f->pending[other] = 2; /* next round */
    f->pending[triangles[0]] = f->pending[triangles[1]] = 2;
    return true;
}

/* A new vertex goes all the way to the surface, or a share of it. */
static bool cut(refiner *f, const side *where, double share)
{
    csg_remesh *r = f->remesh;
    uint32_t corner = where->corner;
    csg_vec3 at = where->at;
    csg_vec3 from = at;
    bool is_crease = csg_remesh_is_crease(r, corner);
    if (!(is_crease && bring_to_crease(r, corner, &at)) &&
        !bring_to_surface(r, &at, normal_at(r, corner)))
        return false;
    at = csg_vec3_add(from, csg_vec3_scale(csg_vec3_sub(at, from), share));
    return split(f, corner, at);
}

/* Where a side is too far from the surface it helps to cut no others, nor short ones: a fan that
 * shares it would only get narrower. Of narrow triangles a vertex that goes half the way turns
 * less. */
static bool cut_one(refiner *f, const side sides[3])
{
    static const double TOO_FAR = 0.7, SHORT = 0.25; /* of the error */
    double error = f->remesh->error;
    int count = 0;
    while (count < 3 && (sides[0].away <= TOO_FAR * error || sides[count].away > FAR * error) &&
           (sides[count].away > FAR * error || sides[count].length > SHORT * error))
        count++;
    for (int i = 0; i < count; i++)
        if (cut(f, &sides[i], 1))
            return true;
    for (int i = 0; i < count && sides[0].away > TOO_FAR * error; i++)
        if (cut(f, &sides[i], 0.5))
            return true;
    return false;
}

/* ---- places that are far -----------------------------------------------------------------------
 */

/* Whether the place of a side that is nearest to p is no end of it. */
static bool is_in_side(const csg_remesh *r, uint32_t corner, csg_vec3 p)
{
    static const double ENDS = 0.05; /* of the side */
    csg_vec3 a = csg_remesh_corner(r, corner), b = csg_remesh_corner(r, csg_corner_next(corner));
    csg_vec3 along = csg_vec3_sub(b, a);
    double square = csg_vec3_dot(along, along);
    double share = square > 0 ? csg_vec3_dot(csg_vec3_sub(p, a), along) / square : 0;
    return share > ENDS && share < 1 - ENDS;
}

static const double LEAST_FACING = 0.3; /* cosine */

/* Whether there is only solid, or only what is outside, between a triangle and a place that is far:
 * else the place is of another part, and a vertex there would be a spike. */
static bool is_of_one_part(csg_remesh *r, uint32_t triangle, csg_vec3 p)
{
    enum { PLACES = 8 };
    const csg_vec3 v[3] = {csg_remesh_corner(r, 3 * triangle),
                           csg_remesh_corner(r, 3 * triangle + 1),
                           csg_remesh_corner(r, 3 * triangle + 2)};
    float at[PLACES][3], f[PLACES];
    double weights[3];
    bool inside = false, outside = false;
    csg_triangle_nearest(v, p, weights);
    csg_vec3 from = csg_vec3_scale(v[0], weights[0]);
    from = csg_vec3_add(from, csg_vec3_scale(v[1], weights[1]));
    from = csg_vec3_add(from, csg_vec3_scale(v[2], weights[2]));
    for (int i = 0; i < PLACES; i++)
        csg_vec3_to_floats(
            at[i], csg_vec3_add(from, csg_vec3_scale(csg_vec3_sub(p, from), (i + 0.5) / PLACES)));
    csg_probe_values(&r->probe, (const float(*)[3])at, PLACES, f);
    for (int i = 0; i < PLACES; i++) {
        inside |= f[i] > 4 * r->probe.noise;
        outside |= f[i] < -4 * r->probe.noise;
    }
    return !(inside && outside);
}

/* The least cosine between how triangles face and how the surface below their middles does. */
static double facing_of(csg_remesh *r, const csg_vec3 (*triangles)[3], int count)
{
    double least = 1;
    for (int i = 0; i < count; i++) {
        const csg_vec3 *v = triangles[i];
        csg_vec3 middle = csg_vec3_scale(csg_vec3_add(v[0], csg_vec3_add(v[1], v[2])), 1.0 / 3);
        csg_vec3 normal = csg_vec3_normalize(csg_triangle_cross(v[0], v[1], v[2]));
        least = fmin(least, csg_vec3_dot(normal, outward_at(r, middle)));
    }
    return least;
}

/* How well the triangles around a vertex at p in that side would face as the surface does. */
static double facing_with(csg_remesh *r, uint32_t corner, csg_vec3 p)
{
    csg_vec3 parts[4][3];
    parts_of_cut(r, corner, p, parts);
    return facing_of(r, (const csg_vec3(*)[3])parts, 4);
}

/* Brings a vertex to a place: one in a side of the triangle that is nearest to it. */
static bool reach(refiner *f, csg_vec3 p)
{
    csg_remesh *r = f->remesh;
    uint32_t triangle, sides[3];
    static const double LEAST = -0.3;
    double facing[3];
    int count = 0;
    double distance = csg_triangle_tree_nearest(&r->tree, p, 4 * r->error, &triangle);
    if (!(distance > r->error) || distance == INFINITY || !is_of_one_part(r, triangle, p))
        return false;
    for (uint32_t corner = 3 * triangle; corner < 3 * triangle + 3; corner++) {
        double one = facing_with(r, corner, p);
        if (one < LEAST || !is_in_side(r, corner, p))
            continue;
        int i = count++;
        for (; i && one > facing[i - 1]; i--) {
            sides[i] = sides[i - 1];
            facing[i] = facing[i - 1];
        }
        sides[i] = corner;
        facing[i] = one;
    }
    for (int i = 0; i < count; i++)
        if (split(f, sides[i], p))
            return true;
    return false;
}

/* ---- slivers -----------------------------------------------------------------------------------
 */

/* How far all places of a segment are from the surface, by the field. */
static double away_of(csg_remesh *r, csg_vec3 a, csg_vec3 b)
{
    float at[CUTS][3], f[CUTS];
    double most = 0;
    for (int i = 0; i < CUTS; i++) {
        double share = (i + 1.0) / (CUTS + 1);
        csg_vec3_to_floats(at[i], csg_vec3_add(a, csg_vec3_scale(csg_vec3_sub(b, a), share)));
    }
    csg_probe_values(&r->probe, (const float(*)[3])at, CUTS, f);
    for (int i = 0; i < CUTS; i++)
        most = fmax(most, fabs((double)f[i]));
    return most;
}

/* Slivers that stand on the surface are near it, but face any way, and cuts make more of them: a
 * side becomes the other diagonal where both triangles get better, or face the right way then. What
 * looks like a crease beside a sliver is none where the other diagonal is near the surface. */
static bool flip(refiner *f, uint32_t corner)
{
    static const double GAIN = 2, LOSS = 0.5, AWAY = 0.7 /* of the error */;
    csg_remesh *r = f->remesh;
    csg_corners *m = &r->corners;
    uint32_t apex = csg_corner_previous(corner), other = m->across[apex];
    csg_vec3 a = csg_remesh_corner(r, corner), b = csg_remesh_corner(r, csg_corner_next(corner));
    csg_vec3 c = csg_remesh_corner(r, apex), d = csg_remesh_corner(r, other);
    const csg_vec3 now[2][3] = {{c, a, b}, {d, b, a}}, then[2][3] = {{c, a, d}, {d, b, c}};
    double before = fmin(csg_triangle_quality(c, a, b), csg_triangle_quality(d, b, a));
    double after = fmin(csg_triangle_quality(c, a, d), csg_triangle_quality(d, b, c));
    bool is_crease = csg_remesh_is_crease(r, corner);
    double facing = facing_of(r, then, 2), faced = facing_of(r, now, 2);
    if (!(after > (faced < LEAST_FACING ? LOSS : GAIN) * before) ||
        facing < fmax(LEAST_FACING, faced) || (is_crease && faced >= LEAST_FACING) ||
        !csg_corners_can_flip(m, corner) ||
        away_of(r, c, d) > (is_crease ? FAR * r->error : fmax(AWAY * r->error, away_of(r, a, b))))
        return false;
    const uint32_t *v = m->vertex, ids[2][3] = {{v[apex], v[corner], v[other]},
                                                {v[other], v[csg_corner_next(corner)], v[apex]}};
    const csg_crossing_change change = {.at = then,
                                        .vertex = ids,
                                        .count = 2,
                                        .vertices = {CSG_CORNER_NONE, CSG_CORNER_NONE},
                                        .triangles = {corner / 3, other / 3}};
    if (csg_crossing_is_made(&r->tree, &change, NULL))
        return false;
    csg_corners_flip(m, corner);
    csg_triangle_tree_update(&r->tree, corner / 3);
    csg_triangle_tree_update(&r->tree, other / 3);
    f->pending[corner / 3] = f->pending[other / 3] = 2; /* next round */
    return true;
}

static bool flip_one(refiner *f, const side sides[3])
{
    for (int i = 0; i < 3; i++)
        if (flip(f, sides[i].corner))
            return true;
    return false;
}

/* Cuts the open triangles, each at most once a round. */
static bool refine_open(refiner *f)
{
    csg_remesh *r = f->remesh;
    bool changed = false;
    for (uint32_t t = 0; t < r->corners.triangle_count; t++) {
        if (f->pending[t] != 1 || !csg_corners_is_live(&r->corners, t))
            continue;
        side sides[3];
        sides_to_cut(r, t, sides);
        changed |= flip_one(f, sides) || cut_one(f, sides);
    }
    return changed;
}

/* Cuts what is open and holds it against the surface again, for as long as that helps. */
static csgm_status refine_in_rounds(refiner *f, double error, csg_distance_proof *out)
{
    enum { MOST_ROUNDS = 16, MOST_IDLE = 2, FEW = 32, MOST_IDLE_OF_FEW = 5 };
    static const uint64_t MOST_EFFORT = 8000000; /* of all rounds; then the last one's word holds */
    csg_remesh *r = f->remesh;
    out->effort = 0;
    csgm_status status = csg_check_distance(r, &f->begun, error, false, f->pending, out);
    uint64_t least = UINT64_MAX / 10;
    int idle = 0; /* rounds that settled hardly any */
    for (int round = 0; round < MOST_ROUNDS && status == CSGM_OK && out->open && !out->stopped &&
                        out->effort < MOST_EFFORT;
         round++) {
        idle += out->open * 10 >= least * 9;
        if (idle > (out->open > FEW ? MOST_IDLE : MOST_IDLE_OF_FEW))
            break;
        least = out->open < least ? out->open : least;
        if (!refine_open(f))
            break;
        status = csg_check_distance(r, &f->begun, error, false, f->pending, out);
    }
    if (status == CSGM_OK && out->open && !out->stopped && out->effort < MOST_EFFORT)
        status = csg_check_distance(r, &f->begun, error, true, f->pending, out);
    return status;
}

csgm_status csg_refine_until_near(csg_remesh *r, double error, const csg_far_places *far,
                                  csg_distance_proof *out)
{
    size_t count = r->corners.triangle_count;
    refiner f = {.remesh = r, .pending = csg_memory_alloc(r->memory, count)};
    if (!f.pending)
        return csg_context_no_memory(r->context);
    csgm_status status = csg_begun_make(r, &f.begun);
    if (status == CSGM_OK) {
        for (size_t i = 0; i < far->count; i++)
            reach(&f, far->at[i]);
        memset(f.pending, 1, count);
        status = refine_in_rounds(&f, error, out);
    }
    csg_begun_release(&f.begun);
    csg_memory_release(r->memory, f.pending, count);
    return status;
}
