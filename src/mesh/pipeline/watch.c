/* SPDX-License-Identifier: MIT
 * Progress, cancelling and the time limit of a mesh build.
 */
#include "base/clock.h"
#include "mesh/work.h"

bool csg_mesh_should_stop(void *user)
{
    csg_mesh_work *w = user;
    const csgm_monitor *monitor = &w->options->monitor;
    if (monitor->cancelled && monitor->cancelled(monitor->user))
        return true;
    if (w->deadline_s > 0 && csg_clock_now_s() > w->deadline_s) {
        atomic_store(&w->timed_out, true);
        return true;
    }
    return false;
}

void csg_mesh_report_progress(void *user, double fraction)
{
    enum { REPORTS_PER_SECOND = 20 };
    csg_mesh_work *w = user;
    const csgm_monitor *monitor = &w->options->monitor;
    if (!monitor->progress)
        return;
    double now = csg_clock_now_s();
    if (now - w->last_report_s < 1.0 / REPORTS_PER_SECOND)
        return;
    w->last_report_s = now;
    fraction = w->stage_done + w->stage_share * fraction;
    if (!w->share) {
        monitor->progress(monitor->user, w->stage, fraction);
        return;
    }
    /* parts alternate between the stages: a half each of what is told as one */
    fraction = (fraction + (w->stage == CSGM_STAGE_OCTREE ? 0 : 1)) / 2;
    monitor->progress(monitor->user, CSGM_STAGE_MESH,
                      w->share->before + w->share->amount * fraction);
}

void csg_mesh_poll(void *user, size_t done, size_t count)
{
    csg_mesh_report_progress(user, (double)done / (double)count);
}

csgm_status csg_mesh_why_stopped(csg_mesh_work *w)
{
    if (atomic_load(&w->out_of_memory))
        return csg_context_no_memory(w->context);
    if (atomic_load(&w->refused))
        return CSGM_ERR_IO;
    if (!atomic_load(&w->timed_out))
        return CSGM_CANCELLED;
    csg_diag_plain(&w->context->diags, CSG_DIAG_TIMEOUT, NULL,
                   "raise --timeout, or mesh at a lower resolution",
                   "meshing took longer than the limit of %g s", w->context->limits.timeout_s);
    return CSGM_ERR_LIMIT;
}
