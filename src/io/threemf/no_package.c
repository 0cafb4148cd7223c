/* SPDX-License-Identifier: MIT
 * Stands in for package.c and zip_write.c in a build without libzip, expat or zlib: says so.
 * Nothing else here is reached, since the table of formats asks first.
 */
#include "io/adapter.h"
#include "io/threemf/zip_write.h"

bool csg_package_available(void)
{
    return false;
}

csgm_status csg_package_open(const uint8_t *bytes, size_t size_bytes, csg_package **out,
                             csg_adapter_error *error)
{
    (void)bytes, (void)size_bytes, (void)out, (void)error;
    return CSGM_ERR_UNSUPPORTED;
}

csgm_status csg_package_parse(csg_package *package, const char *name, const csg_xml_calls *calls,
                              csg_adapter_error *error)
{
    (void)package, (void)name, (void)calls, (void)error;
    return CSGM_ERR_UNSUPPORTED;
}

const char *csg_package_first(csg_package *package)
{
    (void)package;
    return NULL;
}

csgm_status csg_package_parse_bytes(const uint8_t *bytes, size_t size_bytes,
                                    const csg_xml_calls *calls, csg_adapter_error *error)
{
    (void)bytes, (void)size_bytes, (void)calls, (void)error;
    return CSGM_ERR_UNSUPPORTED;
}

void csg_package_close(csg_package *package)
{
    (void)package;
}

csgm_status csg_zip_create(csg_sink *sink, csg_zip **out)
{
    (void)sink, (void)out;
    return CSGM_ERR_UNSUPPORTED;
}

void csg_zip_destroy(csg_zip *zip)
{
    (void)zip;
}

void csg_zip_file(csg_zip *zip, const char *name)
{
    (void)zip, (void)name;
}

void csg_zip_text(csg_zip *zip, const char *text, size_t length)
{
    (void)zip, (void)text, (void)length;
}

void csg_zip_pieces(csg_zip *zip, uint64_t count, csg_zip_piece_fn *piece, void *user)
{
    (void)zip, (void)count, (void)piece, (void)user;
}

csgm_status csg_zip_finish(csg_zip *zip)
{
    (void)zip;
    return CSGM_ERR_UNSUPPORTED;
}
