/* SPDX-License-Identifier: MIT
 * Meshes for the page; see diff_thin.h. Too many triangles are thinned by clustering (Rossignac and
 * Borrel 1993): the vertices of a cell of a grid become one in their mean, with the largest of
 * their distances, so that no change is lost from sight. Cells grow until few enough triangles are
 * left.
 */
#include "diff/diff_thin.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 65535, FINEST = 512, COARSEST = 8 };

typedef struct sums {
    double position[3], color[3];
    uint32_t count;
} sums;

typedef struct cell {
    uint64_t key;
    uint32_t vertex;
} cell;

/* ---- as it is -------------------------------------------------------------------------------- */

static uint16_t step_of(double value, double low, double high)
{
    double share = high > low ? (value - low) / (high - low) : 0;
    return (uint16_t)(STEPS * fmin(1, fmax(0, share)) + 0.5);
}

static bool allocate(diff_thin *out, const csgm_mesh_view *view, bool has_heat)
{
    size_t vertices = (size_t)view->vertex_count + 1, triangles = (size_t)view->triangle_count + 1;
    out->positions = malloc(vertices * 3 * sizeof *out->positions);
    out->heat = has_heat ? malloc(vertices * sizeof *out->heat) : NULL;
    out->colors = view->colors ? malloc(vertices * 3) : NULL;
    out->indices = malloc(triangles * 3 * sizeof *out->indices);
    return out->positions && out->indices && (out->heat || !has_heat) &&
           (out->colors || !view->colors);
}

static void take_all(const diff_drawing *d, int side, diff_thin *out)
{
    const csgm_mesh_view *view = &d->sides[side];
    const csgm_box *box = &d->box;
    for (uint64_t v = 0; v < view->vertex_count; v++) {
        csgm_vec3 p = diff_drawing_vertex(view, (uint32_t)v);
        out->positions[3 * v] = step_of(p.x, box->min.x, box->max.x);
        out->positions[3 * v + 1] = step_of(p.y, box->min.y, box->max.y);
        out->positions[3 * v + 2] = step_of(p.z, box->min.z, box->max.z);
        if (out->heat)
            out->heat[v] = step_of((double)d->distances[side][v], 0, d->most);
        if (out->colors)
            memcpy(out->colors + 3 * v, view->colors + 4 * v, 3);
    }
    memcpy(out->indices, view->indices, (size_t)view->triangle_count * 3 * sizeof *out->indices);
    out->vertex_count = (uint32_t)view->vertex_count;
    out->triangle_count = view->triangle_count;
}

/* ---- clusters -------------------------------------------------------------------------------- */

static int compare_cells(const void *left, const void *right)
{
    const cell *a = left, *b = right;
    if (a->key != b->key)
        return a->key < b->key ? -1 : 1;
    return (a->vertex > b->vertex) - (a->vertex < b->vertex);
}

static double longest(const csgm_box *box)
{
    return fmax(box->max.x - box->min.x, fmax(box->max.y - box->min.y, box->max.z - box->min.z));
}

/* The cluster of each vertex, clusters in the order of cells; their number. */
static uint32_t find_clusters(const diff_drawing *d, const diff_thin *all, int cells, cell *scratch,
                              uint32_t *cluster_of)
{
    double size[3] = {d->box.max.x - d->box.min.x, d->box.max.y - d->box.min.y,
                      d->box.max.z - d->box.min.z};
    double scale[3];
    for (int k = 0; k < 3; k++)
        scale[k] = cells * (size[k] / longest(&d->box)) / (STEPS + 1);
    for (uint32_t v = 0; v < all->vertex_count; v++) {
        uint64_t key = 0;
        for (size_t k = 0; k < 3; k++)
            key = key << 16 | (uint64_t)(all->positions[3 * (size_t)v + k] * scale[k]);
        scratch[v] = (cell){key, v};
    }
    qsort(scratch, all->vertex_count, sizeof *scratch, compare_cells);
    uint32_t count = 0;
    for (uint32_t i = 0; i < all->vertex_count; i++) {
        count += i == 0 || scratch[i].key != scratch[i - 1].key;
        cluster_of[scratch[i].vertex] = count - 1;
    }
    return count;
}

static bool is_flat(const uint32_t *index, const uint32_t *cluster_of)
{
    uint32_t a = cluster_of[index[0]], b = cluster_of[index[1]], c = cluster_of[index[2]];
    return a == b || b == c || c == a;
}

static uint64_t count_left(const diff_thin *all, const uint32_t *cluster_of)
{
    uint64_t left = 0;
    for (uint64_t t = 0; t < all->triangle_count; t++)
        left += !is_flat(all->indices + 3 * t, cluster_of);
    return left;
}

/* Written over the vertices themselves: sums are elsewhere by then. */
static void join_vertices(diff_thin *mesh, const uint32_t *cluster_of, uint32_t count, sums *total,
                          uint16_t *heat)
{
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        sums *s = &total[cluster_of[v]];
        s->count++;
        for (size_t k = 0; k < 3; k++) {
            s->position[k] += mesh->positions[3 * v + k];
            s->color[k] += mesh->colors ? mesh->colors[3 * v + k] : 0;
        }
        if (mesh->heat && mesh->heat[v] > heat[cluster_of[v]])
            heat[cluster_of[v]] = mesh->heat[v];
    }
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < 3; k++) {
            mesh->positions[3 * i + k] = (uint16_t)(total[i].position[k] / total[i].count + 0.5);
            if (mesh->colors)
                mesh->colors[3 * i + k] = (uint8_t)(total[i].color[k] / total[i].count + 0.5);
        }
    if (mesh->heat)
        memcpy(mesh->heat, heat, count * sizeof *heat);
    mesh->vertex_count = count;
}

static void join_triangles(diff_thin *mesh, const uint32_t *cluster_of)
{
    uint64_t left = 0;
    for (uint64_t t = 0; t < mesh->triangle_count; t++) {
        if (is_flat(mesh->indices + 3 * t, cluster_of))
            continue;
        for (size_t k = 0; k < 3; k++)
            mesh->indices[3 * left + k] = cluster_of[mesh->indices[3 * t + k]];
        left++;
    }
    mesh->triangle_count = left;
}

static bool thin(const diff_drawing *d, diff_thin *mesh, uint64_t most)
{
    size_t vertices = mesh->vertex_count;
    cell *scratch = malloc(vertices * sizeof *scratch);
    uint32_t *cluster_of = malloc(vertices * sizeof *cluster_of);
    bool good = scratch && cluster_of;
    uint32_t count = 0;
    int cells = FINEST;
    while (good) {
        count = find_clusters(d, mesh, cells, scratch, cluster_of);
        uint64_t left = count_left(mesh, cluster_of);
        if (left <= most || cells <= COARSEST)
            break;
        /* triangles grow as the square of the cells */
        double share = sqrt((double)most / (double)left);
        cells = (int)(cells * fmin(0.9, fmax(0.25, 0.97 * share)));
    }
    free(scratch);
    sums *total = good ? calloc(count, sizeof *total) : NULL;
    uint16_t *heat = good ? calloc(count, sizeof *heat) : NULL;
    good = total && heat;
    if (good) {
        join_vertices(mesh, cluster_of, count, total, heat);
        join_triangles(mesh, cluster_of);
        mesh->cell = longest(&d->box) / cells;
    }
    free(total);
    free(heat);
    free(cluster_of);
    return good;
}

bool diff_thin_make(const diff_drawing *drawing, int side, uint64_t most_triangles, diff_thin *out)
{
    const csgm_mesh_view *view = &drawing->sides[side];
    *out = (diff_thin){.cell = 0};
    if (!allocate(out, view, drawing->distances[side] != NULL))
        return false;
    if (view->vertex_count == 0 || view->triangle_count == 0)
        return true;
    take_all(drawing, side, out);
    return out->triangle_count <= most_triangles || thin(drawing, out, most_triangles);
}

void diff_thin_release(diff_thin *thin)
{
    free(thin->positions);
    free(thin->heat);
    free(thin->colors);
    free(thin->indices);
    *thin = (diff_thin){.cell = 0};
}
