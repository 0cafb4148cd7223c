/* SPDX-License-Identifier: MIT
 * What a glTF document written by csgmesh says, apart from the bytes of its buffer: a node, a
 * mesh and a primitive for each part. gltf_json.c turns it into text, gltf_write.c fills it in and
 * streams the buffer.
 */
#ifndef CSG_IO_GLTF_LAYOUT_H
#define CSG_IO_GLTF_LAYOUT_H

#include "io/parts.h"
#include "io/writers.h"

/* glTF's own numbers for component types and buffer targets. */
enum {
    CSG_GLTF_UNSIGNED_BYTE = 5121,
    CSG_GLTF_UNSIGNED_SHORT = 5123,
    CSG_GLTF_UNSIGNED_INT = 5125,
    CSG_GLTF_FLOAT = 5126,
    CSG_GLTF_VERTICES = 34962,
    CSG_GLTF_INDICES = 34963
};

/* A part is a node, a mesh and a primitive. */
typedef struct csg_gltf_part {
    const char *name; /* NULL = none */
    uint64_t first_vertex, vertex_count, first_index, index_count;
    float min[3], max[3]; /* of the floats written */
    bool opaque;
    bool textured;        /* metallic and roughness by the texture, else by these factors */
    uint16_t material[2]; /* in 1 / CSG_MATERIAL_ONE */
    uint32_t material_index;
    csg_draco_encoded draco; /* compressed: its bytes, at draco_at in the buffer */
    uint64_t draco_at;
} csg_gltf_part;

typedef struct csg_gltf_layout {
    uint64_t vertex_count, index_count; /* index_count 0: a scene without a mesh, no buffer */
    bool normals, colors, textured;     /* textured: some part is */
    bool wide_colors;                   /* 16-bit */
    bool short_indices;
    bool compressed;
    const csg_gltf_part *parts; /* part_count of them; NULL = `only` */
    uint64_t part_count;
    csg_gltf_part only;
    double matrix[16];   /* column-major; identity is not written */
    const char *comment; /* or NULL */
    /* in this order in the buffer; the texture's coordinates stand behind the colours */
    uint64_t position_bytes, normal_bytes, color_bytes, coordinate_bytes, index_bytes, image_bytes;
    uint64_t buffer_bytes; /* the sum, with index_bytes padded to four */
} csg_gltf_layout;

static inline const csg_gltf_part *csg_gltf_part_at(const csg_gltf_layout *layout, uint64_t index)
{
    return layout->parts ? &layout->parts[index] : &layout->only;
}

enum { CSG_GLTF_JSON_MOST = 8192 }; /* of a document with one part without a name */

/* Text that grows from memory, or, where memory is NULL, stays within its capacity. */
typedef struct csg_gltf_text {
    csg_memory *memory;
    char *text;
    size_t length, capacity;
    bool failed; /* out of memory */
} csg_gltf_text;

/* Puts the document behind what is there; embedded: it ends inside the string of the buffer's data
 * URI, and csg_gltf_json_tail follows the base64. */
void csg_gltf_json(const csg_gltf_layout *layout, bool embedded, csg_gltf_text *text);
extern const char csg_gltf_json_tail[];

/* The parts of the plain buffer, from counts and which arrays there are. */
csg_gltf_layout csg_gltf_measure(const csgm_mesh_view *mesh);
/* The node's matrix, columns of scale * rotation * translate(origin); the rotation takes (x, y, z)
 * to (x, z, -y). */
void csg_gltf_place(csg_gltf_layout *layout, const csgm_vec3 *origin,
                    const csgm_write_options *options);

/* A vertex's metallic or roughness as coordinate of the mixing texture (gltf_write.c): one side of
 * it, from the centre of the first pixel to that of the second. */
static inline uint32_t csg_gltf_coordinate(uint16_t value)
{
    return (uint32_t)(65535.0 * (0.25 + 0.5 * value / CSG_MATERIAL_ONE) + 0.5);
}

/* Compresses each part into parts[i].draco and counts the buffer anew. */
csgm_status csg_gltf_compress(csg_sink *sink, csg_gltf_layout *layout, csg_gltf_part *parts,
                              const csgm_mesh_view *mesh, const csgm_write_options *options);

/* ---- GLB -------------------------------------------------------------------------- */

#define CSG_GLB_MOST UINT32_MAX /* bytes of a file */
enum {
    CSG_GLB_HEAD_MOST = 12 + 8 + 8, /* the head without its JSON */
    /* A plain GLB's JSON chunk is filled up with spaces to this, so that the buffer's place in the
     * file (4096) is known before the numbers in the JSON are. */
    CSG_GLB_JSON_BYTES = 4096 - CSG_GLB_HEAD_MOST
};
/* The JSON chunk's bytes, padded. */
void csg_glb_json(const csg_gltf_layout *layout, csg_gltf_text *text);
uint64_t csg_glb_bytes(const csg_gltf_layout *layout, size_t json_bytes);
/* Header and the JSON chunk's own; what stands between that and the buffer. Each returns the place
 * after. */
uint8_t *csg_glb_put_head(uint8_t *at, const csg_gltf_layout *layout, size_t json_bytes);
uint8_t *csg_glb_put_body_head(uint8_t *at, const csg_gltf_layout *layout);

#endif
