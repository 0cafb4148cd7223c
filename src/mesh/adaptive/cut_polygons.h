/* SPDX-License-Identifier: MIT
 * Polygons as they are cut into triangles, and how far these are from the surface.
 */
#ifndef CSG_MESH_ADAPTIVE_CUT_POLYGONS_H
#define CSG_MESH_ADAPTIVE_CUT_POLYGONS_H

#include "mesh/adaptive/sheets.h"
#include "mesh/marching/tables.h"

enum { CSG_CUT_MOST_CORNERS = 66 };

/* Around an apex, or without a point inside. */
typedef struct csg_cut_polygon {
    csg_polygon polygon;
    bool is_fan;
    csg_vec3 apex;
    csg_apex_kind kind;                /* of the apex */
    uint8_t cut[CSG_CUT_MOST_CORNERS]; /* three corners per triangle */
    uint8_t cell, number;              /* the polygon's, in its cell */
    bool is_cut;                       /* as the mesh is to have it */
    double distance;                   /* from the surface, as it was last cut */
} csg_cut_polygon;

/* Whether sheets that should meet in it do not: of a fan. */
static inline bool csg_cut_has_failed(const csg_cut_polygon *p)
{
    return p->kind == CSG_APEX_FAILED || p->polygon.is_torn;
}

int csg_cut_triangle_count(const csg_cut_polygon *piece);
/* The corners of a triangle as vertices of the polygon, -1 for the apex, and their places. */
void csg_cut_triangle(const csg_cut_polygon *piece, int triangle, int corner[3], csg_vec3 at[3]);

/* Cuts the polygon of a whole cell without a point inside, its vertices being the edges that they
 * are on, from the same vertex on as the mesh will have it: other triangles have other distances.
 * False: it has no such cut. */
bool csg_cut_plain(csg_cut_polygon *piece);

/* The same of one that may have smooth vertices in faces: between those, where the surface is
 * curved least. */
bool csg_cut_without_apex(csg_cut_polygon *piece);

/* The largest distance from the surface of each, as |f| over the slope, at points of the triangles.
 * INFINITY: a triangle higher than `least_height` looks inwards. */
void csg_cuts_find_distances(csg_sheet_probe *probe, csg_cut_polygon *const *pieces, int count,
                             double least_height);

/* Fans, whose distances were found, that are so near to the surface that nobody sees where in them
 * sheets meet, or what is between two: they count as fans in which all meet. */
void csg_cuts_settle_near(csg_cut_polygon *const *fans, int count, double tolerance);

/* Whether all triangles of one have the other on one side, by more than a margin: then they do not
 * meet. */
bool csg_cuts_are_apart(const csg_cut_polygon *one, const csg_cut_polygon *other, double margin);

#endif
