/* SPDX-License-Identifier: MIT
 * Text to models and what is said; see view_job.h. Findings are what --diagnostics=json prints.
 */
#include "view/view_job.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/options.h"
#include "queries/params_json.h"
#include "view/view_model.h"

enum { COARSE_CELLS = 64 /* along the longest side */ };

bool view_job_begin(view_job *j)
{
    static const csgm_normals normals = CSGM_NORMALS_CREASE;
    j->begin_s = cli_now_s();
    j->work.normals = &normals;
    j->app.console = cli_console_make();
    cli_console_configure(&j->app.console, j->app.options);
    j->app.console.json = true;
    j->app.console.quiet = false;
    if (!cli_text_open(&j->said))
        return false;
    j->app.console.out = j->said.out;
    return true;
}

void view_job_release(view_job *j)
{
    for (int i = 0; i < CSGM_MARK_COUNT; i++)
        csgm_mesh_destroy(j->marks[i]);
    cli_work_release(&j->work);
    csgm_context_destroy(j->app.context);
    cli_console_flush(&j->app.console);
    free(cli_text_close(&j->said));
    free(j->parameters);
}

/* ---- what is said ----------------------------------------------------------------------------- */

/* The lines as elements of an array. */
static void put_findings(FILE *out, view_job *j)
{
    cli_console_flush(&j->app.console);
    fflush(j->said.out);
    fputs("\"findings\":[", out);
    for (size_t i = 0; i < j->said.length; i++)
        if (j->said.text[i] != '\n')
            fputc(j->said.text[i], out);
        else if (i + 1 < j->said.length)
            fputc(',', out);
    fputc(']', out);
}

static void put_mesh(cli_json *json, const view_job *j)
{
    csgm_mesh_view view = csgm_mesh_get_view(j->work.mesh);
    cli_json_open(json, "mesh", '{');
    cli_json_count(json, "triangles", view.triangle_count);
    cli_json_number(json, "tolerance", j->work.stats.tolerance);
    cli_json_number(json, "cell", j->work.stats.cell_size);
    cli_json_end(json, '}');
}

/* What the page may ask for as files. */
static void put_formats(FILE *out)
{
    cli_json json = cli_json_make(out, false);
    json.first = true;
    cli_json_open(&json, "formats", '[');
    for (csgm_format f = CSGM_FORMAT_AUTO; f < CSGM_FORMAT_COUNT; f++)
        if (csgm_format_available(f, false))
            cli_json_string(&json, NULL, csgm_format_name(f));
    cli_json_end(&json, ']');
    cli_json_open(&json, "drawings", '[');
    for (csgm_drawing_format f = CSGM_DRAWING_NONE + 1; f < CSGM_DRAWING_COUNT; f++)
        if (csgm_drawing_format_available(f))
            cli_json_string(&json, NULL, csgm_drawing_format_name(f));
    cli_json_end(&json, ']');
    fputc(',', out);
}

char *view_job_state(view_job *j, const char *phase, uint64_t model)
{
    cli_text text;
    if (!cli_text_open(&text))
        return NULL;
    cli_json json = cli_json_make(text.out, false);
    json.first = true;
    fputs("\"scene\":{", text.out);
    cli_json_string(&json, "name", cli_file_name(j->app.options->operands.items[0]));
    cli_json_string(&json, "phase", phase);
    cli_json_count(&json, "model", model);
    cli_json_number(&json, "seconds", cli_now_s() - j->begin_s);
    if (j->work.mesh)
        put_mesh(&json, j);
    fputs("},", text.out);
    if (j->parameters)
        fprintf(text.out, "%s,", j->parameters);
    put_formats(text.out);
    put_findings(text.out, j);
    return cli_text_close(&text);
}

/* ---- reading ---------------------------------------------------------------------------------- */

/* A mesh is shown as it is. */
int view_job_read(view_job *j)
{
    const char *path = j->app.options->operands.items[0];
    csgm_format format = csgm_format_from_path(path);
    int status = cli_app_open(&j->app);
    if (status == CLI_DONE && format != CSGM_FORMAT_AUTO)
        status = cli_exit_status(csgm_mesh_read(j->app.context, path, format, &j->work.mesh));
    else if (status == CLI_DONE)
        status = cli_work_load(&j->app, &j->work, path);
    return status;
}

void view_job_read_parameters(view_job *j)
{
    csgm_params *params = NULL;
    cli_silence silence;
    cli_silence_begin(&silence, &j->app.console);
    if (cli_app_load_params(&j->app, j->app.options->operands.items[0], &params) == CSGM_OK) {
        cli_text text;
        if (cli_text_open(&text)) {
            cli_json json = cli_json_make(text.out, false);
            json.first = true;
            cli_put_params(&json, params);
        }
        j->parameters = cli_text_close(&text);
    }
    csgm_params_destroy(params);
    cli_silence_end(&silence, &j->app.console);
}

/* ---- meshes ----------------------------------------------------------------------------------- */

char *view_job_model(const view_job *j, size_t *length)
{
    static const char *const kinds[CSGM_MARK_COUNT] = {
        [CSGM_MARK_HIGHLIGHT] = "highlight", [CSGM_MARK_BACKGROUND] = "background"};
    view_layer layers[1 + CSGM_MARK_COUNT] = {{"solid", csgm_mesh_get_view(j->work.mesh)}};
    size_t count = 1;
    for (int i = 0; i < CSGM_MARK_COUNT; i++)
        if (j->marks[i])
            layers[count++] = (view_layer){kinds[i], csgm_mesh_get_view(j->marks[i])};
    return view_model_make(layers, count, length);
}

/* Equal cells, without creases: tens of milliseconds for nearly everything. */
bool view_job_mesh_coarsely(view_job *j)
{
    cli_options *o = j->app.options, own = *o;
    cli_silence silence;
    cli_silence_begin(&silence, &j->app.console);
    o->resolution = COARSE_CELLS;
    o->cell_size = o->tolerance = 0;
    o->simplify = (cli_amount){.value = 0};
    o->triangles = 0;
    o->improve = false;
    o->features = CSGM_FEATURES_SMOOTH;
    bool made = cli_work_mesh(&j->app, &j->work) == CLI_DONE;
    *j->app.options = own;
    cli_silence_end(&silence, &j->app.console);
    return made;
}

void view_job_drop_mesh(view_job *j)
{
    csgm_mesh_destroy(j->work.mesh);
    j->work.mesh = NULL;
}

static bool is_finite(csgm_box box)
{
    return isfinite(box.min.x) && isfinite(box.min.y) && isfinite(box.min.z) &&
           isfinite(box.max.x) && isfinite(box.max.y) && isfinite(box.max.z);
}

/* What # and % mark, with the options of the solid; what is infinite ends where that does. */
void view_job_mesh_marks(view_job *j)
{
    for (int i = 0; i < CSGM_MARK_COUNT; i++) {
        const csgm_scene *marked = csgm_scene_get_marked(j->work.scene, (csgm_mark)i);
        cli_options own = *j->app.options;
        cli_silence silence;
        cli_work work = {.normals = j->work.normals};
        if (!marked)
            continue;
        cli_silence_begin(&silence, &j->app.console);
        work.info = csgm_scene_get_info(marked);
        if (!is_finite(work.info.bounds) && !own.given[CLI_OPTION_bounds]) {
            j->app.options->bounds = j->work.info.bounds;
            j->app.options->given[CLI_OPTION_bounds] = true;
        }
        if (csgm_field_compile(j->app.context, marked, &work.field) == CSGM_OK)
            cli_work_mesh(&j->app, &work);
        csgm_field_destroy(work.field);
        j->marks[i] = work.mesh;
        *j->app.options = own;
        cli_silence_end(&silence, &j->app.console);
    }
}
