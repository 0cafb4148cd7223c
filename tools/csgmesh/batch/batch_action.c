/* SPDX-License-Identifier: MIT
 * ActionResult in the wire format of protocol buffers; see batch_action.h. The fields:
 *
 *     ActionResult { OutputFile output_files = 2; int32 exit_code = 4; }
 *     OutputFile   { string path = 1; Digest digest = 2; }
 *     Digest       { string hash = 1; int64 size_bytes = 2; }
 */
#include "batch/batch_action.h"

#include <stdio.h>
#include <string.h>

enum { VARINT = 0, FIXED64 = 1, BYTES = 2, FIXED32 = 5 };
enum { OUTPUT_FILES = 2, EXIT_CODE = 4, PATH = 1, DIGEST = 2, HASH = 1, SIZE_BYTES = 2 };

bool batch_action_add(cli_arena *arena, batch_action *action, const batch_blob *blob)
{
    batch_blob *place =
        cli_arena_push(arena, (void **)&action->files, &action->count, sizeof *place);
    if (place)
        *place = *blob;
    return place != NULL;
}

/* ---- writing -------------------------------------------------------------------------- */

static size_t put_varint(uint8_t *out, uint64_t value)
{
    size_t count = 0;
    do {
        out[count++] = (uint8_t)((value & 127) | (value > 127 ? 128 : 0));
        value >>= 7;
    } while (value);
    return count;
}

static size_t put_bytes(uint8_t *out, int field, const void *bytes, size_t length)
{
    size_t count = put_varint(out, (uint64_t)field << 3 | BYTES);
    count += put_varint(out + count, length);
    memcpy(out + count, bytes, length);
    return count + length;
}

enum { FILE_MOST = 160 }; /* bytes of an OutputFile */

static size_t put_file(uint8_t *out, const batch_blob *blob, size_t index)
{
    uint8_t digest[FILE_MOST], file[FILE_MOST];
    char path[24];
    snprintf(path, sizeof path, "%zu", index);
    size_t digest_size = put_bytes(digest, HASH, blob->sha256, strlen(blob->sha256));
    digest_size += put_varint(digest + digest_size, SIZE_BYTES << 3 | VARINT);
    digest_size += put_varint(digest + digest_size, blob->bytes);
    size_t file_size = put_bytes(file, PATH, path, strlen(path));
    file_size += put_bytes(file + file_size, DIGEST, digest, digest_size);
    return put_bytes(out, OUTPUT_FILES, file, file_size);
}

const char *batch_action_print(cli_arena *arena, const batch_action *action, size_t *length)
{
    uint8_t *bytes = cli_arena_alloc(arena, action->count * (FILE_MOST + 8) + 1);
    *length = 0;
    for (size_t i = 0; bytes && i < action->count; i++)
        *length += put_file(bytes + *length, &action->files[i], i);
    return (const char *)bytes;
}

/* ---- reading -------------------------------------------------------------------------- */

typedef struct reader {
    const uint8_t *at, *end;
    bool good;
} reader;

typedef struct field {
    uint64_t number;
    int kind;
    uint64_t value; /* of VARINT */
    reader inside;  /* of BYTES */
} field;

static uint64_t read_varint(reader *r)
{
    uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
        if (r->at == r->end)
            break;
        uint8_t byte = *r->at++;
        value |= (uint64_t)(byte & 127) << shift;
        if (byte < 128)
            return value;
    }
    r->good = false;
    return 0;
}

/* false: the message ends here, or is none (then it is not good). */
static bool read_field(reader *r, field *out)
{
    if (!r->good || r->at == r->end)
        return false;
    uint64_t tag = read_varint(r), length = 0;
    *out = (field){.number = tag >> 3, .kind = (int)(tag & 7)};
    if (out->kind == VARINT)
        out->value = read_varint(r);
    else if (out->kind == BYTES)
        length = read_varint(r);
    else
        length = out->kind == FIXED64 ? 8 : out->kind == FIXED32 ? 4 : UINT64_MAX;
    if (length > (uint64_t)(r->end - r->at) || !out->number)
        r->good = false;
    if (!r->good)
        return false;
    out->inside = (reader){r->at, r->at + length, true};
    r->at += length;
    return true;
}

static bool read_hash(const reader *text, batch_blob *out)
{
    static const char digits[] = "0123456789abcdef";
    if (text->end - text->at != BATCH_SHA256_TEXT - 1)
        return false;
    memcpy(out->sha256, text->at, BATCH_SHA256_TEXT - 1);
    out->sha256[BATCH_SHA256_TEXT - 1] = '\0';
    return strspn(out->sha256, digits) == BATCH_SHA256_TEXT - 1;
}

static bool read_digest(reader r, batch_blob *out)
{
    field f;
    bool has_hash = false;
    while (read_field(&r, &f)) {
        if (f.number == HASH && f.kind == BYTES)
            has_hash = read_hash(&f.inside, out);
        if (f.number == SIZE_BYTES && f.kind == VARINT)
            out->bytes = f.value;
    }
    return r.good && has_hash && out->bytes <= INT64_MAX;
}

static bool read_file(reader r, batch_blob *out)
{
    field f;
    bool has_digest = false;
    while (read_field(&r, &f))
        if (f.number == DIGEST && f.kind == BYTES)
            has_digest = read_digest(f.inside, out);
    return r.good && has_digest;
}

bool batch_action_parse(cli_arena *arena, const char *bytes, size_t length, batch_action *out)
{
    reader r = {(const uint8_t *)bytes, (const uint8_t *)bytes + length, true};
    field f;
    *out = (batch_action){0};
    while (read_field(&r, &f)) {
        batch_blob blob = {.bytes = 0};
        if (f.number == OUTPUT_FILES && f.kind == BYTES &&
            (!read_file(f.inside, &blob) || !batch_action_add(arena, out, &blob)))
            return false;
        if (f.number == EXIT_CODE && f.kind == VARINT && f.value != 0)
            return false;
    }
    return r.good && out->count > 0;
}
