/* SPDX-License-Identifier: MIT
 * A glTF document as csgmesh writes it: tables of what refers to what, apart from the bytes of its
 * buffer. gltf_plan.c and the compressors fill them in, gltf_json.c turns them into text.
 */
#ifndef CSG_IO_GLTF_DOCUMENT_H
#define CSG_IO_GLTF_DOCUMENT_H

#include "io/looks.h"
#include "io/writers.h"

/* glTF's own numbers for component types and buffer targets. */
enum {
    CSG_GLTF_BYTE = 5120,
    CSG_GLTF_UNSIGNED_BYTE = 5121,
    CSG_GLTF_SHORT = 5122,
    CSG_GLTF_UNSIGNED_SHORT = 5123,
    CSG_GLTF_UNSIGNED_INT = 5125,
    CSG_GLTF_FLOAT = 5126,
    CSG_GLTF_VERTICES = 34962,
    CSG_GLTF_INDICES = 34963
};

enum { CSG_GLTF_LEVELS_MOST = CSGM_DETAILS_MOST + 1 }; /* of detail, the first one too */
enum { CSG_GLTF_NONE = -1 };                           /* of what refers to a table's row */

typedef struct csg_gltf_view {
    uint64_t offset, bytes;
    uint32_t stride; /* 0 = not said; must be where several accessors of vertices share a view */
    uint32_t target; /* 0 = not said */
    /* Compressed by meshoptimizer: offset and bytes are those of what comes out, these are in the
     * file. mode NULL = not compressed. */
    const char *mode, *filter;
    uint64_t packed_offset, packed_bytes, packed_count;
    uint32_t packed_stride;
} csg_gltf_view;

typedef struct csg_gltf_accessor {
    int view; /* NONE: its values are compressed elsewhere */
    uint64_t offset, count;
    int component;
    const char *type;
    bool normalized, has_range;
    double min[3], max[3]; /* of the values in the buffer */
    /* Values that differ; sparse_count 0 = none. */
    uint64_t sparse_count;
    int sparse_places, sparse_values; /* accessors with these, whose views and offsets it takes */
} csg_gltf_accessor;

typedef struct csg_gltf_mesh {
    const char *name;                                 /* NULL = none */
    int position, normal, color, mixing, uv, indices; /* accessors; NONE = it has none */
    uint32_t material;
    int manifold, merge_places, merge_values; /* EXT_mesh_manifold; manifold NONE = not said */
    int draco_view;                           /* NONE = not compressed with Draco */
    uint32_t draco_position, draco_normal, draco_color, draco_mixing, draco_uv;
} csg_gltf_mesh;

/* Nodes are trees of two levels: a root with a matrix, and what stands in it. */
typedef struct csg_gltf_node {
    const char *name;
    bool more;               /* it goes on with the part of the node before it */
    int mesh;                /* NONE = none */
    int parent;              /* NONE: a root */
    const double *matrix;    /* 16, by columns; NULL: by the next two */
    double translation[3];   /* zero is not written */
    double scale;            /* 1 is not written */
    const csgm_level *level; /* of detail, below the first; else NULL */
} csg_gltf_node;

typedef struct csg_gltf_document {
    csg_memory *memory;
    const csgm_write_options *options;
    csg_gltf_view *views;
    csg_gltf_accessor *accessors;
    csg_gltf_mesh *meshes;
    csg_gltf_node *nodes;
    csg_part_look *materials;
    size_t view_count, accessor_count, mesh_count, node_count, material_count;
    size_t view_room, accessor_room, mesh_room, node_room, material_room;
    double matrix[16];                     /* of the roots */
    double coverage[CSG_GLTF_LEVELS_MOST]; /* down to which each level is shown */
    int image_view; /* of the texture of mixed metallic and roughness; NONE = there is none */
    uint64_t buffer_bytes;   /* of the file's buffer; 0 = there is none */
    uint64_t unpacked_bytes; /* of the buffer that stands for what meshoptimizer unpacks */
    bool draco, meshopt, quantized, has_uv;
    bool khr;             /* meshopt is KHR_meshopt_compression */
    uint32_t level_count; /* of detail; the roots are one for each */
    bool failed;          /* out of memory */
} csg_gltf_document;

void csg_gltf_document_init(csg_gltf_document *document, csg_memory *memory,
                            const csgm_write_options *options);
void csg_gltf_document_release(csg_gltf_document *document);

/* Each returns the row's number; where memory runs out document->failed is set. */
int csg_gltf_add_view(csg_gltf_document *document, csg_gltf_view view);
int csg_gltf_add_accessor(csg_gltf_document *document, csg_gltf_accessor accessor);
int csg_gltf_add_mesh(csg_gltf_document *document, csg_gltf_mesh mesh);
int csg_gltf_add_node(csg_gltf_document *document, csg_gltf_node node);
uint32_t csg_gltf_add_material(csg_gltf_document *document, const csg_part_look *look);

/* Text that grows from memory, or, where memory is NULL, stays within its capacity. */
typedef struct csg_gltf_text {
    csg_memory *memory;
    char *text;
    size_t length, capacity;
    bool failed; /* out of memory */
} csg_gltf_text;

/* Puts the document behind what is there; embedded: it ends inside the string of the buffer's data
 * URI, and csg_gltf_json_tail follows the base64. */
void csg_gltf_json(const csg_gltf_document *document, bool embedded, csg_gltf_text *text);
/* What stands behind the data of an embedded buffer, or before the buffer ends in a GLB. */
void csg_gltf_json_tail(const csg_gltf_document *document, csg_gltf_text *text);

#endif
