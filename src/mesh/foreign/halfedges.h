/* SPDX-License-Identifier: MIT
 * What OpenMesh does for meshes of others, in plain C terms (openmesh.cc; no_openmesh.c where the
 * build lacks it): fewer triangles, better ones, smoother ones. No C++ exception or type crosses
 * this header.
 */
#ifndef CSG_MESH_FOREIGN_HALFEDGES_H
#define CSG_MESH_FOREIGN_HALFEDGES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct csg_halfedge_goals {
    double within; /* > 0: no point that goes is farther from what stays; as measured at vertices */
    uint64_t triangles; /* > 0: at most so many */
    uint32_t smooth;    /* rounds */
    double
        improve; /* > 0: triangles become better, and the surface moves by about so much at most */
} csg_halfedge_goals;

/* A closed oriented manifold, or one with rims, in arrays that are changed in place: there are
 * never more vertices or triangles than at first. Lengths are those of a box of [-1, 1]. */
typedef struct csg_halfedge_mesh {
    size_t vertex_count, triangle_count;
    double (*points)[3];
    uint32_t (*corners)[3];
    const uint8_t *fixed; /* per vertex at first: it stays, and stays where it is */
    const uint8_t *seams; /* per half-edge at first, from corner k of triangle t to its next at 3 t
                             + k: colours or materials jump there; NULL: nowhere */
    const float
        *colors; /* per vertex at first, 3 in [0, 1], so far as they do not jump; NULL: none */
    double color_within; /* a channel of a vertex that goes is off by at most this */
    uint32_t *vertex_from, *triangle_from; /* what these were at first */
} csg_halfedge_mesh;

typedef struct csg_halfedge_watch {
    void *user;
    bool (*stop)(void *user);                      /* asked often */
    void (*progress)(void *user, double fraction); /* never falls */
} csg_halfedge_watch;

typedef enum csg_halfedge_result {
    CSG_HALFEDGES_DONE,
    CSG_HALFEDGES_STOPPED,
    CSG_HALFEDGES_NO_MEMORY,
    CSG_HALFEDGES_REFUSED /* a triangle that no manifold can have: the arrays are not what they
                             should be */
} csg_halfedge_result;

/* Bytes that a triangle takes beside the arrays, at most. Of a mesh of 304 732 triangles the whole
 * process took 610 to 730 a triangle more than to copy it, arrays of the mending among them. */
enum { CSG_HALFEDGE_BYTES = 640 };

bool csg_halfedges_available(void);
csg_halfedge_result csg_halfedges_reshape(csg_halfedge_mesh *mesh, const csg_halfedge_goals *goals,
                                          const csg_halfedge_watch *watch);

#ifdef __cplusplus
}
#endif
#endif
