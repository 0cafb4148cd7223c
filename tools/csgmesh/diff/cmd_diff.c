/* SPDX-License-Identifier: MIT
 * csgmesh diff A B: two files or two folders, the verdict as exit status, reports, and --update.
 */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "core/commands.h"
#include "core/format_lists.h"
#include "core/options.h"
#include "core/sources.h"
#include "diff/diff_folders.h"
#include "diff/diff_report.h"

/* ---- options --------------------------------------------------------------------------- */

static bool is_missing(const char *path)
{
    struct stat status;
    return stat(path, &status) != 0 && errno == ENOENT;
}

static int read_ignored(cli_app *app, uint32_t *ignored)
{
    static const struct {
        const char *name;
        uint32_t bit;
    } words[] = {{"order", CSGM_DIFF_IGNORE_ORDER},   {"normals", CSGM_DIFF_IGNORE_NORMALS},
                 {"colors", CSGM_DIFF_IGNORE_COLORS}, {"names", CSGM_DIFF_IGNORE_NAMES},
                 {"up", CSGM_DIFF_IGNORE_UP},         {"topology", CSGM_DIFF_IGNORE_TOPOLOGY}};
    enum { WORDS = sizeof words / sizeof *words };
    const cli_list *list = &app->options->diff_ignore;
    *ignored = app->options->diff_ignore_topology ? CSGM_DIFF_IGNORE_TOPOLOGY : 0;
    for (size_t i = 0; i < list->count; i++)
        for (const char *word = list->items[i]; word;) {
            size_t length = strcspn(word, ","), w = 0;
            while (w < WORDS &&
                   (strlen(words[w].name) != length || strncmp(words[w].name, word, length) != 0))
                w++;
            if (w == WORDS)
                return cli_usage_error(app, "as --ignore normals,colors",
                                       "--ignore knows order, normals, colors, names, up and "
                                       "topology, not '%.*s'",
                                       (int)(length < 40 ? length : 40), word);
            *ignored |= words[w].bit;
            word = word[length] ? word + length + 1 : NULL;
        }
    return CLI_DONE;
}

/* With --tol-volume alone distances do not decide. */
static csgm_diff_options diff_options(cli_app *app, uint32_t ignored)
{
    const cli_options *options = app->options;
    csgm_diff_options diff = csgm_diff_options_default();
    bool has_tolerance =
        options->given[CLI_OPTION_diff_tol] || options->given[CLI_OPTION_diff_tol_rel];
    bool has_volume = options->given[CLI_OPTION_diff_tol_volume];
    diff.tolerance = has_volume && !has_tolerance ? INFINITY : options->diff_tol;
    diff.tolerance_relative = options->diff_tol_rel;
    if (has_volume)
        diff.tolerance_volume = options->diff_tol_volume;
    diff.material = (csgm_diff_material)options->diff_one_sided; /* in the enum's order */
    diff.ignored = ignored;
    if (options->given[CLI_OPTION_diff_samples])
        diff.samples = options->diff_samples;
    diff.verdict_only = options->quiet && !options->diff_json && !options->diff_heatmap &&
                        !options->diff_png && !options->diff_html;
    diff.monitor = (csgm_monitor){.progress = cli_console_progress, .user = &app->console};
    return diff;
}

/* What a heat map's file must have: each vertex its own place and colour. */
enum { HEATMAP_TRAITS = CSGM_IS_WRITTEN | CSGM_KEEPS_VERTICES | CSGM_KEEPS_COLORS };

/* The heat map's format, AUTO when it has none. */
static csgm_format heatmap_format(const char *path)
{
    csgm_format format = csgm_format_from_path(path);
    bool holds_it = (csgm_format_traits(format) & HEATMAP_TRAITS) == HEATMAP_TRAITS;
    return holds_it ? format : CSGM_FORMAT_AUTO;
}

static int refuse_heatmap(cli_app *app, const char *path)
{
    char hint[160], known[128];
    cli_formats_list(known, sizeof known, " .", HEATMAP_TRAITS);
    snprintf(hint, sizeof hint, "formats that can:%s", known);
    return cli_usage_error(app, hint, "%s cannot hold a heat map", path);
}

/* Options that say how a scene is meshed need one. */
static int check_scene_options(cli_app *app)
{
    static const struct {
        cli_option_id id;
        const char *name;
    } rows[] = {{CLI_OPTION_normals, "--normals"},
                {CLI_OPTION_colors, "--colors"},
                {CLI_OPTION_up, "--up"},
                {CLI_OPTION_unit, "--unit"},
                {CLI_OPTION_compress, "--compress"},
                {CLI_OPTION_draco, "--draco"},
                {CLI_OPTION_draco_bits, "--draco-bits"},
                {CLI_OPTION_draco_level, "--draco-level"},
                {CLI_OPTION_features, "--features"},
                {CLI_OPTION_tolerance, "-e"},
                {CLI_OPTION_quality, "--quality"},
                {CLI_OPTION_triangles, "--triangles"},
                {CLI_OPTION_simplify, "--simplify"},
                {CLI_OPTION_improve, "--improve"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (app->options->given[rows[i].id])
            return cli_usage_error(app, NULL, "%s wants a scene: both are meshes", rows[i].name);
    return CLI_DONE;
}

static int check_usage(cli_app *app)
{
    const cli_options *o = app->options;
    const char *const *paths = o->operands.items;
    if (o->operands.count != 2)
        return cli_usage_error(app, "as csgmesh diff old.stl new.stl",
                               "diff wants two meshes, scenes or folders, not %zu",
                               o->operands.count);
    for (int i = 0; i < 2; i++)
        if (strcmp(paths[i], "-") == 0)
            return cli_usage_error(app, NULL, "diff reads files, not standard input");
    if (o->diff_heatmap && heatmap_format(o->diff_heatmap) == CSGM_FORMAT_AUTO)
        return refuse_heatmap(app, o->diff_heatmap);
    if (o->diff_heatmap && diff_is_folder(paths[0]))
        return cli_usage_error(app, NULL, "--heatmap wants two files, not folders");
    if (diff_report_check(app) != CLI_DONE)
        return CLI_TROUBLE;
    if (o->diff_field && !diff_is_folder(paths[0]) && !diff_path_is_scene(paths[0]) &&
        !diff_path_is_scene(paths[1]))
        return cli_usage_error(app, NULL, "--field wants a scene: both are meshes");
    if (!diff_is_folder(paths[0]) && !diff_path_is_scene(paths[0]) &&
        !diff_path_is_scene(paths[1]) && check_scene_options(app) != CLI_DONE)
        return CLI_TROUBLE;
    return cli_work_check(app);
}

/* ---- a pair ---------------------------------------------------------------------------- */

/* What a format cannot hold is no difference. */
static uint32_t ignored_by_format(csgm_format format)
{
    uint32_t traits = csgm_format_traits(format);
    if (format == CSGM_FORMAT_AUTO) /* a scene */
        return 0;
    return (traits & CSGM_KEEPS_NORMALS ? 0 : CSGM_DIFF_IGNORE_NORMALS) |
           (traits & CSGM_KEEPS_COLORS ? 0 : CSGM_DIFF_IGNORE_COLORS) |
           (traits & CSGM_KEEPS_NAMES ? 0 : CSGM_DIFF_IGNORE_NAMES);
}

/* One size is a multiple of the other: the units may differ. */
static void hint_at_units(cli_app *app, const csgm_diff_report *r)
{
    const csgm_box *a = &r->figures[0].check.bounds, *b = &r->figures[1].check.bounds;
    double x = (b->max.x - b->min.x) / (a->max.x - a->min.x),
           y = (b->max.y - b->min.y) / (a->max.y - a->min.y),
           z = (b->max.z - b->min.z) / (a->max.z - a->min.z);
    if (!(r->reasons & CSGM_DIFF_REASON_DISTANCE) || !(x > 5 || x < 0.2) ||
        !(fabs(y / x - 1) < 1e-3) || !(fabs(z / x - 1) < 1e-3))
        return;
    cli_console_say(&app->console, CSGM_NOTE, NULL, "B is %.6g times as large as A: another unit?",
                    x);
}

static void warn(cli_app *app, const csgm_diff_report *r)
{
    bool is_open = (r->figures[0].triangles && !r->figures[0].is_closed) ||
                   (r->figures[1].triangles && !r->figures[1].is_closed);
    if (app->options->diff_one_sided && is_open)
        cli_console_say(&app->console, CSGM_WARNING, NULL,
                        "--one-sided wants closed meshes: added and removed count alike");
    for (int i = 0; i < 2; i++)
        if (r->distance[i].is_measured && !r->distance[i].is_refined && !app->options->quiet)
            cli_console_say(&app->console, CSGM_NOTE, NULL,
                            "%s: the maximum is only known to be between %.6g and %.6g",
                            i ? "B to A" : "A to B", r->distance[i].lower, r->distance[i].upper);
    hint_at_units(app, r);
}

/* A scene that differs from a file is meshed as the file may have been made, too: with the other
 * kind of normals, where these alone differ, or with colours that the file cannot show. */
static bool mesh_otherwise(cli_app *app, diff_side *side, uint32_t reasons, int *status)
{
    return reasons == CSGM_DIFF_REASON_NORMALS
               ? diff_side_mesh_otherwise(app, side, status)
               : reasons && diff_side_mesh_with_looks(app, side, status);
}

static int compare_meshes(cli_app *app, const csgm_diff_options *options, diff_side sides[2],
                          csgm_diff **diff)
{
    int status = cli_exit_status(
        csgm_diff_meshes(app->context, &sides[0].view, &sides[1].view, options, diff));
    for (int i = 0; i < 2 && status == CLI_DONE; i++) {
        if (!mesh_otherwise(app, &sides[i], csgm_diff_get_report(*diff)->reasons, &status))
            continue;
        csgm_diff_destroy(*diff);
        *diff = NULL;
        if (status == CLI_DONE)
            status = cli_exit_status(
                csgm_diff_meshes(app->context, &sides[0].view, &sides[1].view, options, diff));
    }
    return status;
}

static int compare_sides(cli_app *app, const csgm_diff_options *wanted, diff_side sides[2],
                         diff_result *result)
{
    csgm_diff_options options = *wanted;
    csgm_diff *diff;
    options.ignored |= ignored_by_format(sides[0].format) | ignored_by_format(sides[1].format);
    if (app->options->diff_field) {
        options.scene_a = sides[0].work.scene;
        options.scene_b = sides[1].work.scene;
    }
    if (compare_meshes(app, &options, sides, &diff) != CLI_DONE)
        return CLI_TROUBLE;
    result->report = *csgm_diff_get_report(diff);
    result->outcome = result->report.is_different ? DIFF_DIFFERENT : DIFF_SAME;
    warn(app, &result->report);
    const char *heatmap = app->options->diff_heatmap;
    int exit_status = CLI_DONE;
    if (heatmap && !csgm_diff_vertex_distances(diff, 1)) {
        cli_console_say(&app->console, CSGM_ERROR, NULL, "no heat map: a mesh is empty");
        exit_status = CLI_TROUBLE;
    } else if (heatmap) {
        csgm_status status =
            csgm_diff_write_heatmap(app->context, diff, 1, heatmap, heatmap_format(heatmap), NULL);
        exit_status = status == CSGM_OK ? CLI_DONE : CLI_TROUBLE;
    }
    if (exit_status == CLI_DONE)
        exit_status = diff_report_add(app, diff, sides, result);
    result->lacks_picture = exit_status != CLI_DONE;
    csgm_diff_destroy(diff);
    return exit_status;
}

static double diagonal(csgm_box box)
{
    double x = box.max.x - box.min.x, y = box.max.y - box.min.y, z = box.max.z - box.min.z;
    return sqrt(x * x + y * y + z * z);
}

/* Two scenes whose cells follow the shape are meshed within one tolerance, the smaller of theirs:
 * where only one has a finer detail, or is larger, the rest of them gets the same triangles. It is
 * a quarter of what may differ at most, since both meshes stray; but not less than --quality fine,
 * below which cells cost minutes. */
static void share_tolerance(cli_app *app, const csgm_diff_options *options, diff_side sides[2])
{
    double within = INFINITY, finest = INFINITY;
    for (int i = 0; i < 2; i++) {
        const cli_work *work = &sides[i].work;
        csgm_quality quality = (csgm_quality)app->options->quality;
        double own = work->scene ? cli_work_tolerance(app, work, quality) : 0;
        if (!(own > 0))
            return;
        within = fmin(within, own);
        finest = fmin(finest, cli_work_tolerance(app, work, CSGM_QUALITY_FINE));
    }
    double most =
        fmax(options->tolerance, options->tolerance_relative * diagonal(sides[0].work.info.bounds));
    if (most > 0 && isfinite(most))
        within = fmin(within, fmax(ldexp(1, (int)floor(log2(most / 4))), finest));
    sides[0].work.within = sides[1].work.within = within;
}

/* Loads and compares; CLI_TROUBLE: it could not be done. */
static int compare(cli_app *app, const csgm_diff_options *options, diff_side sides[2],
                   diff_result *result)
{
    if (!app->options->diff_heatmap && !diff_report_draws(app, result) &&
        diff_same_bytes(result->a, result->b)) {
        result->report = (csgm_diff_report){.level = CSGM_DIFF_SAME_BYTES};
        result->outcome = DIFF_SAME;
        return CLI_DONE;
    }
    for (int i = 0; i < 2; i++)
        if (diff_side_open(app, &sides[i], i ? result->b : result->a, i ? result->a : result->b) !=
            CLI_DONE)
            return CLI_TROUBLE;
    share_tolerance(app, options, sides);
    for (int i = 0; i < 2; i++)
        if (diff_side_mesh(app, &sides[i]) != CLI_DONE)
            return CLI_TROUBLE;
    return compare_sides(app, options, sides, result);
}

static void work_on(cli_app *app, const csgm_diff_options *options, diff_result *result)
{
    diff_side sides[2] = {{.path = NULL}, {.path = NULL}};
    int status = CLI_DONE;
    if (result->a && result->b && app->options->diff_update && is_missing(result->a))
        result->outcome = DIFF_ONLY_B;
    else if (result->a && result->b)
        status = compare(app, options, sides, result);
    bool accepts = app->options->diff_update && status == CLI_DONE && result->a && result->b &&
                   (result->outcome == DIFF_DIFFERENT || result->outcome == DIFF_ONLY_B);
    if (accepts) {
        status = diff_update(app, result->a, &sides[1], result->b);
        result->is_updated = status == CLI_DONE;
    }
    for (int i = 0; i < 2; i++)
        diff_side_release(&sides[i]);
    if (status != CLI_DONE && !accepts)
        result->outcome = DIFF_FAILED;
    result->exit_status = status != CLI_DONE                                   ? CLI_TROUBLE
                          : result->outcome == DIFF_SAME || result->is_updated ? CLI_DONE
                                                                               : CLI_INPUT_AT_FAULT;
}

/* ---- the run --------------------------------------------------------------------------- */

/* A file that only B's folder has gets its name in A's, so that --update can put it there. */
static bool name_in_a(cli_app *app, const char *a, const char *b, diff_result *result)
{
    if (!app->options->diff_update || result->a)
        return true;
    if (asprintf(&result->a, "%s%s", a, result->b + strlen(b)) >= 0)
        return true;
    result->a = NULL;
    cli_usage_error(app, NULL, "out of memory");
    return false;
}

static int compare_pairs(cli_app *app, const csgm_diff_options *options, diff_results *results)
{
    const char *a = app->options->operands.items[0], *b = app->options->operands.items[1];
    const cli_options *o = app->options;
    bool is_shown = !o->quiet && !(o->diff_json && strcmp(o->diff_json, "-") == 0) &&
                    !(o->diff_junit && strcmp(o->diff_junit, "-") == 0) &&
                    !(o->diff_html && strcmp(o->diff_html, "-") == 0);
    size_t same = 0;
    int worst = CLI_DONE;
    for (size_t i = 0; i < results->count; i++) {
        diff_result *result = &results->items[i];
        if (results->of_folders && !name_in_a(app, a, b, result))
            return CLI_TROUBLE;
        diff_report_begin(results, i);
        cli_console_set_work(&app->console, i, results->count);
        work_on(app, options, result);
        worst = result->exit_status > worst ? result->exit_status : worst;
        same += result->outcome == DIFF_SAME;
        cli_console_end_progress(&app->console);
        if (is_shown && !(results->of_folders && result->outcome == DIFF_SAME))
            diff_print(&app->console, result, true);
    }
    if (is_shown && results->of_folders)
        printf("%zu of %zu same\n", same, results->count);
    return worst;
}

static int find_pairs(cli_app *app, diff_results *results)
{
    const char *a = app->options->operands.items[0], *b = app->options->operands.items[1];
    bool folder_b = diff_is_folder(b);
    /* one that is not there yet has no files: --update makes it */
    bool folder_a = diff_is_folder(a) || (app->options->diff_update && folder_b && is_missing(a));
    if (folder_a && folder_b) {
        results->of_folders = true;
        return diff_pair_folders(app, a, b, results);
    }
    if (folder_a || folder_b)
        return cli_usage_error(app, NULL, "%s is a folder, %s is %s", folder_a ? a : b,
                               folder_a ? b : a, is_missing(folder_a ? b : a) ? "missing" : "not");
    return diff_results_add(app, results, a, b) ? CLI_DONE : CLI_TROUBLE;
}

/* All reports appear, or none. The exit status of the comparison, unless one cannot be written. */
static int write_reports(cli_app *app, const diff_results *results, int status)
{
    const cli_options *o = app->options;
    bool good = !app->overwriter;
    for (size_t i = 0; i < results->count && good; i++)
        good = !results->items[i].lacks_picture;
    csgm_files_hold(app->context);
    if (good && o->diff_json)
        good = diff_write_json(app, results) == CLI_DONE;
    if (good && o->diff_junit)
        good = diff_write_junit(app, results) == CLI_DONE;
    if (good && o->diff_html)
        good = diff_write_html(app, results) == CLI_DONE;
    if (csgm_files_release(app->context, good) != CSGM_OK || !good)
        return CLI_TROUBLE;
    return status;
}

int cli_cmd_diff(cli_app *app)
{
    diff_results results = {0};
    uint32_t ignored = 0;
    int status = check_usage(app);
    if (status == CLI_DONE)
        status = read_ignored(app, &ignored);
    if (status == CLI_DONE)
        status = cli_app_open(app);
    if (status == CLI_DONE)
        status = find_pairs(app, &results);
    for (size_t i = 0; status == CLI_DONE && i < 2 * results.count; i++)
        status =
            cli_sources_guard_file(app, i % 2 ? results.items[i / 2].b : results.items[i / 2].a);
    if (status == CLI_DONE) {
        csgm_diff_options options = diff_options(app, ignored);
        if (!app->options->diff_update) /* what is accepted is there at once */
            csgm_files_hold(app->context);
        status = write_reports(app, &results, compare_pairs(app, &options, &results));
    }
    diff_results_release(&results);
    return cli_finish_stdout(app, status);
}
