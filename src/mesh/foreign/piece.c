/* SPDX-License-Identifier: MIT
 * A part -> a closed manifold; see piece.h. The steps: triangles over the places of their corners,
 * what repair makes of them, pairs of triangles at edges that more than two share (those that lie
 * next to each other with the solid between them), a vertex for each fan; then seams, where the
 * looks of two triangles differ along their edge.
 */
#include "mesh/foreign/piece.h"

#include <string.h>

#include "base/elementary.h"
#include "base/places.h"
#include "base/sets.h"

#define NONE UINT32_MAX

/* ---- triangles over places --------------------------------------------------------------------- */

typedef struct places {
    uint32_t
        *place; /* of each corner of the part: its place, numbered in the order of the corners */
    uint32_t *vertex; /* of each place: a vertex of the source */
    csg_triangles triangles;
} places;

static csg_vec3 point_of(const csgm_mesh_view *source, uint32_t vertex)
{
    return csg_vec3_from_floats(source->positions + 3 * (size_t)vertex);
}

static csg_vec3 on_lattice(const csg_triangle_frame *frame, csg_vec3 p)
{
    csg_vec3 q = csg_triangle_frame_enter(frame, p);
    return csg_triangle_frame_round_point(q);
}

static csg_box box_of(const csg_foreign_piece *piece)
{
    csg_box box = csg_box_empty();
    const uint32_t *corners = piece->source.indices + 3 * piece->first_triangle;
    for (size_t i = 0; i < 3 * piece->triangle_count; i++) {
        csg_vec3 p = point_of(&piece->source, corners[i]);
        box = csg_box_hull(box, (csg_box){p, p});
    }
    return box;
}

static bool find_places(csg_foreign_piece *piece, csg_memory *memory, places *out)
{
    csg_arena *arena = piece->arena;
    size_t corners = 3 * piece->triangle_count, count = 0;
    const uint32_t *indices = piece->source.indices + 3 * piece->first_triangle;
    csg_table table;
    csg_table_init(&table, memory);
    csg_triangles_init(&out->triangles, memory);
    out->place = csg_arena_alloc(arena, corners * sizeof *out->place);
    out->vertex = csg_arena_alloc(arena, corners * sizeof *out->vertex);
    csg_vec3 *rounded = csg_arena_alloc(arena, corners * sizeof *rounded);
    bool good =
        out->place && out->vertex && rounded && csg_table_reserve(&table, corners + 1, NULL, NULL);
    for (size_t i = 0; good && i < corners; i++) {
        size_t slot;
        csg_vec3 p = point_of(&piece->source, indices[i]), at = on_lattice(&piece->frame, p);
        uint32_t found = csg_place_find(&table, rounded, at, &slot);
        if (found == CSG_TABLE_NONE) {
            found = (uint32_t)count++;
            csg_table_put(&table, slot, found);
            rounded[found] = at;
            out->vertex[found] = indices[i];
            good = csg_triangles_add_point(&out->triangles, p);
        }
        out->place[i] = found;
    }
    for (size_t t = 0; good && t < piece->triangle_count; t++)
        good = csg_triangles_add(&out->triangles, out->place[3 * t], out->place[3 * t + 1],
                                 out->place[3 * t + 2]);
    csg_table_release(&table);
    return good;
}

/* ---- pairs of half-edges ----------------------------------------------------------------------- */

typedef struct spoke {
    double angle;
    uint32_t half;
    bool rises; /* runs from the edge's low end to its high one */
} spoke;

/* Angles about the edge as seen along it from low to high: the third corners of its triangles. */
static void measure_spokes(const csg_triangles *triangles, const csg_edge *edge,
                           const uint32_t *halves, spoke *spokes)
{
    csg_vec3 low = triangles->points[edge->low];
    csg_vec3 along = csg_vec3_sub(triangles->points[edge->high], low);
    csg_vec3 x = {0}, y = {0};
    for (uint32_t i = 0; i < edge->count; i++) {
        uint32_t half = halves[edge->first + i];
        uint32_t third = triangles->corners[half / 3][(half % 3 + 2) % 3];
        csg_vec3 out = csg_vec3_cross(along, csg_vec3_sub(triangles->points[third], low));
        if (i == 0) {
            x = out;
            y = csg_vec3_cross(along, out);
        }
        spokes[i] =
            (spoke){csg_atan2(csg_vec3_dot(out, y) / csg_vec3_norm(along), csg_vec3_dot(out, x)),
                    half, csg_half_from(triangles, half) == edge->low};
    }
}

/* Insertion: as a rule there are four. */
static void sort_spokes(spoke *spokes, uint32_t count)
{
    for (uint32_t i = 1; i < count; i++) {
        spoke taken = spokes[i];
        uint32_t k = i;
        for (; k > 0 && (spokes[k - 1].angle > taken.angle ||
                         (spokes[k - 1].angle == taken.angle && spokes[k - 1].half > taken.half));
             k--)
            spokes[k] = spokes[k - 1];
        spokes[k] = taken;
    }
}

/* Seen along the edge, the solid lies counter-clockwise of a triangle that runs back, up to one
 * that rises: these two become neighbours, as brackets do. */
static void pair_spokes(const spoke *spokes, uint32_t count, uint32_t *partner, uint32_t *stack)
{
    uint32_t depth = 0;
    for (uint32_t i = 0; i < 2 * count; i++) {
        const spoke *at = &spokes[i % count];
        if (partner[at->half] != NONE)
            continue;
        if (!at->rises) {
            if (i < count)
                stack[depth++] = at->half;
        } else if (depth) {
            uint32_t other = stack[--depth];
            partner[other] = at->half;
            partner[at->half] = other;
        }
    }
}

static bool find_partners(csg_arena *arena, const csg_triangles *triangles,
                          const csg_triangle_edges *edges, uint32_t *partner)
{
    uint32_t most = 2;
    for (size_t i = 0; i < edges->count; i++)
        most = edges->edges[i].count > most ? edges->edges[i].count : most;
    spoke *spokes = csg_arena_alloc(arena, most * sizeof *spokes);
    uint32_t *stack = csg_arena_alloc(arena, most * sizeof *stack);
    if (!spokes || !stack)
        return false;
    memset(partner, 0xff, 3 * triangles->count * sizeof *partner);
    for (size_t i = 0; i < edges->count; i++) {
        const csg_edge *edge = &edges->edges[i];
        measure_spokes(triangles, edge, edges->halves, spokes);
        if (edge->count > 2)
            sort_spokes(spokes, edge->count);
        pair_spokes(spokes, edge->count, partner, stack);
    }
    return true;
}

/* ---- a vertex for each fan --------------------------------------------------------------------- */

/* Corners -> vertices; a place that has several of them is fixed. */
static bool split_fans(csg_foreign_piece *piece, const csg_chain *chain,
                       const uint32_t *place_vertex, const uint32_t *partner)
{
    csg_arena *arena = piece->arena;
    const csg_triangles *triangles = &chain->triangles;
    size_t halves = 3 * triangles->count, vertices = 0;
    uint32_t *parent = csg_arena_alloc(arena, halves * sizeof *parent);
    uint32_t *number = csg_arena_alloc(arena, halves * sizeof *number);
    uint32_t *fans = csg_arena_calloc(arena, triangles->point_count, sizeof *fans);
    uint32_t *point = csg_arena_alloc(arena, halves * sizeof *point);
    piece->mesh.corners = csg_arena_alloc(arena, triangles->count * sizeof *piece->mesh.corners);
    if (!parent || !number || !fans || !point || !piece->mesh.corners)
        return false;
    csg_sets_init(parent, halves);
    for (uint32_t i = 0; i < halves; i++)
        if (partner[i] != NONE) {
            csg_sets_join(parent, i, csg_corner_next(partner[i]));
            csg_sets_join(parent, csg_corner_next(i), partner[i]);
        }
    for (uint32_t i = 0; i < halves; i++) { /* a root is the first corner of its fan */
        if (csg_set_root(parent, i) == i) {
            point[vertices] = triangles->corners[i / 3][i % 3];
            fans[point[vertices]]++;
            number[i] = (uint32_t)vertices++;
        }
        piece->mesh.corners[i / 3][i % 3] = number[csg_set_root(parent, i)];
    }
    uint8_t *fixed = csg_arena_alloc(arena, vertices);
    piece->points = csg_arena_alloc(arena, vertices * sizeof *piece->points);
    piece->mesh.points = csg_arena_alloc(arena, vertices * sizeof *piece->mesh.points);
    piece->mesh.vertex_from = csg_arena_alloc(arena, vertices * sizeof *piece->mesh.vertex_from);
    piece->source_vertex = csg_arena_alloc(arena, vertices * sizeof *piece->source_vertex);
    if (!fixed || !piece->points || !piece->mesh.points || !piece->mesh.vertex_from ||
        !piece->source_vertex)
        return false;
    for (uint32_t i = 0; i < vertices; i++) {
        csg_vec3 p = triangles->points[point[i]];
        const double at[3] = {p.x, p.y, p.z};
        memcpy(piece->points[i], at, sizeof at);
        memcpy(piece->mesh.points[i], at, sizeof at);
        fixed[i] = fans[point[i]] > 1;
        piece->mesh.vertex_from[i] = i;
        piece->source_vertex[i] = place_vertex[chain->welded[point[i]]];
    }
    piece->mesh.fixed = fixed;
    piece->mesh.vertex_count = vertices;
    piece->mesh.triangle_count = triangles->count;
    return true;
}

/* ---- where triangles came from ----------------------------------------------------------------- */

static void sort_three(const uint32_t in[3], uint32_t out[3])
{
    uint32_t a = in[0], b = in[1], c = in[2], t;
    if (a > b)
        t = a, a = b, b = t;
    if (b > c)
        t = b, b = c, c = t;
    if (a > b)
        t = a, a = b, b = t;
    out[0] = a, out[1] = b, out[2] = c;
}

static uint64_t hash_three(const uint32_t key[3])
{
    return csg_hash_word(csg_hash_word(csg_hash_word(0, key[0]), key[1]), key[2]);
}

static bool find_origins(csg_foreign_piece *piece, csg_memory *memory, const csg_chain *chain,
                         const places *at)
{
    csg_table table;
    csg_table_init(&table, memory);
    size_t count = chain->triangles.count;
    piece->triangle_of = csg_arena_alloc(piece->arena, count * sizeof *piece->triangle_of);
    piece->mesh.triangle_from =
        csg_arena_alloc(piece->arena, count * sizeof *piece->mesh.triangle_from);
    if (!piece->triangle_of || !piece->mesh.triangle_from ||
        !csg_table_reserve(&table, piece->triangle_count + 1, NULL, NULL)) {
        csg_table_release(&table);
        return false;
    }
    for (uint32_t t = 0; t < piece->triangle_count; t++) {
        uint32_t key[3];
        sort_three(at->place + 3 * (size_t)t, key);
        csg_table_add(&table, hash_three(key), t);
    }
    for (size_t t = 0; t < count; t++) {
        uint32_t corners[3], key[3], other[3];
        for (int k = 0; k < 3; k++)
            corners[k] = chain->welded[chain->triangles.corners[t][k]];
        sort_three(corners, key);
        size_t slot;
        uint32_t found = csg_table_first(&table, hash_three(key), &slot);
        for (; found != CSG_TABLE_NONE; found = csg_table_next(&table, &slot)) {
            sort_three(at->place + 3 * (size_t)found, other);
            if (memcmp(key, other, sizeof key) == 0)
                break;
        }
        piece->triangle_of[t] = found; /* CSG_TABLE_NONE is NONE */
        piece->mesh.triangle_from[t] = (uint32_t)t;
    }
    csg_table_release(&table);
    return true;
}

/* ---- looks and seams --------------------------------------------------------------------------- */

csg_corner_look csg_vertex_look(const csgm_mesh_view *source, uint32_t vertex)
{
    csg_corner_look look = {{0}, {0}};
    if (source->colors)
        memcpy(look.color, source->colors + 4 * (size_t)vertex, sizeof look.color);
    if (source->materials)
        memcpy(look.material, source->materials + 2 * (size_t)vertex, sizeof look.material);
    return look;
}

/* A corner of a triangle looks as the source's corner there does. */
static void look_at_corners(csg_foreign_piece *piece, const csg_chain *chain, const places *at)
{
    const uint32_t *indices = piece->source.indices + 3 * piece->first_triangle;
    for (size_t t = 0; t < piece->mesh.triangle_count; t++)
        for (int k = 0; k < 3; k++) {
            uint32_t place = chain->welded[chain->triangles.corners[t][k]];
            uint32_t from = piece->triangle_of[t], vertex = at->vertex[place];
            for (int j = 0; from != NONE && j < 3; j++)
                if (at->place[3 * (size_t)from + (size_t)j] == place)
                    vertex = indices[3 * (size_t)from + (size_t)j];
            piece->looks[3 * t + (size_t)k] = csg_vertex_look(&piece->source, vertex);
        }
}

static bool are_alike(const csg_foreign_piece *piece, uint32_t a, uint32_t b)
{
    return memcmp(&piece->looks[a], &piece->looks[b], sizeof *piece->looks) == 0;
}

bool csg_list_corners(csg_arena *arena, const csg_halfedge_mesh *mesh, csg_vertex_corners *out)
{
    size_t halves = 3 * mesh->triangle_count;
    out->first = csg_arena_alloc(arena, mesh->vertex_count * sizeof *out->first);
    out->next = csg_arena_alloc(arena, halves * sizeof *out->next);
    if (!out->first || !out->next)
        return false;
    memset(out->first, 0xff, mesh->vertex_count * sizeof *out->first);
    for (uint32_t half = (uint32_t)halves; half-- > 0;) {
        uint32_t *head = &out->first[mesh->corners[half / 3][half % 3]];
        out->next[half] = *head;
        *head = half;
    }
    return true;
}

static bool find_seams(csg_foreign_piece *piece, const uint32_t *partner)
{
    size_t count = piece->mesh.triangle_count;
    uint8_t *seams = csg_arena_calloc(piece->arena, 3 * count, 1);
    piece->group = csg_arena_alloc(piece->arena, count * sizeof *piece->group);
    if (!seams || !piece->group || !csg_list_corners(piece->arena, &piece->mesh, &piece->corners))
        return false;
    csg_sets_init(piece->group, count);
    for (uint32_t half = 0; half < 3 * count; half++) {
        uint32_t other = partner[half];
        seams[half] = other != NONE && (!are_alike(piece, half, csg_corner_next(other)) ||
                                        !are_alike(piece, csg_corner_next(half), other));
        if (other != NONE && !seams[half])
            csg_sets_join(piece->group, half / 3, other / 3);
    }
    for (uint32_t t = 0; t < count; t++)
        piece->group[t] = csg_set_root(piece->group, t);
    piece->mesh.seams = seams;
    return true;
}

/* Colours as they vary, for the bound on what goes; where they jump, that of the first corner. */
static bool spread_colors(csg_foreign_piece *piece)
{
    float *colors = csg_arena_alloc(piece->arena, 3 * piece->mesh.vertex_count * sizeof *colors);
    if (!colors)
        return false;
    for (size_t i = 0; i < piece->mesh.vertex_count; i++)
        for (size_t k = 0; k < 3; k++)
            colors[3 * i + k] = (float)piece->looks[piece->corners.first[i]].color[k] / 255.0f;
    piece->mesh.colors = colors;
    return true;
}

static bool add_looks(csg_foreign_piece *piece, const csg_chain *chain, const places *at,
                      const uint32_t *partner)
{
    static const double COLOR_WITHIN = 24.0 / 255;
    if (!piece->source.colors && !piece->source.materials)
        return true;
    size_t corners = 3 * piece->mesh.triangle_count;
    piece->looks = csg_arena_alloc(piece->arena, corners * sizeof *piece->looks);
    if (!piece->looks)
        return false;
    look_at_corners(piece, chain, at);
    bool vary = false;
    for (uint32_t i = 1; i < corners && !vary; i++)
        vary = !are_alike(piece, 0, i);
    if (!find_seams(piece, partner))
        return false;
    piece->mesh.color_within = COLOR_WITHIN;
    return !vary || !piece->source.colors || spread_colors(piece);
}

csg_corner_look csg_foreign_look(const csg_foreign_piece *piece, size_t triangle, int k)
{
    uint32_t from = piece->mesh.triangle_from[triangle];
    uint32_t vertex = piece->mesh.vertex_from[piece->mesh.corners[triangle][k]];
    uint32_t first = piece->corners.first[vertex];
    for (uint32_t c = first; c != NONE; c = piece->corners.next[c])
        if (piece->group[c / 3] == piece->group[from])
            return piece->looks[c];
    return piece->looks[first];
}

/* ---- the whole --------------------------------------------------------------------------------- */

static csgm_status fill(csg_foreign_piece *piece, csg_memory *memory, const csg_chain *chain,
                        const places *at)
{
    csg_triangle_edges edges;
    const csg_triangles *triangles = &chain->triangles;
    uint32_t *partner = csg_arena_alloc(piece->arena, 3 * triangles->count * sizeof *partner);
    piece->frame = chain->frame;
    bool good = partner && csg_edges_make(piece->arena, triangles, &edges) &&
                find_partners(piece->arena, triangles, &edges, partner) &&
                split_fans(piece, chain, at->vertex, partner) &&
                find_origins(piece, memory, chain, at) && add_looks(piece, chain, at, partner);
    return good ? CSGM_OK : CSGM_ERR_MEMORY;
}

csgm_status csg_foreign_piece_make(csg_arena *arena, const csgm_mesh_view *source,
                                   uint64_t first_triangle, uint64_t triangle_count,
                                   csg_foreign_piece *out, csg_repairs *repairs)
{
    places at;
    csg_chain chain;
    csg_memory *memory = arena->memory;
    *repairs = (csg_repairs){0};
    *out = (csg_foreign_piece){.arena = arena,
                               .source = *source,
                               .first_triangle = first_triangle,
                               .triangle_count = triangle_count};
    if (!triangle_count || !csg_triangle_frame_make(box_of(out), &out->frame))
        return CSGM_ERR_SCENE;
    csgm_status status = find_places(out, memory, &at)
                             ? csg_repair(memory, arena, &at.triangles, &chain, repairs)
                             : CSGM_ERR_MEMORY;
    csg_triangles_release(&at.triangles);
    if (status != CSGM_OK)
        return status;
    status = fill(out, memory, &chain, &at);
    csg_triangles_release(&chain.triangles);
    return status;
}
