/* SPDX-License-Identifier: MIT
 * Vertices and triangles of unknown number -> a mesh. Positions are kept in double until the end,
 * when it is known whether floats about zero suffice or the mesh needs an origin.
 */
#ifndef CSG_IO_BUILDER_H
#define CSG_IO_BUILDER_H

#include "io/read_clock.h"
#include "mesh/mesh.h"

typedef struct csg_mesh_builder {
    csgm_context *context;
    double *positions;    /* 3 per vertex */
    float *normals;       /* 3 per vertex, as long as every vertex so far came with one */
    uint8_t *colors;      /* 4 per vertex, from the first coloured one on; white before */
    uint32_t *indices;    /* 3 per triangle */
    uint16_t *materials;  /* 2 per vertex, from the first on that has others than the rest */
    uint16_t material[2]; /* of the vertices to come */
    bool says_unit;       /* the file does: */
    csgm_unit unit;
    const char *left_out; /* of the file, in the arena; NULL: nothing */
    size_t vertex_count, triangle_count;
    size_t position_room, normal_room, color_room, material_room, index_room; /* in elements */
    csgm_mesh_part *parts; /* names in the arena; counts not yet filled in */
    size_t part_count, part_room;
    csg_arena names;
    bool lacks_normals; /* a vertex came without: the mesh will have none */
    bool failed;        /* out of memory or of time; sticky */
    csg_read_clock clock;
    bool too_far; /* a coordinate is beyond what floats hold; sticky */
} csg_mesh_builder;

/* from_s: when the reading began, as csg_read_clock_start has it. */
void csg_builder_init(csg_mesh_builder *builder, csgm_context *context, double from_s);
void csg_builder_release(csg_mesh_builder *builder);

/* Room ahead for counts that are known and believed. */
bool csg_builder_reserve(csg_mesh_builder *builder, size_t vertices, size_t triangles);

/* false: out of memory or time, or 2^32 vertices. normal and color may be NULL. */
bool csg_builder_vertex(csg_mesh_builder *builder, const double position[3], const float *normal,
                        const uint8_t *color);
/* Indices must be below the vertex count by the time of csg_builder_finish. */
bool csg_builder_triangle(csg_mesh_builder *builder, uint32_t a, uint32_t b, uint32_t c);
/* The triangles to come are a part of their own; name: may be NULL, copied. Parts without triangles
 * vanish, and a single one without a name is none. */
bool csg_builder_part(csg_mesh_builder *builder, const char *name);
/* Metallic and roughness of the vertices to come; NULL: those of vertices of which nothing is said.
 */
void csg_builder_material(csg_mesh_builder *builder, const uint16_t *material);
/* What one unit is, as the file says. */
void csg_builder_unit(csg_mesh_builder *builder, csgm_unit unit);
/* What the file has and the mesh will not have, in words: all that there is to say. */
void csg_builder_leave_out(csg_mesh_builder *builder, const char *what);
/* The colours and materials of all vertices that there are, to be changed now: white and plain ones
 * where there were none. NULL = out of memory. */
uint8_t *csg_builder_colors(csg_mesh_builder *builder);
uint16_t *csg_builder_materials(csg_mesh_builder *builder);
/* An array for a normal of every vertex that there is, to be filled now; NULL = out of memory. */
float *csg_builder_normals(csg_mesh_builder *builder);

/* Of a builder that has failed: reports, and is, what it was. */
csgm_status csg_builder_why_failed(const csg_mesh_builder *builder);
/* The mesh; the builder is empty after. Reports what fails (memory and time only). */
csgm_status csg_builder_finish(csg_mesh_builder *builder, csgm_mesh **out);

#endif
