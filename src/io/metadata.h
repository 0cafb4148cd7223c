/* SPDX-License-Identifier: MIT
 * What a file says about itself, as "KEY=VALUE": csgm_write_options.metadata.
 */
#ifndef CSG_IO_METADATA_H
#define CSG_IO_METADATA_H

#include "csgmesh/csgmesh.h"

typedef struct csg_metadata {
    const char *key; /* key_length bytes */
    size_t key_length;
    const char *value;
} csg_metadata;

/* Of a text without a fault. Both spellings of license have the key "license". */
csg_metadata csg_metadata_split(const char *text);
/* What is wrong with the text, a sentence; NULL = nothing. */
const char *csg_metadata_fault(const char *text);
/* Does a later text of these options have the key of this one? The last one counts. */
bool csg_metadata_recurs(const csgm_write_options *options, size_t index);
bool csg_metadata_is(const csg_metadata *metadata, const char *key);

#endif
