/* SPDX-License-Identifier: MIT
 * Three loops over the leaves: edges, faces, triangles; see extract.h.
 */
#include "mesh/adaptive/extract.h"

#include <string.h>

#include "base/trace.h"
#include "mesh/adaptive/cells.h"

/* A fan around a point. The polygon's triangles are its own as long as they are in the item. */
static bool add_fan(csg_cell_loop *w, uint32_t worker, const csg_polygon *p, const float apex[3],
                    csg_apex_kind kind)
{
    csg_cell_worker *self = &w->workers[worker];
    csg_placed_vertex v;
    memset(&v, 0, sizeof v);
    memcpy(v.at, apex, sizeof v.at);
    v.is_crease = kind == CSG_APEX_CREASE;
    self->creases += kind == CSG_APEX_CREASE;
    self->smooth += kind == CSG_APEX_FAILED;
    uint32_t number = CSG_OWN_VERTEX | (uint32_t)(self->count - self->first);
    if (!csg_cells_add_vertex(w, worker, &v))
        return false;
    for (int i = 0; i < p->count; i++)
        if (!csg_cells_add_triangle(w, worker, number, p->vertex[i], p->vertex[(i + 1) % p->count]))
            return false;
    return true;
}

/* Those whose sheets fail to meet, but near the surface. */
static void settle_failed(csg_cell_loop *w, uint32_t worker, const csg_shell *s)
{
    const csg_judge *judge = w->x->judge;
    csg_judge_room *room = &w->x->judge->rooms[worker];
    csg_cut_polygon *failed[CSG_JUDGED_MOST_APEXES];
    int count = 0;
    for (int i = 0; i < room->piece_count; i++)
        if (csg_cut_has_failed(&room->pieces[i]))
            failed[count++] = &room->pieces[i];
    csg_tape tape;
    csg_sheet_probe probe = csg_judge_probe(judge, w->x->bricks, s->brick, room, &tape);
    csg_cuts_find_distances(&probe, failed, count, judge->tolerance);
    csg_cuts_settle_near(failed, count, judge->tolerance);
    room->evaluations += probe.evaluations;
}

/* Fans whose middles the judge has not seen, together. */
static bool add_fans(csg_cell_loop *w, uint32_t worker, const csg_shell *s)
{
    csg_judge_room *room = &w->x->judge->rooms[worker];
    csg_cells_find_apexes(w, worker, s);
    settle_failed(w, worker, s);
    for (int i = 0; i < room->piece_count; i++) {
        const csg_cut_polygon *piece = &room->pieces[i];
        float apex[3];
        csg_vec3_to_floats(apex, piece->apex);
        if (!add_fan(w, worker, &piece->polygon, apex, piece->kind))
            return false;
    }
    room->piece_count = 0;
    return true;
}

/* The polygon last set aside gets its fan: at once where the judge knows its middle, else later. */
static bool fan(csg_cell_at_hand *c, unsigned polygon, const csg_cut_polygon *piece)
{
    csg_judge_room *room = &c->loop->x->judge->rooms[c->worker];
    const csg_judged_apex *judged =
        c->is_border ? NULL
                     : csg_judged_apex_of(c->shell->brick->judged, csg_cells_bit(c), polygon,
                                          (unsigned)piece->polygon.in_faces);
    if (judged) {
        room->piece_count--;
        return add_fan(c->loop, c->worker, &piece->polygon, judged->at,
                       (csg_apex_kind)judged->kind);
    }
    return room->piece_count < CSG_JUDGED_MOST_APEXES || add_fans(c->loop, c->worker, c->shell);
}

/* Triangles without a point inside, as csg_cell_cut cuts polygons of a whole cell. */
static bool cut_whole(csg_cell_at_hand *c)
{
    csg_cell_loop *w = c->loop;
    for (unsigned polygon = 0; polygon < c->polygons.count; polygon++) {
        uint32_t vertex[CSG_CELL_EDGES] = {0};
        uint8_t edge[CSG_CELL_EDGES], triangles[CSG_CELL_MOST_INDICES + 3 * CSG_CELL_EDGES];
        int sides = 0;
        for (unsigned i = c->polygons.first[polygon]; i < c->polygons.first[polygon + 1]; i++) {
            unsigned from = c->polygons.side[i].from;
            uint32_t v = csg_cells_find_vertex(
                w, csg_cells_place(w->x->bricks, c->shell->brick, c->at, from));
            if (v == CSG_TABLE_NONE)
                return csg_cells_is_missing(c);
            edge[sides] = csg_local_edge(from);
            vertex[edge[sides++]] = v;
        }
        if (!csg_cell_cut(edge, sides, triangles)) {
            const csg_cut_polygon *piece = csg_cells_set_aside(c, polygon);
            if (!piece || !fan(c, polygon, piece)) /* joined through faces: there is no cut */
                return false;
            continue;
        }
        for (int i = 0; i < 3 * (sides - 2); i += 3)
            if (!csg_cells_add_triangle(w, c->worker, vertex[triangles[i]],
                                        vertex[triangles[i + 1]], vertex[triangles[i + 2]]))
                return false;
    }
    return true;
}

/* The same where there are vertices in faces. */
static bool add_cut(csg_cell_at_hand *c, const csg_cut_polygon *piece)
{
    const uint32_t *vertex = piece->polygon.vertex;
    for (int t = 0; t < csg_cut_triangle_count(piece); t++) {
        const uint8_t *cut = piece->cut + 3 * (ptrdiff_t)t;
        if (!csg_cells_add_triangle(c->loop, c->worker, vertex[cut[0]], vertex[cut[1]],
                                    vertex[cut[2]]))
            return false;
    }
    return true;
}

static bool make_triangles(csg_cell_at_hand *c)
{
    const csg_brick *brick = c->shell->brick;
    unsigned bit = csg_cells_bit(c);
    if (brick->several >> bit & 1 && c->is_whole)
        return cut_whole(c);
    for (unsigned polygon = 0; polygon < c->polygons.count; polygon++) {
        csg_cut_polygon *piece = csg_cells_set_aside(c, polygon);
        if (!piece)
            return false;
        bool flat = c->is_whole && c->polygons.count == 1 && brick->flat >> bit & 1;
        if (flat && (!piece->polygon.in_faces || csg_cut_without_apex(piece))) {
            c->loop->x->judge->rooms[c->worker].piece_count--;
            return piece->polygon.in_faces ? add_cut(c, piece) : cut_whole(c);
        }
        piece->is_fan = true;
        if (!fan(c, polygon, piece))
            return false;
    }
    return true;
}

static bool visit_cells(csg_cell_loop *w, uint32_t worker, const csg_shell *s)
{
    w->x->judge->rooms[worker].piece_count = 0;
    return csg_cells_each(w, worker, s, make_triangles) && add_fans(w, worker, s);
}

/* Of all leaves in Morton order. */
static csgm_status list_all(csg_cell_loop *w)
{
    bool done = csg_bricks_leaves(w->x->bricks, &w->leaves, &w->leaf_count);
    w->leaf_capacity = w->leaf_count;
    return done ? CSGM_OK : csg_context_no_memory(w->x->context);
}

static csgm_status fill_mesh(const csg_cell_loop *w)
{
    csg_extraction *x = w->x;
    csgm_status status =
        csg_mesh_create(x->context, w->count, w->corner_count / 3, false, x->colors, &x->mesh);
    if (status != CSGM_OK)
        return status;
    for (size_t i = 0; i < w->count; i++) {
        csg_vec3 at = csg_vec3_add(csg_vec3_from_floats(w->vertices[i].at), x->shift);
        csg_vec3_to_floats(x->mesh->positions + 3 * i, at);
    }
    if (w->corner_count)
        memcpy(x->mesh->indices, w->corners, w->corner_count * sizeof *w->corners);
    return CSGM_OK;
}

csgm_status csg_extract(csg_extraction *x)
{
    CSG_ZONE(x->context, "extraction");
    csg_cell_loop w;
    csgm_status status = csg_cell_loop_begin(&w, x);
    if (status == CSGM_OK)
        status = list_all(&w);
    if (status == CSGM_OK)
        csg_cell_loop_keep_shells(&w);
    if (status == CSGM_OK)
        status = csg_cells_find_vertices(&w, 0, 0.5);
    if (status == CSGM_OK)
        status = csg_cell_loop_run(&w, visit_cells, 0.5, 0.5);
    x->creases += w.creases;
    x->smooth += w.smooth;
    if (status == CSGM_OK)
        status = fill_mesh(&w);
    csg_cell_loop_end(&w);
    return status;
}

/* ---- a part of it ------------------------------------------------------------------------------
 */

/* Those of the leaves whose edges and faces those of the part may have. */
static csgm_status find_vertices_around(csg_cell_loop *w, const uint32_t *leaves, size_t count)
{
    csg_memory *memory = &w->x->context->memory;
    const csg_bricks *b = w->x->bricks;
    uint8_t *marks = csg_memory_alloc(memory, b->count);
    if (!marks)
        return csg_context_no_memory(w->x->context);
    memset(marks, 0, b->count);
    for (size_t i = 0; i < count; i++)
        csg_cell_loop_mark_around(b, leaves[i], marks);
    csgm_status status = csg_cells_find_vertices_around(w, marks, 0, 0.5);
    csg_memory_release(memory, marks, b->count);
    return status;
}

static csgm_status list_part(csg_cell_loop *w, const uint32_t *leaves, size_t count)
{
    csg_cell_loop_clear(w);
    for (size_t i = 0; i < count; i++)
        if (!csg_cell_loop_list(w, leaves[i]))
            return csg_context_no_memory(w->x->context);
    return CSGM_OK;
}

/* Numbers the vertices that triangles have; others are of leaves around. */
static uint64_t number_vertices(const csg_cell_loop *w, uint32_t *number)
{
    uint64_t used = 0;
    memset(number, 0xFF, (w->count + 1) * sizeof *number);
    for (size_t i = 0; i < w->corner_count; i++)
        number[w->corners[i]] = 0;
    for (size_t i = 0; i < w->count; i++)
        if (number[i] == 0)
            number[i] = (uint32_t)used++;
    return used;
}

static csgm_status fill_part(const csg_cell_loop *w, const uint32_t *number, uint64_t count,
                             csg_extracted_part *part)
{
    csg_extraction *x = w->x;
    csg_memory *memory = &x->context->memory;
    csgm_status status =
        csg_mesh_create(x->context, count, w->corner_count / 3, false, x->colors, &part->mesh);
    if (status != CSGM_OK)
        return status;
    part->places = csg_memory_alloc(memory, (size_t)(count + 1) * sizeof *part->places);
    part->creases = csg_memory_alloc(memory, (size_t)count + 1);
    if (!part->places || !part->creases)
        return csg_context_no_memory(x->context);
    for (size_t i = 0; i < w->count; i++) {
        const csg_placed_vertex *v = &w->vertices[i];
        if (number[i] == UINT32_MAX)
            continue;
        csg_vec3 at = csg_vec3_add(csg_vec3_from_floats(v->at), x->shift);
        csg_vec3_to_floats(part->mesh->positions + 3 * (size_t)number[i], at);
        part->places[number[i]] = v->place;
        part->creases[number[i]] = v->is_crease;
    }
    for (size_t i = 0; i < w->corner_count; i++)
        part->mesh->indices[i] = number[w->corners[i]];
    return CSGM_OK;
}

static csgm_status write_part(const csg_cell_loop *w, csg_extracted_part *part)
{
    csg_memory *memory = &w->x->context->memory;
    size_t bytes = (w->count + 1) * sizeof(uint32_t);
    uint32_t *number = csg_memory_alloc(memory, bytes);
    if (!number)
        return csg_context_no_memory(w->x->context);
    uint64_t count = number_vertices(w, number);
    csgm_status status = fill_part(w, number, count, part);
    csg_memory_release(memory, number, bytes);
    return status;
}

csgm_status csg_extract_part(csg_extraction *x, const uint32_t *leaves, size_t count,
                             csg_extracted_part *part)
{
    csg_cell_loop w;
    *part = (csg_extracted_part){0};
    csgm_status status = csg_cell_loop_begin(&w, x);
    if (status == CSGM_OK)
        status = find_vertices_around(&w, leaves, count);
    if (status == CSGM_OK)
        status = list_part(&w, leaves, count);
    if (status == CSGM_OK)
        status = csg_cell_loop_run(&w, visit_cells, 0.5, 0.5);
    x->smooth += w.smooth;
    if (status == CSGM_OK)
        status = write_part(&w, part);
    csg_cell_loop_end(&w);
    if (status != CSGM_OK)
        csg_extracted_part_release(part);
    return status;
}

void csg_extracted_part_release(csg_extracted_part *part)
{
    if (part->mesh) {
        csg_memory *memory = &part->mesh->context->memory;
        size_t count = (size_t)part->mesh->vertex_count + 1;
        csg_memory_release(memory, part->places, count * sizeof *part->places);
        csg_memory_release(memory, part->creases, count);
    }
    csg_mesh_destroy(part->mesh);
    *part = (csg_extracted_part){0};
}
