/* SPDX-License-Identifier: MIT
 * The timing table of Barthe, Wyvill and de Groot 2004: 128^3 evaluations of each operator, on the
 * grids of two overlapping soft balls, one thread, as rows of JSON. `operator` is the operator
 * alone, from arrays of both operands' fields into an array; `field` is the whole scene from
 * points: balls, field functions, operator. Best of several rounds.
 *
 *   operators [ROUNDS]
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "field/field.h"
#include "field/kernels/dispatch.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/rule.h"
#include "scene/operators/soft.h"
#include "scene/tree/build.h"

enum { EDGE = 128, COUNT = EDGE * EDGE * EDGE, LEAST_ROUNDS = 1, MOST_ROUNDS = 100 };

typedef struct row {
    const char *name;
    int published_ms; /* on an Athlon of 1 GHz; 0: not in the paper */
    csg_rule rule;
} row;

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static csg_rule rule_of(csg_blend_kind kind, double first, double second, uint32_t inner)
{
    csg_rule rule = csg_rule_standard(kind);
    if (first > 0)
        rule.parameters[0] = first;
    if (second > 0)
        rule.parameters[1] = second;
    for (uint32_t i = 0; i < inner; i++) { /* control points between the two ends */
        rule.spline.angle[i] = first + (second - first) * (i + 1) / (inner + 1);
        rule.spline.factor[i] = i % 2 ? 0.98 : 1.02;
    }
    rule.spline.count = inner;
    return rule;
}

static csg_node_id soft_ball(csg_scene_builder *builder, double x)
{
    csg_span nowhere = {.source = UINT32_MAX};
    double radius = 0.5;
    csg_affine place = csg_affine_translate(csg_vec3_make(x, 0, 0));
    csg_node_id ball = csg_build_ball(builder, radius, nowhere);
    ball = csg_build_soft(builder, (csg_soft){CSG_FALLOFF_SEXTIC, 0}, ball, nowhere);
    return csg_build_transform(builder, &place, ball, nowhere);
}

/* Two balls under the rule, or one where there is none. */
static csgm_field *compile(csgm_context *context, csgm_scene **scene, const csg_rule *rule,
                           double x)
{
    csg_scene_builder builder;
    csg_span nowhere = {.source = UINT32_MAX};
    csgm_field *field = NULL;
    if (csg_build_begin(&builder, context) != CSGM_OK)
        return NULL;
    csg_node_id root = soft_ball(&builder, x);
    if (rule) {
        csg_node_id both[2] = {root, soft_ball(&builder, -x)};
        root = csg_build_operator(&builder, CSG_NODE_UNION, csg_build_rule(&builder, rule), both, 2,
                                  nowhere);
    }
    if (csg_build_finish(&builder, root, NULL, 0, scene) != CSGM_OK ||
        csg_field_compile(context, *scene, &field) != CSGM_OK)
        fprintf(stderr, "operators: %s\n", builder.problem);
    csg_build_abandon(&builder);
    return field;
}

/* One thread's arrays. */
typedef struct bench {
    const csg_kernel *kernel;
    float *x, *y, *z, *out, *scratch;
    size_t scratch_floats;
} bench;

static double time_field(const bench *b, const csgm_field *field, int rounds)
{
    double best = INFINITY;
    for (int i = 0; i < rounds; i++) {
        double begin = now_s();
        b->kernel->values(&field->tape, b->x, b->y, b->z, COUNT, b->out, b->scratch,
                          b->scratch_floats);
        best = fmin(best, now_s() - begin);
    }
    return best;
}

/* Both operands' fields from arrays: first and second in place of x and y. */
static double time_operator(const bench *b, const csgm_field *field, const float *first,
                            const float *second, int rounds)
{
    const csg_tape *tape = &field->tape;
    const csg_tape_node *join = NULL;
    for (uint32_t i = 0; i < tape->count; i++)
        join = tape->nodes[i].join ? &tape->nodes[i] : join;
    double best = INFINITY;
    for (int i = 0; i < rounds; i++) {
        double begin = now_s();
        memcpy(b->out, first, COUNT * sizeof *first);
        for (size_t at = 0; at < COUNT; at += CSG_BATCH)
            b->kernel->join(tape, join, b->out + at, second + at, CSG_BATCH);
        best = fmin(best, now_s() - begin);
    }
    return best;
}

static void fill_points(bench *b)
{
    for (size_t i = 0; i < COUNT; i++) {
        b->x[i] = (float)(i % EDGE) * (3.0f / (EDGE - 1)) - 1.5f;
        b->y[i] = (float)(i / EDGE % EDGE) * (2.4f / (EDGE - 1)) - 1.2f;
        b->z[i] = (float)(i / EDGE / EDGE) * (2.4f / (EDGE - 1)) - 1.2f;
    }
}

/* The field of one ball, from its value: F = 1/2 + lambda f. */
static bool fill_operand(bench *b, csgm_context *context, double x, float *out)
{
    csgm_scene *scene = NULL;
    csgm_field *field = compile(context, &scene, NULL, x);
    if (!field)
        return false;
    csg_field_eval(field, b->x, b->y, b->z, out, COUNT);
    float lambda = (float)csg_scene_softness(scene, scene->root);
    for (size_t i = 0; i < COUNT; i++)
        out[i] = fminf(fmaxf(0.5f + lambda * out[i], 0), 1);
    csg_field_destroy(field);
    csg_scene_destroy(scene);
    return true;
}

static bool measure(bench *b, csgm_context *context, const row *r, const float *first,
                    const float *second, int rounds, bool last)
{
    csgm_scene *scene = NULL;
    csgm_field *field = compile(context, &scene, &r->rule, 0.45);
    if (!field)
        return false;
    double alone = time_operator(b, field, first, second, rounds);
    double whole = time_field(b, field, rounds);
    printf(
        "  {\"name\": \"%s\", \"published_ms\": %d, \"operator_ms\": %.3f, \"field_ms\": %.3f}%s\n",
        r->name, r->published_ms, 1e3 * alone, 1e3 * whole, last ? "" : ",");
    csg_field_destroy(field);
    csg_scene_destroy(scene);
    return true;
}

static float *array(void)
{
    float *a = aligned_alloc(64, COUNT * sizeof *a);
    if (a) /* its pages are there before the clock runs */
        memset(a, 0, COUNT * sizeof *a);
    return a;
}

static bool measure_rows(bench *b, csgm_context *context, float *first, float *second, int rounds)
{
    const row rows[] = {
        {"Ricci, n = 1", 246, rule_of(CSG_BLEND_RICCI, 1, 0, 0)},
        {"Ricci, n = 3", 884, rule_of(CSG_BLEND_RICCI, 3, 0, 0)},
        {"Ricci, n = 7", 940, rule_of(CSG_BLEND_RICCI, 7, 0, 0)},
        {"smooth arc", 1005, rule_of(CSG_BLEND_ARC, 15, 75, 0)},
        {"smooth arc, 3 control points", 1933, rule_of(CSG_BLEND_ARC, 15, 75, 1)},
        {"smooth arc, 5 control points", 2315, rule_of(CSG_BLEND_ARC, 15, 75, 3)},
        {"sharp arc", 2010, rule_of(CSG_BLEND_ARC_SHARP, 0, 0, 0)},
        {"soft sum", 0, rule_of(CSG_BLEND_SOFT_SUM, 0, 0, 0)},
        {"soft set", 0, rule_of(CSG_BLEND_SOFT_SET, 0, 0, 0)},
        {"Perlin", 0, rule_of(CSG_BLEND_PERLIN, 0, 0, 0)},
        {"scale set", 0, rule_of(CSG_BLEND_SCALE_SET, 0, 0, 0)},
    };
    enum { ROWS = sizeof rows / sizeof *rows };
    bool done = true;
    for (size_t i = 0; i < ROWS && done; i++)
        done = measure(b, context, &rows[i], first, second, rounds, i + 1 == ROWS);
    return done;
}

int main(int argc, char **argv)
{
    int rounds = argc > 1 ? atoi(argv[1]) : 15;
    rounds = rounds < LEAST_ROUNDS ? LEAST_ROUNDS : rounds > MOST_ROUNDS ? MOST_ROUNDS : rounds;
    csgm_context context = {0};
    csg_memory_init(&context.memory, NULL, 0);
    csgm_isa isa = csg_cpu_best_isa(CSGM_ISA_AUTO);
    context.isa = isa;
    bench b = {.kernel = csg_kernel_for(isa), .x = array(), .y = array(), .z = array()};
    float *first = array(), *second = array();
    b.out = array();
    b.scratch_floats = csg_kernel_scratch_floats(2);
    b.scratch = malloc(b.scratch_floats * sizeof *b.scratch);
    bool done = b.x && b.y && b.z && b.out && b.scratch && first && second;
    if (done) {
        fill_points(&b);
        done = fill_operand(&b, &context, 0.45, first) && fill_operand(&b, &context, -0.45, second);
    }
    printf("{\"isa\": \"%s\", \"evaluations\": %d, \"rows\": [\n", b.kernel->name, (int)COUNT);
    done = done && measure_rows(&b, &context, first, second, rounds);
    printf("]}\n");
    float *const all[] = {b.x, b.y, b.z, b.out, b.scratch, first, second};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        free(all[i]);
    return done ? 0 : 1;
}
