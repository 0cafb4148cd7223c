/* SPDX-License-Identifier: MIT
 * Documents before tinygltf; see gltf_cut.hh.
 */
#include "io/gltf/gltf_cut.hh"

#include <algorithm>
#include <cstdlib>

#include "io/parts.h"
#include "io/units.h"

namespace csg_gltf
{

void refuse(csgm_status status, const char *format, ...)
{
    char text[sizeof(csg_adapter_error)];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    throw trouble{status, text};
}

/* ---- before tinygltf: a smaller document ------------------------------------------------------
 */

/* Whether the system has so much. nlohmann's values allocate when they are destroyed, so memory
 * that ends among them ends the program: it is asked for as a whole before there is one. */
static bool can_be_had(uint64_t bytes)
{
    void *volatile room = bytes <= SIZE_MAX ? std::malloc(static_cast<size_t>(bytes)) : nullptr;
    bool is_there = room;
    std::free(room);
    return is_there;
}

/* The parser itself does not recurse, but what walks its result may. And neither it nor tinygltf
 * can be told how much memory there is: what they will take is bounded from what is in the text. */
static void check_document(const char *text, size_t size, const csg_gltf_calls *calls,
                           uint64_t bytes_of_element)
{
    constexpr int most = 64; /* our documents need 9 */
    /* arrays that grow hold half as much again as they had, beside it */
    const uint64_t element = 3 * bytes_of_element;
    /* as trees of nlohmann's, twice at the same time */
    constexpr uint64_t value = 2 * 3 * sizeof(json), key = 2 * (sizeof(std::string) + 64);
    uint64_t bytes = 4 * size;
    int depth = 0;
    bool quoted = false;
    for (size_t i = 0; i < size; i++) {
        char c = text[i];
        if (quoted) {
            i += c == '\\';
            quoted = c != '"';
        } else if (c == '"') {
            quoted = true;
        } else if (c == '[' || c == '{') {
            if (++depth > most)
                refuse(CSGM_ERR_FORMAT, "the JSON is nested more than %d deep", most);
            bytes += c == '{' ? element + value : value;
        } else if (c == ',') {
            bytes += value;
        } else if (c == ':') {
            bytes += key;
        } else if (c == ']' || c == '}') {
            depth--;
        }
    }
    if (!calls->allows(calls->user, bytes) || !can_be_had(bytes))
        refuse(CSGM_ERR_MEMORY, "the document takes too much memory");
}

json parse(const char *text, size_t size, const csg_gltf_calls *calls, uint64_t bytes_of_element)
{
    check_document(text, size, calls, bytes_of_element);
    try {
        json root = json::parse(text, text + size);
        if (!root.is_object())
            refuse(CSGM_ERR_FORMAT, "a glTF document is a JSON object");
        return root;
    } catch (const json::parse_error &e) {
        refuse(CSGM_ERR_FORMAT, "the JSON is broken at byte %zu of it", e.byte);
    }
}

const json *member(const json &object, const char *name)
{
    if (!object.is_object())
        return nullptr;
    auto at = object.find(name);
    return at == object.end() ? nullptr : &*at;
}

/* The members named, of each object of an array. */
static json keep_members(const json &array, const std::vector<const char *> &names)
{
    json out = json::array();
    for (const json &from : array) {
        json to = json::object();
        for (const char *name : names)
            if (const json *value = member(from, name))
                to[name] = *value;
        out.push_back(std::move(to));
    }
    return out;
}

int64_t integer(const json *value, int64_t otherwise)
{
    return value && value->is_number_integer() ? value->get<int64_t>() : otherwise;
}

/* Remembers a compressed primitive; its indices accessor has no view, which tinygltf refuses. */
static void note_draco(facts &doc, size_t mesh, size_t primitive, const json &from, json &to)
{
    const json *extensions = member(from, "extensions");
    const json *draco = extensions ? member(*extensions, "KHR_draco_mesh_compression") : nullptr;
    const json *ids = draco ? member(*draco, "attributes") : nullptr;
    if (!draco)
        return;
    if (!ids)
        refuse(CSGM_ERR_FORMAT, "a compressed primitive names no attributes");
    doc.draco[{mesh, primitive}] = {integer(member(*draco, "bufferView"), -1),
                                    {integer(member(*ids, "POSITION"), -1),
                                     integer(member(*ids, "NORMAL"), -1),
                                     integer(member(*ids, "COLOR_0"), -1)}};
    to.erase("indices");
}

static json keep_meshes(facts &doc, const json &meshes)
{
    json out = json::array();
    for (const json &mesh : meshes) {
        json primitives = json::array();
        if (const json *from = member(mesh, "primitives"); from && from->is_array()) {
            primitives = keep_members(*from, {"attributes", "indices", "mode", "material"});
            for (size_t i = 0; i < from->size(); i++)
                note_draco(doc, out.size(), i, (*from)[i], primitives[i]);
        }
        out.push_back({{"primitives", std::move(primitives)}});
        if (const json *name = member(mesh, "name"); name && name->is_string())
            out.back()["name"] = *name;
    }
    return out;
}

static std::string text_of(const json *value)
{
    return value && value->is_string() ? value->get<std::string>() : std::string();
}

/* glTF is in metres and ours in millimetres, but files of csgmesh say what their scene's unit was
 * and whether it was turned. Older ones do not: their numbers are taken as they are. */
static void note_asset(facts &out, const json &root)
{
    const json *asset = member(root, "asset");
    const json *extras = asset ? member(*asset, "extras") : nullptr;
    bool ours = out.ours = asset && text_of(member(*asset, "generator")).rfind("csgmesh ", 0) == 0;
    csgm_unit unit;
    if (!ours)
        out.enlarge = 1 / csg_unit_metres(CSGM_UNIT_MM);
    else if (extras && csg_unit_from_word(text_of(member(*extras, "unit")).c_str(), &unit))
        out.scale = csg_unit_metres(out.unit = unit);
    else
        out.says_unit = false;
    out.z_up = ours && extras && text_of(member(*extras, "up")) == "z";
}

/* A picture of them has its own values, of which factors say nothing. */
static void note_finish(base_color &out, const json *pbr)
{
    if (!pbr || member(*pbr, "metallicRoughnessTexture"))
        return;
    static const char *const names[] = {"metallicFactor", "roughnessFactor"};
    for (size_t k = 0; k < 2; k++) {
        const json *factor = member(*pbr, names[k]);
        double value = factor && factor->is_number() ? factor->get<double>() : 1;
        value = std::clamp(value, 0.0, 1.0); /* a NaN is no JSON */
        out.material[k] = static_cast<uint16_t>(value * CSG_MATERIAL_ONE + 0.5);
    }
    out.has_material = true;
}

/* White is what other programs say where nothing has a colour. */
static void note_materials(facts &out, const json &root)
{
    const json *materials = member(root, "materials");
    if (!materials || !materials->is_array())
        return;
    for (const json &material : *materials) {
        base_color color = {{1, 1, 1, 1}, false, {0, 0}, false, false};
        const json *extras = member(material, "extras");
        const json *uncolored = extras ? member(*extras, "uncolored") : nullptr;
        const json *pbr = member(material, "pbrMetallicRoughness");
        const json *factor = pbr ? member(*pbr, "baseColorFactor") : nullptr;
        if (factor && factor->is_array() && factor->size() == 4 && !uncolored) {
            for (size_t k = 0; k < 4; k++)
                color.rgba[k] = (*factor)[k].is_number() ? (*factor)[k].get<float>() : 1;
            color.is_told = out.ours || color.rgba[0] != 1 || color.rgba[1] != 1 ||
                            color.rgba[2] != 1 || color.rgba[3] != 1;
        }
        std::string mode = text_of(member(material, "alphaMode"));
        color.is_opaque = !out.ours && mode != "BLEND" && mode != "MASK"; /* older ones of ours */
        note_finish(color, pbr);
        out.materials.push_back(color);
    }
}

/* What the extension demands of the numbers is demanded here, since the codec trusts them. */
static void check_packed(const packed &p, size_t view)
{
    uint64_t stride = p.view.stride, count = p.view.count;
    bool good = p.buffer >= 0 && p.offset >= 0 && p.size >= 0 && count && count <= UINT32_MAX;
    if (p.view.mode == CSG_MESHOPT_ATTRIBUTES)
        good = good && stride && stride <= 256 && stride % 4 == 0;
    else
        good = good && (stride == 2 || stride == 4) && p.view.filter == CSG_MESHOPT_NONE;
    if (p.view.mode == CSG_MESHOPT_TRIANGLES)
        good = good && count % 3 == 0;
    if (p.view.filter == CSG_MESHOPT_OCTAHEDRAL || p.view.filter == CSG_MESHOPT_COLOR)
        good = good && (stride == 4 || stride == 8);
    if (p.view.filter == CSG_MESHOPT_QUATERNION)
        good = good && stride == 8;
    if (!good)
        refuse(CSGM_ERR_FORMAT, "the compression of bufferView %zu has numbers that cannot be",
               view);
}

/* One of these words; the first, where nothing is said. */
static int word_of(const json *value, std::initializer_list<const char *> words, size_t view)
{
    int number = 0;
    for (const char *word : words) {
        if (value ? text_of(value) == word : number == 0)
            return number;
        number++;
    }
    refuse(CSGM_ERR_UNSUPPORTED, "bufferView %zu is compressed in a way that is not read", view);
}

/* Our pieces of a part that is there in several. */
static void note_nodes(facts &out, const json &root)
{
    const json *nodes = member(root, "nodes");
    for (size_t i = 0; nodes && nodes->is_array() && i < nodes->size(); i++) {
        const json *extras = member((*nodes)[i], "extras");
        const json *more = extras ? member(*extras, "more") : nullptr;
        out.more.push_back(out.ours && more && more->is_boolean() && more->get<bool>());
    }
}

static void note_packed(facts &out, const json &root)
{
    const json *views = member(root, "bufferViews");
    for (size_t i = 0; views && views->is_array() && i < views->size(); i++) {
        const json *extensions = member((*views)[i], "extensions");
        const json *found = extensions ? member(*extensions, "EXT_meshopt_compression") : nullptr;
        bool is_khr = !found && extensions;
        if (is_khr)
            found = member(*extensions, "KHR_meshopt_compression");
        if (!found)
            continue;
        packed p = {integer(member(*found, "buffer"), -1),
                    integer(member(*found, "byteOffset"), 0),
                    integer(member(*found, "byteLength"), -1),
                    {}};
        p.view.mode = static_cast<csg_meshopt_mode>(
            word_of(member(*found, "mode"), {"ATTRIBUTES", "TRIANGLES", "INDICES"}, i));
        p.view.filter = static_cast<csg_meshopt_filter>(
            word_of(member(*found, "filter"),
                    {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", is_khr ? "COLOR" : ""}, i));
        p.view.count = static_cast<uint64_t>(integer(member(*found, "count"), -1));
        p.view.stride = static_cast<uint64_t>(integer(member(*found, "byteStride"), -1));
        check_packed(p, i);
        out.packed_views[i] = p;
    }
}

json cut_down(facts &doc, const json &root)
{
    json out = json::object();
    auto copy = [&](const char *name, const std::vector<const char *> &names) {
        if (const json *array = member(root, name); array && array->is_array())
            out[name] = keep_members(*array, names);
    };
    out["asset"] = {{"version", "2.0"}};
    if (const json *scene = member(root, "scene"))
        out["scene"] = *scene;
    copy("scenes", {"nodes"});
    copy("nodes", {"children", "mesh", "name", "matrix", "translation", "rotation", "scale"});
    copy("accessors",
         {"bufferView", "byteOffset", "componentType", "normalized", "count", "type", "sparse"});
    copy("bufferViews", {"buffer", "byteOffset", "byteLength", "byteStride"});
    note_asset(doc, root);
    note_materials(doc, root);
    note_packed(doc, root);
    note_nodes(doc, root);
    if (const json *meshes = member(root, "meshes"); meshes && meshes->is_array())
        out["meshes"] = keep_meshes(doc, *meshes);
    return out;
}

/* Materials and textures do not change triangles; anything else that is required may. */
void check_extensions(const json &root)
{
    const json *required = member(root, "extensionsRequired");
    if (!required || !required->is_array())
        return;
    for (const json &item : *required) {
        std::string name = item.is_string() ? item.get<std::string>() : "?";
        bool harmless = name.rfind("KHR_materials_", 0) == 0 ||
                        name.rfind("KHR_texture_", 0) == 0 || name.rfind("EXT_texture_", 0) == 0 ||
                        name == "KHR_lights_punctual" || name == "KHR_mesh_quantization";
        if (name == "KHR_draco_mesh_compression") {
            if (!csg_draco_available())
                refuse(CSGM_ERR_UNSUPPORTED, "it is compressed with Draco, and this csgmesh was "
                                             "built without Draco");
        } else if (name == "EXT_meshopt_compression" || name == "KHR_meshopt_compression") {
            if (!csg_meshopt_available())
                refuse(CSGM_ERR_UNSUPPORTED, "it is compressed by meshoptimizer, and this csgmesh "
                                             "was built without it");
        } else if (!harmless) {
            refuse(CSGM_ERR_UNSUPPORTED, "it requires the extension '%.80s', which is not read",
                   name.c_str());
        }
    }
}

void check_version(const json &root)
{
    const json *asset = member(root, "asset");
    const json *version = asset ? member(*asset, "version") : nullptr;
    if (!version || !version->is_string())
        refuse(CSGM_ERR_FORMAT, "the document has no asset.version");
    if (version->get<std::string>().rfind("2.", 0) != 0)
        refuse(CSGM_ERR_UNSUPPORTED, "glTF version %.20s is not read, only 2.0",
               version->get<std::string>().c_str());
}

} // namespace csg_gltf
