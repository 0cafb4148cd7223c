/* SPDX-License-Identifier: MIT
 * A mesh as glTF has it: shapes (a mesh and a primitive each) and the nodes that show them; and
 * where each byte of the plain buffer stands. gltf_write.c and glb_stream.c fill it in.
 *
 * The buffer, in this order: positions, normals, indices, places and values of merges, colours, two
 * kinds of texture coordinates, the texture of mixed materials. Colours come late so that a stream
 * that has seen one colour only can leave them out.
 */
#ifndef CSG_IO_GLTF_PLAN_H
#define CSG_IO_GLTF_PLAN_H

#include "io/gltf/gltf_document.h"

/* What becomes a mesh of its own. */
typedef struct csg_gltf_shape {
    const char *name; /* NULL = none */
    uint64_t first_vertex, vertex_count, first_index, index_count;
    float min[3], max[3]; /* of the floats written */
    csg_part_look look;
    uint64_t merge_count; /* indices that name another vertex of their place; 0 = not said */
    /* bytes from the buffer's begin, where it is not compressed */
    uint64_t index_at, merge_at, color_at, mixing_at;
} csg_gltf_shape;

/* A shape where it is shown; several may show one. */
typedef struct csg_gltf_show {
    size_t shape;
    const char *name;
    csgm_vec3 shift; /* added to its vertices */
    bool more;       /* of the part that the show before it is of */
    uint32_t level;  /* of detail; those of one level stand together */
} csg_gltf_show;

typedef struct csg_gltf_source {
    csgm_mesh_view mesh;
    const float *uv;          /* 2 * vertex_count, or NULL */
    const uint32_t *merge_to; /* each vertex's first copy at its place, or NULL */
    csg_gltf_shape *shapes;
    csg_gltf_show *shows;
    size_t shape_count, show_count;
    csg_arena arena; /* shapes, shows, and what of the mesh's arrays is not borrowed */
} csg_gltf_source;

/* Where the sections of the plain buffer begin. */
typedef struct csg_gltf_sections {
    uint64_t normals, indices, merges, colors, mixing, uv, image, end;
} csg_gltf_sections;

/* 65535 itself would be the primitive restart value. */
static inline bool csg_gltf_is_short(const csg_gltf_shape *shape)
{
    return shape->vertex_count <= UINT16_MAX;
}

static inline uint64_t csg_gltf_padded(uint64_t bytes)
{
    return (bytes + 3) & ~(uint64_t)3;
}

/* Places of merges are places among a shape's indices. */
static inline uint64_t csg_gltf_place_bytes(const csg_gltf_shape *shape)
{
    return shape->index_count <= UINT16_MAX ? 2 : 4;
}

/* Gives each shape its places in the buffer. */
csg_gltf_sections csg_gltf_place_sections(csg_gltf_source *source);
/* The tables of a document whose buffer is plain. */
void csg_gltf_plan(csg_gltf_document *document, const csg_gltf_source *source,
                   const csg_gltf_sections *sections);
/* The roots and what stands in them; meshes are in the order of shapes. */
void csg_gltf_add_nodes(csg_gltf_document *document, const csg_gltf_source *source,
                        const double *scales, const csgm_vec3 *shifts);
/* A mesh that has nothing yet but its name and material. */
csg_gltf_mesh csg_gltf_new_mesh(csg_gltf_document *document, const csg_gltf_shape *shape);

/* A vertex's metallic or roughness as coordinate of the mixing texture: one side of it, from the
 * centre of the first pixel to that of the second. */
static inline uint32_t csg_gltf_coordinate(uint16_t value)
{
    return (uint32_t)(65535.0 * (0.25 + 0.5 * value / CSG_MATERIAL_ONE) + 0.5);
}
/* The texture's file, padded to four bytes. */
enum { CSG_GLTF_MIXING_BYTES = 72 };
extern const uint8_t csg_gltf_mixing_texture[CSG_GLTF_MIXING_BYTES];
/* Of unit length; (0, 0, 1) where there is no direction. */
void csg_gltf_unit_normal(const float n[3], float out[3]);
bool csg_gltf_is_mixed(const csg_gltf_source *source); /* some shape needs it */

/* ---- GLB -------------------------------------------------------------------------- */

#define CSG_GLB_MOST UINT32_MAX /* bytes of a file */
enum {
    CSG_GLB_HEAD_MOST = 12 + 8 + 8, /* the head without its JSON */
    /* A plain GLB's JSON chunk is filled up with spaces to this, so that the buffer's place in the
     * file (4096) is known before the numbers in the JSON are. */
    CSG_GLB_JSON_BYTES = 4096 - CSG_GLB_HEAD_MOST
};
/* The JSON chunk's bytes, padded. */
void csg_glb_json(const csg_gltf_document *document, csg_gltf_text *text);
uint64_t csg_glb_bytes(const csg_gltf_document *document, size_t json_bytes);
/* Header and the JSON chunk's own; what stands between that and the buffer. Each returns the place
 * after. */
uint8_t *csg_glb_put_head(uint8_t *at, const csg_gltf_document *document, size_t json_bytes);
uint8_t *csg_glb_put_body_head(uint8_t *at, const csg_gltf_document *document);

#endif
