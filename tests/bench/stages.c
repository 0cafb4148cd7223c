/* SPDX-License-Identifier: MIT
 * What happens inside one run from scene text to file, as JSON: the time of each stage,
 * evaluations, tape lengths, memory. csgmesh --stats says the same of a mesh that is kept in memory
 * and looked at; here it streams to the file as it does without --stats.
 *
 *   stages --compiler                                       what this build was made with
 *   stages SCENE OUT CELLS THREADS [NAME=EXPRESSION...]      bounds are [-1.3, 1.3]^3
 */
#include <csgmesh/csgmesh.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MOST_DEFINES = 16 };

typedef struct run {
    csgm_context *context;
    csgm_scene *scene;
    csgm_field *field;
    csgm_mesh_stats stats;
    uint64_t counts[2];
    double scene_s, compile_s, build_s;
} run;

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void print_finding(void *user, const csgm_diag *diag)
{
    char text[1024];
    csgm_diag_format(diag, text, sizeof text);
    fputs(text, user);
}

static csgm_status load(run *r, const char *path, char **words, int count)
{
    csgm_define defines[MOST_DEFINES];
    for (int i = 0; i < count; i++) {
        char *equals = strchr(words[i], '=');
        if (!equals)
            return CSGM_ERR_ARGUMENT;
        *equals = '\0';
        defines[i] = (csgm_define){words[i], equals + 1};
    }
    csgm_scene_options options = csgm_scene_options_default();
    options.defines = defines;
    options.define_count = (size_t)count;
    return csgm_scene_load(r->context, path, &options, &r->scene);
}

static csgm_status build(run *r, const char *path, uint32_t cells)
{
    csgm_mesh_options options = csgm_mesh_options_default();
    options.resolution = cells;
    r->stats = csgm_mesh_stats_default();
    options.bounds = (csgm_box){{-1.3, -1.3, -1.3}, {1.3, 1.3, 1.3}};
    return csgm_mesh_build_file(r->context, r->field, &options, path, CSGM_FORMAT_AUTO, NULL,
                                r->counts, &r->stats);
}

static void print_run(const run *r)
{
    const csgm_mesh_stats *s = &r->stats;
    printf("{\"time_s\": {\"scene\": %.6f, \"compile\": %.6f, \"octree\": %.6f, \"mesh\": %.6f, "
           "\"finish\": %.6f},\n",
           r->scene_s, r->compile_s, s->octree_s, s->mesh_s, r->build_s - s->octree_s - s->mesh_s);
    printf(" \"vertices\": %llu, \"triangles\": %llu, \"blocks\": %llu,\n",
           (unsigned long long)r->counts[0], (unsigned long long)r->counts[1],
           (unsigned long long)s->leaf_blocks);
    printf(" \"points\": %llu, \"gradients\": %llu, \"intervals\": %llu, \"primitives\": %llu,\n",
           (unsigned long long)s->point_evaluations, (unsigned long long)s->gradient_evaluations,
           (unsigned long long)s->interval_evaluations,
           (unsigned long long)s->primitive_evaluations);
    printf(" \"mean_tape_length\": %.3f, \"memory_peak_bytes\": %llu, \"simd\": \"%s\"}\n",
           s->mean_tape_length, (unsigned long long)s->memory_peak_bytes,
           csgm_context_isa(r->context));
}

static int print_compiler(void)
{
#ifdef __clang__
    puts(__VERSION__);
#else
    puts("gcc " __VERSION__);
#endif
    return 0;
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "--compiler") == 0)
        return print_compiler();
    if (argc < 5 || argc - 5 > MOST_DEFINES)
        return 2;
    run r = {0};
    csgm_context_options options = csgm_context_options_default();
    options.threads = (uint32_t)atoi(argv[4]);
    options.on_diag = print_finding;
    options.user = stderr;
    csgm_status status = csgm_context_create(&options, &r.context);

    double begin_s = now_s();
    if (status == CSGM_OK)
        status = load(&r, argv[1], argv + 5, argc - 5);
    double loaded_s = now_s();
    if (status == CSGM_OK)
        status = csgm_field_compile(r.context, r.scene, &r.field);
    double compiled_s = now_s();
    if (status == CSGM_OK)
        status = build(&r, argv[2], (uint32_t)atoi(argv[3]));
    r.scene_s = loaded_s - begin_s;
    r.compile_s = compiled_s - loaded_s;
    r.build_s = now_s() - compiled_s;
    if (status == CSGM_OK)
        print_run(&r);
    else
        fprintf(stderr, "stages: %s\n", csgm_status_name(status));
    csgm_field_destroy(r.field);
    csgm_scene_destroy(r.scene);
    csgm_context_destroy(r.context);
    return status == CSGM_OK ? 0 : 1;
}
