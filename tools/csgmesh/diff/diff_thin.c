/* SPDX-License-Identifier: MIT
 * Meshes for the page; see diff_thin.h. Where there are too many triangles, the vertices of
 * each cluster (csgm_mesh_cluster) become one in their mean, with the largest of their distances,
 * so that no change is lost from sight.
 */
#include "diff/diff_thin.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = 65535 };

typedef struct sums {
    double position[3], color[3];
    uint32_t count;
} sums;

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

static bool is_flat(const uint32_t *index, const uint32_t *cluster_of)
{
    uint32_t a = cluster_of[index[0]], b = cluster_of[index[1]], c = cluster_of[index[2]];
    return a == b || b == c || c == a;
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

static bool thin(const diff_drawing *d, int side, diff_thin *mesh, uint64_t most)
{
    uint32_t count = 0;
    uint32_t *cluster_of = malloc(mesh->vertex_count * sizeof *cluster_of);
    bool good = cluster_of && csgm_mesh_cluster(d->context, &d->sides[side], d->box, most,
                                                cluster_of, &count, &mesh->cell) == CSGM_OK;
    sums *total = good ? calloc(count, sizeof *total) : NULL;
    uint16_t *heat = good ? calloc(count, sizeof *heat) : NULL;
    good = total && heat;
    if (good) {
        join_vertices(mesh, cluster_of, count, total, heat);
        join_triangles(mesh, cluster_of);
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
    return out->triangle_count <= most_triangles || thin(drawing, side, out, most_triangles);
}

void diff_thin_release(diff_thin *thin)
{
    free(thin->positions);
    free(thin->heat);
    free(thin->colors);
    free(thin->indices);
    *thin = (diff_thin){.cell = 0};
}
