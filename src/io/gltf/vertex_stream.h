/* SPDX-License-Identifier: MIT
 * Compressed vertices of version 1, which KHR_meshopt_compression has beside those of version 0 and
 * Debian's meshoptimizer 0.18 does not know. Written from appendices A and B of the extension.
 *
 * Each byte of a vertex is a row of differences to the vertex before, in blocks of up to 256
 * vertices. What a difference is, is told for each four bytes: that of bytes, of pairs, or bits
 * that have changed. A row is left out where it is 0, or stored as it is, or in groups of 16 that
 * each have as many bits a value as they need; what does not fit follows the group.
 */
#ifndef CSG_IO_GLTF_VERTEX_STREAM_H
#define CSG_IO_GLTF_VERTEX_STREAM_H

#include <stdbool.h>
#include <stdint.h>

/* Whether bytes begin as a stream of version 1 does. */
bool csg_vertex_stream_is_one(const uint8_t *bytes, uint64_t size);

/* stride: a multiple of 4 up to 256; out: count * stride bytes. False: it is broken. */
bool csg_vertex_stream_decode(const uint8_t *bytes, uint64_t size, uint64_t count, uint64_t stride,
                              uint8_t *out);

/* Bytes that csg_vertex_stream_encode may need, and those that it has written. */
uint64_t csg_vertex_stream_bound(uint64_t count, uint64_t stride);
uint64_t csg_vertex_stream_encode(const uint8_t *data, uint64_t count, uint64_t stride,
                                  uint8_t *out);

/* The filter COLOR: luma and chroma of count colours become RGBA of bytes (stride 4) or pairs of
 * bytes (8). */
void csg_color_filter_decode(uint8_t *colors, uint64_t count, uint64_t stride);

#endif
