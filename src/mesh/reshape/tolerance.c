/* SPDX-License-Identifier: MIT
 * One try to reach a goal; see tolerance.h.
 */
#include "mesh/reshape/tolerance.h"

#include <math.h>

#include "base/clock.h"
#include "base/trace.h"
#include "mesh/reshape/decimate.h"
#include "mesh/reshape/improve.h"
#include "mesh/reshape/refine.h"

/* ---- which resolution -------------------------------------------------------------------------
 */

/* How far the triangles of equal cells stray from the surface, but for a fiftieth of them, and
 * for those that cut off a crease: these do not get better with the square of the cell. */
static bool find_deviation(csg_remesh *r, double *out)
{
    static const double CUT = 0.1; /* of the longest side */
    size_t count = r->corners.triangle_count, n = 0;
    float *values = csg_memory_alloc(r->memory, count * sizeof *values);
    if (!values)
        return false;
    csg_remesh_values_at_centroids(r, NULL, values);
    for (uint32_t t = 0; t < count; t++) {
        csg_vec3 a = csg_remesh_corner(r, 3 * t), b = csg_remesh_corner(r, 3 * t + 1);
        double side = csg_vec3_norm(csg_vec3_sub(a, b)), f = fabs((double)values[t]);
        if (f < CUT * fmax(side, 0.5 * r->cell))
            values[n++] = (float)f;
    }
    *out = csg_remesh_common_value(values, n) / (double)r->probe.marching->field->tape.lipschitz;
    csg_memory_release(r->memory, values, count * sizeof *values);
    return true;
}

/* Cells whose triangles stray by six tenths of the error: theirs grows with their square. */
static csgm_status choose_cells(csg_remesh *r, csg_mesh_goal *goal)
{
    static const double ROOM = 1, CLOSE_ENOUGH = 0.8, LEAST_STEP = 0.25;
    double deviation;
    if (!find_deviation(r, &deviation))
        return csg_context_no_memory(r->context);
    double factor = sqrt(ROOM * goal->error / fmax(deviation, 1e-30));
    if (factor < CLOSE_ENOUGH && !goal->is_last)
        goal->cell_size = r->cell * fmax(factor, LEAST_STEP);
    return CSGM_OK;
}

/* ---- one try ----------------------------------------------------------------------------------
 */

/* With errors that double until few enough triangles are left. A share of a mesh that cells made
 * within an error is that of the triangles which the error leaves, not of those that it began with:
 * nobody has seen these. */
static csgm_status reach_count(csg_decimation *d, csg_mesh_goal *goal)
{
    csg_remesh *r = d->remesh;
    csgm_status status = CSGM_OK;
    if (goal->error > 0 && goal->share > 0 && !goal->triangles && !goal->is_own) {
        status = csg_decimate(d, CSG_DECIMATE_ALL);
        goal->begun = r->corners.live;
    }
    double wanted = goal->triangles ? (double)goal->triangles : goal->share * (double)goal->begun;
    uint32_t least = wanted < (double)goal->begun ? (uint32_t)ceil(wanted) : (uint32_t)goal->begun;
    double most = 0.25 * csg_lattice_extent(r->marching->lattice);
    r->error = goal->error > 0 ? goal->error : r->cell / 64;
    while (status == CSGM_OK) {
        status = csg_decimate(d, least);
        if (status != CSGM_OK || r->corners.live <= least + 1 || r->error * 2 > most)
            break;
        r->error *= 2;
    }
    goal->tight = r->corners.live > least + 1;
    return status;
}

double csg_mesh_goal_error(const csg_mesh_goal *goal)
{
    return goal->care * goal->error;
}

/* Triangles whose vertices lie on a curved surface are all on its one side. With vertices that lie
 * a little on the other they are larger by half, and as near. That is for those who ask how near
 * the mesh is; others want to find its vertices where the surface is. */
double csg_mesh_goal_farthest(const csg_mesh_goal *goal)
{
    static const double OFF = 0.75; /* of what changes may make */
    return goal->proves && !csg_mesh_goal_has_count(goal) ? OFF * csg_mesh_goal_error(goal) : 0;
}

static csgm_status thin_out(csg_remesh *r, csg_mesh_goal *goal, const csg_missed *missed,
                            csg_far_places *far)
{
    CSG_ZONE(r->context, "decimation");
    csg_decimation d;
    r->error = csg_mesh_goal_error(goal);
    if (goal->joined) /* samples move now; the tree is not asked before it is made again */
        csg_triangle_tree_forget(&r->tree);
    csgm_status status =
        csg_decimation_begin(&d, r, missed, goal->joined ? &goal->joined->samples : NULL);
    if (status != CSGM_OK)
        return status;
    d.farthest_vertex = csg_mesh_goal_farthest(goal);
    status =
        csg_mesh_goal_has_count(goal) ? reach_count(&d, goal) : csg_decimate(&d, CSG_DECIMATE_ALL);
    double error = goal->proves && !csg_mesh_goal_has_count(goal) ? goal->error : INFINITY;
    if (status == CSGM_OK && !csg_decimation_measure(&d, error, far, &goal->measured))
        status = csg_context_no_memory(r->context);
    csg_decimation_end(&d);
    return status;
}

/* The bound that is proven, of a mesh that is brought to the places that are far. */
static csgm_status prove(csg_remesh *r, csg_mesh_goal *goal, const csg_far_places *far)
{
    CSG_ZONE(r->context, "distance proof");
    csg_distance_proof proof;
    goal->allowed = goal->error > 0 && !csg_mesh_goal_has_count(goal) ? goal->error : r->error;
    goal->bound = INFINITY;
    if (csg_mesh_goal_has_count(goal) || !goal->proves)
        return CSGM_OK; /* a proof might refine it again: every collapse was checked, that is all */
    csgm_status status = csg_refine_until_near(r, goal->allowed, far, &proof);
    if (status != CSGM_OK)
        return status;
    goal->unproven = proof.stopped;
    goal->open = proof.stopped ? 0 : proof.open;
    goal->bound = goal->open || proof.stopped ? INFINITY : goal->allowed;
    goal->place = csg_vec3_add(proof.place, r->marching->field->center);
    return CSGM_OK;
}

/* Of what was missed the places that are farther from the mesh than the error, to the goal. */
static csgm_status list_away(const csg_remesh *r, const csg_missed *missed, csg_mesh_goal *goal)
{
    for (size_t i = 0; i < missed->count; i++) {
        csg_vec3 at = csg_vec3_from_floats(missed->points[i].at);
        if (csg_triangle_tree_nearest(&r->tree, at, goal->error, NULL) == INFINITY &&
            !csg_far_places_add(&goal->away, r->memory, at))
            return csg_context_no_memory(r->context);
    }
    return CSGM_OK;
}

/* What the cells are too large for; where they are free, smaller ones are asked for. */
static csgm_status find_missed(csg_remesh *r, csg_mesh_goal *goal, csg_missed *missed)
{
    static const double PART = 2; /* of the error: what is as far from the mesh is not part of it */
    CSG_ZONE(r->context, "missed parts");
    *missed = (csg_missed){0};
    if (!(goal->error > 0) || goal->is_own)
        return CSGM_OK;
    if (!goal->proves) /* tiles had what was seen in them */
        return goal->seen && !goal->joined
                   ? csg_missed_take_seen(r, goal->seen, csg_mesh_goal_error(goal), missed)
                   : CSGM_OK;
    csgm_status status = csg_missed_find(r, goal->error, &goal->before, goal->looks_closer, missed);
    if (status == CSGM_OK && goal->chooses && !goal->is_last &&
        missed->distances.farthest > goal->error)
        goal->cell_size = 0.5 * r->cell;
    double most = goal->looks_closer ? goal->error : PART * goal->error;
    if (status == CSGM_OK && goal->follows && !goal->is_last && missed->distances.farthest > most) {
        goal->cell_size = r->cell;
        status = list_away(r, missed, goal);
    }
    goal->unfinished = missed->unfinished;
    if (status == CSGM_OK && goal->looks_closer && goal->cell_size > 0)
        csg_missed_keep(r, missed, &goal->before);
    return status;
}

/* The largest distance of a place from the mesh as it is now. */
static double measure(const csg_remesh *r, const csg_mesh_goal *goal, const csg_far_places *far)
{
    double most = csg_lattice_extent(r->marching->lattice);
    return fmax(goal->measured, csg_far_places_distance(far, &r->tree, most));
}

static csgm_status thin_and_prove(csg_remesh *r, csg_mesh_goal *goal, csg_far_places *far)
{
    bool thins = goal->error > 0 || csg_mesh_goal_has_count(goal);
    csg_missed missed;
    csgm_status status = find_missed(r, goal, &missed);
    if (status == CSGM_OK && thins && !(goal->cell_size > 0))
        status = thin_out(r, goal, &missed, far);
    goal->measured = fmax(goal->measured, missed.distances.unlisted);
    csg_missed_release(&missed, r->memory);
    if (status != CSGM_OK || goal->cell_size > 0)
        return status;
    if (status == CSGM_OK && goal->improve)
        status = csg_improve(r, thins);
    if (status == CSGM_OK && thins && goal->chooses && measure(r, goal, far) > goal->error &&
        !goal->is_last)
        goal->cell_size = 0.6 * r->cell; /* the lattice is too coarse for its own samples */
    else if (status == CSGM_OK && thins)
        status = prove(r, goal, far);
    goal->measured = measure(r, goal, far);
    if (status == CSGM_OK && goal->open && !goal->is_last && !goal->follows)
        goal->cell_size = goal->chooses ? 0.6 * r->cell : r->cell;
    if (status == CSGM_OK && !(goal->cell_size > 0))
        status = csg_remesh_write_back(r, goal->normals != CSGM_NORMALS_NONE,
                                       goal->normals == CSGM_NORMALS_CREASE);
    return status;
}

static csgm_status try_goal(csg_remesh *r, csg_mesh_goal *goal)
{
    csg_far_places far = {0};
    goal->begun = goal->joined ? goal->joined->begun : r->corners.live;
    csgm_status status = goal->chooses ? choose_cells(r, goal) : CSGM_OK;
    if (status == CSGM_OK && !(goal->cell_size > 0))
        status = thin_and_prove(r, goal, &far);
    csg_far_places_release(&far, r->memory);
    return status;
}

csgm_status csg_mesh_reshape(csg_mesh_goal *goal, csgm_mesh **mesh, const csg_marching *marching,
                             csg_mesh_watch *watch)
{
    CSG_ZONE(watch->context, "reshape");
    csg_remesh remesh;
    double begin_s = csg_clock_now_s();
    const csg_remesh_origin origin = {.is_own = goal->is_own,
                                      .kinds = goal->joined ? goal->joined->kinds : NULL};
    csgm_status status = csg_remesh_begin(&remesh, *mesh, &origin, marching, watch);
    if (status == CSGM_OK) {
        status = try_goal(&remesh, goal);
        *mesh = remesh.mesh;
        csg_remesh_end(&remesh);
    }
    goal->reshape_s += csg_clock_now_s() - begin_s;
    return status;
}
