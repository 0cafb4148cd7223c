/* SPDX-License-Identifier: MIT
 * From a polygon and its sheets to the place of its apex.
 */
#ifndef CSG_MESH_FEATURES_APEX_H
#define CSG_MESH_FEATURES_APEX_H

#include "mesh/features/probe.h"
#include "mesh/plane.h"

enum { CSG_FEATURE_MOST_STARTS = 4 };

/* From the floats of a probe. */
csg_plane csg_plane_at(float x, float y, float z, float f, float gx, float gy, float gz);

/* Moves x to the point nearest to it where the planes meet: on two, their line; on three and more,
 * the point of least squares. False: they do not meet in a line (a point). */
bool csg_planes_meet(const csg_plane *planes, int count, csg_vec3 *x);

/* A polygon and its sheets. */
typedef struct csg_feature_polygon {
    int sides, sheets;
    csg_vec3 corner[CSG_FEATURE_MOST_SIDES];
    uint8_t edge[CSG_FEATURE_MOST_SIDES], sheet[CSG_FEATURE_MOST_SIDES];
    uint16_t creased;
    csg_vec3 middle, toward[CSG_FEATURE_MOST_SHEETS]; /* toward: the mean of a sheet's corners */
    csg_vec3 start[CSG_FEATURE_MOST_STARTS];          /* where to look for the apex, best first */
    int start_count;
} csg_feature_polygon;

typedef struct csg_apex {
    csg_vec3 at;
    csg_plane planes[CSG_FEATURE_MOST_SHEETS]; /* of each sheet */
    bool lost;
} csg_apex;

/* Fills middle and toward. */
void csg_feature_find_middles(csg_feature_polygon *polygon);

/* Moves an apex to where its planes meet, or loses it. */
void csg_apex_meet(const csg_feature_polygon *polygon, csg_apex *apex, double cell);

/* An apex on its way, with planes to begin with. */
typedef struct csg_apex_walk {
    const csg_feature_polygon *polygon;
    csg_apex *apex;
    bool slides;   /* along its crease, to where the fan looks out */
    bool is_plane; /* its sheets may be: that is tried before it is taken nearer step by step */
} csg_apex_walk;

enum { CSG_FEATURE_MOST_WALKS = 16 };

/* Moves the apexes, at most as many as above, to where the sheets of their polygons meet. */
void csg_apexes_improve(const csg_apex_walk *walks, int count, double cell,
                        csg_feature_probe *probe);

/* The field at the apexes; any number for those that are lost. */
void csg_apexes_ask(const csg_apex_walk *walks, int count, csg_feature_probe *probe, float *f);

/* The first of `count` apexes that holds good: the field, f, is 0 there, the sheets differ, and, if
 * there is such a one, the polygon's triangles (in *out, which begins as a copy of the polygon) do
 * not fold over. NULL: none. */
const csg_apex *csg_apexes_choose(const csg_feature_polygon *polygon, const csg_apex *apexes,
                                  const float *f, int count, const csg_marching *marching,
                                  csg_feature *out);

/* Both for one apex, from its planes on. */
bool csg_apex_find(const csg_feature_polygon *polygon, csg_apex *apex, csg_feature_probe *probe,
                   csg_feature *out);

/* Writes place and normals. */
void csg_apex_place(const csg_feature_polygon *polygon, const csg_apex *apex, csg_feature *out);

#endif
