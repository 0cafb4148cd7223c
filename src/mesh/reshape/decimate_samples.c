/* SPDX-License-Identifier: MIT
 * Points of the true surface that watch over a decimation: where each lies, and who answers for it.
 * So the distance from the surface to the mesh is known at all of them at any time.
 */
#include <math.h>
#include <string.h>

#include "mesh/reshape/decimate.h"

enum { BATCH = CSG_PROBE_MOST };

/* Colours and materials may be off by this much where a sample meets the mesh. */
enum { COLOR_STEP = 12, MATERIAL_STEP = 500 };

/* ---- making ------------------------------------------------------------------------------------
 */

static void add_sample(csg_decimation *d, const float at[3], uint32_t triangle)
{
    uint32_t s = d->sample_count++;
    memcpy(d->samples[s].at, at, sizeof d->samples[s].at);
    d->samples[s].next = d->first_sample[triangle];
    d->first_sample[triangle] = s;
}

/* Two Newton steps; what is not on the surface then, or has left the triangle's neighbourhood, is
 * no sample. */
static void project(csg_decimation *d, float (*at)[3], const uint32_t *triangles, size_t count)
{
    enum { STEPS = 2 };
    csg_remesh *r = d->remesh;
    float f[BATCH], g[BATCH][3], start[BATCH][3];
    memcpy(start, at, count * sizeof *at);
    for (int step = 0; step <= STEPS; step++) {
        csg_probe_values(&r->probe, (const float(*)[3])at, count, f);
        if (step == STEPS)
            break;
        csg_probe_gradients(&r->probe, (const float(*)[3])at, count, g);
        for (size_t i = 0; i < count; i++) {
            float square = g[i][0] * g[i][0] + g[i][1] * g[i][1] + g[i][2] * g[i][2];
            for (int axis = 0; axis < 3 && square > 1e-6f; axis++)
                at[i][axis] -= f[i] * g[i][axis] / square;
        }
    }
    double reach = fmax(0.5 * r->cell, 2 * r->error); /* cells may be of any size there */
    float close = 4 * r->probe.noise + (float)(1e-3 * r->error);
    for (size_t i = 0; i < count; i++) {
        double x = (double)(at[i][0] - start[i][0]), y = (double)(at[i][1] - start[i][1]),
               z = (double)(at[i][2] - start[i][2]);
        if (fabsf(f[i]) <= close && x * x + y * y + z * z <= reach * reach)
            add_sample(d, at[i], triangles[i]);
    }
}

/* Whether the surface may bulge out of the triangle between its corners by so much of the error
 * that these do not speak for it. An edge along which normals turn bulges by an eighth of what its
 * ends' tangents differ by. At creases the mean normal tells nothing: there it is size that does.
 */
static bool may_bulge(const csg_decimation *d, uint32_t triangle, const csg_vec3 *normals)
{
    static const double SHARE = 0.125, LARGE = 4; /* of the error */
    const csg_remesh *r = d->remesh;
    const uint32_t *v = r->corners.vertex + 3 * (size_t)triangle;
    double most = 0;
    bool at_crease = false;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t a = v[k], b = v[k == 2 ? 0 : k + 1];
        csg_vec3 edge = csg_vec3_sub(r->at[b], r->at[a]);
        most = fmax(most, fabs(csg_vec3_dot(edge, csg_vec3_sub(normals[b], normals[a]))) / 8);
        at_crease |= r->kind[a] != CSG_VERTEX_SMOOTH;
    }
    if (!at_crease)
        return most > SHARE * r->error;
    const csg_vec3 at[3] = {r->at[v[0]], r->at[v[1]], r->at[v[2]]};
    return csg_triangle_longest_side(at) > LARGE * r->error;
}

static void sample_triangles(csg_decimation *d, const csg_vec3 *normals)
{
    csg_remesh *r = d->remesh;
    float at[BATCH][3];
    uint32_t triangles[BATCH];
    size_t n = 0;
    for (uint32_t t = 0; t < r->corners.triangle_count; t++) {
        if (csg_corners_is_live(&r->corners, t) && may_bulge(d, t, normals)) {
            csg_vec3 sum = csg_vec3_add(
                csg_remesh_corner(r, 3 * t),
                csg_vec3_add(csg_remesh_corner(r, 3 * t + 1), csg_remesh_corner(r, 3 * t + 2)));
            at[n][0] = (float)(sum.x / 3);
            at[n][1] = (float)(sum.y / 3);
            at[n][2] = (float)(sum.z / 3);
            triangles[n++] = t;
        }
        if (n == BATCH || (n && t + 1 == r->corners.triangle_count)) {
            project(d, at, triangles, n);
            n = 0;
        }
    }
}

void csg_decimation_make_samples(csg_decimation *d, const csg_vec3 *normals)
{
    const csg_remesh *r = d->remesh;
    memset(d->first_sample, 0xFF, r->corners.triangle_count * sizeof *d->first_sample);
    for (uint32_t v = 0; v < r->corners.vertex_count; v++) {
        csg_vec3 p = r->at[v];
        const float at[3] = {(float)p.x, (float)p.y, (float)p.z};
        add_sample(d, at, r->corners.corner[v] / 3);
    }
    d->vertex_samples = d->sample_count;
    sample_triangles(d, normals);
    for (size_t i = 0; d->missed && i < d->missed->count; i++)
        add_sample(d, d->missed->points[i].at, d->missed->points[i].triangle);
}

/* ---- handing over ------------------------------------------------------------------------------
 */

static csg_look_at_vertex look_of(const csg_decimation *d, uint32_t vertex, uint32_t kept)
{
    return vertex == kept ? d->room->look : d->remesh->looks[vertex];
}

/* Whether a vertex's sample has the look that the triangle gives it at this place. */
static bool looks_alike(const csg_decimation *d, uint32_t sample, uint32_t triangle,
                        const double weights[3], uint32_t kept)
{
    if (!d->originals || sample >= d->vertex_samples)
        return true;
    if (d->room->one_look && !memcmp(&d->originals[sample], &d->room->look, sizeof d->room->look))
        return true;
    double color[4] = {0}, material[2] = {0};
    for (int k = 0; k < 3; k++) {
        csg_look_at_vertex look = look_of(d, d->room->vertex[triangle][k], kept);
        for (int c = 0; c < 4; c++)
            color[c] += weights[k] * look.color[c];
        for (int c = 0; c < 2; c++)
            material[c] += weights[k] * look.material[c];
    }
    const csg_look_at_vertex *own = &d->originals[sample];
    for (int c = 0; c < 4; c++)
        if (fabs(color[c] - own->color[c]) > COLOR_STEP)
            return false;
    return fabs(material[0] - own->material[0]) <= MATERIAL_STEP &&
           fabs(material[1] - own->material[1]) <= MATERIAL_STEP;
}

/* Whether the sample is right above or below the triangle: weights and height are found then. */
static bool is_over(const csg_facet *t, csg_vec3 p, double weights[3], double *square)
{
    csg_vec3 off = csg_vec3_sub(p, t->at);
    double a = csg_vec3_dot(off, t->toward[0]), b = csg_vec3_dot(off, t->toward[1]);
    if (!(a >= 0 && b >= 0 && a + b <= 1))
        return false;
    double height = csg_vec3_dot(off, t->normal);
    weights[0] = 1 - a - b;
    weights[1] = a;
    weights[2] = b;
    *square = height * height;
    return true;
}

/* The triangle that answers for a sample from now on: the nearest of those that it is over, or the
 * first that is near enough; if there is none, the nearest of all. NONE: it would be too far away.
 */
static uint32_t choose_owner(csg_decimation *d, uint32_t sample, uint32_t hint, uint32_t kept)
{
    static const double NEAR = 1.0 / 16; /* of the error, squared */
    csg_collapse_room *room = d->room;
    double most = d->remesh->error * d->remesh->error, least = INFINITY, best[3] = {0, 0, 0};
    csg_vec3 p = csg_sample_at(d, sample);
    double weights[3], square;
    uint32_t owner = CSG_CORNER_NONE;
    for (uint32_t i = 0; i < room->count && least > NEAR * most; i++) {
        uint32_t k = hint + i < room->count ? hint + i : hint + i - room->count;
        if (!is_over(&room->facet[k], p, weights, &square) || !(square < least))
            continue;
        least = square;
        owner = k;
        memcpy(best, weights, sizeof best);
    }
    if (least <= most && looks_alike(d, sample, owner, best, kept)) {
        room->farthest = least > room->farthest ? least : room->farthest;
        return owner;
    }
    least = INFINITY;
    for (uint32_t k = 0; k < room->count; k++) {
        square = csg_triangle_nearest(room->after[k], p, weights);
        if (square < least) {
            least = square;
            owner = k;
            memcpy(best, weights, sizeof best);
        }
    }
    room->farthest = least > room->farthest ? least : room->farthest;
    return least <= most && looks_alike(d, sample, owner, best, kept) ? owner : CSG_CORNER_NONE;
}

static csg_facet facet_of(const csg_vec3 v[3], csg_vec3 n)
{
    csg_vec3 s = csg_vec3_sub(v[1], v[0]), t = csg_vec3_sub(v[2], v[0]);
    double square = csg_vec3_dot(n, n);
    csg_facet f = {.at = v[0]};
    if (!(square > 0)) /* nothing is over it */
        return (csg_facet){.at = v[0], .toward = {{NAN, NAN, NAN}, {NAN, NAN, NAN}}};
    f.toward[0] = csg_vec3_scale(csg_vec3_cross(t, n), 1 / square);
    f.toward[1] = csg_vec3_scale(csg_vec3_cross(n, s), 1 / square);
    f.normal = csg_vec3_scale(n, 1 / sqrt(square));
    return f;
}

static bool has_one_look(const csg_decimation *d, uint32_t kept)
{
    const csg_collapse_room *room = d->room;
    const csg_look_at_vertex *looks = d->remesh->looks;
    for (uint32_t i = 0; looks && i < room->count; i++)
        for (int k = 1; k < 3; k++)
            if (room->vertex[i][k] != kept &&
                memcmp(&looks[room->vertex[i][k]], &room->look, sizeof room->look))
                return false;
    return looks != NULL;
}

/* Finds who answers for a triangle's samples. One that nobody can answer for comes first in its
 * list from then on: the next try is likely to fail at it, too. */
static bool find_owners(csg_decimation *d, uint32_t triangle, uint32_t hint, uint32_t kept)
{
    csg_collapse_room *room = d->room;
    uint32_t before = CSG_CORNER_NONE, s = d->first_sample[triangle];
    for (; s != CSG_CORNER_NONE; before = s, s = d->samples[s].next) {
        uint32_t owner = choose_owner(d, s, hint, kept);
        if (owner == CSG_CORNER_NONE)
            break;
        if (!csg_memory_reserve(d->remesh->memory, (void **)&room->owner, &room->owner_capacity,
                                room->owner_count + 1, sizeof *room->owner))
            return false;
        hint = owner;
        room->owner[room->owner_count++] = owner;
    }
    if (s != CSG_CORNER_NONE && before != CSG_CORNER_NONE) {
        d->samples[before].next = d->samples[s].next;
        d->samples[s].next = d->first_sample[triangle];
        d->first_sample[triangle] = s;
    }
    return s == CSG_CORNER_NONE;
}

bool csg_decimation_can_hand_over(csg_decimation *d, uint32_t kept)
{
    csg_collapse_room *room = d->room;
    room->owner_count = 0;
    room->farthest = 0;
    room->one_look = has_one_look(d, kept);
    for (uint32_t i = 0; i < room->count; i++)
        room->facet[i] = facet_of((const csg_vec3 *)room->after[i], room->normal[i]);
    for (uint32_t i = 0; i < room->count + 2; i++)
        if (!find_owners(d, room->triangle[i], i < room->count ? i : 0, kept))
            return false;
    return true;
}

void csg_decimation_hand_over(csg_decimation *d)
{
    csg_collapse_room *room = d->room;
    uint32_t chain = CSG_CORNER_NONE, *end = &chain;
    for (uint32_t i = 0; i < room->count + 2; i++) {
        *end = d->first_sample[room->triangle[i]];
        d->first_sample[room->triangle[i]] = CSG_CORNER_NONE;
        while (*end != CSG_CORNER_NONE)
            end = &d->samples[*end].next;
    }
    for (size_t i = 0; chain != CSG_CORNER_NONE; i++) {
        uint32_t s = chain, triangle = room->triangle[room->owner[i]];
        chain = d->samples[s].next;
        d->samples[s].next = d->first_sample[triangle];
        d->first_sample[triangle] = s;
    }
}

double csg_decimation_largest_distance(const csg_decimation *d)
{
    const csg_remesh *r = d->remesh;
    double most = 0, weights[3];
    for (uint32_t t = 0; t < r->corners.triangle_count; t++) {
        if (!csg_corners_is_live(&r->corners, t))
            continue;
        const csg_vec3 v[3] = {csg_remesh_corner(r, 3 * t), csg_remesh_corner(r, 3 * t + 1),
                               csg_remesh_corner(r, 3 * t + 2)};
        for (uint32_t s = d->first_sample[t]; s != CSG_CORNER_NONE; s = d->samples[s].next) {
            csg_vec3 p = csg_sample_at(d, s);
            double own = sqrt(csg_triangle_nearest(v, p, weights));
            if (own > most) /* another one may be nearer than the one that answers for it */
                most = fmax(most, fmin(own, csg_triangle_tree_nearest(&r->tree, p, own, NULL)));
        }
    }
    return most;
}
