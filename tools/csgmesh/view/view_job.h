/* SPDX-License-Identifier: MIT
 * One showing of a scene, step by step: read, meshed coarsely, meshed as the options say, each time
 * with the model and what is said of it as a page takes them. Who asks, and on which thread, is the
 * caller's.
 */
#ifndef CLI_VIEW_JOB_H
#define CLI_VIEW_JOB_H

#include "core/cli.h"
#include "core/textfile.h"
#include "core/work.h"

typedef struct view_job {
    cli_app
        app; /* its options, start_s and cancelled are the caller's; options change for a while */
    cli_work work;
    cli_text said;
    char *parameters; /* JSON; NULL: not known */
    csgm_mesh *marks[CSGM_MARK_COUNT];
    double begin_s;
} view_job;

/* false: out of memory. Release it either way. */
bool view_job_begin(view_job *job);
void view_job_release(view_job *job);

/* Each returns an exit status; failures are among the findings. */
int view_job_read(view_job *job);
/* Without a finding: what is wrong is said when the scene is read. */
void view_job_read_parameters(view_job *job);

/* Into job->work.mesh, without findings; drop it before the next one. */
bool view_job_mesh_coarsely(view_job *job);
void view_job_drop_mesh(view_job *job);
/* What # and % mark, with the options of the solid; what is infinite ends where that does. */
void view_job_mesh_marks(view_job *job);

/* Of the mesh and the marks that there are, as view_model.h has it. From malloc; NULL: out of
 * memory. */
char *view_job_model(const view_job *job, size_t *length);
/* The members "scene", "parameters", "formats", "drawings" and "findings" of a JSON object. phase:
 * "reading", "coarse", "done", "failed". From malloc; NULL: out of memory. */
char *view_job_state(view_job *job, const char *phase, uint64_t model);

#endif
