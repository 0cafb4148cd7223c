/* SPDX-License-Identifier: MIT
 * The only file that names Draco: indexed triangles <-> its compressed bytes.
 * Always edgebreaker: the sequential method writes files that cannot be decoded when a vertex is
 * unused. Edgebreaker drops degenerate faces and unused vertices, may split vertices and reorders,
 * so counts are those that the encoder tracked. Draco crashes on NaN and on a mesh without faces:
 * callers check both. Whole numbers (colours) are kept exactly; only floats are quantised.
 */
#include "io/adapter.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

#include <draco/compression/decode.h>
#include <draco/compression/expert_encode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/mesh/mesh.h>
#include <draco/metadata/metadata_decoder.h>

namespace
{

csgm_status fail(csg_adapter_error *error, csgm_status status, const char *text)
{
    std::snprintf(error->text, sizeof error->text, "%s", text);
    return status;
}

/* ---- encoding --------------------------------------------------------------------- */

int add_attribute(draco::Mesh *mesh, draco::GeometryAttribute::Type kind, int8_t components,
                  draco::DataType type, bool normalized, const void *values, uint32_t count)
{
    int64_t stride = components * draco::DataTypeLength(type);
    draco::GeometryAttribute shape;
    shape.Init(kind, nullptr, static_cast<uint8_t>(components), type, normalized, stride, 0);
    int id = mesh->AddAttribute(shape, true, count);
    if (count)
        mesh->attribute(id)->buffer()->Write(0, values, static_cast<size_t>(stride) * count);
    return id;
}

struct encoded_owner {
    draco::EncoderBuffer buffer;
};

csgm_status encode(const csg_draco_mesh *in, const csg_draco_settings *settings,
                   csg_draco_encoded *out, csg_adapter_error *error)
{
    draco::Mesh mesh;
    const uint32_t count = static_cast<uint32_t>(in->vertex_count);
    mesh.set_num_points(count);
    int position = add_attribute(&mesh, draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32,
                                 false, in->positions, count);
    int normal = in->normals ? add_attribute(&mesh, draco::GeometryAttribute::NORMAL, 3,
                                             draco::DT_FLOAT32, false, in->normals, count)
                             : -1;
    int color = in->colors
                    ? add_attribute(&mesh, draco::GeometryAttribute::COLOR, 4,
                                    in->color_bytes == 2 ? draco::DT_UINT16 : draco::DT_UINT8, true,
                                    in->colors, count)
                    : -1;
    int coordinate = in->coordinates ? add_attribute(&mesh, draco::GeometryAttribute::TEX_COORD, 2,
                                                     draco::DT_UINT16, true, in->coordinates, count)
                                     : -1;
    mesh.SetNumFaces(in->triangle_count);
    for (uint64_t i = 0; i < in->triangle_count; i++) {
        draco::Mesh::Face face;
        for (size_t k = 0; k < 3; k++)
            face[k] = in->indices[3 * i + k];
        mesh.SetFace(draco::FaceIndex(static_cast<uint32_t>(i)), face);
    }
    draco::ExpertEncoder encoder(mesh);
    int speed = 10 - static_cast<int>(settings->level);
    encoder.SetSpeedOptions(speed, speed);
    encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    encoder.SetTrackEncodedProperties(true);
    if (in->grid)
        encoder.SetAttributeExplicitQuantization(
            position, static_cast<int>(settings->position_bits), 3, in->grid, in->grid[3]);
    else
        encoder.SetAttributeQuantization(position, static_cast<int>(settings->position_bits));
    if (normal >= 0)
        encoder.SetAttributeQuantization(normal, static_cast<int>(settings->normal_bits));
    auto owner = std::make_unique<encoded_owner>();
    draco::Status status = encoder.EncodeToBuffer(&owner->buffer);
    if (!status.ok())
        return fail(error, CSGM_ERR_UNSUPPORTED, status.error_msg());
    if (!encoder.num_encoded_faces())
        return fail(error, CSGM_ERR_UNSUPPORTED, "all triangles are degenerate");
    *out = {};
    out->bytes = reinterpret_cast<const uint8_t *>(owner->buffer.data());
    out->size_bytes = owner->buffer.size();
    out->vertex_count = encoder.num_encoded_points();
    out->triangle_count = encoder.num_encoded_faces();
    out->position_id = mesh.attribute(position)->unique_id();
    out->normal_id = normal >= 0 ? mesh.attribute(normal)->unique_id() : 0;
    out->color_id = color >= 0 ? mesh.attribute(color)->unique_id() : 0;
    out->coordinate_id = coordinate >= 0 ? mesh.attribute(coordinate)->unique_id() : 0;
    out->owner = owner.release();
    return CSGM_OK;
}

/* ---- decoding --------------------------------------------------------------------- */

struct decoded_owner {
    std::vector<float> positions, normals, colors;
    std::vector<uint32_t> indices;
};

bool collect(const draco::Mesh &mesh, const draco::PointAttribute *attribute, uint32_t components,
             std::vector<float> *out)
{
    const uint32_t count = mesh.num_points();
    if (attribute->data_type() == draco::DT_BOOL)
        return false; /* Draco takes any byte for one, which is undefined; no place is a truth */
    out->resize(static_cast<size_t>(count) * components);
    for (uint32_t i = 0; i < count; i++) {
        draco::AttributeValueIndex at = attribute->mapped_index(draco::PointIndex(i));
        if (at.value() >= attribute->size())
            return false;
        float value[4];
        if (!attribute->ConvertValue<float>(at, static_cast<int8_t>(components), value))
            return false;
        std::memcpy(out->data() + static_cast<size_t>(i) * components, value,
                    components * sizeof *value);
    }
    return true;
}

const draco::PointAttribute *find(const draco::Mesh &mesh, const csg_draco_ids *ids, int64_t id,
                                  draco::GeometryAttribute::Type kind)
{
    if (!ids)
        return mesh.GetNamedAttribute(kind);
    if (id < 0 || id > UINT32_MAX)
        return nullptr;
    return mesh.GetAttributeByUniqueId(static_cast<uint32_t>(id));
}

/* Normalised whole numbers come out of ConvertValue as 0..1 already. */
bool collect_all(const draco::Mesh &mesh, const csg_draco_ids *ids, decoded_owner *owner,
                 uint32_t *color_components)
{
    using attribute = draco::GeometryAttribute;
    auto position = find(mesh, ids, ids ? ids->position : -1, attribute::POSITION);
    auto normal = find(mesh, ids, ids ? ids->normal : -1, attribute::NORMAL);
    auto color = find(mesh, ids, ids ? ids->color : -1, attribute::COLOR);
    if (!position || position->num_components() != 3)
        return false;
    *color_components = color ? color->num_components() : 0;
    return collect(mesh, position, 3, &owner->positions) &&
           (!normal ||
            (normal->num_components() == 3 && collect(mesh, normal, 3, &owner->normals))) &&
           (!color || ((*color_components == 3 || *color_components == 4) &&
                       collect(mesh, color, *color_components, &owner->colors)));
}

// A count of the connectivity: plain before `varying`, the version that has it in 7 bits a byte.
bool take_count(draco::DecoderBuffer *buffer, uint16_t varying, uint64_t *count)
{
    uint32_t number = 0;
    if (buffer->bitstream_version() < varying ? !buffer->Decode(&number)
                                              : !draco::DecodeVarint(&number, buffer))
        return false;
    *count = number;
    return true;
}

// What the file says that it has, from its first bytes (Draco Bitstream Specification, 3.2 and 5).
// False: nothing that is known here, the decoder has the word.
bool read_counts(draco::DecoderBuffer buffer, uint64_t *faces, uint64_t *points)
{
    draco::DracoHeader header;
    if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok() ||
        header.encoder_type != draco::TRIANGULAR_MESH)
        return false;
    const auto version = static_cast<uint16_t>(header.version_major << 8 | header.version_minor);
    buffer.set_bitstream_version(version);
    draco::GeometryMetadata metadata;
    draco::MetadataDecoder metadata_decoder;
    if ((header.flags & METADATA_FLAG_MASK) &&
        !metadata_decoder.DecodeGeometryMetadata(&buffer, &metadata))
        return false;
    if (header.encoder_method != draco::MESH_EDGEBREAKER_ENCODING)
        return take_count(&buffer, DRACO_BITSTREAM_VERSION(2, 2), faces) &&
               take_count(&buffer, DRACO_BITSTREAM_VERSION(2, 2), points);
    uint8_t traversal;
    uint64_t added;
    const uint16_t varying = DRACO_BITSTREAM_VERSION(2, 0);
    if (!buffer.Decode(&traversal) ||
        (version < DRACO_BITSTREAM_VERSION(2, 2) && !take_count(&buffer, varying, &added)))
        return false;
    return take_count(&buffer, varying, points) && take_count(&buffer, varying, faces);
}

// The decoder takes its arrays by these counts before it has seen what they are of: a file of 20
// bytes could ask for 2^32 triangles. Entropy coding has no least size for a triangle; thousand in
// a byte, a million besides, are more than any regular mesh has. And what is made of each, corner
// table and faces, needs room in any case.
csgm_status check_counts(const draco::DecoderBuffer &buffer, size_t size, uint64_t most,
                         csg_adapter_error *error)
{
    constexpr uint64_t free_count = 1 << 20, most_in_a_byte = 1 << 10;
    constexpr uint64_t face_bytes = 36, point_bytes = 12;
    uint64_t faces = 0, points = 0;
    if (!read_counts(buffer, &faces, &points))
        return CSGM_OK;
    if (std::max(faces, points) > free_count + most_in_a_byte * size)
        return fail(error, CSGM_ERR_FORMAT,
                    "it says that it has more triangles or vertices than its bytes can hold");
    error->is_limit = most && faces * face_bytes + points * point_bytes > most;
    return error->is_limit
               ? fail(error, CSGM_ERR_MEMORY, "the decoded mesh is larger than the memory limit")
               : CSGM_OK;
}

csgm_status decode(const uint8_t *bytes, size_t size, const csg_draco_ids *ids, uint64_t most,
                   csg_draco_decoded *out, csg_adapter_error *error)
{
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char *>(bytes), size);
    if (csgm_status status = check_counts(buffer, size, most, error))
        return status;
    draco::Decoder decoder;
    auto result = decoder.DecodeMeshFromBuffer(&buffer);
    if (!result.ok())
        return fail(error, CSGM_ERR_FORMAT, result.status().error_msg());
    const draco::Mesh &mesh = *result.value();
    const uint64_t points = mesh.num_points(), faces = mesh.num_faces();
    error->is_limit = most && (points * 40 + faces * 12) > most;
    if (error->is_limit)
        return fail(error, CSGM_ERR_MEMORY, "the decoded mesh is larger than the memory limit");
    auto owner = std::make_unique<decoded_owner>();
    *out = {};
    if (!collect_all(mesh, ids, owner.get(), &out->part.color_components))
        return fail(error, CSGM_ERR_FORMAT, "the Draco data lacks positions or has odd attributes");
    owner->indices.resize(static_cast<size_t>(faces) * 3);
    for (uint32_t i = 0; i < faces; i++)
        for (size_t k = 0; k < 3; k++) {
            uint32_t index = mesh.face(draco::FaceIndex(i))[k].value();
            if (index >= points)
                return fail(error, CSGM_ERR_FORMAT, "an index of the Draco data is out of range");
            owner->indices[3 * static_cast<size_t>(i) + k] = index;
        }
    csg_adapter_part &part = out->part;
    part.positions = owner->positions.data();
    part.normals = owner->normals.empty() ? nullptr : owner->normals.data();
    part.colors = owner->colors.empty() ? nullptr : owner->colors.data();
    part.indices = owner->indices.data();
    part.vertex_count = points;
    part.index_count = faces * 3;
    out->owner = owner.release();
    return CSGM_OK;
}

} // namespace

bool csg_draco_available(void)
{
    return true;
}

csgm_status csg_draco_encode(const csg_draco_mesh *mesh, const csg_draco_settings *settings,
                             csg_draco_encoded *out, csg_adapter_error *error)
{
    try {
        return encode(mesh, settings, out, error);
    } catch (const std::bad_alloc &) {
        return fail(error, CSGM_ERR_MEMORY, "out of memory");
    } catch (...) {
        return fail(error, CSGM_ERR_INTERNAL, "the encoder failed");
    }
}

void csg_draco_release(csg_draco_encoded *encoded)
{
    delete static_cast<encoded_owner *>(encoded->owner);
    *encoded = {};
}

csgm_status csg_draco_decode(const uint8_t *bytes, size_t size_bytes, const csg_draco_ids *ids,
                             uint64_t most_bytes, csg_draco_decoded *out, csg_adapter_error *error)
{
    try {
        return decode(bytes, size_bytes, ids, most_bytes, out, error);
    } catch (const std::bad_alloc &) {
        return fail(error, CSGM_ERR_MEMORY, "out of memory");
    } catch (...) {
        return fail(error, CSGM_ERR_FORMAT, "the decoder failed");
    }
}

void csg_draco_release_decoded(csg_draco_decoded *decoded)
{
    delete static_cast<decoded_owner *>(decoded->owner);
    *decoded = {};
}
