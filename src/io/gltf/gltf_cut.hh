/* SPDX-License-Identifier: MIT
 * A glTF document before tinygltf sees it: nlohmann's JSON, cut down to what geometry needs
 * (free-form "extras" would let tinygltf recurse without bound), and what tinygltf does not read:
 * compressed primitives and views, colours of materials, the unit.
 */
#ifndef CSG_IO_GLTF_CUT_HH
#define CSG_IO_GLTF_CUT_HH

#include <cstdarg>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "io/adapter.h"

namespace csg_gltf
{

using nlohmann::json;

struct trouble {
    csgm_status status;
    std::string text;
};

[[noreturn]] void refuse(csgm_status status, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* A primitive compressed with Draco. */
struct compressed {
    int64_t view;
    csg_draco_ids ids;
};

/* What a material says of colour: linear. */
struct base_color {
    float rgba[4];
    bool is_told;         /* else it is how glTF shows what has no colour */
    uint16_t material[2]; /* metallic and roughness, as csg_adapter_part has them */
    bool has_material;
    bool is_opaque; /* what it says of alpha is not meant */
};

/* A view compressed by meshoptimizer: where its bytes are. */
struct packed {
    int64_t buffer, offset, size;
    csg_meshopt_view view; /* without bytes */
};

struct facts {
    std::vector<bool> more; /* nodes that go on with the part of the node before them */
    std::map<size_t, packed> packed_views;                 /* by view */
    std::map<std::pair<size_t, size_t>, compressed> draco; /* by mesh and primitive */
    std::vector<base_color> materials;
    double scale = 1;   /* by which roots are divided, exactly */
    double enlarge = 1; /* what the coordinates are multiplied by at the end */
    bool ours = false;
    bool z_up = false; /* the scene was not turned */
    csgm_unit unit = CSGM_UNIT_MM;
    bool says_unit = true;
};

/* bytes_of_element: of tinygltf's largest struct. Throws trouble, as all of these. */
json parse(const char *text, size_t size, const csg_gltf_calls *calls, uint64_t bytes_of_element);
void check_version(const json &root);
/* Materials and textures do not change triangles; anything else that is required may. */
void check_extensions(const json &root);
json cut_down(facts &out, const json &root);

/* gltf_left_out.cc: what the document has and meshes have not, in words; "" where that is nothing.
 */
std::string left_out(const json &root, bool ours);

const json *member(const json &object, const char *name);
int64_t integer(const json *value, int64_t otherwise);

} // namespace csg_gltf
#endif
