/* SPDX-License-Identifier: MIT
 * Compressed vertices of version 1 (io/gltf/vertex_stream.h): streams that meshoptimizer 1.3 wrote,
 * what is written reads back, and what is broken is refused without reading beyond its end.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "io/gltf/vertex_stream.h"

enum { SMOOTH_BYTES, SMOOTH_PAIRS, FLOATS, ROUGH_BYTES, KINDS };

static uint32_t state;

static uint32_t next(void)
{
    state = state * 1664525u + 1013904223u;
    return state >> 16;
}

static void store_little_endian(uint8_t *at, uint32_t value, int bytes)
{
    for (int i = 0; i < bytes; i++)
        at[i] = (uint8_t)(value >> 8 * i);
}

/* As they were made for the streams below. */
static void make(uint8_t *data, uint32_t count, uint32_t stride, int kind)
{
    state = 1;
    for (uint32_t i = 0; i < count; i++) {
        uint8_t *at = data + i * stride;
        for (uint32_t k = 0; k < stride && kind == SMOOTH_BYTES; k++)
            at[k] = (uint8_t)(i * 3 * (k + 1) + (next() & 7));
        for (uint32_t k = 0; k < stride && kind == SMOOTH_PAIRS; k += 2)
            store_little_endian(at + k, 5000 + i * (41 + k) - (next() & 63), 2);
        for (uint32_t k = 0; k < stride && kind == FLOATS; k += 4)
            store_little_endian(at + k, 0x3f800000 + (i >> 3) * 0x100000 + ((next() & 15) << 12),
                                4);
        for (uint32_t k = 0; k < stride && kind == ROUGH_BYTES; k++)
            at[k] = (uint8_t)(k == 1 ? next() & 255 : k == 2 ? next() & 1 : 7);
    }
}

static const struct {
    uint32_t count, stride, size;
    const uint8_t *bytes;
} streams[KINDS] = {
    {33, 4, 145,
     (const uint8_t[]){
         0xa1, 0xf5, 0x0a, 0x06, 0x6f, 0x1e, 0x10, 0xa8, 0xa3, 0xe0, 0xc6, 0x14, 0x84, 0x83, 0xa8,
         0x66, 0x28, 0xe5, 0xfa, 0x5e, 0x10, 0x01, 0x00, 0x04, 0x0a, 0x0c, 0xf4, 0xf4, 0xf6, 0xfc,
         0x4f, 0x0c, 0xf2, 0x16, 0x16, 0x14, 0x10, 0x16, 0x1a, 0xfc, 0x4a, 0xef, 0x4e, 0xcc, 0x8f,
         0xcf, 0x1f, 0x14, 0x16, 0x10, 0x12, 0x10, 0x01, 0x00, 0x12, 0x00, 0x12, 0x10, 0x12, 0x16,
         0x12, 0x04, 0x16, 0x12, 0x14, 0x12, 0x0c, 0x1a, 0x18, 0x0c, 0x16, 0x0c, 0x0e, 0x1e, 0x12,
         0x0a, 0x16, 0x0e, 0x0e, 0x12, 0x10, 0x18, 0x10, 0x12, 0x10, 0x18, 0x14, 0x10, 0x00, 0x16,
         0x14, 0x18, 0x22, 0x12, 0x18, 0x16, 0x1e, 0x1c, 0x16, 0x16, 0x12, 0x18, 0x1a, 0x16, 0x1e,
         0x14, 0x18, 0x16, 0x16, 0x20, 0x1c, 0x18, 0x12, 0x1e, 0x0c, 0x18, 0x1a, 0x1a, 0x22, 0x0a,
         0x18, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
         0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x06, 0x03, 0x00}},
    {40, 8, 187,
     (const uint8_t[]){
         0xa1, 0xbb, 0xbb, 0x00, 0x02, 0x42, 0x54, 0x7a, 0x8a, 0x15, 0xa8, 0x5e, 0x40, 0x1e, 0x5c,
         0x7a, 0x08, 0xbc, 0x52, 0x30, 0x44, 0x20, 0x6c, 0x5e, 0x50, 0x32, 0x82, 0x66, 0x10, 0x4a,
         0x7e, 0x28, 0x5e, 0x4e, 0x3a, 0x84, 0x20, 0x98, 0x18, 0x5a, 0xb0, 0x10, 0x76, 0x00, 0x36,
         0x3c, 0x9e, 0x03, 0xae, 0x3e, 0x03, 0x62, 0xa6, 0x3e, 0x4c, 0x32, 0x86, 0x18, 0x70, 0x4e,
         0xa6, 0x2e, 0x48, 0x94, 0x13, 0x5e, 0xb4, 0x19, 0xb6, 0x0a, 0x92, 0x26, 0x60, 0x94, 0x42,
         0x30, 0x50, 0x58, 0x28, 0x64, 0x64, 0xb6, 0x22, 0x00, 0x5a, 0x4c, 0x3a, 0x36, 0xba, 0x08,
         0xc6, 0x15, 0xc8, 0x0a, 0xb0, 0x12, 0x64, 0x30, 0x56, 0x90, 0x6e, 0x5e, 0x1a, 0x42, 0xc6,
         0x11, 0x5e, 0x8a, 0x4c, 0x44, 0x7c, 0x4a, 0x5c, 0x44, 0x58, 0x5c, 0x5e, 0x44, 0xd4, 0x26,
         0x2a, 0xac, 0x4c, 0x00, 0x80, 0x62, 0x6e, 0x74, 0x34, 0x6e, 0x50, 0x88, 0x3a, 0x80, 0x70,
         0x14, 0x6e, 0x7c, 0x30, 0x78, 0x32, 0xbe, 0x0f, 0x90, 0x66, 0x2a, 0x8e, 0x44, 0x68, 0x9a,
         0x6e, 0x13, 0x9c, 0x74, 0x6c, 0x6e, 0x5c, 0x14, 0x6a, 0x26, 0x8e, 0x5c, 0x48, 0x00, 0x00,
         0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x80, 0x13, 0x80,
         0x13, 0x72, 0x13, 0x55, 0x13, 0x01, 0x01}},
    {50, 4, 72,
     (const uint8_t[]){0xa1, 0x5a, 0x2a, 0x00, 0xe5, 0x38, 0xe4, 0xad, 0x8d, 0x76, 0xc5, 0xbd,
                       0x12, 0xa5, 0xdd, 0x95, 0x62, 0xab, 0x93, 0xbf, 0xf6, 0xfe, 0xed, 0x34,
                       0x26, 0x56, 0xe4, 0x0f, 0x0f, 0x0f, 0x02, 0x00, 0x04, 0x00, 0x00, 0x01,
                       0x01, 0x01, 0x01, 0x03, 0x01, 0x01, 0x01, 0x07, 0x01, 0x01, 0x00, 0x03,
                       0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
                       0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x80, 0x80, 0x3f, 0x42}},
    {37, 4, 75,
     (const uint8_t[]){0xa1, 0x9e, 0x00, 0xe3, 0x4b, 0xcc, 0x3b, 0x35, 0x34, 0x13, 0x6c, 0xb8, 0xef,
                       0x6f, 0x58, 0x05, 0x30, 0x1b, 0x90, 0x1f, 0x4d, 0x9f, 0x54, 0xfc, 0x05, 0xb0,
                       0xd7, 0x20, 0x55, 0xcc, 0xca, 0x60, 0x5f, 0xe4, 0xc1, 0xf3, 0xfd, 0x6a, 0xc8,
                       0x05, 0x24, 0x99, 0x24, 0x08, 0x19, 0x84, 0x26, 0x12, 0x01, 0x00, 0x01, 0x00,
                       0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
                       0x00, 0x00, 0x00, 0x00, 0x00, 0x07, 0x88, 0x00, 0x07, 0x00}},
};

static void test_streams_of_others(void **state_)
{
    (void)state_;
    for (int kind = 0; kind < KINDS; kind++) {
        uint8_t wanted[512], found[512];
        uint64_t bytes = (uint64_t)streams[kind].count * streams[kind].stride;
        make(wanted, streams[kind].count, streams[kind].stride, kind);
        assert_true(csg_vertex_stream_is_one(streams[kind].bytes, streams[kind].size));
        assert_true(csg_vertex_stream_decode(streams[kind].bytes, streams[kind].size,
                                             streams[kind].count, streams[kind].stride, found));
        assert_memory_equal(found, wanted, bytes);
    }
}

/* All counts around groups and blocks, all strides; no more bytes than that of others takes. */
static void test_round_trip(void **state_)
{
    static const uint32_t counts[] = {1, 2, 15, 16, 17, 255, 256, 257, 1000};
    (void)state_;
    for (int kind = 0; kind < KINDS; kind++) {
        for (uint32_t stride = 4; stride <= 256; stride = stride < 16 ? stride + 4 : stride * 2)
            for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
                size_t bytes = (size_t)counts[i] * stride;
                uint64_t bound = csg_vertex_stream_bound(counts[i], stride);
                uint8_t *data = malloc(bytes), *out = malloc(bound), *back = malloc(bytes);
                make(data, counts[i], stride, kind);
                uint64_t size = csg_vertex_stream_encode(data, counts[i], stride, out);
                assert_true(size <= bound);
                assert_true(csg_vertex_stream_decode(out, size, counts[i], stride, back));
                assert_memory_equal(data, back, bytes);
                free(data);
                free(out);
                free(back);
            }
        uint8_t data[512], out[1024];
        make(data, streams[kind].count, streams[kind].stride, kind);
        assert_true(csg_vertex_stream_encode(data, streams[kind].count, streams[kind].stride,
                                             out) <= streams[kind].size);
    }
}

/* Each stream cut at each byte, with a byte more, and with each byte changed: in a room of its own
 * size, so that a sanitizer sees what is read beyond it. */
static void test_broken(void **state_)
{
    (void)state_;
    for (int kind = 0; kind < KINDS; kind++) {
        uint32_t size = streams[kind].size;
        uint8_t found[512];
        for (uint32_t cut = 0; cut <= size + 1; cut++) {
            uint8_t *bytes = calloc(1, cut ? cut : 1);
            memcpy(bytes, streams[kind].bytes, cut < size ? cut : size);
            bool is_whole = csg_vertex_stream_decode(bytes, cut, streams[kind].count,
                                                     streams[kind].stride, found);
            assert_int_equal(is_whole, cut == size);
            free(bytes);
        }
        for (uint32_t at = 0; at < size; at++) {
            uint8_t *bytes = malloc(size);
            for (uint32_t by = 1; by < 256; by++) {
                memcpy(bytes, streams[kind].bytes, size);
                bytes[at] = (uint8_t)(bytes[at] + by);
                bool is_read = csg_vertex_stream_decode(bytes, size, streams[kind].count,
                                                        streams[kind].stride, found);
                assert_true(at > 0 || !is_read);
            }
            free(bytes);
        }
    }
}

/* Red, black, white and blue with alpha, as meshoptimizer 1.3 packs them in 8 and in 12 bits; what
 * it unpacks, to the last bit but one. */
static void test_colors(void **state_)
{
    static const struct {
        uint32_t stride;
        uint8_t packed[32], wanted[32];
    } rows[] = {
        {4,
         {144, 95, 241, 255, 0, 0, 0, 255, 255, 0, 0, 192, 122, 167, 237, 223},
         {254, 129, 64, 255, 0, 0, 0, 255, 255, 255, 255, 128, 52, 103, 230, 191}},
        {8,
         {0,   9,  255, 5, 1, 255, 255, 15, 0,   0, 0,   0,   0,   0,   255, 15,
          255, 15, 0,   0, 0, 0,   0,   12, 154, 7, 103, 250, 205, 254, 255, 13},
         {239, 255, 24,  128, 4,   64,  255, 255, 0,  0,  0,   0,   0,   0,   255, 255,
          255, 255, 255, 255, 255, 255, 8,   128, 67, 51, 118, 102, 110, 230, 251, 191}},
    };
    (void)state_;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        uint8_t colors[32];
        uint32_t bytes = rows[i].stride / 4;
        memcpy(colors, rows[i].packed, sizeof colors);
        csg_color_filter_decode(colors, 4, rows[i].stride);
        for (uint32_t k = 0; k < 16; k++) {
            int a = 0, b = 0;
            for (uint32_t j = 0; j < bytes; j++) {
                a |= colors[k * bytes + j] << 8 * j;
                b |= rows[i].wanted[k * bytes + j] << 8 * j;
            }
            assert_in_range(a - b + 1, 0, 2);
        }
    }
    uint8_t zero[4] = {1, 2, 3, 0}; /* no alpha tells how many bits there are */
    csg_color_filter_decode(zero, 1, 4);
    assert_int_equal(zero[0] + zero[1] + zero[2] + zero[3], 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_streams_of_others),
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_broken),
        cmocka_unit_test(test_colors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
