/* SPDX-License-Identifier: MIT
 * Any bytes -> a reader of meshes (FUZZ_FORMAT). Besides not crashing: memory comes back, a refusal
 * says why once, coordinates are finite, indices in range, and parts cover the triangles in order.
 * Under 3MF, an input that begins with '<' is the model itself, put into a package here, since few
 * changes of a compressed package leave it one.
 */
#include <math.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include "fuzz/fuzz.h"
#include "fuzz/mutate.h"
#include "io/formats.h"
#include "io/threemf/zip_write.h"

static void check(const csgm_mesh_view *mesh)
{
    uint64_t end = 0;
    for (uint64_t i = 0; i < 3 * mesh->vertex_count; i++)
        if (!isfinite(mesh->positions[i]))
            fuzz_fail("a coordinate is not finite", "", 0);
    for (uint64_t i = 0; i < 3 * mesh->triangle_count; i++)
        if (mesh->indices[i] >= mesh->vertex_count)
            fuzz_fail("an index is out of range", "", 0);
    for (uint64_t i = 0; i < mesh->part_count; i++) {
        if (mesh->parts[i].first_triangle != end || !mesh->parts[i].triangle_count)
            fuzz_fail("parts do not follow one another", "", 0);
        end += mesh->parts[i].triangle_count;
    }
    if (mesh->part_count && end != mesh->triangle_count)
        fuzz_fail("parts leave out triangles", "", 0);
}

static void read_bytes(csgm_context *context, const uint8_t *bytes, size_t size)
{
    csgm_mesh *mesh = NULL;
    csgm_status status = csg_io_read_memory(context, bytes, size, "mesh", FUZZ_FORMAT, &mesh);
    if (status != CSGM_OK && context->diags.errors != 1)
        fuzz_fail("refused without a word, or with two", "", 0);
    if (status == CSGM_OK) {
        fuzz_accepted++;
        csgm_mesh_view view = csg_mesh_view(mesh);
        check(&view);
    }
    csg_mesh_destroy(mesh);
}

/* The model in a package as csgmesh writes them; NULL when there is no room. */
static uint8_t *make_package(csgm_context *context, const uint8_t *model, size_t size,
                             size_t *package_bytes)
{
    static const char relationships[] =
        "<R xmlns=\"r\"><Relationship Target=\"m\" Type=\"/3dmodel\"/>"
        "</R>";
    csg_sink sink;
    csg_zip *zip = NULL;
    uint8_t *bytes = NULL;
    int file = memfd_create("package", MFD_CLOEXEC);
    if (file < 0 || csg_sink_open(&sink, context, file, "package") != CSGM_OK)
        abort();
    if (csg_zip_create(&sink, &zip) != CSGM_OK)
        abort();
    csg_zip_file(zip, "_rels/.rels");
    csg_zip_text(zip, relationships, sizeof relationships - 1);
    csg_zip_file(zip, "m");
    csg_zip_text(zip, (const char *)model, size);
    csg_zip_finish(zip);
    csg_zip_destroy(zip);
    csg_sink_close(&sink);
    *package_bytes = (size_t)lseek(file, 0, SEEK_END);
    bytes = malloc(*package_bytes);
    if (!bytes || pread(file, bytes, *package_bytes, 0) != (ssize_t)*package_bytes)
        abort();
    close(file);
    return bytes;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    csgm_context context;
    fuzz_context_init(&context);
    fuzz_files_open(data, size);
    if (FUZZ_FORMAT == CSGM_FORMAT_3MF && size && data[0] == '<') {
        size_t bytes = 0;
        uint8_t *package = make_package(&context, data, size, &bytes);
        read_bytes(&context, package, bytes);
        free(package);
    } else {
        read_bytes(&context, data, size);
    }
    fuzz_files_close();
    fuzz_context_close(&context);
    return 0;
}

#ifdef FUZZ_MUTATE
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    return FUZZ_MUTATE(data, size, most, seed);
}
#endif
