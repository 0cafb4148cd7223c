/* SPDX-License-Identifier: MIT
 * A tile of a mesh's picture; see draw.h.
 */
#include <string.h>

#include "render/draw.h"
#include "render/ground_map.h"
#include "render/outline.h"

/* Where the tile is, in samples. */
typedef struct area {
    int64_t x0, y0, width, height;
} area;

/* ---- which triangle a sample sees ------------------------------------------------------------ */

/* Twice the signed area of a, b, p is a * x + b * y + c over snapped coordinates; with the rule
 * that a sample on an edge belongs to the triangle to the right of it or below. */
typedef struct edge {
    int64_t a, b, c;
} edge;

static edge edge_between(const csg_draw_vertex *from, const csg_draw_vertex *to)
{
    int64_t dx = (int64_t)to->x - from->x, dy = (int64_t)to->y - from->y;
    edge e = {-dy, dx, dy * from->x - dx * from->y};
    bool is_top_or_left = dy < 0 || (dy == 0 && dx > 0);
    e.c -= !is_top_or_left;
    return e;
}

static int64_t floor_divide(int64_t a, int64_t b)
{
    return a / b - (a % b < 0);
}

/* Samples whose centres lie in the box around the corners, within the area. */
static bool sample_range(const csg_draw_vertex v[3], const area *in, int64_t range[4])
{
    const int64_t half = CSG_DRAW_SUBSTEPS / 2;
    int64_t low_x = v[0].x, high_x = v[0].x, low_y = v[0].y, high_y = v[0].y;
    for (int i = 1; i < 3; i++) {
        low_x = v[i].x < low_x ? v[i].x : low_x;
        high_x = v[i].x > high_x ? v[i].x : high_x;
        low_y = v[i].y < low_y ? v[i].y : low_y;
        high_y = v[i].y > high_y ? v[i].y : high_y;
    }
    range[0] = floor_divide(low_x - half, CSG_DRAW_SUBSTEPS);
    range[1] = floor_divide(low_y - half, CSG_DRAW_SUBSTEPS);
    range[2] = floor_divide(high_x - half, CSG_DRAW_SUBSTEPS) + 1;
    range[3] = floor_divide(high_y - half, CSG_DRAW_SUBSTEPS) + 1;
    range[0] = range[0] > in->x0 ? range[0] : in->x0;
    range[1] = range[1] > in->y0 ? range[1] : in->y0;
    range[2] = range[2] < in->x0 + in->width ? range[2] : in->x0 + in->width;
    range[3] = range[3] < in->y0 + in->height ? range[3] : in->y0 + in->height;
    return range[0] < range[2] && range[1] < range[3];
}

/* Corners in the order that makes its area positive. */
static void fill(csg_draw_room *room, const area *in, const csg_draw_vertex v[3], uint32_t id)
{
    int64_t range[4];
    if (!sample_range(v, in, range))
        return;
    edge e[3];
    for (int i = 0; i < 3; i++)
        e[i] = edge_between(&v[(i + 1) % 3], &v[(i + 2) % 3]);
    int64_t area2 = e[0].a * v[0].x + e[0].b * v[0].y + e[0].c;
    double scale = area2 > 0 ? 1 / (double)area2 : 0;
    for (int64_t y = range[1]; y < range[3]; y++) {
        int64_t at_x = range[0] * CSG_DRAW_SUBSTEPS + CSG_DRAW_SUBSTEPS / 2;
        int64_t at_y = y * CSG_DRAW_SUBSTEPS + CSG_DRAW_SUBSTEPS / 2;
        int64_t w[3];
        for (int i = 0; i < 3; i++)
            w[i] = e[i].a * at_x + e[i].b * at_y + e[i].c;
        size_t sample = (size_t)((y - in->y0) * in->width + range[0] - in->x0);
        for (int64_t x = range[0]; x < range[2]; x++, sample++) {
            if ((w[0] | w[1] | w[2]) >= 0) {
                float nearness = (float)(((double)w[0] * (double)v[0].nearness +
                                          (double)w[1] * (double)v[1].nearness +
                                          (double)w[2] * (double)v[2].nearness) *
                                         scale);
                if (nearness > room->nearness[sample] &&
                    (!room->behind || nearness < room->behind[sample])) {
                    room->nearness[sample] = nearness;
                    room->triangle[sample] = id;
                }
            }
            for (int i = 0; i < 3; i++)
                w[i] += e[i].a * CSG_DRAW_SUBSTEPS;
        }
    }
}

static bool is_clear(const csg_draw *draw, uint32_t triangle)
{
    const uint32_t *index = draw->mesh->indices + 3 * (size_t)triangle;
    const uint8_t *colors = draw->mesh->colors;
    return (colors[4 * (size_t)index[0] + 3] & colors[4 * (size_t)index[1] + 3] &
            colors[4 * (size_t)index[2] + 3]) < 255;
}

/* Of what is seen through the inner side is not drawn: each wall is seen once, as in a scene. */
static void fill_triangle(const csg_draw *draw, csg_draw_room *room, const area *in,
                          uint32_t triangle)
{
    csg_draw_vertex v[2][3];
    int count = csg_draw_corners(draw, triangle, v);
    for (int part = 0; part < count; part++) {
        csg_draw_vertex *c = v[part];
        int64_t turn = ((int64_t)c[1].x - c[0].x) * ((int64_t)c[2].y - c[0].y) -
                       ((int64_t)c[1].y - c[0].y) * ((int64_t)c[2].x - c[0].x);
        if (turn > 0 && draw->is_clear && is_clear(draw, triangle))
            continue;
        if (turn < 0) {
            csg_draw_vertex other = c[1];
            c[1] = c[2];
            c[2] = other;
        }
        if (turn != 0)
            fill(room, in, c, triangle + 1);
    }
}

/* ---- its light ------------------------------------------------------------------------------- */

/* Where a ray meets the triangle's plane: shares of the corners, held to the triangle. */
static void shares_of(const csg_vec3 corner[3], csg_vec3 origin, csg_vec3 direction,
                      double share[3])
{
    csg_vec3 u = csg_vec3_sub(corner[1], corner[0]), v = csg_vec3_sub(corner[2], corner[0]);
    csg_vec3 p = csg_vec3_cross(direction, v), s = csg_vec3_sub(origin, corner[0]);
    csg_vec3 q = csg_vec3_cross(s, u);
    double determinant = csg_vec3_dot(u, p);
    share[1] = csg_vec3_dot(s, p) / determinant;
    share[2] = csg_vec3_dot(direction, q) / determinant;
    if (!isfinite(share[1] + share[2]))
        share[1] = share[2] = 1.0 / 3;
    share[1] = fmin(fmax(share[1], 0), 1);
    share[2] = fmin(fmax(share[2], 0), 1 - share[1]);
    share[0] = 1 - share[1] - share[2];
}

static csg_vec3 facet_normal(const csg_vec3 corner[3])
{
    return csg_vec3_normalize(
        csg_vec3_cross(csg_vec3_sub(corner[1], corner[0]), csg_vec3_sub(corner[2], corner[0])));
}

static csg_vec3 normal_of(const csg_draw *draw, const uint32_t index[3], const csg_vec3 corner[3],
                          const double share[3])
{
    const float *normals = draw->mesh->normals;
    csg_vec3 flat = facet_normal(corner);
    if (!normals || draw->picture->options->flat)
        return flat;
    csg_vec3 sum = {0, 0, 0};
    for (int i = 0; i < 3; i++) {
        const float *n = normals + 3 * (size_t)index[i];
        sum = csg_vec3_add(sum, csg_vec3_scale(csg_vec3_from_floats(n), share[i]));
    }
    sum = csg_vec3_normalize(sum);
    return csg_vec3_norm(sum) > 0.5 && csg_vec3_dot(sum, flat) > 0 ? sum : flat;
}

/* Returns how much of what is behind the surface hides. */
static float color_of(const csg_draw *draw, const uint32_t index[3], const double share[3],
                      csg_surface *surface)
{
    const uint8_t *colors = draw->mesh->colors;
    const uint16_t *materials = draw->mesh->materials;
    float weights[3] = {(float)share[0], (float)share[1], (float)share[2]};
    for (int c = 0; c < 3; c++) {
        surface->color[c] = colors ? 0 : c < 2 ? 0.76f : 0.74f;
        for (int i = 0; colors && i < 3; i++)
            surface->color[c] +=
                weights[i] * (float)colors[4 * (size_t)index[i] + (size_t)c] / 255.0f;
    }
    float alpha = colors ? 0 : 1;
    for (int i = 0; colors && i < 3; i++)
        alpha += weights[i] * (float)colors[4 * (size_t)index[i] + 3] / 255.0f;
    surface->metallic = materials ? 0 : 0.0f;
    surface->roughness = materials ? 0 : 0.6f;
    for (int i = 0; materials && i < 3; i++) {
        surface->metallic += weights[i] * (float)materials[2 * (size_t)index[i]] / 10000.0f;
        surface->roughness += weights[i] * (float)materials[2 * (size_t)index[i] + 1] / 10000.0f;
    }
    return draw->is_clear ? alpha : 1;
}

/* How much of the sample an edge's line covers; lines fade where triangles are smaller than they.
 */
static float wire_at(const csg_draw *draw, const csg_vec3 corner[3], const double share[3])
{
    csg_vec3 at[3];
    for (int i = 0; i < 3; i++)
        at[i] = csg_view_project(draw->view, corner[i]);
    double area2 =
        fabs((at[1].x - at[0].x) * (at[2].y - at[0].y) - (at[1].y - at[0].y) * (at[2].x - at[0].x));
    double nearest = INFINITY, smallest = INFINITY;
    for (int i = 0; i < 3; i++) {
        const csg_vec3 *a = &at[(i + 1) % 3], *b = &at[(i + 2) % 3];
        double dx = b->x - a->x, dy = b->y - a->y;
        double height = area2 / (sqrt(dx * dx + dy * dy) + 1e-9);
        nearest = fmin(nearest, share[i] * height);
        smallest = fmin(smallest, height);
    }
    double cover = fmin(fmax(1.0 - nearest, 0), 1), fade = fmin(smallest / 5, 1);
    return (float)(cover * fade);
}

/* Where the key light was looked for last in a pixel. */
typedef struct looked {
    bool is_any;
    csg_vec3 at, normal;
    float lit;
} looked;

/* The share of the key light that arrives. What is before a facet is before its plane, but those at
 * the border of light and shadow turn away where the surface does not. In a pixel of many triangles
 * those beside each other have the same. */
static float lit_at(const csg_draw *draw, csg_vec3 at, csg_vec3 normal, csg_vec3 facet,
                    looked *last)
{
    const double beside = 1.5; /* places of the light's map */
    const double same = 0.95;  /* cosine */
    csg_vec3 key = csg_vec3_from_floats(draw->picture->lights.key);
    if (!(csg_vec3_dot(normal, key) > 0))
        return 0;
    if (csg_vec3_dot(facet, key) > 0)
        normal = facet;
    if (last->is_any && csg_vec3_dot(normal, last->normal) > same &&
        csg_vec3_norm(csg_vec3_sub(at, last->at)) < beside * draw->light->key.place)
        return last->lit;
    *last = (looked){true, at, normal, csg_mesh_light_key(draw->light, at, normal)};
    return last->lit;
}

/* Light of a triangle through a point of the picture; returns how much it hides. */
static float shade_triangle(const csg_draw *draw, uint32_t triangle, double x, double y,
                            looked *last, float light[3])
{
    const csg_picture *picture = draw->picture;
    const uint32_t *index = draw->mesh->indices + 3 * (size_t)triangle;
    csg_vec3 corner[3], origin, direction;
    double share[3];
    for (int i = 0; i < 3; i++)
        corner[i] = csg_draw_position(draw, index[i]);
    csg_view_ray(draw->view, x, y, &origin, &direction);
    shares_of(corner, origin, direction, share);
    csg_vec3 normal = normal_of(draw, index, corner, share);
    csg_surface surface = {.open = 1, .lit = 1};
    float alpha = color_of(draw, index, share, &surface);
    csg_vec3 flat =
        csg_vec3_cross(csg_vec3_sub(corner[1], corner[0]), csg_vec3_sub(corner[2], corner[0]));
    if (csg_vec3_dot(flat, direction) > 0) { /* the inner side, reddish: a hole, or turned about */
        normal = csg_vec3_scale(normal, -1);
        flat = csg_vec3_scale(flat, -1);
        const float inner[3] = {0.62f, 0.18f, 0.14f};
        for (int c = 0; c < 3; c++)
            surface.color[c] = 0.35f * surface.color[c] + 0.65f * inner[c];
    }
    const double n[3] = {normal.x, normal.y, normal.z};
    const double d[3] = {direction.x, direction.y, direction.z};
    for (int axis = 0; axis < 3; axis++) {
        surface.normal[axis] = (float)n[axis];
        surface.to_eye[axis] = (float)-d[axis];
    }
    csg_vec3 at = csg_vec3_make(0, 0, 0);
    for (int i = 0; i < 3; i++)
        at = csg_vec3_add(at, csg_vec3_scale(corner[i], share[i]));
    surface.lit = lit_at(draw, at, normal, csg_vec3_normalize(flat), last);
    csg_shade(&picture->lights, picture->curve, &surface, light);
    float wire = picture->options->wireframe ? 0.85f * wire_at(draw, corner, share) : 0;
    for (int c = 0; c < 3; c++)
        light[c] *= 1 - wire;
    return alpha + wire * (1 - alpha);
}

/* ---- lines ------------------------------------------------------------------------------------ */

/* A tile that is filled. */
typedef struct draw_area {
    const csg_draw *draw;
    csg_draw_room *room;
    area in;
} draw_area;

/* Where sample x, y of the picture is in the room. */
static size_t sample_of(const draw_area *a, int64_t x, int64_t y)
{
    return (size_t)((y - a->in.y0) * a->in.width + x - a->in.x0);
}

/* What sample x, y of the picture sees; with the triangle's normal, or that of the surface. */
static csg_outline_point outline_point(const draw_area *a, int64_t x, int64_t y, bool is_facet)
{
    const csg_draw *draw = a->draw;
    const csg_view *view = draw->view;
    uint32_t id = a->room->triangle[sample_of(a, x, y)];
    csg_outline_point point = {.is_hit = id != 0};
    if (!id)
        return point;
    const uint32_t *index = draw->mesh->indices + 3 * (size_t)(id - 1);
    csg_vec3 corner[3], origin, direction, at = {0, 0, 0};
    double share[3];
    for (int i = 0; i < 3; i++)
        corner[i] = csg_draw_position(draw, index[i]);
    csg_view_ray(view, ((double)x + 0.5) / draw->samples, ((double)y + 0.5) / draw->samples,
                 &origin, &direction);
    shares_of(corner, origin, direction, share);
    for (int i = 0; i < 3; i++)
        at = csg_vec3_add(at, csg_vec3_scale(csg_vec3_sub(corner[i], view->eye), share[i]));
    csg_vec3_to_floats(point.at, at);
    csg_vec3_to_floats(point.normal,
                       is_facet ? facet_normal(corner) : normal_of(draw, index, corner, share));
    point.pixel = (float)(view->pixel * (view->orthographic ? 1 : csg_vec3_dot(at, view->forward)));
    return point;
}

static bool is_parted(const draw_area *a, int64_t x, int64_t y, int64_t dx, int64_t dy)
{
    const uint32_t *triangle = a->room->triangle;
    if (triangle[sample_of(a, x, y)] == triangle[sample_of(a, x + dx, y + dy)])
        return false;
    for (int is_facet = 1; is_facet >= (a->draw->mesh->normals ? 0 : 1); is_facet--) {
        csg_outline_point here = outline_point(a, x, y, is_facet);
        csg_outline_point there = outline_point(a, x + dx, y + dy, is_facet);
        if (csg_outline_between(&here, &there, is_facet ? CSG_OUTLINE_FACETS : CSG_OUTLINE_CREASE))
            return true;
    }
    return false;
}

/* Of a pixel; what parts it from its neighbour is half its own. */
static float line_in_pixel(const draw_area *a, uint32_t pixel_x, uint32_t pixel_y)
{
    int64_t n = a->draw->samples, x0 = pixel_x * n, y0 = pixel_y * n;
    int across = 0, down = 0;
    for (int64_t i = 0; i < n; i++)
        for (int64_t k = -1; k < n; k++) {
            int weight = k < 0 || k == n - 1 ? 1 : 2;
            across += weight * is_parted(a, x0 + k, y0 + i, 1, 0);
            down += weight * is_parted(a, x0 + i, y0 + k, 0, 1);
        }
    float whole = 2 * (float)n;
    return csg_outline_cover((float)across / whole, (float)down / whole);
}

/* ---- the tile -------------------------------------------------------------------------------- */

static float ground_at(const csg_draw *draw, double x, double y)
{
    csg_vec3 origin, direction;
    csg_view_ray(draw->view, x, y, &origin, &direction);
    return csg_ground_map_at(draw->ground, origin, direction);
}

/* A triangle in a pixel. */
typedef struct piece {
    uint32_t id, count, sum_x, sum_y; /* of its samples */
    float share;                      /* of them, as much as they are seen */
} piece;

/* The triangles that the pixel's samples see. */
static uint32_t find_pieces(const draw_area *a, uint32_t x, uint32_t y, piece out[64])
{
    uint32_t n = a->draw->samples, known = 0;
    for (uint32_t s = 0; s < n * n; s++) {
        size_t at = sample_of(a, (int64_t)x * n + s % n, (int64_t)y * n + s / n);
        uint32_t id = a->room->triangle[at], k = 0;
        if (!id)
            continue;
        while (k < known && out[k].id != id)
            k++;
        if (k == known)
            out[known++] = (piece){.id = id};
        out[k].count++;
        out[k].sum_x += s % n;
        out[k].sum_y += s / n;
        out[k].share += a->room->through ? a->room->through[at] : 1;
    }
    return known;
}

/* What is behind the pixel's samples of a piece is seen as much less. */
static void cover_samples(const draw_area *a, uint32_t x, uint32_t y, uint32_t id, float alpha)
{
    uint32_t n = a->draw->samples;
    for (uint32_t s = 0; s < n * n; s++) {
        size_t at = sample_of(a, (int64_t)x * n + s % n, (int64_t)y * n + s / n);
        if (a->room->triangle[at] == id)
            a->room->through[at] *= 1 - alpha;
    }
}

/* Adds the light of what a pixel sees: each triangle once, at the middle of its samples there. */
static void add_pixel(const draw_area *a, uint32_t x, uint32_t y, csg_draw_sum *sum)
{
    piece pieces[64];
    looked last = {.is_any = false};
    uint32_t n = a->draw->samples, known = find_pieces(a, x, y, pieces);
    for (uint32_t k = 0; k < known; k++) {
        const piece *p = &pieces[k];
        float light[3];
        double count = p->count;
        float alpha = shade_triangle(a->draw, p->id - 1, x + (p->sum_x / count + 0.5) / n,
                                     y + (p->sum_y / count + 0.5) / n, &last, light);
        for (int c = 0; c < 3; c++)
            sum->light[c] += light[c] * (alpha * p->share);
        sum->cover += alpha * p->share;
        if (a->room->through)
            cover_samples(a, x, y, p->id, alpha);
    }
}

static void end_pixel(const draw_area *a, uint32_t x, uint32_t y, csg_draw_sum *sum)
{
    const csg_picture *picture = a->draw->picture;
    uint32_t samples = a->draw->samples * a->draw->samples;
    float left = (float)samples - sum->cover;
    if (left > 0)
        sum->cover += left * ground_at(a->draw, x + 0.5, y + 0.5);
    csg_outline_draw(sum->line, (float)samples, sum->light, &sum->cover);
    csg_shade_pixel(picture->curve, sum->light, sum->cover, samples, picture->options->background,
                    csg_picture_pixel(picture, x, y));
}

static area area_of(const csg_draw *draw, uint32_t column, uint32_t row)
{
    int64_t side = (int64_t)CSG_DRAW_TILE * draw->samples, border = draw->border;
    return (area){column * side - border, row * side - border, side + 2 * border,
                  side + 2 * border};
}

static void fill_tile(const csg_draw *draw, csg_draw_room *room, uint32_t column, uint32_t row)
{
    area in = area_of(draw, column, row);
    int64_t side = in.width;
    for (int64_t i = 0; i < side * side; i++) {
        room->nearness[i] = -INFINITY;
        room->triangle[i] = 0;
    }
    size_t tile = (size_t)row * draw->columns + column;
    for (uint64_t i = draw->tile_first[tile]; i < draw->tile_first[tile + 1]; i++)
        fill_triangle(draw, room, &in, draw->tile_triangles[i]);
}

/* Where something is behind what was drawn and seen through it. False: nowhere. */
static bool look_behind(const draw_area *a)
{
    csg_draw_room *room = a->room;
    bool is_any = false;
    for (int64_t i = 0; i < a->in.width * a->in.height; i++) {
        bool goes_on = room->triangle[i] && room->through[i] > CSG_HARDLY_SEEN;
        room->behind[i] = goes_on ? room->nearness[i] : -INFINITY;
        is_any = is_any || goes_on;
    }
    return is_any;
}

static void begin_tile(const draw_area *a)
{
    csg_draw_room *room = a->room;
    memset(room->sums, 0, sizeof room->sums);
    for (int64_t i = 0; room->through && i < a->in.width * a->in.height; i++) {
        room->through[i] = 1;
        room->behind[i] = INFINITY;
    }
}

void csg_draw_tile(const csg_draw *draw, csg_draw_room *room, uint32_t column, uint32_t row)
{
    draw_area a = {draw, room, area_of(draw, column, row)};
    const csgm_image *image = draw->picture->image;
    uint32_t x0 = column * CSG_DRAW_TILE, y0 = row * CSG_DRAW_TILE;
    uint32_t width = image->width - x0 < CSG_DRAW_TILE ? image->width - x0 : CSG_DRAW_TILE;
    uint32_t height = image->height - y0 < CSG_DRAW_TILE ? image->height - y0 : CSG_DRAW_TILE;
    begin_tile(&a);
    for (int surface = 0; surface < CSG_MOST_SURFACES; surface++) {
        fill_tile(draw, room, column, row);
        for (uint32_t i = 0; i < width * height; i++) {
            csg_draw_sum *sum = &room->sums[i];
            add_pixel(&a, x0 + i % width, y0 + i / width, sum);
            if (surface == 0 && draw->picture->options->edges)
                sum->line = line_in_pixel(&a, x0 + i % width, y0 + i / width);
        }
        if (!room->through || !look_behind(&a))
            break;
    }
    for (uint32_t i = 0; i < width * height; i++)
        end_pixel(&a, x0 + i % width, y0 + i / width, &room->sums[i]);
}
