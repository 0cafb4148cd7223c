/* SPDX-License-Identifier: MIT
 * What a glTF document has and a mesh has no place for, in words, so that who converts it can be
 * told. What a file of csgmesh says of itself (its unit, its source) is no such thing.
 */
#include "io/gltf/gltf_cut.hh"

namespace csg_gltf
{

namespace
{

struct words {
    std::string text;

    void add(const std::string &what)
    {
        text += (text.empty() ? "" : ", ") + what;
    }

    void count(size_t number, const char *noun)
    {
        if (number)
            add(std::to_string(number) + " " + noun + (number > 1 ? "s" : ""));
    }
};

size_t size_of(const json *array)
{
    return array && array->is_array() ? array->size() : 0;
}

size_t size_of(const json &root, const char *name)
{
    return size_of(member(root, name));
}

/* What primitives have beside positions, normals, colours and triangles. */
struct primitive_facts {
    bool has_coordinates, has_targets, has_lines;
};

void look_at(const json &primitive, primitive_facts &out)
{
    const json *attributes = member(primitive, "attributes");
    int64_t mode = integer(member(primitive, "mode"), 4);
    out.has_coordinates |= attributes && member(*attributes, "TEXCOORD_0");
    out.has_targets |= size_of(primitive, "targets") > 0;
    out.has_lines |= mode >= 0 && mode < 4;
}

primitive_facts look_at_meshes(const json &root)
{
    primitive_facts out = {};
    const json *meshes = member(root, "meshes");
    for (size_t i = 0; i < size_of(meshes); i++) {
        const json *primitives = member((*meshes)[i], "primitives");
        for (size_t k = 0; k < size_of(primitives); k++)
            look_at((*primitives)[k], out);
    }
    return out;
}

/* Ours have a picture where metallic and roughness vary within a part. */
bool has_finishes(const json &root)
{
    const json *materials = member(root, "materials");
    for (size_t i = 0; i < size_of(materials); i++) {
        const json *pbr = member((*materials)[i], "pbrMetallicRoughness");
        if (pbr && member(*pbr, "metallicRoughnessTexture"))
            return true;
    }
    return false;
}

bool has_levels(const json &root)
{
    const json *nodes = member(root, "nodes");
    for (size_t i = 0; i < size_of(nodes); i++) {
        const json *extensions = member((*nodes)[i], "extensions");
        if (extensions && member(*extensions, "MSFT_lod"))
            return true;
    }
    return false;
}

size_t count_lights(const json &root)
{
    const json *extensions = member(root, "extensions");
    const json *lights = extensions ? member(*extensions, "KHR_lights_punctual") : nullptr;
    return lights ? size_of(*lights, "lights") : 0;
}

/* Title, author and the like. */
bool has_metadata(const json &root, bool ours)
{
    const json *asset = member(root, "asset");
    const json *extras = asset ? member(*asset, "extras") : nullptr;
    if (asset && member(*asset, "copyright"))
        return true;
    if (!ours || !extras || !extras->is_object())
        return extras && !extras->empty();
    for (const auto &item : extras->items())
        if (item.key() != "unit" && item.key() != "up" && item.key() != "source")
            return true;
    return false;
}

} // namespace

std::string left_out(const json &root, bool ours)
{
    words out;
    primitive_facts primitives = look_at_meshes(root);
    size_t textures = size_of(root, "textures");
    if (ours && has_finishes(root)) {
        out.add("metallic and roughness that vary within a part");
        primitives.has_coordinates = false;
    } else if (!ours) {
        out.count(textures, "texture");
    }
    if (primitives.has_coordinates && (ours || !textures))
        out.add("texture coordinates");
    out.count(size_of(root, "animations"), "animation");
    out.count(size_of(root, "skins"), "skin");
    if (primitives.has_targets)
        out.add("morph targets");
    if (primitives.has_lines)
        out.add("points and lines");
    if (has_levels(root))
        out.add("levels of detail");
    out.count(size_of(root, "cameras"), "camera");
    out.count(count_lights(root), "light");
    if (size_of(root, "scenes") > 1)
        out.count(size_of(root, "scenes") - 1, "further scene");
    if (has_metadata(root, ours))
        out.add("metadata");
    return out.text;
}

} // namespace csg_gltf
