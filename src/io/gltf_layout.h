/* SPDX-License-Identifier: MIT
 * What a glTF document written by csgmesh says, apart from the bytes of its buffer: one node, one
 * mesh, one primitive. gltf_json.c turns it into text, gltf_write.c fills it in and streams the
 * buffer.
 */
#ifndef CSG_IO_GLTF_LAYOUT_H
#define CSG_IO_GLTF_LAYOUT_H

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

typedef struct csg_gltf_layout {
    uint64_t vertex_count, index_count; /* index_count 0: a scene without a mesh, no buffer */
    bool normals, colors, opaque;
    bool wide_colors; /* 16-bit */
    bool short_indices;
    const csg_draco_encoded *draco; /* NULL = plain */
    float min[3], max[3];           /* of the floats written */
    double matrix[16];              /* column-major; identity is not written */
    uint64_t position_bytes, normal_bytes, color_bytes,
        index_bytes;       /* in this order in the buffer */
    uint64_t buffer_bytes; /* the sum, with index_bytes padded to four */
} csg_gltf_layout;

enum { CSG_GLTF_JSON_MOST = 8192 };

/* Writes the document into text; embedded: it ends inside the string of the buffer's data URI, and
 * csg_gltf_json_tail follows the base64. Returns its length. */
size_t csg_gltf_json(const csg_gltf_layout *layout, bool embedded, char text[CSG_GLTF_JSON_MOST]);
extern const char csg_gltf_json_tail[];

/* The parts of the plain buffer, from counts and which arrays there are. */
csg_gltf_layout csg_gltf_measure(const csgm_mesh_view *mesh);
/* The node's matrix, columns of scale * rotation * translate(origin); the rotation takes (x, y, z)
 * to (x, z, -y). */
void csg_gltf_place(csg_gltf_layout *layout, const csgm_vec3 *origin,
                    const csgm_write_options *options);

/* ---- GLB -------------------------------------------------------------------------- */

#define CSG_GLB_MOST UINT32_MAX /* bytes of a file */
enum {
    CSG_GLB_HEAD_MOST = 12 + 8 + 8, /* the head without its JSON */
    /* A plain GLB's JSON chunk is filled up with spaces to this, so that the buffer's place in the
     * file (4096) is known before the numbers in the JSON are. */
    CSG_GLB_JSON_BYTES = 4096 - CSG_GLB_HEAD_MOST
};
/* The JSON chunk's bytes, padded; returns their number. text has room for CSG_GLTF_JSON_MOST + 4.
 */
size_t csg_glb_json(const csg_gltf_layout *layout, char *text);
uint64_t csg_glb_bytes(const csg_gltf_layout *layout, size_t json_bytes);
/* Header, JSON chunk and the head of the binary chunk; returns the place after. */
uint8_t *csg_glb_put_head(uint8_t *at, const csg_gltf_layout *layout, const char *json,
                          size_t json_bytes);

#endif
