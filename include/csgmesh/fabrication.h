/* SPDX-License-Identifier: MIT
 *
 * What a workshop asks of a solid: the smallest box that it is cut from, its thinnest wall and its
 * narrowest gap, faces that overhang. Options, statuses and what is left after a limit are those of
 * csgm_measure_field and csgm_measure_mesh (csgmesh.h); proofs are in docs/measure.md.
 */
#ifndef CSGMESH_FABRICATION_H
#define CSGMESH_FABRICATION_H

#include "csgmesh/csgmesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- oriented boxes ---------------------------------------------------------------- */

/* A box in any orientation that the solid lies in and nearly touches on all sides. That it does is
 * proven; that no smaller one is turned otherwise is not: it is the smallest that was found. */
typedef struct csgm_oriented_box {
    uint32_t struct_size;   /* set by csgm_oriented_box_default; do not touch */
    bool is_reached;        /* all ends are known to the tolerance */
    uint64_t cubes;         /* looked at; 0 of a mesh */
    csgm_vec3 axes[3];      /* along its edges, of unit length, at right angles, that of the longest
                               edge first; the largest component is positive */
    csgm_interval edges[3]; /* their lengths */
    csgm_interval volume;
    csgm_interval ends[6]; /* the least of axes[k] . x over the solid, then the largest: the solid
                              lies between the outer ends of these for certain */
} csgm_oriented_box;

/* All zeros but struct_size. */
CSGM_API csgm_oriented_box csgm_oriented_box_default(void);

/* Each end is known to tolerance times the longest side of the scene's bounds. */
CSGM_API csgm_status csgm_oriented_box_of_field(csgm_context *context, const csgm_field *field,
                                                const csgm_measure_options *options,
                                                csgm_oriented_box *out);

/* Of all vertices that triangles have, exact but for rounding. The mesh need not be closed.
 * CSGM_ERR_FORMAT (reported): a coordinate is not finite or an index out of range. */
CSGM_API csgm_status csgm_oriented_box_of_mesh(csgm_context *context, const csgm_mesh_view *mesh,
                                               const csgm_measure_options *options,
                                               csgm_oriented_box *out);

/* ---- walls and gaps ---------------------------------------------------------------- */

/* A wall is a segment inside the solid from one point of its surface to another one, a gap one
 * outside, where the surface's normal at either end is within angle_deg of the segment. Where faces
 * meet in an edge or corner, all directions between their normals are normals. So an edge is no
 * wall of thickness zero, unless its faces are less than twice the angle apart. */
typedef struct csgm_wall_options {
    uint32_t struct_size; /* set by csgm_wall_options_default; do not touch */
    double tolerance;     /* how closely lengths are to be known, as a share of the longest side of
                             the bounds; 0 (the default): 1e-4, but no closer than a 32nd of each */
    double finest;        /* a length: where normals are not known closely, as at the tip of a cone,
                             shorter segments are not looked for; 0 (the default): a 500th of the
                             longest side */
    double angle_deg;     /* above 0, at most 40, default 30 */
    const char *part;     /* of this name alone; NULL (default): all of it */
    uint64_t most_pairs;  /* > 0, default 2^21: of pieces of the surface that are looked at, for
                             walls, and again for gaps; about a million a second */
    csgm_monitor monitor; /* stage CSGM_STAGE_MEASURE */
} csgm_wall_options;

CSGM_API csgm_wall_options csgm_wall_options_default(void);

typedef struct csgm_span {
    csgm_interval
        length;        /* of the shortest segment; both ends infinite: there is none for certain */
    double overlooked; /* 0, or the length below which some places were not looked at for it */
    bool is_shown;     /* two points are known that are length.high apart */
    csgm_vec3 at[2];   /* these, just beyond the surface on either side: outside of a wall, inside
                          beside a gap */
} csgm_span;

typedef struct csgm_walls {
    uint32_t struct_size; /* set by csgm_walls_default; do not touch */
    bool is_reached;      /* both as closely as the tolerance asks */
    uint64_t pairs;       /* looked at */
    csgm_span wall, gap;  /* the thinnest, the narrowest */
} csgm_walls;

/* All zeros but struct_size. */
CSGM_API csgm_walls csgm_walls_default(void);

/* No wall is thinner and no gap narrower than length.low: that is proven. length.high is shown by
 * two points; that the solid, or air, is between them follows from the field's Lipschitz constant,
 * and their normals are what floats say, those where faces meet within half of the tolerance.
 * Statuses are those of csgm_measure_field. */
CSGM_API csgm_status csgm_walls_of_field(csgm_context *context, const csgm_field *field,
                                         const csgm_wall_options *options, csgm_walls *out);

/* ---- faces of meshes --------------------------------------------------------------- */

typedef struct csgm_face_options {
    uint32_t struct_size; /* set by csgm_face_options_default; do not touch */
    csgm_vec3 up;        /* against gravity while it is printed, or how a mould opens; of any length
                            > 0, default (0, 0, 1) */
    double overhang_deg; /* above 0, below 90, default 45: a face overhangs where it looks down and
                            its plane is within so many degrees of the level one */
    double draft_deg; /* above 0, below 90, default 1: a wall has draft where its plane is at least
                         so many degrees from `up` */
    const char *part; /* of this name alone; NULL (default): all of it */
} csgm_face_options;

CSGM_API csgm_face_options csgm_face_options_default(void);

/* Areas by direction, each between bounds that include all rounding. */
typedef struct csgm_faces {
    uint32_t struct_size;   /* set by csgm_faces_default; do not touch */
    csgm_interval area;     /* of all faces */
    csgm_interval overhang; /* of those that overhang, the lowest level ones included */
    csgm_interval
        resting;         /* of these: in the level plane of the lowest vertex, what it stands on */
    csgm_interval steep; /* of those within less than draft_deg of `up`: walls without draft */
    uint64_t overhang_triangles, steep_triangles;
} csgm_faces;

/* All zeros but struct_size. */
CSGM_API csgm_faces csgm_faces_default(void);

/* Of each triangle, by its normal. options NULL = defaults. CSGM_ERR_ARGUMENT: an option out of
 * range, or no part has that name. CSGM_ERR_FORMAT (reported): a coordinate is not finite or an
 * index out of range. CSGM_ERR_SCENE (reported): there are no triangles. */
CSGM_API csgm_status csgm_faces_of_mesh(csgm_context *context, const csgm_mesh_view *mesh,
                                        const csgm_face_options *options, csgm_faces *out);

/* The same of a field's surface, between bounds that are proven, without a mesh. What rests is
 * within 0.1 degrees of level there, and within a 10 000th of the longest side of the bounds of the
 * lowest point. The ends of intervals are infinite where nothing bounds how gradients turn.
 * how NULL = defaults: ten times its tolerance is how closely areas are to be known, as a share of
 * the whole one, and half of most_cubes are looked at for each; its density and part are not
 * asked for. Triangles are 0. Statuses are those of csgm_measure_field. */
CSGM_API csgm_status csgm_faces_of_field(csgm_context *context, const csgm_field *field,
                                         const csgm_face_options *options,
                                         const csgm_measure_options *how, csgm_faces *out);

#ifdef __cplusplus
}
#endif
#endif
