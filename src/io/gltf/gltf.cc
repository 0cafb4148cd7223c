/* SPDX-License-Identifier: MIT
 * The only file that names tinygltf: a glTF document ->
 * its triangles, node by node. tinygltf turns the JSON into accessors, views, meshes and nodes;
 * what it does not do is done here. Before it: the document is cut down to what geometry needs
 * (free-form "extras" would let it recurse without bound), buffers are resolved without copies, and
 * compressed primitives lose the indices that a tinygltf without Draco refuses. After it: every
 * number is checked against the bytes that are there before anything is allocated. Not read: sparse
 * accessors, morph targets, skins, required extensions that change geometry in other ways.
 */
#include "io/gltf/gltf_cut.hh"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <new>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#include <tiny_gltf.h>

namespace
{

using namespace csg_gltf;

struct span {
    const uint8_t *bytes;
    size_t size;
};

struct document {
    const csg_gltf_calls *calls;
    std::vector<span> buffers;
    std::vector<std::vector<unsigned char>> embedded;        /* bytes of data URIs */
    mutable std::map<size_t, std::vector<uint8_t>> unpacked; /* views, when they are asked for */
    facts told;
    tinygltf::Model model;
};

/* ---- buffers ------------------------------------------------------------------------------------
 */

std::string percent_decoded(const std::string &uri)
{
    std::string out;
    for (size_t i = 0; i < uri.size(); i++) {
        unsigned byte;
        if (uri[i] == '%' && i + 2 < uri.size() &&
            /* NOLINTNEXTLINE(cert-err34-c): two digits always fit */
            std::sscanf(uri.substr(i + 1, 2).c_str(), "%2x", &byte) == 1) {
            out += static_cast<char>(byte);
            i += 2;
        } else {
            out += uri[i];
        }
    }
    return out;
}

span find_buffer(document &doc, const std::string &uri)
{
    if (tinygltf::IsDataURI(uri)) {
        std::string mime;
        doc.embedded.emplace_back();
        if (!tinygltf::DecodeDataURI(&doc.embedded.back(), mime, uri, 0, false))
            refuse(CSGM_ERR_FORMAT, "a buffer's base64 cannot be decoded");
        return {doc.embedded.back().data(), doc.embedded.back().size()};
    }
    span found{};
    std::string name = percent_decoded(uri);
    if (name.empty() || name.find('\0') != std::string::npos)
        refuse(CSGM_ERR_FORMAT, "a buffer names no file");
    csgm_status status = doc.calls->load(doc.calls->user, name.c_str(), &found.bytes, &found.size);
    if (status)
        throw trouble{status, ""}; /* reported there */
    return found;
}

void resolve_buffers(document &doc, const json &root, span bin)
{
    const json *buffers = member(root, "buffers");
    if (!buffers || !buffers->is_array())
        return;
    for (const json &buffer : *buffers) {
        const json *uri = member(buffer, "uri");
        int64_t told = integer(member(buffer, "byteLength"), -1);
        span found{};
        if (uri && uri->is_string())
            found = find_buffer(doc, uri->get_ref<const std::string &>());
        else if (doc.buffers.empty() && bin.bytes)
            found = bin;
        else if (!uri && !doc.told.packed_views.empty())
            told = 0; /* it stands for what is unpacked */
        else
            refuse(CSGM_ERR_FORMAT, "buffer %zu has no bytes", doc.buffers.size());
        if (told < 0 || static_cast<uint64_t>(told) > found.size)
            refuse(CSGM_ERR_FORMAT, "buffer %zu ends too soon: it says %lld bytes and has %zu",
                   doc.buffers.size(), static_cast<long long>(told), found.size);
        found.size = static_cast<size_t>(told);
        doc.buffers.push_back(found);
    }
}

/* ---- accessors ----------------------------------------------------------------------------------
 */

/* Each is unpacked once. */
span unpack(const document &doc, size_t index, const packed &from)
{
    auto done = doc.unpacked.find(index);
    if (done != doc.unpacked.end())
        return {done->second.data(), done->second.size()};
    csg_meshopt_view view = from.view;
    if (static_cast<size_t>(from.buffer) >= doc.buffers.size())
        refuse(CSGM_ERR_FORMAT, "there is no buffer %lld", static_cast<long long>(from.buffer));
    const span &buffer = doc.buffers[static_cast<size_t>(from.buffer)];
    view.size = static_cast<uint64_t>(from.size);
    if (static_cast<uint64_t>(from.offset) > buffer.size ||
        view.size > buffer.size - static_cast<uint64_t>(from.offset))
        refuse(CSGM_ERR_FORMAT, "compressed bufferView %zu goes beyond the end of its buffer",
               index);
    view.bytes = buffer.bytes + from.offset;
    /* eight elements take a bit or more: what says more is broken */
    if (view.count / 8 > 64 * (view.size + 16))
        refuse(CSGM_ERR_FORMAT, "compressed bufferView %zu has too few bytes", index);
    uint64_t bytes = view.count * view.stride;
    if (!doc.calls->allows(doc.calls->user, bytes))
        refuse(CSGM_ERR_MEMORY, "a compressed view takes too much memory");
    std::vector<uint8_t> &out = doc.unpacked[index];
    out.resize(bytes);
    if (!csg_meshopt_decode(&view, out.data()))
        refuse(CSGM_ERR_FORMAT, "compressed bufferView %zu is broken, or of a later version",
               index);
    return {out.data(), out.size()};
}

span view_bytes(const document &doc, int64_t index)
{
    if (index < 0 || static_cast<uint64_t>(index) >= doc.model.bufferViews.size())
        refuse(CSGM_ERR_FORMAT, "there is no bufferView %lld", static_cast<long long>(index));
    auto compressed_view = doc.told.packed_views.find(static_cast<size_t>(index));
    if (compressed_view != doc.told.packed_views.end())
        return unpack(doc, static_cast<size_t>(index), compressed_view->second);
    const tinygltf::BufferView &view = doc.model.bufferViews[static_cast<size_t>(index)];
    if (view.buffer < 0 || static_cast<size_t>(view.buffer) >= doc.buffers.size())
        refuse(CSGM_ERR_FORMAT, "there is no buffer %d", view.buffer);
    const span &buffer = doc.buffers[static_cast<size_t>(view.buffer)];
    if (view.byteOffset > buffer.size || view.byteLength > buffer.size - view.byteOffset)
        refuse(CSGM_ERR_FORMAT, "bufferView %lld goes beyond the end of its buffer",
               static_cast<long long>(index));
    return {buffer.bytes + view.byteOffset, view.byteLength};
}

/* An accessor whose bytes are known to be there. */
struct values {
    const uint8_t *bytes;
    size_t count, stride;
    int component;
    bool normalized;
    uint32_t components;
};

values open_accessor(const document &doc, int index)
{
    if (index < 0 || static_cast<size_t>(index) >= doc.model.accessors.size())
        refuse(CSGM_ERR_FORMAT, "there is no accessor %d", index);
    const tinygltf::Accessor &accessor = doc.model.accessors[static_cast<size_t>(index)];
    int size = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(accessor.componentType));
    int components = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type));
    if (accessor.sparse.isSparse || accessor.bufferView < 0)
        refuse(CSGM_ERR_UNSUPPORTED, "accessor %d is sparse or empty, which is not read", index);
    if (size <= 0 || components <= 0 || components > 4)
        refuse(CSGM_ERR_FORMAT, "accessor %d has no type", index);
    span bytes = view_bytes(doc, accessor.bufferView);
    size_t element = static_cast<size_t>(size) * static_cast<size_t>(components);
    size_t stride = doc.model.bufferViews[static_cast<size_t>(accessor.bufferView)].byteStride;
    stride = stride ? stride : element;
    if (accessor.byteOffset > bytes.size || stride > 65536)
        refuse(CSGM_ERR_FORMAT, "accessor %d goes beyond the end of its bufferView", index);
    bytes.bytes += accessor.byteOffset;
    bytes.size -= accessor.byteOffset;
    if (accessor.count &&
        (bytes.size < element || (bytes.size - element) / stride + 1 < accessor.count))
        refuse(CSGM_ERR_FORMAT, "accessor %d goes beyond the end of its bufferView", index);
    return {bytes.bytes,
            accessor.count,
            stride,
            accessor.componentType,
            accessor.normalized,
            static_cast<uint32_t>(components)};
}

template <typename T> T load(const uint8_t *at)
{
    T value;
    std::memcpy(&value, at, sizeof value); /* both little endian */
    return value;
}

float load_float(const values &v, const uint8_t *at)
{
    auto scaled = [&](float value, float most) {
        return !v.normalized ? value : value < -most ? -1.0f : value / most;
    };
    switch (v.component) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return load<float>(at);
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return scaled(load<int8_t>(at), 127);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return scaled(load<uint8_t>(at), 255);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return scaled(load<int16_t>(at), 32767);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return scaled(load<uint16_t>(at), 65535);
    default:
        refuse(CSGM_ERR_UNSUPPORTED, "vertex data of component type %d is not read", v.component);
    }
}

std::vector<float> read_floats(const values &v)
{
    std::vector<float> out(v.count * v.components);
    size_t size =
        static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(v.component)));
    for (size_t i = 0; i < v.count; i++)
        for (size_t k = 0; k < v.components; k++)
            out[i * v.components + k] = load_float(v, v.bytes + i * v.stride + k * size);
    return out;
}

std::vector<uint32_t> read_indices(const document &doc, int accessor)
{
    values v = open_accessor(doc, accessor);
    std::vector<uint32_t> out(v.count);
    for (size_t i = 0; i < v.count; i++) {
        const uint8_t *at = v.bytes + i * v.stride;
        switch (v.component) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            out[i] = *at;
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            out[i] = load<uint16_t>(at);
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            out[i] = load<uint32_t>(at);
            break;
        default:
            refuse(CSGM_ERR_FORMAT, "indices of component type %d", v.component);
        }
    }
    return out;
}

/* ---- primitives ---------------------------------------------------------------------------------
 */

struct arrays {
    std::vector<float> positions, normals, colors;
    std::vector<uint32_t> indices;
    uint32_t color_components = 0;
};

/* Strips and fans become separate triangles. */
std::vector<uint32_t> to_triangles(const std::vector<uint32_t> &in, int mode)
{
    std::vector<uint32_t> out;
    for (size_t i = 2; i < in.size(); i++) {
        bool odd = mode == TINYGLTF_MODE_TRIANGLE_STRIP && i % 2;
        uint32_t a = mode == TINYGLTF_MODE_TRIANGLE_FAN ? in[0] : in[i - 2];
        out.insert(out.end(), {odd ? in[i - 1] : a, odd ? a : in[i - 1], in[i]});
    }
    return out;
}

std::vector<float> attribute(const document &doc, const tinygltf::Primitive &primitive,
                             const char *name, uint32_t *components)
{
    *components = 0;
    auto at = primitive.attributes.find(name);
    if (at == primitive.attributes.end())
        return {};
    values v = open_accessor(doc, at->second);
    *components = v.components;
    return read_floats(v);
}

arrays read_plain(const document &doc, const tinygltf::Primitive &primitive)
{
    arrays out;
    uint32_t components, normal_components;
    out.positions = attribute(doc, primitive, "POSITION", &components);
    out.normals = attribute(doc, primitive, "NORMAL", &normal_components);
    out.colors = attribute(doc, primitive, "COLOR_0", &out.color_components);
    size_t count = out.positions.size() / 3;
    if (components != 3 && components != 0)
        refuse(CSGM_ERR_FORMAT, "positions are not of type VEC3");
    if (!out.normals.empty() && (normal_components != 3 || out.normals.size() != count * 3))
        refuse(CSGM_ERR_FORMAT, "there are not as many normals as positions");
    if (!out.colors.empty() && (out.color_components < 3 || out.color_components > 4 ||
                                out.colors.size() != count * out.color_components))
        refuse(CSGM_ERR_FORMAT, "there are not as many colours as positions");
    if (primitive.indices >= 0)
        out.indices = read_indices(doc, primitive.indices);
    else
        for (size_t i = 0; i < count; i++)
            out.indices.push_back(static_cast<uint32_t>(i));
    if (primitive.mode != TINYGLTF_MODE_TRIANGLES)
        out.indices = to_triangles(out.indices, primitive.mode);
    if (out.indices.size() % 3)
        refuse(CSGM_ERR_FORMAT, "the number of indices is not a multiple of three");
    for (uint32_t index : out.indices)
        if (index >= count)
            refuse(CSGM_ERR_FORMAT, "an index is out of range");
    return out;
}

using transform = std::array<double, 12>;

/* Where primitives of a mesh come from: its node's place, and the name of the part they are. */
struct origin {
    transform place;
    const char *name;
    bool begins;
};

/* Hands a part over, with its material's colour. */
void emit(const document &doc, csg_adapter_part &part, const origin &at, int material)
{
    std::vector<float> colors;
    size_t index = static_cast<size_t>(material);
    bool is_there = material >= 0 && index < doc.told.materials.size();
    if (is_there && doc.told.materials[index].has_material)
        part.material = doc.told.materials[index].material;
    bool is_opaque = is_there ? doc.told.materials[index].is_opaque : !doc.told.ours;
    uint32_t components = part.colors ? part.color_components : 0;
    if ((is_there && doc.told.materials[index].is_told) || (is_opaque && components == 4)) {
        static const float white[4] = {1, 1, 1, 1};
        const float *factor = is_there ? doc.told.materials[index].rgba : white;
        colors.resize(4 * part.vertex_count);
        for (size_t i = 0; i < part.vertex_count; i++)
            for (size_t k = 0; k < 4; k++)
                colors[4 * i + k] =
                    k == 3 && is_opaque
                        ? 1
                        : factor[k] * (k < components ? part.colors[components * i + k] : 1);
        part.colors = colors.data();
        part.color_components = 4;
    }
    part.begins = at.begins;
    part.name = at.name;
    transform place = at.place;
    for (double &entry : place)
        entry *= doc.told.enlarge;
    csgm_status status = doc.calls->part(doc.calls->user, &part, place.data());
    if (status)
        throw trouble{status, ""};
}

void emit_compressed(const document &doc, const compressed &from, const origin &at, int material)
{
    span bytes = view_bytes(doc, from.view);
    csg_adapter_error error = {};
    csg_draco_decoded decoded = {};
    if (!csg_draco_available())
        refuse(CSGM_ERR_UNSUPPORTED, "it is compressed with Draco, and this csgmesh was built "
                                     "without Draco");
    csgm_status status = csg_draco_decode(bytes.bytes, bytes.size, &from.ids, doc.calls->most_bytes,
                                          &decoded, &error);
    if (error.is_limit)
        doc.calls->allows(doc.calls->user, UINT64_MAX / 2); /* it is noted as refused */
    if (status)
        refuse(status, "a compressed primitive: %s", error.text);
    struct guard {
        csg_draco_decoded &of;
        ~guard()
        {
            csg_draco_release_decoded(&of);
        }
    } release{decoded};
    emit(doc, decoded.part, at, material);
}

void emit_primitive(const document &doc, size_t mesh, size_t index, const origin &at)
{
    const tinygltf::Primitive &primitive = doc.model.meshes[mesh].primitives[index];
    if (primitive.mode < TINYGLTF_MODE_TRIANGLES || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
        return; /* points and lines are no surface */
    auto draco = doc.told.draco.find({mesh, index});
    if (draco != doc.told.draco.end()) {
        emit_compressed(doc, draco->second, at, primitive.material);
        return;
    }
    arrays in = read_plain(doc, primitive);
    csg_adapter_part part = {};
    part.positions = in.positions.data();
    part.normals = in.normals.empty() ? nullptr : in.normals.data();
    part.colors = in.colors.empty() ? nullptr : in.colors.data();
    part.color_components = in.color_components;
    part.indices = in.indices.data();
    part.vertex_count = in.positions.size() / 3;
    part.index_count = in.indices.size();
    emit(doc, part, at, primitive.material);
}

/* ---- nodes --------------------------------------------------------------------------------------
 */

transform identity()
{
    return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
}

/* First b, then a; rows of [m | t]. */
transform multiply(const transform &a, const transform &b)
{
    transform out;
    for (size_t r = 0; r < 3; r++)
        for (size_t c = 0; c < 4; c++)
            out[4 * r + c] = a[4 * r] * b[c] + a[4 * r + 1] * b[4 + c] + a[4 * r + 2] * b[8 + c] +
                             (c == 3 ? a[4 * r + 3] : 0);
    return out;
}

transform from_quaternion(const std::vector<double> &q, const std::vector<double> &s)
{
    double x = q[0], y = q[1], z = q[2], w = q[3];
    return {(1 - 2 * (y * y + z * z)) * s[0], 2 * (x * y - z * w) * s[1],
            2 * (x * z + y * w) * s[2],       0,
            2 * (x * y + z * w) * s[0],       (1 - 2 * (x * x + z * z)) * s[1],
            2 * (y * z - x * w) * s[2],       0,
            2 * (x * z - y * w) * s[0],       2 * (y * z + x * w) * s[1],
            (1 - 2 * (x * x + y * y)) * s[2], 0};
}

transform local_transform(const tinygltf::Node &node)
{
    transform out = identity();
    if (node.matrix.size() == 16) { /* column-major */
        for (size_t r = 0; r < 3; r++)
            for (size_t c = 0; c < 4; c++)
                out[4 * r + c] = node.matrix[4 * c + r];
        return out;
    }
    std::vector<double> s = node.scale.size() == 3 ? node.scale : std::vector<double>{1, 1, 1};
    std::vector<double> q =
        node.rotation.size() == 4 ? node.rotation : std::vector<double>{0, 0, 0, 1};
    out = from_quaternion(q, s);
    for (size_t r = 0; r < 3 && node.translation.size() == 3; r++)
        out[4 * r + 3] = node.translation[r];
    return out;
}

/* Of a root, divided by the length of a scene unit: the matrix that we write becomes a whole one.
 */
transform node_transform(const tinygltf::Node &node, double divisor)
{
    transform out = local_transform(node);
    for (double &entry : out)
        entry /= divisor;
    return out;
}

/* What undoes the turn of a scene that was not turned. */
transform upright(const document &doc)
{
    return doc.told.z_up ? transform{1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0} : identity();
}

void emit_mesh(const document &doc, int mesh, const transform &place, const std::string &node_name,
               bool more)
{
    if (mesh < 0)
        return;
    if (static_cast<size_t>(mesh) >= doc.model.meshes.size())
        refuse(CSGM_ERR_FORMAT, "there is no mesh %d", mesh);
    const tinygltf::Mesh &from = doc.model.meshes[static_cast<size_t>(mesh)];
    const std::string &name = node_name.empty() ? from.name : node_name;
    for (size_t i = 0; i < from.primitives.size(); i++)
        emit_primitive(doc, static_cast<size_t>(mesh), i, {place, name.c_str(), i == 0 && !more});
}

/* The nodes of the scene that is shown, or, without scenes, those that are nobody's children.
 */
std::vector<int> root_nodes(const tinygltf::Model &model)
{
    if (!model.scenes.empty()) {
        size_t scene = model.defaultScene < 0 ? 0 : static_cast<size_t>(model.defaultScene);
        if (scene >= model.scenes.size())
            refuse(CSGM_ERR_FORMAT, "there is no scene %zu", scene);
        return model.scenes[scene].nodes;
    }
    std::vector<bool> is_child(model.nodes.size(), false);
    for (const tinygltf::Node &node : model.nodes)
        for (int child : node.children)
            if (child >= 0 && static_cast<size_t>(child) < is_child.size())
                is_child[static_cast<size_t>(child)] = true;
    std::vector<int> roots;
    for (size_t i = 0; i < is_child.size(); i++)
        if (!is_child[i])
            roots.push_back(static_cast<int>(i));
    return roots;
}

/* Depth first with a stack of its own; children come out in their order. Every node has one
 * parent at most, so one that comes twice is shared or its own ancestor. */
void walk(const document &doc)
{
    const std::vector<tinygltf::Node> &nodes = doc.model.nodes;
    std::vector<bool> seen(nodes.size(), false);
    struct visit {
        int node;
        transform parent;
        double divisor;
    };
    std::vector<visit> stack;
    std::vector<int> roots = root_nodes(doc.model);
    for (auto root = roots.rbegin(); root != roots.rend(); ++root)
        stack.push_back({*root, upright(doc), doc.told.scale});
    while (!stack.empty()) {
        auto [index, parent, divisor] = stack.back();
        stack.pop_back();
        if (index < 0 || static_cast<size_t>(index) >= nodes.size())
            refuse(CSGM_ERR_FORMAT, "there is no node %d", index);
        if (seen[static_cast<size_t>(index)])
            refuse(CSGM_ERR_FORMAT, "node %d has two parents or is its own ancestor", index);
        seen[static_cast<size_t>(index)] = true;
        const tinygltf::Node &node = nodes[static_cast<size_t>(index)];
        transform place = multiply(parent, node_transform(node, divisor));
        emit_mesh(doc, node.mesh, place, node.name, doc.told.more[static_cast<size_t>(index)]);
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
            stack.push_back({*child, place, 1});
    }
    for (size_t i = 0; nodes.empty() && i < doc.model.meshes.size(); i++)
        emit_mesh(doc, static_cast<int>(i), identity(), {}, false);
}

void read(const char *text, size_t size, span bin, const csg_gltf_calls *calls)
{
    document doc;
    doc.calls = calls;
    json root = parse(text, size, calls,
                      std::max({sizeof(tinygltf::Node), sizeof(tinygltf::Mesh),
                                sizeof(tinygltf::Primitive), sizeof(tinygltf::Scene),
                                sizeof(tinygltf::Accessor), sizeof(tinygltf::BufferView)}));
    check_version(root);
    check_extensions(root);
    std::string small = cut_down(doc.told, root).dump();
    if (doc.told.says_unit)
        calls->unit(calls->user, doc.told.unit);
    std::string rest = left_out(root, doc.told.ours);
    if (!rest.empty())
        calls->left_out(calls->user, rest.c_str());
    resolve_buffers(doc, root, bin);
    root = nullptr; /* base64 buffers are large */
    std::string error, warning;
    tinygltf::TinyGLTF loader;
    if (!loader.LoadASCIIFromString(&doc.model, &error, &warning, small.data(),
                                    static_cast<unsigned>(small.size()), ""))
        refuse(CSGM_ERR_FORMAT, "%.*s",
               static_cast<int>(error.find('\n') == std::string::npos ? error.size()
                                                                      : error.find('\n')),
               error.empty() ? "the document is not glTF" : error.c_str());
    walk(doc);
}

csgm_status fail(csg_adapter_error *error, csgm_status status, const char *text)
{
    std::snprintf(error->text, sizeof error->text, "%s", text);
    return status;
}

} // namespace

bool csg_gltf_available(void)
{
    return true;
}

csgm_status csg_gltf_parse(const char *json_text, size_t json_bytes, const uint8_t *bin,
                           size_t bin_bytes, const csg_gltf_calls *calls, csg_adapter_error *error)
{
    try {
        read(json_text, json_bytes, {bin, bin_bytes}, calls);
        return CSGM_OK;
    } catch (const trouble &t) {
        return fail(error, t.status, t.text.c_str());
    } catch (const std::bad_alloc &) {
        return fail(error, CSGM_ERR_MEMORY, "out of memory");
    } catch (...) {
        return fail(error, CSGM_ERR_FORMAT, "the document is not glTF");
    }
}
