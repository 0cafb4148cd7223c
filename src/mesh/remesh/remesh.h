/* SPDX-License-Identifier: MIT
 * A finished mesh while it is being changed against its field: connectivity, places in the field's
 * frame, what kind of vertex each is, and the checks that every change must pass.
 * reshape/decimate.c collapses edges, reshape/improve.c moves vertices and flips edges,
 * reshape/tolerance.c decides and writes the result back.
 */
#ifndef CSG_MESH_REMESH_REMESH_H
#define CSG_MESH_REMESH_REMESH_H

#include "mesh/mesh.h"
#include "mesh/remesh/corners.h"
#include "mesh/remesh/crossing.h"
#include "mesh/remesh/probe.h"
#include "mesh/remesh/triangle.h"
#include "mesh/watch.h"

typedef enum csg_vertex_kind {
    CSG_VERTEX_SMOOTH,
    CSG_VERTEX_CREASE, /* moves along its crease only */
    CSG_VERTEX_CORNER  /* stays */
} csg_vertex_kind;

typedef struct csg_look_at_vertex {
    uint8_t color[4];
    uint16_t material[2];
} csg_look_at_vertex;

typedef struct csg_remesh {
    csgm_context *context;
    csg_memory *memory; /* the context's */
    csg_mesh_watch *watch;
    const csg_marching *marching;
    csgm_mesh
        *mesh; /* the arrays it was made of; csg_remesh_write_back puts others in their place */
    csg_probe probe;
    csg_corners corners;
    csg_triangle_tree tree;    /* of these, kept true by whoever changes them */
    csg_vec3 *at;              /* per vertex, field frame */
    uint8_t *kind;             /* per vertex: csg_vertex_kind */
    csg_look_at_vertex *looks; /* per vertex; NULL: the mesh has neither colours nor materials */
    bool is_own;               /* it began with triangles of polyhedra */
    uint32_t closing;          /* of its triangles, the first: csg_remesh_origin */
    double cell;               /* edge of a cell */
    double error;              /* that changes may make: distance both ways */
} csg_remesh;

/* Where a mesh comes from. */
typedef struct csg_remesh_origin {
    bool is_own;      /* triangles are polyhedra's, slivers among them true */
    uint32_t closing; /* the first triangles only close a part of a mesh (close.h): they are none of
                         the surface's, and whoever changes the mesh keeps away from them */
    const uint8_t *kinds; /* per vertex, as they were found before; NULL: they are to be found */
} csg_remesh_origin;

/* Of a mesh, which loses its vertices and triangles unless it is own, and whose creases are found
 * by angle: where triangles that lie on the surface meet at 20 degrees or more, and, where cells
 * follow the shape, the field turns there and not beside it. marching: as it was made, with its
 * blocks at hand. CSGM_OK, CSGM_ERR_MEMORY or CSGM_ERR_INTERNAL: not a closed manifold. */
csgm_status csg_remesh_begin(csg_remesh *remesh, csgm_mesh *mesh, const csg_remesh_origin *origin,
                             const csg_marching *marching, csg_mesh_watch *watch);
void csg_remesh_end(csg_remesh *remesh);
/* The mesh as it is now as new arrays in place of remesh->mesh, which is destroyed; gaps in the
 * numbers are closed. split: a vertex for each sheet at creases and corners. */
csgm_status csg_remesh_write_back(csg_remesh *remesh, bool normals, bool split);

/* Looks at creases and corners once more, when triangles are few and large: a corner at which they
 * show nothing but a straight crease is one of it, and where all is plane there is neither. No kind
 * grows. False: stopped, or without memory; the watch knows. */
bool csg_remesh_ease_kinds(csg_remesh *remesh);

/* Where a vertex of the mesh that it began with was, field frame. */
csg_vec3 csg_remesh_first_place(const csg_remesh *remesh, uint32_t vertex);
/* Whether a triangle is one of those that it began with, in its place. */
bool csg_remesh_is_as_begun(const csg_remesh *remesh, uint32_t triangle);

static inline csg_vec3 csg_remesh_corner(const csg_remesh *remesh, uint32_t c)
{
    return remesh->at[remesh->corners.vertex[c]];
}

static inline csg_vec3 csg_remesh_centroid(const csg_remesh *remesh, uint32_t triangle)
{
    csg_vec3 sum = csg_vec3_add(csg_remesh_corner(remesh, 3 * triangle),
                                csg_vec3_add(csg_remesh_corner(remesh, 3 * triangle + 1),
                                             csg_remesh_corner(remesh, 3 * triangle + 2)));
    return csg_vec3_make(sum.x / 3, sum.y / 3, sum.z / 3);
}

/* The field at the centroids of all triangles, or, if `wanted` is not NULL, of those t with
 * wanted[t]; out[t] of others, and of one that is gone, stays as it is. */
void csg_remesh_values_at_centroids(csg_remesh *remesh, const uint8_t *wanted, float *out);
/* What only a fiftieth of the values exceed, 0 of none; they get sorted. */
double csg_remesh_common_value(float *values, size_t count);

/* Whether the edge that starts at this corner belongs to a crease: both ends do and its triangles
 * meet at an angle. */
bool csg_remesh_is_crease(const csg_remesh *remesh, uint32_t corner);

/* The nearest place on the surface, by Newton's steps along the gradient. False: none within
 * `reach`. */
bool csg_remesh_project(csg_remesh *remesh, csg_vec3 *at, double reach);
/* The same to a thousandth of the error, with fewer questions: the gradient is asked once. */
bool csg_remesh_come_to_surface(csg_remesh *remesh, csg_vec3 *at, double reach);
csg_look_at_vertex csg_remesh_look(csg_remesh *remesh, csg_vec3 at);

/* Whether triangles (a[i], b[i], c[i]) lie within `error` of the surface at evenly spread points: a
 * step along the normal leads outside, the same step back inside. So a triangle faces outward, and
 * two sheets that face each other cannot cross: each keeps to its half of the room between them.
 * seen: points of each triangle that are not looked at (csg_bracket_bit); NULL: all are. */
bool csg_remesh_brackets(csg_remesh *remesh, const csg_vec3 (*triangles)[3], const uint16_t *seen,
                         size_t count);

enum { CSG_BRACKET_MOST_SPLIT = 3 };

/* Into how many parts each side of a triangle is cut there, whose longest one has this square. */
static inline int csg_bracket_split(const csg_remesh *remesh, double longest)
{
    double one = 1.5 * remesh->cell;
    return longest <= one * one ? 1 : longest <= 4 * one * one ? 2 : CSG_BRACKET_MOST_SPLIT;
}
/* In `seen`: the point between i / split and (i + 1) / split of the way to the second corner, and j
 * and j + 1 to the third. */
static inline uint16_t csg_bracket_bit(int i, int j)
{
    return (uint16_t)(1u << (CSG_BRACKET_MOST_SPLIT * i + j));
}

#endif
