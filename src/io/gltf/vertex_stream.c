/* SPDX-License-Identifier: MIT
 * Compressed vertices of version 1; see vertex_stream.h.
 */
#include "io/gltf/vertex_stream.h"

#include <string.h>

enum {
    HEADER = 0xa1,
    GROUP = 16, /* values with one number of bits */
    BLOCK_MOST = 256,
    BLOCK_BYTES = 8192,
    STRIDE_MOST = 256,
    CHANNEL = 4,     /* bytes of a vertex with one kind of difference */
    LEAST_TAIL = 24, /* decoders may read so far beyond a group */
    LOOKED_AT = 64   /* blocks by which the kinds of differences are chosen */
};

/* Of each byte of a vertex in a block. */
enum { FEW_BITS, MORE_BITS, ALL_ZERO, AS_THEY_ARE };

static const uint8_t bits_of[2][4] = {{0, 1, 2, 4}, {1, 2, 4, 8}};

/* Of a channel; above it, in the same byte, by how much BITS are turned. */
enum { BYTES, PAIRS, BITS, KINDS };

static uint64_t block_of(uint64_t stride, uint64_t left)
{
    uint64_t most = BLOCK_BYTES / stride / GROUP * GROUP;
    most = most < BLOCK_MOST ? most : BLOCK_MOST;
    return left < most ? left : most;
}

static uint64_t tail_of(uint64_t stride)
{
    uint64_t tail = stride + stride / CHANNEL;
    return tail > LEAST_TAIL ? tail : LEAST_TAIL;
}

static uint64_t groups_of(uint64_t count)
{
    return (count + GROUP - 1) / GROUP;
}

static uint32_t load(const uint8_t at[CHANNEL])
{
    return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static void store(uint32_t value, uint8_t at[CHANNEL])
{
    for (int i = 0; i < CHANNEL; i++)
        at[i] = (uint8_t)(value >> 8 * i);
}

static uint32_t turned(uint32_t value, uint32_t by)
{
    return value << by | value >> ((32 - by) & 31);
}

/* ---- differences ----------------------------------------------------------------------------- */

/* Whole numbers of `width` bits side by side in 32: those of a - b, with their signs behind them;
 * and b's back from a. */
static uint32_t difference(uint32_t a, uint32_t b, uint32_t width)
{
    uint32_t mask = (1u << width) - 1, sum = 0;
    for (uint32_t at = 0; at < 32; at += width) {
        uint32_t d = ((a >> at) - (b >> at)) & mask;
        sum |= ((d >> (width - 1) ? ~(d << 1) : d << 1) & mask) << at;
    }
    return sum;
}

static uint32_t add_difference(uint32_t before, uint32_t stored, uint32_t width)
{
    uint32_t mask = (1u << width) - 1, sum = 0;
    for (uint32_t at = 0; at < 32; at += width) {
        uint32_t d = (stored >> at) & mask;
        sum |= (((before >> at) + (d & 1 ? ~(d >> 1) : d >> 1)) & mask) << at;
    }
    return sum;
}

static uint32_t store_change(uint32_t now, uint32_t before, uint8_t kind)
{
    if ((kind & 15) == BITS)
        return turned(now ^ before, kind >> 4);
    return difference(now, before, (kind & 15) == BYTES ? 8 : 16);
}

static uint32_t apply_change(uint32_t before, uint32_t stored, uint8_t kind)
{
    if ((kind & 15) == BITS)
        return before ^ turned(stored, (32u - (kind >> 4)) & 31);
    return add_difference(before, stored, (kind & 15) == BYTES ? 8 : 16);
}

static bool is_kind(uint8_t kind)
{
    return (kind & 15) < KINDS && ((kind & 15) == BITS || kind < 16);
}

/* ---- reading --------------------------------------------------------------------------------- */

typedef struct reader {
    const uint8_t *at, *end;
} reader;

static const uint8_t *take(reader *r, uint64_t bytes)
{
    const uint8_t *at = r->at;
    if ((uint64_t)(r->end - r->at) < bytes)
        return NULL;
    r->at += bytes;
    return at;
}

/* The i-th value: single bits stand from the lowest of a byte on, others from the highest. */
static uint8_t value_in(const uint8_t *packed, uint32_t i, uint32_t bits)
{
    uint32_t each = 8 / bits, place = bits == 1 ? i % 8 : each - 1 - i % each;
    uint32_t byte = packed[i / each];
    return (uint8_t)(byte >> place * bits & ((1u << bits) - 1));
}

static bool read_group(reader *r, uint32_t bits, uint8_t out[GROUP])
{
    const uint8_t *packed = take(r, GROUP / 8 * bits);
    if (!packed)
        return false;
    for (uint32_t i = 0; i < GROUP; i++) {
        out[i] = bits == 0 ? 0 : bits == 8 ? packed[i] : value_in(packed, i, bits);
        if (bits && bits < 8 && out[i] == (1u << bits) - 1) {
            const uint8_t *whole = take(r, 1);
            if (!whole)
                return false;
            out[i] = *whole;
        }
    }
    return true;
}

/* A byte of each vertex in a block; `out` has room for whole groups. */
static bool read_row(reader *r, uint32_t control, uint64_t count, uint8_t *out)
{
    uint64_t groups = groups_of(count);
    const uint8_t *from;
    if (control == ALL_ZERO) {
        memset(out, 0, count);
        return true;
    }
    if (control == AS_THEY_ARE) {
        if ((from = take(r, count)))
            memcpy(out, from, count);
        return from != NULL;
    }
    if (!(from = take(r, (groups + 3) / 4)))
        return false;
    for (uint64_t g = 0; g < groups; g++)
        if (!read_group(r, bits_of[control][from[g / 4] >> g % 4 * 2 & 3], out + g * GROUP))
            return false;
    return true;
}

static bool read_block(reader *r, const uint8_t *kinds, uint64_t count, uint64_t stride,
                       const uint8_t *last, uint8_t *out)
{
    uint8_t rows[CHANNEL][BLOCK_MOST];
    const uint8_t *controls = take(r, stride / CHANNEL);
    if (!controls)
        return false;
    for (uint64_t k = 0; k < stride; k += CHANNEL) {
        uint32_t before = load(last + k);
        for (uint32_t j = 0; j < CHANNEL; j++)
            if (!read_row(r, controls[k / CHANNEL] >> 2 * j & 3, count, rows[j]))
                return false;
        for (uint64_t i = 0; i < count; i++) {
            uint8_t stored[CHANNEL] = {rows[0][i], rows[1][i], rows[2][i], rows[3][i]};
            before = apply_change(before, load(stored), kinds[k / CHANNEL]);
            store(before, out + i * stride + k);
        }
    }
    return true;
}

bool csg_vertex_stream_is_one(const uint8_t *bytes, uint64_t size)
{
    return size && bytes[0] == HEADER;
}

bool csg_vertex_stream_decode(const uint8_t *bytes, uint64_t size, uint64_t count, uint64_t stride,
                              uint8_t *out)
{
    if (!csg_vertex_stream_is_one(bytes, size) || size - 1 < tail_of(stride))
        return false;
    reader r = {bytes + 1, bytes + size - tail_of(stride)};
    const uint8_t *kinds = bytes + size - stride / CHANNEL, *last = kinds - stride;
    for (uint64_t k = 0; k < stride / CHANNEL; k++)
        if (!is_kind(kinds[k]))
            return false;
    for (uint64_t done = 0; done < count;) {
        uint64_t block = block_of(stride, count - done);
        if (!read_block(&r, kinds, block, stride, last, out + done * stride))
            return false;
        done += block;
        last = out + (done - 1) * stride;
    }
    return r.at == r.end;
}

/* ---- writing --------------------------------------------------------------------------------- */

static uint32_t group_bytes(const uint8_t group[GROUP], uint32_t bits)
{
    uint32_t sum = GROUP / 8 * bits, most = (1u << bits) - 1;
    for (uint32_t i = 0; i < GROUP && bits < 8; i++)
        sum += bits ? group[i] >= most : group[i] ? GROUP * 8u : 0; /* 0 bits: all are 0 */
    return sum;
}

/* Which of four numbers of bits takes least. */
static uint32_t choose_bits(const uint8_t group[GROUP], uint32_t control, uint32_t *bytes)
{
    uint32_t best = 0;
    *bytes = UINT32_MAX;
    for (uint32_t i = 0; i < 4; i++) {
        uint32_t own = group_bytes(group, bits_of[control][i]);
        if (own < *bytes) {
            *bytes = own;
            best = i;
        }
    }
    return best;
}

static uint64_t row_bytes(const uint8_t *row, uint32_t control, uint64_t count)
{
    uint64_t groups = groups_of(count), sum = (groups + 3) / 4;
    for (uint64_t g = 0; g < groups; g++) {
        uint32_t bytes;
        choose_bits(row + g * GROUP, control, &bytes);
        sum += bytes;
    }
    return sum;
}

/* How a row takes least. */
static uint32_t choose_control(const uint8_t *row, uint64_t count, uint64_t *bytes)
{
    uint32_t best = AS_THEY_ARE;
    bool is_zero = true;
    for (uint64_t i = 0; i < count; i++)
        is_zero = is_zero && row[i] == 0;
    *bytes = is_zero ? 0 : count;
    if (is_zero)
        return ALL_ZERO;
    for (uint32_t control = FEW_BITS; control <= MORE_BITS; control++) {
        uint64_t own = row_bytes(row, control, count);
        if (own < *bytes) {
            *bytes = own;
            best = control;
        }
    }
    return best;
}

/* Differences of a channel, by bytes; whole groups, the last one filled with 0. */
static void make_rows(const uint8_t *from, uint64_t count, uint64_t stride, uint32_t before,
                      uint8_t kind, uint8_t rows[CHANNEL][BLOCK_MOST])
{
    for (uint64_t i = 0; i < groups_of(count) * GROUP; i++) {
        uint8_t stored[CHANNEL] = {0};
        if (i < count) {
            uint32_t now = load(from + i * stride);
            store(store_change(now, before, kind), stored);
            before = now;
        }
        for (int j = 0; j < CHANNEL; j++)
            rows[j][i] = stored[j];
    }
}

static uint64_t channel_bytes(const uint8_t *from, uint64_t count, uint64_t stride, uint32_t before,
                              uint8_t kind)
{
    uint8_t rows[CHANNEL][BLOCK_MOST];
    uint64_t sum = 0;
    make_rows(from, count, stride, before, kind, rows);
    for (int j = 0; j < CHANNEL; j++) {
        uint64_t bytes;
        choose_control(rows[j], count, &bytes);
        sum += bytes;
    }
    return sum;
}

/* Tries all kinds on some blocks from all over. */
static uint8_t choose_kind(const uint8_t *data, uint64_t count, uint64_t stride, uint64_t channel)
{
    uint64_t block = block_of(stride, count), blocks = (count + block - 1) / block;
    uint64_t step = (blocks + LOOKED_AT - 1) / LOOKED_AT, least = UINT64_MAX;
    const uint8_t *from = data + channel * CHANNEL;
    uint8_t best = BYTES;
    for (uint8_t turn = 0; turn < 8; turn++)
        for (uint8_t kind = turn ? BITS : BYTES; kind < KINDS; kind++) {
            uint8_t own = (uint8_t)(turn << 4 | kind);
            uint64_t sum = 0;
            for (uint64_t b = 0; b < blocks; b += step) {
                uint64_t first = b * block;
                sum += channel_bytes(from + first * stride, block_of(stride, count - first), stride,
                                     load(from + (first ? first - 1 : 0) * stride), own);
            }
            if (sum < least) {
                least = sum;
                best = own;
            }
        }
    return best;
}

static uint8_t *write_group(uint8_t *out, const uint8_t group[GROUP], uint32_t bits)
{
    uint32_t most = (1u << bits) - 1, each = bits ? 8 / bits : 1;
    uint8_t *packed = out;
    memset(packed, 0, GROUP / 8 * (size_t)bits);
    out += GROUP / 8 * bits;
    for (uint32_t i = 0; i < GROUP && bits; i++) {
        uint32_t value = group[i] < most ? group[i] : most;
        uint32_t place = bits == 1 ? i % 8 : each - 1 - i % each;
        packed[i / each] |= (uint8_t)(value << place * bits);
        if (bits < 8 && value == most)
            *out++ = group[i];
    }
    return out;
}

static uint8_t *write_row(uint8_t *out, const uint8_t *row, uint32_t control, uint64_t count)
{
    uint64_t groups = groups_of(count);
    if (control == ALL_ZERO)
        return out;
    if (control == AS_THEY_ARE) {
        memcpy(out, row, count);
        return out + count;
    }
    uint8_t *header = out;
    memset(header, 0, (groups + 3) / 4);
    out += (groups + 3) / 4;
    for (uint64_t g = 0; g < groups; g++) {
        uint32_t bytes, choice = choose_bits(row + g * GROUP, control, &bytes);
        header[g / 4] |= (uint8_t)(choice << g % 4 * 2);
        out = write_group(out, row + g * GROUP, bits_of[control][choice]);
    }
    return out;
}

static uint8_t *write_block(uint8_t *out, const uint8_t *data, const uint8_t *last, uint64_t count,
                            uint64_t stride, const uint8_t *kinds)
{
    uint8_t rows[CHANNEL][BLOCK_MOST], *controls = out;
    memset(controls, 0, stride / CHANNEL);
    out += stride / CHANNEL;
    for (uint64_t k = 0; k < stride; k += CHANNEL) {
        make_rows(data + k, count, stride, load(last + k), kinds[k / CHANNEL], rows);
        for (uint32_t j = 0; j < CHANNEL; j++) {
            uint64_t bytes;
            uint32_t control = choose_control(rows[j], count, &bytes);
            controls[k / CHANNEL] |= (uint8_t)(control << 2 * j);
            out = write_row(out, rows[j], control, count);
        }
    }
    return out;
}

uint64_t csg_vertex_stream_bound(uint64_t count, uint64_t stride)
{
    uint64_t block = block_of(stride, BLOCK_MOST), blocks = (count + block - 1) / block;
    /* no row takes more than its bytes as they are */
    return 1 + blocks * (stride / CHANNEL) + count * stride + tail_of(stride);
}

/* The first vertex is the one that it differs from. */
uint64_t csg_vertex_stream_encode(const uint8_t *data, uint64_t count, uint64_t stride,
                                  uint8_t *out)
{
    uint8_t first[STRIDE_MOST] = {0}, kinds[STRIDE_MOST / CHANNEL] = {0}, *at = out;
    const uint8_t *last = first;
    if (count)
        memcpy(first, data, stride);
    for (uint64_t k = 0; k < stride / CHANNEL && count; k++)
        kinds[k] = choose_kind(data, count, stride, k);
    *at++ = HEADER;
    for (uint64_t done = 0; done < count;) {
        uint64_t block = block_of(stride, count - done);
        at = write_block(at, data + done * stride, last, block, stride, kinds);
        done += block;
        last = data + (done - 1) * stride;
    }
    uint64_t own = stride + stride / CHANNEL;
    memset(at, 0, tail_of(stride) - own);
    at += tail_of(stride) - own;
    memcpy(at, first, stride);
    memcpy(at + stride, kinds, stride / CHANNEL);
    return (uint64_t)(at + own - out);
}

/* ---- colours --------------------------------------------------------------------------------- */

static int32_t as_signed(uint32_t value, uint32_t width)
{
    return value >> (width - 1) ? (int32_t)value - (int32_t)(1u << width) : (int32_t)value;
}

/* y, co, cg and alpha of as many bits as the place of alpha's highest one tells. */
static void color_of(const uint32_t in[4], uint32_t width, uint32_t out[4])
{
    uint32_t bits = 0, most = (1u << width) - 1;
    while (bits < width && in[3] >> bits)
        bits++;
    uint32_t own = (1u << bits) - 1, alpha = in[3] & own >> 1;
    int32_t y = (int32_t)in[0], co = as_signed(in[1], width), cg = as_signed(in[2], width);
    int32_t parts[4] = {y + co - cg, y + cg, y - co - cg, (int32_t)(alpha << 1 | (alpha & 1))};
    for (int c = 0; c < 4; c++) {
        int32_t part = parts[c] < 0 ? 0 : parts[c];
        float value = own ? (float)part * ((float)most / (float)own) + 0.5f : 0;
        out[c] = value < (float)most ? (uint32_t)value : most;
    }
}

void csg_color_filter_decode(uint8_t *colors, uint64_t count, uint64_t stride)
{
    uint32_t bytes = stride == 8 ? 2 : 1;
    for (uint64_t i = 0; i < count; i++) {
        uint8_t *at = colors + i * stride;
        uint32_t in[4] = {0}, out[4];
        for (uint32_t k = 0; k < 4 * bytes; k++)
            in[k / bytes] |= (uint32_t)at[k] << k % bytes * 8;
        color_of(in, 8 * bytes, out);
        for (uint32_t k = 0; k < 4 * bytes; k++)
            at[k] = (uint8_t)(out[k / bytes] >> k % bytes * 8);
    }
}
