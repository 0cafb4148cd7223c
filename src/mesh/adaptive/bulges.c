/* SPDX-License-Identifier: MIT
 * Faces in which the surface is curved: the straight way between two of its points is too far from
 * it, but a cell a half as large would cost four times as many. So a vertex is put between: first
 * where the points' tangents meet, or where a curve with these tangents is, then by Newton's steps
 * in the face. Between it and either point there may be a crease, or another bend: so a rounded
 * edge, or a chamfer, passes through a face by three vertices.
 */
#include <math.h>

#include "base/elementary.h"

#include "mesh/adaptive/sheets.h"
#include "mesh/plane.h"

/* Of two tangents that meet: sin^2 of 2 degrees. */
static const double LEAST_SINE_SQUARE = 1e-3;

enum { NEWTON = 3, MOST = (CSG_MOST_FACES + CSG_LANES - 1) / CSG_LANES * CSG_LANES };

/* Of a cell: how far from its sides a place is kept. */
static const double MARGIN = 0x1p-9;
/* Cosine: where gradients turn more there may be two sheets. */
static const double LEAST_COSINE = -0.5;
/* Of all that the gradients turn: between one end and the middle. */
static const double MOST_TURN = 0.9;

/* One face's way. */
typedef struct approach {
    csg_face_crease *face;
    int axis;                       /* the face's own */
    csg_vec3 at, gradient, ends[2]; /* gradients in the face */
} approach;

static double *component(csg_vec3 *v, int axis)
{
    return axis == 0 ? &v->x : axis == 1 ? &v->y : &v->z;
}

static int axis_of(const csg_cell_box *face)
{
    return face->low[0] == face->high[0] ? 0 : face->low[1] == face->high[1] ? 1 : 2;
}

static bool is_within(const approach *a)
{
    const csg_cell_box *box = &a->face->face;
    const double at[3] = {a->at.x, a->at.y, a->at.z};
    for (int axis = 0; axis < 3; axis++)
        if (axis != a->axis && !(at[axis] >= box->low[axis] + MARGIN * box->cell &&
                                 at[axis] <= box->high[axis] - MARGIN * box->cell))
            return false;
    return true;
}

/* False: the surface does not bulge by more than `most`. */
static bool set_out(approach *a, csg_face_crease *face, double most)
{
    if (face->is_there || face->is_wedge)
        return false;
    *a = (approach){.face = face, .axis = axis_of(&face->face)};
    csg_vec3 unit[2];
    for (int k = 0; k < 2; k++) {
        a->ends[k] = face->ends[k].gradient;
        *component(&a->ends[k], a->axis) = 0;
        unit[k] = csg_vec3_normalize(a->ends[k]);
    }
    csg_vec3 way = csg_vec3_sub(face->ends[1].at, face->ends[0].at);
    double bulge = csg_vec3_dot(way, csg_vec3_sub(unit[1], unit[0])) / 8;
    if (!(fabs(bulge) > most) || !(csg_vec3_dot(unit[0], unit[1]) > LEAST_COSINE))
        return false;
    csg_vec3 middle = csg_vec3_scale(csg_vec3_add(face->ends[0].at, face->ends[1].at), 0.5);
    csg_vec3 normal = csg_vec3_normalize(csg_vec3_add(unit[0], unit[1]));
    csg_plane planes[2] = {csg_plane_of(face->ends[0].at, 0, unit[0]),
                           csg_plane_of(face->ends[1].at, 0, unit[1])};
    a->at = middle;
    *component(&a->at, a->axis) = face->face.low[a->axis];
    if (!csg_planes_meet_in_line(planes, LEAST_SINE_SQUARE, &a->at) || !is_within(a))
        a->at = csg_vec3_add(middle, csg_vec3_scale(normal, bulge));
    *component(&a->at, a->axis) = face->face.low[a->axis];
    return true;
}

static void ask(csg_sheet_probe *p, const approach *ways, int count, float *f, float g[3][MOST])
{
    float x[MOST], y[MOST], z[MOST];
    for (int i = 0; i < count || i % CSG_LANES; i++) {
        csg_vec3 at = ways[i < count ? i : 0].at;
        x[i] = (float)at.x, y[i] = (float)at.y, z[i] = (float)at.z;
    }
    p->kernel->values_and_gradients(p->tape, x, y, z, (size_t)count, f, g[0], g[1], g[2],
                                    p->scratch, p->scratch_floats);
    p->evaluations += (uint64_t)count;
}

/* One of Newton's steps in the face. False: it leads out of it. */
static bool step(approach *a, double f, csg_vec3 g)
{
    csg_vec3 across = g;
    *component(&across, a->axis) = 0;
    double square = csg_vec3_dot(across, across);
    if (!(square > 1e-12))
        return false;
    float rounded[3];
    csg_vec3_to_floats(rounded, csg_vec3_sub(a->at, csg_vec3_scale(across, f / square)));
    a->at = csg_vec3_from_floats(rounded);
    a->gradient = g;
    return is_within(a);
}

static double angle(csg_vec3 a, csg_vec3 b)
{
    return csg_arc_cosine(csg_gradients_cosine(a, b));
}

/* Whether the gradient turns on the way to the middle, and from there on. */
static bool is_curved(const approach *a)
{
    csg_vec3 g = a->gradient;
    *component(&g, a->axis) = 0;
    double most = MOST_TURN * angle(a->ends[0], a->ends[1]);
    return angle(a->ends[0], g) <= most && angle(a->ends[1], g) <= most;
}

/* A place between the points of each face through which no crease goes and the surface bulges. */
static void bulge_in_faces(csg_sheet_probe *p, csg_face_crease *faces, int count, double most)
{
    approach ways[CSG_MOST_FACES];
    float f[MOST], g[3][MOST];
    int going = 0;
    for (int i = 0; i < count; i++) {
        faces[i].is_smooth = false;
        going += set_out(&ways[going], &faces[i], most);
    }
    for (int round = 0; round < NEWTON && going; round++) {
        int kept = 0;
        ask(p, ways, going, f, g);
        for (int i = 0; i < going; i++) {
            approach a = ways[i];
            if (step(&a, (double)f[i],
                     csg_vec3_make((double)g[0][i], (double)g[1][i], (double)g[2][i])))
                ways[kept++] = a;
        }
        going = kept;
    }
    for (int i = 0; i < going; i++) {
        csg_face_crease *face = ways[i].face;
        face->is_there = face->is_smooth = is_curved(&ways[i]);
        face->at = ways[i].at;
        face->gradient = ways[i].gradient;
    }
}

/* ---- parts of a side ---------------------------------------------------------------------------
 */

/* Sides' parts that are looked for at once. */
typedef struct parts {
    csg_face_crease search[CSG_MOST_FACES];
    csg_face_crease *of[CSG_MOST_FACES];
    int count;
} parts;

static void find_parts(csg_sheet_probe *p, parts *all, double most)
{
    csg_sheets_meet_in_faces(p, all->search, all->count);
    bulge_in_faces(p, all->search, all->count, most);
    for (int i = 0; i < all->count; i++)
        *all->of[i] = all->search[i];
    all->count = 0;
}

static double cosine_in_face(const csg_face_crease *part)
{
    csg_vec3 g[2] = {part->ends[0].gradient, part->ends[1].gradient};
    for (int k = 0; k < 2; k++)
        *component(&g[k], axis_of(&part->face)) = 0;
    return csg_gradients_cosine(g[0], g[1]);
}

/* What is between a bend and either end is to be looked for where gradients turn. */
static void add_parts(csg_sheet_probe *p, parts *all, csg_face_side *side, double most)
{
    const csg_face_crease *bend = &side->part[CSG_BETWEEN];
    for (int k = 0; k < 2; k++) {
        csg_face_crease *part = &side->part[k ? CSG_ABOVE : CSG_BELOW];
        *part = (csg_face_crease){.face = bend->face};
        part->ends[k] = bend->ends[k];
        part->ends[1 - k] = (csg_surface_point){bend->at, bend->gradient};
        if (cosine_in_face(part) > CSG_LEAST_CREASE_COSINE)
            continue;
        if (all->count == CSG_MOST_FACES)
            find_parts(p, all, most);
        all->of[all->count] = part;
        all->search[all->count++] = *part;
    }
}

void csg_sheets_find_in_faces(csg_sheet_probe *p, csg_face_side *sides, int count, double most,
                              bool divides)
{
    parts all = {.count = 0};
    for (int i = 0; i < count; i++) {
        sides[i].part[CSG_BELOW] = sides[i].part[CSG_ABOVE] = (csg_face_crease){.is_there = false};
        all.of[all.count] = &sides[i].part[CSG_BETWEEN];
        all.search[all.count++] = sides[i].part[CSG_BETWEEN];
        if (all.count == CSG_MOST_FACES)
            find_parts(p, &all, most);
    }
    find_parts(p, &all, most);
    for (int i = 0; i < count && divides; i++)
        if (sides[i].part[CSG_BETWEEN].is_there && sides[i].part[CSG_BETWEEN].is_smooth)
            add_parts(p, &all, &sides[i], most);
    find_parts(p, &all, most);
}
