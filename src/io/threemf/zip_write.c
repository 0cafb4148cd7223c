/* SPDX-License-Identifier: MIT
 * The archive of zip_write.h. The text is cut into pieces that are
 * compressed on their own (each ends on a byte with a full flush, so that they can be put one after
 * the other), a few for every thread at a time. Sizes are known behind the data, so a file's head
 * is followed by its bytes and a "data descriptor": nothing is sought, and a pipe gets the same
 * bytes.
 */
#include "io/threemf/zip_write.h"

#include <zlib.h>

#include "base/pool.h"
#include "io/zip_records.h"

enum {
    MOST_FILES = 4,
    MOST_SLOTS = 32,
    LEVEL = 6,
    DESCRIPTOR_BYTES = 16,
    VERSION = 20,  /* of the format: 2.0, deflate */
    DESCRIPTED = 8 /* flag: sizes stand behind the data */
};

typedef struct entry {
    const char *name;
    uint64_t at, text_bytes, packed_bytes;
    uint32_t crc;
} entry;

/* A piece between its making and its place in the file. */
typedef struct slot {
    char *text;
    uint8_t *packed;
    size_t text_bytes, packed_bytes;
    uint32_t crc;
} slot;

typedef struct packer {
    z_stream stream;
    bool ready;
} packer;

struct csg_zip {
    csg_sink *sink;
    uint64_t written;
    entry files[MOST_FILES];
    size_t file_count;
    slot slots[MOST_SLOTS];
    size_t slot_count, packed_room;
    packer *packers; /* one per worker */
    uint32_t worker_count;
    size_t full; /* slots of text put in small portions; more of it may be in the next one */
    uint64_t first_piece;
    csg_zip_piece_fn *piece;
    void *user;
};

/* ---- pieces ---------------------------------------------------------------------------------- */

static bool make_slot(csg_zip *zip, slot *s)
{
    csg_memory *memory = &zip->sink->context->memory;
    s->text = csg_memory_alloc(memory, CSG_ZIP_PIECE_BYTES);
    s->packed = csg_memory_alloc(memory, zip->packed_room);
    return s->text && s->packed;
}

static void release_slot(csg_zip *zip, slot *s)
{
    csg_memory *memory = &zip->sink->context->memory;
    csg_memory_release(memory, s->text, CSG_ZIP_PIECE_BYTES);
    csg_memory_release(memory, s->packed, zip->packed_room);
}

/* Cannot fail: the room is what zlib says is enough. */
static void pack(csg_zip *zip, slot *s, packer *by)
{
    z_stream *stream = &by->stream;
    deflateReset(stream);
    stream->next_in = (uint8_t *)s->text;
    stream->avail_in = (unsigned)s->text_bytes;
    stream->next_out = s->packed;
    stream->avail_out = (unsigned)zip->packed_room;
    deflate(stream, Z_FULL_FLUSH);
    s->packed_bytes = zip->packed_room - stream->avail_out;
    s->crc = (uint32_t)crc32(0, (const uint8_t *)s->text, (unsigned)s->text_bytes);
}

static void append(csg_zip *zip, const slot *s)
{
    entry *file = &zip->files[zip->file_count - 1];
    csg_sink_put(zip->sink, s->packed, s->packed_bytes);
    file->crc = (uint32_t)crc32_combine(file->crc, s->crc, (z_off_t)s->text_bytes);
    file->text_bytes += s->text_bytes;
    file->packed_bytes += s->packed_bytes;
    zip->written += s->packed_bytes;
}

static void do_for_slots(csg_zip *zip, size_t count, csg_pool_work *task)
{
    if (zip->sink->context->pool)
        csg_pool_run(zip->sink->context->pool, count, task, NULL, zip);
    else
        for (size_t i = 0; i < count; i++)
            task(zip, 0, i);
    for (size_t i = 0; i < count; i++)
        append(zip, &zip->slots[i]);
}

static bool pack_slot(void *user, uint32_t worker, size_t index)
{
    csg_zip *zip = user;
    pack(zip, &zip->slots[index], &zip->packers[worker]);
    return true;
}

static void flush_loose(csg_zip *zip)
{
    bool is_begun = zip->full < zip->slot_count && zip->slots[zip->full].text_bytes;
    do_for_slots(zip, zip->full + is_begun, pack_slot);
    zip->full = 0;
    zip->slots[0].text_bytes = 0;
}

void csg_zip_text(csg_zip *zip, const char *text, size_t length)
{
    while (length) {
        slot *s = &zip->slots[zip->full];
        size_t room = CSG_ZIP_PIECE_BYTES - s->text_bytes;
        size_t count = length < room ? length : room;
        memcpy(s->text + s->text_bytes, text, count);
        s->text_bytes += count;
        text += count;
        length -= count;
        if (s->text_bytes < CSG_ZIP_PIECE_BYTES)
            continue;
        if (++zip->full == zip->slot_count)
            flush_loose(zip);
        else
            zip->slots[zip->full].text_bytes = 0;
    }
}

static bool make_piece(void *user, uint32_t worker, size_t index)
{
    csg_zip *zip = user;
    slot *s = &zip->slots[index];
    s->text_bytes = zip->piece(zip->user, zip->first_piece + index, s->text);
    return pack_slot(zip, worker, index);
}

void csg_zip_pieces(csg_zip *zip, uint64_t count, csg_zip_piece_fn *piece, void *user)
{
    flush_loose(zip);
    zip->piece = piece;
    zip->user = user;
    for (uint64_t first = 0; first < count && !zip->sink->error; first += zip->slot_count) {
        size_t batch = count - first < zip->slot_count ? (size_t)(count - first) : zip->slot_count;
        zip->first_piece = first;
        do_for_slots(zip, batch, make_piece);
    }
    zip->slots[0].text_bytes = 0;
}

/* ---- the archive ----------------------------------------------------------------------------- */

static void put_bytes(csg_zip *zip, const void *bytes, size_t count)
{
    csg_sink_put(zip->sink, bytes, count);
    zip->written += count;
}

static csg_zip_record record_of(const entry *file)
{
    return (csg_zip_record){.version = VERSION,
                            .flags = DESCRIPTED,
                            .method = Z_DEFLATED,
                            .crc = file->crc,
                            .packed_bytes = (uint32_t)file->packed_bytes,
                            .plain_bytes = (uint32_t)file->text_bytes,
                            .name_bytes = (uint32_t)strlen(file->name)};
}

static void end_file(csg_zip *zip)
{
    static const uint8_t last_block[2] = {3, 0};
    uint8_t descriptor[DESCRIPTOR_BYTES];
    if (!zip->file_count)
        return;
    entry *file = &zip->files[zip->file_count - 1];
    flush_loose(zip);
    put_bytes(zip, last_block, sizeof last_block);
    file->packed_bytes += sizeof last_block;
    csg_zip_record record = record_of(file);
    csg_zip_store_sizes(csg_store_u32(descriptor, 0x08074B50), &record);
    put_bytes(zip, descriptor, sizeof descriptor);
}

void csg_zip_file(csg_zip *zip, const char *name)
{
    uint8_t head[CSG_ZIP_HEAD_BYTES];
    end_file(zip);
    entry *file = &zip->files[zip->file_count++];
    *file = (entry){.name = name, .at = zip->written};
    csg_zip_record record = record_of(file);
    csg_zip_store_head(head, &record);
    put_bytes(zip, head, sizeof head);
    put_bytes(zip, name, strlen(name));
}

static void put_record(csg_zip *zip, const entry *file)
{
    uint8_t bytes[CSG_ZIP_RECORD_BYTES];
    csg_zip_record record = record_of(file);
    csg_zip_store_record(bytes, &record, (uint32_t)file->at);
    put_bytes(zip, bytes, sizeof bytes);
    put_bytes(zip, file->name, strlen(file->name));
}

csgm_status csg_zip_finish(csg_zip *zip)
{
    uint8_t end[CSG_ZIP_END_BYTES];
    end_file(zip);
    uint64_t directory = zip->written;
    bool fits = true;
    for (size_t i = 0; i < zip->file_count; i++) {
        put_record(zip, &zip->files[i]);
        fits &= zip->files[i].text_bytes < UINT32_MAX;
    }
    csg_zip_store_end(end, (uint32_t)zip->file_count, (uint32_t)directory,
                      (uint32_t)(zip->written - directory));
    put_bytes(zip, end, sizeof end);
    return fits && zip->written < UINT32_MAX ? CSGM_OK : CSGM_ERR_UNSUPPORTED;
}

static bool make_packers(csg_zip *zip)
{
    csg_memory *memory = &zip->sink->context->memory;
    zip->packers = csg_memory_alloc(memory, zip->worker_count * sizeof(packer));
    if (!zip->packers)
        return false;
    memset(zip->packers, 0, zip->worker_count * sizeof(packer));
    for (uint32_t i = 0; i < zip->worker_count; i++) {
        z_stream *stream = &zip->packers[i].stream;
        stream->zalloc = csg_zlib_alloc;
        stream->zfree = csg_zlib_release;
        stream->opaque = memory;
        zip->packers[i].ready =
            deflateInit2(stream, LEVEL, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY) == Z_OK;
        if (!zip->packers[i].ready)
            return false;
    }
    return true;
}

csgm_status csg_zip_create(csg_sink *sink, csg_zip **out)
{
    csg_zip *zip = csg_memory_alloc(&sink->context->memory, sizeof *zip);
    if (!zip)
        return csg_context_no_memory(sink->context);
    memset(zip, 0, sizeof *zip);
    zip->sink = sink;
    zip->worker_count = sink->context->pool ? csg_pool_threads(sink->context->pool) : 1;
    bool made = make_packers(zip);
    if (made) /* and a flush at the end */
        zip->packed_room = deflateBound(&zip->packers[0].stream, CSG_ZIP_PIECE_BYTES) + 64;
    size_t wanted = 2 * (size_t)zip->worker_count;
    wanted = wanted < MOST_SLOTS ? wanted : MOST_SLOTS;
    while (made && zip->slot_count < wanted)
        made = make_slot(zip, &zip->slots[zip->slot_count++]);
    if (made) {
        *out = zip;
        return CSGM_OK;
    }
    csg_zip_destroy(zip);
    return csg_context_no_memory(sink->context);
}

void csg_zip_destroy(csg_zip *zip)
{
    if (!zip)
        return;
    csg_memory *memory = &zip->sink->context->memory;
    for (size_t i = 0; i < zip->slot_count; i++)
        release_slot(zip, &zip->slots[i]);
    for (uint32_t i = 0; zip->packers && i < zip->worker_count; i++)
        if (zip->packers[i].ready)
            deflateEnd(&zip->packers[i].stream);
    csg_memory_release(memory, zip->packers, zip->worker_count * sizeof(packer));
    csg_memory_release(memory, zip, sizeof *zip);
}
