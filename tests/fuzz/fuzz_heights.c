/* SPDX-License-Identifier: MIT
 * Any bytes -> heights from a table or a PNG image -> the solid. The checksums of an image's chunks
 * are set right first, or nearly all would end there.
 */
#include <stdlib.h>
#include <string.h>

#include "fuzz/fuzz_reader.h"
#include "outline/heights/heights.h"

static uint32_t checksum(const uint8_t *data, size_t size)
{
    uint32_t sum = ~0u;
    for (size_t i = 0; i < size; i++) {
        sum ^= data[i];
        for (int bit = 0; bit < 8; bit++)
            sum = sum & 1 ? sum >> 1 ^ 0xEDB88320u : sum >> 1;
    }
    return ~sum;
}

/* Chunks: length, name, data, checksum; numbers with the high byte first. */
static void mend_checksums(uint8_t *data, size_t size)
{
    for (size_t at = 8; at + 12 <= size;) {
        size_t length = (size_t)data[at] << 24 | (size_t)data[at + 1] << 16 |
                        (size_t)data[at + 2] << 8 | data[at + 3];
        if (length > size - at - 12)
            return;
        uint32_t sum = checksum(data + at + 4, length + 4);
        for (int i = 0; i < 4; i++)
            data[at + 8 + length + (size_t)i] = (uint8_t)(sum >> (24 - 8 * i));
        at += length + 12;
    }
}

static void check_solid(const csg_heights *heights)
{
    csg_triangles triangles;
    csg_problem problem = {""};
    csgm_status status = csg_heights_solid(heights, true, &triangles, &problem);
    fuzz_expect_sentence(status, &problem);
    for (size_t i = 0; i < triangles.point_count; i++)
        if (!isfinite(triangles.points[i].z))
            fuzz_fail("a height that is not finite", "", 0);
    csg_triangles_release(&triangles);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    csgm_context context;
    csg_heights heights;
    csg_problem problem = {""};
    fuzz_context_init(&context);
    csg_bytes bytes = {&context.memory, malloc(size + 1), size};
    if (!bytes.data)
        abort();
    memcpy(bytes.data, data, size);
    mend_checksums((uint8_t *)bytes.data, size);
    csgm_status status =
        csg_heights_from_bytes(&context.memory, &bytes, size & 1, &heights, &problem);
    fuzz_expect_sentence(status, &problem);
    if (status == CSGM_OK)
        check_solid(&heights);
    csg_heights_release(&heights);
    free(bytes.data);
    fuzz_context_close(&context);
    return 0;
}
