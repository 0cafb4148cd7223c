/* SPDX-License-Identifier: MIT
 * From where a change is best seen; see diff_view.h. Each view is a small z-buffer without
 * perspective, in which pixels count by how far their place has moved: what is hidden, turned away
 * or seen from the side counts less or not at all.
 */
#include "diff/diff_view.h"

#include <math.h>
#include <stdlib.h>

enum {
    SIDE = 96, /* pixels */
    AROUND = 8,
    RAISED = 2, /* elevations, above and below */
    ABOVE = AROUND * RAISED,
    VIEWS = 2 * ABOVE
};

static const double MOVED = 0.05; /* of the largest distance: less is not looked at */
static const double CLEARLY = 1.25, NEED = 2;

typedef struct pixel {
    float depth; /* towards the eye */
    float moved;
} pixel;

typedef struct small_view {
    const diff_drawing *drawing;
    csgm_vec3 right, up, toward, middle;
    double scale;
    pixel *pixels;      /* SIDE^2 */
    csgm_vec3 *corners; /* of one side: pixels across and down, and depth */
} small_view;

/* Azimuths 35 and 80 and their quarter turns, at elevations of 25 and 60 degrees, then below. */
static csgm_vec3 view_number(int i)
{
    static const double sine[2] = {0.57357643635, 0.98480775301},
                        cosine[2] = {0.81915204429, 0.17364817767},
                        level[RAISED] = {0.90630778704, 0.5},
                        height[RAISED] = {0.42261826174, 0.86602540378};
    int raised = i % ABOVE / AROUND, around = i % AROUND;
    double s = sine[around / 4], c = cosine[around / 4];
    const double turned[4][2] = {{s, -c}, {-c, -s}, {c, s}, {-s, c}};
    return (csgm_vec3){level[raised] * turned[around % 4][0], level[raised] * turned[around % 4][1],
                       i < ABOVE ? height[raised] : -height[raised]};
}

static double dot(csgm_vec3 a, csgm_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static void aim(small_view *v, csgm_vec3 toward)
{
    double flat = sqrt(toward.x * toward.x + toward.y * toward.y);
    v->toward = toward;
    v->right = (csgm_vec3){-toward.y / flat, toward.x / flat, 0};
    v->up = (csgm_vec3){-toward.z * toward.x / flat, -toward.z * toward.y / flat, flat};
    for (int i = 0; i < SIDE * SIDE; i++)
        v->pixels[i] = (pixel){-INFINITY, 0};
}

static void project(small_view *v, const csgm_mesh_view *mesh)
{
    for (uint64_t i = 0; i < mesh->vertex_count; i++) {
        csgm_vec3 p = diff_drawing_vertex(mesh, (uint32_t)i);
        csgm_vec3 at = {p.x - v->middle.x, p.y - v->middle.y, p.z - v->middle.z};
        v->corners[i] = (csgm_vec3){SIDE / 2.0 + v->scale * dot(at, v->right),
                                    SIDE / 2.0 - v->scale * dot(at, v->up), dot(at, v->toward)};
    }
}

static int clamped(double pixels)
{
    return pixels > 0 ? pixels < SIDE ? (int)pixels : SIDE : 0;
}

/* Pixels whose middles are in the triangle. */
static void draw_triangle(small_view *v, const csgm_vec3 c[3], float moved)
{
    double area = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[1].y - c[0].y) * (c[2].x - c[0].x);
    int x0 = clamped(floor(fmin(c[0].x, fmin(c[1].x, c[2].x)) + 0.5));
    int y0 = clamped(floor(fmin(c[0].y, fmin(c[1].y, c[2].y)) + 0.5));
    int x1 = clamped(floor(fmax(c[0].x, fmax(c[1].x, c[2].x)) + 0.5));
    int y1 = clamped(floor(fmax(c[0].y, fmax(c[1].y, c[2].y)) + 0.5));
    if (!(area != 0))
        return;
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            double px = x + 0.5 - c[0].x, py = y + 0.5 - c[0].y;
            double s = (px * (c[2].y - c[0].y) - py * (c[2].x - c[0].x)) / area;
            double t = (py * (c[1].x - c[0].x) - px * (c[1].y - c[0].y)) / area;
            pixel *at = &v->pixels[y * SIDE + x];
            float depth = (float)(c[0].z + s * (c[1].z - c[0].z) + t * (c[2].z - c[0].z));
            if (s >= 0 && t >= 0 && s + t <= 1 && depth > at->depth)
                *at = (pixel){depth, moved};
        }
}

/* As the heat map: all of B, and of A what is not where B is. */
static void draw_side(small_view *v, int side)
{
    const diff_drawing *d = v->drawing;
    const csgm_mesh_view *mesh = &d->sides[side];
    const float *distances = d->distances[side];
    project(v, mesh);
    for (uint64_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *index = mesh->indices + 3 * t;
        csgm_vec3 corners[3];
        float moved = 0;
        if (side == 0 && !diff_drawing_shows(d, t))
            continue;
        for (int i = 0; i < 3; i++) {
            corners[i] = v->corners[index[i]];
            moved += distances ? distances[index[i]] / 3 : 0;
        }
        draw_triangle(v, corners, moved);
    }
}

static double seen_from(small_view *v, csgm_vec3 toward)
{
    double sum = 0;
    aim(v, toward);
    draw_side(v, 1);
    draw_side(v, 0);
    for (int i = 0; i < SIDE * SIDE; i++)
        if ((double)v->pixels[i].moved > MOVED * v->drawing->most)
            sum += (double)v->pixels[i].moved;
    return sum;
}

static int best_of(const double seen[VIEWS])
{
    int best = 0, below = ABOVE;
    for (int i = 1; i < ABOVE; i++)
        if (seen[i] > CLEARLY * seen[0] && seen[i] > 1.001 * seen[best])
            best = i;
    for (int i = ABOVE; i < VIEWS; i++)
        if (seen[i] > 1.001 * seen[below])
            below = i;
    return seen[below] > NEED * seen[best] ? below : best;
}

csgm_status diff_view_find(const diff_drawing *drawing, csgm_vec3 *toward)
{
    const csgm_mesh_view *sides = drawing->sides;
    csgm_vec3 low = drawing->box.min, high = drawing->box.max;
    csgm_vec3 size = {high.x - low.x, high.y - low.y, high.z - low.z};
    uint64_t vertices = sides[sides[1].vertex_count > sides[0].vertex_count].vertex_count;
    double seen[VIEWS] = {0};
    small_view v = {.drawing = drawing,
                    .middle = {(low.x + high.x) / 2, (low.y + high.y) / 2, (low.z + high.z) / 2},
                    .scale = SIDE / fmax(sqrt(dot(size, size)), 1e-300),
                    .pixels = malloc(SIDE * SIDE * sizeof *v.pixels),
                    .corners = malloc((size_t)(vertices + 1) * sizeof *v.corners)};
    csgm_status status = v.pixels && v.corners ? CSGM_OK : CSGM_ERR_MEMORY;
    for (int i = 0; status == CSGM_OK && drawing->most > 0 && i < VIEWS; i++)
        seen[i] = seen_from(&v, view_number(i));
    if (status == CSGM_OK)
        *toward = view_number(best_of(seen));
    free(v.pixels);
    free(v.corners);
    return status;
}
