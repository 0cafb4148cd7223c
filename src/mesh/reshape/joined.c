/* SPDX-License-Identifier: MIT
 * Tiles are closed (remesh/close.h), thinned out and taken apart again; see joined.h.
 */
#include "mesh/reshape/joined.h"

#include <string.h>

#include "base/mesh_codes.h"
#include "mesh/remesh/close.h"
#include "mesh/reshape/decimate.h"

void csg_joined_begin(csg_joined *j, csgm_context *context, bool colors, bool materials)
{
    *j = (csg_joined){.context = context, .has_colors = colors, .has_materials = materials};
    csg_table_init(&j->seam_index, &context->memory);
}

/* All but kinds and samples. */
static void release_mesh(csg_joined *j)
{
    csg_memory *memory = &j->context->memory;
    csg_memory_release(memory, j->positions, j->position_room * sizeof *j->positions);
    csg_memory_release(memory, j->colors, j->color_room);
    csg_memory_release(memory, j->materials, j->material_room * sizeof *j->materials);
    csg_memory_release(memory, j->indices, j->index_room * sizeof *j->indices);
    csg_memory_release(memory, j->seam, j->seam_room * sizeof *j->seam);
    csg_table_release(&j->seam_index);
    j->positions = NULL, j->colors = NULL, j->materials = NULL, j->indices = NULL, j->seam = NULL;
    j->position_room = j->color_room = j->material_room = j->index_room = j->seam_room = 0;
}

void csg_joined_end(csg_joined *j)
{
    csg_memory *memory = &j->context->memory;
    release_mesh(j);
    csg_memory_release(memory, j->kinds, j->kind_room);
    csg_begun_samples_release(&j->samples, memory);
    csg_memory_release(memory, j->samples.looks,
                       j->samples.look_capacity * sizeof *j->samples.looks);
    *j = (csg_joined){.context = j->context};
}

/* ---- one tile ----------------------------------------------------------------------------------
 */

typedef struct tile {
    csg_joined *joined;
    const csg_tile_mesh *given;
    csg_closed_mesh closed;
    csg_remesh remesh;
    csg_missed seen; /* what the judge saw in it */
    csg_decimation decimation;
    uint32_t *number; /* per vertex: in the joined mesh; CSG_CORNER_NONE */
} tile;

static csgm_status thin_out(tile *t, const csg_marching *marching, csg_mesh_watch *watch)
{
    csg_remesh *r = &t->remesh;
    const csg_tile_mesh *given = t->given;
    const csg_remesh_origin origin = {.closing = t->closed.closing};
    csgm_status status = csg_remesh_begin(r, t->closed.mesh, &origin, marching, watch);
    if (status != CSGM_OK)
        return status;
    /* not the tile's own: places are rounded as those of the whole mesh are */
    r->tree.noise = csg_triangle_tree_noise(csg_lattice_extent(marching->lattice));
    r->error = given->error;
    if (given->seen)
        status = csg_missed_take_seen(r, given->seen, given->error, &t->seen);
    if (status == CSGM_OK)
        status = csg_decimation_begin(&t->decimation, r, &t->seen, NULL);
    if (status != CSGM_OK)
        return status;
    t->decimation.farthest_vertex = given->farthest;
    if (!(given->low.x <= given->high.x))
        return CSGM_OK;
    return csg_decimate_within(&t->decimation, given->low, given->high, given->share);
}

/* ---- vertices ----------------------------------------------------------------------------------
 */

static uint64_t hash_of_seam(const void *entries, uint32_t i)
{
    const csg_tile_seam *seam = entries;
    return csg_hash_word(CSG_HASH_START, seam[i].place);
}

/* The entry of a place on a seam, made where it is new: then its number is NONE. NULL: out of
 * memory. */
static csg_tile_seam *enter_seam(csg_joined *j, uint64_t place)
{
    csg_memory *memory = &j->context->memory;
    size_t slot;
    if (!csg_table_reserve(&j->seam_index, j->seam_count + 1, hash_of_seam, j->seam) ||
        !csg_memory_reserve(memory, (void **)&j->seam, &j->seam_room, j->seam_count + 1,
                            sizeof *j->seam))
        return NULL;
    uint32_t found = csg_table_first(&j->seam_index, csg_hash_word(CSG_HASH_START, place), &slot);
    while (found != CSG_TABLE_NONE && j->seam[found].place != place)
        found = csg_table_next(&j->seam_index, &slot);
    if (found == CSG_TABLE_NONE) {
        found = (uint32_t)j->seam_count++;
        j->seam[found] = (csg_tile_seam){place, CSG_CORNER_NONE};
        csg_table_put(&j->seam_index, slot, found);
    }
    return &j->seam[found];
}

static bool reserve_vertex(csg_joined *j)
{
    csg_memory *memory = &j->context->memory;
    size_t n = j->vertex_count + 1;
    return csg_memory_reserve(memory, (void **)&j->positions, &j->position_room, 3 * n,
                              sizeof *j->positions) &&
           csg_memory_reserve(memory, (void **)&j->kinds, &j->kind_room, n, 1) &&
           (!j->has_colors ||
            csg_memory_reserve(memory, (void **)&j->colors, &j->color_room, 4 * n, 1)) &&
           (!j->has_materials ||
            csg_memory_reserve(memory, (void **)&j->materials, &j->material_room, 2 * n,
                               sizeof *j->materials));
}

/* A vertex of the tile behind those that are there. False: out of memory. */
static bool add_vertex(tile *t, uint32_t vertex)
{
    csg_joined *j = t->joined;
    const csg_remesh *r = &t->remesh;
    if (!reserve_vertex(j))
        return false;
    size_t n = j->vertex_count++;
    csg_vec3_to_floats(j->positions + 3 * n, csg_vec3_add(r->at[vertex], r->marching->shift));
    j->kinds[n] = r->kind[vertex];
    if (j->has_colors)
        memcpy(j->colors + 4 * n, r->looks[vertex].color, 4);
    if (j->has_materials)
        memcpy(j->materials + 2 * n, r->looks[vertex].material, 2 * sizeof(uint16_t));
    t->number[vertex] = (uint32_t)n;
    return true;
}

/* One that is on the border: another tile may have brought it. */
static bool add_seam_vertex(tile *t, uint32_t vertex)
{
    csg_joined *j = t->joined;
    csg_tile_seam *seam = enter_seam(j, t->given->places[t->closed.original[vertex]]);
    if (!seam)
        return false;
    if (seam->number == CSG_CORNER_NONE) {
        j->creases += t->given->creases[t->closed.original[vertex]];
        seam->number = (uint32_t)j->vertex_count;
        return add_vertex(t, vertex);
    }
    t->number[vertex] = seam->number;
    uint8_t *kind = &j->kinds[seam->number];
    *kind = t->remesh.kind[vertex] > *kind ? t->remesh.kind[vertex] : *kind;
    return true;
}

static bool add_vertices(tile *t)
{
    const csg_corners *m = &t->remesh.corners;
    for (uint32_t v = 0; v < m->vertex_count; v++) {
        uint32_t original = t->closed.original[v];
        t->number[v] = CSG_CORNER_NONE;
        if (original == CSG_CORNER_NONE)
            continue;
        bool at_border = t->closed.at_border[v];
        if (!at_border)
            t->joined->creases += t->given->creases[original];
        if (m->corner[v] != CSG_CORNER_NONE &&
            !(at_border ? add_seam_vertex(t, v) : add_vertex(t, v)))
            return false;
    }
    return true;
}

/* ---- triangles and samples ---------------------------------------------------------------------
 */

static bool keep_sample(tile *t, uint32_t sample, uint32_t triangle)
{
    const csg_decimation *d = &t->decimation;
    csg_memory *memory = &t->joined->context->memory;
    csg_begun_samples *s = &t->joined->samples;
    csg_surface_sample kept = d->samples[sample];
    csg_surface_sample_set_next(&kept, triangle);
    if (sample >= d->vertex_samples)
        return csg_begun_samples_add_other(s, memory, &kept);
    if (!csg_memory_reserve(memory, (void **)&s->of_vertices, &s->vertex_capacity,
                            s->vertex_count + 1, sizeof kept) ||
        (d->originals && !csg_memory_reserve(memory, (void **)&s->looks, &s->look_capacity,
                                             s->vertex_count + 1, sizeof *s->looks)))
        return false;
    if (d->originals)
        s->looks[s->vertex_count] = d->originals[sample];
    s->of_vertices[s->vertex_count++] = kept;
    return true;
}

static bool add_triangles(tile *t)
{
    csg_joined *j = t->joined;
    const csg_corners *m = &t->remesh.corners;
    for (uint32_t i = t->closed.closing; i < m->triangle_count; i++) {
        if (!csg_corners_is_live(m, i))
            continue;
        if (!csg_memory_reserve(&j->context->memory, (void **)&j->indices, &j->index_room,
                                j->index_count + 3, sizeof *j->indices))
            return false;
        uint32_t triangle = (uint32_t)(j->index_count / 3);
        for (uint32_t k = 0; k < 3; k++)
            j->indices[j->index_count++] = t->number[m->vertex[3 * i + k]];
        for (uint32_t s = t->decimation.first_sample[i]; s != CSG_CORNER_NONE;
             s = csg_sample_next(&t->decimation, s))
            if (!keep_sample(t, s, triangle))
                return false;
    }
    return true;
}

static csgm_status append(tile *t)
{
    csgm_context *context = t->joined->context;
    size_t bytes = ((size_t)t->remesh.corners.vertex_count + 1) * sizeof *t->number;
    t->number = csg_memory_alloc(&context->memory, bytes);
    bool done = t->number && add_vertices(t) && add_triangles(t);
    csg_memory_release(&context->memory, t->number, bytes);
    return done ? CSGM_OK : csg_context_no_memory(context);
}

csgm_status csg_joined_add(csg_joined *j, const csg_tile_mesh *given, const csg_marching *marching,
                           csg_mesh_watch *watch)
{
    tile t = {.joined = j, .given = given};
    j->begun += given->mesh->triangle_count;
    if (!given->mesh->triangle_count)
        return CSGM_OK;
    csgm_status status = csg_mesh_close(given->mesh, &t.closed);
    if (status != CSGM_OK)
        return status;
    status = thin_out(&t, marching, watch);
    if (status == CSGM_OK)
        status = append(&t);
    csg_decimation_end(&t.decimation);
    csg_missed_release(&t.seen, &j->context->memory);
    if (t.remesh.corners.memory) /* it was begun */
        csg_remesh_end(&t.remesh);
    csg_closed_mesh_release(&t.closed);
    return status;
}

static void fill(const csg_joined *j, csgm_mesh *mesh)
{
    memcpy(mesh->positions, j->positions, 3 * j->vertex_count * sizeof *mesh->positions);
    memcpy(mesh->indices, j->indices, j->index_count * sizeof *mesh->indices);
    if (j->has_colors)
        memcpy(mesh->colors, j->colors, 4 * j->vertex_count);
    if (j->has_materials)
        memcpy(mesh->materials, j->materials, 2 * j->vertex_count * sizeof *mesh->materials);
}

csgm_status csg_joined_write(csg_joined *j, csgm_mesh **out)
{
    csgm_mesh *mesh;
    *out = NULL;
    csgm_status status = csg_mesh_create(j->context, j->vertex_count, j->index_count / 3, false,
                                         j->has_colors, &mesh);
    if (status != CSGM_OK)
        return status;
    *out = mesh;
    status = j->has_materials ? csg_mesh_add_materials(mesh) : CSGM_OK;
    if (status == CSGM_OK && j->index_count)
        fill(j, mesh);
    release_mesh(j);
    return status;
}
