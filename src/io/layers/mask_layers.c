/* SPDX-License-Identifier: MIT
 * Masks for printers with a screen: a ZIP archive with a grey PNG for each layer, 00000.png and so
 * on, white where the solid is, grey by how much of a pixel it covers, and layers.csv, which says
 * from where to where each layer is. Pictures are compressed
 * already, so that they are stored; no time stamps. The pictures are written here, with zlib alone,
 * since they are made by all threads in memory: bands of rows, no filter.
 */
#include <string.h>
#include <zlib.h>

#include "io/layers/coverage.h"
#include "io/layers/layers.h"
#include "io/zip_records.h"

enum {
    BAND = 32, /* rows at once */
    LEVEL = 6,
    ROOM = 1 << 14,
    NAME_BYTES = 9,
    VERSION = 10 /* of the format: 1.0, stored */
};

static const char HEIGHTS[] = "layers.csv";

/* ---- PNG -------------------------------------------------------------------------------------- */

static uint8_t *store_big(uint8_t *at, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        at[i] = (uint8_t)(value >> (24 - 8 * i));
    return at + 4;
}

/* Where a chunk begins; its length comes at its end. */
static size_t begin_chunk(csg_page *page, const char *type)
{
    size_t at = page->length;
    csg_page_bytes(page, "\0\0\0\0", 4);
    csg_page_bytes(page, type, 4);
    return at;
}

static void end_chunk(csg_page *page, size_t at)
{
    uint8_t sum[4];
    if (page->failed)
        return;
    uint8_t *chunk = (uint8_t *)page->data + at;
    uint32_t length = (uint32_t)(page->length - at - 8);
    store_big(chunk, length);
    store_big(sum, (uint32_t)crc32(0, chunk + 4, length + 4));
    csg_page_bytes(page, sum, sizeof sum);
}

typedef struct picture_room {
    z_stream stream;
    bool is_ready;
    double *sums; /* of a band */
    uint8_t *row;
} picture_room;

static void deflate_bytes(csg_page *page, z_stream *stream, const uint8_t *bytes, size_t count,
                          int flush)
{
    uint8_t out[ROOM];
    stream->next_in = (uint8_t *)bytes;
    stream->avail_in = (unsigned)count;
    do {
        stream->next_out = out;
        stream->avail_out = ROOM;
        deflate(stream, flush);
        csg_page_bytes(page, out, ROOM - stream->avail_out);
    } while (!stream->avail_out);
}

static void put_rows(csg_page *page, const csg_layers_head *head, const csg_outline *contours,
                     picture_room *room)
{
    size_t stride = (size_t)head->width + 2;
    for (uint32_t first = 0; first < head->height; first += BAND) {
        uint32_t end = first + BAND < head->height ? first + BAND : head->height;
        memset(room->sums, 0, stride * BAND * sizeof *room->sums);
        csg_coverage_add(contours, head->scale, head->corner, head->pixel, head->width, first, end,
                         room->sums);
        for (uint32_t y = first; y < end; y++) {
            room->row[0] = 0; /* no filter */
            csg_coverage_bytes(room->sums + (y - first) * stride, head->width, room->row + 1);
            deflate_bytes(page, &room->stream, room->row, (size_t)head->width + 1,
                          y + 1 < head->height ? Z_NO_FLUSH : Z_FINISH);
        }
    }
}

static void put_picture(csg_page *page, const csg_layers_head *head, const csg_outline *contours)
{
    static const uint8_t signature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    csg_memory *memory = page->memory;
    size_t sums_bytes = ((size_t)head->width + 2) * BAND * sizeof(double);
    uint8_t size[13] = {[8] = 8}; /* bits of a pixel; grey, one pass */
    picture_room room = {
        .stream = {.zalloc = csg_zlib_alloc, .zfree = csg_zlib_release, .opaque = memory}};
    room.sums = csg_memory_alloc(memory, sums_bytes);
    room.row = csg_memory_alloc(memory, (size_t)head->width + 1);
    room.is_ready = deflateInit(&room.stream, LEVEL) == Z_OK;
    csg_page_bytes(page, signature, sizeof signature);
    store_big(store_big(size, head->width), head->height);
    size_t chunk = begin_chunk(page, "IHDR");
    csg_page_bytes(page, size, sizeof size);
    end_chunk(page, chunk);
    chunk = begin_chunk(page, "IDAT");
    if (room.sums && room.row && room.is_ready)
        put_rows(page, head, contours, &room);
    else
        page->failed = true;
    end_chunk(page, chunk);
    end_chunk(page, begin_chunk(page, "IEND"));
    if (room.is_ready)
        deflateEnd(&room.stream);
    csg_memory_release(memory, room.sums, sums_bytes);
    csg_memory_release(memory, room.row, (size_t)head->width + 1);
}

/* ---- the archive ------------------------------------------------------------------------------ */

static csg_zip_record record_of(const csg_mask_entry *entry)
{
    return (csg_zip_record){.version = VERSION,
                            .crc = entry->crc,
                            .packed_bytes = entry->bytes,
                            .plain_bytes = entry->bytes,
                            .name_bytes = NAME_BYTES};
}

static void put_mask(csg_page *page, const csg_layers_head *head, const csg_sliced_layer *layer)
{
    uint8_t empty[CSG_ZIP_HEAD_BYTES] = {0};
    csg_mask_entry *entry = &head->masks[layer->number];
    size_t at = page->length;
    csg_page_bytes(page, empty, sizeof empty);
    csg_page_format(page, "%05zu.png", layer->number);
    size_t from = page->length;
    put_picture(page, head, &layer->contours);
    if (page->failed)
        return;
    const uint8_t *picture = (const uint8_t *)page->data + from;
    entry->bytes = (uint32_t)(page->length - from);
    entry->crc = (uint32_t)crc32(0, picture, entry->bytes);
    entry->low = layer->low * page->scale;
    entry->high = layer->high * page->scale;
    csg_zip_record record = record_of(entry);
    csg_zip_store_head((uint8_t *)page->data + at, &record);
}

/* Heights of layers in millimetres, which their pictures do not have. */
static csg_mask_entry put_heights(csg_page *page, const csg_layers_head *head)
{
    uint8_t empty[CSG_ZIP_HEAD_BYTES] = {0};
    csg_mask_entry entry = {0};
    size_t at = page->length;
    csg_page_bytes(page, empty, sizeof empty);
    csg_page_text(page, HEIGHTS);
    size_t from = page->length;
    csg_page_text(page, "picture,from,to\n");
    for (size_t i = 0; i < head->count; i++) {
        csg_page_format(page, "%05zu.png,", i);
        csg_page_number(page, head->masks[i].low, page->decimals);
        csg_page_text(page, ",");
        csg_page_number(page, head->masks[i].high, page->decimals);
        csg_page_text(page, "\n");
    }
    if (page->failed)
        return entry;
    entry.bytes = (uint32_t)(page->length - from);
    entry.crc = (uint32_t)crc32(0, (const uint8_t *)page->data + from, entry.bytes);
    csg_zip_record record = record_of(&entry);
    record.name_bytes = sizeof HEIGHTS - 1;
    csg_zip_store_head((uint8_t *)page->data + at, &record);
    return entry;
}

static void begin_masks(csg_page *page, const csg_layers_head *head)
{
    (void)page, (void)head;
}

static void end_masks(csg_page *page, const csg_layers_head *head)
{
    uint32_t at = 0;
    uint8_t bytes[CSG_ZIP_RECORD_BYTES], end[CSG_ZIP_END_BYTES];
    csg_mask_entry heights = put_heights(page, head);
    size_t from = page->length;
    for (size_t i = 0; i < head->count; i++) {
        csg_zip_record record = record_of(&head->masks[i]);
        csg_zip_store_record(bytes, &record, at);
        csg_page_bytes(page, bytes, sizeof bytes);
        csg_page_format(page, "%05zu.png", i);
        at += CSG_ZIP_HEAD_BYTES + NAME_BYTES + head->masks[i].bytes;
    }
    csg_zip_record record = record_of(&heights);
    record.name_bytes = sizeof HEIGHTS - 1;
    csg_zip_store_record(bytes, &record, at);
    csg_page_bytes(page, bytes, sizeof bytes);
    csg_page_text(page, HEIGHTS);
    at += CSG_ZIP_HEAD_BYTES + record.name_bytes + heights.bytes;
    csg_zip_store_end(end, (uint32_t)head->count + 1, at, (uint32_t)(page->length - from));
    csg_page_bytes(page, end, sizeof end);
}

const csg_layers_writer csg_layers_zip = {begin_masks,
                                          put_mask,
                                          end_masks,
                                          .has_masks = true,
                                          .most_layers = 65534,
                                          .most_bytes = CSG_LAYERS_ARCHIVE_BYTES};

bool csg_masks_available(void)
{
    return true;
}
