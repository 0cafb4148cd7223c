/* SPDX-License-Identifier: MIT
 * argv -> openscad_line, by the table openscad_options.def; see there. Long options are --name
 * value or --name=value, also those of one letter (--o FILE), short ones -x value or -xvalue.
 */
#include "openscad/openscad_line.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef enum option_id {
#define OPENSCAD_OPTION(NAME, letter, name, argument, help) OPTION_##NAME,
#define OPENSCAD_REFUSED OPENSCAD_OPTION
#include "openscad/openscad_options.def"
#undef OPENSCAD_OPTION
#undef OPENSCAD_REFUSED
} option_id;

typedef struct openscad_row {
    option_id id;
    char letter;
    const char *name, *argument, *why; /* why: it is refused */
} openscad_row;

static const openscad_row rows[] = {
#define OPENSCAD_OPTION(NAME, letter, name, argument, help)                                        \
    {OPTION_##NAME, letter, name, argument, NULL},
#define OPENSCAD_REFUSED(NAME, letter, name, argument, why)                                        \
    {OPTION_##NAME, letter, name, argument, why},
#include "openscad/openscad_options.def"
#undef OPENSCAD_OPTION
#undef OPENSCAD_REFUSED
};

enum { ROWS = sizeof rows / sizeof *rows, MOST_FRAMES = 100000 };

typedef struct openscad_reader {
    cli_app *app;
    openscad_line *line;
    const char *export_format;
} openscad_reader;

static int refuse(openscad_reader *r, const openscad_row *row, const char *value,
                  const char *wanted)
{
    return cli_usage_error(r->app, "csgmesh help openscad lists the options",
                           "openscad: %s%s wants %s, not '%.80s'", row->name[1] ? "--" : "-",
                           row->name, wanted, value);
}

/* ---- values ------------------------------------------------------------------------------ */

/* `count` finite numbers with commas between; how many there were, 0 where it is something else. */
static size_t read_numbers(const char *text, double *out, size_t most)
{
    for (size_t i = 0; i < most; i++) {
        char *after;
        out[i] = strtod(text, &after);
        if (after == text || !isfinite(out[i]) || (*after && *after != ','))
            return 0;
        if (!*after)
            return i + 1;
        text = after + 1;
    }
    return 0;
}

static bool read_whole(const char *text, uint64_t most, char end, uint64_t *out, const char **after)
{
    uint64_t value = 0;
    const char *c = text;
    for (; *c >= '0' && *c <= '9' && value <= most; c++)
        value = 10 * value + (uint64_t)(*c - '0');
    if (c == text || *c != end || value < 1 || value > most)
        return false;
    *out = value;
    *after = *c ? c + 1 : c;
    return true;
}

static int read_camera(openscad_reader *r, const openscad_row *row, const char *value)
{
    openscad_line *line = r->line;
    line->camera_numbers = read_numbers(value, line->camera, 7);
    if (line->camera_numbers < 6)
        return refuse(r, row, value, "six or seven numbers with commas between");
    return CLI_DONE;
}

static int read_size(openscad_reader *r, const openscad_row *row, const char *value)
{
    uint64_t width = 0, height = 0;
    const char *next;
    if (!read_whole(value, 16384, ',', &width, &next) ||
        !read_whole(next, 16384, '\0', &height, &next))
        return refuse(r, row, value, "WIDTH,HEIGHT of 1 to 16384");
    r->line->width = (uint32_t)width;
    r->line->height = (uint32_t)height;
    return CLI_DONE;
}

static int read_frames(openscad_reader *r, const openscad_row *row, const char *value)
{
    const char *next;
    if (!read_whole(value, MOST_FRAMES, '\0', &r->line->frames, &next))
        return refuse(r, row, value, "a number of pictures from 1 to 100000");
    return CLI_DONE;
}

/* K/N; kept in first_frame and end_frame until the number of frames is known. */
static int read_shard(openscad_reader *r, const openscad_row *row, const char *value)
{
    const char *next;
    if (!read_whole(value, MOST_FRAMES, '/', &r->line->first_frame, &next) ||
        !read_whole(next, MOST_FRAMES, '\0', &r->line->end_frame, &next) ||
        r->line->first_frame > r->line->end_frame)
        return refuse(r, row, value, "K/N, as 1/4");
    return CLI_DONE;
}

static int read_scheme(openscad_reader *r, const openscad_row *row, const char *value)
{
    static const char *const schemes[][2] = {
        {"Cornfield", "#ffffe5"}, {"Metallic", "#aaaaff"},      {"Sunset", "#aa4444"},
        {"Starnight", "#000000"}, {"BeforeDawn", "#333333"},    {"Nature", "#fafafa"},
        {"DeepOcean", "#333333"}, {"Solarized", "#fdf6e3"},     {"Tomorrow", "#f8f8f8"},
        {"Monotone", "#ffffe5"},  {"Tomorrow Night", "#1d1f21"}};
    for (size_t i = 0; i < sizeof schemes / sizeof *schemes; i++)
        if (strcmp(value, schemes[i][0]) == 0) {
            r->line->background = schemes[i][1];
            return CLI_DONE;
        }
    return refuse(r, row, value,
                  "Cornfield, Metallic, Sunset, Starnight, BeforeDawn, Nature, DeepOcean, "
                  "Solarized, Tomorrow, Tomorrow Night or Monotone");
}

static bool is_among(const char *text, const char *const *names)
{
    for (; *names; names++)
        if (strcmp(text, *names) == 0)
            return true;
    return false;
}

static int read_feature(openscad_reader *r, const openscad_row *row, const char *value)
{
    static const char *const known[] = {"all",
                                        "lazy-union",
                                        "roof",
                                        "textmetrics",
                                        "import-function",
                                        "object-function",
                                        "predictible-output",
                                        "sort-stl",
                                        "manifold",
                                        "fast-csg",
                                        "fast-csg-trust-corefinement",
                                        "fast-csg-remesh",
                                        "fast-csg-remesh-predictibly",
                                        "fast-csg-exact",
                                        "fast-csg-exact-callbacks",
                                        "vertex-object-renderers",
                                        "vertex-object-renderers-direct",
                                        "vertex-object-renderers-prealloc",
                                        "vertex-object-renderers-indexing",
                                        "input-driver-dbus",
                                        NULL};
    if (is_among(value, known))
        return CLI_DONE;
    if (strcmp(value, "python-engine") == 0)
        return cli_usage_error(r->app, NULL, "openscad: --%s %s: csgmesh has no such feature",
                               row->name, value);
    return refuse(r, row, value, "the name of a feature, as textmetrics, or all");
}

static int read_summary(openscad_reader *r, const openscad_row *row, const char *value)
{
    static const struct {
        const char *name;
        unsigned bits;
    } parts[] = {{"all", OPENSCAD_SUMMARY_ALL},
                 {"time", OPENSCAD_SUMMARY_TIME},
                 {"geometry", OPENSCAD_SUMMARY_GEOMETRY},
                 {"bounding-box", OPENSCAD_SUMMARY_BOX},
                 {"area", OPENSCAD_SUMMARY_AREA}};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        if (strcmp(value, parts[i].name) == 0) {
            r->line->summary |= parts[i].bits;
            return CLI_DONE;
        }
    return refuse(r, row, value, "all, time, geometry, bounding-box or area");
}

static int read_projection(openscad_reader *r, const openscad_row *row, const char *value)
{
    static const char *const orthographic[] = {"o", "ortho", "orthogonal", NULL};
    static const char *const perspective[] = {"p", "perspective", NULL};
    r->line->orthographic = is_among(value, orthographic);
    return r->line->orthographic || is_among(value, perspective)
               ? CLI_DONE
               : refuse(r, row, value, "o (ortho) or p (perspective)");
}

static int add_output(openscad_reader *r, const char *path, const char *format)
{
    r->line->outputs[r->line->output_count++] = (openscad_output){.path = path, .format = format};
    return CLI_DONE;
}

static int read_switch(openscad_reader *r, const openscad_row *row, const char *value)
{
    static const char *const on[] = {"true", "on", "1", NULL};
    return is_among(value, on) ? CLI_DONE
                               : cli_usage_error(r->app, NULL,
                                                 "openscad: --%s %.20s: what calls say is "
                                                 "always checked",
                                                 row->name, value);
}

static int read_backend(openscad_reader *r, const openscad_row *row, const char *value)
{
    static const char *const known[] = {"CGAL", "cgal", "Manifold", "manifold", NULL};
    return is_among(value, known) ? CLI_DONE : refuse(r, row, value, "CGAL or Manifold");
}

/* What stands behind --render= or --preview=. */
static int read_look(openscad_reader *r, const openscad_row *row, const char *value)
{
    static const char *const known[] = {"", "true", "force", "cgal", "full", NULL};
    r->line->is_rendered = row->id == OPTION_RENDER;
    if (!value || is_among(value, known))
        return CLI_DONE;
    return cli_usage_error(r->app, NULL, "openscad: --%s=%.40s: csgmesh has no such picture",
                           row->name, value);
}

static int add_define(openscad_reader *r, const char *value)
{
    r->line->defines.items[r->line->defines.count++] = value;
    return CLI_DONE;
}

static int set_text(const char **slot, const char *value)
{
    *slot = value;
    return CLI_DONE;
}

static int set_flag(bool *slot)
{
    *slot = true;
    return CLI_DONE;
}

/* value: NULL where it takes none, or none was given behind a =. */
static int take(openscad_reader *r, const openscad_row *row, const char *value)
{
    openscad_line *line = r->line;
    if (row->why)
        return cli_usage_error(r->app, NULL, "openscad: %s%s: %s", row->name[1] ? "--" : "-",
                               row->name, row->why);
    switch (row->id) {
    case OPTION_OUTPUT:
        return add_output(r, value, NULL);
    case OPTION_STL:
        return add_output(r, value, "stl");
    case OPTION_DXF:
        return add_output(r, value, "dxf");
    case OPTION_EXPORT_FORMAT:
        return set_text(&r->export_format, value);
    case OPTION_DEFINE:
        return add_define(r, value);
    case OPTION_PARAMETER_FILE:
        return set_text(&line->parameter_file, value);
    case OPTION_PARAMETER_SET:
        return set_text(&line->parameter_set, value);
    case OPTION_DEPENDENCIES:
        return set_text(&line->depfile, value);
    case OPTION_SUMMARY_FILE:
        return set_text(&line->summary_file, value);
    case OPTION_FACETS:
        return set_text(&line->facets, value);
    case OPTION_ENABLE:
        return read_feature(r, row, value);
    case OPTION_CAMERA:
        return read_camera(r, row, value);
    case OPTION_IMGSIZE:
        return read_size(r, row, value);
    case OPTION_ANIMATE:
        return read_frames(r, row, value);
    case OPTION_ANIMATE_SHARDING:
        return read_shard(r, row, value);
    case OPTION_PROJECTION:
        return read_projection(r, row, value);
    case OPTION_COLORSCHEME:
        return read_scheme(r, row, value);
    case OPTION_BACKEND:
        return read_backend(r, row, value);
    case OPTION_SUMMARY:
        return read_summary(r, row, value);
    case OPTION_CHECK_PARAMETERS:
    case OPTION_CHECK_RANGES:
        return read_switch(r, row, value);
    case OPTION_RENDER:
    case OPTION_PREVIEW:
        return read_look(r, row, value);
    case OPTION_AUTOCENTER:
        return set_flag(&line->auto_center);
    case OPTION_VIEWALL:
        return set_flag(&line->view_all);
    case OPTION_QUIET:
        return set_flag(&line->quiet);
    case OPTION_HARDWARNINGS:
        return set_flag(&line->hard_warnings);
    case OPTION_HELP:
        return set_flag(&line->help);
    case OPTION_VERSION:
        return set_flag(&line->version);
    default:
        return set_flag(&line->info);
    }
}

/* ---- names ------------------------------------------------------------------------------- */

static const openscad_row *find_long(const char *name, size_t length)
{
    for (size_t i = 0; i < ROWS; i++)
        if (strlen(rows[i].name) == length && strncmp(rows[i].name, name, length) == 0)
            return &rows[i];
    return NULL;
}

static int refuse_unknown(openscad_reader *r, const char *text)
{
    const char *names[ROWS + 1];
    char name[64], hint[128];
    for (size_t i = 0; i < ROWS; i++)
        names[i] = rows[i].name;
    names[ROWS] = NULL;
    snprintf(name, sizeof name, "%.*s", (int)strcspn(text + 2, "="),
             text[1] == '-' ? text + 2 : "");
    const char *near = name[0] && name[1] ? cli_nearest(name, names) : NULL;
    snprintf(hint, sizeof hint, near ? "did you mean '--%s'?" : "%s",
             near ? near : "csgmesh help openscad lists the options");
    return cli_usage_error(r->app, hint, "openscad: unknown option '%.60s'", text);
}

/* The option at argv[*next], which moves on. */
static int read_option(openscad_reader *r, const cli_list *arguments, size_t *next)
{
    const char *text = arguments->items[(*next)++], *value = NULL;
    const openscad_row *row = NULL;
    if (text[1] == '-') {
        size_t length = strcspn(text + 2, "=");
        row = find_long(text + 2, length);
        value = text[2 + length] ? text + 3 + length : NULL;
    } else {
        for (size_t i = 0; i < ROWS && !row; i++)
            row = rows[i].letter == text[1] ? &rows[i] : NULL;
        value = text[2] ? text + 2 : NULL;
    }
    if (!row)
        return refuse_unknown(r, text);
    const char *label = row->name[1] ? "--" : "-";
    if (!row->argument && value)
        return cli_usage_error(r->app, NULL, "openscad: %s%s takes no value", label, row->name);
    if (row->argument && row->argument[0] != '[' && !value && *next < arguments->count)
        value = arguments->items[(*next)++];
    if (row->argument && row->argument[0] != '[' && !value)
        return cli_usage_error(r->app, NULL, "openscad: %s%s needs %s", label, row->name,
                               row->argument);
    return take(r, row, value);
}

/* ---- outputs ----------------------------------------------------------------------------- */

/* How an output is made follows from its format. */
static int settle_output(openscad_reader *r, openscad_output *output)
{
    static const char *const unknown[] = {"ast",   "term", "nef3", "nefdbg",
                                          "param", "wrl",  "pov",  NULL};
    static const char *const drawings[] = {"svg", "dxf", "pdf", NULL};
    const char *name = r->export_format ? r->export_format : output->format;
    const char *slash = strrchr(output->path, '/'), *dot = strrchr(output->path, '.');
    if (!name && dot && (!slash || dot > slash))
        name = dot + 1;
    if (!name)
        return cli_usage_error(r->app, "give --export-format, as --export-format stl",
                               "openscad: '%.200s' names no format", output->path);
    output->ascii = strcmp(name, "asciistl") == 0;
    if (output->ascii || strcmp(name, "binstl") == 0)
        output->format = "stl";
    else if (r->export_format)
        output->format = name;
    output->way = strcmp(name, "png") == 0    ? OPENSCAD_PICTURE
                  : strcmp(name, "csg") == 0  ? OPENSCAD_TREE
                  : strcmp(name, "echo") == 0 ? OPENSCAD_ECHO
                                              : OPENSCAD_MESH;
    output->is_drawing = is_among(name, drawings);
    if (is_among(name, unknown))
        return cli_usage_error(r->app, NULL, "openscad: csgmesh writes no .%s (%.200s)", name,
                               output->path);
    return CLI_DONE;
}

static int settle_frames(openscad_reader *r)
{
    openscad_line *line = r->line;
    uint64_t part = line->first_frame, parts = line->end_frame;
    if (parts && !line->frames)
        return cli_usage_error(r->app, NULL, "openscad: --animate_sharding needs --animate");
    line->first_frame = parts ? (part - 1) * line->frames / parts : 0;
    line->end_frame = parts ? part * line->frames / parts : line->frames;
    return CLI_DONE;
}

static bool has_mesh_file(const openscad_line *line)
{
    for (size_t i = 0; i < line->output_count; i++)
        if (openscad_is_mesh_file(&line->outputs[i]))
            return true;
    return false;
}

static int settle(openscad_reader *r)
{
    openscad_line *line = r->line;
    int status = settle_frames(r);
    if (status == CLI_DONE && !line->scene)
        status = cli_usage_error(r->app, "as csgmesh openscad part.scad -o part.stl",
                                 "openscad: no scene given");
    if (status == CLI_DONE && !line->output_count)
        status = cli_usage_error(r->app, "as -o part.stl",
                                 "openscad: there is no window here: give an output");
    for (size_t i = 0; i < line->output_count && status == CLI_DONE; i++)
        status = settle_output(r, &line->outputs[i]);
    if (status == CLI_DONE && line->output_count + line->frames > 1 &&
        strcmp(line->scene, "-") == 0)
        status =
            cli_usage_error(r->app, NULL, "openscad: standard input is read once: give one output");
    if (status == CLI_DONE && (line->summary || line->summary_file) && !has_mesh_file(line))
        status = cli_usage_error(r->app, "add -o part.stl",
                                 "openscad: --summary needs a file with a mesh");
    return status;
}

int openscad_line_read(cli_app *app, openscad_line *line)
{
    const cli_list *arguments = &app->arguments;
    openscad_reader r = {app, line, NULL};
    *line = (openscad_line){.width = 512, .height = 512, .background = "#ffffe5"};
    line->facets = "exact";
    line->outputs = calloc(arguments->count + 1, sizeof *line->outputs);
    line->defines.items = calloc(arguments->count + 1, sizeof *line->defines.items);
    if (!line->outputs || !line->defines.items)
        return cli_usage_error(app, NULL, "out of memory");
    int status = CLI_DONE;
    for (size_t next = 0; next < arguments->count && status == CLI_DONE;) {
        const char *text = arguments->items[next];
        if (text[0] == '-' && text[1])
            status = read_option(&r, arguments, &next);
        else if (line->scene)
            status =
                cli_usage_error(app, "an output file is given as -o FILE",
                                "openscad: one scene at a time: '%.200s' is one too many", text);
        else
            line->scene = arguments->items[next++];
    }
    if (status == CLI_DONE && !line->help && !line->version && !line->info)
        status = settle(&r);
    return status;
}

void openscad_line_release(openscad_line *line)
{
    free(line->outputs);
    free(line->defines.items);
}
