/* SPDX-License-Identifier: MIT
 * What stands around the files of a ZIP archive: a head before each, a record of each behind all,
 * and the end (APPNOTE.TXT 6.3.9, sections 4.3.7, 4.3.12 and 4.3.16). Without time stamps, beyond
 * 4 GiB nothing. And how zlib, which compresses these files, takes memory from the budget.
 */
#ifndef CSG_IO_ZIP_RECORDS_H
#define CSG_IO_ZIP_RECORDS_H

#include <string.h>

#include "base/sized_block.h"
#include "io/sink.h"

enum { CSG_ZIP_HEAD_BYTES = 30, CSG_ZIP_RECORD_BYTES = 46, CSG_ZIP_END_BYTES = 22 };

typedef struct csg_zip_record {
    uint32_t version; /* of the format that is needed, times ten */
    uint32_t flags, method;
    uint32_t crc, packed_bytes, plain_bytes; /* 0 in a head whose flags put them behind the file */
    uint32_t name_bytes;
} csg_zip_record;

/* CRC and sizes, where they stand alone, too. */
static inline uint8_t *csg_zip_store_sizes(uint8_t *at, const csg_zip_record *file)
{
    at = csg_store_u32(at, file->crc);
    at = csg_store_u32(at, file->packed_bytes);
    return csg_store_u32(at, file->plain_bytes);
}

/* What a head and a record have in common; up to where the lengths of other fields are. */
static inline uint8_t *csg_zip_store_common(uint8_t *at, const csg_zip_record *file)
{
    enum { NO_DATE = 0x0021 /* 1 January 1980, the format's zero */ };
    at = csg_store_u16(csg_store_u16(at, file->version), file->flags);
    at = csg_store_u16(csg_store_u16(csg_store_u16(at, file->method), 0), NO_DATE);
    return csg_store_u16(csg_zip_store_sizes(at, file), file->name_bytes);
}

/* The name follows. */
static inline void csg_zip_store_head(uint8_t out[CSG_ZIP_HEAD_BYTES], const csg_zip_record *file)
{
    memset(out, 0, CSG_ZIP_HEAD_BYTES);
    csg_zip_store_common(csg_store_u32(out, 0x04034B50), file);
}

/* at: where its head begins. The name follows. */
static inline void csg_zip_store_record(uint8_t out[CSG_ZIP_RECORD_BYTES],
                                        const csg_zip_record *file, uint32_t at)
{
    memset(out, 0, CSG_ZIP_RECORD_BYTES);
    csg_zip_store_common(csg_store_u16(csg_store_u32(out, 0x02014B50), file->version), file);
    csg_store_u32(out + 42, at);
}

/* records: how many, behind how many bytes, and how many bytes they take with their names. */
static inline void csg_zip_store_end(uint8_t out[CSG_ZIP_END_BYTES], uint32_t records, uint32_t at,
                                     uint32_t bytes)
{
    memset(out, 0, CSG_ZIP_END_BYTES);
    csg_store_u32(out, 0x06054B50);
    csg_store_u16(csg_store_u16(out + 8, records), records);
    csg_store_u32(csg_store_u32(out + 12, bytes), at);
}

/* zlib's zalloc and zfree; opaque: the csg_memory. */
static inline void *csg_zlib_alloc(void *memory, unsigned count, unsigned size)
{
    return csg_sized_block_alloc(memory, (size_t)count * size);
}

static inline void csg_zlib_release(void *memory, void *pointer)
{
    csg_sized_block_release(memory, pointer);
}

#endif
