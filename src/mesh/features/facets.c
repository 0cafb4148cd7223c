/* SPDX-License-Identifier: MIT
 * Balls around cells and jumps, held against a shape in its own frame; see facets.h.
 */
#include "mesh/features/facets.h"

#include <string.h>

/* Cells: creases nearer to each other run through one polygon, or through one and the next, and a
 * polygon has one apex. */
static const double NARROW = 2;

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

void csg_feature_find_facets(const csg_tape *tape, const csg_tape_node *leaf, float cell,
                             float radius, const float *x, const float *y, const float *z,
                             size_t count, csg_shape_balls *balls)
{
    const float *parameters = tape->parameters + leaf->parameters;
    const float *frame = parameters + CSG_LEAF_FRAME;
    double scale = 1 / fabs((double)parameters[CSG_LEAF_SIGMA]);
    const csg_shape_crease crease = {.least = (double)CSG_FEATURE_LEAST_JUMP,
                                     .blunt = (double)CSG_FEATURE_FADING,
                                     .narrow = NARROW * (double)cell * scale,
                                     .most_turn = CSG_FEATURE_MOST_BEND};
    balls->count = count;
    balls->radius = 1.01 * (double)radius * scale; /* of rounding there is less */
    if (leaf->warp || parameters[CSG_LEAF_RAISE] != 0 || !keeps_angles(leaf, frame)) {
        memset(balls->may_crease, true, sizeof balls->may_crease);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        const float at[3] = {x[i], y[i], z[i]};
        float q[3];
        csg_feature_to_own(leaf, frame, at, q);
        balls->center[i] = csg_vec3_from_floats(q);
    }
    csg_shape_creases(csg_tape_shape(tape, leaf), &crease, balls);
}

/* ---- jumps ------------------------------------------------------------------------------------
 */

/* Cells: how far off the surface a jump may be, and how far the nearest places of the surface then
 * are from it: both feet of a blunt edge's jump, and the edge between them. */
static const float MOST_OFF = 0.1f, AROUND = 0.15f;

/* Those that a smooth surface could have as well: blunt ones, of segments whose ends differ no more
 * than normals in a cell of it. */
static bool is_asked(const csg_feature_room *room, const csg_segment *s, float cell)
{
    float ends = 1.0f - csg_feature_cosine(room->gradient[s->from], room->gradient[s->to]);
    float off = fmaxf(fabsf(s->low_value), fabsf(s->high_value));
    return s->active && s->jump < CSG_FEATURE_FADING && (double)ends < CSG_FEATURE_MOST_BEND &&
           off <= MOST_OFF * cell;
}

static int octant_of(uint16_t cell)
{
    return (cell >> 2 & 1) | (cell >> 5 & 1) << 1 | (cell >> 8 & 1) << 2;
}

/* Of those in one part, from *next on, at most as many as there are balls: their numbers and the
 * middles of their brackets. */
static size_t gather(csg_feature_room *room, int octant, float cell, uint32_t *next)
{
    size_t count = 0;
    for (; *next < room->segment_count && count < CSG_SHAPE_MOST_BALLS; ++*next) {
        const csg_segment *s = &room->segments[*next];
        if (octant_of(room->loops[s->loop].cell) != octant || !is_asked(room, s, cell))
            continue;
        const float *a = room->slots.at[s->from], *b = room->slots.at[s->to];
        float t = 0.5f * (s->low + s->high);
        room->x[count] = a[0] + t * (b[0] - a[0]);
        room->y[count] = a[1] + t * (b[1] - a[1]);
        room->z[count] = a[2] + t * (b[2] - a[2]);
        room->which[count++] = *next;
    }
    return count;
}

void csg_feature_drop_facets(csg_feature_room *room, const csg_feature_probe *probe)
{
    const csg_tape *tape = &probe->marching->field->tape;
    float cell = (float)probe->marching->lattice->cell_size;
    csg_shape_balls balls;
    for (int octant = 0; octant < CSG_OCTANTS; octant++) {
        if (!(room->facets.are_all >> octant & 1))
            continue;
        for (uint32_t next = 0; next < room->segment_count;) {
            size_t count = gather(room, octant, cell, &next);
            if (!count)
                break;
            csg_feature_find_facets(tape, &room->facets.shape[octant], cell, AROUND * cell, room->x,
                                    room->y, room->z, count, &balls);
            for (size_t i = 0; i < count; i++)
                room->segments[room->which[i]].active = balls.may_crease[i];
        }
    }
}
