/* SPDX-License-Identifier: MIT
 * Stands in for draco.cc in a build without Draco: says so. Nothing else here is reached, since the
 * table of formats asks first.
 */
#include "io/adapter.h"

bool csg_draco_available(void)
{
    return false;
}

csgm_status csg_draco_encode(const csg_draco_mesh *mesh, const csg_draco_settings *settings,
                             csg_draco_encoded *out, csg_adapter_error *error)
{
    (void)mesh, (void)settings, (void)out, (void)error;
    return CSGM_ERR_UNSUPPORTED;
}

void csg_draco_release(csg_draco_encoded *encoded)
{
    (void)encoded;
}

csgm_status csg_draco_decode(const uint8_t *bytes, size_t size_bytes, const csg_draco_ids *ids,
                             uint64_t most_bytes, csg_draco_decoded *out, csg_adapter_error *error)
{
    (void)bytes, (void)size_bytes, (void)ids, (void)most_bytes, (void)out, (void)error;
    return CSGM_ERR_UNSUPPORTED;
}

void csg_draco_release_decoded(csg_draco_decoded *decoded)
{
    (void)decoded;
}
