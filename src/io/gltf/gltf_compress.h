/* SPDX-License-Identifier: MIT
 * Compressed buffers of glTF: pieces of bytes, and the document's tables that say what they are.
 */
#ifndef CSG_IO_GLTF_COMPRESS_H
#define CSG_IO_GLTF_COMPRESS_H

#include "io/gltf/gltf_plan.h"

/* A piece of the buffer; the next begins at a multiple of four bytes. */
typedef struct csg_gltf_piece {
    const uint8_t *bytes;
    size_t size_bytes;
    csg_draco_encoded draco; /* whose bytes they are, or nothing */
    void *owned;             /* owned_bytes from memory, or NULL */
    size_t owned_bytes;
} csg_gltf_piece;

typedef struct csg_gltf_pieces {
    csg_memory *memory;
    csg_gltf_piece *pieces;
    size_t count, room;
    uint64_t end; /* of the last one, padded */
} csg_gltf_pieces;

/* Takes what the piece owns, also when it fails: out of memory, not reported. */
bool csg_gltf_add_piece(csg_gltf_pieces *pieces, csg_gltf_piece piece);
void csg_gltf_pieces_release(csg_gltf_pieces *pieces);

/* Each shape as a mesh of Draco's, on one grid for all. */
csgm_status csg_gltf_compress_draco(csg_sink *sink, csg_gltf_document *document,
                                    const csg_gltf_source *source, csg_gltf_pieces *pieces);

/* Each shape's arrays by meshoptimizer, quantised on one grid for all. */
csgm_status csg_gltf_compress_meshopt(csg_sink *sink, csg_gltf_document *document,
                                      const csg_gltf_source *source, csg_gltf_pieces *pieces);

#endif
