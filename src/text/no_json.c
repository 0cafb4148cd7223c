/* SPDX-License-Identifier: MIT
 * Stands in for json.cc in a build without nlohmann's JSON: says so. Reading is not reached, since
 * callers ask first.
 */
#include "text/json.h"

bool csg_json_available(void)
{
    return false;
}

csg_json_outcome csg_json_read(const char *text, size_t length, csg_json_fn *event, void *user,
                               csg_json_error *error)
{
    (void)text, (void)length, (void)event, (void)user;
    *error = (csg_json_error){0, "this build has no JSON library"};
    return CSG_JSON_BROKEN;
}
