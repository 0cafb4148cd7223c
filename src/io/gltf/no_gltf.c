/* SPDX-License-Identifier: MIT
 * Stands in for gltf.cc in a build without tinygltf: says so. Reading is not reached, since the
 * table of formats asks first. Writing glTF needs no library.
 */
#include "io/adapter.h"

bool csg_gltf_available(void)
{
    return false;
}

csgm_status csg_gltf_parse(const char *json, size_t json_bytes, const uint8_t *bin,
                           size_t bin_bytes, const csg_gltf_calls *calls, csg_adapter_error *error)
{
    (void)json, (void)json_bytes, (void)bin, (void)bin_bytes, (void)calls, (void)error;
    return CSGM_ERR_UNSUPPORTED;
}
