/* SPDX-License-Identifier: MIT
 * Any bytes -> the whole evaluator -> a scene. Besides not crashing: memory comes back, a refusal
 * says why, the field can be evaluated, and the printed scene parses back to the same print.
 */
#include <stdlib.h>
#include <string.h>

#include "fuzz/fuzz.h"
#include "lang/lang.h"
#include "scene/collected_text.h"
#include "scene/reference.h"
#include "scene/tree/print.h"

static void check_field(const csgm_scene *scene)
{
    static const csg_vec3 points[] = {{0, 0, 0}, {1, -2, 0.5}, {-1e3, 1e5, 7}};
    csgm_status status = CSGM_OK;
    for (size_t i = 0; i < sizeof points / sizeof *points; i++)
        csg_reference_eval(scene, points[i], &status);
}

/* Limits differ: a loop that made a solid step by step is one line of print. */
static void check_print(csgm_context *context, const csgm_scene *scene)
{
    text first = {0}, second = {0};
    csgm_scene *again = NULL;
    context->limits.eval_steps = 100000000;
    context->limits.depth = 10000;
    context->limits.scene_nodes = 4000000;
    context->memory.limit_bytes = (uint64_t)1 << 30;
    csg_scene_print(scene, collect, &first);
    csg_lang_input input = {.path = "print", .text = first.data, .text_length = first.length};
    csgm_status status = csg_lang_compile(context, &input, &again);
    if (status == CSGM_ERR_SYNTAX || status == CSGM_ERR_SCENE)
        fuzz_fail("the print does not parse back", first.data, first.length);
    if (status == CSGM_OK) {
        csg_scene_print(again, collect, &second);
        if (first.length != second.length || memcmp(first.data, second.data, first.length) != 0) {
            collect(&first, "\n---- again:\n", 13);
            collect(&first, second.data, second.length);
            fuzz_fail("the print parses back to another scene", first.data, first.length);
        }
    }
    csg_scene_destroy(again);
    free(first.data);
    free(second.data);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    csgm_context context;
    csgm_scene *scene = NULL;
    fuzz_context_init(&context);
    fuzz_text file = fuzz_files_open(data, size);
    csg_lang_input input = {
        .path = "scene.txt", .text = file.text, .text_length = file.length, .options = NULL};
    csgm_status status = csg_lang_compile(&context, &input, &scene);
    if (status != CSGM_OK && context.diags.errors == 0)
        fuzz_fail("refused without a word", file.text, file.length);
    if (status == CSGM_OK) {
        check_field(scene);
        check_print(&context, scene);
    }
    csg_scene_destroy(scene);
    fuzz_files_close();
    fuzz_context_close(&context);
    return 0;
}
