/* SPDX-License-Identifier: MIT
 * A buffered stream of bytes to a file descriptor. Puts never fail: the first error sticks, later
 * bytes are dropped, and csg_sink_close reports it once. Everything binary is little endian.
 */
#ifndef CSG_IO_SINK_H
#define CSG_IO_SINK_H

#include <string.h>

#include "base/context.h"
#include "io/adapter.h"

enum {
    CSG_SINK_BYTES = 1 << 20,
    CSG_SINK_ROOM = 1 << 14 /* the most one csg_sink_room may ask for */
};

typedef struct csg_sink {
    csgm_context *context;
    const char *name; /* for diagnostics; borrowed */
    /* What may be made beside the file, whose path `name` is then; NULL: nothing can stand there.
     * Set after opening. */
    struct csg_companion *companion;
    int fd;
    int error; /* errno of the first failure, 0 = none */
    uint8_t *buffer;
    size_t length;
} csg_sink;

csgm_status csg_sink_open(csg_sink *sink, csgm_context *context, int fd, const char *name);
/* Writes what is left and gives the buffer back; the descriptor stays open. Reports the sticky
 * error. */
csgm_status csg_sink_close(csg_sink *sink);
/* Gives the buffer back without writing. */
void csg_sink_discard(csg_sink *sink);

void csg_sink_flush(csg_sink *sink);
void csg_sink_put(csg_sink *sink, const void *bytes, size_t count);
void csg_sink_text(csg_sink *sink, const char *text);
void csg_sink_format(csg_sink *sink, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* A place for at most `count` bytes; tell with csg_sink_took where the bytes put there end. */
static inline uint8_t *csg_sink_room(csg_sink *sink, size_t count)
{
    if (sink->length + count > CSG_SINK_BYTES)
        csg_sink_flush(sink);
    return sink->buffer + sink->length;
}

static inline void csg_sink_took(csg_sink *sink, const void *end)
{
    sink->length = (size_t)((const uint8_t *)end - sink->buffer);
}

/* ---- little-endian stores: return the place after --------------------------------- */

static inline uint8_t *csg_store_u16(uint8_t *at, uint32_t value)
{
    at[0] = (uint8_t)value;
    at[1] = (uint8_t)(value >> 8);
    return at + 2;
}

static inline uint8_t *csg_store_u32(uint8_t *at, uint32_t value)
{
    at[0] = (uint8_t)value;
    at[1] = (uint8_t)(value >> 8);
    at[2] = (uint8_t)(value >> 16);
    at[3] = (uint8_t)(value >> 24);
    return at + 4;
}

static inline uint8_t *csg_store_f32(uint8_t *at, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return csg_store_u32(at, bits);
}

static inline uint8_t *csg_store_f64(uint8_t *at, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return csg_store_u32(csg_store_u32(at, (uint32_t)bits), (uint32_t)(bits >> 32));
}

#endif
