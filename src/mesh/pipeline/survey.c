/* SPDX-License-Identifier: MIT
 * What a mesh was made from, as boxes, and these as a mesh; see survey.h.
 */
#include "mesh/pipeline/survey.h"

#include <math.h>
#include <string.h>

#include "base/elementary.h"
#include "base/mesh_codes.h"

enum {
    BARS = 12, /* of a frame: a thin box for each edge */
    BAR_VERTICES = 8,
    BAR_TRIANGLES = 12
};
static const double BAR_WIDTH = 1.0 / 40; /* of the box */

csg_survey *csg_survey_create(csgm_context *context)
{
    csg_survey *survey = csg_memory_alloc(&context->memory, sizeof *survey);
    if (survey)
        *survey = (csg_survey){.context = context};
    else
        csg_context_no_memory(context);
    return survey;
}

void csg_survey_destroy(csg_survey *survey)
{
    if (!survey)
        return;
    csg_memory *memory = &survey->context->memory;
    csg_memory_release(memory, survey->boxes, survey->capacity * sizeof *survey->boxes);
    csg_memory_release(memory, survey, sizeof *survey);
}

/* ---- what is looked at --------------------------------------------------------------------- */

static void add_box(csg_survey *s, csg_survey_kind kind, csg_vec3 min, double size,
                    const uint8_t color[3])
{
    if (s->failed || !csg_memory_reserve(&s->context->memory, (void **)&s->boxes, &s->capacity,
                                         s->count + 1, sizeof *s->boxes)) {
        s->failed = true;
        return;
    }
    s->boxes[s->count++] =
        (csg_survey_box){min, size, {color[0], color[1], color[2]}, (uint8_t)kind};
}

/* A cube of the lattice, by its lowest point and its cells along an edge. */
static void add_cube(csg_survey *s, csg_survey_kind kind, csg_vec3 center,
                     const csg_lattice *lattice, const uint32_t point[3], uint32_t cells,
                     uint32_t nodes)
{
    double longest = 8, share = csg_log2(nodes < 1 ? 1 : nodes) / longest; /* 2^8 nodes are many */
    share = share < 1 ? share : 1;
    const uint8_t color[3] = {(uint8_t)(40 + 210 * share), (uint8_t)(90 + 120 * share),
                              (uint8_t)(220 - 180 * share)};
    csg_vec3 steps = {point[0], point[1], point[2]};
    csg_vec3 min = csg_vec3_add(csg_vec3_add(center, lattice->origin),
                                csg_vec3_scale(steps, lattice->cell_size));
    add_box(s, kind, min, cells * lattice->cell_size, color);
}

void csg_survey_octree(csg_survey *s, const csg_mesh_input *input, const csg_octree *octree)
{
    enum { CELLS = 2 * CSG_BLOCK_EDGE };
    for (size_t i = 0; i < csg_octree_frontier_count(octree); i++) {
        uint32_t at[3];
        csg_tape tape = csg_octree_frontier_tape(octree, i, at);
        const uint32_t point[3] = {CELLS * at[0], CELLS * at[1], CELLS * at[2]};
        add_cube(s, CSG_SURVEY_OCTREE, input->field->center, &input->lattice, point, CELLS,
                 tape.count);
    }
}

void csg_survey_blocks(csg_survey *s, const csg_mesh_input *input, csg_mesh_blocks blocks)
{
    enum { CELLS = CSG_BLOCK_EDGE };
    for (size_t i = 0; i < blocks.count; i++) {
        const csg_block *block = blocks.block[i];
        const uint32_t point[3] = {CELLS * block->at[0], CELLS * block->at[1],
                                   CELLS * block->at[2]};
        add_cube(s, CSG_SURVEY_BLOCKS, input->field->center, &input->lattice, point, CELLS,
                 block->node_count);
    }
}

void csg_survey_bricks(csg_survey *s, csg_vec3 center, const csg_bricks *bricks)
{
    for (size_t i = 0; i < bricks->count; i++) {
        const csg_brick *brick = &bricks->items[i];
        uint32_t edge = csg_bricks_cell(bricks, brick->level), point[3];
        for (int axis = 0; axis < 3; axis++)
            point[axis] = csg_brick_point(bricks, brick, axis, 0);
        if (brick->divided)
            add_cube(s, CSG_SURVEY_OCTREE, center, bricks->lattice, point, CSG_BRICK_EDGE * edge,
                     brick->node_count);
        for (unsigned cell = 0; cell < CSG_OCTANTS; cell++) {
            unsigned at[3];
            uint32_t low[3];
            if (!((brick->crossed & ~brick->divided) >> cell & 1))
                continue;
            csg_brick_cell_place(cell, at);
            for (int axis = 0; axis < 3; axis++)
                low[axis] = point[axis] + at[axis] * edge;
            add_cube(s, CSG_SURVEY_BLOCKS, center, bricks->lattice, low, edge, brick->node_count);
        }
    }
}

static const uint8_t *color_of(csg_feature_state state)
{
    static const uint8_t green[3] = {60, 180, 75}, orange[3] = {245, 150, 40};
    static const uint8_t red[3] = {220, 40, 40}, grey[3] = {150, 150, 150};
    switch (state) {
    case CSG_FEATURE_SOLVED:
        return green;
    case CSG_FEATURE_FOLDED:
        return orange;
    case CSG_FEATURE_BARE:
        return grey;
    case CSG_FEATURE_NEW:
    case CSG_FEATURE_UNSOLVED:
    case CSG_FEATURE_GIVEN_UP:
        break;
    }
    return red;
}

static csg_vec3 place_of(const csg_feature *feature)
{
    if (feature->state == CSG_FEATURE_SOLVED || feature->state == CSG_FEATURE_FOLDED)
        return csg_vec3_from_floats(feature->at);
    csg_vec3 sum = {0, 0, 0};
    for (unsigned i = 0; i < feature->side_count; i++)
        sum = csg_vec3_add(sum, csg_vec3_from_floats(feature->side[i].corner));
    return csg_vec3_scale(sum, 1.0 / feature->side_count);
}

void csg_survey_features(csg_survey *s, const csg_mesh_input *input, const csg_feature_store *store)
{
    double size = input->lattice.cell_size / 4, half = size / 2;
    for (size_t i = 0; i < store->count; i++) {
        const csg_feature *feature = &store->features[i];
        csg_vec3 middle = csg_vec3_add(input->field->center, place_of(feature));
        add_box(s, CSG_SURVEY_FEATURES, csg_vec3_sub(middle, (csg_vec3){half, half, half}), size,
                color_of(feature->state));
    }
}

/* ---- the mesh ------------------------------------------------------------------------------ */

/* Where the next box goes. */
typedef struct filling {
    csgm_mesh *mesh;
    uint32_t vertex;
    uint64_t triangle;
} filling;

static void put_box(filling *to, csg_vec3 min, csg_vec3 max, const uint8_t color[3])
{
    /* corners by bits x, y, z; counter-clockwise seen from outside */
    static const uint8_t corners[BAR_TRIANGLES][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                                      {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                                      {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    csg_vec3 origin = to->mesh->origin;
    for (uint32_t i = 0; i < BAR_VERTICES; i++) {
        csg_vec3 at = {i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z};
        csg_vec3_to_floats(to->mesh->positions + 3 * (to->vertex + i), csg_vec3_sub(at, origin));
        memcpy(to->mesh->colors + 4 * (to->vertex + i),
               (uint8_t[4]){color[0], color[1], color[2], 255}, 4);
    }
    for (int i = 0; i < BAR_TRIANGLES; i++, to->triangle++)
        for (uint32_t k = 0; k < 3; k++)
            to->mesh->indices[3 * to->triangle + k] = to->vertex + corners[i][k];
    to->vertex += BAR_VERTICES;
}

/* Twelve bars, all within the box, so that frames side by side do not share places. */
static void put_frame(filling *to, const csg_survey_box *box)
{
    const double width = box->size * BAR_WIDTH, far = box->size - width;
    for (int axis = 0; axis < 3; axis++)
        for (int end = 0; end < 4; end++) {
            double low[3], size[3];
            for (int k = 0; k < 3; k++) {
                bool is_second = k == (axis + 1) % 3 ? end & 1 : end >> 1;
                low[k] = k == axis ? 0 : is_second ? far : 0;
                size[k] = k == axis ? box->size : width;
            }
            csg_vec3 min = csg_vec3_add(box->min, (csg_vec3){low[0], low[1], low[2]});
            put_box(to, min, csg_vec3_add(min, (csg_vec3){size[0], size[1], size[2]}), box->color);
        }
}

static csgm_status fill_parts(const csg_survey *s, filling *to)
{
    static const char *const names[CSG_SURVEY_KINDS] = {"octree", "blocks", "features"};
    csgm_status status = CSGM_OK;
    for (int kind = 0; kind < CSG_SURVEY_KINDS && status == CSGM_OK; kind++) {
        uint64_t first = to->triangle;
        for (size_t i = 0; i < s->count; i++) {
            const csg_survey_box *box = &s->boxes[i];
            csg_vec3 size = {box->size, box->size, box->size};
            if (box->kind == kind && kind == CSG_SURVEY_FEATURES)
                put_box(to, box->min, csg_vec3_add(box->min, size), box->color);
            else if (box->kind == kind)
                put_frame(to, box);
        }
        if (to->triangle > first)
            status = csg_mesh_add_part(to->mesh, names[kind], first);
    }
    return status;
}

csgm_status csg_survey_mesh(const csg_survey *s, csgm_mesh **out)
{
    uint64_t bars = 0;
    csg_box bounds = csg_box_empty();
    if (s->failed)
        return csg_context_no_memory(s->context);
    for (size_t i = 0; i < s->count; i++) {
        bars += s->boxes[i].kind == CSG_SURVEY_FEATURES ? 1 : BARS;
        bounds = csg_box_hull(bounds, (csg_box){s->boxes[i].min, s->boxes[i].min});
    }
    if (bars > UINT32_MAX / BAR_VERTICES) {
        csg_diag_plain(&s->context->diags, CSG_DIAG_TOO_FINE, NULL, "lower -r, or raise -s or -e",
                       "there are too many cells to be shown");
        return CSGM_ERR_LIMIT;
    }
    csgm_mesh *mesh;
    csgm_status status =
        csg_mesh_create(s->context, bars * BAR_VERTICES, bars * BAR_TRIANGLES, false, true, &mesh);
    if (status != CSGM_OK)
        return status;
    if (s->count)
        mesh->origin = csg_mesh_origin(csg_box_center(bounds), bounds);
    status = fill_parts(s, &(filling){.mesh = mesh});
    if (status == CSGM_OK)
        *out = mesh;
    else
        csg_mesh_destroy(mesh);
    return status;
}
