/* SPDX-License-Identifier: MIT
 * Points of the true surface that watch over a decimation: where each lies, and who answers for it.
 * So the distance from the surface to the mesh is known at all of them at any time.
 */
#include <math.h>
#include <string.h>

#include "base/four.h"
#include "mesh/remesh/probe_loop.h"
#include "mesh/reshape/decimate.h"

enum { BATCH = CSG_PROBE_MOST };

/* Colours and materials may be off by this much where a sample meets the mesh. */
enum { COLOR_STEP = 12, MATERIAL_STEP = 500 };

/* ---- making ------------------------------------------------------------------------------------
 */

static void add_sample(csg_decimation *d, const float at[3], csg_vec3 normal, uint32_t triangle)
{
    uint32_t s = d->sample_count++;
    const double parts[3] = {normal.x, normal.y, normal.z};
    memcpy(d->samples[s].at, at, sizeof d->samples[s].at);
    for (int axis = 0; axis < 3; axis++)
        d->samples[s].normal[axis] = (int16_t)lrint(INT16_MAX * parts[axis]);
    csg_sample_put(d, s, triangle);
}

/* Zero where it leads over a crease. */
static csg_vec3 normal_of(const csg_decimation *d, uint32_t triangle)
{
    const csg_remesh *r = d->remesh;
    const uint32_t *v = r->corners.vertex + 3 * (size_t)triangle;
    for (int k = 0; k < 3; k++)
        if (r->kind[v[k]] != CSG_VERTEX_SMOOTH)
            return csg_vec3_make(0, 0, 0);
    return csg_vec3_normalize(csg_triangle_cross(r->at[v[0]], r->at[v[1]], r->at[v[2]]));
}

/* One of Newton's steps for each that is not near the surface yet. */
static void take_step(csg_probe *probe, float (*at)[3], float *f, float close, size_t count)
{
    float places[BATCH][3], g[BATCH][3], values[BATCH];
    uint32_t of[BATCH], n = 0;
    for (uint32_t i = 0; i < count; i++)
        if (!(fabsf(f[i]) <= close)) {
            memcpy(places[n], at[i], sizeof places[n]);
            of[n++] = i;
        }
    csg_probe_gradients(probe, (const float(*)[3])places, n, g);
    for (uint32_t i = 0; i < n; i++) {
        float square = g[i][0] * g[i][0] + g[i][1] * g[i][1] + g[i][2] * g[i][2];
        for (int axis = 0; axis < 3 && square > 1e-6f; axis++)
            places[i][axis] -= f[of[i]] * g[i][axis] / square;
    }
    csg_probe_values(probe, (const float(*)[3])places, n, values);
    for (uint32_t i = 0; i < n; i++) {
        memcpy(at[of[i]], places[i], sizeof places[i]);
        f[of[i]] = values[i];
    }
}

/* Two of Newton's steps, one where that is enough; what is not on the surface then, or has left the
 * triangle's neighbourhood, is nowhere. */
static void project(const csg_remesh *r, csg_probe *probe, float (*at)[3], size_t count)
{
    enum { STEPS = 2 };
    float f[BATCH], start[BATCH][3];
    float close = 4 * probe->noise + (float)(1e-3 * r->error);
    memcpy(start, at, count * sizeof *at);
    csg_probe_values(probe, (const float(*)[3])at, count, f);
    for (int step = 0; step < STEPS; step++)
        take_step(probe, at, f, close, count);
    double reach = fmax(0.5 * r->cell, 2 * r->error); /* cells may be of any size there */
    for (size_t i = 0; i < count; i++) {
        double x = (double)(at[i][0] - start[i][0]), y = (double)(at[i][1] - start[i][1]),
               z = (double)(at[i][2] - start[i][2]);
        if (!(fabsf(f[i]) <= close && x * x + y * y + z * z <= reach * reach))
            at[i][0] = NAN;
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

/* Places above triangles that the surface may bulge out of; of others nowhere. */
typedef struct bulges {
    const csg_decimation *decimation;
    const csg_vec3 *normals;
    float (*at)[3]; /* per triangle; NAN: nowhere */
} bulges;

static void find_some_bulges(void *user, csg_probe *probe, size_t first, size_t end)
{
    const bulges *b = user;
    const csg_remesh *r = b->decimation->remesh;
    float at[BATCH][3];
    uint32_t of[BATCH], n = 0;
    for (uint32_t t = (uint32_t)first; t < end; t++) {
        b->at[t][0] = NAN;
        if (!csg_corners_is_live(&r->corners, t) || !may_bulge(b->decimation, t, b->normals))
            continue;
        csg_vec3_to_floats(at[n], csg_remesh_centroid(r, t));
        of[n++] = t;
    }
    if (n)
        project(r, probe, at, n);
    for (uint32_t i = 0; i < n; i++)
        memcpy(b->at[of[i]], at[i], sizeof at[i]);
}

/* False: stopped, or without memory; the watch knows. */
static bool sample_triangles(csg_decimation *d, const csg_vec3 *normals)
{
    csg_remesh *r = d->remesh;
    const uint32_t count = r->corners.triangle_count;
    bulges b = {d, normals, csg_memory_alloc(r->memory, count * sizeof *b.at)};
    if (!b.at)
        return csg_mesh_stop_without_memory(r->watch);
    bool done = csg_probe_loop(r->watch, r->marching, count, BATCH, find_some_bulges, &b);
    for (uint32_t t = 0; t < count && done; t++)
        if (b.at[t][0] == b.at[t][0])
            add_sample(d, b.at[t], normal_of(d, t), t);
    csg_memory_release(r->memory, b.at, count * sizeof *b.at);
    return done;
}

static void add_missed(csg_decimation *d)
{
    for (size_t i = 0; d->missed && i < d->missed->count; i++)
        add_sample(d, d->missed->points[i].at, csg_vec3_make(0, 0, 0),
                   d->missed->points[i].triangle);
}

bool csg_decimation_make_samples(csg_decimation *d, const csg_vec3 *normals)
{
    const csg_remesh *r = d->remesh;
    memset(d->first_sample, 0xFF, r->corners.triangle_count * sizeof *d->first_sample);
    for (uint32_t v = 0; v < r->corners.vertex_count; v++) {
        csg_vec3 p = r->at[v];
        const float at[3] = {(float)p.x, (float)p.y, (float)p.z};
        bool at_crease = r->kind[v] != CSG_VERTEX_SMOOTH;
        add_sample(d, at, at_crease ? csg_vec3_make(0, 0, 0) : normals[v],
                   r->corners.corner[v] / 3);
    }
    d->vertex_samples = d->sample_count;
    if (!sample_triangles(d, normals))
        return false;
    add_missed(d);
    return true;
}

bool csg_begun_samples_add_other(csg_begun_samples *s, csg_memory *memory,
                                 const csg_surface_sample *sample)
{
    size_t place = s->other_count % CSG_SAMPLES_OF_BLOCK;
    if (!place) {
        csg_sample_block *block = csg_memory_alloc(memory, sizeof *block);
        if (!block)
            return false;
        block->next = NULL;
        *(s->last ? &s->last->next : &s->others) = block;
        s->last = block;
        s->block_count++;
    }
    s->last->items[place] = *sample;
    s->other_count++;
    return true;
}

/* How many of the others the first block has. */
static size_t count_of_first(const csg_begun_samples *s)
{
    return s->other_count < CSG_SAMPLES_OF_BLOCK ? s->other_count : CSG_SAMPLES_OF_BLOCK;
}

static void drop_first(csg_begun_samples *s, csg_memory *memory)
{
    csg_sample_block *block = s->others;
    s->other_count -= count_of_first(s);
    s->others = block->next;
    s->last = s->others ? s->last : NULL;
    s->block_count--;
    csg_memory_release(memory, block, sizeof *block);
}

void csg_begun_samples_release(csg_begun_samples *s, csg_memory *memory)
{
    csg_memory_release(memory, s->of_vertices, s->vertex_capacity * sizeof *s->of_vertices);
    while (s->others)
        drop_first(s, memory);
    s->of_vertices = NULL;
    s->vertex_count = s->vertex_capacity = 0;
}

bool csg_decimation_hold_samples(csg_decimation *d, size_t needed)
{
    csg_begun_samples *begun = d->begun;
    if (begun && !d->samples) {
        d->samples = begun->of_vertices;
        d->sample_capacity = begun->vertex_capacity;
        begun->of_vertices = NULL;
        begun->vertex_capacity = 0;
    }
    return csg_memory_reserve(d->remesh->memory, (void **)&d->samples, &d->sample_capacity, needed,
                              sizeof *d->samples);
}

/* Room for so many more of the samples that there are to be. Arrays grow by an eighth at least;
 * what would be too much at last would never be given back, so the last step is one that it fits.
 */
static bool hold_more(csg_decimation *d, size_t more, size_t all)
{
    size_t needed = d->sample_count + more, next = d->sample_capacity + d->sample_capacity / 8 + 1;
    if (needed <= d->sample_capacity)
        return true;
    if (next + next / 8 + 1 > all)
        needed = all;
    return csg_decimation_hold_samples(d, needed);
}

/* The samples may be the next ones of d->samples themselves. */
static void take(csg_decimation *d, const csg_surface_sample *samples, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t s = d->sample_count++;
        d->samples[s] = samples[i];
        csg_sample_put(d, s, csg_surface_sample_next(&samples[i]));
    }
}

bool csg_decimation_take_samples(csg_decimation *d)
{
    csg_begun_samples *begun = d->begun;
    memset(d->first_sample, 0xFF, d->remesh->corners.triangle_count * sizeof *d->first_sample);
    size_t missed = d->missed ? d->missed->count : 0;
    size_t all = begun->vertex_count + begun->other_count + missed;
    take(d, d->samples, begun->vertex_count);
    d->vertex_samples = d->sample_count;
    while (begun->others) {
        size_t count = count_of_first(begun);
        if (!hold_more(d, count, all))
            return false;
        take(d, begun->others->items, count);
        drop_first(begun, d->remesh->memory);
    }
    csg_begun_samples_release(begun, d->remesh->memory);
    if (!hold_more(d, missed, all))
        return false;
    add_missed(d);
    return true;
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
    if (!d->originals || d->room->is_first_look || sample >= d->vertex_samples)
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

/* Of every triangle of the fan: the squared height of a place over its plane, and that where the
 * place is right above or below the triangle and does not face the other way, else INFINITY. The
 * triangles meet in one place, from which `off` leads; what is a corner is over both triangles
 * there, however it was rounded. */
static void find_heights(csg_facets *f, const float off[3], const float normal[3], uint32_t count)
{
    static const float SLACK = 1e-5f;
    const csg_four infinite = csg_four_all(INFINITY), slack = csg_four_all(-SLACK);
    for (uint32_t k = 0; k < count; k += CSG_FACET_LANES) {
        csg_four a = csg_four_all(0), b = a, height = a, facing = a;
        for (int axis = 0; axis < 3; axis++) {
            csg_four along = csg_four_load(f->normal[axis] + k);
            a += off[axis] * csg_four_load(f->second[axis] + k);
            b += off[axis] * csg_four_load(f->third[axis] + k);
            height += off[axis] * along;
            facing += normal[axis] * along;
        }
        csg_four least = csg_four_smaller(csg_four_smaller(a, b), 1 - a - b);
        csg_four square = height * height;
        csg_four_mask is_over = (least >= slack) & (facing >= csg_four_all(0));
        csg_four_store(square, f->square + k);
        csg_four_store(csg_four_choose(is_over, square, infinite), f->over + k);
        csg_four_store(a, f->weight[0] + k);
        csg_four_store(b, f->weight[1] + k);
    }
}

/* The first of the least. */
static uint32_t find_lowest(const csg_facets *f, uint32_t count)
{
    float least = f->over[0];
    for (uint32_t k = 1; k < count; k++)
        least = f->over[k] < least ? f->over[k] : least;
    uint32_t found = 0;
    while (found + 1 < count && f->over[found] > least)
        found++;
    return found;
}

/* The triangle that is nearest to a sample, which is over none of them, or not near enough. */
static uint32_t choose_nearest(csg_decimation *d, csg_vec3 p, double best[3], double *least)
{
    csg_collapse_room *room = d->room;
    float most = (float)room->most;
    uint32_t owner = CSG_CORNER_NONE;
    *least = INFINITY;
    for (uint32_t k = 0; k < room->count; k++) {
        if (room->facets.square[k] > most) /* its plane is too far away, so it is */
            continue;
        double weights[3], square = csg_triangle_nearest(room->after[k], p, weights);
        if (square < *least) {
            *least = square;
            owner = k;
            memcpy(best, weights, sizeof weights);
        }
    }
    return owner;
}

/* The triangle that answers for a sample from now on: the nearest of those that it is over; if
 * there is none, the nearest of all. NONE: it would be too far away. */
static uint32_t choose_owner(csg_decimation *d, uint32_t sample, uint32_t kept)
{
    csg_collapse_room *room = d->room;
    csg_facets *f = &room->facets;
    double most = room->most;
    csg_vec3 p = csg_sample_at(d, sample), normal = csg_sample_normal(d, sample);
    float off[3], facing[3];
    csg_vec3_to_floats(off, csg_vec3_sub(p, room->after[0][0]));
    csg_vec3_to_floats(facing, normal);
    find_heights(f, off, facing, room->count);
    uint32_t owner = find_lowest(f, room->count);
    double least = (double)f->over[owner];
    double weights[3] = {1 - (double)f->weight[0][owner] - (double)f->weight[1][owner],
                         (double)f->weight[0][owner], (double)f->weight[1][owner]};
    if (least <= most && looks_alike(d, sample, owner, weights, kept)) {
        room->farthest = least > room->farthest ? least : room->farthest;
        return owner;
    }
    owner = choose_nearest(d, p, weights, &least);
    room->farthest = least > room->farthest ? least : room->farthest;
    return least <= most && looks_alike(d, sample, owner, weights, kept) ? owner : CSG_CORNER_NONE;
}

static csg_vec3 part_of(const float parts[3][CSG_RING_MOST], uint32_t k)
{
    return csg_vec3_make((double)parts[0][k], (double)parts[1][k], (double)parts[2][k]);
}

static void make_facet(csg_facets *f, uint32_t k, const csg_vec3 v[3], csg_vec3 n)
{
    csg_vec3 s = csg_vec3_sub(v[1], v[0]), t = csg_vec3_sub(v[2], v[0]);
    double square = csg_vec3_dot(n, n); /* > 0: has_shape */
    csg_vec3 second = csg_vec3_scale(csg_vec3_cross(t, n), 1 / square);
    csg_vec3 third = csg_vec3_scale(csg_vec3_cross(n, s), 1 / square);
    csg_vec3 normal = csg_vec3_scale(n, 1 / sqrt(square));
    f->second[0][k] = (float)second.x, f->second[1][k] = (float)second.y;
    f->second[2][k] = (float)second.z;
    f->third[0][k] = (float)third.x, f->third[1][k] = (float)third.y;
    f->third[2][k] = (float)third.z;
    f->normal[0][k] = (float)normal.x, f->normal[1][k] = (float)normal.y;
    f->normal[2][k] = (float)normal.z;
}

static bool has_one_look(const csg_decimation *d, uint32_t kept)
{
    const csg_collapse_room *room = d->room;
    const csg_look_at_vertex *looks = d->remesh->looks;
    for (uint32_t i = 0; looks && i < room->count; i++)
        for (int k = 1; k < 3; k++)
            if (room->vertex[i][k] != kept &&
                memcmp(&looks[room->vertex[i][k]], &room->look, sizeof room->look) != 0)
                return false;
    return looks != NULL;
}

/* Finds who answers for a triangle's samples. One that nobody can answer for comes first in its
 * list from then on: the next try is likely to fail at it, too. */
static bool find_owners(csg_decimation *d, uint32_t triangle, uint32_t kept)
{
    csg_collapse_room *room = d->room;
    uint32_t before = CSG_CORNER_NONE, s = d->first_sample[triangle];
    for (; s != CSG_CORNER_NONE; before = s, s = csg_sample_next(d, s)) {
        uint32_t owner = choose_owner(d, s, kept);
        if (owner == CSG_CORNER_NONE)
            break;
        if (room->owner_count == room->owner_capacity &&
            !csg_memory_reserve(d->remesh->memory, (void **)&room->owner, &room->owner_capacity,
                                room->owner_count + 1, sizeof *room->owner))
            return false;
        room->owner[room->owner_count++] = owner;
    }
    if (s != CSG_CORNER_NONE && before != CSG_CORNER_NONE) {
        csg_surface_sample_set_next(&d->samples[before], csg_sample_next(d, s));
        csg_sample_put(d, s, triangle);
    }
    return s == CSG_CORNER_NONE;
}

/* Lanes behind the last facet repeat it. */
static void make_facets(csg_decimation *d, double reach)
{
    csg_collapse_room *room = d->room;
    room->most = reach * reach;
    room->farthest = 0;
    for (uint32_t i = 0; i < room->count; i++)
        make_facet(&room->facets, i, (const csg_vec3 *)room->after[i], room->normal[i]);
    for (uint32_t i = room->count; i % CSG_FACET_LANES; i++)
        make_facet(&room->facets, i, (const csg_vec3 *)room->after[room->count - 1],
                   room->normal[room->count - 1]);
}

bool csg_decimation_may_hand_over(csg_decimation *d, uint32_t kept, double reach)
{
    csg_collapse_room *room = d->room;
    make_facets(d, reach);
    room->is_first_look = true;
    for (uint32_t i = 0; i < room->count + room->gone; i++) {
        uint32_t s = d->first_sample[room->triangle[i]];
        if (s != CSG_CORNER_NONE && choose_owner(d, s, kept) == CSG_CORNER_NONE)
            return false;
    }
    return true;
}

bool csg_decimation_can_hand_over(csg_decimation *d, uint32_t kept, double reach)
{
    csg_collapse_room *room = d->room;
    make_facets(d, reach);
    room->is_first_look = false;
    room->owner_count = 0;
    room->one_look = has_one_look(d, kept);
    for (uint32_t i = 0; i < room->count + room->gone; i++)
        if (!find_owners(d, room->triangle[i], kept))
            return false;
    return true;
}

/* The points of csg_remesh_brackets that are a third of the triangle or less from a sample over it
 * which faces its way. */
static void see(csg_decimation *d, uint32_t sample, uint32_t k)
{
    static const double LEAST_COS = 0.7, NEAR = 0.3, LOW = 0.75 /* of the error */;
    csg_collapse_room *room = d->room;
    const csg_facets *f = &room->facets;
    csg_vec3 off = csg_vec3_sub(csg_sample_at(d, sample), room->after[k][0]);
    csg_vec3 normal = csg_sample_normal(d, sample);
    double a = csg_vec3_dot(off, part_of(f->second, k)),
           b = csg_vec3_dot(off, part_of(f->third, k));
    int split = csg_bracket_split(d->remesh, room->longest[k]);
    if (!(csg_vec3_dot(normal, part_of(f->normal, k)) >= LEAST_COS * INT16_MAX) ||
        !(fabs(csg_vec3_dot(off, part_of(f->normal, k))) <= LOW * d->remesh->error) ||
        !(a >= 0 && b >= 0 && a + b <= 1))
        return;
    if (split == 1)
        room->seen[k] = csg_bracket_bit(0, 0);
    for (int i = 0; i < split; i++)
        for (int j = 0; i + j < split; j++) {
            double by_a = a - (i + 1.0 / 3) / split, by_b = b - (j + 1.0 / 3) / split;
            if (fabs(by_a) <= NEAR && fabs(by_b) <= NEAR && fabs(by_a + by_b) <= NEAR)
                room->seen[k] |= csg_bracket_bit(i, j);
        }
}

void csg_decimation_find_seen(csg_decimation *d)
{
    csg_collapse_room *room = d->room;
    size_t n = 0;
    memset(room->seen, 0, room->count * sizeof *room->seen);
    for (uint32_t i = 0; i < room->count + room->gone; i++)
        for (uint32_t s = d->first_sample[room->triangle[i]]; s != CSG_CORNER_NONE;
             s = csg_sample_next(d, s))
            see(d, s, room->owner[n++]);
}

void csg_decimation_hand_over(csg_decimation *d)
{
    csg_collapse_room *room = d->room;
    uint32_t chain = CSG_CORNER_NONE, last = CSG_CORNER_NONE;
    for (uint32_t i = 0; i < room->count + room->gone; i++) {
        uint32_t s = d->first_sample[room->triangle[i]];
        d->first_sample[room->triangle[i]] = CSG_CORNER_NONE;
        if (last == CSG_CORNER_NONE)
            chain = s;
        else
            csg_surface_sample_set_next(&d->samples[last], s);
        for (; s != CSG_CORNER_NONE; s = csg_sample_next(d, s))
            last = s;
    }
    for (size_t i = 0; chain != CSG_CORNER_NONE; i++) {
        uint32_t s = chain;
        chain = csg_sample_next(d, s);
        csg_sample_put(d, s, room->triangle[room->owner[i]]);
    }
}

/* Another triangle may be nearer than the one that answers for it. */
static double distance_of(const csg_decimation *d, csg_vec3 p, const csg_vec3 owner[3], double most)
{
    double weights[3], own = sqrt(csg_triangle_nearest(owner, p, weights));
    return own > most ? fmin(own, csg_triangle_tree_nearest(&d->remesh->tree, p, own, NULL)) : own;
}

bool csg_decimation_measure(const csg_decimation *d, double error, csg_far_places *far,
                            double *most)
{
    const csg_remesh *r = d->remesh;
    *most = 0;
    for (uint32_t t = 0; t < r->corners.triangle_count; t++) {
        if (!csg_corners_is_live(&r->corners, t))
            continue;
        const csg_vec3 v[3] = {csg_remesh_corner(r, 3 * t), csg_remesh_corner(r, 3 * t + 1),
                               csg_remesh_corner(r, 3 * t + 2)};
        for (uint32_t s = d->first_sample[t]; s != CSG_CORNER_NONE; s = csg_sample_next(d, s)) {
            csg_vec3 p = csg_sample_at(d, s);
            double distance = distance_of(d, p, v, *most);
            if (!(distance > error))
                *most = fmax(*most, distance);
            else if (!csg_far_places_add(far, r->memory, p))
                return false;
        }
    }
    return true;
}
