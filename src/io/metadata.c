/* SPDX-License-Identifier: MIT
 * Metadata; see metadata.h.
 */
#include "io/metadata.h"

#include <string.h>

#include "base/utf8.h"

enum { KEY_MOST = 64, VALUE_MOST = 1024 };

csg_metadata csg_metadata_split(const char *text)
{
    csg_metadata out = {.key = text, .key_length = strcspn(text, "=")};
    out.value = text + out.key_length + (text[out.key_length] == '=');
    if (csg_metadata_is(&out, "licence")) {
        out.key = "license"; /* as glTF's viewers and 3MF spell it */
        out.key_length = strlen(out.key);
    }
    return out;
}

bool csg_metadata_is(const csg_metadata *metadata, const char *key)
{
    return metadata->key_length == strlen(key) &&
           memcmp(metadata->key, key, metadata->key_length) == 0;
}

bool csg_metadata_recurs(const csgm_write_options *options, size_t index)
{
    csg_metadata m = csg_metadata_split(options->metadata[index]);
    for (size_t i = index + 1; i < options->metadata_count; i++) {
        csg_metadata later = csg_metadata_split(options->metadata[i]);
        if (m.key_length == later.key_length && memcmp(m.key, later.key, m.key_length) == 0)
            return true;
    }
    return false;
}

static bool is_utf8(const char *text)
{
    for (size_t room = strlen(text), length; room; text += length, room -= length) {
        uint32_t character;
        length = csg_utf8_decode(text, room, &character);
        if (!length)
            return false;
    }
    return true;
}

const char *csg_metadata_fault(const char *text)
{
    static const char letters[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    /* what csgmesh itself says there */
    static const char *const taken[] = {"unit", "up", "comment"};
    csg_metadata m = csg_metadata_split(text);
    if (!strchr(text, '=') || !*m.value)
        return "has no value";
    if (!m.key_length || m.key_length > KEY_MOST || strspn(m.key, letters) < m.key_length)
        return "has no key of letters, digits, _ and -";
    if (strlen(m.value) > VALUE_MOST)
        return "has a value of more than 1024 bytes";
    if (!is_utf8(m.value))
        return "has a value that is not UTF-8";
    for (size_t i = 0; i < sizeof taken / sizeof *taken; i++)
        if (csg_metadata_is(&m, taken[i]))
            return "has a key that csgmesh uses itself";
    return NULL;
}
