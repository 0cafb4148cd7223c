/* SPDX-License-Identifier: MIT
 * A cube of the tape's frame becomes a box of the shape's own, wide enough for all rounding on the
 * way; the shape says what of it comes within reach of the box (shape.h). Distances that matter are
 * those of the demand on the leaf. No point of the cube is farther from the surface than its centre
 * and the way there, so what lies farther from the box is nearest to no point of it.
 */
#include "field/prune/prune_shapes.h"

#include <math.h>
#include <string.h>

/* Of lengths that were computed in float. */
static const float ROOM = 1 + 0x1p-18f;

csg_shape_demand csg_prune_shape_demand(const csg_tape *tape, const csg_tape_node *leaf, float low,
                                        float high, float demand_low, float demand_high)
{
    const float *parameters = tape->parameters + leaf->parameters;
    float raise = parameters[CSG_LEAF_RAISE], slack = parameters[CSG_LEAF_SLACK];
    float per_unit = ROOM / fabsf(parameters[CSG_LEAF_SIGMA]);
    float most = fmaxf(fabsf(demand_low - raise), fabsf(demand_high - raise)) + slack;
    float middle = fabsf(0.5f * low + 0.5f * high - raise) + slack;
    return (csg_shape_demand){most * per_unit, middle * per_unit};
}

/* From the leaf's own frame, below its warps, to the shape's. */
static csg_vec3 enter_frame(const csg_tape_node *leaf, const float *frame, const double at[3])
{
    double q[3];
    for (int k = 0; k < 3; k++) {
        if (leaf->frame == CSG_FRAME_OFFSET) {
            q[k] = at[k] - (double)frame[k];
            continue;
        }
        const float *row = frame + 3 * k;
        q[k] = (double)frame[9 + k];
        for (int j = 0; j < 3; j++)
            q[k] += (double)row[j] * at[j];
    }
    return csg_vec3_make(q[0], q[1], q[2]);
}

/* Half the sides of the box around a cube's image under a frame. */
static csg_vec3 half_of_image(const csg_tape_node *leaf, const float *parameters, double side)
{
    const float *frame = parameters + CSG_LEAF_FRAME;
    if (leaf->frame == CSG_FRAME_OFFSET)
        return csg_vec3_make(side, side, side);
    double slack = (double)parameters[CSG_LEAF_SLACK], half[3];
    for (int k = 0; k < 3; k++) {
        half[k] = slack * 0x1p-5 / fabs((double)parameters[CSG_LEAF_SIGMA]);
        for (int j = 0; j < 3; j++)
            half[k] += fabs((double)frame[3 * k + j]) * side;
    }
    return csg_vec3_make(half[0], half[1], half[2]);
}

/* Of the shape's frame: the box around a cube's image. Below warps that around a ball: |sigma| is
 * at most 1 over the Lipschitz constant of the whole way. */
static csg_shape_cell cell_of(const csg_kernel *kernel, const csg_tape *tape,
                              const csg_tape_node *leaf, const csg_shape_cube *cube)
{
    static const double SHARE = 0.5773503; /* 1 / sqrt 3, rounded up */
    const float *parameters = tape->parameters + leaf->parameters;
    double slack = (double)parameters[CSG_LEAF_SLACK];
    double at[3] = {(double)cube->center[0], (double)cube->center[1], (double)cube->center[2]};
    csg_shape_cell cell = {.reach = 0};
    if (leaf->warp) {
        float x[CSG_LANES], y[CSG_LANES], z[CSG_LANES];
        for (int i = 0; i < CSG_LANES; i++)
            x[i] = cube->center[0], y[i] = cube->center[1], z[i] = cube->center[2];
        kernel->warped(tape, leaf->warp, x, y, z, CSG_LANES);
        at[0] = (double)x[0], at[1] = (double)y[0], at[2] = (double)z[0];
        double half = ((double)cube->radius * (double)ROOM + 2 * slack) /
                      fabs((double)parameters[CSG_LEAF_SIGMA]);
        cell.half = csg_vec3_make(half, half, half);
    } else {
        cell.half = half_of_image(leaf, parameters, (double)cube->radius * SHARE + slack);
    }
    cell.center = enter_frame(leaf, parameters + CSG_LEAF_FRAME, at);
    if (csg_tape_shape(tape, leaf)->kind == CSG_SHAPE_REGION)
        cell.half.z = 0; /* it does not depend on z */
    return cell;
}

static csg_shape_near *make_near(csg_arena *arena, double limit, const uint32_t *items,
                                 uint32_t count)
{
    csg_shape_near *near = csg_arena_alloc(arena, sizeof *near + count * sizeof *items);
    if (near) {
        *near = (csg_shape_near){limit, count};
        memcpy(near->items, items, count * sizeof *items);
    }
    return near;
}

bool csg_prune_copy_shape(csg_tape_node *leaf, csg_arena *arena)
{
    const csg_shape_near *near = leaf->near;
    if (near)
        leaf->near = make_near(arena, near->limit, near->items, near->count);
    return leaf->near || !near;
}

bool csg_prune_shape(const csg_kernel *kernel, const csg_tape *tape, csg_tape_node *leaf,
                     const csg_shape_cube *cube, csg_shape_demand demand, csg_arena *arena,
                     bool *shortened)
{
    uint32_t items[CSG_SHAPE_MOST_NEAR];
    const csg_shape_near *before = leaf->near;
    csg_shape_cell cell = cell_of(kernel, tape, leaf, cube);
    double within = (double)demand.middle + csg_vec3_norm(cell.half);
    cell.reach = fmin(fmax((double)demand.reach, (double)demand.middle), within);
    if (before)
        cell.reach = fmin(cell.reach, before->limit);
    uint32_t count = csg_shape_narrow(csg_tape_shape(tape, leaf), before, &cell, items);
    bool is_same =
        before && count == before->count && !memcmp(items, before->items, count * sizeof *items);
    if (count == 0 || is_same)
        return csg_prune_copy_shape(leaf, arena);
    *shortened = true;
    leaf->near = make_near(arena, cell.reach, items, count);
    return leaf->near != NULL;
}
