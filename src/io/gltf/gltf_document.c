/* SPDX-License-Identifier: MIT
 * The growing tables of a glTF document; see gltf_document.h.
 */
#include "io/gltf/gltf_document.h"

void csg_gltf_document_init(csg_gltf_document *document, csg_memory *memory,
                            const csgm_write_options *options)
{
    *document = (csg_gltf_document){
        .memory = memory, .options = options, .image_view = CSG_GLTF_NONE, .level_count = 1};
}

#define RELEASE(table, room)                                                                       \
    csg_memory_release(document->memory, document->table, document->room * sizeof *document->table)

void csg_gltf_document_release(csg_gltf_document *document)
{
    RELEASE(views, view_room);
    RELEASE(accessors, accessor_room);
    RELEASE(meshes, mesh_room);
    RELEASE(nodes, node_room);
    RELEASE(materials, material_room);
}

/* Where memory runs out the document is not written. */
#define ADD(document, table, count, room, row)                                                     \
    if (!csg_memory_reserve((document)->memory, (void **)&(document)->table, &(document)->room,    \
                            (document)->count + 1, sizeof *(document)->table)) {                   \
        (document)->failed = true;                                                                 \
        return 0;                                                                                  \
    }                                                                                              \
    (document)->table[(document)->count++] = row

int csg_gltf_add_view(csg_gltf_document *document, csg_gltf_view view)
{
    ADD(document, views, view_count, view_room, view);
    return (int)document->view_count - 1;
}

int csg_gltf_add_accessor(csg_gltf_document *document, csg_gltf_accessor accessor)
{
    ADD(document, accessors, accessor_count, accessor_room, accessor);
    return (int)document->accessor_count - 1;
}

int csg_gltf_add_mesh(csg_gltf_document *document, csg_gltf_mesh mesh)
{
    ADD(document, meshes, mesh_count, mesh_room, mesh);
    return (int)document->mesh_count - 1;
}

int csg_gltf_add_node(csg_gltf_document *document, csg_gltf_node node)
{
    ADD(document, nodes, node_count, node_room, node);
    return (int)document->node_count - 1;
}

uint32_t csg_gltf_add_material(csg_gltf_document *document, const csg_part_look *look)
{
    for (size_t i = 0; i < document->material_count; i++)
        if (csg_look_is(&document->materials[i], look))
            return (uint32_t)i;
    ADD(document, materials, material_count, material_room, *look);
    return (uint32_t)document->material_count - 1;
}
