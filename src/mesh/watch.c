/* SPDX-License-Identifier: MIT
 * Progress, cancelling and the time limit; see watch.h.
 */
#include "mesh/watch.h"

#include "base/clock.h"
#include "base/mesh_codes.h"

void csg_mesh_watch_begin(csg_mesh_watch *w, csgm_context *context, const csgm_monitor *monitor,
                          double limit_from_s)
{
    w->context = context;
    w->monitor = monitor;
    w->started_s = csg_clock_now_s();
    w->stage = CSGM_STAGE_OCTREE;
    w->stage_share = 1;
    if (context->limits.timeout_s > 0)
        w->deadline_s =
            (limit_from_s > 0 ? limit_from_s : w->started_s) + context->limits.timeout_s;
}

bool csg_mesh_should_stop(void *user)
{
    csg_mesh_watch *w = user;
    if (csg_context_is_cancelled(w->context) ||
        (w->monitor->cancelled && w->monitor->cancelled(w->monitor->user)))
        return true;
    if (w->deadline_s > 0 && csg_clock_now_s() > w->deadline_s) {
        atomic_store(&w->timed_out, true);
        return true;
    }
    return false;
}

bool csg_mesh_stop_without_memory(csg_mesh_watch *w)
{
    atomic_store(&w->out_of_memory, true);
    return false;
}

void csg_mesh_report_progress(void *user, double fraction)
{
    enum { REPORTS_PER_SECOND = 20 };
    csg_mesh_watch *w = user;
    const csgm_monitor *monitor = w->monitor;
    if (!monitor->progress)
        return;
    double now = csg_clock_now_s();
    fraction = w->stage_done + w->stage_share * fraction;
    if (now - w->last_report_s < 1.0 / REPORTS_PER_SECOND || fraction < w->told[w->stage])
        return;
    w->last_report_s = now;
    w->told[w->stage] = fraction;
    if (!w->is_part) {
        monitor->progress(monitor->user, w->stage, fraction);
        return;
    }
    /* parts alternate between the stages: an equal share each of what is told as one */
    int shares = w->taken[CSGM_STAGE_RESHAPE] > 0 ? 3 : 2;
    int before = w->stage == CSGM_STAGE_MESH ? 1 : w->stage == CSGM_STAGE_RESHAPE ? 2 : 0;
    fraction = w->part_before + w->part_amount * (fraction + before) / shares;
    if (fraction < w->told_of_part)
        return;
    w->told_of_part = fraction;
    monitor->progress(monitor->user, CSGM_STAGE_MESH, fraction);
}

void csg_mesh_take(csg_mesh_watch *w, csgm_stage stage, double part)
{
    if (w->stage != stage)
        w->last_report_s = 0; /* a new stage is told at once */
    w->stage = stage;
    w->stage_done = w->taken[stage];
    w->stage_share = part * (1 - w->taken[stage]);
    w->taken[stage] += w->stage_share;
}

csgm_status csg_mesh_why_stopped(csg_mesh_watch *w)
{
    return csg_mesh_why_work_stopped(
        w, "meshing", "raise --timeout, or mesh more coarsely: --quality draft, or a lower -r");
}

csgm_status csg_mesh_why_work_stopped(csg_mesh_watch *w, const char *work, const char *hint)
{
    if (atomic_load(&w->out_of_memory))
        return csg_context_no_memory(w->context);
    if (atomic_load(&w->refused))
        return CSGM_ERR_IO;
    if (!atomic_load(&w->timed_out))
        return CSGM_CANCELLED;
    csg_diag_plain(&w->context->diags, CSG_DIAG_TIMEOUT, NULL, hint,
                   "%s took longer than the limit of %g s", work, w->context->limits.timeout_s);
    return CSGM_ERR_LIMIT;
}

csgm_status csg_mesh_report_open(csg_mesh_watch *w)
{
    csg_diag_plain(&w->context->diags, CSG_DIAG_OPEN_MESH, NULL,
                   "please report this with the scene; -r N makes the mesh in another way",
                   "the mesh that was made is not closed, which is a bug in csgmesh");
    return CSGM_ERR_INTERNAL;
}
