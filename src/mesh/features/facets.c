/* SPDX-License-Identifier: MIT
 * Balls around cells and jumps, held against a shape in its own frame; see facets.h.
 */
#include "mesh/features/facets.h"

#include <string.h>

/* Cells: creases nearer to each other run through one polygon, or through one and the next, and a
 * polygon has one apex. */
static const double NARROW = 2;
/* What is nearest to a jump, both feet of a blunt edge's and the edge between them, is as far from
 * it as it is off the surface, a little more, and so many cells. */
static const double FARTHER = 1.05, AROUND = 0.05;

/* Whether a frame keeps angles, but for rounding. */
static bool keeps_angles(const csg_tape_node *leaf, const float *frame)
{
    static const float SAME = 1e-4f;
    float one = frame[0] * frame[0] + frame[1] * frame[1] + frame[2] * frame[2];
    bool keeps = true;
    for (int i = 0; i < 3 && leaf->frame != CSG_FRAME_OFFSET; i++)
        for (int k = 0; k <= i; k++) {
            const float *a = frame + 3 * i, *b = frame + 3 * k;
            float product = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            keeps = keeps && fabsf(product - (i == k ? one : 0)) <= SAME * one;
        }
    return keeps;
}

/* Whether the leaf's shape tells its creases, and they are the leaf's. */
static bool tells_creases(const csg_tape *tape, const csg_tape_node *leaf)
{
    const float *parameters = tape->parameters + leaf->parameters;
    return !leaf->warp && parameters[CSG_LEAF_RAISE] == 0 &&
           csg_shape_tells_creases(csg_tape_shape(tape, leaf)) &&
           keeps_angles(leaf, parameters + CSG_LEAF_FRAME);
}

/* Balls around points of the tape's frame, held against the shape of a leaf that tells; radii are
 * filled in. */
static void find_creases(const csg_tape *tape, const csg_tape_node *leaf, float cell,
                         const float *x, const float *y, const float *z, csg_shape_balls *balls)
{
    const float *parameters = tape->parameters + leaf->parameters;
    const float *frame = parameters + CSG_LEAF_FRAME;
    double scale = 1 / fabs((double)parameters[CSG_LEAF_SIGMA]);
    const csg_shape_crease crease = {.least = (double)CSG_FEATURE_LEAST_JUMP,
                                     .blunt = (double)CSG_FEATURE_FADING,
                                     .narrow = NARROW * (double)cell * scale,
                                     .most_turn = CSG_FEATURE_MOST_BEND};
    for (size_t i = 0; i < balls->count; i++) {
        const float at[3] = {x[i], y[i], z[i]};
        float q[3];
        csg_feature_to_own(leaf, frame, at, q);
        balls->center[i] = csg_vec3_from_floats(q);
        balls->radius[i] *= scale;
    }
    csg_shape_creases(csg_tape_shape(tape, leaf), &crease, balls);
}

/* A segment of a polygon lies in one face of its cell, between two points of the surface, so none
 * of it is farther than half a face's diagonal from one of them, nor is the place of the surface
 * that is nearest to it: all of these are in a ball around the cell. With fewer facets than cells
 * most are too large for their edges to be left out. */
void csg_feature_find_facets(const csg_tape *tape, const csg_tape_node *leaf, float cell,
                             const float *x, const float *y, const float *z, size_t count,
                             csg_shape_balls *balls)
{
    static const double HALF_CUBE = 0.8661, HALF_FACE = 0.7072; /* diagonals, rounded up */
    if (!tells_creases(tape, leaf)) {
        memset(balls->may_crease, true, sizeof balls->may_crease);
        return;
    }
    balls->count = balls->fewest = count;
    for (size_t i = 0; i < count; i++)
        balls->radius[i] = 1.01 * (HALF_CUBE + FARTHER * HALF_FACE + AROUND) * (double)cell;
    find_creases(tape, leaf, cell, x, y, z, balls);
}

/* ---- jumps ------------------------------------------------------------------------------------
 */

/* The jumps of one part that are held against one of its leaves. */
typedef struct facet_jumps {
    csg_feature_room *room;
    csg_feature_probe *probe;
    float cell;
    int octant;
    uint32_t next; /* segment to be looked at */
    size_t count;
    uint32_t which[CSG_SHAPE_MOST_BALLS];
    csg_shape_balls balls;
} facet_jumps;

static float low_value(const csg_feature_room *room, const csg_segment *s)
{
    return s->low > 0 ? s->low_value : room->value[s->from];
}

static float high_value(const csg_feature_room *room, const csg_segment *s)
{
    return s->high < 1 ? s->high_value : room->value[s->to];
}

/* Those that a smooth surface could have as well: blunt ones, of segments whose ends differ no more
 * than normals in a cell of it. */
static bool is_asked(const csg_feature_room *room, const csg_segment *s, int octant)
{
    uint16_t cell = room->loops[s->loop].cell;
    int own = (cell >> 2 & 1) | (cell >> 5 & 1) << 1 | (cell >> 8 & 1) << 2;
    float ends = 1.0f - csg_feature_cosine(room->gradient[s->from], room->gradient[s->to]);
    return s->active && own == octant && s->jump < CSG_FEATURE_FADING &&
           (double)ends < CSG_FEATURE_MOST_BEND;
}

static void place_at(const facet_jumps *j, const csg_segment *s, float t, size_t i)
{
    const csg_feature_room *room = j->room;
    const float *a = room->slots.at[s->from], *b = room->slots.at[s->to];
    j->room->x[i] = a[0] + t * (b[0] - a[0]);
    j->room->y[i] = a[1] + t * (b[1] - a[1]);
    j->room->z[i] = a[2] + t * (b[2] - a[2]);
}

/* As many as fit. The middle of a bracket, and a ball that holds what is nearest to it: both feet
 * of a blunt edge's jump and the edge between them, which is little farther. */
static bool gather_jumps(facet_jumps *j)
{
    const csg_feature_room *room = j->room;
    for (j->count = 0; j->next < room->segment_count && j->count < CSG_SHAPE_MOST_BALLS;
         j->next++) {
        const csg_segment *s = &room->segments[j->next];
        if (!is_asked(room, s, j->octant))
            continue;
        float off = fmaxf(fabsf(low_value(room, s)), fabsf(high_value(room, s)));
        place_at(j, s, 0.5f * (s->low + s->high), j->count);
        j->balls.radius[j->count] = FARTHER * (double)off + AROUND * (double)j->cell;
        j->which[j->count++] = j->next;
    }
    j->balls.count = j->count;
    j->balls.fewest = 0;
    return j->count > 0;
}

/* Whether the field at both ends of the brackets is the leaf: what else the tape has does not
 * matter there, and may have been dropped or not. Goes to is_leaf. */
static void find_leaf(facet_jumps *j, const csg_tape_node *leaf, bool *is_leaf)
{
    enum { BOTH = 2 };
    csg_feature_room *room = j->room;
    csg_feature_probe *probe = j->probe;
    csg_tape_node alone = *leaf;
    csg_tape tape = probe->marching->field->tape;
    size_t n = BOTH * j->count;
    alone.join = CSG_JOIN_NONE;
    tape.nodes = &alone;
    tape.count = 1;
    for (size_t i = 0; i < n; i++) {
        const csg_segment *s = &room->segments[j->which[i / BOTH]];
        place_at(j, s, i % BOTH ? s->high : s->low, i);
    }
    for (size_t i = n; i % CSG_LANES; i++)
        room->x[i] = room->x[0], room->y[i] = room->y[0], room->z[i] = room->z[0];
    probe->marching->kernel->values(&tape, room->x, room->y, room->z, n, room->f, probe->scratch,
                                    probe->scratch_floats);
    probe->evaluations += n;
    for (size_t i = 0; i < j->count; i++) {
        const csg_segment *s = &room->segments[j->which[i]];
        is_leaf[i] = fabsf(room->f[BOTH * i] - low_value(room, s)) <= probe->marching->noise &&
                     fabsf(room->f[BOTH * i + 1] - high_value(room, s)) <= probe->marching->noise;
    }
}

/* Those of one part, at one leaf. */
static void drop_at_leaf(facet_jumps *j, const csg_tape_node *leaf, bool is_alone)
{
    const csg_tape *tape = &j->probe->marching->field->tape;
    csg_feature_room *room = j->room;
    bool is_leaf[CSG_SHAPE_MOST_BALLS];
    for (j->next = 0; gather_jumps(j);) {
        find_creases(tape, leaf, j->cell, room->x, room->y, room->z, &j->balls);
        memset(is_leaf, true, sizeof is_leaf);
        if (!is_alone)
            find_leaf(j, leaf, is_leaf);
        for (size_t i = 0; i < j->count; i++)
            if (is_leaf[i] && !j->balls.may_crease[i])
                room->segments[j->which[i]].active = 0;
    }
}

void csg_feature_drop_facets(csg_feature_room *room, csg_feature_probe *probe)
{
    const csg_block *block = probe->block;
    facet_jumps j = {
        .room = room, .probe = probe, .cell = (float)probe->marching->lattice->cell_size};
    for (j.octant = 0; j.octant < CSG_OCTANTS; j.octant++) {
        const csg_block_part *part = block->parts ? &block->parts[j.octant] : NULL;
        const csg_tape_node *nodes = part ? part->nodes : block->nodes;
        uint32_t count = part ? part->node_count : block->node_count;
        if (part && part->state != CSG_CELL_SURFACE)
            continue;
        for (uint32_t i = 0; i < count; i++)
            if (nodes[i].op == CSG_OP_SHAPE &&
                tells_creases(&probe->marching->field->tape, &nodes[i]))
                drop_at_leaf(&j, &nodes[i], count == 1);
    }
}
