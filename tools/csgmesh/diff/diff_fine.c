/* SPDX-License-Identifier: MIT
 * Bisection of long edges; see diff_fine.h. An edge is halved by both of its triangles or by none,
 * since that hangs on its length alone, and at the same point: no cracks open.
 */
#include "diff/diff_fine.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 64 }; /* halves of halves that wait; each is half as long after two steps */

static double length2(const csgm_mesh_view *mesh, uint32_t a, uint32_t b)
{
    const float *p = mesh->positions + 3 * (size_t)a, *q = mesh->positions + 3 * (size_t)b;
    double sum = 0;
    for (int i = 0; i < 3; i++)
        sum += ((double)p[i] - (double)q[i]) * ((double)p[i] - (double)q[i]);
    return sum;
}

/* The edge between corners i and i + 1 that is longest. */
static int longest_edge(const csgm_mesh_view *mesh, const uint32_t corner[3], double *out)
{
    int longest = 0;
    *out = -1;
    for (int i = 0; i < 3; i++) {
        double here = length2(mesh, corner[i], corner[(i + 1) % 3]);
        if (here > *out) {
            *out = here;
            longest = i;
        }
    }
    return longest;
}

bool diff_fine_has_longer_edge(const csgm_mesh_view *mesh, double longest)
{
    for (uint64_t t = 0; t < mesh->triangle_count; t++) {
        double here;
        longest_edge(mesh, mesh->indices + 3 * t, &here);
        if (here > longest * longest)
            return true;
    }
    return false;
}

/* ---- room ------------------------------------------------------------------------------------ */

static bool grow(void **items, size_t count, size_t bytes)
{
    void *more = *items || bytes ? realloc(*items, count * bytes) : NULL;
    if (more)
        *items = more;
    return more != NULL;
}

static bool has_vertex_room(diff_fine *f)
{
    csgm_mesh_view *v = &f->view;
    if (v->vertex_count < f->vertex_room)
        return true;
    size_t room = 2 * f->vertex_room + 64;
    if (room > UINT32_MAX || !grow((void **)&f->positions, room, 3 * sizeof(float)) ||
        (v->normals && !grow((void **)&f->normals, room, 3 * sizeof(float))) ||
        (v->colors && !grow((void **)&f->colors, room, 4)) ||
        (v->materials && !grow((void **)&f->materials, room, 2 * sizeof(uint16_t))))
        return false;
    f->vertex_room = room;
    v->positions = f->positions;
    v->normals = f->normals;
    v->colors = f->colors;
    v->materials = f->materials;
    return true;
}

static bool add_triangle(diff_fine *f, const uint32_t corner[3])
{
    if (f->view.triangle_count == f->triangle_room) {
        size_t room = 2 * f->triangle_room + 64;
        if (!grow((void **)&f->indices, room, 3 * sizeof(uint32_t)))
            return false;
        f->triangle_room = room;
        f->view.indices = f->indices;
    }
    memcpy(f->indices + 3 * f->view.triangle_count++, corner, 3 * sizeof *corner);
    return true;
}

/* ---- halves ---------------------------------------------------------------------------------- */

static void set_normal(float *out, const float *a, const float *b)
{
    float sum[3], length = 0;
    for (int i = 0; i < 3; i++) {
        sum[i] = a[i] + b[i];
        length += sum[i] * sum[i];
    }
    length = sqrtf(length);
    for (int i = 0; i < 3; i++)
        out[i] = length > 0 ? sum[i] / length : a[i];
}

/* UINT32_MAX: out of memory. */
static uint32_t middle_of(diff_fine *f, uint32_t a, uint32_t b)
{
    if (!has_vertex_room(f))
        return UINT32_MAX;
    uint32_t m = (uint32_t)f->view.vertex_count++;
    for (size_t i = 0; i < 3; i++)
        f->positions[3 * (size_t)m + i] =
            0.5f * (f->positions[3 * (size_t)a + i] + f->positions[3 * (size_t)b + i]);
    if (f->normals)
        set_normal(f->normals + 3 * (size_t)m, f->normals + 3 * (size_t)a,
                   f->normals + 3 * (size_t)b);
    for (size_t i = 0; f->colors && i < 4; i++)
        f->colors[4 * (size_t)m + i] =
            (uint8_t)((f->colors[4 * (size_t)a + i] + f->colors[4 * (size_t)b + i] + 1) / 2);
    for (size_t i = 0; f->materials && i < 2; i++)
        f->materials[2 * (size_t)m + i] =
            (uint16_t)((f->materials[2 * (size_t)a + i] + f->materials[2 * (size_t)b + i] + 1) / 2);
    return m;
}

static bool halve(diff_fine *f, const uint32_t triangle[3], double longest, uint64_t most)
{
    uint32_t stack[DEEPEST][3];
    int top = 1;
    memcpy(stack[0], triangle, sizeof stack[0]);
    while (top) {
        uint32_t corner[3];
        double length;
        memcpy(corner, stack[--top], sizeof corner);
        int edge = longest_edge(&f->view, corner, &length);
        if (!(length > longest * longest) || top + 2 > DEEPEST || f->view.triangle_count > most) {
            if (!add_triangle(f, corner))
                return false;
            continue;
        }
        uint32_t a = corner[edge], b = corner[(edge + 1) % 3], c = corner[(edge + 2) % 3];
        uint32_t m = middle_of(f, a, b);
        if (m == UINT32_MAX)
            return false;
        memcpy(stack[top++], (uint32_t[3]){m, b, c}, sizeof corner);
        memcpy(stack[top++], (uint32_t[3]){a, m, c}, sizeof corner);
    }
    return true;
}

/* ---- the whole ------------------------------------------------------------------------------- */

static bool copy_vertices(const csgm_mesh_view *mesh, diff_fine *out)
{
    size_t count = (size_t)mesh->vertex_count;
    out->view = *mesh;
    out->view.parts = NULL;
    out->view.part_count = out->view.triangle_count = 0;
    out->vertex_room = count;
    if (!has_vertex_room(out))
        return false;
    memcpy(out->positions, mesh->positions, count * 3 * sizeof(float));
    if (mesh->normals)
        memcpy(out->normals, mesh->normals, count * 3 * sizeof(float));
    if (mesh->colors)
        memcpy(out->colors, mesh->colors, count * 4);
    if (mesh->materials)
        memcpy(out->materials, mesh->materials, count * 2 * sizeof(uint16_t));
    return true;
}

bool diff_fine_make(const csgm_mesh_view *mesh, double longest, uint64_t most, diff_fine *out)
{
    most += mesh->triangle_count;
    for (;; longest *= 1.5) {
        *out = (diff_fine){.positions = NULL};
        bool good = copy_vertices(mesh, out);
        for (uint64_t t = 0; good && t < mesh->triangle_count && out->view.triangle_count <= most;
             t++)
            good = halve(out, mesh->indices + 3 * t, longest, most);
        if (!good || out->view.triangle_count <= most)
            return good;
        diff_fine_release(out);
    }
}

void diff_fine_release(diff_fine *fine)
{
    free(fine->positions);
    free(fine->normals);
    free(fine->colors);
    free(fine->materials);
    free(fine->indices);
    *fine = (diff_fine){.positions = NULL};
}
